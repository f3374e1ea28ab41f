# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The cases of the loopback test. Each returns its result in words, or raises the reason."""

from __future__ import annotations

import time
from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import can

from ravenchart import rounded
from ravenchart.hw_can.bench.bus_records import FD_LENGTHS
from ravenchart.hw_can.bench.peer import BenchError

from .ends import Ends, exchange, opened

BURST = 200
"""Frames of a burst."""

PINGS = 200
"""Frames whose latency is measured, one by one."""

LATEST = 200_000_000
"""Nanoseconds within which each of them must arrive."""

STREAM = 1_000
"""Frames of the throughput."""

LAST = 0x7FF
"""The identifier of least priority, which ends a test of filters."""

SETTLING = 0.1
"""Seconds in which a frame that should not come would have come."""

_NO_ECHO = "slcan has no echo of own frames"
_LIMITS = {
    ("slcan", "esi"): "slcan carries no ESI",
    ("slcan", "echo"): _NO_ECHO,
    ("socketcand", "remote"): "socketcand loses remote frames",
    ("socketcand", "fd"): "socketcand has no FD frames",
}
"""The features that python-can's interfaces lack, by their own formats."""

_CARRY_ERRORS = frozenset({"virtual", "ravenchart"})
"""Interfaces whose bus is a simulated one, where an error frame can be requested."""


class Failed(Exception):  # noqa: N818
    """The case found an error."""


class Skipped(Exception):  # noqa: N818
    """The interface cannot do what the case needs."""


@dataclass(frozen=True, slots=True)
class ConformanceCase:
    """One case: its name, and its function."""

    name: str
    run: Callable[[Ends], str]


def frame(identifier: int, data: bytes = b"", *, extended: bool = False) -> can.Message:
    """A data frame of the classic format."""
    return can.Message(arbitration_id=identifier, is_extended_id=extended, data=data)


def fd_frames(*, brs: bool = False, esi: bool = False) -> list[can.Message]:
    """FD frames of each length, standard and extended."""
    return [
        can.Message(
            arbitration_id=(0x18DA0000 if extended else 0x400) + length,
            is_extended_id=extended,
            is_fd=True,
            bitrate_switch=brs,
            error_state_indicator=esi,
            data=bytes((length + i) % 256 for i in range(length)),
        )
        for extended in (False, True)
        for length in sorted(FD_LENGTHS)
    ]


def every_kind(ends: Ends) -> list[can.Message]:
    """One frame or more of each kind that the bus was opened for."""
    found = [*_data(extended=False)[::4], *_data(extended=True)[::4]]
    return found + (fd_frames()[::5] if ends.setup.fd else [])


def _data(*, extended: bool) -> list[can.Message]:
    base = 0x18FF0000 if extended else 0x300
    return [frame(base + n, bytes(range(n)), extended=extended) for n in range(9)]


def _remote(*, extended: bool) -> list[can.Message]:
    base = 0x18EE0000 if extended else 0x200
    return [
        can.Message(
            arbitration_id=base + n, is_extended_id=extended, is_remote_frame=True, dlc=n
        )
        for n in range(9)
    ]  # fmt: skip


def _needs(ends: Ends, *features: str) -> None:
    """Skipped when the interface is known to lack one of ``features``."""
    if "fd" in features and not ends.setup.fd:
        raise Skipped("the bus was opened without --fd")
    for name in ends.setup.names:
        for feature in features:
            if (name, feature) in _LIMITS:
                raise Skipped(_LIMITS[name, feature])


def exact(sent: Sequence[can.Message], got: Sequence[can.Message]) -> str:
    """Compare with the frames that were sent, in their order; Failed names the first difference."""
    for number, (a, b) in enumerate(zip(sent, got, strict=False), 1):
        if not a.equals(b, timestamp_delta=None, check_channel=False, check_direction=False):
            raise Failed(f"frame {number} of {len(sent)}: sent {_shown(a)}, got {_shown(b)}")
    if len(got) != len(sent):
        raise Failed(f"{len(got)} of {len(sent)} frames arrived")
    return f"{len(sent)} frame{'s' if len(sent) > 1 else ''}, exact"


def _shown(message: can.Message) -> str:
    identifier = f"{message.arbitration_id:0{8 if message.is_extended_id else 3}X}"
    flags = (
        ("R", message.is_remote_frame),
        ("E", message.is_error_frame),
        ("FD", message.is_fd),
        ("BRS", message.bitrate_switch),
        ("ESI", message.error_state_indicator),
    )
    marks = "".join(f" {mark}" for mark, is_set in flags if is_set)
    return f"{identifier}{marks} [{message.dlc}] {message.data.hex()}".rstrip()


def _identifiers(ends: Ends) -> str:
    standard = [frame(n) for n in (0, 1, 0x555, 0x7FE, 0x7FF)]
    extended = [frame(n, extended=True) for n in (0, 0x7FF, 0x800, 0x15555555, 0x1FFFFFFF)]
    sent = standard + extended
    return exact(sent, _one_by_one(ends, sent))


def _one_by_one(ends: Ends, frames: Sequence[can.Message]) -> list[can.Message]:
    """Send each frame after the last one arrived, so that no arbitration is between them."""
    found: list[can.Message] = []
    for one in frames:
        got = ends.across([one])
        if not got:
            break
        found += got
    return found


def _every_byte(ends: Ends) -> str:
    sent = [frame(0x123, bytes(range(n, n + 8))) for n in range(0, 256, 8)]
    return exact(sent, ends.across(sent))


def _remotes(ends: Ends, *, extended: bool) -> str:
    _needs(ends, "remote")
    sent = _remote(extended=extended)
    return exact(sent, _one_by_one(ends, sent))


def _fd(ends: Ends, *features: str) -> str:
    _needs(ends, "fd", *features)
    sent = fd_frames(brs="brs" in features, esi="esi" in features)
    return exact(sent, _one_by_one(ends, sent))


def _error_frame(ends: Ends) -> str:
    if not set(ends.setup.names) <= _CARRY_ERRORS:
        raise Skipped("only a simulated bus makes an error frame on demand")
    sent = [can.Message(arbitration_id=0x88, is_error_frame=True, data=bytes(range(8)))]
    return exact(sent, ends.across(sent))


def _other_way(ends: Ends) -> str:
    if ends.setup.echo:
        raise Skipped("one bus object has no other way")
    sent = every_kind(ends)
    return exact(sent, [got for one in sent for got in ends.back([one])])


def _burst_frames(base: int) -> list[can.Message]:
    return [frame(base + n % 64, n.to_bytes(4, "little")) for n in range(BURST)]


def _none_lost(sent: Sequence[can.Message], got: Sequence[can.Message]) -> None:
    """Compare the frames in any order, because a controller may send by priority."""

    def key(message: can.Message) -> tuple[int, bytes]:
        return message.arbitration_id, bytes(message.data)

    exact(sorted(sent, key=key), sorted(got, key=key))


def _burst(ends: Ends) -> str:
    sent = _burst_frames(0x100)
    _none_lost(sent, ends.across(sent))
    return f"{BURST} frames back to back, none lost"


def _order(ends: Ends) -> str:
    sent = _burst_frames(0x100)
    got = ends.across(sent)
    by_id: dict[int, list[int]] = defaultdict(list)
    for message in got:
        by_id[message.arbitration_id].append(int.from_bytes(message.data, "little"))
    for identifier, numbers in by_id.items():
        if numbers != sorted(numbers):
            raise Failed(f"frames of {identifier:03X} changed places: {numbers}")
    _none_lost(sent, got)
    return f"{len(by_id)} identifiers, each in its order"


def _filters(ends: Ends) -> str:
    last = {"can_id": LAST, "can_mask": 0x1FFFFFFF, "extended": False}
    sent = [
        frame(0x0F0), frame(0x123), frame(0x124), frame(0x123, extended=True),
        frame(0x18FF0001, extended=True), frame(LAST),
    ]  # fmt: skip
    chosen: tuple[tuple[list[dict[str, int | bool]] | None, list[int]], ...] = (
        ([{"can_id": 0x123, "can_mask": 0x7FF, "extended": False}, last], [1, 5]),
        ([{"can_id": 0x120, "can_mask": 0x7F0, "extended": False}, last], [1, 2, 5]),
        ([{"can_id": 0x18FF0000, "can_mask": 0x1FFF0000, "extended": True}, last], [4, 5]),
        (None, [0, 1, 2, 3, 4, 5]),
    )
    try:
        for filters, passing in chosen:
            ends.far.set_filters(filters)  # type: ignore[arg-type]
            got = [message for one in sent for message in _sent_and_seen(ends, one)]
            if (wrong := _exact_or_why([sent[i] for i in passing], got)) is not None:
                raise Failed(f"filters {filters}: {wrong}")
    finally:
        ends.far.set_filters(None)
    return f"{len(chosen)} sets of filters"


def _sent_and_seen(ends: Ends, one: can.Message) -> list[can.Message]:
    """The frames received after sending one frame that may be filtered out."""
    ends.near.send(one)
    end = time.monotonic() + SETTLING
    while (rest := end - time.monotonic()) > 0:
        message = ends.far.recv(rest)
        if message is not None and not message.is_error_frame:
            return [message]
    return []


def _exact_or_why(sent: Sequence[can.Message], got: Sequence[can.Message]) -> str | None:
    try:
        exact(sent, got)
    except Failed as wrong:
        return str(wrong)
    return None


def _echo(ends: Ends) -> str:
    _needs(ends, "echo")
    sent = every_kind(ends)
    if ends.setup.echo:
        return exact(sent, ends.across(sent)) + ", each of its own"
    exact(sent, ends.across(sent))
    if (stray := ends.near.recv(SETTLING)) is not None and not stray.is_error_frame:
        raise Failed(f"own frame {_shown(stray)} came back though not asked for")
    try:
        own = opened(ends.setup.interface, ends.setup.channel, ends.setup, echo=True)
    except BenchError as fault:
        raise Skipped(f"no second bus object: {fault}") from None
    with own:
        return exact(sent, exchange(ends, own, own, sent)) + ", only when asked for"


def _state(ends: Ends) -> str:
    told = []
    for bus in {id(bus): bus for bus in (ends.near, ends.far)}.values():
        if type(bus).state is not can.BusABC.state:
            told.append(bus.state)
    if not told:
        raise Skipped(f"python-can's {' and '.join(ends.setup.names)} tells no state")
    wrong = [state.name for state in told if state is not can.BusState.ACTIVE]
    if wrong:
        raise Failed(f"state {', '.join(wrong)} on a sound bus")
    return f"active at {len(told)} end{'s' if len(told) > 1 else ''}"


def _timestamps(ends: Ends) -> str:
    sent = _burst_frames(0x180)
    got = ends.across(sent)
    _none_lost(sent, got)
    times = [message.timestamp for message in got]
    if not any(times):
        raise Skipped("the interface gives no timestamps")
    if times != sorted(times):
        raise Failed("a frame is stamped earlier than the one before it")
    span = rounded.up(rounded.of_seconds(times[-1] - times[0]))
    return f"{len(times)} in rising order over {span}"


def _latency(ends: Ends) -> str:
    for number in range(PINGS):
        sent = frame(0x321, number.to_bytes(8, "little"))
        began = time.perf_counter_ns()
        ends.near.send(sent)
        got = ends.far.recv(ends.patience)
        taken = time.perf_counter_ns() - began
        exact([sent], [] if got is None else [got])
        ends.latencies.append(taken)
    in_order = sorted(ends.latencies)
    late = [number for number, one in enumerate(ends.latencies, 1) if one > LATEST]
    if late:
        longest, limit = rounded.against(in_order[-1], LATEST)
        raise Failed(
            f"{len(late)} of {PINGS} frames took longer than {limit}, "
            f"the longest {longest}, the first of them frame {late[0]}"
        )
    median, high = in_order[PINGS // 2], in_order[PINGS * 99 // 100]
    longest = rounded.up(in_order[-1])
    return f"median {rounded.up(median)}, 99 % {rounded.up(high)}, max {longest}"


def _throughput(ends: Ends) -> str:
    sent = [frame(0x10000 + n, n.to_bytes(8, "little"), extended=True) for n in range(STREAM)]
    began = time.perf_counter()
    got = ends.across(sent)
    seconds = time.perf_counter() - began
    _none_lost(sent, got)
    ends.rate = STREAM / seconds
    return f"{ends.rate:,.0f} frames/s over {STREAM:,} frames of 8 bytes"


def _no_errors(ends: Ends) -> str:
    ends.drain()
    if ends.errors:
        first = ends.errors[0]
        raise Failed(f"{len(ends.errors)} error frames came, the first {_shown(first)}")
    return "none came unasked"


CASES = (
    ConformanceCase(
        "standard data frames", lambda e: exact(f := _data(extended=False), _one_by_one(e, f))
    ),
    ConformanceCase(
        "extended data frames", lambda e: exact(f := _data(extended=True), _one_by_one(e, f))
    ),
    ConformanceCase("identifiers at their limits", _identifiers),
    ConformanceCase("every byte value", _every_byte),
    ConformanceCase("standard remote frames", lambda ends: _remotes(ends, extended=False)),
    ConformanceCase("extended remote frames", lambda ends: _remotes(ends, extended=True)),
    ConformanceCase("FD frames of every length", _fd),
    ConformanceCase("FD frames, bit rate switched", lambda ends: _fd(ends, "brs")),
    ConformanceCase("FD frames, error state indicated", lambda ends: _fd(ends, "esi")),
    ConformanceCase("error frame", _error_frame),
    ConformanceCase("the other way", _other_way),
    ConformanceCase("burst", _burst),
    ConformanceCase("order", _order),
    ConformanceCase("filters", _filters),
    ConformanceCase("echo", _echo),
    ConformanceCase("error state", _state),
    ConformanceCase("timestamps", _timestamps),
    ConformanceCase("latency", _latency),
    ConformanceCase("throughput", _throughput),
    ConformanceCase("error frames seen", _no_errors),
)
