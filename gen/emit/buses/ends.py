# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Names of what a bus remembers of a protected or authenticated message, at each of its ends."""

from __future__ import annotations

from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.model.buses import Message


def sending_state(message: Message) -> str:
    """The state of the sender."""
    return f"Sender_Of_{ada_case(message.name)}"


def checking_state(message: Message) -> str:
    """The state of the receiver."""
    return f"Checker_Of_{ada_case(message.name)}"


def state_before(message: Message) -> str:
    """The state of the receiver before the frame came."""
    return f"Checker_Before_{ada_case(message.name)}"
