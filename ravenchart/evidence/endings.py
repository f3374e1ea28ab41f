# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The claim that each execution of a program ends."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.emit.nodes.termination import ending_claims
from ravenchart.proof.outside_spark import own_names

from . import records
from .claim import Claim, ClaimKind, Shown, verdict_of
from .facts import Facts, NodeFacts

NO_RECORD = "no record of termination is given: `ravenchart prove --record FILE` writes it too"


def endings(facts: Facts) -> Iterator[Claim]:
    """The claim about each node that runs something."""
    for node in facts.nodes:
        if ending_claims(node.program.part):
            yield _ending(facts, node)


def _ending(facts: Facts, node: NodeFacts) -> Claim:
    record, claims = node.ending, ending_claims(node.program.part)
    problems = [NO_RECORD] if record is None else [*record.problems, *_missing(node)]
    verdict = verdict_of(problems, shown=record is not None)
    hidden = _outside(facts, node)
    if record is not None and record.proved < record.checks and len(problems) == 1 and hidden:
        verdict = Shown.PARTLY
        problems = [f"{problems[0]}: rows may call what is outside SPARK, {', '.join(hidden)}"]
    several = len(facts.nodes) > 1
    slots = node.program.part.slots
    return Claim(
        f"termination-{node.name}" if several else "termination",
        ClaimKind.PROGRAM,
        tuple(sorted({claim.element for claim in claims})),
        f"Each execution{f' on {node.name}' if several else ''} ends: no loop and no recursion "
        "below it is endless",
        "gnatprove: each row of each processor, and what the processor calls beside it, is called "
        "by a procedure that is declared to terminate. Loops and recursions need a variant. "
        f"{len(claims)} claims about {len(slots)} rows.",
        "proof",
        records.UNKNOWN_TOOL if record is None else record.tool,
        verdict,
        tuple(problems),
        (
            *(() if record is None else ((f"record {record.name}", record.digest),)),
            *(() if record is None else record.sources),
            *node.files,
        ),
    )


def _outside(facts: Facts, node: NodeFacts) -> tuple[str, ...]:
    """Bodies outside SPARK that rows may call, by the list beside the model."""
    own = own_names(name for name, _ in facts.reasons)
    found = () if node.record is None else node.record.outside
    return tuple(name for name in found if not records.uncovered((name,), own))


def _missing(node: NodeFacts) -> Iterator[str]:
    """Gaps of the record of termination."""
    yield from (f"the program is not what this model gives: {one}" for one in node.differences)
    assert node.ending is not None
    shown = {entity.name.lower() for entity in node.ending.entities}
    for claim in ending_claims(node.program.part):
        if claim.entity.lower() not in shown:
            yield f"the record says nothing of {claim.element} ({claim.entity})"
