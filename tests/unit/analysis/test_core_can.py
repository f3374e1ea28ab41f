# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Frames: lengths, arbitration, parameters refused, errors, unknown traffic, queues."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import permutations
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ravenchart.analysis.core import holistic
from ravenchart.analysis.core.bus import Bus, Errors, Frame
from ravenchart.analysis.core.can import analyse, load, response_under
from ravenchart.analysis.core.frames import FD_SIZES, Bits, classic_bits, fd_bits, rank
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.core.responses import Reason
from ravenchart.analysis.core.tasks import Task

BUS = Bus(bit_time=1)


def frame(name: str, place: int, cost: int, period: int, **more: Any) -> Frame:
    return Frame(name, place, period, more.pop("deadline", period), cost, **more)


def lists_of_frames(queues: bool) -> st.SearchStrategy[list[Frame]]:
    shapes = st.tuples(
        st.integers(1, 4), st.integers(8, 40), st.integers(0, 9), st.sampled_from(["", "q", "r"])
    )
    return st.lists(shapes, min_size=1, max_size=5).map(
        lambda found: [
            frame(f"m{n}", n, cost, period, jitter=late, queue=name if queues else "")
            for n, (cost, period, late, name) in enumerate(found)
        ]
    )


@pytest.mark.parametrize(
    ("made", "message"),
    [
        (
            lambda: frame("m", 1, 0, 9),
            "transmission_time of message m must be an integer above 0, not 0",
        ),
        (lambda: frame("m", 1, 1, -9), "period of message m must be an integer above 0, not -9"),
        (lambda: frame("m", 1, 1, 9, jitter=-1), "jitter of message m must be an integer from 0"),
        (lambda: analyse([frame("m", 1, 1, 9)] * 2, BUS), "two messages have the name m"),
        (lambda: Bus(0), "bit_time of the bus must be an integer above 0, not 0"),
        (lambda: Errors(0), "period of the error model must be an integer above 0, not 0"),
        (lambda: classic_bits(9), "length of a classic frame must be at most 8, not 9"),
        (lambda: fd_bits(9), "length of a CAN FD frame must be one of"),
        (lambda: rank(0x800), "identifier of a frame must fit 11 bits, not 2048"),
        (lambda: rank(-1), "identifier of a frame must be an integer from 0 up, not -1"),
        (lambda: Bits(55).time(0), "bit_rate of the bus must be an integer above 0, not 0"),
    ],
)
def test_what_has_no_meaning_is_refused_by_name(made: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        made()


# --- Lengths and arbitration -----------------------------------------------------------


def test_times_are_rounded_up_once() -> None:
    assert classic_bits(8).time(500_000) == 270_000
    assert Bits(1).time(3_000_000) == 334
    assert Bits(100, 300).time(500_000, 2_000_000) == 350_000
    assert Bits(1, 1).time(3_000_000, 6_000_000) == 500


def test_fd_lengths_follow_the_layout() -> None:
    #  8 bytes: 17 + 4 stuff + 13; 5 + 64 + (21 - 4) stuff + 4 count + 17 CRC + 6 fixed stuff
    assert fd_bits(8) == Bits(34, 113)
    #  64 bytes: 5 + 512 + (133 - 4) + 4 + 21 + 7
    assert fd_bits(64) == Bits(34, 678)
    assert fd_bits(64, extended=True) == Bits(36 + 8 + 13, 5 + 512 + (138 - 8) + 4 + 21 + 7)
    assert fd_bits(8, switched=False) == Bits(147)
    for size in FD_SIZES:
        assert fd_bits(size, stuffed=False).data < fd_bits(size).data


def test_a_standard_frame_beats_extended_ones_with_its_leading_bits() -> None:
    standard = rank(0x123)
    assert rank(0x122) < standard < rank(0x123 << 18, extended=True)
    assert rank((0x122 << 18) + 0x3FFFF, extended=True) < standard
    assert rank((0x123 << 18) + 5, extended=True) < rank(0x124)


# --- Delays ------------------------------------------------------------------------------


def test_the_terms_by_hand() -> None:
    a, b = analyse([frame("a", 1, 3, 10), frame("b", 2, 5, 20)], BUS)
    assert (a.bound, a.blocked, a.blocker, a.window) == (5 + 3, 5, "b", 5)
    assert (b.bound, b.blocked, b.blocker) == (3 + 5, 0, "")
    assert [(i.frame.name, i.instances, i.time) for i in b.interference] == [("a", 1, 3)]


def test_a_frame_queued_when_arbitration_starts_takes_part() -> None:
    c = analyse([frame("a", 1, 5, 10), frame("b", 2, 5, 100), frame("c", 3, 1, 100)], BUS)[2]
    assert (c.window, c.interference[0].instances) == (15, 2)


def test_unknown_traffic_blocks_the_lowest_too() -> None:
    a, b = analyse([frame("a", 1, 3, 10), frame("b", 2, 5, 20)], replace(BUS, unknown=7))
    assert (a.blocked, a.blocker, b.blocked, b.blocker) == (7, "", 7, "")
    assert b.bound == 7 + 2 * 3 + 5


def test_an_error_costs_its_bits_and_the_longest_frame_of_the_level() -> None:
    frames = [frame("a", 1, 3, 100), frame("b", 2, 5, 200)]
    once = analyse(frames, replace(BUS, errors=Errors(period=1_000)))
    assert [r.errors for r in once] == [31 + 3, 31 + 5]
    assert [r.bound for r in once] == [5 + 34 + 3, 36 + 3 + 5]
    burst = analyse(frames, replace(BUS, errors=Errors(1_000, burst=2, bits=23)))
    assert [r.errors for r in burst] == [2 * (23 + 3), 2 * (23 + 5)]


def test_errors_that_leave_no_time_leave_no_bound() -> None:
    found = analyse([frame("a", 1, 3, 10)], replace(BUS, errors=Errors(period=34)))
    assert (found[0].bound, found[0].reason) == (None, Reason.OVERLOAD)


def test_load_above_one_has_no_bound_below_that_place() -> None:
    found = analyse([frame("a", 1, 5, 10), frame("b", 2, 5, 10), frame("c", 3, 1, 10)], BUS)
    assert [r.reason for r in found] == [None, None, Reason.OVERLOAD]
    assert load([r.frame for r in found]) == Fraction(11, 10)


# --- Of one rank -----------------------------------------------------------------------


def test_frames_of_one_rank_are_sent_before_each_other() -> None:
    a, b, c, d = analyse(
        [frame("a", 1, 2, 50), frame("b", 2, 3, 50), frame("c", 2, 5, 50), frame("d", 3, 7, 50)],
        BUS,
    )
    assert (a.bound, d.bound) == (7 + 2, 2 + 3 + 5 + 7)
    assert (b.bound, c.bound) == (7 + 2 + 5 + 3, 7 + 2 + 3 + 5)
    assert (b.blocker, c.blocker) == ("d", "d")
    assert [(i.frame.name, i.time) for i in b.interference] == [("c", 5), ("a", 2)]


def test_a_queue_is_no_more_urgent_than_what_has_the_rank_of_its_last() -> None:
    frames = [
        frame("a", 1, 4, 90, queue="q"),
        frame("b", 2, 4, 90, queue="q"),
        frame("c", 2, 4, 90),
    ]
    assert [r.bound for r in analyse(frames, BUS)] == [12, 12, 12]


@settings(max_examples=150, deadline=None)
@given(st.data())
def test_with_one_rank_a_response_is_the_longest_of_all_orders(data: st.DataObject) -> None:
    frames = data.draw(lists_of_frames(queues=data.draw(st.booleans())))
    first = data.draw(st.integers(0, len(frames) - 1))
    last = data.draw(st.integers(first, len(frames) - 1))
    tied = [replace(f, rank=first) if first <= f.rank <= last else f for f in frames]
    found = {r.frame.name: r.bound for r in analyse(tied, BUS)}
    longest: dict[str, int | None] = {}
    for order in permutations(range(first, last + 1)):
        ranks = dict(zip(range(first, last + 1), order, strict=True))
        for one in analyse([replace(f, rank=ranks.get(f.rank, f.rank)) for f in frames], BUS):
            name, known = one.frame.name, longest.get(one.frame.name, 0)
            longest[name] = None if known is None or one.bound is None else max(known, one.bound)
    if any(f.queue for f in frames):
        assert all(
            bound is None or ((most := longest[n]) is not None and most <= bound)
            for n, bound in found.items()
        )
    else:
        assert found == longest


# --- First in, first out -------------------------------------------------------------------


def test_a_queued_frame_waits_at_the_least_urgent_place_of_its_queue() -> None:
    frames = [
        frame("a", 1, 4, 100, queue="q"),
        frame("b", 2, 4, 100),
        frame("c", 3, 4, 100, queue="q"),
        frame("d", 4, 4, 100),
    ]
    found = {r.frame.name: r for r in analyse(frames, BUS)}
    #  a: d, b and c before it; without the queue only one of the others
    assert (found["a"].bound, found["c"].bound) == (16, 16)
    assert {i.frame.name for i in found["a"].interference} == {"b", "c"}
    #  b: the same for the others, a may be late by what it waits
    assert (found["b"].bound, found["d"].bound) == (12, 16)
    assert found["b"].level.jitter(frames[0], frames[1]) == 12


def test_queues_that_wait_for_each_other_settle_or_have_no_bound() -> None:
    frames = [frame(f"m{n}", n, 4, 60, queue="pq"[n % 2]) for n in range(8)]
    assert all(r.bound is not None for r in analyse(frames, BUS))
    full = [replace(f, period=33) for f in frames]
    for response in analyse(full, BUS):
        assert response.bound is not None or response.reason is not None


@settings(max_examples=150, deadline=None)
@given(lists_of_frames(queues=True), st.integers(0, 3))
def test_a_queue_never_shortens_a_response_and_terms_add_up(
    frames: list[Frame], unknown: int
) -> None:
    bus = replace(BUS, unknown=unknown, errors=Errors(500) if unknown == 3 else None)
    free = analyse([replace(f, queue="") for f in frames], bus)
    for queued, alone in zip(analyse(frames, bus), free, strict=True):
        if queued.bound is None:
            continue
        assert alone.bound is not None and alone.bound <= queued.bound
        parts = queued.blocked + queued.own + queued.errors
        assert parts + sum(i.time for i in queued.interference) == queued.window
        item = queued.frame
        total = (
            item.jitter
            + queued.window
            + item.transmission_time
            - queued.worst_instance * item.period
        )
        assert total == queued.bound


@settings(max_examples=100, deadline=None)
@given(lists_of_frames(queues=False))
def test_one_response_alone_is_the_same(frames: list[Frame]) -> None:
    for n, response in enumerate(analyse(frames, BUS)):
        alone = response_under(frames[n], frames[:n], frames[n + 1 :], BUS)
        assert (alone.bound, alone.instances) == (response.bound, response.instances)


# --- What is said of full buses, and what a frame's receivers may count on ---------------


@pytest.mark.parametrize("reloaded", [False, True])
def test_an_overloaded_bus_is_the_reason_why_a_queue_has_no_bound(reloaded: bool) -> None:
    queued = [
        Frame(name, rank, 100, 100, 60, queue="node", reloaded=reloaded)
        for rank, name in enumerate(("a", "b"))
    ]
    for found in analyse([*queued, Frame("c", 9, 100, 100, 1)], Bus(1)):
        assert found.bound is None
        assert found.reason in (Reason.OVERLOAD, Reason.DELAYED)
        if found.frame.queue:
            assert found.reason is Reason.OVERLOAD
            assert found.level.load == Fraction(121, 100)


def test_a_receiver_may_have_a_frame_three_bits_before_the_bus_is_free() -> None:
    """A frame of one length still makes what it releases up to three bits early."""
    for best, late in ((50, 6), (40, 16), (3, 50), (0, 50)):
        network = Network(
            tasks=(Task("act", 1, 100, 100, 5, core="a"), Task("low", 0, 100, 100, 1, core="a")),
            frames={"bus": (Frame("m", 1, 100, 100, 50, best=best),)},
            buses={"bus": Bus(2)},
            released_by={"act": "m"},
        )
        found = holistic.analyse(network)
        assert found.inherited["act"] == late
        assert found.from_event("act") == 55
