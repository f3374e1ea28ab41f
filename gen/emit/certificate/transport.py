# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Values that travel in several frames in the timing certificate (ISO-TP).

A round trip holds the delivery of a segment, an execution of the port region that sends flow
control, and the delivery of that. It ends with the next release of the sender's row.
"""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.emit.ada.declarations import Decl
from ravenchart.gen.emit.ada.expressions import Expr, number
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.statements import Comment
from ravenchart.gen.model.buses import Message, Reception
from ravenchart.gen.model.claims import Claims
from ravenchart.gen.model.system import System
from ravenchart.gen.model.transport import Transport

from .terms import assured, ceiling, exact, name_of, named_number, plus, refuse, stated, times


def transferred(system: System) -> Iterator[tuple[Message, Transport, Reception, Reception]]:
    """Each message in several frames, with the reception of a segment and of flow control."""
    flows = {message.controls: message for message in system.messages if message.controls}
    for message in system.messages:
        flow = flows.get(message.name)
        if message.transport is not None and flow is not None:
            ends = *system.receptions(message), *system.receptions(flow)
            if len(ends) == 2:  # and not the part of a node
                yield message, message.transport, *ends


def transfer_claims(system: System, claims: Claims) -> list[Decl]:
    """How long each transfer takes, from the frames that it consists of."""
    items: list[Decl] = []
    for message, transport, there, back in transferred(system):
        own, label = name_of(message.element), message.element
        claim = claims.transfers.get(message.element, (0, 0))
        segment, answer = ref(f"{name_of(there.element)}_Handed"), f"{name_of(back.element)}_Handed"
        apart, row = ref(f"{own}_T"), ref(f"{own}_Row")
        heard = plus(segment, ref(f"{name_of(back.message.element)}_T"), ref(answer))
        trip, bound = ref(f"{own}_Round_Trip"), ref(f"{own}_Transfer")
        further = transport.segments - 1 - transport.rounds
        last: list[Expr] = [times(number(transport.rounds), trip)]
        last += [times(number(further), apart)] if further else []
        words = f"[{label}] a value of {transport.length} bytes travels in {transport.segments} "
        words += f"segments, with flow control {transport.rounds} times. Row: the period of the "
        words += "row that sends. Round_Trip: the time from a segment that flow control follows to "
        words += "the next segment. Transfer: the time from the first release until the value is "
        words += "handed over. Renewal: the time from one value to the next."
        items += [
            Comment(words),
            stated(f"{own}_Row", transport.row),
            stated(f"{own}_Round_Trip", claim[0]),
            exact(trip, [apart, times(ceiling(heard, row), row)], label, "round trip"),
            stated(f"{own}_Transfer", claim[1]),
            exact(bound, [plus(*last, segment)], label, "transfer"),
            named_number(f"{own}_Renewal", plus(*last, apart)),
            stated(f"{own}_Timeout", transport.timeout),
            refuse(plus(trip, segment), ref(f"{own}_Timeout"), label, "can be given up in time"),
            assured((plus(trip, segment), ref(f"{own}_Timeout"))),
        ]
    return items
