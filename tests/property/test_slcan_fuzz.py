# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Random byte strings through the slcan parser: nothing is raised or accepted wrongly.

200,000 of them in each build; ten million with `make test-long`. What becomes of the
first lines is held against the grammar of the protocol, as regular expressions.
"""

from __future__ import annotations

import os
import re
import struct
import subprocess

import pytest
from can.util import dlc2len

from tests.support.ada_programs import built
from tests.support.modes import MODES

STRINGS = 10_000_000 if "RAVENCHART_LONG_TESTS" in os.environ else 200_000
SHOWN = 50_000
LONGEST = 138
"""Bytes of a line before its carriage return."""

FRAME = re.compile(
    rb"(?:([trdb])([0-7][0-9A-Fa-f]{2})|([TRDB])([01][0-9A-Fa-f]{7}))"
    rb"([0-9A-Fa-f])((?:[0-9A-Fa-f]{2})*)"
)
COMMANDS = {b"": "EMPTY_LINE", b"O": "OPEN_CHANNEL", b"C": "CLOSE_CHANNEL",
            b"V": "VERSION_QUERY", b"N": "SERIAL_QUERY"}  # fmt: skip
SETTING = re.compile(rb"[FPALEvzZ]|[SYZQWX][0-9]|[sMm][0-9A-Fa-f]{2,}")


def meaning(line: bytes) -> str:
    """What the program is to show of a line."""
    if len(line) > LONGEST:
        return "REJECTED_LINE"
    if line in COMMANDS:
        return COMMANDS[line]
    if SETTING.fullmatch(line):
        return "OTHER_COMMAND"
    found = FRAME.fullmatch(line)
    if found is None:
        return "REJECTED_LINE"
    base, short, extended, long, length, data = found.groups()
    kind = {b"t": "DATA", b"r": "REMOTE"}.get((base or extended).lower(), "DATA_FD")
    asked = dlc2len(int(length, 16))
    if len(data) != (0 if kind == "REMOTE" else 2 * asked) or (asked > 8 and kind != "DATA_FD"):
        return "REJECTED_LINE"
    content = bytes.fromhex(data.decode()).ljust(64, b"\0")
    payload = sum(struct.unpack("<8Q", content)) % 2**64
    form = "STANDARD" if base else "EXTENDED"
    return f"FRAME_LINE/{form}/{kind}/ {int(short or long, 16)}/ {asked}/ {payload}"


@pytest.mark.slow
@pytest.mark.parametrize("mode", MODES)
def test_what_is_accepted_is_written_as_it_was_read(mode: str) -> None:
    program = built(mode, "loopback", "slcan_fuzz") / "slcan_fuzz"
    done = subprocess.run(
        [program, str(STRINGS), str(SHOWN)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout[-500:] + done.stderr
    *lines, frames = done.stdout.splitlines()
    assert STRINGS / 4 < int(frames) < STRINGS / 2
    shown = [line.split("/", 1) for line in lines]
    assert len(shown) == SHOWN
    assert [(hexed, word) for hexed, word in shown if meaning(bytes.fromhex(hexed)) != word] == []
    assert {word.split("/")[0] for _, word in shown} >= {*COMMANDS.values(), "REJECTED_LINE"}
