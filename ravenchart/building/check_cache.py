# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Earlier results of the rules of behaviour, kept by the content of the model (`kept`).

A key covers every file of the model, the sources of the tool, and the versions of Python and z3.
An unfinished result is kept with the effort that it was allowed.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from functools import cache
from importlib import metadata
from typing import Any

from ravenchart.behaviour.limits import UNFINISHED, Behaviour
from ravenchart.gen.model.safety import Fact, SafeRegion
from ravenchart.tools import kept

KIND = "checks"
FORMAT = 3
"""Part of each key: raised when what an entry holds changes."""
SOURCES = ("analysis", "behaviour", "gen")


@cache
def _tool() -> list[object]:
    """All that decides what is found in a model."""
    return [FORMAT, sys.version, metadata.version("z3-solver"), kept.sources(*SOURCES)]


def key(sources: Mapping[str, Sequence[str]]) -> str:
    """The key of a model, given the lines of its files by name."""
    return kept.digest([_tool(), sorted((name, list(text)) for name, text in sources.items())])


def load(key: str, effort: int, *, finished: bool) -> Behaviour | None:
    """The result that is kept; None without one.

    An unfinished one counts if it was allowed ``effort``, unless it must be ``finished``.
    """
    entry: Any = kept.load(KIND, key)
    try:
        found = tuple(kept.diagnostic(one) for one in entry["found"])
        is_open = any(one.code == UNFINISHED for one in found)
        safe = tuple(_safe(one) for one in entry["safe"])
        if is_open and (finished or entry["effort"] < effort):
            return None
        return Behaviour(found, safe)
    except (KeyError, TypeError, ValueError):
        return None


def store(key: str, effort: int, behaviour: Behaviour) -> None:
    """Keep what was found with so much work."""
    found = [kept.listed(one) for one in behaviour.found]
    safe = [asdict(one) for one in behaviour.safe]
    kept.store(KIND, key, {"effort": effort, "found": found, "safe": safe})


def _safe(entry: Any) -> SafeRegion:
    facts = (
        Fact(one["vertex"], one["data"], one["field"], tuple((a, b) for a, b in one["spans"]))
        for one in entry["facts"]
    )
    names = tuple(entry["invariants"])
    home = entry["component"], entry["region"]
    return SafeRegion(*home, names, tuple(facts), tuple(entry["alone"]))
