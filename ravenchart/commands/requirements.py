# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart requirements`: traceability from requirements to tests, and back."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from ravenchart.failures import OK, WRONG
from ravenchart.terminal import progress

from . import common, evidence
from .results import RequirementsResult, TracedElement, TracedRequirement


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    common.add_model(sub)
    sub.add_argument(
        "list", type=Path, metavar="FILE",
        help="the list of requirements: CSV with the columns id and text, or ReqIF",
    )  # fmt: skip
    evidence.add_sources(sub)


def execute(options: argparse.Namespace) -> int:
    """Trace and print both ways; the exit status."""
    from ravenchart.evidence import claims, lists, tracing
    from ravenchart.gen.diagnostics import render_all

    requirements = lists.read(options.list)
    facts = evidence.gathered(options)
    with progress("judge the claims"):
        found = claims.claims(facts)
        trace = tracing.traced_requirements(facts, found, requirements, options.scenario)
    for one in trace.forward:
        print(f"{one.requirement.id}  {one.requirement.text}")
        for title, words in (
            ("element", [f"{link.element} ({link.kind}, {link.origin})" for link in one.links]),
            ("code", list(one.code)),
            ("claim", [f"{claim.id}: {claim.verdict.value}" for claim in one.claims]),
            ("test", [f"{probe.name}: {probe.outcome}" for probe in one.probes]),
        ):
            for word in words or ["none"]:
                print(f"  {title:<8}{word}")
    print("\nBack from the elements of the model:")
    for back in trace.backward:
        print(f"  {back.link.element} ({back.link.kind}): {', '.join(back.link.ids)}")
    if trace.findings:
        print(render_all(trace.findings, {}), file=sys.stderr)
    count = common.several(len(trace.findings), "finding")
    print(f"{common.several(len(requirements), 'requirement')}, {count}")
    options.answer.add(trace.findings)
    options.answer.result = RequirementsResult(
        [
            TracedRequirement(
                one.requirement.id,
                one.requirement.text,
                [link.element for link in one.links],
                list(one.code),
                {claim.id: claim.verdict.value for claim in one.claims},
                {probe.name: probe.outcome for probe in one.probes},
            )
            for one in trace.forward
        ],
        [
            TracedElement(
                back.link.element,
                back.link.kind,
                list(back.link.ids),
                list(back.code),
                [claim.id for claim in back.claims],
            )
            for back in trace.backward
        ],
    )
    return WRONG if trace.findings else OK
