# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart allocate`: the periodic rows of a model put together anew, and checked."""

from __future__ import annotations

import argparse

from rich.console import Console
from rich.table import Table as Printed
from rich.text import Text

from ravenchart import rounded
from ravenchart.allocation.helpers import helped
from ravenchart.allocation.proposals import STRATEGIES, Proposal, propose, yaml
from ravenchart.analysis.present.sentences import verdict_line
from ravenchart.failures import OK, WRONG
from ravenchart.gen.model.statechart import Timing
from ravenchart.gen.model.system import Processor
from ravenchart.terminal import console, progress

from . import common
from .results import ActivityRow, Allocated, AllocateResult


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
    unit = rounded.unit_of(processor.period for processor in proposal.system.processors)

    def add(
        name: str, of: Processor | Timing, priority: str, bound: int | None, style: str
    ) -> None:
        found, deadline = unit.against(bound, of.deadline)
        slack = unit.down(None if bound is None else of.deadline - bound)
        times = unit.down(of.period), deadline, unit.up(of.wcet)
        table.add_row(name, *times, priority, found, slack, style=style)

    for one in sorted(proposal.system.processors, key=lambda p: -p.priority):
        mark = " (stays)" if one.name in proposal.kept else ""
        bound = analysis.found.from_event(one.name)
        add(one.name + mark, one, str(one.priority), bound, "bold")
        for slot in one.slots:
            add(f"  {slot.element}", slot.timing, "", bounds.get(slot.element), "")
    out.print(table)
    out.print(f"Times in {unit.name}, rounded to the safe side. Priorities are by deadline.")
    out.print("Drivers, the host probe, sporadic processors, cyclic executives, and processors ")
    out.print("with phases or a logical execution time stay as they are.")
    if not analysis.schedulable:
        out.print("No tables were found that keep every deadline and limit, chains included.")
    out.print("`--yaml` prints `processors:` to put into the model.")


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
    """Declare the arguments of the command."""
    common.add_model(sub)
    sub.add_argument(
        "--strategy", choices=tuple(STRATEGIES), required=True,
        help="period: a processor for each period; locality: for each instance where "
        "rates fit; fewest: as few as possible; slack: as much slack as possible",
    )  # fmt: skip
    common.add_scheduler(sub)
    sub.add_argument("--yaml", action="store_true", help="print the result in the form of a model")


def execute(options: argparse.Namespace) -> int:
    """Propose it; the exit status."""
    checked = common.checked(options, deadlines=False)
    with helped(options.scheduler) as helpers, progress("allocate"):
        proposal = propose(checked.analysis, options.strategy, helpers=helpers)
    options.answer.result = _answer(proposal, options.strategy)
    if options.yaml:
        print(yaml(proposal), end="")
    else:
        show(proposal)
    return OK if proposal.analysis.schedulable else WRONG
