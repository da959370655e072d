"""A board with a Cortex-M7 in QEMU, its serial line as a terminal of this machine, and what may
happen to either."""

import contextlib
import json
import os
import pathlib
import socket
import subprocess
import time
import tty

from relay import Window, carry

SETTINGS_ADDRESS = 0x200000
TABLE_ADDRESS = 0x300000


class Board:
    """`terminal` stays the same for as long as this lives, whatever becomes of the processor."""

    def __init__(self, image, folder):
        self.image = image
        self.folder = pathlib.Path(folder)
        self.near, far = os.openpty()
        tty.setraw(self.near)
        tty.setraw(far)
        self.far = far  # kept open, or reading from the near end fails
        self.terminal = os.ttyname(far)
        self.fault = None  # "cut" or "corrupt"
        self.window = Window()
        self.process = None
        self.line = None
        carry(lambda: os.read(self.near, 4096), self._to_processor)

    def start(self, settings, table):
        self.stop()
        serial, monitor = (self.folder / name for name in ("serial", "monitor"))
        for path in (serial, monitor):
            path.unlink(missing_ok=True)
        self.process = subprocess.Popen(
            ["qemu-system-arm", "-machine", "mps2-an500", "-display", "none", "-S", "-kernel", self.image,
             "-device", f"loader,file={settings},addr={SETTINGS_ADDRESS},force-raw=on",
             "-device", f"loader,file={table},addr={TABLE_ADDRESS},force-raw=on",
             "-serial", f"unix:{serial},server=on,wait=off", "-qmp", f"unix:{monitor},server=on,wait=off"],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        self.monitor = self._connect(monitor).makefile("rw")
        self.fault = None
        line = self.line = self._connect(serial)
        carry(lambda: line.recv(4096), self._to_terminal)
        self.monitor.readline()
        self._order("qmp_capabilities")
        self._order("cont")  # until now the processor stood still

    def reset(self):
        """Resets the processor; its memory stays."""
        self._order("system_reset")

    def stop(self):
        if self.process is not None:
            self.line = None
            self.process.kill()
            self.process.wait()
            self.process = None

    def _connect(self, path):
        for _ in range(100):
            with contextlib.suppress(OSError):
                connection = socket.socket(socket.AF_UNIX)
                connection.connect(str(path))
                return connection
            time.sleep(0.05)
        raise AssertionError("QEMU did not start")

    def _order(self, name):
        self.monitor.write(json.dumps({"execute": name}) + "\n")
        self.monitor.flush()
        while "return" not in json.loads(self.monitor.readline()):
            pass

    def _to_terminal(self, data):
        self.window.send(lambda part: os.write(self.near, part), self._spoilt(data))

    def _to_processor(self, data):
        data = self.window.without_receipts(data)
        line = self.line
        if line is not None:
            with contextlib.suppress(OSError):  # it may be stopped at any time
                line.sendall(self._spoilt(data))

    def _spoilt(self, data):
        if self.fault == "cut":
            return b""
        if self.fault == "corrupt":
            return bytes(byte ^ 0x04 if i % 7 == 3 else byte for i, byte in enumerate(data))
        return data
