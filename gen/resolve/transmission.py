# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The transmission mode of a message, from what the model says of it."""

from __future__ import annotations

from ravenchart.gen.files.schema_frames import MessageForm, TransmissionForm
from ravenchart.gen.language.names import Findings
from ravenchart.gen.language.quantities import shown
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.transmission import Mode, Transmission

TRANSMISSION = "RV-0620"
"""A transmission mode that a message cannot have."""


def transmission_of(
    name: str, form: MessageForm, row: Ns, findings: Findings
) -> Transmission | None:
    """The mode of a message whose row has that period; None where it is periodic, or not sound."""
    given = form.send
    if given is None or not _belongs(name, form, given, findings):
        return None
    if given.mode == "periodic" or given.lost("minimum_delay") or given.lost("period"):
        return None
    before = findings.count()
    minimum = _executions(name, given, "minimum_delay", row, findings)
    renewal = _executions(name, given, "period", row, findings) if given.has("period") else 0
    if findings.count() == before and 0 < renewal < minimum:
        message = f"`period` of {name} is {shown(Ns(renewal * row))}, shorter than its "
        message += f"`minimum_delay`, {shown(Ns(minimum * row))}"
        hint = f"give it a `period` of {shown(Ns(minimum * row))} or more"
        findings.error(TRANSMISSION, given.at("period"), message, hint=hint)
    if form.has("protection"):
        message = f"{name} has protection and the transmission mode `{given.mode}`: the receiver "
        message += "counts on one frame in each period"
        hint = "remove `send`, or the protection"
        findings.error(TRANSMISSION, form.at_key("send"), message, hint=hint)
    if form.has("authentication"):
        message = f"{name} has authentication and the transmission mode `{given.mode}`, which do "
        message += "not go together"
        hint = "remove `send`, or the authentication"
        findings.error(TRANSMISSION, form.at_key("send"), message, hint=hint)
    if findings.count() > before:
        return None
    return Transmission(Mode(given.mode), minimum, renewal, row)


def _belongs(name: str, form: MessageForm, given: TransmissionForm, findings: Findings) -> bool:
    """Report keys without a meaning here, and a missing one."""
    before = findings.count()
    if form.from_ is None and not form.lost("from"):
        message = f"the message {name} is sent by others, and `send` has no meaning"
        hint = "remove it; `sporadic` says how a message from outside comes"
        findings.error("RV-0210", form.at_key("send"), message, hint=hint)
    wanted = {"periodic": (), "mixed": ("minimum_delay", "period")}.get(
        given.mode, ("minimum_delay",)
    )
    for key in ("minimum_delay", "period"):
        if given.has(key) and key not in wanted:
            message = f"`{key}` has no meaning in the transmission mode `{given.mode}`"
            findings.error("RV-0210", given.at_key(key), message, hint="remove it")
    if given.mode == "mixed" and given.period is None and not given.lost("period"):
        message = f"the transmission mode `mixed` of {name} needs the key `period`"
        hint = "give the longest time from one frame to the next"
        findings.error("RV-0202", given.origin, message, hint=hint)
    return findings.count() == before


def _executions(name: str, given: TransmissionForm, key: str, row: Ns, findings: Findings) -> int:
    """A time in executions of the row; 1 unless given."""
    time = given.minimum_delay if key == "minimum_delay" else given.period
    if time is None:
        return 1
    if time % row:
        message = f"`{key}` of {name} is {shown(Ns(time))}, no multiple of the period of the row "
        message += f"that sends it, {shown(row)}"
        hint = f"write `{key}: {shown(Ns(-(-time // row) * row))}`"
        findings.error(TRANSMISSION, given.at(key), message, hint=hint)
    return max(1, time // row)
