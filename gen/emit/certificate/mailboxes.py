# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The depths of mailboxes whose senders have a logical execution time.

While a receiver runs, the sender may put in values that become visible later: those of releases
within L + D, where D is the deadline of the receiver. One more is visible.
"""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.emit.ada.declarations import Decl
from ravenchart.gen.emit.ada.expressions import number
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.statements import Comment
from ravenchart.gen.model.logical import logical_links, timed_row
from ravenchart.gen.model.system import Processor, Slot, System

from .certified import timed_by
from .terms import ceiling, name_of, plus, refuse, stated, times


def mailbox_depths(system: System) -> Iterator[Decl]:
    """Each depth, and that it is enough."""
    for link in logical_links(system):
        target, sender = str(link.connection.target), name_of(link.sender.name)
        ahead = plus(ref(f"{sender}_Let"), ref(f"{name_of(link.receiver.name)}_D"))
        places = [timed_row(system, row) for row in link.rows]
        one = [
            ceiling(ahead, times(ref(f"{_timed(*place)}_Divisor"), ref(f"{sender}_T")))
            for place in places
        ]
        needed = [ceiling(ahead, ref(f"{sender}_T"))] if link.by_releases else one
        yield Comment(f"[{target}.mailbox] the values that it keeps")
        depth = ref(f"{name_of(target)}_Depth")
        yield stated(depth, link.depth)
        problem = "may lose a value that is visible"
        yield refuse(plus(number(1), *needed), depth, target, problem)


def _timed(processor: Processor, slot: Slot) -> str:
    return name_of(timed_by(processor.name, processor.slots, slot))
