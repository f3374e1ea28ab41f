# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Files beside a program that others read while it runs.

The one who writes such a file holds a lock on it for as long as it lives, so a file without a lock
is of one that has ended.
"""

from __future__ import annotations

import fcntl
import os
import struct
import tempfile
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

ABANDONED = 60.0
"""A file without a lock for so long, in s, is left over."""

TRACE = ".trace"
"""The trace of a controller has the name of its file of snapshots, and this behind it."""

_LOCK = "hhqqi"
"""`struct flock` of Linux on 64 bits: type, whence, start, length, process."""


def hold(file: int) -> None:
    """Lock a file, by its descriptor, until that is closed. OSError where another one holds it."""
    asked = struct.pack(_LOCK, fcntl.F_WRLCK, os.SEEK_SET, 0, 0, 0)
    fcntl.fcntl(file, fcntl.F_OFD_SETLK, asked)


def holder(file: int) -> int | None:
    """The number of the process that holds the file of a descriptor; None where none does.

    It is 0 for a process that this one cannot see, as in another container, and -1 where the lock
    is one of `hold`, which belongs to no process.
    """
    asked = struct.pack(_LOCK, fcntl.F_RDLCK, os.SEEK_SET, 0, 0, 0)
    kind, _, _, _, process = struct.unpack(_LOCK, fcntl.fcntl(file, fcntl.F_GETLK, asked))
    return None if kind == fcntl.F_UNLCK else int(process)


def is_held(path: Path) -> bool:
    """Whether someone writes it now. OSError where it cannot be read."""
    file = os.open(path, os.O_RDONLY | os.O_CLOEXEC)
    try:
        return holder(file) is not None
    finally:
        os.close(file)


def new_file(executable: Path, mark: str) -> Path | None:
    """A new file beside a program, with that mark in its name; None where it cannot be there.

    Files there that a killed run has left over are deleted.
    """
    folder, prefix = executable.absolute().parent, f"{executable.name}{mark}"
    for path in folder.glob(f"{prefix}*"):
        with suppress(OSError):
            if path.is_symlink():
                continue  # to a trace, which nobody holds: see `link_trace`
            if time.time() - path.stat().st_mtime > ABANDONED and not is_held(path):
                path.unlink()
    try:
        file, name = tempfile.mkstemp(prefix=prefix, dir=folder)
    except OSError:
        return None
    os.close(file)
    return Path(name)


def held_files(folders: Sequence[Path], program: str, mark: str) -> list[Path]:
    """The files with a mark that are held now, of a program in any mode; the newest first."""
    found: list[tuple[float, Path]] = []
    for path in (p for folder in folders for p in folder.glob(f"*/{program}{mark}*")):
        with suppress(OSError):
            if is_held(path):
                found.append((path.stat().st_mtime, path))
    return [path for _, path in sorted(found, reverse=True)]


def trace_beside(snapshots: Path) -> Path:
    """The name by which the trace of a controller is found, beside its file of snapshots."""
    return Path(f"{snapshots}{TRACE}")


def link_trace(snapshots: Path, trace: Path) -> None:
    """Let the trace of a controller be found; links that killed runs have left over are deleted."""
    for link in snapshots.parent.glob(f"*{TRACE}"):
        if link.is_symlink() and not link.with_name(link.name.removesuffix(TRACE)).exists():
            link.unlink(missing_ok=True)
    with suppress(OSError):
        trace_beside(snapshots).symlink_to(trace.absolute())
