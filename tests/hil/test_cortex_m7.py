"""The firmware image in an emulated board, on the bus: starts the board, and the guest that takes its
serial line for a CAN interface and plays `cortex_m7_scenarios`. Serves what those ask for."""

import contextlib
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile

from emulated_board import Board

HERE = pathlib.Path(__file__).parent
SOURCE = pathlib.Path(os.environ["FLEXCOMP_SOURCE"])
IMAGE = SOURCE / "build" / "cortex-m7" / "bin" / "flexcomp_firmware.elf"
SKIPPED = 77


def serve(board, request):
    order = request["order"]
    if order == "start":
        board.start(request["settings"], request["table"])
    elif order == "reset":
        board.reset()
    else:
        board.fault = {"cut": "cut", "corrupt": "corrupt", "mend": None}[order]


def main():
    if not IMAGE.exists() or shutil.which("qemu-system-arm") is None:
        print(f"skipped: {IMAGE.name} has not been built (cmake --preset cortex-m7), or there is no QEMU")
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        board = Board(IMAGE, folder)
        environment = dict(os.environ, FLEXCOMP_VCAN="guest", FLEXCOMP_GUEST_SERIAL=board.terminal,
                           FLEXCOMP_BOARD=folder, FLEXCOMP_BUS="slcan0")
        guest = subprocess.Popen([SOURCE / "tools" / "vcan", sys.executable, HERE / "cortex_m7_scenarios.py",
                                  *sys.argv[1:]], env=environment, start_new_session=True)
        request = pathlib.Path(folder) / "request"
        try:
            while True:
                try:
                    return guest.wait(timeout=0.01)
                except subprocess.TimeoutExpired:
                    if request.exists():
                        serve(board, json.loads(request.read_text()))
                        request.unlink()
        finally:
            with contextlib.suppress(ProcessLookupError):  # usually it has ended
                os.killpg(guest.pid, signal.SIGKILL)
            board.stop()


if __name__ == "__main__":
    sys.exit(main())
