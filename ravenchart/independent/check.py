# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The whole check of one model."""

from __future__ import annotations

from pathlib import Path

from .arrays import counted_out
from .composites import written_out
from .declared import check_component
from .deployment import Deployment
from .findings import Report, UnusableError
from .model import generated_name, parted, read
from .timing import Timing

ALWAYS = (
    "who shares objects other than devices: each task counts as blocked for a critical section",
    "how guards are put together, and all effects, entries and exits",
    "leaves that histories restore, selection, deferral, and all contracts",
    "bodies of the program: gnatprove proves them against the declared form",
    "use of the certificate's facts by the program: the compiler compares them",
)
"""Facts that this checker does not compare."""


MALFORMED = (LookupError, ValueError, StopIteration, RecursionError)
"""Exceptions of reading a text that has another form."""


def checked(main: Path, generated: Path | None = None) -> Report:
    """The report on a model and its generated program."""
    report = Report()
    model = read(main)
    file, chosen = parted(main)
    name = generated_name(file)
    folder = main.parent / name / chosen.lower() if generated is None else generated
    try:
        deployment = Deployment(written_out(counted_out(model)))
        programs = deployment.programs(folder)
    except MALFORMED as problem:
        raise UnusableError(f"{main} is no valid model: {problem}") from problem
    if not programs or not deployment.tasks:
        raise UnusableError(f"{main} has no processors: there is nothing to compare")
    for program, instances in programs:
        if not program.is_dir():
            raise UnusableError(f"{program} is missing: generate the program first")
        try:
            _check(deployment, program, instances, report)
        except MALFORMED as problem:
            raise UnusableError(f"{program} cannot be compared: {problem}") from problem
    for what in ALWAYS:
        report.skip(what, 0)
    return report


def _check(deployment: Deployment, program: Path, instances: list[str], report: Report) -> None:
    """The program of one node."""
    model = deployment.model
    path = program / f"{model.name.lower()}-timing_certificate.ads"
    Timing(deployment, path, report).check()
    kinds = model.section("components")
    here = (deployment.instances.map(one).text("component") or "" for one in instances)
    for component in dict.fromkeys(kinds.name(kind) for kind in here):
        if component is not None:
            check_component(model, component, program, report)
