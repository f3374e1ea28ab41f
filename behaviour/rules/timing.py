# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Whether a schedule takes a way: the path formula of a search's steps.

Each step happens in some execution of its row. The executions that are not on the
way must have had nothing to do. Time-outs count executions. Values from
outside change only when the port region or the user's body runs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import z3

from ravenchart.behaviour.tree import CONDITIONS, START, Occurrence
from ravenchart.gen.model.statechart import After, Every

from . import logic
from .logic import PORT_STATES, Term, Variable
from .outcomes import Outcome
from .schedule import RowReleases
from .stepping import Configuration

if TYPE_CHECKING:
    from .search import Point, SearchMove, WaySearch


@dataclass(frozen=True, slots=True, eq=False)
class TimedStep:
    """A step on a way, and the execution of its row in which it is made."""

    thread: str
    outcome: Outcome
    row: RowReleases
    execution: Term
    moment: Term
    """When it is made, in ns."""
    number: int


@dataclass(frozen=True, slots=True, eq=False)
class TimedWay:
    """Steps from the start, and the terms that a schedule must meet to make them."""

    search: WaySearch
    steps: tuple[TimedStep, ...] = ()
    terms: tuple[Term, ...] = ()
    added: tuple[Term, ...] = ()
    """The terms that the last step has added."""
    due: Mapping[str, Mapping[str, Term]] = field(default_factory=dict)
    """The running time-outs of each thread, each with the execution in which it is due."""
    latest: Mapping[str, int] = field(default_factory=dict)
    """The latest step of each thread."""
    reads: tuple[tuple[Variable, Term, Term], ...] = ()
    """Values from outside, each with how often its writer has run before."""

    def extended(self, before: Point, move: SearchMove) -> TimedWay:
        """The way with one step more, made in a situation."""
        thread, outcome, condition = move.thread, move.outcome, move.condition
        index = len(self.steps)
        row, execution = self.search.rows[thread], z3.Int(f"execution#{index}")
        made = TimedStep(thread, outcome, row, execution, row.moment(execution), index)
        steps = (*self.steps, made)
        new = [made.execution >= 0, condition]
        if outcome.occurrence == START:
            new.append(made.execution == 0)
        if self.steps:
            one = self.steps[-1]
            later = one.row.turn < made.row.turn
            new.append(one.moment <= made.moment if later else one.moment < made.moment)
        if move.raisers:
            new.append(z3.Or([self._just_raised(made, name) for name in move.raisers]))
        reads = [*self.reads]
        for other in self.search.threads:
            new += self._waits(before, other.name, made, reads)
        timers, due = self._timers(made, index)
        new += timers
        for (name, _), symbol in self.search.outside_in([condition]).items():
            new += self.search.typed(name, symbol)
            new += self._read(reads, name, symbol, made.moment, made.row.turn)
        added = tuple(term for term in new if not z3.is_true(term))
        return TimedWay(
            self.search,
            steps,
            (*self.terms, *added),
            added,
            {**self.due, thread: due},
            {**self.latest, thread: index},
            tuple(reads),
        )

    def ending(self) -> list[Term]:
        """That nothing was due after the last steps of the threads, and before the end."""
        terms: list[Term] = []
        for thread, due in self.due.items():
            if due:
                last = self._before(thread, self.steps[-1]) - 1
                idle = last > self.steps[self.latest[thread]].execution
                terms += [z3.Implies(idle, at > last) for at in due.values()]
        return terms

    def model(self, bad: Term) -> Term | None:
        """Data and times with which the way is taken and ends in a bad situation."""
        reads = [*self.reads]
        terms = [*self.terms, *self.ending(), bad]
        for (name, _), symbol in self.search.outside_in([bad]).items():
            terms += self.search.typed(name, symbol)
            if self.steps:
                end = self.steps[-1]
                terms += self._read(reads, name, symbol, end.moment, end.row.turn)
        solver = logic.solver()
        solver.set("rlimit", 10 * logic.EFFORT)
        solver.add(*terms)
        return solver.model() if solver.check() == z3.sat else None

    def data(self, model: Term, bad: Term) -> str:
        """The values from outside that decide, as text."""
        found = []
        read = self.search.outside_in([*self.terms, bad])
        for (name, number), symbol in sorted(read.items(), key=lambda item: item[0][1]):
            if number > len(self.steps):
                continue
            type_ = self.search.reach.types[name]
            value = logic.said(model.eval(symbol, model_completion=True), type_)
            said = f"{value}({name[1]})" if name[0] == "port state" else f"{name} = {value}"
            when = "then" if number == len(self.steps) else f"in step {number + 1}"
            found.append(f"{said} {when}")
        return ", ".join(found)

    # --- executions without a step

    def _before(self, name: str, made: TimedStep) -> Term:
        """How many executions of a row come before that of a step."""
        if made.thread == name:
            return made.execution
        key = (name, made.thread, made.number)
        if key not in self.search.counts:
            row = self.search.rows[name]
            self.search.counts[key] = row.executions_before(made.moment, made.row.turn)
        return self.search.counts[key]

    def _just_raised(self, made: TimedStep, name: str) -> Term:
        """That a row has run since the execution before a step, so that it may raise its event."""
        raiser = self.search.rows[name]
        moment = made.row.moment(made.execution - 1)
        earlier = raiser.executions_before(moment, made.row.turn)
        return self._before(name, made) > earlier

    def _waits(
        self, here: Point, name: str, made: TimedStep, reads: list[tuple[Variable, Term, Term]]
    ) -> list[Term]:
        """Where a row runs between the last step and the next, it has nothing to do."""
        number = 1_000 * (len(self.steps) + 1) + list(self.search.rows).index(name)
        waits = self._can_wait(name, here, number)
        if z3.is_true(waits):
            return []
        first: Term = z3.IntVal(0)
        if self.steps:
            own = self.steps[-1].thread == name
            first = self._before(name, self.steps[-1]) + (1 if own else 0)
        last = self._before(name, made) - 1
        terms = [z3.Implies(first <= last, waits)]
        row = self.search.rows[name]
        for (variable, _), symbol in self.search.outside_in([waits]).items():
            terms += self.search.typed(variable, symbol)
            for execution in (first, last):
                terms += self._read(reads, variable, symbol, row.moment(execution), row.turn)
        return terms

    def _can_wait(self, name: str, here: Point, number: int) -> Term:
        """That an execution of a thread has no effect."""
        search = self.search
        thread = search.reach.thread(name)
        at, queue, kept, _ = here.status[name]
        is_region = name in search.reach.published
        if at.stopped:
            return z3.BoolVal(True)
        if at == Configuration() or at.pending or queue:
            return z3.BoolVal(False)
        if search.released(thread, at, kept) is not None:
            return z3.BoolVal(False)
        cases = []
        occurrence = CONDITIONS if is_region else Occurrence("time", "run")
        for outcome in search.reach.steps(thread, at, occurrence):
            if outcome.raised or (is_region and outcome.fired):
                continue
            same = [search.at(here, v, number) == here.store[n] for n, v in outcome.updates]
            cases.append(z3.And([search.at(here, outcome.condition, number), *same]))
        return z3.simplify(z3.Or(cases))

    # --- time-outs

    def _timers(self, made: TimedStep, index: int) -> tuple[list[Term], dict[str, Term]]:
        """Each time-out comes in its execution, and nothing of lower rank before it."""
        search, outcome = self.search, made.outcome
        due = dict(self.due.get(made.thread, {}))
        timed = search.timed(made.thread)
        kind, subject = outcome.occurrence.kind, outcome.occurrence.subject
        terms: list[Term] = []
        if made.thread in self.latest:
            idle = self.steps[self.latest[made.thread]].execution + 1 < made.execution
            terms += [z3.Implies(idle, at >= made.execution) for at in due.values()]
        if kind in ("event", "conditions"):
            terms += [at > made.execution for at in due.values()]
        if kind == "time" and subject in timed:
            order = list(timed)
            expiry = due.pop(subject)
            terms.append(expiry <= made.execution)
            for name, at in due.items():
                earlier = order.index(name) < order.index(subject)
                terms.append(at > expiry if earlier else at >= expiry)
            trigger = timed[subject].trigger
            if isinstance(trigger, Every):
                due[subject] = expiry + trigger.executions
        for name, transition in timed.items():
            trigger = transition.trigger
            assert isinstance(trigger, After | Every)
            if transition.source in outcome.entered:
                due[name] = made.execution + trigger.executions
            if transition.source not in outcome.after.active:
                due.pop(name, None)
        return terms, due

    # --- what comes from outside

    def _read(
        self,
        reads: list[tuple[Variable, Term, Term]],
        name: Variable,
        value: Term,
        moment: Term,
        turn: int,
    ) -> list[Term]:
        """That a value from outside does not change between two runs of its writer."""
        writer = self._writer(name)
        if writer is None or writer not in self.search.rows:
            return []
        count = self.search.rows[writer].executions_before(moment, turn)
        terms = [
            z3.Implies(count == before, value == other)
            for read, other, before in reads
            if read == name and not value.eq(other)
        ]
        reads.append((name, value, count))
        if name[0] == "port state":
            terms.append(z3.Implies(count == 0, value == PORT_STATES.index("never_received")))
        elif name[0] == "data":
            terms.append(z3.Implies(count == 0, value == self.search.reach.initial[name]))
        return terms

    def _writer(self, name: Variable) -> str | None:
        """The row that writes a value from outside."""
        component = self.search.reach.component
        if name[0] in ("port", "port state"):
            return component.handler(name[1])
        if name[0] == "data":
            for activity in component.activities:
                if name[1] in activity.writes:
                    return activity.name
        return None
