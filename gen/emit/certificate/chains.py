# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The chains of a model in the timing certificate: sums of the claimed bounds of their steps.

The model decides which sums (`hops`); claims are numbers only.
"""

from __future__ import annotations

import math

from ravenchart.gen.emit.ada.declarations import Decl
from ravenchart.gen.emit.ada.expressions import Expr, OperatorChain, number
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.statements import Comment
from ravenchart.gen.model.claims import ChainClaim
from ravenchart.gen.model.logical import first_of, period_of, timed_row
from ravenchart.gen.model.system import Chain, Processor, System

from .certified import first_release
from .hops import ClaimedHop, hops_of
from .terms import assured, exact, name_of, named_number, none_of, plus, refuse, stated, times

SUFFIX = {"row": "Done", "item": "R", "handed": "Handed", "transfer": "Transfer"}
"""The endings of the names that steps have for their responses."""


def chain_claims(system: System, chain: Chain, claim: ChainClaim) -> list[Decl]:
    """The reaction time and the age of a chain as sums.

    A step that the one before releases counts from the same event. So of such steps the last
    one stands for all. An output is renewed at least as often as the rows that make it run:
    where a queue is filled, and where a sampled row begins the next part. A step that repeats
    the values of a queue renews nothing.
    """
    own = f"Chain_{ada_case(chain.name)}"
    hops = hops_of(system, chain)
    words = [f"[{chain.name}] end-to-end latency."]
    reaction: list[Expr] = []
    age: list[Expr] = []
    items: list[Decl] = []
    queued = False
    waits = iter(claim.waits)
    for place, hop in enumerate(hops):
        before = hops[place - 1] if place else None
        if hop.how == "released" and before is not None:
            del reaction[-1], age[-1]  # its response counts from the same event
            if hop.rare and before.kind == "row":
                words.append(f"{hop.element} follows some jobs of {before.element} only.")
                reaction.append(OperatorChain("-", (_period(system, hop), _period(system, before))))
            if hop.kind == "transfer":
                words.append(f"{hop.element} waits for the previous value.")
                reaction.append(OperatorChain("-", (_longest(system, hop), _period(system, hop))))
        elif hop.how == "sampled":
            words.append(f"{hop.element} samples.")
            sender = None if before is None else _sender(hops[:place])
            saved: list[Expr] = []
            if hop.link is not None and before is not None:
                reaction[-1] = age[-1] = ref(f"{name_of(hop.link.sender.name)}_Let")
                items += _grid(system, f"{own}_{place + 1}", (before, hop), chain.name)
                saved = [ref(f"{own}_{place + 1}_Grid"), ref(f"{own}_{place + 1}_Lag")]
            reaction.append(_less(_period(system, hop), saved))
            if sender is not None and not queued:
                age.append(_less(_longest(system, sender), saved))
            queued = False
        elif hop.how == "woken" and before is not None:
            words.append(f"A queue releases {hop.element}; a value waits for its response time.")
            separation, more = _period(system, hop), hop.at_once - 1
            filled = times(number(hop.at_once), separation), _period(system, before)
            items.append(refuse(*filled, f"chain {chain.name}", "can fill a queue"))
            delays = [_response(hop), *([times(number(more), separation)] if more else [])]
            reaction += delays
            age += delays
        elif before is not None:
            words.append(f"{hop.element} reads a queue; Wait_{place + 1} is the wait in it.")
            wait = f"{own}_Wait_{place + 1}"
            items += _queue(system, wait, (before, hop), next(waits, 0), chain.name)
            reaction.append(ref(wait))
            age += [_renewal(system, hops[:place]), ref(wait)]
            queued = True
        reaction.append(_response(hop))
        age.append(_response(hop))
    items = [Comment(" ".join(words)), *items]
    waiting = [hop.element for hop in hops if hop.open]
    kept = [hop.element for hop in hops[:-1] if not hop.sure]
    kept += [hop.element for hop in hops if hop.open and hop.how == "queued"]
    for what, terms, bound, limit, without in (
        ("Reaction", reaction, claim.reaction, chain.reaction, waiting),
        ("Age", age, claim.age, chain.age, kept),
    ):
        if limit is None:
            continue
        items += [
            stated(f"{own}_{what}", bound),
            stated(f"{own}_{what}_Limit", limit),
            named_number(f"{own}_{what}_Needs", plus(*terms)),
        ]
        label, low = f"chain {chain.name}", what.lower()
        needs, claimed = ref(f"{own}_{what}_Needs"), ref(f"{own}_{what}")
        items.append(exact(claimed, [needs], label, low))
        problem = f"can exceed the limit of its {low}"
        items.append(refuse(claimed, ref(f"{own}_{what}_Limit"), label, problem))
        items.append(assured((needs, ref(f"{own}_{what}_Limit"))))
        if not hops or without:
            problem = f"can have any {low}: " + (without[0] if without else "its way is broken")
            items.append(refuse(number(1), number(0), label, problem))
    return items


def _less(period: Expr, saved: list[Expr]) -> Expr:
    """The longest distance of instants with one epoch: period - grid + lag."""
    if not saved:
        return period
    grid, lag = saved
    return OperatorChain("+", (OperatorChain("-", (period, grid)), lag))


def _grid(system: System, own: str, hops: tuple[ClaimedHop, ClaimedHop], chain: str) -> list[Decl]:
    """The instants from which on values are visible, and those at which they are taken.

    Grid divides both periods, so the distances of the instants are Lag and some grids more.
    """
    before, hop = hops
    assert hop.link is not None
    one, other = (timed_row(system, step.element) for step in hops)
    step, lag = ref(f"{own}_Grid"), ref(f"{own}_Lag")
    visible = f"{name_of(hop.link.sender.name)}_Let"
    grid = math.gcd(period_of(*one), period_of(*other))
    late = (first_of(*other) - first_of(*one) - hop.link.lasting) % grid
    shown = first_release(system, *one), ref(visible), lag
    apart = first_of(*one) + hop.link.lasting + late - first_of(*other)
    rounds = times(number(abs(apart) // grid), step)
    sides = plus(*shown), plus(first_release(system, *other), rounds)
    if apart < 0:
        sides = plus(*shown, rounds), first_release(system, *other)
    wrong: list[Expr] = [OperatorChain(">=", (lag, step)), OperatorChain("/=", sides)]
    for period in (_period(system, before), _period(system, hop)):
        whole = times(OperatorChain("/", (period, step)), step)
        wrong.append(OperatorChain("/=", (period, whole)))
    return [
        stated(step, grid),
        stated(lag, late),
        *none_of(wrong, f"chain {chain}", "supposes other instants"),
    ]


def _response(hop: ClaimedHop) -> Expr:
    return ref(f"{name_of(hop.element)}_{SUFFIX[hop.kind]}")


def _period(system: System, hop: ClaimedHop) -> Expr:
    """The distance of its outputs."""
    if hop.kind != "row":
        return ref(f"{name_of(hop.element)}_T")
    processor = system.processor_of(hop.element)
    return times(number(_divisor(processor, hop.element)), ref(f"{name_of(processor.name)}_T"))


def _longest(system: System, hop: ClaimedHop) -> Expr:
    """The longest distance of its outputs."""
    return ref(f"{name_of(hop.renewed)}_Renewal") if hop.renewed else _period(system, hop)


def _sender(hops: tuple[ClaimedHop, ...]) -> ClaimedHop:
    """The step whose period the outputs of these have: the last, or what releases its processor."""
    found = len(hops) - 1
    for place in range(len(hops) - 1, 0, -1):
        if hops[place].how == "woken":
            found = place - 1
        elif hops[place].how != "released":
            break
    return hops[found]


def _renewal(system: System, hops: tuple[ClaimedHop, ...]) -> Expr:
    """How often new values come out of these steps: what only passes them on adds nothing."""
    begins = max((n for n, hop in enumerate(hops) if hop.how == "sampled"), default=0)
    slowest = next((hop for hop in hops[begins:] if hop.renewed), hops[begins])
    return _longest(system, slowest)


def _divisor(processor: Processor, row: str) -> int:
    return next(slot.divisor for slot in processor.slots if slot.element == row)


def _queue(
    system: System, wait: str, hops: tuple[ClaimedHop, ClaimedHop], claimed: int, chain: str
) -> list[Decl]:
    """How long an item waits for its reader, who takes one in a job.

    The wait is longest for the last item that lateness lets come at once, or for the
    last that the next job of the writer puts in.
    """
    before, hop = hops
    late, period, cycle = _response(before), _period(system, before), _period(system, hop)
    burst = f"{wait}_Burst"
    label, many = f"chain {chain}", number(hop.at_once)
    last = times(ref(burst), many, cycle)
    full = plus(times(plus(ref(burst), number(1)), many, cycle), late)
    following = OperatorChain("-", (full, times(ref(burst), period)))
    return [
        named_number(burst, plus(OperatorChain("/", (late, period)), number(1))),
        stated(wait, claimed),
        refuse(times(many, cycle), period, label, "can fill a queue"),
        exact(ref(wait), [last, following], label, "wait in a queue"),
    ]
