# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Protocols of provided interfaces and of device types: their states, steps and commands exist."""

from __future__ import annotations

from collections.abc import Iterable

from ravenchart.gen.files.schema_devices import ProtocolForm
from ravenchart.gen.language.names import Findings, NameScope
from ravenchart.gen.model.commands import Command, CommandKind
from ravenchart.gen.model.protocols import Protocol, ProtocolStep
from ravenchart.gen.origins import Origin

WRONG = "RV-1219"


def protocol_of(
    owner: str,
    form: ProtocolForm | None,
    provided: Iterable[Command],
    findings: Findings,
    *,
    damaged: bool,
) -> Protocol | None:
    """The protocol of an interface or device type that provides these commands.

    Of a ``damaged`` one some commands may be lost.
    """
    if form is None:
        return None
    before = findings.count()
    states: NameScope[str] = NameScope(f"state of the protocol of {owner}")
    states.open = form.list_damaged("states")
    for index, name in enumerate(form.states):
        states.declare(name, form.item_at("states", index), name, findings)
    commands: NameScope[Command] = NameScope(f"command of {owner}", open=damaged)
    for command in provided:
        commands.declare(command.name, command.origin, command)
    initial = states.look_up(form.initial, form.at("initial"), findings)
    steps: dict[tuple[str, str], ProtocolStep] = {}
    names: NameScope[str] = NameScope(f"transition of the protocol of {owner}")
    for name, at in form.transitions.items():
        names.declare(name, at.origin, name, findings)
        source = states.look_up(at.from_, at.at("from"), findings)
        target = source if at.to is None else states.look_up(at.to, at.at("to"), findings)
        called = commands.look_up(at.on, at.at("on"), findings)
        if source is None or target is None or called is None:
            continue
        if not _is_called(called, at.at("on"), findings):
            continue
        key = source, called.name
        if key in steps:
            message = f"{source} has two transitions for {called.name}"
            notes = [(steps[key].origin, "the first is here")]
            hint = "remove one, or let it begin in another state"
            findings.error(WRONG, at.origin, message, notes=notes, hint=hint)
        else:
            steps[key] = ProtocolStep(name, at.origin, source, target, called.name)
    if initial is None or findings.count() > before or form.damaged:
        return None
    found = Protocol(owner, form.origin, initial, states.sound(), tuple(steps.values()))
    _all_are_reached(found, form, findings)
    return found


def _is_called(command: Command, at: Origin, findings: Findings) -> bool:
    """Whether calls of the command have an order: it is neither read nor an event."""
    if command.kind not in (CommandKind.READ, CommandKind.EVENT):
        return True
    kind = "an event" if command.kind is CommandKind.EVENT else "a read command"
    message = f"{command.name} is {kind}: a protocol rules the order of calls"
    findings.error(WRONG, at, message, hint="remove the transition")
    return False


def _all_are_reached(protocol: Protocol, form: ProtocolForm, findings: Findings) -> None:
    """Each state can be reached from the initial one."""
    reached = {protocol.initial}
    for _ in protocol.states:
        reached |= {step.target for step in protocol.steps if step.source in reached}
    for index, state in enumerate(protocol.states):
        if state not in reached:
            message = f"no transitions lead from {protocol.initial} to the state {state}"
            hint = "add a transition to it, or remove it"
            findings.error(WRONG, form.item_at("states", index), message, hint=hint)
