# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The claims that clients call commands in the order of a protocol."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.behaviour.limits import OF_PROTOCOLS, UNFINISHED
from ravenchart.gen.derive.clients import clients

from .claim import Claim, ClaimKind, own_tool, verdict_of
from .facts import Facts


def protocols(facts: Facts) -> Iterator[Claim]:
    """One claim for each component that calls commands of a protocol."""
    found = facts.checked.diagnostics
    open_ = any(one.code == UNFINISHED for one in found)
    for client in clients(facts.checked.system):
        if not client.callers:
            continue
        name, rule = client.component.name, client.protocol
        against = [
            one
            for one in found
            if one.code in OF_PROTOCOLS
            and one.notes[0][0] == rule.origin
            and name in one.message.split()
        ]
        reasons = tuple(f"{one.message} ({one.code})" for one in against)
        yield Claim(
            f"protocol-{name}.{client.provider}", ClaimKind.BEHAVIOUR, client.instances,
            f"{name} calls {', '.join(client.in_order)} of {client.provider} in the order of the "
            f"protocol of {rule.name}",
            "search of all situations, and induction over each step by a solver; about the model, "
            "not about its code",
            "model checking", f"{own_tool()}, z3",
            verdict_of(reasons, shown=bool(reasons) or not open_), reasons, facts.sources,
        )  # fmt: skip
