# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A CAN bus with two slcan adapters, each behind a serial line of its own: two pseudo terminals."""

from __future__ import annotations

import os
import select
import threading
import tty
from contextlib import suppress
from pathlib import Path

from ravenchart.running.process import separate_cores

FRAMES = b"tTrRdDbB"


class SerialBus:
    """Frames of each adapter go to the other; commands of the host are taken without a word."""

    def __init__(self, *devices: Path) -> None:
        """The adapters are found by these names."""
        self._devices = devices
        self._lines = [os.openpty() for _ in devices]
        for device, (_, slave) in zip(devices, self._lines, strict=True):
            tty.setraw(slave)
            device.unlink(missing_ok=True)
            device.symlink_to(os.ttyname(slave))
        self._ends, self._end = os.pipe()
        self._thread = threading.Thread(target=self._relay, daemon=True)

    def __enter__(self) -> tuple[Path, ...]:
        self._thread.start()
        return self._devices

    def __exit__(self, *_: object) -> None:
        os.close(self._end)
        self._thread.join()
        for line in (*self._lines, (self._ends,)):
            for descriptor in line:
                os.close(descriptor)

    def _relay(self) -> None:
        with separate_cores():  # a bus delays no frame because the host has other work
            self._pass_on()

    def _pass_on(self) -> None:
        masters = [master for master, _ in self._lines]
        for master in masters:
            os.set_blocking(master, False)
        begun = dict.fromkeys(masters, b"")
        while True:
            ready = select.select([*masters, self._ends], [], [])[0]
            if self._ends in ready:
                return
            for master in ready:
                *lines, begun[master] = (begun[master] + os.read(master, 4096)).split(b"\r")
                passing = b"".join(line + b"\r" for line in lines if line and line[0] in FRAMES)
                for other in masters:
                    if other != master and passing:
                        with suppress(BlockingIOError):  # nobody reads there: the frames are lost
                            os.write(other, passing)
