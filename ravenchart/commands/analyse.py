"""`ravenchart analyse`: response times against deadlines, of a model or of plain files."""

from __future__ import annotations

import argparse
from pathlib import Path

from ravenchart.failures import OK, WRONG, Refused

from . import common, plain


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare what the command is told."""
    common.add_model(sub)
    sub.add_argument("--html", type=Path, metavar="FILE", help="write the report there too")
    sub.add_argument(
        "--observed", type=Path, metavar="FILE",
        help="compare measured execution times (the trace of a run, or a plain file "
        "for a plain file) with the budgets",
    )  # fmt: skip
    output = sub.add_mutually_exclusive_group()
    output.add_argument("--json", action="store_true", help="print everything as JSON")
    output.add_argument("--export", choices=plain.EXPORTS, help="print the system for that tool")


def execute(options: argparse.Namespace) -> int:
    """Analyse it; the exit status."""
    printed = options.json or options.export is not None
    if printed and (options.html is not None or options.observed is not None):
        raise Refused("ravenchart: error: --json and --export go without --html and --observed")
    if options.model.suffix.lower() in plain.ENDINGS:
        return _plain(options)
    from ravenchart.analysis.present.table import show

    checked = common.checked(options, deadlines=False)
    analysis = checked.analysis
    status = OK if analysis.schedulable else WRONG
    if options.export is not None:
        from ravenchart.analysis.plain.build import PlainSystem

        system = PlainSystem(analysis.network, tuple(found.chain for _, found in analysis.limited))
        print(plain.exported(system, options.export, options.model, checked.system.name), end="")
        return OK
    if options.json:
        from ravenchart.analysis.present.figures import figures

        options.answer.figures = figures(analysis)
        return status
    show(analysis)
    if options.html is not None:
        from ravenchart.analysis.present import report

        options.html.parent.mkdir(parents=True, exist_ok=True)
        options.html.write_text(report.render(analysis), encoding="utf-8")
        print(f"report: {options.html}")
    if options.observed is not None:
        from . import observed

        status = status if observed.within_budgets(checked, options.observed) else WRONG
    return status


def _plain(options: argparse.Namespace) -> int:
    if options.html is not None:
        raise Refused(f"{options.model}: error: --html is for models")
    met = plain.run(
        options.model, options.answer if options.json else None, options.export, options.observed
    )
    return OK if met else WRONG
