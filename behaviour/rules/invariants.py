# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rules of declared invariants: proved, violated with a trace, or not inductive.

An invariant is proved when the reachable nodes of the threads exclude it, or when
it holds at the start and no step of any thread breaks it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import z3

from ravenchart.gen.diagnostics import Diagnostic, error, warning
from ravenchart.gen.language.terms import ScalarType
from ravenchart.gen.model.component import Invariant
from ravenchart.gen.model.system import System
from ravenchart.gen.origins import Origin

from . import logic
from .budget import Exhausted
from .labels import active_leaves, begun_at, step_label, valuation
from .logic import Term, Variable
from .reach import Reachable
from .schedule import in_one_table, schedules
from .search import Violation, WaySearch
from .stepping import Configuration
from .threads import Edge, Thread

VIOLATED = "RV-1108"
NOT_PROVED = "RV-1109"

Pairs = Sequence[tuple[Term, Term]]
"""A substitution: each term with its replacement."""


@dataclass(frozen=True, slots=True)
class OpenInvariant:
    """An invariant that is violated, or that a step may violate as far as its proof can tell."""

    invariant: Invariant
    broken: Broken
    """The step at which the proof ends."""
    violation: Violation | None
    """A way from the start to a situation that violates it, where one was found."""
    looked: int
    """How many situations were searched for such a way."""
    hindrance: str = ""
    """Why none was searched; "" where that was for want of time."""


def invariants_hold(reach: Reachable, system: System) -> Iterator[Diagnostic]:
    """Each declared invariant holds in every reachable situation."""
    for one in open_invariants(reach, system):
        if one.violation is None:
            yield _not_inductive(one)
        else:
            yield _violated(reach, one.invariant, one.violation)


def open_invariants(reach: Reachable, system: System) -> Iterator[OpenInvariant]:
    """The invariants of the component that are not proved; `Exhausted` behind the last one."""
    for invariant in reach.component.invariants:
        bad = logic.term(invariant.condition, reach.symbol)
        if _is_excluded(reach, bad):
            continue
        broken = _breaking_step(reach, system, bad)
        if broken is None:
            continue
        searches = [
            WaySearch(reach, system, instance, rows, bad)
            for instance, rows in schedules(system, reach.component)
        ]
        try:
            violation = next((v for v in map(WaySearch.violation, searches) if v), None)
        except Exhausted:
            yield OpenInvariant(invariant, broken, None, sum(search.looked for search in searches))
            raise
        looked = sum(search.looked for search in searches)
        why = next((search.hindrance for search in searches if search.hindrance), "")
        yield OpenInvariant(invariant, broken, violation, looked, "" if looked else why)


# --- Proof ---------------------------------------------------------------------------


def _is_excluded(reach: Reachable, bad: Term) -> bool:
    """Whether no combination of reachable nodes is bad."""
    solver = logic.solver()
    solver.add(*reach.typed, bad)
    solver.add(*(_somewhere(reach, thread) for thread in reach.threads))
    solver.add(*_written_by_users(reach))
    return bool(reach.budget.ask(solver) == z3.unsat)


def _somewhere(reach: Reachable, thread: Thread) -> Term:
    """That a thread is in one of its nodes."""
    if thread.parts is not None:
        at = {n.configuration.active or thread.tree.default for n in thread.nodes}
        return reach.is_published(thread.name, sorted(at))
    cases: dict[str, Term] = {}
    for node in thread.nodes:
        case = _states(reach, thread, node.configuration)
        made = z3.And([*case, *reach.of_node(thread, node.cells)])
        cases.setdefault(made.sexpr(), made)
    return z3.Or(list(cases.values()))


def _states(reach: Reachable, thread: Thread, at: Configuration) -> list[Term]:
    """The states that a thread publishes in a configuration, as far as they are asked for."""
    active = thread.tree.default if at == Configuration() else at.active
    asked = _asked(reach, thread, active)
    return [
        reach.symbol(name) if name[2] in active else z3.Not(reach.symbol(name)) for name in asked
    ]


def _asked(reach: Reachable, thread: Thread, active: tuple[str, ...]) -> list[Variable]:
    """The states of a thread that are asked for and that ``active`` determines."""
    asked = [n for n in reach.symbols if n[0] == "in" and n[1] == thread.name]
    if thread.parts is None:
        return asked
    return [name for name in asked if thread.tree.determines(active, name.state)]


def _written_by_users(reach: Reachable) -> list[Term]:
    owned = {name for thread in reach.threads for name in thread.own}
    return [
        z3.Or([reach.in_cell(name, reach.symbol(name), cell) for cell in sorted(cells)])
        for name, cells in reach.values.items()
        if name not in owned
    ]


@dataclass(frozen=True, slots=True)
class Broken:
    """A step that breaks an invariant, where it stands, and data with which it does."""

    step: str
    origin: Origin
    data: str


def _breaking_step(reach: Reachable, system: System, bad: Term) -> Broken | None:
    """The first step from a situation that keeps the invariant to one that does not."""
    if _possible(reach, [_substituted(bad, _start(reach))]) is not None:
        return Broken(f"the start of {reach.component.name}", reach.component.origin, "")
    nodes = {t.name: _somewhere(reach, t) for t in reach.threads}
    before = [z3.Not(bad), *_written_by_users(reach)]
    for writer, origin, written in _inputs(reach):
        pairs = [(reach.symbol(n), logic.symbol(f"new {n}", reach.types[n])) for n in written]
        after = _substituted(bad, pairs)
        if after.eq(bad):
            continue
        typed = [
            logic.within(new, reach.types[n]) for n, (_, new) in zip(written, pairs, strict=True)
        ]
        model = _possible(reach, [*before, *nodes.values(), *typed, after])
        if model is not None:
            return Broken(
                f"{writer}, which may write anything", origin, valuation(reach, model, [bad])
            )
    for thread in reach.threads:
        others = [term for name, term in nodes.items() if name != thread.name]
        stale = _stale(reach, system, thread)
        old = [*reach.typed, *reach.of_others(thread)]
        given = [*before, *others, *(_substituted(term, stale) for term in old)]
        for edge in _distinct(thread):
            reach.budget.count()
            after = _substituted(bad, _after(reach, thread, edge, stale))
            condition = _substituted(_lasting(reach, thread, edge.outcome.condition), stale)
            here = _states(reach, thread, edge.outcome.before)
            here += reach.of_node(thread, edge.before.cells)
            model = _possible(reach, [*given, *here, condition, after])
            if model is not None:
                data = valuation(reach, model, (bad, edge.outcome.condition))
                return Broken(_step(thread, edge), begun_at(thread.tree, edge.outcome), data)
    return None


def _possible(reach: Reachable, terms: Sequence[Term]) -> Term | None:
    """A model of some terms; None when there is none."""
    if any(map(z3.is_false, terms)):
        return None
    solver = logic.solver()
    solver.add(*reach.typed, *terms)
    answer = reach.budget.ask(solver)
    if answer == z3.unsat:
        return None
    return solver.model() if answer == z3.sat else z3.Model(z3.main_ctx())


def _substituted(term: Term, pairs: Pairs) -> Term:
    return z3.simplify(z3.substitute(term, *pairs))


def _start(reach: Reachable) -> Pairs:
    """Every variable as it is before anything has run."""
    trees = {thread.name: thread.tree for thread in reach.threads}
    pairs = [
        (reach.symbol(n), z3.BoolVal(n[2] in trees[n[1]].default))
        for n in reach.symbols
        if n[0] == "in"
    ]
    return [*pairs, *((reach.symbol(name), value) for name, value in reach.initial.items())]


def _inputs(reach: Reachable) -> Iterator[tuple[str, Origin, list[Variable]]]:
    """The writers without a flow: each port's handler, each body of the user's, each command."""
    for port in reach.component.inputs():
        names = [n for n in reach.types if n[0] in ("port", "port state") and n[1] == port.name]
        yield f"the port {port.name}", port.origin, names
    for activity in reach.component.activities:
        if activity.flow is None:
            names = [n for n in reach.types if n[0] == "data" and n[1] in activity.writes]
            yield f"the body of {activity.name}", activity.origin, names
    for data in reach.component.data:
        if data.is_command:
            names = [n for n in reach.types if n[0] == "data" and n[1] == data.name]
            yield f"the command {data.name}", data.origin, names


def _distinct(thread: Thread) -> Iterator[Edge]:
    """One edge for each step from each node."""
    yield from {(id(e.outcome), e.before): e for e in reversed(thread.edges)}.values()


def _stale(reach: Reachable, system: System, thread: Thread) -> Pairs:
    """Copies of variables that a thread may have read before another processor wrote them."""
    component = reach.component
    rows = {r.name: r for r in component.runnables()}
    known = (*rows, *component.handlers())
    beside = {name for name in known if in_one_table(system, component, thread.name, name)}
    old = []
    for name, type_ in reach.types.items():
        if name[0] == "in" and name not in reach.symbols:
            continue
        writers = [r.name for r in rows.values() if name[1] in r.writes or name[1] == r.name]
        writers += [component.handler(name[1])] if name[0] in ("port", "port state") else []
        if any(writer not in beside for writer in writers):
            old.append((reach.symbol(name), logic.symbol(f"old {name}", type_)))
    return old


def _written(reach: Reachable, thread: Thread) -> list[tuple[Variable, ScalarType]]:
    """The data of a thread, with their types."""
    writes = thread.tree.region.writes
    return [(n, t) for n, t in reach.types.items() if n[0] == "data" and n[1] in writes]


def _lasting(reach: Reachable, thread: Thread, condition: Term) -> Term:
    """The part of a step's condition that holds until its end. Where regions are explored one by
    one, another one may have set the chart's data: conditions on these data are left out."""
    if thread.parts is None:
        return condition
    own = {name.unknown for name, _ in _written(reach, thread)}
    asked = condition.children() if z3.is_and(condition) else [condition]
    return z3.And([one for one in asked if not own & {*logic.unknowns([one])}])


def _after(reach: Reachable, thread: Thread, edge: Edge, stale: Pairs) -> Pairs:
    """The states and data that a step changes, each with its value after the step."""
    active = edge.outcome.after.active
    states = [
        (reach.symbol(name), z3.BoolVal(name[2] in active))
        for name in _asked(reach, thread, active)
    ]
    if thread.parts is not None:
        written = _written(reach, thread)
        return [*states, *((reach.symbol(n), logic.symbol(f"new {n}", t)) for n, t in written)]
    data = [(reach.symbol(n), _substituted(value, stale)) for n, value in edge.outcome.updates]
    return [*states, *data]


# --- Words ---------------------------------------------------------------------------


def _step(thread: Thread, edge: Edge) -> str:
    at, to = (active_leaves(thread.tree, n.configuration) for n in (edge.before, edge.after))
    return f"{thread.name}: {at} -{step_label(thread.tree, edge.outcome)}-> {to}"


def _violated(reach: Reachable, invariant: Invariant, found: Violation) -> Diagnostic:
    message = f"the invariant {invariant.name} of {reach.component.name} is violated: {found.trace}"
    notes = [(invariant.origin, f"then {found.data}")] if found.data else []
    return error(VIOLATED, invariant.origin, message, notes=notes)


def _not_inductive(one: OpenInvariant) -> Diagnostic:
    invariant, broken = one.invariant, one.broken
    message = f"the invariant {invariant.name} is not proved: {broken.step} may violate it"
    data = f"when {broken.data}" if broken.data else "whatever the data"
    notes = [(broken.origin, f"the step violates it {data}")]
    hint = f"{search_in_words(one)}; exclude it by a guard, or say more in the condition of `never`"
    return warning(NOT_PROVED, invariant.origin, message, notes=notes, hint=hint)


def search_in_words(one: OpenInvariant) -> str:
    """The search for a way from the start to a situation that violates it."""
    if one.hindrance:
        return f"{one.hindrance}, so no way from the start to it was looked for"
    if not one.looked:
        return "there was no time left to look for a way from the start to it"
    return f"no way from the start to it was found among {one.looked} situations"
