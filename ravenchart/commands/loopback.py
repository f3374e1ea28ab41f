# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart loopback`: one suite over any python-can interface with two ends on one bus."""

from __future__ import annotations

import argparse
from pathlib import Path

from rich.console import Console
from rich.table import Table
from rich.text import Text

from ravenchart import rounded, terminal
from ravenchart.failures import OK, WRONG, Unusable
from ravenchart.hw_can.bench.peer import BenchError
from ravenchart.hw_can.conformance.ends import Setup, open_ends
from ravenchart.hw_can.conformance.suite import CaseVerdict, SuiteResult, histogram, run

from . import loopback_files, results

BAR = 40
"""Columns of the longest bar of the histogram."""

_STYLES = {CaseVerdict.PASSED: "", CaseVerdict.FAILED: "bold red", CaseVerdict.SKIPPED: "dim"}


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    sub.add_argument(
        "--interface", required=True, metavar="NAME", help="name of the interface in python-can"
    )
    sub.add_argument("--channel", required=True, help="name of the channel of that interface")
    sub.add_argument(
        "--receive-interface", metavar="NAME", help="interface of the other end (default: the same)"
    )
    sub.add_argument(
        "--receive-channel", metavar="CHANNEL", help="channel of the other end (default: the same)"
    )
    sub.add_argument(
        "--echo",
        action="store_true",
        help="one bus object that receives its own frames is both ends: for a single adapter",
    )
    sub.add_argument(
        "--bitrate",
        type=_bitrate,
        metavar="BIT/S",
        help="bit rate (default: that of the interface)",
    )
    sub.add_argument("--fd", action="store_true", help="test CAN FD frames too")
    sub.add_argument("--junit", type=Path, metavar="FILE", help="write JUnit XML there")
    sub.add_argument("--html", type=Path, metavar="FILE", help="write a report there")


def show(result: SuiteResult, console: Console | None = None) -> None:
    """Print a row for each case, the histogram of latencies, and the verdict."""
    out = console or terminal.console()
    table = Table(box=None, pad_edge=False, padding=(0, 1, 0, 0))
    table.add_column("case", no_wrap=True)
    table.add_column("")
    table.add_column("s", justify="right", no_wrap=True)
    table.add_column("seen, or the reason", overflow="fold", ratio=1)
    for case in result.cases:
        took = rounded.instant(rounded.of_seconds(case.seconds))
        cells = (case.name, case.verdict.value, took, case.detail)
        table.add_row(*map(Text, cells), style=_STYLES[case.verdict])
    out.print(table)
    bars = histogram(result.latencies)
    if bars:
        out.print("\nlatency, send to receive")
        highest = max(count for _, count in bars)
        for below, count in bars:
            bar = "#" * -(-BAR * count // highest)
            out.print(f"  < {below:>7,} us {count:>5,} {bar}".rstrip())
    out.print(Text(f"\n{verdict_line(result)}", style="green" if result.passed else "bold red"))


def verdict_line(result: SuiteResult) -> str:
    """PASS or FAIL, and how many cases ended how."""
    passed, failed, skipped = map(result.count, CaseVerdict)
    word = "PASS" if result.passed else "FAIL"
    return f"{word}: {passed} passed, {failed} failed, {skipped} skipped"


def answered(result: SuiteResult) -> results.LoopbackResult:
    """The result as `--json` prints it."""
    cases = [
        results.LoopbackCase(one.name, one.verdict.value.lower(), one.seconds, one.detail)
        for one in result.cases
    ]
    return results.LoopbackResult(result.passed, cases, list(result.latencies), result.rate)


def tested(options: argparse.Namespace) -> bool:
    """Run the suite, print and write it; whether nothing failed and something passed.

    Raises BenchError when the bus cannot be opened, OSError when a file cannot be written.
    """
    both = options.receive_interface is not None or options.receive_channel is not None
    if options.echo and both:
        raise BenchError("--echo cannot be combined with --receive-interface and --receive-channel")
    setup = Setup(
        interface=options.interface,
        channel=options.channel,
        receive_interface=options.receive_interface or options.interface,
        receive_channel=options.receive_channel or options.channel,
        bitrate=options.bitrate,
        fd=options.fd,
        echo=options.echo,
    )
    ends = open_ends(setup)
    try:
        with terminal.stages("loopback") as tell:
            result = run(ends, tell)
    finally:
        ends.close()
    options.answer.result = answered(result)
    show(result)
    if options.junit is not None:
        options.junit.write_text(loopback_files.junit(result), encoding="utf-8")
    if options.html is not None:
        options.html.write_text(loopback_files.html(result), encoding="utf-8")
    return result.passed


def execute(options: argparse.Namespace) -> int:
    """Test them; the exit status."""
    try:
        return OK if tested(options) else WRONG
    except BenchError as problem:
        raise Unusable(str(problem)) from problem


def _bitrate(text: str) -> int:
    """A nominal bit rate, 1 .. 1,000,000 bit/s."""
    if not (text.isascii() and text.isdigit() and 0 < int(text) <= 1_000_000):
        raise argparse.ArgumentTypeError(f"{text!r} is not 1 .. 1000000 bit/s")
    return int(text)
