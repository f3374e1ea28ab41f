"""Results of earlier proofs, kept by the content that they speak of.

A key is the SHA-256 over gnatprove's version, the run's settings, and the name and bytes of every
file that it may read: another byte, tool or switch is another key. The folder is
``$XDG_CACHE_HOME/ravenchart/proofs`` (``~/.cache`` where that is not set). An entry that cannot be
read is proved again. Whoever can write there can lie: see ASM-016 in proofs/assumptions.md.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from .spark_results import Entity, Outside, Results
from .toolchain import ROOT

if TYPE_CHECKING:
    from .proving import Task

FORMAT = 1
"""Part of each key: raised when what an entry holds changes."""
KEPT = 400
"""Entries at most; the oldest go."""


def folder() -> Path:
    """Where the entries are."""
    home = os.environ.get("XDG_CACHE_HOME") or "~/.cache"
    return Path(home).expanduser() / "ravenchart" / "proofs"


def key(version: str, task: Task, inputs: Mapping[Path, str]) -> str:
    """What the results depend on, as one digest; where objects go is no part of it."""
    scenario = {n: v for n, v in sorted(task.scenario.items()) if n != "RAVENCHART_BUILD"}
    base = task.project.resolve().parent
    parts = [
        FORMAT,
        version,
        task.project.name,
        scenario,
        task.warnings,
        task.whole,
        sorted(task.units),
        sorted((_place(path, base), digest) for path, digest in inputs.items()),
    ]
    return hashlib.sha256(json.dumps(parts).encode()).hexdigest()


def _place(path: Path, base: Path) -> str:
    """The same for the same file in another checkout or another place of the model."""
    return os.path.relpath(path, ROOT if path.is_relative_to(ROOT) else base)


def load(key: str) -> Results | None:
    """The results of an earlier run; None when there are none that can be read."""
    path = folder() / f"{key}.json"
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        results = Results(
            found["checks"],
            found["justified"],
            found["unproved"],
            found["assumed"],
            tuple(Outside(**o) for o in found["outside"]),
            frozenset(found["files"]),
            tuple(Entity(e["path"], e["checks"], tuple(e["provers"])) for e in found["entities"]),
        )
    except (OSError, ValueError, KeyError, TypeError):
        return None
    with suppress(OSError):
        path.touch()
    return results


def store(key: str, results: Results) -> None:
    """Keep the results; where that is not possible, the next proof is a run again."""
    found = {**asdict(results), "files": sorted(results.files)}
    home = folder()
    with suppress(OSError):
        home.mkdir(parents=True, exist_ok=True)
        beside = home / f".{key}.{os.getpid()}"
        beside.write_text(json.dumps(found), encoding="utf-8")
        beside.replace(home / f"{key}.json")
        entries = sorted(home.glob("*.json"), key=lambda path: path.stat().st_mtime)
        for old in entries[:-KEPT]:
            old.unlink()
