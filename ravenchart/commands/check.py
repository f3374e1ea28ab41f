# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart check`: the rules of a model, its behaviour and its deadlines."""

from __future__ import annotations

import argparse
from collections.abc import Iterator

from ravenchart.failures import OK, Refused, Unusable
from ravenchart.gen.files.load import deployments_of
from ravenchart.gen.model.notation import shown_expression
from ravenchart.gen.model.safety import SafeRegion
from ravenchart.gen.model.system import System

from . import common
from .build_results import CheckResult


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    common.add_model(sub)
    sub.add_argument(
        "--watch", action="store_true",
        help="check again whenever a file of the model changes, until Ctrl-C",
    )  # fmt: skip
    sub.add_argument(
        "--all", action="store_true", help="check each deployment of the model, one after another"
    )


def execute(options: argparse.Namespace) -> int:
    """Check it; the exit status."""
    if options.watch:
        from . import watching

        if options.json:
            raise Unusable("--watch cannot be combined with --json: it does not end")
        watching.watch(options.model)
    if options.all:
        return _all(options)
    return _one(options)


def _all(options: argparse.Namespace) -> int:
    """Check each deployment; Refused in the end where one has errors."""
    if options.json:
        raise Unusable("--all cannot be combined with --json: check each deployment by itself")
    refused: dict[str, Refused] = {}
    first: dict[str, str] = {}
    paths = deployments_of(options.model)
    for options.model in paths:
        name = options.model.name
        print(f"--- {name} ---", flush=True)
        try:
            _one(options)
        except Refused as problem:
            refused[name] = problem
            other = first.setdefault(problem.shown(), name)
            print(problem.shown() if other == name else f"the same errors as in {other}")
    if refused:
        found = [one for problem in refused.values() for one in problem.found]
        text = f"{len(refused)} of {common.several(len(paths), 'deployment')} have errors: "
        raise Refused(text + ", ".join(refused), found)
    return OK


def _one(options: argparse.Namespace) -> int:
    found = common.checked(options, finish=True, library=True)
    system = found.system
    options.answer.result = CheckResult(
        system.name,
        system.digest,
        len(system.instances),
        len(system.processors),
        len(system.messages),
        {
            f"{safe.component}.{name}": list(_facts(system, safe))
            for safe in system.safe_regions
            for name in safe.invariants
        },
    )
    print(common.verdict(found))
    for safe in system.safe_regions:
        count = common.several(len(safe.invariants), "invariant")
        names = ", ".join(safe.invariants)
        print(f"{safe.component}.{safe.region}: its code has contracts of {count}: {names}")
        for fact in _facts(system, safe):
            print(f"  their proof uses: {fact}")
    return OK


def _facts(system: System, safe: SafeRegion) -> Iterator[str]:
    """The facts about data in the proof of a region's invariants, leaf by leaf."""
    component = next(c for c in system.components if c.name == safe.component)
    for fact in safe.facts:
        yield f"in {fact.vertex}, {shown_expression(fact.condition(component))}"
