# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The facts about a controller that are not shown: the first page of the folder."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from ravenchart.analysis.units import duration
from ravenchart.gen.emit.commands.lifecycle import has_lifecycle

from . import ledger
from .claim import Claim, Shown
from .documents import Lack
from .facts import Facts
from .records import UNKNOWN_TOOL
from .results import PASSED

ORDER = (Shown.NOT_MET, Shown.NOT_SHOWN, Shown.PARTLY, Shown.USERS)

LIMITS = (
    ("object code", "Proof is about source code. The compiler and its run-time library are taken "
     "as correct (ASM-006, ASM-009)."),
    ("invariants", "`never` is a contract of the generated code only where a claim says so "
     "(code-never-...). Any other is checked on the model."),
    ("effects", "No postcondition states what an effect does to the data, nor what a body of an "
     "activity without `ensures` does."),
    ("mutation", "No mutation score is part of this folder."),
    ("records", "A proof record is a text file, and can be edited. To check it, run "
     "`ravenchart prove MODEL --fresh` and compare."),
    ("requirements", "An id at an element says that somebody saw a connection. That the element "
     "implements the text needs a review."),
)  # fmt: skip
"""Facts that no folder shows."""


_UNCOVERED = Lack(
    "limit",
    "coverage",
    "No structural coverage is given: `ravenchart tests MODEL --coverage FILE` counts it, and "
    "`--coverage FILE` here makes claims of it.",
)


def gaps(facts: Facts, claims: Sequence[Claim]) -> tuple[Lack, ...]:
    """All of them, the worst first."""
    return (
        *_claims(claims),
        *_assumptions(facts),
        *_outside(facts),
        *_given(facts),
        *_tests(facts),
        *_tools(facts),
        *(() if facts.coverage else (_UNCOVERED,)),
        *(Lack("limit", what, why) for what, why in LIMITS),
    )


def _claims(claims: Sequence[Claim]) -> Iterator[Lack]:
    for verdict in ORDER:
        for claim in claims:
            if claim.verdict is verdict:
                reason = claim.reasons[0] if claim.reasons else claim.theorem
                more = f" (and {len(claim.reasons) - 1} more)" if len(claim.reasons) > 1 else ""
                yield Lack("claim", claim.id, f"{verdict.value}: {reason}{more}")


def _assumptions(facts: Facts) -> Iterator[Lack]:
    found = ledger.in_use(facts.checked.system, facts.driver)
    for one in found:
        yield Lack("assumption", one.id, f"{one.title[:1].upper()}{one.title[1:]}. {one.text}")
    if not found:
        yield Lack("assumption", "ledger", "the ledger of assumptions is missing")


def _outside(facts: Facts) -> Iterator[Lack]:
    if has_lifecycle(facts.checked.system):
        told = "no check of its body is made: ASM-019"
        yield Lack("outside", "Ravenchart.Device_Failures", told)
    for name, reason in (*facts.runtime_reasons, *facts.reasons):
        yield Lack("outside", name, f"no check of its body is made: {reason}")


def _given(facts: Facts) -> Iterator[Lack]:
    system = facts.checked.system
    given = "is given by the model, and not measured"
    for processor in system.processors:
        for slot in processor.slots:
            yield Lack("given", slot.element, f"wcet {duration(slot.timing.wcet)} {given}")
    for node in system.nodes:
        figures = [
            ("context_switch", node.context_switch),
            ("critical_section", node.critical_section),
            ("release", node.release),
        ]
        told = ", ".join(f"{name} {duration(value)}" for name, value in figures)
        yield Lack("given", node.name, f"{told}: {given}")
    for device in system.devices:
        if device.type is not None:
            told = f"the WCETs of the commands of {device.type.name}"
            yield Lack("given", device.name, f"{told} are given by the model, and not measured")
    for bus in system.buses:
        yield Lack("given", bus.name, f"driver_wcet {duration(bus.driver_wcet)} {given}")
        if bus.errors is None:
            yield Lack("given", bus.name, "bounds hold for a bus without errors: `errors` is empty")
        else:
            every = duration(bus.errors.period)
            yield Lack(
                "given", bus.name,
                f"bounds hold for {bus.errors.burst} errors at once and one every {every}",
            )  # fmt: skip


def _tests(facts: Facts) -> Iterator[Lack]:
    if facts.tests is None:
        yield Lack("test", "tests", "no results of tests are given, so none is shown to pass")
        return
    for test in facts.tests:
        if test.outcome != PASSED:
            yield Lack("test", test.name, f"{test.outcome}: {test.why}")


def _tools(facts: Facts) -> Iterator[Lack]:
    held = [node.record for node in facts.programs if node.record is not None]
    names = [one.name for one in (*held, *facts.runtime) if one.tool == UNKNOWN_TOOL]
    if names:
        told = re.sub(r", ([^,]*)$", r" and \1", ", ".join(dict.fromkeys(names)))
        yield Lack("limit", "prover", f"the version of gnatprove is not recorded in {told}")
