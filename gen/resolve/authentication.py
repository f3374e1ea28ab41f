# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The authentication of a message, from what the model says of it."""

from __future__ import annotations

from ravenchart.gen.files.schema_frames import MessageForm
from ravenchart.gen.language.names import Findings
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.authentication import Authentication, trailer_bytes
from ravenchart.gen.model.signals import FD_SIZES, Signal, bits_of

AUTHENTICATION = "RV-0621"
"""A message cannot be authenticated as given."""


def trailer_of(form: MessageForm) -> int:
    """Bytes at the end of the frame that the authentication of a message takes."""
    given = form.authentication
    return 0 if given is None else trailer_bytes(given.freshness_bits, given.mac_bits)


def authentication_of(
    name: str,
    form: MessageForm,
    signals: tuple[Signal, ...],
    events: tuple[tuple[str, str], ...],
    findings: Findings,
) -> Authentication | None:
    """The authentication of a message; None where it has none, or no sound one."""
    given, before = form.authentication, findings.count()
    if given is None:
        return None
    if form.has("protection"):
        message = f"{name} has `protection` and `authentication`"
        hint = "remove `protection`: a MAC finds what a CRC finds"
        findings.error(AUTHENTICATION, given.origin, message, hint=hint)
    if form.format != "fd":
        message = f"{name} is a classic frame; authentication needs CAN FD"
        findings.error(AUTHENTICATION, given.origin, message, hint="write `format: fd`")
    data, trailer, room = -(-bits_of(signals) // 8), trailer_of(form), FD_SIZES[-1]
    if data <= room < data + trailer:
        message = f"{name} needs {data + trailer} bytes, {trailer} of them for freshness value and "
        message += f"MAC; a frame has {room} at most"
        hint = "give smaller `freshness_bits` or `mac_bits`: "
        hint += f"there is room for {room - data} bytes of both"
        findings.error(AUTHENTICATION, given.origin, message, hint=hint)
    if findings.count() > before:
        return None
    return Authentication(
        given.profile,
        given.data_id,
        given.key_,
        given.freshness_bits,
        given.mac_bits,
        Ns(given.mac_wcet),
        events,
    )
