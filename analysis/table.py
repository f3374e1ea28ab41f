"""The terminal table: the verdict first, then one row a task, worst first.

It fits 80 columns and never says anything by colour alone; `rich` leaves the
colour out when the output is no terminal.
"""

from __future__ import annotations

from rich.console import Console
from rich.table import Table
from rich.text import Text

from .bus_load import bus_loads
from .response_times import GROWTH_SCALE, Analysis, Response, Verdict, growth_margin
from .units import microseconds, percent

WIDTH = 80
"""Columns of a printed table."""

WORDS = {Verdict.MET: "ok", Verdict.MISSED: "MISS", Verdict.NO_BOUND: "NONE"}
"""The verdict of a row in a word."""


def show(analysis: Analysis, console: Console | None = None) -> None:
    """Print the verdict, the load of cores and buses, and the table of tasks."""
    out = console or Console(width=WIDTH, highlight=False)
    good = analysis.schedulable and all(b.share <= 1 for b in bus_loads(analysis.system))
    out.print(Text(verdict_line(analysis), style="bold green" if good else "bold red"))
    for line in load_lines(analysis):
        out.print(Text(line))
    out.print()
    out.print(_table(analysis))
    out.print(
        Text("Times in us: T period, D deadline, C budget, B blocking, R response.", style="dim")
    )


def verdict_line(analysis: Analysis) -> str:
    """The outcome in one line."""
    failed, total = analysis.failed(), len(analysis.responses)
    over = [b.bus.name for b in bus_loads(analysis.system) if b.share > 1]
    if not failed and not over:
        return f"{analysis.system.name}: every deadline is met ({total} tasks)"
    parts = []
    if failed:
        more = f" and {len(failed) - 1} more" if len(failed) > 1 else ""
        parts.append(
            f"{len(failed)} of {total} deadlines may be missed: {failed[0].task.element}{more}"
        )
    if over:
        parts.append(f"overloaded: {', '.join(over)}")
    return f"{analysis.system.name}: {'; '.join(parts)}"


def load_lines(analysis: Analysis) -> tuple[str, ...]:
    """The load of each core and bus, and how far the budgets may grow."""
    system = analysis.system
    lines = [f"{n.name}: core load {percent(analysis.utilisation(n.name))}" for n in system.nodes]
    lines += [
        f"{load.bus.name}: bus load {percent(load.share)}, every frame at its longest"
        for load in bus_loads(system)
    ]
    return (*lines, growth_line(analysis))


def growth_line(analysis: Analysis) -> str:
    """The margin of the whole system in one sentence."""
    growth = growth_margin(analysis.system.tasks, analysis.system.objects)
    if growth is None:
        return "no execution time, however short, meets every deadline"
    share = f"{abs(growth) * 100 / GROWTH_SCALE:.1f} %"
    if growth >= 0:
        return f"all execution times may grow by {share} before a deadline is missed"
    return f"all execution times must shrink by {share} to meet every deadline"


def _table(analysis: Analysis) -> Table:
    """The rows of all tasks, worst slack first."""
    table = Table(box=None, pad_edge=False, padding=(0, 1, 0, 0))
    table.add_column("task", overflow="fold", ratio=1)
    for name in ("T", "D", "C", "B", "R", "slack"):
        table.add_column(name, justify="right", no_wrap=True)
    table.add_column("", no_wrap=True)
    for response in analysis.worst_first():
        table.add_row(*_cells(response), style="" if _met(response) else "bold red")
    return table


def _met(response: Response) -> bool:
    return response.verdict is Verdict.MET


def _cells(response: Response) -> tuple[str, ...]:
    """One task's cells."""
    task = response.task
    return (
        task.element,
        *(microseconds(t) for t in (task.period, task.deadline, task.budget, response.blocked)),
        "-" if response.bound is None else microseconds(response.bound),
        "-" if response.slack is None else microseconds(response.slack),
        WORDS[response.verdict],
    )
