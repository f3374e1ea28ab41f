"""The chains of a model in the timing certificate: sums of what tasks and messages claim."""

from __future__ import annotations

from ..claims import ChainClaim, Step
from ..model import Processor, System
from .ada import Chain, Comment, Decl, Expr, Ref, number
from .certificate_terms import assured, name_of, named, plus, refuse, stated, times
from .naming import ada_case

SUFFIX = {"row": "Done", "item": "R", "handed": "Handed"}
"""What the response of a step is called."""


def chain_claims(system: System, claim: ChainClaim) -> list[Decl]:
    """The reaction time and the age of a chain as sums.

    What is released by the step before it counts from the same event, so of such
    steps the last one stands for all.
    """
    own = f"Chain_{ada_case(claim.name)}"
    words = [f"[{claim.name}] from end to end."]
    reaction: list[Expr] = []
    age: list[Expr] = []
    items: list[Decl] = []
    for number_, step in enumerate(claim.steps, 1):
        before = claim.steps[number_ - 2] if number_ > 1 else None
        if step.hop == "released" and before is not None:
            del reaction[-1], age[-1]  # its response counts from the same event
        elif step.hop == "sampled":
            words.append(f"{step.element} samples.")
            reaction.append(_period(system, step))
        elif step.hop == "queued" and before is not None:
            words.append(f"{step.element} takes one of a queue: Wait_{number_}.")
            wait = f"{own}_Wait_{number_}"
            items += _queue(system, wait, before, step, claim.name)
            reaction.append(Ref(wait))
            age.append(Ref(wait))
        reaction.append(_response(step))
        age.append(_response(step))
        if step.renewed:
            age.append(_period(system, step))
    chain = next(chain for chain in system.chains if chain.name == claim.name)
    items = [Comment(" ".join(words)), *items]
    for what, terms, bound, limit in (
        ("Reaction", reaction, claim.reaction, chain.reaction),
        ("Age", age, claim.age, chain.age),
    ):
        if limit is None:
            continue
        items += [
            stated(f"{own}_{what}", bound),
            stated(f"{own}_{what}_Limit", limit),
            named(f"{own}_{what}_Needs", plus(*terms)),
        ]
        needs, claimed = Ref(f"{own}_{what}_Needs"), Ref(f"{own}_{what}")
        problem = f"can have a longer {what.lower()} than claimed"
        items.append(refuse(needs, claimed, f"chain {claim.name}", problem))
        problem = f"can exceed the limit of its {what.lower()}"
        items.append(refuse(claimed, Ref(f"{own}_{what}_Limit"), f"chain {claim.name}", problem))
        items.append(assured(needs, Ref(f"{own}_{what}_Limit")))
    return items


def _response(step: Step) -> Expr:
    return Ref(f"{name_of(step.element)}_{SUFFIX[step.kind]}")


def _period(system: System, step: Step) -> Expr:
    """The distance of its outputs."""
    if step.kind != "row":
        return Ref(f"{name_of(step.element)}_T")
    processor = system.processor_of(step.element)
    return times(number(_divisor(processor, step.element)), Ref(f"{name_of(processor.name)}_T"))


def _divisor(processor: Processor, row: str) -> int:
    return next(slot.divisor for slot in processor.slots if slot.element == row)


def _queue(system: System, wait: str, before: Step, step: Step, chain: str) -> list[Decl]:
    """How long an item waits for its reader, who takes one in a job.

    The wait is longest for the last of those that lateness lets come at once, or
    for the next.
    """
    late, period, cycle = _response(before), _period(system, before), _period(system, step)
    burst = f"{wait}_Burst"
    label = f"chain {chain}"
    last = times(Ref(burst), cycle)
    gone = Chain("*", (number(-1), Ref(burst), period))
    following = plus(times(plus(Ref(burst), number(1)), cycle), late, gone)
    problem = "can wait longer in a queue than claimed"
    return [
        named(burst, plus(Chain("/", (late, period)), number(1))),
        stated(wait, step.wait),
        refuse(cycle, period, label, "has a queue that fills"),
        refuse(last, Ref(wait), label, problem),
        refuse(following, Ref(wait), label, problem),
    ]
