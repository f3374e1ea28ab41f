"""`ravenchart allocate`: the periodic rows of a model put together anew, and checked.

Sporadic processors, drivers and the host probe stay as they are. The strategies search
with the drivers and sporadic processors above all tables. What they come to is completed
as a model is and analysed as one, with its messages, chains and queues; where these are
not kept, rows move on (`allocation_search`). Rows of a table keep the order that they
have in the model: what hands a value on comes before what takes it.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from rich.console import Console
from rich.table import Table as Printed
from rich.text import Text

from ravenchart.analysis.core import allocation
from ravenchart.analysis.core.allocation import Movable, Strategy, Table
from ravenchart.analysis.core.blocking import Section
from ravenchart.analysis.core.tasks import Task
from ravenchart.analysis.present.words import verdict_line
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.analysis.units import duration, microseconds
from ravenchart.failures import OK, WRONG
from ravenchart.gen.derive.completion import completed
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.system import Processor, Slot, System
from ravenchart.terminal import console, progress

from . import common
from .allocation_search import SET, Judged, searched
from .results import ActivityRow, Allocated, AllocateResult

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


def propose(analysis: Analysis, strategy: str) -> Proposal:
    """The model's periodic rows put together by that strategy."""
    system = analysis.system
    kept = [processor for processor in system.processors if processor.released_by is not None]
    moved = [processor for processor in system.processors if processor.released_by is None]
    home = {slot.element: (processor, slot) for processor in moved for slot in processor.slots}
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

    def judge(tables: list[Table]) -> Judged:
        made: list[Processor] = []
        for table in tables:
            names = {activity.name for activity in table}
            rows = [row for name, row in home.items() if name in names]
            taken = [processor.name for processor in (*made, *kept)]
            made.append(_processor(rows, taken))
        short = [p for p in made if p.wcet < system.node(p.node).critical_section]
        if short:
            return Judged(tables, None, len(short))
        told = replace(system, processors=tuple(_unranked(p) for p in (*kept, *made)))
        return Judged(tables, analyse(completed(told)))

    starts = [list(found.tables)]
    own = [tuple(known[slot.element] for slot in processor.slots) for processor in moved]
    if STRATEGIES[strategy] not in SET:
        starts.append(own)
    best = searched(starts, STRATEGIES[strategy], judge)
    if best.analysis is None:
        best = judge(own)
    assert best.analysis is not None  # `check` refuses a model with such tables
    names = tuple(processor.name for processor in kept)
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
    return replace(
        first,
        name=first.name if same else _free(f"every_{duration(period).replace(' ', '_')}", taken),
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


def _free(name: str, taken: Sequence[str]) -> str:
    """The name, with a number where it is taken."""
    used = {one.lower() for one in taken}
    free, number = name, 1
    while free.lower() in used:
        number += 1
        free = f"{name}_{number}"
    return free


def show(proposal: Proposal, out: Console | None = None) -> None:
    """The verdict, a row for each processor and each of its rows, and what stayed."""
    out = out or console()
    analysis = proposal.analysis
    out.print(Text(verdict_line(analysis)))
    out.print()
    table = Printed(box=None, pad_edge=False, padding=(0, 1, 0, 0))
    table.add_column("processor, rows", overflow="fold", ratio=1)
    for column in ("T", "D", "C", "priority", "R", "slack"):
        table.add_column(column, justify="right", no_wrap=True)
    bounds = {row.row.name: row.bound for _, row in analysis.rows()}
    for processor in sorted(proposal.system.processors, key=lambda p: -p.priority):
        times = (processor.period, processor.deadline, processor.wcet)
        bound, slack = analysis.found.from_event(processor.name), analysis.slack(processor.name)
        mark = " (stays)" if processor.name in proposal.kept else ""
        cells = (str(processor.priority), _us(bound), _us(slack))
        table.add_row(processor.name + mark, *map(microseconds, times), *cells, style="bold")
        for slot in processor.slots:
            limits = (slot.timing.period, slot.timing.deadline, slot.timing.wcet)
            found = bounds.get(slot.element)
            left = None if found is None else slot.timing.deadline - found
            table.add_row(
                f"  {slot.element}", *map(microseconds, limits), "", _us(found), _us(left)
            )
    out.print(table)
    out.print("Times in us. Drivers, the host probe and sporadic processors stay as they are;")
    out.print("priorities are by deadline.")
    if not analysis.schedulable:
        out.print("No tables were found that keep every deadline and limit, chains included.")
    out.print("`--yaml` prints `processors:` to put into the model.")


def _us(time: int | None) -> str:
    return "-" if time is None else microseconds(time)


def yaml(proposal: Proposal) -> str:
    """``processors:`` of the model, as it would be; without priorities, which are by deadline."""
    lines = [f"# {verdict_line(proposal.analysis)}", "processors:"]
    for one in _written(proposal.system):
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
        lines += [
            f"    deadline: {duration(one.deadline)}",
            f"    stack: {one.stack_bytes} B",
            "    activities:",
            *(f"      - {slot.element}" for slot in one.slots),
        ]
        for key, events in (
            ("on_deadline_miss", one.on_deadline_miss),
            ("on_overrun", one.on_overrun),
            ("on_silence", one.on_silence),
        ):
            if events:
                lines.append(f"    {key}:")
                lines += [f"      - {instance}.{event}" for instance, event in events]
    return "\n".join(lines) + "\n"


def _written(system: System) -> Iterator[Processor]:
    """The processors as a model has them: one copy of what only serves a bus, for all its nodes."""
    seen: set[str] = set()
    for processor in system.processors:
        suffix = f"_{processor.node}"
        slots = tuple(
            replace(slot, name=slot.name.removesuffix(suffix)) if slot.of_bus else slot
            for slot in processor.slots
        )
        one = replace(processor, slots=slots)
        if one.name.endswith(suffix) and all(slot.of_bus for slot in slots):
            name = one.name.removesuffix(suffix)
            if name not in seen:
                yield replace(one, name=name, node="")
            seen.add(name)
        else:
            yield one


def _answer(proposal: Proposal, strategy: str) -> AllocateResult:
    analysis = proposal.analysis
    bounds = {row.row.name: row.bound for _, row in analysis.rows()}
    made = [
        Allocated(
            one.name,
            one.node,
            one.core,
            one.name in proposal.kept,
            one.priority,
            one.period,
            one.offset,
            one.deadline,
            one.wcet,
            analysis.found.from_event(one.name),
            [
                ActivityRow(
                    slot.element,
                    slot.timing.period,
                    slot.timing.deadline,
                    slot.timing.wcet,
                    bounds.get(slot.element),
                )
                for slot in one.slots
            ],
        )
        for one in sorted(proposal.system.processors, key=lambda p: -p.priority)
    ]
    return AllocateResult(strategy, analysis.schedulable, made, yaml(proposal))


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare what the command is told."""
    common.add_model(sub)
    sub.add_argument(
        "--strategy", choices=tuple(STRATEGIES), required=True,
        help="period: a processor for each period; locality: for each instance where "
        "rates fit; fewest: as few as possible; slack: as much slack as possible",
    )  # fmt: skip
    sub.add_argument("--yaml", action="store_true", help="print the result in the form of a model")


def execute(options: argparse.Namespace) -> int:
    """Propose it; the exit status."""
    checked = common.checked(options, deadlines=False)
    with progress("allocate"):
        proposal = propose(checked.analysis, options.strategy)
    options.answer.result = _answer(proposal, options.strategy)
    if options.yaml:
        print(yaml(proposal), end="")
    else:
        show(proposal)
    return OK if proposal.analysis.schedulable else WRONG
