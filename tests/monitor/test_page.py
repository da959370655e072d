"""The monitor's page over HTTP, and in a real browser where there is one."""

import base64
import contextlib
import http.client
import json
import os
import pathlib
import re
import shutil
import socket
import subprocess
import tempfile
import time
import unittest
import urllib.parse

SERVER = pathlib.Path(os.environ["FLEXCOMP_BIN"]) / "serve_page"
BUILD = pathlib.Path(os.environ["FLEXCOMP_BUILD"])
CHROMIUM = shutil.which("chromium")


@contextlib.contextmanager
def served(seconds):
    """The address of a page that is served for so long."""
    process = subprocess.Popen([SERVER, str(seconds)], stdout=subprocess.PIPE, text=True)
    try:
        yield urllib.parse.urlparse(process.stdout.readline().strip())
    finally:
        process.kill()
        process.wait()
        process.stdout.close()


def get(address, target, host=None):
    connection = http.client.HTTPConnection(address.hostname, address.port, timeout=10)
    connection.request("GET", target, headers={"Host": host or address.netloc})
    return connection.getresponse()


class OverHttp(unittest.TestCase):
    def test_the_page_and_its_events_are_there(self):
        with served(20) as address:
            page = get(address, "/")
            self.assertEqual((200, "text/html; charset=utf-8"), (page.status, page.headers["Content-Type"]))
            self.assertIn("<title>flexcomp node monitor</title>", page.read().decode())
            events = get(address, "/events")
            self.assertEqual("text/event-stream; charset=utf-8", events.headers["Content-Type"])
            times = []
            for _ in range(5):
                line = events.readline().decode()
                self.assertTrue(line.startswith("data: "))
                times.append(json.loads(line[6:])["time"])
                self.assertEqual(b"\n", events.readline())
            self.assertEqual(sorted(set(times)), times)

    def test_the_page_brings_nothing_from_elsewhere(self):
        with served(20) as address:
            page = get(address, "/")
            self.assertIn("default-src 'none'", page.headers["Content-Security-Policy"])
            self.assertIsNone(re.search(r"https?://|src=", page.read().decode()))

    def test_what_a_foreign_page_may_ask_is_refused(self):
        with served(20) as address:
            self.assertEqual(403, get(address, "/events", host="evil.example").status)
            self.assertEqual(403, get(address, "/", host=f"127.0.0.1:{address.port}.evil.example").status)
            self.assertEqual(200, get(address, "/", host=f"localhost:{address.port}").status)
            self.assertEqual(404, get(address, "/other").status)

    def test_it_is_on_this_machine_alone(self):
        with served(20) as address:
            listening = [line.split()[1] for line in pathlib.Path("/proc/net/tcp").read_text().splitlines()[1:]]
            self.assertIn(f"0100007F:{address.port:04X}", listening)
            self.assertNotIn(f"00000000:{address.port:04X}", listening)

    def test_garbage_silence_and_crowds_stop_nobody(self):
        with served(20) as address:
            crowd = [socket.create_connection((address.hostname, address.port)) for _ in range(8)]
            crowd[0].sendall(b"\0\xff" * 10000)
            crowd[1].sendall(b"GET / HTTP/1.1\r\nHost:")
            crowd[2].sendall(b"GET / HTTP/1.1\r\nHost:\r\n\r\n")
            crowd[3].close()
            self.assertEqual(200, get(address, "/").status)
            self.assertTrue(crowd[2].recv(100).startswith(b"HTTP/1.1 403"))
            for one in crowd:
                one.close()


class Browser:
    """Chromium without a window, by its debugging protocol over pipes."""

    def __init__(self, folder):
        (to_read, self._write), (self._read, to_write) = os.pipe(), os.pipe()

        def take_places():  # where the browser looks for the pipes
            os.dup2(to_read, 103)
            os.dup2(to_write, 104)
            os.dup2(103, 3)
            os.dup2(104, 4)

        self._process = subprocess.Popen(
            [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--remote-debugging-pipe",
             f"--user-data-dir={folder}", "--window-size=1000,900"],
            preexec_fn=take_places, close_fds=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_read)
        os.close(to_write)
        self._buffer, self._number, self._session = b"", 0, None

    def order(self, method, **parameters):
        self._number += 1
        order = {"id": self._number, "method": method, "params": parameters}
        if self._session:
            order["sessionId"] = self._session
        os.write(self._write, json.dumps(order).encode() + b"\0")
        while True:
            while b"\0" not in self._buffer:
                self._buffer += os.read(self._read, 1 << 16)
            answer, _, self._buffer = self._buffer.partition(b"\0")
            answer = json.loads(answer)
            if answer.get("id") == self._number:
                return answer["result"]

    def open(self, address):
        target = self.order("Target.createTarget", url=address)["targetId"]
        self._session = self.order("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]

    def evaluate(self, expression):
        return self.order("Runtime.evaluate", expression=expression)["result"].get("value")

    def screenshot(self):
        return base64.b64decode(self.order("Page.captureScreenshot", format="png")["data"])

    def close(self):
        self._process.kill()
        self._process.wait()
        os.close(self._write)
        os.close(self._read)


@unittest.skipIf(CHROMIUM is None, "there is no chromium")
class InABrowser(unittest.TestCase):
    def test_the_plots_move_and_a_fault_is_shown_in_words(self):
        with tempfile.TemporaryDirectory() as folder, served(120) as address:
            browser = Browser(folder)
            self.addCleanup(browser.close)
            browser.open(address.geturl())
            self.wait_for(browser, "document.getElementById('state').textContent === 'active'")
            first = self.ink(browser)
            self.wait_for(browser, "document.getElementById('faults').textContent === 'wrench stale'")
            self.assertEqual("holding", browser.evaluate("document.getElementById('state').textContent"))
            self.assertGreater(self.ink(browser), first)
            (BUILD / "monitor_page.png").write_bytes(browser.screenshot())

    def wait_for(self, browser, condition):
        latest = time.monotonic() + 60
        while not browser.evaluate(condition):
            self.assertLess(time.monotonic(), latest, condition)
            time.sleep(0.1)

    @staticmethod
    def ink(browser):
        """Pixels of the plot of corrections in the colour of joint 1, or close to it."""
        return browser.evaluate("""(() => {
            const canvas = document.getElementById("correction");
            const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
            let count = 0;
            for (let i = 0; i < pixels.length; i += 4) {
                count += pixels[i + 3] > 100 && pixels[i + 2] > pixels[i] + 80;
            }
            return count;
        })()""")


if __name__ == "__main__":
    unittest.main()
