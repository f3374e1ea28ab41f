# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart analyse`: response times against deadlines, of a model or of plain files."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from ravenchart import rounded
from ravenchart.failures import OK, WRONG, Refused
from ravenchart.terminal import progress

from . import bounds, common, plain
from .answer import add_option, say

if TYPE_CHECKING:
    from ravenchart.analysis.findings.differences import Differences, Figures
    from ravenchart.analysis.plain.bounds import Bound
    from ravenchart.building.checking import Checked


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    common.add_model(sub, "or a plain file, CSV or JSON")
    sub.add_argument(
        "--html", type=Path, metavar="FILE", help="write the report as a page of HTML there too"
    )
    sub.add_argument(
        "--observed", type=Path, metavar="FILE",
        help="compare measured execution times (the trace of a run, or a plain file "
        "for a plain file) with the WCETs",
    )  # fmt: skip
    bounds.add_arguments(sub)
    sub.add_argument(
        "--compare", type=Path, metavar="OLD",
        help="report the changes since OLD: a model, a plain file or an answer of --json",
    )  # fmt: skip
    output = sub.add_mutually_exclusive_group()
    add_option(output)
    output.add_argument("--export", choices=plain.EXPORTS, help="print the system for that tool")


def execute(options: argparse.Namespace) -> int:
    """Analyse it; the exit status."""
    printed = options.json or options.export is not None
    if printed and any((options.html, options.observed, options.bounds)):
        raise Refused(
            "ravenchart: error: --json and --export cannot be combined with --html, --observed "
            "and --bounds"
        )
    if options.export is not None and options.compare is not None:
        raise Refused("ravenchart: error: --export cannot be combined with --compare")
    if options.model.suffix.lower() in plain.ENDINGS:
        if options.bounds is not None:
            raise Refused("ravenchart: error: --bounds is for a model")
        return OK if plain.run(options, _comparison(options)) else WRONG
    checked = common.checked(options, deadlines=False)
    status = OK if checked.analysis.schedulable else WRONG
    if options.export is not None:
        _export(options, checked)
        return OK
    return status if _of_model(options, checked) else WRONG


def _comparison(options: argparse.Namespace) -> Callable[[Figures], Differences] | None:
    """How the figures of now are compared with the earlier version; None where none is given."""
    if options.compare is None:
        return None
    from .comparing import compared

    return partial(compared, options.compare)


def _export(options: argparse.Namespace, checked: Checked) -> None:
    """Print the system of a model for another tool."""
    from ravenchart.analysis.plain.build import PlainSystem
    from ravenchart.analysis.system.stream import network_with_streams

    analysis = checked.analysis
    network = network_with_streams(analysis.network, analysis.streams)
    system = PlainSystem(network, tuple(found.chain for _, found in analysis.limited))
    print(plain.exported(system, options.export, options.model, checked.system.name), end="")


def _of_model(options: argparse.Namespace, checked: Checked) -> bool:
    """Print, or answer, what was found for a model; no observed time is above its WCET."""
    from ravenchart.analysis.present.figures import figures
    from ravenchart.analysis.present.table import show

    analysis, earlier = checked.analysis, _comparison(options)
    given = bounds.of_model(options, checked)
    found = figures(analysis) if options.json or earlier else {}
    changed = None if earlier is None else earlier(found)
    if options.json:
        more = {} if changed is None else {"compared": changed.figures()}
        options.answer.figures = found | more
        return True
    show(analysis)
    for line in () if changed is None else changed.lines():
        print(line)
    run, within = None, True
    if options.observed is not None:
        from . import observed

        seen = observed.observation(checked, options.observed)
        within = observed.within_wcets(checked, seen, options.observed)
        run = observed.report(checked, seen, options.observed, within=within)
    if options.bounds is not None:
        within = _is_bounded(options, checked, given) and within
    if options.html is not None:
        from ravenchart.analysis.present import report
        from ravenchart.building import programs

        with progress("write the report"):
            built = {one.node: one.last_build() for one in programs.programs_of(checked)}
            page = report.render_report(analysis, run, changed, built)
        plain.write(options.html, page)
    return within


def _is_bounded(options: argparse.Namespace, checked: Checked, given: Mapping[str, Bound]) -> bool:
    """Print each bound of a static tool beside its WCET; none is above it."""
    table = bounds.rows(checked, given)
    for row in table:
        if row.bound is None:
            print(f"{row.row}: no bound is given for its WCET of {rounded.up(row.wcet)}")
        else:
            bound, wcet = rounded.beside(row.bound, row.wcet)
            word = "ABOVE" if row.words else "within"
            print(f"{row.row}: bound {bound}, {word} its WCET of {wcet}")
    for text in bounds.findings(table, given, checked.system):
        say(options.answer, text)
    return not any(row.words for row in table)
