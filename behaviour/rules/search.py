# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Search for a way from the start to a bad situation that some schedule really takes.

The search runs the regions and flows that matter together, one step at a time, in
every order. Data are terms over values from outside. A way that ends in a bad
situation counts when z3 finds a schedule for it (`timing`). A violation that is found
has a trace. A search that finds none proves nothing.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import z3

from ravenchart.behaviour.tree import CONDITIONS, START, Occurrence
from ravenchart.gen.language.terms import BOOLEAN, Reading
from ravenchart.gen.model.statechart import DONE, After, Every, Overflow, Transition
from ravenchart.gen.model.system import System
from ravenchart.gen.origins import Origin

from . import logic
from .labels import active_leaves, begun_at, step_label
from .logic import Term, Variable
from .outcomes import Outcome
from .outside import external_events
from .reach import Reachable
from .schedule import Rows
from .stepping import Configuration
from .threads import Thread
from .timing import TimedWay

MOST_SITUATIONS = 300
"""Situations that one search explores at most."""

OUTSIDE: Mapping[Variable, Term] = MappingProxyType({})
"""The value of an event from outside: any."""
NOTHING: Mapping[Variable, Term] = MappingProxyType({})
"""The value of an occurrence that is no event: none."""

Queued = tuple[str, tuple[tuple[str | None, Term], ...]]
"""An event that waits, with the value that it carries."""
Kept = tuple[Queued, bool]
"""A deferred event, and whether a state that defers it has been left since."""
Status = tuple[Configuration, tuple[Queued, ...], tuple[Kept, ...], frozenset[str]]
"""Of one thread: its control, its queue, its deferred events, and time-outs that were lost."""


@dataclass(frozen=True, slots=True, eq=False)
class Point:
    """A situation of all threads, and the way to it."""

    status: Mapping[str, Status]
    store: Mapping[Variable, Term]
    way: TimedWay
    conditions: tuple[Term, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class SearchMove:
    """A step of a thread, under a condition, and the situation that it leads to."""

    thread: str
    outcome: Outcome
    condition: Term
    point: Point
    raisers: tuple[str, ...]
    """Rows of which one must have run just before, because it raised the event."""


@dataclass(frozen=True, slots=True)
class Violation:
    """A feasible way to a bad situation, and the data that take it."""

    trace: str
    data: str
    origin: Origin
    """The transition of the last step, or its row."""


@dataclass
class WaySearch:
    """A breadth-first search for a situation of one instance in which ``bad`` holds."""

    reach: Reachable
    system: System
    instance: str
    rows: Rows
    bad: Term
    looked: int = 0

    def __post_init__(self) -> None:
        self.threads = _cone(self.reach, self.bad)
        self.names = {name.unknown: name for name in self.reach.types}
        self.readings: dict[str, tuple[Variable, int]] = {}
        """The unknowns for values from outside: what each is of, and the step that reads it."""
        self.external: dict[str, list[str | None]] = {}
        """Events from outside, with the rows that raise them."""
        for event, row in external_events(self.reach.component, self.system):
            self.external.setdefault(event, []).append(row)
        self.parameters = self.reach.parameters_of(self.instance)
        self.known: dict[int, tuple[Term, list[Variable]]] = {}
        self.counts: dict[tuple[str, str, int], Term] = {}

    @property
    def hindrance(self) -> str:
        """Why it looks at no situation; "" where it does."""
        for thread in self.threads:
            if thread.tree.region.steps_per_execution > 1:
                return f"{thread.name} makes several steps in an execution"
            row = f"{self.instance}.{thread.name}"
            if self.system.processor_of(row).released_by is not None:
                return f"nothing says how often {row} is released"
        return ""

    def violation(self) -> Violation | None:
        """The first violation found."""
        if self.hindrance:
            return None
        seen: set[str] = set()
        waiting = deque([self.start()])
        while waiting:
            point = waiting.popleft()
            wrong = self.at(point, self.bad, len(point.way.steps))
            if self.possible(point, wrong):
                model = point.way.model(wrong)
                if model is not None:
                    data = point.way.data(model, wrong)
                    return Violation(self.told(point.way), data, self._end(point.way))
            solver = logic.solver()
            solver.set("rlimit", 10 * logic.EFFORT)
            solver.add(*point.way.terms)
            for move in self.moves(point):
                key = _key(move.point)
                if key in seen:
                    continue
                self.looked += 1
                self.reach.budget.count()
                if self.looked > MOST_SITUATIONS:
                    return None
                way = point.way.extended(point, move)
                solver.push()
                solver.add(*way.added, *way.ending())
                if self.reach.budget.ask(solver) == z3.sat:
                    seen.add(key)
                    waiting.append(replace(move.point, way=way))
                solver.pop()
        return None

    def start(self) -> Point:
        """The situation before anything has run."""
        status = {}
        for thread in self.threads:
            is_region = thread.name in self.reach.published
            active = () if is_region else ("working",)
            status[thread.name] = (Configuration(active), (), (), frozenset[str]())
        return Point(status, dict(self.reach.initial), TimedWay(self))

    # --- terms

    def at(
        self,
        point: Point,
        term: Term,
        number: int,
        carried: Mapping[Variable, Term] = NOTHING,
    ) -> Term:
        """A term in a situation; its values from outside are those that step ``number`` reads."""
        if term.get_id() not in self.known:
            found = logic.unknowns([term])
            self.known[term.get_id()] = term, [self.names[name] for name in found]
        pairs = []
        for name in self.known[term.get_id()][1]:
            symbol = self.reach.symbol(name)
            if name in carried:
                pairs.append((symbol, carried[name]))
            elif name in self.parameters:
                pairs.append((symbol, self.parameters[name]))
            elif name[0] == "in":
                at = point.status[name[1]][0]
                tree = self.reach.thread(name[1]).tree
                active = tree.default if at == Configuration() else at.active
                pairs.append((symbol, z3.BoolVal(name[2] in active)))
            elif name in point.store and not self.is_outside(name):
                pairs.append((symbol, point.store[name]))
            else:
                pairs.append((symbol, self.read(name, number)))
        return z3.simplify(z3.substitute(term, *pairs)) if pairs else term

    def is_outside(self, name: Variable) -> bool:
        """Whether a body of the user's or a command writes the data."""
        return name[1] in self.reach.component.from_outside()

    def read(self, name: Variable, number: int) -> Term:
        """The unknown for a value from outside that a step reads."""
        text = f"{name.unknown}@{number}"
        self.readings[text] = name, number
        return logic.symbol(text, self.reach.types[name])

    def possible(self, point: Point, *conditions: Term) -> bool:
        """Whether some data from outside lead to a situation and meet conditions there."""
        asked = [c for c in conditions if not z3.is_true(c)]
        if any(z3.is_false(c) for c in asked):
            return False
        if not asked:
            return True
        solver = logic.solver()
        asked += point.conditions
        solver.add(*asked)
        for (name, _), term in self.outside_in(asked).items():
            solver.add(*self.typed(name, term))
        return bool(self.reach.budget.ask(solver) == z3.sat)

    def typed(self, name: Variable, term: Term) -> list[Term]:
        """That a value read from outside lies in its type."""
        type_ = self.reach.types[name]
        return [] if type_ == BOOLEAN else [logic.within(term, type_)]

    def outside_in(self, terms: Iterable[Term]) -> dict[tuple[Variable, int], Term]:
        """The values from outside in some terms, with the number of the step that read each."""
        named = logic.unknowns(terms).items()
        return {self.readings[text]: term for text, term in named if text in self.readings}

    # --- steps

    def moves(self, point: Point) -> Iterator[SearchMove]:
        """The situations one step further, still with the way to the situation before."""
        number = len(point.way.steps)
        for thread in self._turns(point):
            for occurrence, carried in self.occurrences(thread, point):
                for outcome in self.reach.steps(thread, point.status[thread.name][0], occurrence):
                    condition = self.at(point, outcome.condition, number, carried)
                    if outcome.stuck is None and not z3.is_false(condition):
                        after = self._after(point, thread, outcome, condition, carried)
                        rows = self._raisers(occurrence, carried)
                        yield SearchMove(thread.name, outcome, condition, after, rows)

    def _raisers(self, occurrence: Occurrence, carried: Mapping[Variable, Term]) -> tuple[str, ...]:
        """The rows that raise an event from outside; none when it comes at any time."""
        rows = self.external.get(occurrence.subject, []) if carried is OUTSIDE else []
        return () if None in rows else tuple(row for row in rows if row in self.rows)

    def _turns(self, point: Point) -> Iterator[Thread]:
        """The threads that may run next: first executions come in the order of their rows."""
        rows = self.rows
        new = [t for t in self.threads if point.status[t.name][0] == Configuration()]
        starts = sorted(new, key=lambda t: (rows[t.name].first, rows[t.name].turn))
        for thread in self.threads:
            row = rows[thread.name]
            if not starts or thread is starts[0]:
                yield thread
            elif thread not in new:
                again = row.period if thread.name in self.reach.published else 0
                next_ = rows[starts[0].name]
                if (row.first + again, row.turn) < (next_.first, next_.turn):
                    yield thread

    def _after(
        self,
        point: Point,
        thread: Thread,
        outcome: Outcome,
        condition: Term,
        carried: Mapping[Variable, Term],
    ) -> Point:
        number = len(point.way.steps)
        store = dict(point.store)
        for name, term in outcome.updates:
            store[name] = self.at(point, term, number, carried)
        status = dict(point.status)
        status[thread.name] = self._taken(thread, point.status[thread.name], outcome, carried)
        for event, values in outcome.raised:
            given = tuple((f, self.at(point, t, number, carried)) for f, t in values)
            self._deliver(status, thread, event, given)
        conditions = point.conditions if z3.is_true(condition) else (*point.conditions, condition)
        return Point(status, store, point.way, conditions)

    def _taken(
        self,
        thread: Thread,
        before: Status,
        outcome: Outcome,
        carried: Mapping[Variable, Term],
    ) -> Status:
        """The status of the thread that has made the step."""
        at, queue, kept, lost = before
        kind, subject = outcome.occurrence.kind, outcome.occurrence.subject
        if kind == "event":
            ready = self.released(thread, at, kept)
            if ready is not None:
                kept = kept[:ready] + kept[ready + 1 :]
            elif queue and queue[0][0] == subject and carried is not OUTSIDE:
                queue = queue[1:]
            if outcome.deferred and len(kept) < thread.tree.region.deferral_depth:
                values = tuple((name[2], v) for name, v in carried.items())
                kept = (*kept, ((subject, values), False))
        states = thread.tree.states
        freed = {event for name in outcome.left for event in states[name].defers}
        kept = tuple((queued, free or queued[0] in freed) for queued, free in kept)
        lost = frozenset(n for n in lost if thread.tree.source_of(n) not in outcome.entered)
        if kind == "time" and not outcome.fired:
            trigger = self.timed(thread.name).get(subject)
            if trigger is not None and isinstance(trigger.trigger, After):
                lost |= {subject}
        return outcome.after, queue, kept, lost

    def timed(self, thread: str) -> dict[str, Transition]:
        """The transitions of a region that time triggers, by name."""
        if thread not in self.reach.published:
            return {}
        transitions = self.reach.thread(thread).tree.region.transitions
        return {t.name: t for t in transitions if isinstance(t.trigger, After | Every)}

    def _deliver(
        self,
        status: dict[str, Status],
        thread: Thread,
        event: str,
        values: tuple[tuple[str | None, Term], ...],
    ) -> None:
        """Put a raised event into the queue of each region that names it."""
        if event == DONE:
            activity = next(a for a in self.reach.component.activities if a.name == thread.name)
            assert activity.while_in is not None
            region, state = activity.while_in.region, activity.while_in.state
            if region in status and state in status[region][0].active:
                at, *rest = status[region]
                tree = self.reach.thread(region).tree
                if state not in at.done and state in tree.completing:
                    (done,) = self.reach.steps(
                        self.reach.thread(region), at, Occurrence("done", state)
                    )
                    status[region] = (done.after, *rest)  # type: ignore[assignment]
            return
        own = {e.name: e.overflow for e in self.reach.component.events}
        for other in self.threads:
            region_ = other.tree.region
            if event in region_.events():
                at, queue, kept, lost = status[other.name]
                if len(queue) < region_.queue_depth:
                    queue = (*queue, (event, values))
                elif (own[event] or region_.overflow) is Overflow.DROP_OLDEST:
                    queue = (*queue[1:], (event, values))
                status[other.name] = (at, queue, kept, lost)

    def released(self, thread: Thread, at: Configuration, kept: tuple[Kept, ...]) -> int | None:
        """The index of the oldest deferred event that is due."""
        for index, ((event, _), free) in enumerate(kept):
            if free or not any(event in thread.tree.states[name].defers for name in at.active):
                return index
        return None

    def occurrences(
        self, thread: Thread, point: Point
    ) -> Iterator[tuple[Occurrence, Mapping[Variable, Term]]]:
        """The occurrences that a thread's next step may be made for, with their values."""
        at, queue, kept, lost = point.status[thread.name]
        if at.stopped:
            return
        if at == Configuration():
            yield START, NOTHING
            return
        if at.pending:
            yield Occurrence("completion", at.pending[0]), NOTHING
            return
        tree = thread.tree
        triggers = [t for name in at.active for t in tree.outgoing[name]]
        for transition in triggers:
            if isinstance(transition.trigger, After | Every) and transition.name not in lost:
                yield Occurrence("time", transition.name), NOTHING
        ready = self.released(thread, at, kept)
        waits: Queued | None = kept[ready][0] if ready is not None else queue[0] if queue else None
        if waits is not None:
            event, values = waits
            carried = {logic.variable(Reading.EVENT, event, f): term for f, term in values}
            yield Occurrence("event", event), carried
        else:
            for event in tree.region.events():
                if event in self.external:
                    yield Occurrence("event", event), OUTSIDE
            yield CONDITIONS, NOTHING

    # --- words

    def _end(self, way: TimedWay) -> Origin:
        """The transition that the last step begins with, or the row; without one the component."""
        if not way.steps:
            return self.reach.component.origin
        last = way.steps[-1]
        return begun_at(self.reach.thread(last.thread).tree, last.outcome)

    def told(self, way: TimedWay) -> str:
        """A way as text: each step, with its region when there are several."""
        several = len({made.thread for made in way.steps}) > 1
        parts: list[str] = []
        last: str | None = None
        at: dict[str, str] = {}
        for made in way.steps:
            tree = self.reach.thread(made.thread).tree
            to = active_leaves(tree, made.outcome.after)
            if made.thread not in self.reach.published:
                parts.append(f"{made.thread} runs")
            elif made.outcome.occurrence == START:
                parts.append(f"{made.thread}: {to}" if several else to)
            elif last == made.thread and made.thread in at:
                parts[-1] += f" -{step_label(tree, made.outcome)}-> {to}"
            else:
                head = f"{made.thread}: " if several else ""
                parts.append(f"{head}{at[made.thread]} -{step_label(tree, made.outcome)}-> {to}")
            at[made.thread] = to
            last = made.thread
        return "; ".join(parts) if parts else "at the start"


def _key(point: Point) -> str:
    """A key that is equal for situations that differ only in the numbers of their reads."""
    values = [term for _, term in sorted(point.store.items(), key=lambda item: str(item[0]))]
    waiting = [q for s in point.status.values() for q in (*s[1], *(kept for kept, _ in s[2]))]
    queued = [t for q in waiting for _, t in q[1]]
    held = {*logic.unknowns((*values, *queued))}
    relevant: list[Term] = []
    rest = list(point.conditions)
    grown = bool(held)
    while grown:
        grown = False
        for condition in list(rest):
            used = {*logic.unknowns([condition])}
            if used & held:
                held |= used
                relevant.append(condition)
                rest.remove(condition)
                grown = True
    control = [
        (name, s[0], [q[0] for q in s[1]], [(q[0], free) for q, free in s[2]], sorted(s[3]))
        for name, s in point.status.items()
    ]
    terms = [term.sexpr() for term in (*values, *queued)] + sorted(c.sexpr() for c in relevant)
    numbers: dict[str, str] = {}
    text = re.sub(
        r"@\d+", lambda found: numbers.setdefault(found[0], f"@{len(numbers)}"), "\n".join(terms)
    )
    return f"{control}\n{text}"


def _cone(reach: Reachable, bad: Term) -> list[Thread]:
    """The threads that a term may depend on."""
    wanted: set[str] = set()
    asked = [bad]
    events: set[str] = set()
    while True:
        used = logic.unknowns(asked)
        names = [name for name in reach.symbols if name.unknown in used]
        found = [
            thread
            for thread in reach.threads
            if thread.name in {n[1] for n in names if n[0] == "in"}
            or {n[1] for n in names if n[0] == "data"} & {*thread.tree.region.writes}
            or events & {*thread.tree.region.raises}
            or any(f"{r}.{s}.{DONE}" in events for r, s in reach.completes(thread))
        ]
        if {t.name for t in found} <= wanted:
            return [t for t in reach.threads if t.name in wanted]
        wanted |= {t.name for t in found}
        for thread in found:
            for made in thread.steps.values():
                for outcome in made:
                    asked += [outcome.condition, *(v for _, v in outcome.updates)]
            events |= set(thread.tree.region.events())
            events |= {f"{thread.name}.{s}.{DONE}" for s in thread.tree.working}
