# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""How the value of a message is cut into segments, from what the model says of it."""

from __future__ import annotations

from ravenchart.gen.files.schema_frames import MessageForm, TransportForm
from ravenchart.gen.language.names import Findings
from ravenchart.gen.language.quantities import shown
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.component import Port, PortKind
from ravenchart.gen.model.signals import FRAME_BITS, Signal, bits_of
from ravenchart.gen.model.transport import MICROSECOND, Transport, code_of

TRANSPORT = "RV-0626"
"""A value that cannot be sent in several frames as it is given."""

SECOND = 10**9


def transport_of(
    name: str,
    form: MessageForm,
    given: TransportForm,
    signals: tuple[Signal, ...],
    ports: tuple[Port, ...],
    row: Ns,
    findings: Findings,
) -> Transport | None:
    """The transport of a message with these signals; None where it is not sound.

    ``ports`` are those that receive; ``row`` is the period of what sends.
    """
    before = findings.count()
    for key in ("protection", "authentication", "send", "bytes"):
        if form.has(key):
            message = f"{name} has `transport`, and `{key}` is not supported with it"
            findings.error(TRANSPORT, form.at_key(key), message, hint=f"remove `{key}`")
    if form.format == "fd":
        message = f"{name} is a CAN FD frame, which needs no `transport`"
        hint = "remove `format: fd`, or `transport`"
        findings.error(TRANSPORT, form.at_key("transport"), message, hint=hint)
    if form.from_ is None or form.to is None:
        what = "sent" if form.from_ is None else "received"
        message = f"{name} is {what} outside the model: `transport` needs both ends in it"
        hint = "give `from` and `to`"
        findings.error(TRANSPORT, form.at_key("transport"), message, hint=hint)
    queued = next((port for port in ports if port.kind is PortKind.QUEUED), None)
    if queued is not None:
        message = f"{queued.name} is a queued port, and receives {name}, which has `transport`"
        notes = [(queued.origin, f"`{queued.name}` is declared here")]
        hint = "let the port be `kind: sampled`"
        findings.error(TRANSPORT, form.at("to"), message, notes=notes, hint=hint)
    bits = bits_of(signals)
    if bits <= FRAME_BITS:
        message = f"{name} has {bits} bits, which one frame carries"
        findings.error(TRANSPORT, form.at_key("transport"), message, hint="remove `transport`")
    separation = Ns(given.separation or 0)
    if code_of(separation) is None:
        message = (
            f"`separation` of {name} is {shown(separation)}, for which ISO 15765-2 has no code"
        )
        hint = "give 100 us to 900 us in steps of 100 us, or up to 127 ms in steps of 1 ms"
        findings.error(TRANSPORT, given.at("separation"), message, hint=hint)
    if row % MICROSECOND:
        message = f"{name} is sent every {shown(row)}, no whole number of microseconds"
        findings.error(TRANSPORT, form.at("from"), message, hint="give the row another period")
    if findings.count() > before or given.lost("timeout") or given.lost("separation"):
        return None
    return Transport(
        flow=f"{name}_Flow",
        flow_identifier=given.flow_id,
        block=given.block,
        separation=separation,
        waits=given.flow_limit,
        timeout=Ns(given.timeout or SECOND),
        length=-(-bits // 8),
        row=row,
    )
