"""Results kept by the content that they speak of, in folders of ``$XDG_CACHE_HOME/ravenchart``.

``~/.cache`` stands for that variable where it is not set. An entry that cannot be read is none.
Whoever can write there can lie.
"""

from __future__ import annotations

import hashlib
import json
import os
from contextlib import suppress
from pathlib import Path

from ravenchart.paths import cache

KEPT = 400
"""Entries of a kind at most; the oldest go."""


def digest(parts: object) -> str:
    """A key: the SHA-256 over all that a result depends on."""
    return hashlib.sha256(json.dumps(parts).encode()).hexdigest()


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
