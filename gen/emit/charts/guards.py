# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""All guards of a chart, all its flows, and which operators the guards use."""

from __future__ import annotations

from ravenchart.gen.emit.ada.named import DottedName
from ravenchart.gen.emit.language.terms import operators_in
from ravenchart.gen.language import terms as m
from ravenchart.gen.model.statechart import Region, When


def guards_of(region: Region) -> list[m.Expression]:
    """All guards and conditions."""
    guards = [t.guard for t in region.transitions if t.guard is not None]
    return guards + [t.trigger.condition for t in region.transitions if isinstance(t.trigger, When)]


def flows_of(region: Region) -> list[m.Flow]:
    """All behaviours: effects, initial effects, entries, exits."""
    flows = [t.effect for t in region.transitions]
    flows += [flow for s in region.states for flow in (s.entry, s.exit)]
    flows += [r.initial.effect for s in region.states for r in s.regions]
    return [*flows, region.initial.effect]


def guard_operators(region: Region) -> set[DottedName]:
    """The runtime's types whose operators its guards use."""
    return {name for guard in guards_of(region) for name in operators_in(guard)}
