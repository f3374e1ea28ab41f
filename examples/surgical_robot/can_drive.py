# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The drive of drive_over_can.yaml on the bench: four axes, by the frames of its data sheet.

It takes set-points (0x201) and reports positions (0x181) every 5 ms, each with four words of
16 bits in mrad, the most significant byte first. An axis moves by at most 6 mrad in 5 ms::

    ravenchart bus --port 29536
    python examples/surgical_robot/can_drive.py ravenchart 127.0.0.1:29536

The arguments are interface and channel of python-can.
"""

from __future__ import annotations

import struct
import sys
import time
from threading import Event

import can

SET_POINTS, POSITIONS = 0x201, 0x181
PERIOD = 0.005
"""Time between two reports in s."""
STRIDE = 6
"""What an axis moves in a period at most, in mrad."""
WORDS = ">4h"


def drive(bus: can.BusABC, stopped: Event) -> list[int]:
    """Play the drive until ``stopped`` is set; where its axes are then, in mrad."""
    places, goals = [0] * 4, [0] * 4
    due = time.monotonic()
    while not stopped.is_set():
        due += PERIOD
        while (frame := bus.recv(max(0.0, due - time.monotonic()))) is not None:
            if frame.arbitration_id == SET_POINTS and frame.dlc == 8:
                goals = list(struct.unpack(WORDS, frame.data))
        places = [
            at + max(-STRIDE, min(STRIDE, goal - at))
            for at, goal in zip(places, goals, strict=True)
        ]
        data = struct.pack(WORDS, *places)
        bus.send(can.Message(arbitration_id=POSITIONS, data=data, is_extended_id=False))
    return places


if __name__ == "__main__":
    with can.Bus(interface=sys.argv[1], channel=sys.argv[2]) as line:
        try:
            drive(line, Event())
        except KeyboardInterrupt:
            sys.exit(130)
