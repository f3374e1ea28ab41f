# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rule of eventless steps: completions and conditions that go on for ever.

A cycle of such steps is a livelock when one valuation of the data from outside the
region enables every step, and the region's own data are the same after the cycle.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice, pairwise, product

import networkx
import z3

from ravenchart.gen.diagnostics import Diagnostic, error, warning

from . import logic
from .labels import trace, valuation, way_to
from .logic import Term, Variable
from .reach import Reachable
from .threads import Edge, Situation, Thread

LONGEST_CYCLE = 8
"""Steps at most of a cycle that is checked."""
MOST_CYCLES = 200
"""Cycles at most that are checked in one group of nodes."""


def eventless_steps_end(reach: Reachable, thread: Thread) -> Iterator[Diagnostic]:
    """No cycle of completions and conditions goes on without a change from outside."""
    steps: dict[tuple[Situation, Situation], list[Edge]] = {}
    for edge in thread.edges:
        if edge.outcome.occurrence.kind in ("completion", "conditions") and edge.outcome.fired:
            steps.setdefault((edge.before, edge.after), []).append(edge)
    graph: networkx.DiGraph[Situation] = networkx.DiGraph()
    graph.add_edges_from(steps)
    told: set[str] = set()
    rank = {node: index for index, node in enumerate(thread.nodes)}
    groups = networkx.strongly_connected_components(graph)
    for group in sorted(groups, key=lambda nodes: min(rank[node] for node in nodes)):
        for cycle, data in _endless(reach, thread, graph.subgraph(group), steps, rank):
            names = [name for edge in cycle for name in edge.outcome.fired]
            if told & set(names):
                continue
            told |= set(names)
            yield _finding(reach, thread, cycle, data)


def _endless(
    reach: Reachable,
    thread: Thread,
    graph: networkx.DiGraph[Situation],
    steps: dict[tuple[Situation, Situation], list[Edge]],
    rank: dict[Situation, int],
) -> Iterator[tuple[Sequence[Edge], str]]:
    """The cycles that some data let go on, shortest first, each from its nearest node."""
    found = islice(networkx.simple_cycles(graph, LONGEST_CYCLE), MOST_CYCLES)
    cycles = [_turned(nodes, rank) for nodes in found]
    for nodes in sorted(cycles, key=lambda c: (len(c), [rank[node] for node in c])):
        ways = product(*(steps[pair] for pair in pairwise([*nodes, nodes[0]])))
        for cycle in islice(ways, MOST_CYCLES):
            reach.budget.count()
            terms = _goes_on(reach, thread, cycle)
            solver = logic.solver()
            solver.add(*reach.typed, *reach.of_others(thread), *terms)
            if reach.budget.ask(solver) == z3.sat:
                yield cycle, valuation(reach, solver.model(), [terms[-1]])
                break


def _turned(nodes: Sequence[Situation], rank: dict[Situation, int]) -> list[Situation]:
    start = min(range(len(nodes)), key=lambda index: rank[nodes[index]])
    return [*nodes[start:], *nodes[:start]]


def _goes_on(reach: Reachable, thread: Thread, cycle: Sequence[Edge]) -> list[Term]:
    """That the steps can be made one after the other and lead back to the same data."""
    store: dict[Variable, Term] = {}
    conditions = []
    for edge in cycle:
        pairs = [(reach.symbol(name), value) for name, value in store.items()]
        conditions.append(z3.substitute(edge.outcome.condition, *pairs))
        updates = {n: z3.substitute(value, *pairs) for n, value in edge.outcome.updates}
        store.update(updates)
    back = [value == reach.symbol(name) for name, value in store.items()]
    return [
        *reach.of_node(thread, cycle[0].before.cells),
        *back,
        z3.simplify(z3.And(conditions)),
    ]


def _finding(reach: Reachable, thread: Thread, cycle: Sequence[Edge], data: str) -> Diagnostic:
    region = thread.tree.region
    first = next(t for t in region.transitions if t.name == cycle[0].outcome.fired[0])
    starves = all(edge.outcome.occurrence.kind == "completion" for edge in cycle)
    circle = trace(thread.tree, cycle)
    told = f" with {data}" if data else ""
    message = f"livelock in {region.name}{told}: a cycle without event or time-out: {circle}"
    notes = [(first.origin, way_to(reach, thread, cycle[0]))]
    if starves:
        notes.append((region.origin, "completions come before events, so no event is ever taken"))
        hint = "let one of the transitions wait for an event or a time-out"
        return error("RV-1107", first.origin, message, notes=notes, hint=hint)
    hint = "let an effect end the condition, or use `every` where it shall be repeated"
    return warning("RV-1107", first.origin, message, notes=notes, hint=hint)
