# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Protocols of interfaces: the order in which one client may call the commands."""

from __future__ import annotations

from dataclasses import dataclass

from ravenchart.gen.origins import Origin


@dataclass(frozen=True, slots=True)
class ProtocolStep:
    """A transition of a protocol: in ``source`` the command may be called, and ``target`` is next.

    At most one step of a state has a command.
    """

    name: str
    origin: Origin
    source: str
    target: str
    command: str


@dataclass(frozen=True, slots=True)
class Protocol:
    """A protocol state machine (UML 2.5.1, 14.4): each client is in one of the states.

    ``name`` is that of the interface or device type. Commands that no step names may be called in
    every state.
    """

    name: str
    origin: Origin
    initial: str
    states: tuple[str, ...]
    steps: tuple[ProtocolStep, ...]

    @property
    def commands(self) -> tuple[str, ...]:
        """The commands whose order is ruled, in the order in which they are named first."""
        return tuple(dict.fromkeys(step.command for step in self.steps))

    def after(self, state: str, command: str) -> str | None:
        """The state after a call; None where the command may not be called."""
        found = (s.target for s in self.steps if (s.source, s.command) == (state, command))
        return next(found, None)

    def allowed(self, state: str) -> tuple[str, ...]:
        """The commands of the protocol that may be called in a state."""
        return tuple(step.command for step in self.steps if step.source == state)
