# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Deadlines that a processor keeps by its offset: every instant at which releases meet.

The claimed bound holds for any offsets, and is above the deadline. A busy period that delays the
processor begins at an instant at which a processor of its level is released, late by its jitter.
Jobs that arrive earlier than that jitter before it are done (Tindell 1994). So of processors the
releases due in [instant - J, instant + W) count, and no others. The certificate also shows that
no instant is left out. Between a listed one and the next there is none within the reach, and
after the last of a cycle comes the first once more.
"""

from __future__ import annotations

from ravenchart.gen.derive.instants import Instant, cycle_of, instants, lateness, phased
from ravenchart.gen.emit.ada.declarations import Decl
from ravenchart.gen.emit.ada.expressions import Expr, OperatorChain, number
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.statements import Comment
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.claims import ResponseClaim
from ravenchart.gen.model.system import System, Task

from .interference import costs, demand_within, platform
from .terms import (
    LATE,
    ONE,
    OVERLAP,
    RESPONSE,
    assured,
    ceiling,
    exact,
    name_of,
    named_number,
    plus,
    refuse,
    stated,
    times,
)

UNLISTED = "can be late from an instant that is not listed"


def offset_claims(system: System, task: Task, claim: ResponseClaim) -> list[Decl]:
    """That a job is done by its deadline, whichever instant its busy period begins at."""
    own, label = name_of(task.element), task.element
    reach = claim.response - lateness(system, task) - task.deadline
    bound, jitter, period, deadline = (ref(f"{own}_{letter}") for letter in "RJTD")
    items: list[Decl] = [
        Comment(
            f"[{label}] meets its deadline with its offset; R, for any offsets, is too long.\n"
            "At: an instant at which a processor of its priority or a higher one is released, as "
            "late as possible, less than Reach before its own job is due. All repeat with Cycle. "
            "A job whose busy period begins at no such instant has a response time of at most "
            "R - Reach. Releases of these processors that are due from At - J on and before "
            "At + W delay the job.\n"
            "Since: the instant before At, or Reach before the job is due. No instant lies "
            "between Since and At."
        ),
        stated(f"{own}_Reach", reach),
        refuse(OperatorChain("-", (bound, jitter, ref(f"{own}_Reach"))), deadline, label, LATE),
        refuse(deadline, period, label, OVERLAP),
    ]
    found = instants(system, task, reach) or ()
    if not found:
        return [*items, refuse(bound, deadline, label, LATE)]
    between = _begun(system, task)
    windows = (*claim.since, *[0] * len(found))
    for place, (instant, length) in enumerate(zip(found, windows, strict=False), 1):
        names = [f"{own}_{part}_{place}" for part in ("At", "W_At", "Needs_At")]
        at, window, needs = map(ref, names)
        due = plus(ref(f"{own}_O"), times(number(instant.release), period))
        work = [ref(c) for n, c in costs(task).items() if instant.release % n == 0]
        items += [
            stated(names[0], instant.time),
            stated(names[1], length),
            named_number(names[2], plus(*work, *_delay(system, task, at, window))),
            exact(window, [needs], label, RESPONSE, least=1),
            refuse(plus(at, window), plus(due, deadline), label, LATE),
            refuse(plus(due, jitter, ONE), plus(at, period), label, UNLISTED),
            assured((needs, window)),
        ]
        reached = OperatorChain("-", (due, ref(f"{own}_Reach")))
        between += _all_between(system, task, found, place, reached, reach)
    return items + between


def _begun(system: System, task: Task) -> list[Decl]:
    """That the releases of its level repeat with the cycle, which all have begun before."""
    own, label = name_of(task.element), task.element
    cycle = ref(f"{own}_Cycle")
    tasks = phased(system, task)
    items: list[Decl] = [stated(f"{own}_Cycle", cycle_of(tasks))]
    for other in tasks:
        name = name_of(other.element)
        for divisor in sorted({slot.divisor for slot in other.slots}):
            period = times(number(divisor), ref(f"{name}_T"))
            whole = times(OperatorChain("/", (cycle, period)), period)
            items.append(refuse(cycle, whole, label, UNLISTED))
        first = plus(ref(f"{name}_O"), ref(f"{name}_J"), cycle)
        items.append(refuse(first, ref(f"{own}_At_1"), label, UNLISTED))
    return items


def _all_between(
    system: System, task: Task, found: tuple[Instant, ...], place: int, reached: Expr, reach: int
) -> list[Decl]:
    """That no instant is left out between one that is listed and that before it."""
    own, label = name_of(task.element), task.element
    at, since = ref(f"{own}_At_{place}"), ref(f"{own}_Since_{place}")
    before: Expr = ref(f"{own}_At_{place - 1}")
    last = found[place - 2].time
    if place == 1:
        before = OperatorChain("-", (ref(f"{own}_At_{len(found)}"), ref(f"{own}_Cycle")))
        last = Ns(last - cycle_of(phased(system, task)))
    due = task.offset + found[place - 1].release * task.period
    missed = []
    for other in phased(system, task):
        name = name_of(other.element)
        begin = before if other is task else since
        late, period = (ref(f"{name}_O"), ref(f"{name}_J")), ref(f"{name}_T")
        end = OperatorChain("-", (plus(begin, ONE), *late))
        missed.append(
            OperatorChain(
                "-", (ceiling(OperatorChain("-", (at, *late)), period), ceiling(end, period))
            )
        )
    return [
        named_number(f"{own}_Since_{place}", before if last >= due - reach else reached),
        refuse(before, since, label, UNLISTED),
        refuse(plus(since, ONE), at, label, UNLISTED),
        refuse(plus(*missed), number(0), label, UNLISTED),
    ]


def _delay(system: System, task: Task, at: Expr, window: Expr) -> list[Expr]:
    """The delay of a job: of processors the releases due in the window, the most of all others."""
    node = system.node(task.node)
    known = {other.element for other in phased(system, task)}
    terms: list[Expr] = [ref(f"{name_of(task.element)}_B")]

    def term(other: Task, divisor: int, cost: Expr) -> Expr:
        own = name_of(other.element)
        period = times(number(divisor), ref(f"{own}_T"))
        if other.element not in known:
            return demand_within(window, ref(f"{own}_J"), period, cost)
        offset = ref(f"{own}_O")
        end = OperatorChain("-", (plus(at, window), offset))
        begin = OperatorChain("-", (at, ref(f"{own}_J"), offset))
        return times(OperatorChain("-", (ceiling(end, period), ceiling(begin, period))), cost)

    for other in system.tasks:
        here = (other.node, other.core) == (task.node, task.core)
        if here and other is not task and other.priority >= task.priority:
            terms += [term(other, divisor, ref(c)) for divisor, c in costs(other).items()]
    return [*terms, *platform(system, node, task.core, window, term)]
