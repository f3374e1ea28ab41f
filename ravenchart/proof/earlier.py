# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Results of earlier proofs, kept by the content that they are about.

A key is the SHA-256 over gnatprove's version, the run's settings, and the name and code of every
file that it may read: other code, another tool or switch is another key. Comments and layout are
no code (`code`). Entries are in `kept`; one that cannot be read is proved again. The entries are
trusted: see ASM-016 in proofs/assumptions.md.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ravenchart.paths import ROOT
from ravenchart.tools import kept

from . import code
from .spark_results import Entity, Outside, Results, named_outside

if TYPE_CHECKING:
    from .proving import ProofTask

FORMAT = 3
"""Part of each key: raised when what an entry holds changes."""
KIND = "proofs"


def key(version: str, task: ProofTask, inputs: Iterable[Path]) -> str:
    """A digest of all that the results depend on; the folder of the objects is no part of it."""
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
        sorted((_place(path, base), code.digest(path.read_bytes())) for path in inputs),
    ]
    return kept.digest(parts)


def _place(path: Path, base: Path) -> str:
    """The same for the same file in another checkout or another place of the model."""
    return os.path.relpath(path, ROOT if path.is_relative_to(ROOT) else base)


def load(key: str) -> Results | None:
    """The results of an earlier run; None when there are none that can be read."""
    found: Any = kept.load(KIND, key)
    try:
        return Results(
            found["checks"],
            found["justified"],
            (),
            found["assumed"],
            tuple(_outside(o["name"], o["location"]) for o in found["outside"]),
            frozenset(found["files"]),
            tuple(Entity(e["path"], e["checks"], tuple(e["provers"])) for e in found["entities"]),
        )
    except (KeyError, TypeError):
        return None


def _outside(name: str, location: str) -> Outside:
    """With the file alone: comments that were edited since may have moved the line."""
    return named_outside(name, location.partition(":")[0])


def store(key: str, results: Results) -> None:
    """Keep the results; where that is not possible, the next proof is a run again."""
    kept.store(KIND, key, {**asdict(results), "files": sorted(results.files)})
