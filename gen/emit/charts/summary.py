# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The declared chart for a reader: a line of text for each of its transitions."""

from __future__ import annotations

from ravenchart.gen.emit.language.compound import Firing, FiringKind
from ravenchart.gen.model.notation import shown_expression, trigger
from ravenchart.gen.model.statechart import Completion, OnEvent


def summary(firing: Firing) -> str:
    """Name, source and target, trigger and guard, such as ``go: Idle -> Busy on Go [left > 0]``."""
    sources = " and ".join(firing.sources)
    match firing.kind:
        case FiringKind.MOVE:
            way = f"{sources} -> {firing.goal or _unnamed(firing)}"
        case FiringKind.INTERNAL:
            way = f"in {sources}"
        case FiringKind.DEFERRAL:
            way = f"{sources} defers"
        case FiringKind.RESTORE:
            way = f"{sources} -> the remembered state"
    guards = " and ".join(map(shown_expression, firing.guards))
    return f"{firing.name}: {way}{_trigger(firing)}" + (f" [{guards}]" if guards else "")


def _unnamed(firing: Firing) -> str:
    """The target of a history without memory, or of a fork."""
    return "several regions" if firing.vertex is None else "the default state"


def _trigger(firing: Firing) -> str:
    found: list[str] = []
    for one in firing.triggers:
        match one:
            case str(event):
                found.append(event)
            case OnEvent() | Completion():
                found.append(f"on {trigger(one) or 'completion'}")
            case _:
                found.append(trigger(one))
    words = " or ".join(filter(None, found))
    return f" {words}" if words else ""
