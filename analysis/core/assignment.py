# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Priorities for tasks and identifiers for frames.

Deadline monotonic order (Leung and Whitehead 1982), here by deadline less jitter, is
optimal for plain tasks with deadlines up to the period. With longer deadlines,
sections, or on a bus it is only a good guess. Audsley's assignment (1991, 2001) finds
an order whenever there is one that this analysis accepts. The reason: the acceptance of
a task depends on the set of more urgent tasks, not on their order among each other. This
holds for ceiling blocking too, which depends on the same two sets.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TypeVar

from . import can
from .bus import Bus, Frame
from .can_response import FrameLevel, FrameResponse
from .responses import Reason
from .tasks import Task

Item = TypeVar("Item", Task, Frame)


@dataclass(frozen=True, slots=True)
class Order:
    """Names, most urgent first, when ``complete``; else ``names`` are those that fit.

    Of an incomplete order ``names`` are the least urgent ones, and none of the
    ``unplaced`` meets its deadline below all others of them.
    """

    names: tuple[str, ...]
    unplaced: tuple[str, ...] = ()

    @property
    def complete(self) -> bool:
        """Every deadline is met in this order."""
        return not self.unplaced


def deadline_monotonic(items: Sequence[Item]) -> list[Item]:
    """The items by deadline less jitter, shortest first; equal ones as given."""
    return sorted(items, key=lambda item: item.deadline - item.jitter)


Candidates = Callable[[Sequence[Item], Sequence[Item]], Iterable[Item]]
"""The items that may go directly above those placed, in the order to try: (left, placed)."""


def longest_deadline_first(left: Sequence[Item], _: Sequence[Item]) -> Iterable[Item]:
    """All that are left, from the longest deadline less jitter."""
    return reversed(left)


def audsley_frames(
    frames: Sequence[Frame], bus: Bus, candidates: Candidates[Frame] = longest_deadline_first
) -> Order:
    """An order of the frames of one bus in which all deadlines are met, if there is one.

    Their ranks do not count. The assignment is optimal on CAN too: of the less urgent frames only
    the longest counts, which does not depend on their order (Davis et al. 2007).
    ``candidates`` may hold back frames whose place is bound. ValueError for a
    first-in first-out queue that is not ``reloaded``: there the order within it counts.
    """
    fits = responses_in_place(frames, bus)
    return audsley(frames, lambda frame, above, below: fits(frame, above, below).met, candidates)


def responses_in_place(
    frames: Sequence[Frame], bus: Bus
) -> Callable[[Frame, Sequence[Frame], Sequence[Frame]], FrameResponse]:
    """The response of a frame, of the frames above it and of those below it.

    ValueError as for `audsley_frames`.
    """
    delays = can.delays_in_any_order(frames, bus)
    known = {name: delay for name, delay in delays.items() if delay is not None}

    def response(frame: Frame, above: Sequence[Frame], below: Sequence[Frame]) -> FrameResponse:
        if frame.queue:
            above, below = (*above, *below), ()
        for other in (frame, *above):
            if delays.get(other.name, 0) is None:
                level = FrameLevel((*above, frame, *below), len(above) + 1, bus, known)
                return FrameResponse(frame, level, None, reason=Reason.DELAYED)
        return can.response_under(frame, above, below, bus, known)

    return response


def audsley(
    items: Sequence[Item],
    fits: Callable[[Item, Sequence[Item], Sequence[Item]], bool],
    candidates: Candidates[Item],
) -> Order:
    """From the lowest place up, the first of the candidates that fits there."""
    left = deadline_monotonic(items)
    placed: list[Item] = []
    while left:
        for item in candidates(left, placed):
            above = [other for other in left if other is not item]
            if fits(item, above, placed):
                left = above
                placed.insert(0, item)
                break
        else:
            break
    return Order(tuple(item.name for item in placed), tuple(item.name for item in left))
