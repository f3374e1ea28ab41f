# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""End-to-end protection in the timing certificate: how surely and how soon it finds an error.

The residual error probability is that of IEC 61784-3 for a black channel. The bits of a frame are
wrong independently of each other, each with probability 1/100. A CRC of r bits does not find
2**-r of the errors that it does not always find. All of it is exact: named numbers are integers
without a largest value.
"""

from __future__ import annotations

from math import comb

from ravenchart.gen.emit.ada.declarations import Decl
from ravenchart.gen.emit.ada.expressions import Expr, OperatorChain, number
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.statements import Comment
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.claims import Claims
from ravenchart.gen.model.instances import End
from ravenchart.gen.model.protection import Protection
from ravenchart.gen.model.system import System

from .terms import ceiling, exact, name_of, named_number, plus, stated, times

HOUR = 3_600 * 10**9
"""In nanoseconds."""

RESIDUAL = (
    "Few: 100**Data_Bits times the probability that no more bits are wrong than the CRC always "
    "finds, with each bit wrong with probability 1/100.\n"
    "Residual: the probability that corruption of a frame is not found, in units of 10**-18.\n"
    "Per_Hour: the same for all frames of an hour, in units of 10**-9."
)


def age_limited_ports(system: System) -> tuple[tuple[Message, End], ...]:
    """The ports whose `max_age` finds that usable frames of a checked message no longer come."""
    found: list[tuple[Message, End]] = []
    for message in system.messages:
        if message.check is None:
            continue
        for end in message.targets:
            component = system.instance(end.instance).component
            if component.port(end.name).max_age is not None and component.port_region is not None:
                found.append((message, end))
    return tuple(found)


def protection_claims(system: System, claims: Claims) -> list[Decl]:
    """The residual error of each protected message, and when a port of a checked one is stale."""
    items: list[Decl] = []
    for message in system.messages:
        if message.protection is not None:
            items += [] if items else [Comment(RESIDUAL)]
            items += _residual(message, message.protection, claims.residual.get(message.name, 0))
    for message, end in age_limited_ports(system):
        items += _stale(system, message, end, claims.stale.get(str(end), 0))
    return items


def _residual(message: Message, own: Protection, claimed: int) -> list[Decl]:
    """The probability that a corrupted frame is used, and how often that is in an hour."""
    element, profile = name_of(message.element), own.profile
    bits, few = (ref(f"{element}_{part}") for part in ("Data_Bits", "Few"))
    residual = f"{element}_Residual"
    right, needs = ref(residual), ref(f"{residual}_Needs")
    whole = OperatorChain("**", (number(100), bits))
    checks = OperatorChain("**", (number(2), number(profile.crc_bits)))
    patterns: list[Expr] = []
    for wrong in range(profile.found_bits + 1):
        sound = OperatorChain(
            "**", (number(99), OperatorChain("-", (bits, number(wrong))) if wrong else bits)
        )
        patterns.append(times(number(comb(8 * message.length, wrong)), sound))
    missed = OperatorChain("-", (whole, few))
    return [
        Comment(f"[{message.element}] the residual error of {own.name}"),
        named_number(bits, times(number(8), ref(f"{element}_Length"))),
        named_number(few, plus(*patterns)),
        stated(right, claimed),
        named_number(needs, ceiling(times(missed, number(10**18)), times(checks, whole))),
        exact(right, [needs], message.element, "residual error"),
        named_number(
            f"{residual}_Per_Hour",
            ceiling(times(right, number(HOUR)), times(number(10**9), ref(f"{element}_T"))),
        ),
    ]


def _stale(system: System, message: Message, end: End, claimed: int) -> list[Decl]:
    """From when a frame is due that is not usable, or does not come: when its port is Stale."""
    own, processor = name_of(str(end)), system.processor_of(system.handler(end))
    received = system.reception(message, end)
    component = system.instance(end.instance).component
    age = component.port(end.name).max_age
    assert received is not None
    assert age is not None
    limit, period = ref(f"{own}_Max_Age"), ref(f"{own}_Looks")
    needs = plus(
        ref(f"{name_of(received.element)}_Handed"),
        times(plus(OperatorChain("/", (limit, period)), number(2)), period),
        ref(f"{name_of(processor.name)}_R"),
    )
    words = (
        f"[{end}] Looks: the period at which the age of its value is checked. Stale: the time "
        f"from when the last usable frame of {message.name} was due until the port is known to be "
        "stale."
    )
    return [
        Comment(words),
        stated(limit, age),
        stated(period, component.handlers()[component.handler(end.name)].period),
        stated(f"{own}_Stale", claimed),
        named_number(f"{own}_Stale_Needs", needs),
        exact(ref(f"{own}_Stale"), [ref(f"{own}_Stale_Needs")], str(end), "time until it is stale"),
    ]
