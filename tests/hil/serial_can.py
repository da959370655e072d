"""A CAN interface slcan0 from the serial line /dev/ttyS0, until it is killed.

Not slcand on the line itself: user-mode Linux does not tell slcan when its serial line has taken a
frame, and so slcan would send one only."""

import os
import subprocess
import termios
import tty

from relay import Receipts, carry


def main():
    near, far = os.openpty()
    line = os.open("/dev/ttyS0", os.O_RDWR | os.O_NOCTTY)
    for end in (near, far, line):
        tty.setraw(end, termios.TCSANOW)
    receipts = Receipts(lambda data: os.write(line, data))
    with subprocess.Popen(["slcand", "-F", "-o", "-s6", "-t", "hw", os.ttyname(far), "slcan0"]):
        carry(lambda: os.read(near, 4096), lambda data: os.write(line, data))
        carry(lambda: os.read(line, 4096), lambda data: os.write(near, receipts.give(data))).join()


if __name__ == "__main__":
    main()
