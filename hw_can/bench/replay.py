# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A log as input of a scenario: frames in BLF, ASC or candump's format, sent at their times."""

from __future__ import annotations

from pathlib import Path

import can

from .peer import BenchError, Codec
from .several import JoinedCodec

SUFFIXES = (".asc", ".blf", ".log")
"""Vector's ASC and BLF, and the format of candump."""

Timed = tuple[float, can.Message]
"""A frame, and when it is due, in s from the first frame of the log."""


def read_log(path: Path) -> list[Timed]:
    """The frames of a log in the order of time, without error frames; BenchError in words."""
    if path.suffix not in SUFFIXES:
        raise BenchError(f"{path.name} has no suffix of {', '.join(SUFFIXES)}")
    try:
        with can.LogReader(path) as reader:
            frames = [frame for frame in reader if not frame.is_error_frame]
    except OSError as fault:
        raise BenchError(f"cannot read {path}: {(fault.strerror or str(fault)).lower()}") from None
    except Exception as fault:  # the readers of python-can raise what they like
        raise BenchError(f"{path} is no log of this format: {fault}") from None
    frames.sort(key=lambda frame: frame.timestamp)
    return [(frame.timestamp - frames[0].timestamp, frame) for frame in frames]


def log_for(path: Path, codec: Codec) -> list[Timed]:
    """The same with the bus of each frame, where the file is called after one of several buses.

    The formats BLF and ASC have numbers for channels only, so a run names a file ``run-cabin.blf``.
    """
    log = read_log(path)
    for bus in codec.codecs if isinstance(codec, JoinedCodec) else ():
        if path.stem.lower().endswith(f"-{bus.lower()}"):
            for _, frame in log:
                frame.channel = bus
    return log


def fault_of_log(path: Path) -> str | None:
    """Why the log cannot be replayed, in words."""
    try:
        return None if read_log(path) else f"{path.name} has no frame"
    except BenchError as fault:
        return str(fault)


def from_outside(log: list[Timed], codec: Codec, drives: frozenset[str]) -> list[Timed]:
    """The frames of messages that the bench sends: no node and none of ``drives`` sends them.

    Frames that do not fit their message, such as remote frames, are left out.
    """
    names = ((at, frame, codec.from_outside(frame)) for at, frame in log)
    return [(at, frame) for at, frame, name in names if name is not None and name not in drives]
