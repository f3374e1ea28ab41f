# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart evidence`: one folder that an assessor can follow."""

from __future__ import annotations

import argparse
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

from ravenchart.failures import OK, WRONG, Refused
from ravenchart.terminal import progress

from . import common
from .results import EvidenceResult

if TYPE_CHECKING:
    from ravenchart.evidence.facts import Facts

BAD = ("not met", "not shown")


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    common.add_model(sub)
    sub.add_argument(
        "--out", type=Path, metavar="FOLDER",
        help="write the folder there; `evidence` beside the model unless given",
    )  # fmt: skip
    sub.add_argument(
        "--requirements", type=Path, metavar="FILE",
        help="trace the requirements of that list: CSV with the columns id and text, or ReqIF",
    )  # fmt: skip
    add_sources(sub)


def add_sources(sub: argparse.ArgumentParser) -> None:
    """Declare where the facts beside the model are."""
    common.add_driver(sub)
    sub.add_argument(
        "--record", type=Path, metavar="FILE", action="append", default=[],
        help="the proof record that `prove --record` wrote; once for each node and library",
    )  # fmt: skip
    sub.add_argument(
        "--memory", type=Path, metavar="FILE", action="append", default=[],
        help="stacks and memory as `build --memory` wrote them; for several nodes, once for each",
    )  # fmt: skip
    sub.add_argument(
        "--coverage", type=Path, metavar="FILE",
        help="what test cases execute, as `tests --coverage` wrote it (LCOV)",
    )  # fmt: skip
    sub.add_argument(
        "--tests", type=Path, metavar="FILE", help="results of tests in the form of JUnit"
    )
    sub.add_argument(
        "--scenario", type=Path, metavar="FILE", action="append",
        help="a scenario whose expectations name requirements; those beside the model unless given",
    )  # fmt: skip


def gathered(options: argparse.Namespace) -> Facts:
    """The facts of a model; Refused with its errors, files named as the call names them."""
    from ravenchart.evidence import facts

    model: Path = options.model
    try:
        with progress(f"check {model.name}"):
            found = facts.gather(
                model,
                options.driver,
                options.record,
                options.tests,
                memory=options.memory,
                coverage=options.coverage,
            )
    except Refused:
        common.checked(options, deadlines=False)  # tells the same with the path as given
        raise
    if found.checked.diagnostics:
        common.checked(options, deadlines=False)
    return found


def execute(options: argparse.Namespace) -> int:
    """Write the folder; the exit status."""
    from ravenchart.evidence import folder, lists
    from ravenchart.gen.diagnostics import render_all

    place = options.out or folder.default_folder(options.model)
    try:
        listed = options.requirements
        requirements = None if listed is None else lists.read(listed, listed.name)
        found = gathered(options)
        with progress("judge the claims"):
            made = folder.make(found, requirements, options.scenario)
    except Refused:
        folder.remove(place)  # it would speak of other content
        raise
    folder.write(place, made)
    counts = Counter(claim.verdict.value for claim in made.claims)
    for claim in made.claims:
        if claim.verdict.value in BAD:
            reason = claim.reasons[0] if claim.reasons else claim.theorem
            print(f"{claim.id}: {claim.verdict.value}: {reason}")
    traced = [one for one in made.findings if one.code.startswith("RV-14")]
    if traced:
        print(render_all(traced, {}))
    words = ("met", "partly", "not met", "not shown", "user's")
    print(f"{place}: claims: {', '.join(f'{counts[word]} {word}' for word in words)}")
    options.answer.add(traced)
    options.answer.result = EvidenceResult(
        str(place),
        sorted(made.texts),
        {word: counts[word] for word in words},
    )
    return WRONG if traced or any(counts[word] for word in BAD) else OK
