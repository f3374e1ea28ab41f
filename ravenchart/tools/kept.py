# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Results kept by the content that they are about, in folders of ``$XDG_CACHE_HOME/ravenchart``.

``~/.cache`` stands for that variable where it is not set. An entry that cannot be read is none.
The entries are trusted, so others must not be able to write there.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

from ravenchart.gen.diagnostics import Diagnostic, Severity
from ravenchart.gen.origins import Origin
from ravenchart.paths import PACKAGE, cache

KEPT = 400
"""Entries of a kind at most; the oldest go."""


def digest(parts: object) -> str:
    """A key: the SHA-256 over all that a result depends on."""
    return hashlib.sha256(json.dumps(parts).encode()).hexdigest()


def sources(*folders: str) -> list[tuple[str, str]]:
    """Name and SHA-256 of each module in these folders of the package: what a result is made by."""
    found = ((place, home) for home in folders for place in sorted(_modules(PACKAGE / home)))
    return [(os.path.relpath(place, PACKAGE), file_digest(place)) for place, _ in found]


def _modules(folder: str | Path) -> Iterator[str]:
    for entry in os.scandir(folder):
        if entry.name.endswith(".py"):
            yield entry.path
        elif entry.is_dir():
            yield from _modules(entry.path)


def file_digest(path: str | Path) -> str:
    """SHA-256 of a file's bytes, in hexadecimal."""
    with open(path, "rb", buffering=0) as file:
        return hashlib.sha256(file.read()).hexdigest()


def folder(kind: str) -> Path:
    """Where the entries of a kind are."""
    return cache() / kind


def load(kind: str, key: str) -> dict[str, object] | None:
    """An entry; None when there is none that can be read."""
    path = folder(kind) / f"{key}.json"
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    with suppress(OSError):
        path.touch()
    return found if isinstance(found, dict) else None


def store(kind: str, key: str, entry: dict[str, object]) -> None:
    """Keep an entry; where that is not possible, the work is done again next time."""
    home = folder(kind)
    with suppress(OSError):
        home.mkdir(parents=True, exist_ok=True)
        beside = home / f".{key}.{os.getpid()}"
        beside.write_text(json.dumps(entry), encoding="utf-8")
        beside.replace(home / f"{key}.json")
        entries = sorted(home.glob("*.json"), key=lambda path: path.stat().st_mtime)
        for old in entries[:-KEPT]:
            old.unlink()


# --- Diagnostics, as entries have them ---------------------------------------------


def listed(found: Diagnostic) -> list[object]:
    """A diagnostic as a list."""
    notes = [(_place(origin), text) for origin, text in found.notes]
    place = _place(found.origin)
    return [found.code, found.severity.value, place, found.message, notes, found.hint]


def _place(origin: Origin) -> list[object]:
    return [origin.file, origin.line, origin.column]


def diagnostic(entry: Any) -> Diagnostic:
    """The diagnostic of such a list; TypeError or ValueError where it is none."""
    code, severity, place, message, notes, hint = entry
    shown = tuple((Origin(*origin), text) for origin, text in notes)
    return Diagnostic(code, Severity(severity), Origin(*place), message, shown, hint)
