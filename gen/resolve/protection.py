# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The end-to-end protection of a message, from what the model says of it."""

from __future__ import annotations

from ravenchart.gen.files.schema_frames import ProtectionForm
from ravenchart.gen.language.names import Findings
from ravenchart.gen.model.protection import PROFILES, Profile, Protection

PROTECTION = "RV-0619"
"""A message cannot be protected as given."""


def protection_of(
    name: str,
    form: ProtectionForm,
    length: int,
    events: tuple[tuple[str, str], ...],
    findings: Findings,
) -> Protection | None:
    """The protection of a message of so many bytes; None where it is not sound."""
    profile = PROFILES[form.profile]
    before = findings.count()
    if form.lost("data_id") or form.lost("data_ids") or form.list_damaged("data_ids"):
        return None
    _identifiers(name, form, profile, findings)
    if form.max_delta > profile.counters - 2:
        message = f"`max_delta` of {name} is {form.max_delta}; the limit of {form.profile} is "
        message += f"{profile.counters - 2}"
        hint = f"give {profile.counters - 2} at most; the counter has {profile.counters} values"
        findings.error(PROTECTION, form.at("max_delta"), message, hint=hint)
    if length > profile.longest:
        message = f"{name} has {length} bytes; the CRC of {form.profile} protects "
        message += f"{profile.longest} at most"
        findings.error(PROTECTION, form.at("profile"), message, hint="use `profile: e2e_p5`")
    if findings.count() > before:
        return None
    return Protection(
        form.profile,
        form.data_id or 0,
        tuple(form.data_ids or ()),
        form.max_delta,
        form.sync,
        events,
    )


def _identifiers(name: str, form: ProtectionForm, profile: Profile, findings: Findings) -> None:
    """Report a data identifier that is missing, too large, or of another profile."""
    wanted, other = "data_id", "data_ids"
    if form.profile == "e2e_p2":
        wanted, other = other, wanted
    if form.has(other):
        message = f"{name} has `{other}`; {form.profile} takes `{wanted}`"
        findings.error(PROTECTION, form.at_key(other), message, hint=f"remove `{other}`")
    if not form.has(wanted):
        message = f"the protection of {name} needs the key `{wanted}`"
        count = "16 numbers from 0 to 0xFF" if wanted == "data_ids" else "a number"
        findings.error(PROTECTION, form.origin, message, hint=f"add `{wanted}`: {count}")
        return
    for number in (form.data_id,) if wanted == "data_id" else tuple(form.data_ids or ()):
        if number is not None and not 0 <= number <= profile.id_last:
            message = f"the data identifier {number} of {name} is out of range: {form.profile} "
            message += f"has 0 to {profile.id_last}"
            findings.error(PROTECTION, form.at(wanted), message, hint="give a smaller one")
