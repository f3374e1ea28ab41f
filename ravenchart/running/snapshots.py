# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The snapshots of a running controller: the file that it writes them to, found and read.

Ravenchart.Hosts.Snapshots (spark_runtime/native) says what the file holds. The controller holds a
lock on it for as long as it lives, so a file without a lock is of one that has ended.
"""

from __future__ import annotations

import fcntl
import os
import struct
import tempfile
import time
from collections.abc import Sequence
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

ABANDONED = 60.0
"""A file without a lock for so long, in s, is left over."""

_LOCK = "hhqqi"
"""`struct flock` of Linux on 64 bits: type, whence, start, length, process."""


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
        """The number of the process that writes it; None where there is none any more.

        It is 0 for a process that this one cannot see, as in another container.
        """
        asked = struct.pack(_LOCK, fcntl.F_RDLCK, os.SEEK_SET, 0, 0, 0)
        kind, _, _, _, process = struct.unpack(_LOCK, fcntl.fcntl(self._file, fcntl.F_GETLK, asked))
        return None if kind == fcntl.F_UNLCK else int(process)

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


def new_file(executable: Path) -> Path | None:
    """A new file for the snapshots of a program, beside it; None where it cannot be there.

    Files there that a killed run has left over are deleted.
    """
    folder, prefix = executable.absolute().parent, f"{executable.name}{MARK}"
    for path in folder.glob(f"{prefix}*"):
        with suppress(OSError):
            if time.time() - path.stat().st_mtime > ABANDONED and not is_written(path):
                path.unlink()
    try:
        file, name = tempfile.mkstemp(prefix=prefix, dir=folder)
    except OSError:
        return None
    os.close(file)
    return Path(name)


def is_written(path: Path) -> bool:
    """Whether a controller writes it now. OSError where it cannot be read."""
    file = SnapshotFile(path)
    try:
        return file.owner() is not None
    finally:
        file.close()


def snapshot_files(folders: Sequence[Path], program: str) -> list[Path]:
    """The files of controllers that run now, of a program in any mode; the newest first."""
    found: list[tuple[float, Path]] = []
    for path in (p for folder in folders for p in folder.glob(f"*/{program}{MARK}*")):
        with suppress(OSError):
            if is_written(path):
                found.append((path.stat().st_mtime, path))
    return [path for _, path in sorted(found, reverse=True)]
