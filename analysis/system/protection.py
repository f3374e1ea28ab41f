# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The end-to-end protection of each message, in numbers.

The residual error rate is that of IEC 61784-3 for a black channel: only the protection
itself counts, not the CRC of CAN. docs/protection.md has the formulas and their assumptions.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import comb

from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.instances import End
from ravenchart.gen.model.protection import Protection
from ravenchart.gen.model.system import System

from .timing import Analysis

BIT_ERROR_PROBABILITY = Fraction(1, 100)
"""The bit error probability of the black channel."""
HOUR = 3_600_000_000_000
"""An hour in ns."""


@dataclass(frozen=True, slots=True)
class PortSilence:
    """A port that receives the message, and the time until the port is stale.

    The time counts from when the last good frame was due to be sent; None: no `max_age`, or
    no bound.
    """

    port: End
    delivery: str
    """The element that hands the message over."""
    found: Ns | None


@dataclass(frozen=True, slots=True)
class ProtectedMessage:
    """A protected message."""

    message: Message
    protection: Protection
    random: float
    """Probability that a frame of random bits is used."""
    residual: Fraction
    """Probability that corruption of a frame is not found; exact."""
    rate: float
    """Corrupted frames that are not found, in an hour."""
    tolerated: Ns
    """The time of lost frames after which the next one is still used."""
    silences: tuple[PortSilence, ...]


def residual_probability(
    check_bits: int, found_bits: int, length: int, bit_error: Fraction
) -> Fraction:
    """The probability that errors in ``length`` bits are not found.

    Errors of up to ``found_bits`` bits are all found. Of the others 2 ** -check_bits are not.
    """
    few = Fraction(0)
    for wrong in range(found_bits + 1):
        few += comb(length, wrong) * bit_error**wrong * (1 - bit_error) ** (length - wrong)
    return (1 - few) / (1 << check_bits)


def protected(analysis: Analysis) -> tuple[ProtectedMessage, ...]:
    """Each protected message."""
    found: list[ProtectedMessage] = []
    for message in analysis.system.messages:
        own = message.protection
        if own is None:
            continue
        bits = 8 * message.length
        profile = own.profile
        residual = residual_probability(
            profile.crc_bits, profile.found_bits, bits, BIT_ERROR_PROBABILITY
        )
        found.append(
            ProtectedMessage(
                message,
                own,
                own.residual,
                residual,
                float(residual * HOUR / message.period),
                Ns(own.max_delta * message.period),
                silences(analysis, message),
            )
        )
    return tuple(found)


def silences(analysis: Analysis, message: Message) -> tuple[PortSilence, ...]:
    """The time until each port that receives a message is known to be stale."""
    return tuple(_silence(analysis, message, end) for end in message.targets)


def _silence(analysis: Analysis, message: Message, end: End) -> PortSilence:
    """Delivery, then executions of the port region until the age passes, one more, and R of it."""
    system: System = analysis.system
    component = system.instance(end.instance).component
    home, limit = system.home(end), component.port(end.name).max_age
    element = next(one.element for one in system.receptions(message) if one.node == home)
    handler = component.handlers().get(component.handler(end.name))
    if handler is None or limit is None:
        return PortSilence(end, element, None)
    delivery = analysis.deliveries.get(element)
    delivered = delivery.bound if delivery else None
    response = analysis.found.from_event(system.processor_of(system.handler(end)).name)
    if delivered is None or response is None:
        return PortSilence(end, element, None)
    period = handler.period
    return PortSilence(end, element, Ns(delivered + (limit // period + 2) * period + response))
