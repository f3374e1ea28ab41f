# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart prove`: generated, and proved with gnatprove."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from ravenchart.building import programs
from ravenchart.evidence.records import of_termination
from ravenchart.failures import OK, WRONG
from ravenchart.gen.emit.nodes.termination import ending_claims
from ravenchart.proof import outside_spark, proving, unproved, verdicts
from ravenchart.proof.spark_results import Outside
from ravenchart.terminal import stages

from . import common
from .answer import say
from .results import Proved, ProveResult, Unproved


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    common.add_model(sub)
    common.add_driver(sub)
    sub.add_argument(
        "--whole", action="store_true",
        help="prove the runtime and the HAL again, which `make prove` proves by themselves",
    )  # fmt: skip
    sub.add_argument(
        "--fresh", action="store_true",
        help="run gnatprove also where the same content was proved before",
    )  # fmt: skip
    sub.add_argument(
        "--cache", metavar="HOST[:PORT]", type=_memcached,
        help="share verdicts of provers with a memcached server; port 11211 unless given",
    )  # fmt: skip
    sub.add_argument(
        "--record", type=Path, metavar="FILE",
        help="write the proof record to this file; with several nodes or with libraries, one for "
        "each, to FILE with the name of the node or library behind its own",
    )  # fmt: skip


def _memcached(address: str) -> verdicts.Memcached:
    try:
        return verdicts.Memcached(address)
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"`{address}` is not HOST or HOST:PORT, with a port from 1 to 65535"
        ) from None


def execute(options: argparse.Namespace) -> int:
    """Prove every program of the model; the exit status."""
    checked = common.checked(options, library=True)
    _, generated = common.write(checked, options.answer)
    answer = options.answer.result = ProveResult(generated, [])
    driver = options.driver or programs.default_driver(checked)
    programs.check_driver(checked, driver)
    libraries = [one for used in checked.libraries for one in programs.programs_of(used)]
    nodes = programs.programs_of(checked)
    made = [*libraries, *nodes]
    reasons = outside_spark.reasons_of(checked.system, checked.folder)
    clean = True
    outside: dict[Outside, None] = {}
    for one in made:
        name = one.node or one.checked.system.name
        proof, open_ = _proof(one, driver, options)
        where = f" on {one.node}" if one in nodes and len(nodes) > 1 else ""
        title = f"{one.checked.system.name}{where}"
        for finding in open_:
            say(options.answer, "\n".join(finding.lines()))
        print(f"{title}: {proof.summary()}", flush=True)
        ending, endless = _ending(one, driver, options)
        excused = outside_spark.listed(proof.results.outside, reasons)
        left = () if excused else endless
        for finding in left:
            say(options.answer, "\n".join(finding.lines()))
        if ending is not None:
            print(f"{title}: {_told(one, endless, excused=bool(excused))}", flush=True)
        answer.programs.append(_proved(name, proof, ending, (*open_, *left)))
        clean = clean and proof.clean and not left
        outside |= dict.fromkeys(proof.results.outside)
        if options.record is not None:
            record = record_of(options.record, name, several=len(made) > 1)
            record.write_text(proving.record_text(proof), encoding="utf-8")
            if ending is not None:
                beside = of_termination(record)
                beside.write_text(proving.record_text(ending), encoding="utf-8")
    for line in outside_spark.lines(tuple(outside), reasons):
        if line.startswith("error"):
            say(options.answer, line)
        else:
            print(line)
    return OK if clean and outside_spark.agree(tuple(outside), reasons) else WRONG


def _proof(
    one: programs.Program, driver: str, options: argparse.Namespace
) -> tuple[proving.Proof, tuple[unproved.UnprovedCheck, ...]]:
    """The proof of a program, and what is left open."""
    task = one.proof(driver, whole=options.whole)
    with stages(f"prove {one.node or one.checked.system.name}") as tell:
        try:
            proof = proving.prove(task, fresh=options.fresh, memcached=options.cache, tell=tell)
        except proving.NotProved as left:
            tell("looking for values that fail")
            text = proving.examples(task, left.proof) or str(left)
            places = [path for path in task.sources if path.is_dir()]
            found, home = left.proof.results.open, one.checked
            return left.proof, unproved.findings(text, found, home.system, home.folder, places)
    return proof, ()


def _ending(
    one: programs.Program, driver: str, options: argparse.Namespace
) -> tuple[proving.Proof | None, tuple[unproved.UnprovedCheck, ...]]:
    """The proof that each execution ends, and what may not; None where nothing runs."""
    task = one.termination(driver)
    if task is None:
        return None, ()
    with stages(f"prove {one.node or one.checked.system.name}") as tell:
        try:
            proof = proving.prove(task, fresh=options.fresh, memcached=options.cache, tell=tell)
        except proving.NotProved as left:
            claims = ending_claims(one.part)
            return left.proof, unproved.endless(left.proof.results.open, claims)
    return proof, ()


def record_of(path: Path, node: str, *, several: bool) -> Path:
    """Where the record of a node is written: with ``several`` each has a file of its own."""
    return path.with_name(f"{path.stem}-{node}{path.suffix}") if several else path


def _told(one: programs.Program, left: Sequence[unproved.UnprovedCheck], *, excused: bool) -> str:
    """Whether each execution ends, in a line; ``excused``: there are bodies outside SPARK."""
    rows = len(one.part.slots)
    if not left or not excused:
        what = "executions of 1 row end" if rows == 1 else f"executions of {rows} rows end"
        return f"all {what}: {'NOT PROVED' if left else 'proved'}"
    names = ", ".join(finding.element for finding in left)
    return (
        f"executions of {rows - len(left)} of {rows} rows end: proved; bodies outside SPARK may "
        f"be below {names}"
    )


def _proved(
    node: str,
    proof: proving.Proof,
    ending: proving.Proof | None,
    left: Sequence[unproved.UnprovedCheck],
) -> Proved:
    found = proof.results
    return Proved(
        node,
        found.checks,
        found.checks - found.justified - found.unproved,
        found.justified,
        found.assumed,
        [one.name for one in found.outside],
        [
            Unproved(
                one.file,
                one.line,
                one.column,
                one.check,
                one.example,
                one.element,
                str(one.origin or ""),
                one.help,
            )
            for one in left
        ],
        proof.clean,
        proof.cached,
        ending is None or ending.clean,
    )
