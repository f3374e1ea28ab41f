"""What the rules of behaviour found earlier, kept by the content of the model (`kept`).

A key covers every file of the model, the sources of the tool, and the versions of Python and z3.
A result that is not finished is kept with the seconds that it had.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

import z3

from ravenchart.behaviour.rules import UNFINISHED
from ravenchart.gen.diagnostics import Diagnostic, Severity
from ravenchart.gen.origins import Origin
from ravenchart.paths import PACKAGE

from . import kept

KIND = "checks"
FORMAT = 1
"""Part of each key: raised when what an entry holds changes."""
SOURCES = ("analysis", "behaviour", "gen")


@cache
def _tool() -> list[object]:
    """All that decides what is found in a model."""
    paths = sorted(path for name in SOURCES for path in (PACKAGE / name).rglob("*.py"))
    sources = [
        (str(p.relative_to(PACKAGE)), hashlib.sha256(p.read_bytes()).hexdigest()) for p in paths
    ]
    return [FORMAT, sys.version, z3.get_version_string(), sources]


def key(sources: Mapping[str, Sequence[str]]) -> str:
    """The key of a model, given the lines of its files by name."""
    return kept.digest([_tool(), sorted((name, list(text)) for name, text in sources.items())])


def load(key: str, seconds: float, *, finished: bool) -> tuple[Diagnostic, ...] | None:
    """What was found; None when nothing is kept.

    One that was not finished counts when it had ``seconds``, unless it must be ``finished``.
    """
    entry: Any = kept.load(KIND, key)
    try:
        found = tuple(_diagnostic(one) for one in entry["found"])
        is_open = any(one.code == UNFINISHED for one in found)
        return None if is_open and (finished or entry["seconds"] < seconds) else found
    except (KeyError, TypeError, ValueError):
        return None


def store(key: str, seconds: float, found: Sequence[Diagnostic]) -> None:
    """Keep what was found within so many seconds."""
    kept.store(KIND, key, {"seconds": seconds, "found": [_entry(one) for one in found]})


def _entry(found: Diagnostic) -> list[object]:
    notes = [(_place(origin), text) for origin, text in found.notes]
    place = _place(found.origin)
    return [found.code, found.severity.value, place, found.message, notes, found.hint]


def _place(origin: Origin) -> list[object]:
    return [origin.file, origin.line, origin.column]


def _diagnostic(entry: Any) -> Diagnostic:
    code, severity, place, message, notes, hint = entry
    shown = tuple((Origin(*origin), text) for origin, text in notes)
    return Diagnostic(code, Severity(severity), Origin(*place), message, shown, hint)
