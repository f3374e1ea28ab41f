# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The periodic rows of a model put together anew, and checked.

Sporadic processors, drivers and the host probe stay as they are, and so do processors with a
logical execution time or phases. The strategies search with
the drivers and sporadic processors above all tables. Their tables are completed as a model
is, and analysed as one with its messages, chains and queues. Where a limit of these is not
kept, `search` moves rows. Rows of a table keep the order that they have in the model: a row
that hands a value on comes before the row that takes it.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

from ravenchart.analysis.core import allocation
from ravenchart.analysis.core.allocation import Movable, Strategy, Table
from ravenchart.analysis.core.blocking import Section
from ravenchart.analysis.core.tasks import Task
from ravenchart.analysis.present.sentences import verdict_line
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.analysis.units import duration
from ravenchart.gen.derive.completion import completed
from ravenchart.gen.derive.sharing import too_long
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.system import Processor, Slot, System, Work

from .search import SET, Judged, Rank, Ranked, rank_of_tables, searched

STRATEGIES = {
    "period": Strategy.BY_PERIOD,
    "locality": Strategy.BY_LOCALITY,
    "fewest": Strategy.FEWEST_TASKS,
    "slack": Strategy.MOST_SLACK,
}
"""The strategies by the word that chooses one."""

URGENT = "urgent"
"""The object that stands for all of a core while searching: every activity uses some."""


@dataclass(frozen=True, slots=True)
class Proposal:
    """A model with other processors, and its analysis."""

    system: System
    analysis: Analysis
    kept: tuple[str, ...]
    """Processors that stay, with their tables."""


@dataclass(frozen=True, slots=True)
class WantedTable:
    """A processor as a model would have it; times in ns. A sporadic one stays as it is."""

    name: str
    node: str
    """"" where a model of several nodes has it on each."""
    core: int
    released_by: str | None
    """The bus or port that releases a sporadic one; None: it is periodic."""
    priority: int
    period: int
    offset: int
    deadline: int
    stack_bytes: int
    rows: tuple[str, ...]
    raises: Mapping[str, tuple[str, ...]]
    """By the key that says when: the events that it raises."""
    logical: int | None = None
    """The logical execution time of one that stays as it is."""
    phases: Mapping[str, int] = field(default_factory=dict)
    """Those of its rows that the model gives."""
    cyclic: bool = False
    """It is a cyclic executive."""


class Judge:
    """The periodic rows of a model in other tables, and the analysis of that model."""

    def __init__(self, system: System) -> None:
        """Of the model whose rows are to move."""
        self.system = system
        self.kept = [one for one in system.processors if _stays(one)]
        """Sporadic processors, and those with instants that the model gives."""
        self.moved = [one for one in system.processors if not _stays(one)]
        """All others."""
        self.home = {slot.element: (one, slot) for one in self.moved for slot in one.slots}
        """Where each row of theirs is."""

    def __call__(self, tables: list[Table]) -> Judged:
        """Judge these tables."""
        made: list[Processor] = []
        for table in tables:
            names = {activity.name for activity in table}
            rows = [row for name, row in self.home.items() if name in names]
            made.append(_processor(rows, [one.name for one in (*made, *self.kept)]))
        processors = tuple(_unranked(one) for one in (*self.kept, *made))
        told = completed(replace(self.system, processors=processors))
        short = sum(one.wcet < self.system.node(one.node).critical_section for one in made)
        short += len(list(too_long(told)))
        return Judged(tables, None, short) if short else Judged(tables, analyse(told))


def _stays(processor: Processor) -> bool:
    """Whether a processor stays as it is: other tables would change when values are visible."""
    phased = processor.cyclic or any(slot.placed_at for slot in processor.slots)
    return processor.released_by is not None or processor.logical is not None or phased


RankOf = Callable[[list[Table]], Rank]
"""How good tables are."""


def _rank(judge: Judge, strategy: Strategy, tables: list[Table]) -> Rank:
    return rank_of_tables(judge(tables), strategy)


def propose(
    analysis: Analysis,
    strategy: str,
    better: Callable[[Proposal], None] = lambda _: None,
    helpers: Callable[[RankOf], Ranked] | None = None,
) -> Proposal:
    """The model's periodic rows put together by that strategy; ``better`` gets the best so far.

    ``helpers`` turns a function of tables into one of many tables, which works on them in parallel.
    """
    system = analysis.system
    judge = Judge(system)
    kept, moved, home = judge.kept, judge.moved, judge.home
    activities = [
        Movable(
            slot.element,
            slot.timing.period,
            slot.timing.wcet,
            slot.timing.deadline,
            slot.owner,
            _core(system, processor),
        )
        for processor, slot in home.values()
    ]
    sections = [
        Section(
            f"{URGENT} {_core(system, processor)}",
            slot.element,
            system.node(processor.node).critical_section,
        )
        for processor, slot in home.values()
        if system.node(processor.node).critical_section
    ]
    periodic = {processor.name for processor in moved}
    above = [_as_found(t, analysis) for t in analysis.network.tasks if t.name not in periodic]
    found = allocation.allocate(
        activities, STRATEGIES[strategy], sections, analysis.network.platforms, above, whole=True
    )
    known = {activity.name: activity for activity in activities}

    starts = [list(found.tables)]
    own = [tuple(known[slot.element] for slot in processor.slots) for processor in moved]
    if STRATEGIES[strategy] not in SET:
        starts.append(own)
    names = tuple(processor.name for processor in kept)

    def heard(now: Judged) -> None:
        if now.analysis is not None:
            better(Proposal(now.analysis.system, now.analysis, names))

    rank_of = partial(_rank, judge, STRATEGIES[strategy])
    best = searched(starts, STRATEGIES[strategy], judge, heard, helpers and helpers(rank_of))
    if best.analysis is None:
        best = judge(own)
    assert best.analysis is not None  # `check` refuses a model with such tables
    return Proposal(best.analysis.system, best.analysis, names)


def _core(system: System, processor: Processor) -> str:
    return system.node(processor.node).core_name(processor.core)


def _as_found(task: Task, analysis: Analysis) -> Task:
    """With the jitter that it was found to inherit; its period where there is no bound."""
    late = analysis.found.inherited.get(task.name, task.period)
    return replace(task, jitter=task.jitter + late)


def _unranked(processor: Processor) -> Processor:
    """Without a priority, so that it gets one by its deadline."""
    return replace(processor, priority=0)


def _processor(rows: Sequence[tuple[Processor, Slot]], taken: Sequence[str]) -> Processor:
    """A processor of these rows: one of those they come from where its rows stay together."""
    origins = list(dict.fromkeys(processor.name for processor, _ in rows))
    first = rows[0][0]
    period = min(slot.timing.period for _, slot in rows)
    same = len(origins) == 1 and len(first.slots) == len(rows)
    fresh = f"every_{duration(period).replace(' ', '_')}"
    return replace(
        first,
        name=first.name if same else free_name(fresh, taken),
        period=period,
        offset=first.offset if same else Ns(0),
        deadline=min(slot.timing.deadline for _, slot in rows),
        stack_bytes=max(processor.stack_bytes for processor, _ in rows),
        slots=tuple(slot for _, slot in rows),
        on_deadline_miss=tuple(
            dict.fromkeys(miss for processor, _ in rows for miss in processor.on_deadline_miss)
        ),
        on_overrun=tuple(
            dict.fromkeys(over for processor, _ in rows for over in processor.on_overrun)
        ),
        on_silence=tuple(
            dict.fromkeys(one for processor, _ in rows for one in processor.on_silence)
        ),
    )


def free_name(name: str, taken: Iterable[str]) -> str:
    """The name, with a number where it is taken."""
    used = {one.lower() for one in taken}
    free, number = name, 1
    while free.lower() in used:
        number += 1
        free = f"{name}_{number}"
    return free


def yaml(proposal: Proposal) -> str:
    """``processors:`` of the model, as it would be; without priorities, which are by deadline."""
    lines = [f"# {verdict_line(proposal.analysis)}", "processors:"]
    for one in tables(proposal):
        lines.append(f"  {one.name}:")
        if one.node:
            lines.append(f"    node: {one.node}")
        if one.core > 1:
            lines.append(f"    core: {one.core}")
        if one.released_by is not None:
            lines.append(f"    released_by: {one.released_by}")
        lines.append(f"    period: {duration(one.period)}")
        if one.offset:
            lines.append(f"    offset: {duration(one.offset)}")
        if one.logical is not None:
            lines.append(f"    logical_execution_time: {duration(one.logical)}")
        if one.cyclic:
            lines.append("    schedule: table")
        if one.phases:
            lines.append("    phases:")
            lines += [f"      {row}: {duration(time)}" for row, time in one.phases.items()]
        lines += [
            f"    deadline: {duration(one.deadline)}",
            f"    stack: {one.stack_bytes} B",
            "    activities:",
            *(f"      - {row}" for row in one.rows),
        ]
        for key, events in one.raises.items():
            if events:
                lines.append(f"    {key}:")
                lines += [f"      - {event}" for event in events]
    return "\n".join(lines) + "\n"


def _reactions(processor: Processor) -> Iterator[tuple[str, tuple[str, ...]]]:
    """The keys with what a processor raises, and the events."""
    for key, events in (
        ("on_deadline_miss", processor.on_deadline_miss),
        ("on_overrun", processor.on_overrun),
        ("on_silence", processor.on_silence),
    ):
        yield key, tuple(f"{instance}.{event}" for instance, event in events)


def _written(system: System) -> Iterator[Processor]:
    """The processors as a model has them: one copy of what only serves a bus, for all its nodes.

    Where some of its nodes have the rows in other tables, each copy stays and names its node.
    """
    seen: set[str] = set()
    homes: defaultdict[str, set[str]] = defaultdict(set)
    for one in system.processors:
        if all(slot.of_bus for slot in one.slots):
            homes[one.name.removesuffix(f"_{one.node}")].add(one.node)
    for processor in system.processors:
        suffix = f"_{processor.node}"
        slots = tuple(
            replace(slot, name=slot.name.removesuffix(suffix)) if slot.of_bus else slot
            for slot in processor.slots
        )
        one = replace(processor, slots=slots)
        name = one.name.removesuffix(suffix)
        serves = one.name.endswith(suffix) and all(slot.of_bus for slot in slots)
        if serves and homes[name] == _served_nodes(system, processor):
            if name not in seen:
                yield replace(one, name=name, node="")
            seen.add(name)
        else:
            yield one


def _served_nodes(system: System, processor: Processor) -> set[str]:
    """The nodes on which the model would have a copy of a processor that only serves a bus."""
    bus, work = processor.slots[0].owner, processor.slots[0].work
    if work is Work.BUS_RECEIVE:
        return {node.name for node in system.nodes if system.received(bus, node.name)}
    return set(system.joining(bus))


def stack_text(size: int) -> str:
    """A size in bytes as a model has it."""
    return f"{size} B" if size % 1024 else f"{size // 1024} KiB"


def tables(proposal: Proposal) -> tuple[WantedTable, ...]:
    """The processors as a model has them."""
    return tuple(
        WantedTable(
            one.name,
            one.node,
            one.core,
            None if one.released_by is None else str(one.released_by),
            one.priority,
            one.period,
            one.offset,
            one.deadline,
            one.stack_bytes,
            tuple(slot.element for slot in one.slots),
            dict(_reactions(one)),
            one.logical,
            {slot.element: slot.after for slot in one.slots if slot.placed_at},
            one.cyclic,
        )
        for one in _written(proposal.system)
    )
