# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Messages of a bus: what travels from which port to which, and how."""

from __future__ import annotations

from dataclasses import dataclass

from ravenchart.gen.derive.identifiers import OPEN
from ravenchart.gen.files.schema_frames import (
    AuthenticationForm,
    MessageForm,
    ProtectionForm,
)
from ravenchart.gen.language.terms import BOOLEAN, Ns
from ravenchart.gen.model.authentication import Authentication
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.component import Direction, Port
from ravenchart.gen.model.instances import End
from ravenchart.gen.model.protection import Protection
from ravenchart.gen.model.signals import Signal
from ravenchart.gen.model.transmission import Transmission
from ravenchart.gen.model.transport import Transport
from ravenchart.gen.origins import Origin

from .authentication import authentication_of
from .layouts import layout_of, size_of
from .paths import DeploymentNames, ends_at, event_at
from .protection import protection_of
from .transmission import transmission_of
from .transport import transport_of

MEANINGLESS = ("signals", "multiplexor", "protection", "authentication", "transport")
"""Keys of a message whose value nobody here knows."""


def message_of(name: str, form: MessageForm, site: DeploymentNames) -> Message | None:
    """A message, its signals laid out; its type is that of its ports."""
    findings = site.findings
    bus = site.buses.look_up(form.bus, form.at("bus"), findings)
    source = None
    if form.from_ is not None:
        source = next(iter(ends_at(form.from_, form.at("from"), Direction.OUT, site)), None)
    texts: list[tuple[str, Origin]] = []
    if isinstance(form.to, str):
        texts = [(form.to, form.at("to"))]
    elif form.to is not None:
        texts = [(text, form.item_at("to", index)) for index, text in enumerate(form.to)]
    targets = [ends_at(text, origin, Direction.IN, site) for text, origin in texts]
    sound = [end for ends in targets for end in ends]
    gone = form.lost("from") or form.lost("to") or form.list_damaged("to")
    foreign = form.from_ is None and not texts and not gone
    if foreign and form.bytes is None and not form.lost("bytes"):
        message = f"the message {name} has neither `from` nor `to`"
        hint = (
            "name the port that sends it or the one that receives it; of a frame that others "
            "send to others, give the `bytes`"
        )
        findings.error("RV-0608", form.origin, message, hint=hint)
        return None
    for key in MEANINGLESS if foreign else ():
        if form.has(key):
            message = f"the message {name} has no value, and `{key}` no meaning"
            findings.error("RV-0210", form.at_key(key), message, hint="remove it")
    if foreign and form.id is None and not form.lost("id"):
        message = f"the message {name} is sent by others and needs the key `id`"
        findings.error("RV-0202", form.origin, message)
    period = _message_period(name, form, source, site)
    if form.has("sporadic") and (foreign or source is not None):
        why = "is sent by others to others" if foreign else f"is sent by {form.from_}"
        message = f"the message {name} {why}, and `sporadic` has no meaning"
        findings.error("RV-0210", form.at_key("sporadic"), message, hint="remove it")
    broken = (form.from_ is not None and source is None) or () in targets
    if bus is None or broken or gone or period is None:
        return None
    if form.lost("bytes") or form.lost("id") or (foreign and form.id is None):
        return None
    type_ = BOOLEAN if foreign else (source or sound[0])[1].type
    signals = () if foreign else layout_of(name, form, type_, findings)
    if signals is None:
        return None
    ports = tuple(target[1] for target in sound)
    travels = _travels(name, form, signals, ports, period, site)
    if travels is None:
        return None
    return Message(
        name=name,
        origin=form.origin,
        bus=bus.name,
        identifier=OPEN if form.id is None else form.id,
        extended=form.extended,
        type=type_,
        signals=signals,
        length=travels.length,
        source=None if source is None else source[0],
        targets=tuple(target[0] for target in sound),
        period=travels.period,
        deadline=None if form.deadline is None else Ns(form.deadline),
        fd=form.format == "fd",
        sporadic=source is None and form.sporadic is not False,
        protection=travels.protection,
        authentication=travels.authentication,
        transmission=travels.transmission,
        transport=travels.transport,
        database_name=form.database_name,
    )


@dataclass(frozen=True, slots=True)
class _Travels:
    """How frames of a message go: their bytes, the least time between two, what they carry."""

    length: int
    period: Ns
    protection: Protection | None = None
    authentication: Authentication | None = None
    transmission: Transmission | None = None
    transport: Transport | None = None


def _travels(
    name: str,
    form: MessageForm,
    signals: tuple[Signal, ...],
    ports: tuple[Port, ...],
    period: Ns,
    site: DeploymentNames,
) -> _Travels | None:
    """How frames of a message with these signals go; None where they cannot as it is given."""
    findings = site.findings
    if any(form.lost(key) for key in ("protection", "authentication", "transport", "send")):
        return None
    if form.transport is not None and signals:
        given = (name, form, form.transport, signals, ports, period)
        transport = transport_of(*given, findings)
        if transport is None:
            return None
        return _Travels(8, Ns(transport.distance * period), transport=transport)
    length = size_of(name, form, signals, findings)
    if length is None:
        return None
    protection = _message_protection(name, form, length, site)
    authentication = _message_authentication(name, form, signals, site)
    if (protection is None) != (form.protection is None):
        return None
    if (authentication is None) != (form.authentication is None):
        return None
    before = findings.count()
    transmission = None if form.send is None else transmission_of(name, form, period, findings)
    if findings.count() > before:
        return None
    least = period if transmission is None else Ns(transmission.minimum * period)
    return _Travels(length, least, protection, authentication, transmission)


def _message_protection(
    name: str, form: MessageForm, length: int, site: DeploymentNames
) -> Protection | None:
    """The protection of a message of so many bytes; None where it has none, or no sound one."""
    if form.protection is None:
        return None
    events = _refusals(form.protection, site)
    found = protection_of(name, form.protection, length, events or (), site.findings)
    return None if events is None else found


def _message_authentication(
    name: str, form: MessageForm, signals: tuple[Signal, ...], site: DeploymentNames
) -> Authentication | None:
    """The authentication of a message; None where it has none, or no sound one."""
    if form.authentication is None:
        return None
    events = _refusals(form.authentication, site)
    found = authentication_of(name, form, signals, events or (), site.findings)
    return None if events is None else found


def _refusals(
    given: ProtectionForm | AuthenticationForm, site: DeploymentNames
) -> tuple[tuple[str, str], ...] | None:
    """The events that a frame raises which is not used; None where not all are sound."""
    if given.lost("on_error") or given.list_damaged("on_error"):
        return None
    events = [
        event_at(text, given.item_at("on_error", index), site)
        for index, text in enumerate(given.on_error or ())
    ]
    sound = tuple(pair for pair in events if pair is not None)
    return sound if len(sound) == len(events) else None


def _message_period(
    name: str, form: MessageForm, source: tuple[End, Port] | None, site: DeploymentNames
) -> Ns | None:
    """The period given, or the shortest of what sends the message."""
    findings = site.findings
    if form.from_ is None:
        if form.period is None and not form.lost("period") and not form.lost("from"):
            message = f"the message {name} comes from outside and needs the key `period`"
            hint = "give the least time between two of its frames"
            findings.error("RV-0609", form.origin, message, hint=hint)
        return None if form.period is None else Ns(form.period)
    if form.period is not None:
        message = f"the message {name} has the period of what sends it; leave `period` out"
        findings.error("RV-0609", form.at_key("period"), message)
    if source is None:
        return None
    instance = site.instances.find(source[0].instance)
    parts = None if instance is None else site.parts(instance)
    if instance is None or parts is None:
        return None
    period = instance.component.send_period(source[1].name)
    if period is None and not parts.is_damaged:
        message = f"the message {name} has no period: nothing sends on {source[0]}"
        notes = [(source[1].origin, f"`{source[1].name}` is declared here")]
        hint = "send on the port by an activity (`sends:`) or in a flow (`send:`)"
        findings.error("RV-0609", form.at("from"), message, notes=notes, hint=hint)
    return period


# --- Processors --------------------------------------------------------------------
