# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Claims about times: by the analysis, and by the certificate that the compiler checks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from ravenchart.analysis.system.timing import Analysis, Verdict
from ravenchart.analysis.units import duration
from ravenchart.gen.emit.ada.naming import root_package
from ravenchart.gen.model.system import Processor

from .claim import NO_RECORD, Claim, ClaimKind, Shown, own_tool
from .facts import Facts


@dataclass(frozen=True, slots=True)
class _Certificate:
    """Why the timing certificates do not show the bounds: what is wrong, and what is missing."""

    wrong: tuple[str, ...]
    missing: tuple[str, ...]


def _certified(facts: Facts) -> _Certificate:
    if facts.ungenerated:
        return _Certificate((f"no certificate can be made: {facts.ungenerated}",), ())
    problems: list[str] = []
    missing: list[str] = []
    unit = f"{root_package(facts.checked.system)}.Timing_Certificate"
    for node in facts.nodes:
        name = f"{unit.lower().replace('.', '-')}.ads"
        problems += [one for one in node.differences if one.startswith(f"{name} ")]
        if node.record is None:
            missing.append(f"that the compiler accepts the certificate is not shown: {NO_RECORD}")
        elif node.record.problems:
            problems.append(f"the record of its proof does not hold: {node.record.problems[0]}")
        elif not node.record.of_unit(unit):
            problems.append(f"the record has no check of {unit}")
    return _Certificate(tuple(dict.fromkeys(problems)), tuple(dict.fromkeys(missing)))


def _bounded(
    facts: Facts, id_: str, elements: Iterable[str], statement: str, theorem: str,
    problems: Sequence[str], certificate: _Certificate,
) -> Claim:  # fmt: skip
    """A claim on a time: by the analysis, and by the certificate that the compiler checks."""
    wrong = (*problems, *certificate.wrong)
    verdict = Shown.NOT_MET if wrong else Shown.PARTLY if certificate.missing else Shown.MET
    inputs = [*facts.sources]
    for node in facts.nodes:
        inputs += [pair for pair in node.files if "timing_certificate" in pair[0]]
        if node.record is not None:
            inputs.append((f"record {node.record.name}", node.record.digest))
    return Claim(
        id_, ClaimKind.TIMING, tuple(dict.fromkeys(elements)), statement, theorem,
        "analysis, and certificate checked by compiler and gnatprove", own_tool(),
        verdict, (*wrong, *certificate.missing), tuple(inputs),
    )  # fmt: skip


SUM = (
    "response-time analysis of fixed priorities with blocking, and its sum in static expressions "
    "of `Timing_Certificate`. It rests on the worst-case execution times that the model gives."
)


def bounds(facts: Facts) -> Iterator[Claim]:
    system, analysis = facts.checked.system, facts.checked.analysis
    certificate = _certified(facts)
    for name in analysis.tasks:
        task = analysis.tasks[name]
        statement, problems = _deadline(analysis, name)
        owner = next((p for p in system.processors if p.name == name), None)
        rows = [] if owner is None else [*_row_elements(facts, owner)]
        slots = {slot.element: slot for slot in task.slots}
        for row in analysis.response(name).rows:
            slot = slots[row.row.name]
            if row.bound > slot.timing.deadline:
                limit = duration(slot.timing.deadline)
                problems.append(f"{slot.element}: R = {duration(row.bound)}, but D = {limit}")
        yield _bounded(
            facts, f"deadline-{name}", (name, *rows), f"Task {statement}", SUM, problems,
            certificate,
        )  # fmt: skip
    for name, message in analysis.messages.items():
        statement, problems = _deadline(analysis, name)
        if message in analysis.undelivered:
            problems.append("it may wait for its reception without bound")
        yield _bounded(
            facts, f"deadline-{name}", (message.name,), f"Message {statement}",
            "response-time analysis of CAN frames by identifier, with blocking, bit stuffing and "
            "the errors that the model gives", problems, certificate,
        )  # fmt: skip
    limited = {chain.name: found for chain, found in analysis.limited}
    for chain in system.chains:
        found = limited.get(chain.name)
        problems = [] if found is not None and found.met else ["a limit is not kept, or no bound"]
        limits = [
            f"{word} at most {duration(limit)}"
            for word, limit in (("reaction", chain.reaction), ("age", chain.age))
            if limit is not None
        ]
        yield _bounded(
            facts, f"chain-{chain.name}", (chain.name, *map(str, chain.path)),
            f"Chain {chain.name}: {', '.join(limits)}",
            "end-to-end latency along the way of the values, row by row", problems, certificate,
        )  # fmt: skip
    short = [f"{one.what}: depth {one.given}, needed {one.needed}" for one in
             analysis.short_queues]  # fmt: skip
    yield _bounded(
        facts, "queues", (system.name,), "Every queue holds all that may wait in it at once",
        "the depth of each queue against what may wait in it at once", short, certificate,
    )  # fmt: skip


def _deadline(analysis: Analysis, name: str) -> tuple[str, list[str]]:
    """R and D of a task or message in words, and why the deadline is not kept."""
    bound, deadline = analysis.found.from_event(name), analysis.found.deadline(name)
    verdict = analysis.verdict(name)
    told = "no bound" if bound is None else f"R = {duration(bound)}"
    if verdict is Verdict.MET:
        return f"{name} is done by its deadline: {told}, D = {duration(deadline)}", []
    return (
        f"{name} is done by its deadline D = {duration(deadline)}",
        [f"{told}, but D = {duration(deadline)}"],
    )


def _row_elements(facts: Facts, processor: Processor) -> Iterator[str]:
    """The rows of a table, and what they run in the component."""
    system = facts.checked.system
    for slot in processor.slots:
        yield slot.element
        if not slot.of_bus:
            yield f"{system.instance(slot.owner).component.name}.{slot.name}"
