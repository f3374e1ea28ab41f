# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rules of protocols: each client calls the commands of an interface in the declared order.

The state of the protocol is a data item of the client (`gen.derive.followed`), and a misuse is an
invariant that excludes one value of it. So it is proved, or violated with a trace, as `invariants`
does it.
"""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.derive.followed import Client, clients, misuses, watched_client
from ravenchart.gen.diagnostics import Diagnostic, error, warning
from ravenchart.gen.model.component import Activity, Component
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import System

from .budget import Budget
from .invariants import OpenInvariant, open_invariants
from .reach import Reachable

MISUSED = "RV-1112"
NOT_SHOWN = "RV-1113"


def protocols_followed(
    component: Component, system: System, budget: Budget
) -> Iterator[Diagnostic]:
    """A client of an interface with a protocol calls its commands only where it may."""
    for client in clients(system):
        callers = client.callers
        if client.component != component or not callers:
            continue
        reason = _hindrance(callers)
        if reason is not None:
            yield _not_shown(client, callers[0], reason)
            continue
        known = {one.literal: one for one in misuses(client.protocol)}
        reach = Reachable(watched_client(client, callers[0]), system, budget)
        for found in open_invariants(reach, system):
            misuse = known[found.invariant.name]
            allowed = ", ".join(client.protocol.allowed(misuse.state)) or "no command"
            what = f"{misuse.command} in the state {misuse.state} of {client.protocol.name}"
            yield _misused(client, found, what, allowed)


def _hindrance(callers: tuple[Region | Activity, ...]) -> str | None:
    """The reason why the order of calls is not known; None where it is."""
    if len(callers) > 1:
        rows = " and ".join(row.name for row in callers)
        return f"{rows} both call, and their order is not fixed"
    caller = callers[0]
    if isinstance(caller, Activity) and caller.flow is None:
        return f"the body of {caller.name} is the user's"
    return None


def _misused(client: Client, found: OpenInvariant, what: str, allowed: str) -> Diagnostic:
    """A misuse that happens, or one that is not excluded."""
    name, protocol = client.component.name, client.protocol
    origin = found.invariant.origin
    notes = [(protocol.origin, f"the protocol allows there: {allowed}")]
    if found.violation is not None:
        message = f"{name} calls {what}: {found.violation.trace}"
        return error(MISUSED, origin, message, notes=notes)
    message = f"{name} is not shown never to call {what}: {found.broken.step} may do it"
    hint = f"no way to it was found among {found.looked} situations; exclude the call by a guard"
    return warning(NOT_SHOWN, found.broken.origin, message, notes=notes, hint=hint)


def _not_shown(client: Client, caller: Region | Activity, reason: str) -> Diagnostic:
    message = (
        f"the calls of {client.protocol.name} by {client.component.name} are not checked: {reason}"
    )
    notes = [(client.protocol.origin, "the protocol is declared here")]
    hint = "call the commands of the protocol from one region, or from one activity with actions"
    return warning(NOT_SHOWN, caller.origin, message, notes=notes, hint=hint)
