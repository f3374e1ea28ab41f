"""`ravenchart analyse` of a plain CSV or JSON file: the verdict, a table, JSON, exports."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

from rich.console import Console
from rich.table import Table

from ravenchart.analysis.core.holistic import Holistic
from ravenchart.analysis.core.responses import Response
from ravenchart.analysis.exchange import FORMATS, Unfit
from ravenchart.analysis.findings import advice
from ravenchart.analysis.plain.build import PlainSystem, load
from ravenchart.analysis.plain.observed import budgets, observed
from ravenchart.analysis.plain.results import PlainResult, analyse, everything, loads
from ravenchart.analysis.present.report import Execution
from ravenchart.analysis.present.words import offset_lines
from ravenchart.analysis.units import duration, percent
from ravenchart.failures import Refused
from ravenchart.terminal import console

from .answer import Answer
from .observed import tell

EXPORTS = tuple(FORMATS)
"""Tools that a system can be exported for."""

ENDINGS = (".csv", ".json")
"""How the names of plain files end."""

SHOWN = 50
"""Rows of the table; the tightest come first."""


def read(path: Path) -> PlainSystem:
    """The system in a file; `Refused` with everything that is wrong with it."""
    found = load(_text(path), str(path))
    if isinstance(found, PlainSystem):
        return found
    raise Refused("\n".join(map(str, found[:SHOWN])))


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise Refused(f"{path}: error: the file must be UTF-8 text") from None


def run(path: Path, answer: Answer | None, export: str | None, seen: Path | None) -> bool:
    """Analyse and print; whether every deadline is met, or the export was printed.

    With ``answer`` everything goes there, for `--json`. With ``seen``, a file of observed times,
    whether these are within their budgets too.
    """
    system = read(path)
    if export is not None:
        print(exported(system, export, path, path.stem), end="")
        return True
    try:
        result = analyse(system)
    except ValueError as fault:
        raise Refused(f"{path}: error: {fault}") from None
    if answer is not None:
        changes = {"changes": advice.figures(_advice(result))}
        answer.figures = everything(result) | changes
    else:
        show(result, console(None))
    within = seen is None or _within_budgets(seen, system)
    return within and result.met


def _within_budgets(path: Path, system: PlainSystem) -> bool:
    """Print what was observed beside the budgets, nearest to them first."""
    found = observed(_text(path), str(path), system.network)
    if not isinstance(found, dict):
        raise Refused("\n".join(map(str, found[:SHOWN])))
    known = budgets(system.network)
    rows = [Execution(name, time, known[name]) for name, time in found.items()]
    rows.sort(key=lambda row: -Fraction(row.observed, row.claimed))
    return tell(rows, known)


def exported(system: PlainSystem, tool: str, path: Path, title: str) -> str:
    """The system of a file, for that tool; `Refused` with what the tool cannot express."""
    try:
        return FORMATS[tool](system.network, system.chains, title)
    except Unfit as unfit:
        raise Refused(f"{path}: error: {unfit}") from None


def show(result: PlainResult, out: Console) -> None:
    """The verdict, then the tightest rows, chains and loads."""
    found = result.found
    missed = [name for name in found.responses if not found.meets(name)]
    late = [latency.chain.name for latency in result.latencies if not latency.met]
    if result.met:
        out.print("every deadline is met", markup=False)
    for name in missed[:SHOWN]:
        out.print(_miss(name, found), markup=False)
    for name in late:
        out.print(f"chain {name} is above its limit", markup=False)
    if result.scaling is not None:
        factor = result.scaling.factor
        limit = f", then {result.scaling.binding} fails" if result.scaling.binding else ""
        out.print(
            f"all execution times can be multiplied by {float(factor):.4f}{limit}", markup=False
        )
    for name, share in loads(result.system.network).items():
        out.print(f"load of {name or 'the core'}: {percent(share)}", markup=False)
    out.print(_table(result))
    if len(found.responses) > SHOWN:
        out.print(f"and {len(found.responses) - SHOWN} more with more slack", markup=False)
    for line in offset_lines(found.responses.values()):
        out.print(line, markup=False)
    for latency in result.latencies:
        out.print(
            f"chain {latency.chain.name}: reaction {_shown(latency.reaction)}, "
            f"age {_shown(latency.age)}",
            markup=False,
        )
    for line in advice.lines(_advice(result)):
        out.print(line, markup=False)


def _advice(result: PlainResult) -> advice.Advice | None:
    """What to change so that deadlines are met; limits of chains are not looked at."""
    return advice.of_network(result.system.network, result.scaling, met=result.found.met)


def _miss(name: str, found: Holistic) -> str:
    """One line on a missed deadline."""
    needed, reason = found.from_event(name), found.responses[name].reason
    if needed is None:
        return f"{name} has no bound: {reason.value if reason else 'unknown'}"
    over = needed - found.deadline(name)
    return f"{name} misses its deadline by {duration(over)}"


def _table(result: PlainResult) -> Table:
    found = result.found
    table = Table(box=None)
    for title in ("", "T", "D", "C", "J", "B", "R", "slack"):
        table.add_column(title, justify="right" if title else "left")
    names = sorted(found.responses, key=lambda name: _slack(name, found))
    for name in names[:SHOWN]:
        response = found.responses[name]
        item = response.task if isinstance(response, Response) else response.frame
        cost = response.task.plain_cost if isinstance(response, Response) else response.frame.cost
        needed = found.from_event(name)
        slack = None if needed is None else found.deadline(name) - needed
        table.add_row(
            name,
            *map(duration, (item.period, item.deadline, cost)),
            duration(item.jitter),
            duration(response.blocked),
            _shown(needed),
            _shown(slack),
        )
    return table


def _slack(name: str, found: Holistic) -> tuple[bool, int]:
    needed = found.from_event(name)
    return needed is not None, 0 if needed is None else found.deadline(name) - needed


def _shown(time: int | None) -> str:
    return "no bound" if time is None else duration(time)
