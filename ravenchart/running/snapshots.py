# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The snapshots of a running controller: the file that it writes them to, found and read.

Ravenchart.Hosts.Snapshots (spark_runtime/native) says what the file holds. The controller holds
it as `held_files` says.
"""

from __future__ import annotations

import os
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from ravenchart.analysis.system.observed import (
    VALUE,
    Observation,
    TraceError,
    TraceMap,
    TraceRecord,
    read_trace,
    trace_record,
)

from . import held_files

VARIABLE = "RAVENCHART_MONITOR"
"""The environment variable that names the file to a controller."""

MARK = ".live-"
"""In the name of a file that `run` gives a controller, behind the name of the program."""

FIRST_LINE = 22
"""Bytes of the first line."""

RECENT = 32
"""So many transitions and faults a snapshot lists at the most."""

KINDS = (
    "sent", "arrived", "handled", "raised", "activity", "transition", "state", "fault", VALUE,
)  # fmt: skip
"""The kinds of records in the order in which a snapshot counts them."""

TRIES = 20
"""So often a snapshot is read that is being written."""

PAUSE = 0.002
"""Seconds between two tries."""


@dataclass(frozen=True, slots=True)
class Tally:
    """How many records of one kind there were of an element, and the last of them."""

    count: int
    last: TraceRecord


@dataclass(frozen=True, slots=True)
class Snapshot:
    """The report of a controller at one time.

    The records of ``seen`` are the last transitions and faults. ``seen`` is complete in the last
    snapshot of a controller that ended in order. ``partial``: the controller ran already when its
    records were first read, so earlier ones are missing.
    """

    sequence: int
    seen: Observation
    tallies: tuple[Tally, ...]
    partial: bool = False


class SnapshotFile:
    """A file of snapshots, open. OSError where it cannot be read."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._file = os.open(path, os.O_RDONLY | os.O_CLOEXEC)

    def close(self) -> None:
        """Give the file back."""
        os.close(self._file)

    def follow(self) -> None:
        """Read from now on the file that has its name now, where that is another one."""
        with suppress(OSError):
            file = os.open(self.path, os.O_RDONLY | os.O_CLOEXEC)
            if os.path.samestat(os.fstat(file), os.fstat(self._file)):
                os.close(file)
            else:
                os.close(self._file)
                self._file = file

    def owner(self) -> int | None:
        """The number of the process that writes it, as of `held_files.holder`."""
        return held_files.holder(self._file)

    def text(self) -> str | None:
        """The last whole snapshot; None where there is none yet."""
        for number in range(TRIES):
            if number:
                time.sleep(PAUSE)
            with suppress(ValueError):
                words = os.pread(self._file, FIRST_LINE, 0).split()
                length = int(words[2]) if len(words) == 3 else 0
                text = os.pread(self._file, length, 0).decode("ascii", "replace")
                if _is_whole(text, length):
                    return text
        return None


def _is_whole(text: str, length: int) -> bool:
    """Whether the first and the last line have one number, and all is there."""
    lines = text.splitlines()
    return (
        len(text) == length > 0
        and len(lines) > 1
        and lines[-1].startswith("S ")
        and lines[0].startswith(f"{lines[-1]} ")
    )


def parsed_snapshot(text: str, trace_map: TraceMap, file: str) -> Snapshot:
    """A whole snapshot; TraceError names the first line that cannot be read."""
    lines = text.splitlines()
    report: list[str] = []
    tallies: list[Tally] = []
    for number, line in enumerate(lines[1:-1], 2):
        words = line.split()
        if words[:1] != ["C"]:
            report.append(line)
            continue
        try:
            _, kind, element, count, at, value = words
            tallies.append(Tally(int(count), trace_record(at, kind, element, value, trace_map)))
        except ValueError as fault:
            raise TraceError(f"{file}:{number}: error: {fault}") from None
    seen = read_trace(report, trace_map, file)
    return Snapshot(int(lines[-1].split()[1]), seen, tuple(tallies))
