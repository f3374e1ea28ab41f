# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The terminal table: the verdict first, then one row a task or message, worst first.

It fits 80 columns and never says anything by colour alone.
"""

from __future__ import annotations

from rich.console import Console
from rich.table import Table
from rich.text import Text

from ravenchart import rounded, terminal
from ravenchart.analysis.core.tasks import Task
from ravenchart.analysis.findings import advice
from ravenchart.analysis.system.stream import StreamResponse
from ravenchart.analysis.system.timing import Analysis, Verdict
from ravenchart.rounded import TimeUnit

from .bars import stream_row
from .sentences import WORDS, instant_lines, load_lines, offset_lines, stream_lines, verdict_line

LEGEND = (
    "Times in {}, rounded to the safe side: T period, D deadline, C execution or\n"
    "transmission, J jitter, B blocking, R response."
)


def show(analysis: Analysis, console: Console | None = None) -> None:
    """Print the verdict, loads and limits, and the tables of tasks, messages and chains."""
    out = console or terminal.console()
    style = "bold green" if analysis.schedulable else "bold red"
    out.print(Text(verdict_line(analysis), style=style))
    for line in load_lines(analysis):
        out.print(Text(line))
    out.print()
    worst, unit = analysis.worst_first(), _unit_of(analysis)
    tasks = _table(analysis, "task", [name for name in worst if name in analysis.tasks], unit)
    for one in analysis.streams:
        tasks.add_row(*_stream_cells(one, unit), style="" if one.holds else "bold yellow")
    out.print(tasks)
    if analysis.messages:
        sent = [name for name in worst if name in analysis.messages]
        out.print(_table(analysis, "message", sent, unit))
    if analysis.limited:
        out.print(_chains(analysis, unit))
    out.print(Text(LEGEND.format(unit.name), style="dim"))
    for line in (
        *offset_lines(analysis.responses),
        *instant_lines(analysis.system),
        *stream_lines(analysis),
    ):
        out.print(Text(line))
    for line in advice.lines(advice.of_model(analysis)):
        out.print(Text(line))


def _new_table(name: str, *columns: str) -> Table:
    """A table of names, and of figures to the right."""
    table = Table(box=None, pad_edge=False, padding=(0, 1, 0, 0))
    table.add_column(name, overflow="fold", ratio=1)
    for column in columns:
        table.add_column(column, justify="right", no_wrap=True)
    table.add_column("", no_wrap=True)
    return table


def _unit_of(analysis: Analysis) -> TimeUnit:
    """The unit of all tables of this analysis."""
    return rounded.unit_of(item.period for item in analysis.network.items().values())


def _table(analysis: Analysis, kind: str, names: list[str], unit: TimeUnit) -> Table:
    """The rows of these tasks or messages, in that order."""
    table = _new_table(kind, "T", "D", "C", "J", "B", "R", "slack")
    for name in names:
        met = analysis.verdict(name) is Verdict.MET
        table.add_row(*_cells(analysis, name, unit), style="" if met else "bold red")
    return table


def _cells(analysis: Analysis, name: str, unit: TimeUnit) -> tuple[str, ...]:
    """The cells of one task or message."""
    response = analysis.found.responses[name]
    item = analysis.network.items()[name]
    longest = analysis.tasks[name].wcet if isinstance(item, Task) else item.transmission_time
    jitter = item.jitter + analysis.found.inherited.get(name, 0)
    bound, deadline = unit.against(analysis.found.from_event(name), item.deadline)
    return (
        name,
        unit.down(item.period),
        deadline,
        *map(unit.up, (longest, jitter, response.blocked)),
        bound,
        unit.down(analysis.slack(name)),
        WORDS[analysis.verdict(name)],
    )


def _stream_cells(one: StreamResponse, unit: TimeUnit) -> tuple[str, ...]:
    """The cells of a stream, which has neither jitter of its own nor blocking."""
    row = stream_row(one)
    bound, deadline = unit.against(row["bound"], row["deadline"])
    period, wcet = one.response.task.period, one.response.task.wcet
    zero = unit.up(0)
    return (
        row["name"],
        unit.down(period),
        deadline,
        *(unit.up(wcet), zero, zero, bound),
        unit.down(row["slack"]),
        row["word"],
    )


def _chains(analysis: Analysis, unit: TimeUnit) -> Table:
    """The chains with limits."""
    table = _new_table("chain", "reaction", "limit", "age", "limit")
    for chain, found in analysis.limited:
        reaction = unit.against(found.reaction, chain.reaction)
        age = unit.against(found.age, chain.age)
        word = "ok" if found.met else "MISS"
        table.add_row(chain.name, *reaction, *age, word, style="" if found.met else "bold red")
    return table
