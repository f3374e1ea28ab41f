# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""How long the frames of a message are, in the timing certificate.

A length counts from the start of the frame to the next one, with as many stuff bits as there can
be. A CAN FD frame begins at the nominal rate, up to the bit that switches, and ends at that rate,
behind the CRC. The body in between is at the data rate where the bus has one (ISO 11898-1).
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from ravenchart.gen.emit.ada.declarations import Aspect, Decl, Param, Subprogram
from ravenchart.gen.emit.ada.expressions import Expr, OperatorChain, Power, call, number, plain
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.model.buses import Bus, Message

from .terms import ONE, ceiling, name_of, named_number, plus, stated, times

SECOND = Power(10, 9)
"""In nanoseconds."""
UNSTUFFED = 13
"""CRC delimiter, acknowledgement and its delimiter, end of frame, three bits to the next frame."""

CONTROL = 5
"""Error state indicator and length code of a CAN FD frame: what of its body can be stuffed
besides the data."""


def explained(bus: Bus) -> str:
    """The meaning of the numbers of a message's length."""
    text = (
        "Stuffed: bits that stuffing can lengthen by a quarter. Bits: the longest frame, with 10 "
        "bits that are not stuffed and 3 to the next frame. Time_Of: the time of that frame."
    )
    if bus.takes_fd:
        text += (
            "\nOf a CAN FD frame, Head: bits up to the switch of the bit rate. Early: stuff bits "
            "in Head. Body: the longest part from the switch to the end of the CRC. Bits: all "
            "other bits."
        )
    return text


def _time_functions(bus: Bus, messages: Sequence[Message]) -> list[Decl]:
    """How long a classic frame of the bus takes at most, by the bits that are stuffed."""
    if all(message.fd for message in messages):
        return []
    line = ada_case(bus.name)
    rate, stuffed = ref(f"{line}_Bit_Rate"), call("Time", ref("Stuffed"))
    bits = plus(stuffed, number(UNSTUFFED), _quarter(stuffed))
    time = ceiling(times(call(f"{line}_Bits", ref("Stuffed")), SECOND), rate)
    return [
        Subprogram(
            f"{line}_{name}",
            (Param("Stuffed", "in", "Positive"),),
            "Time",
            (Aspect("Static"),),
            expression=value,
        )
        for name, value in (("Bits", bits), ("Time_Of", time))
    ]


def _head(message: Message) -> int:
    """Bits up to the switch; of a classic frame all that stuffing can lengthen, but the data."""
    if message.fd:
        return 36 if message.extended else 17
    return 54 if message.extended else 34


def _checks(message: Message) -> int:
    """Count of stuff bits, CRC and the fixed stuff bits of a CAN FD frame."""
    return 4 + 17 + 6 if message.length <= 16 else 4 + 21 + 7


def length_terms(message: Message, bus: Bus) -> list[Decl]:
    """The bits of a message's longest frame, and its time."""
    own, line = name_of(message.element), ada_case(bus.name)
    if not message.fd:
        stuffed: Expr = plus(plain(_head(message)), _data_bits(own))
        return [named_number(f"{own}_C", call(f"{line}_Time_Of", stuffed))]
    stuffed, bits, rate = ref(f"{own}_Stuffed"), ref(f"{own}_Bits"), ref(f"{line}_Bit_Rate")
    head, early, body = (ref(f"{own}_{part}") for part in ("Head", "Early", "Body"))
    behind = _less(stuffed, head), _less(_quarter(stuffed), early)
    cost: Expr = ceiling(times(plus(bits, body), SECOND), rate)
    if bus.data_rate is not None:
        fast = ref(f"{line}_Data_Rate")
        cost = ceiling(times(plus(times(bits, fast), times(body, rate)), SECOND), times(rate, fast))
    return [
        stated(head, _head(message)),
        named_number(early, _quarter(head)),
        named_number(stuffed, plus(head, plain(CONTROL), _data_bits(own))),
        named_number(body, plus(*behind, number(_checks(message)))),
        named_number(bits, plus(head, early, number(UNSTUFFED))),
        named_number(f"{own}_C", cost),
    ]


def _data_bits(own: str) -> Expr:
    return times(plain(8), ref(f"{own}_Length"))


def _quarter(stuffed: Expr) -> Expr:
    """Stuff bits at most: one behind the first five bits, then one behind every four."""
    return OperatorChain("/", (_less(stuffed, ONE), number(4)))


def _less(left: Expr, right: Expr) -> Expr:
    return OperatorChain("-", (left, right))


def rate_terms(bus: Bus, messages: Sequence[Message]) -> list[Decl]:
    """The rates of a bus, the times of its classic frames, and one bit in nanoseconds."""
    line = ada_case(bus.name)
    rate = f"{line}_Bit_Rate"
    switched = [] if bus.data_rate is None else [stated(f"{line}_Data_Rate", bus.data_rate)]
    bit = named_number(f"{line}_Bit", ceiling(number(10**9), ref(rate)))
    return [stated(rate, bus.bit_rate), *switched, *_time_functions(bus, messages), bit]


def span(message: Message, bus: Bus) -> Fraction:
    """The longest frame, in bits at the nominal rate."""
    head = _head(message)
    if not message.fd:
        stuffed = head + 8 * message.length
        return Fraction(stuffed + UNSTUFFED + (stuffed - 1) // 4)
    stuffed = head + CONTROL + 8 * message.length
    early = (head - 1) // 4
    body = stuffed - head + (stuffed - 1) // 4 - early + _checks(message)
    return head + early + UNSTUFFED + Fraction(body * bus.bit_rate, bus.data_rate or bus.bit_rate)
