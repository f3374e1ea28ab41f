# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart check --watch`: the model is checked again whenever a file of it changes.

The files are those that the last check read or tried to read, included ones too. `stat` reads
their state every `POLL` seconds. A model has at most 100 files, so polling takes less than a
thousandth of a core. It works on network folders, and needs no library. An editor that writes a
new file and renames it over the old one changes the inode: that is a change like any other.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import NoReturn

from rich.text import Text

from ravenchart import terminal
from ravenchart.building import checking
from ravenchart.failures import Failure
from ravenchart.gen.diagnostics import Diagnostic
from ravenchart.gen.files.load import read_file

from .common import several, tell_warnings, verdict

POLL = 0.2
"""Seconds between two looks at the files."""

QUIET = 5
"""Looks that a file may be away, or still be written to, before the model is checked with it."""

Stamp = tuple[int, int, int] | None
"""Inode, size and time of a file; None of one that is not there."""


def watch(model: Path) -> NoReturn:
    """Check the model now and after each change, until a signal ends the process."""
    while True:
        seen: dict[Path, Stamp] = {}
        shown = time.strftime("%H:%M:%S")
        _print(Text(f"--- {shown} check {model} ---", style="bold"))
        verdict, passed = _checked(model, seen)
        _print(Text(f"{verdict} ({several(len(seen), 'file')} watched)", style=_style(passed)))
        wait(seen)
        print(flush=True)


def wait(seen: Mapping[Path, Stamp]) -> None:
    """Return when the files are no longer as ``seen``, and have been quiet for a moment."""
    while True:
        time.sleep(POLL)
        now = _now(seen)
        for _ in range(QUIET):
            if now == seen:
                break
            time.sleep(POLL)
            before, now = now, _now(seen)
            away = any(now[path] is None and seen[path] is not None for path in seen)
            if now == before and not away:
                break
        if now != seen:
            return


def _checked(model: Path, seen: dict[Path, Stamp]) -> tuple[str, bool]:
    """Check it once, and print what is wrong; the verdict, and whether there is no error."""

    def read(path: Path, limit: int) -> bytes:
        seen[path] = _stamp(path)  # before it is read: a change meanwhile is one to check again
        return read_file(path, limit)

    try:
        found = checking.check(model, finish=True, read=read, library=True)
    except Failure as failure:
        print(failure.shown(), file=sys.stderr, flush=True)
        return f"FAILED: {_counted(failure)}", False
    tell_warnings(found.warnings)
    return verdict(found), True


def _counted(failure: Failure) -> str:
    """How many errors and warnings there are."""
    diagnostics = [one for one in failure.found if isinstance(one, Diagnostic)]
    errors = sum(one.is_error for one in diagnostics) or 1
    warnings = sum(not one.is_error for one in diagnostics)
    counted = several(errors, "error")
    return f"{counted}, {several(warnings, 'warning')}" if warnings else counted


def _now(paths: Mapping[Path, Stamp]) -> dict[Path, Stamp]:
    return {path: _stamp(path) for path in paths}


def _stamp(path: Path) -> Stamp:
    try:
        found = path.stat()
    except (OSError, ValueError):  # ValueError: a NUL in the name
        return None
    return found.st_ino, found.st_size, found.st_mtime_ns


def _style(passed: bool) -> str:
    return "bold green" if passed else "bold red"


def _print(line: Text) -> None:
    out = terminal.console(None)
    out.print(line, soft_wrap=True)
    out.file.flush()
