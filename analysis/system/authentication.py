# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The authentication of each message, in numbers."""

from __future__ import annotations

from dataclasses import dataclass

from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.authentication import Authentication
from ravenchart.gen.model.buses import Message

from .protection import PortSilence, silences
from .timing import Analysis


@dataclass(frozen=True, slots=True)
class Authenticated:
    """An authenticated message."""

    message: Message
    authentication: Authentication
    tolerated: Ns | None
    """The time of lost frames after which the next one is still used; None: any time."""
    silences: tuple[PortSilence, ...]


def authentications(analysis: Analysis) -> tuple[Authenticated, ...]:
    """Each authenticated message."""
    found: list[Authenticated] = []
    for message in analysis.system.messages:
        own = message.authentication
        if own is not None:
            lost = own.lost_at_most
            tolerated = None if lost is None else Ns((lost + 1) * message.period)
            found.append(Authenticated(message, own, tolerated, silences(analysis, message)))
    return tuple(found)
