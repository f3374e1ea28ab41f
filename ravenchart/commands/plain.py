# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart analyse` of a plain CSV or JSON file: the verdict, a table, JSON, exports."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

from rich.console import Console
from rich.table import Table

from ravenchart import rounded
from ravenchart.analysis.core.can_response import FrameResponse
from ravenchart.analysis.core.chains import Latency
from ravenchart.analysis.core.holistic import Holistic
from ravenchart.analysis.core.responses import Reason, Response
from ravenchart.analysis.core.tasks import Task
from ravenchart.analysis.exchange import FORMATS, Unfit
from ravenchart.analysis.findings import advice
from ravenchart.analysis.findings.deadlines import no_bound_reason
from ravenchart.analysis.findings.differences import Differences, Figures
from ravenchart.analysis.plain.build import PlainSystem, load_plain
from ravenchart.analysis.plain.observed import longest_times, observed
from ravenchart.analysis.plain.results import Json, PlainResult, analyse_plain, everything, loads
from ravenchart.analysis.present.plain_report import render_plain
from ravenchart.analysis.present.report import Execution
from ravenchart.analysis.present.sentences import distance_lines, offset_lines, overload_lines
from ravenchart.failures import Refused
from ravenchart.terminal import console

from .observed import tell

EXPORTS = tuple(FORMATS)
"""Tools that a system can be exported for."""

ENDINGS = (".csv", ".json")
"""How the names of plain files end."""

FEW = 5
"""Names in a line."""

SHOWN = 50
"""Rows of the table; the tightest come first."""


def read(path: Path) -> PlainSystem:
    """The system in a file; `Refused` with everything that is wrong with it."""
    found = load_plain(text_of(path), str(path))
    if isinstance(found, PlainSystem):
        return found
    raise Refused("\n".join(map(str, found[:SHOWN])))


def text_of(path: Path) -> str:
    """The text of a file; Refused where it is not UTF-8."""
    try:
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise Refused(f"{path}: error: the file must be UTF-8 text") from None


def analysed(path: Path) -> PlainResult:
    """The analysis of a file; `Refused` with what is wrong with it."""
    try:
        return analyse_plain(read(path))
    except ValueError as fault:
        raise Refused(f"{path}: error: {fault}") from None


def figures(result: PlainResult) -> Json:
    """Everything, for `--json`."""
    return everything(result) | {"changes": advice.figures(_advice(result))}


def run(options: argparse.Namespace, earlier: Callable[[Figures], Differences] | None) -> bool:
    """Analyse and print what the options ask for; whether every deadline is met.

    An export counts as met. With a file of observed times these must be within their WCETs
    too. ``earlier`` compares with another version.
    """
    path: Path = options.model
    if options.export is not None:
        print(exported(read(path), options.export, path, path.stem), end="")
        return True
    result = analysed(path)
    found = figures(result) if options.json or earlier else {}
    compared = None if earlier is None else earlier(found)
    if options.json:
        more = {} if compared is None else {"compared": compared.figures()}
        options.answer.figures = found | more
    else:
        show(result, console(None))
        for line in () if compared is None else compared.lines():
            print(line)
    rows: list[Execution] = []
    within = True
    if options.observed is not None:
        rows = _observed(options.observed, result.system)
        within = tell(rows, longest_times(result.system.network))
    if options.html is not None:
        lines = advice.lines(_advice(result))
        write(options.html, render_plain(path.stem, result, lines, rows, compared))
    return within and result.met


def write(path: Path, report: str) -> None:
    """Write a report, in a new folder where there is none, and say where it is."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(report, encoding="utf-8")
    print(f"report: {path}")


def _observed(path: Path, system: PlainSystem) -> list[Execution]:
    """The observed times beside the WCETs, nearest to them first."""
    found = observed(text_of(path), str(path), system.network)
    if not isinstance(found, dict):
        raise Refused("\n".join(map(str, found[:SHOWN])))
    known = longest_times(system.network)
    rows = [Execution(name, max(seen), known[name], tuple(seen)) for name, seen in found.items()]
    return sorted(rows, key=lambda row: -Fraction(row.observed, row.wcet))


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
    if result.met:
        out.print("every deadline is met", markup=False)
    overloaded = overload_lines(loads(result.system.network))
    for line in overloaded:
        out.print(line, markup=False)
    if overloaded:
        delayed = [name for name in missed if _is_delayed(found.responses[name])]
        named = ", ".join(delayed[:FEW])
        more = f" and {len(delayed) - FEW} more" if len(delayed) > FEW else ""
        out.print(f"without a bound because of that: {named}{more}", markup=False)
        missed = [name for name in missed if name not in delayed]
    for name in missed[:SHOWN]:
        out.print(_miss(name, found), markup=False)
    for latency in result.latencies:
        if not latency.met:
            out.print(_late(latency), markup=False)
    if result.scaling is not None:
        factor = rounded.factor(result.scaling.factor)
        limit = f", then {result.scaling.binding} fails" if result.scaling.binding else ""
        out.print(f"all execution times can be multiplied by {factor}{limit}", markup=False)
    for name, share in loads(result.system.network).items():
        out.print(f"load of {name or 'the core'}: {rounded.percent(share)}", markup=False)
    out.print(_table(result))
    if len(found.responses) > SHOWN:
        out.print(f"and {len(found.responses) - SHOWN} more with more slack", markup=False)
    for line in (*offset_lines(found.responses.values()), *distance_lines(found)):
        out.print(line, markup=False)
    for latency in result.latencies:
        reaction, age = _shown(latency.reaction), _shown(latency.age)
        out.print(f"chain {latency.chain.name}: reaction {reaction}, age {age}", markup=False)
    for line in advice.lines(_advice(result)):
        out.print(line, markup=False)


def _advice(result: PlainResult) -> advice.Advice | None:
    """Changes by which deadlines are met; limits of chains are not considered."""
    return advice.of_network(result.system.network, result.scaling, met=result.found.met)


def _is_delayed(response: Response | FrameResponse) -> bool:
    return response.reason in (Reason.OVERLOAD, Reason.DELAYED)


def _late(latency: Latency) -> str:
    """One line on a chain with a limit that is not kept."""
    limits = latency.chain.reaction_limit, latency.chain.age_limit
    pairs = zip((latency.reaction, latency.age), limits, strict=True)
    unbounded = any(limit and time is None for time, limit in pairs)
    return f"chain {latency.chain.name} {'has no bound' if unbounded else 'is above its limit'}"


def _miss(name: str, found: Holistic) -> str:
    """One line on a missed deadline."""
    needed = found.from_event(name)
    if needed is None:
        return f"{name} has no bound: {no_bound_reason(found.responses[name])}"
    over = needed - found.deadline(name)
    return f"{name} misses its deadline by {rounded.up(over)}"


def _table(result: PlainResult) -> Table:
    found, items = result.found, result.system.network.items()
    unit = rounded.unit_of(item.period for item in items.values())
    table = Table(box=None)
    table.add_column(f"in {unit.name}")
    for title in ("T", "D", "C", "J", "B", "R", "slack"):
        table.add_column(title, justify="right")
    names = sorted(found.responses, key=lambda name: _slack(name, found))
    for name in names[:SHOWN]:
        response = found.responses[name]
        item = items[name]
        longest = item.longest_wcet if isinstance(item, Task) else item.transmission_time
        needed = found.from_event(name)
        bound, deadline = unit.against(needed, item.deadline)
        table.add_row(
            name,
            unit.down(item.period),
            deadline,
            *map(unit.up, (longest, item.jitter, response.blocked)),
            bound if needed is not None else "no bound",
            unit.down(None if needed is None else item.deadline - needed),
        )
    return table


def _slack(name: str, found: Holistic) -> tuple[bool, int]:
    needed = found.from_event(name)
    return needed is not None, 0 if needed is None else found.deadline(name) - needed


def _shown(time: int | None) -> str:
    return "no bound" if time is None else rounded.up(time)
