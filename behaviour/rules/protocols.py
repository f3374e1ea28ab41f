# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rules of protocols: each client calls the commands of a provider in the declared order.

The state of the protocol is one data item more of the client, which follows its calls. A call that
the state does not allow gives the item a value that it keeps. An invariant excludes that value: so
it is proved, or violated with a trace, as `invariants` does it.

The program collects the calls of a step and makes them behind it, in the order of the ports.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial

import z3

from ravenchart.behaviour.limits import MISUSED, NOT_FOLLOWED
from ravenchart.gen.derive.clients import Client
from ravenchart.gen.diagnostics import Diagnostic, error, warning
from ravenchart.gen.language.terms import (
    BOOLEAN,
    EnumerationType,
    Flow,
    Literal,
    Name,
    Operation,
    Reading,
    Send,
)
from ravenchart.gen.model.component import Activity, Component, Data, Invariant
from ravenchart.gen.model.protocols import Protocol
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import System

from .budget import Budget
from .cells import PROTOCOL
from .invariants import OpenInvariant, open_invariants, search_in_words
from .logic import Term, Variable, variable
from .reach import Reachable
from .stepping import OpenStep

ITEM = variable(Reading.DATA, PROTOCOL, None)
"""The state of the protocol."""


def protocol_followed(client: Client, system: System, budget: Budget) -> Iterator[Diagnostic]:
    """A client of a provider with a protocol calls its commands only where it may."""
    callers = client.callers
    if not callers:
        return
    reason = _hindrance(callers)
    if reason is not None:
        yield _not_checked(client, callers[0], reason)
        return
    own = [one for one in system.instances if one.name in client.instances]
    others = [one for one in system.instances if one.component.name != client.component.name]
    bound = replace(system, instances=(*others, *own))
    step = partial(_FollowedStep, caller=callers[0].name, client=client)
    reach = Reachable(_with_item(client, callers[0]), bound, budget, step)
    for found in open_invariants(reach, bound):
        yield _misused(client, found)


def _hindrance(callers: tuple[Region | Activity, ...]) -> str | None:
    """The reason why the order of calls is not known; None where it is."""
    if len(callers) > 1:
        rows = " and ".join(row.name for row in callers)
        return f"{rows} both call, and their order is not fixed"
    caller = callers[0]
    if isinstance(caller, Activity) and caller.forwards:
        return f"{caller.name} forwards the calls of others"
    if isinstance(caller, Activity) and caller.flow is None:
        return f"the body of {caller.name} is the user's"
    return None


def _with_item(client: Client, caller: Region | Activity) -> Component:
    """The component with the item, which the caller writes, and an invariant for each command."""
    component, protocol = client.component, client.protocol
    of_type = _values(protocol)
    item = Data(PROTOCOL, protocol.origin, of_type, protocol.initial)

    def never(command: str) -> Invariant:
        value = Name(Reading.DATA, PROTOCOL, None, of_type)
        wrong = Literal(_misuse(command), of_type)
        return Invariant(command, caller.origin, Operation("=", (value, wrong), BOOLEAN))

    def written(row: Region | Activity) -> tuple[str, ...]:
        return (*row.writes, PROTOCOL) if row is caller else row.writes

    return replace(
        component,
        data=(*component.data, item),
        regions=tuple(replace(one, writes=written(one)) for one in component.regions),
        activities=tuple(replace(one, writes=written(one)) for one in component.activities),
        invariants=tuple(never(command) for command in client.in_order),
    )


def _values(protocol: Protocol) -> EnumerationType:
    """The states of a protocol, and a value for the misuse of each command."""
    misuses = (_misuse(command) for command in protocol.commands)
    return EnumerationType(PROTOCOL, protocol.origin, (*protocol.states, *misuses))


def _misuse(command: str) -> str:
    """The value that the item has after a call that was not allowed; no state has such a name."""
    return f"not {command}"


@dataclass(kw_only=True)
class _FollowedStep(OpenStep):
    """A step whose calls move the protocol on behind it."""

    caller: str
    client: Client

    def run(self) -> str | None:
        """Make the step, then the calls that it has asked for."""
        if self.tree.region.name != self.caller:
            return super().run()
        commands = self.client.in_order
        for command in commands:
            self.store[_asked(command)] = z3.BoolVal(False)
        stuck = super().run()
        value = self.read(ITEM)
        for command in commands:
            asked = self.store.pop(_asked(command))
            if not z3.is_false(asked):
                value = z3.simplify(
                    z3.If(asked, _after(self.client.protocol, command, value), value)
                )
                self.store[ITEM] = value
        return stuck

    def perform(self, flow: Flow) -> None:
        """Execute a flow, and note the calls."""
        for action in flow:
            if isinstance(action, Send) and _asked(action.port) in self.store:
                self.store[_asked(action.port)] = z3.BoolVal(True)
            else:
                super().perform((action,))


def _asked(command: str) -> Variable:
    """Whether the step has asked for a call: known within the step alone."""
    return variable(Reading.DATA, f"{PROTOCOL}: call of {command}", None)


def _after(protocol: Protocol, command: str, value: Term) -> Term:
    """The item after a call; a value that says of a misuse stays."""
    literals = _values(protocol).literals
    found = value
    for state in protocol.states:
        target = protocol.after(state, command) or _misuse(command)
        is_there = value == z3.IntVal(literals.index(state))
        found = z3.If(is_there, z3.IntVal(literals.index(target)), found)
    return found


# --- Words ---------------------------------------------------------------------------


def _misused(client: Client, found: OpenInvariant) -> Diagnostic:
    """A call that is not allowed, or one that is not excluded."""
    name, command, protocol = client.component.name, found.invariant.name, client.protocol
    states = [state for state in protocol.states if protocol.after(state, command)]
    notes = [
        (protocol.origin, f"{protocol.name} allows {command} in: {', '.join(states)}"),
        (protocol.origin, f"{client.instances[0]} calls {client.provider}"),
    ]
    called = [one for one in client.in_order if one in client.callers[0].sends]
    if len(called) > 1:
        order = ", ".join(called)
        notes.append((found.invariant.origin, f"the calls of one step are made in order: {order}"))
    if found.violation is not None:
        message = f"{name} calls {command} where {protocol.name} does not allow it: "
        message += found.violation.trace
        hint = "call it in another step, or add a transition to the protocol"
        return error(MISUSED, found.violation.origin, message, notes=notes, hint=hint)
    message = f"{name} may call {command} where {protocol.name} does not allow it: "
    message += f"{found.broken.step} is not excluded"
    hint = f"{search_in_words(found)}; exclude the call by a guard"
    return warning(NOT_FOLLOWED, found.broken.origin, message, notes=notes, hint=hint)


def _not_checked(client: Client, caller: Region | Activity, reason: str) -> Diagnostic:
    message = f"the calls of {client.protocol.name} by {client.component.name} are not checked: "
    message += reason
    notes = [(client.protocol.origin, "the protocol is declared here")]
    hint = "call the commands of the protocol from one region, or from one activity with actions"
    return warning(NOT_FOLLOWED, caller.origin, message, notes=notes, hint=hint)
