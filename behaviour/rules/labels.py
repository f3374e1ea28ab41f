# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Traces and valuations as text."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import z3

from ravenchart.behaviour.tree import ChartTree
from ravenchart.gen.language.quantities import shown
from ravenchart.gen.model.statechart import After, Every
from ravenchart.gen.origins import Origin

from . import logic
from .logic import Term, Variable
from .outcomes import Outcome
from .reach import Reachable
from .stepping import Configuration
from .threads import Edge, Thread

LONGEST = 12
"""Steps of a trace that are shown; of a longer trace, the last ones."""


def active_leaves(tree: ChartTree, configuration: Configuration) -> str:
    """The active leaves of a configuration."""
    if configuration.stopped:
        return "the end"
    leaves = [n for n in configuration.active if tree.states[n].is_leaf]
    return " + ".join(leaves) if leaves else "the start"


def step_label(tree: ChartTree, outcome: Outcome) -> str:
    """The reason for a step: an event, a time, or the transition that nothing triggers."""
    kind, subject = outcome.occurrence.kind, outcome.occurrence.subject
    if kind == "event":
        return subject
    if kind == "time":
        trigger = next(t.trigger for t in tree.region.transitions if t.name == subject)
        assert isinstance(trigger, After | Every)
        word = "after" if isinstance(trigger, After) else "every"
        return f"{word} {shown(trigger.delay)}"
    if kind == "done":
        return "done"
    return ", ".join(outcome.fired[:1]) or "completion"


def trace(tree: ChartTree, steps: Sequence[Edge]) -> str:
    """A way of a region: ``Idle -go-> Moving -done-> Idle``."""
    if not steps:
        return "the start"
    first = steps[0]
    text = (
        ""
        if not first.before.configuration.active
        else active_leaves(tree, first.before.configuration)
    )
    if len(steps) > LONGEST:
        text = "..."
    done = False
    for edge in steps[-LONGEST:]:
        if edge.outcome.occurrence.kind == "done":
            done = True
            continue
        target = active_leaves(tree, edge.after.configuration)
        word = "done" if done else step_label(tree, edge.outcome)
        text = target if not text else f"{text} -{word}-> {target}"
        done = False
    return text


def variables(term: Term, symbols: dict[Variable, Term]) -> list[Variable]:
    """The variables in a term, in the order declared."""
    used = logic.unknowns([term])
    return [name for name in symbols if name.unknown in used]


def valuation(reach: Reachable, model: Term, terms: Iterable[Term]) -> str:
    """The values of the variables of some terms: ``speed = 11, in(Motion.Moving)``."""
    shown_: list[str] = []
    conjunction = z3.And([*terms, z3.BoolVal(True)])
    for name in sorted(variables(conjunction, reach.symbols), key=list(reach.types).index):
        value = model.eval(reach.symbols[name], model_completion=True)
        said = logic.said(value, reach.types[name])
        if name[0] == "in":
            shown_.append(str(name) if z3.is_true(value) else f"not {name}")
        elif name[0] == "port state":
            shown_.append(f"{said}({name[1]})")
        else:
            shown_.append(f"{name} = {said}")
    return ", ".join(shown_)


def way_to(reach: Reachable, thread: Thread, edge: Edge) -> str:
    """The shortest way to the situation before a step, as a note."""
    way = reach.way(thread, edge.before)
    text = trace(thread.tree, way)
    return f"the way there: {text}" if len(way) > 1 else f"the way begins with {text}"


def begun_at(tree: ChartTree, outcome: Outcome) -> Origin:
    """The transition that a step begins with, or the region."""
    taken = outcome.fired[:1]
    found = (one.origin for one in tree.region.transitions if one.name in taken)
    return next(found, tree.region.origin)
