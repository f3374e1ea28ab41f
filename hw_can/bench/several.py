# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Several buses as one for the bench: each frame has the name of its bus as its channel."""

from __future__ import annotations

import select
import time
from collections.abc import Mapping
from contextlib import ExitStack

import can

from .peer import BenchError, Codec, FrameValues, OnFrame, Peer, Value
from .protection import Wrong

POLL = 0.001
"""Seconds between two looks at buses whose drivers have no descriptor to wait for."""


class JoinedCodec(Codec):
    """The messages of several buses, whose names are all different."""

    def __init__(self, codecs: Mapping[str, Codec]) -> None:
        """The codec of each bus, by the name of the bus."""
        self.codecs = codecs

    @property
    def has_fd(self) -> bool:
        """Whether there are CAN FD frames among the messages of any bus."""
        return any(codec.has_fd for codec in self.codecs.values())

    def fields(self, name: str) -> tuple[str, ...]:
        """The fields of a message; BenchError when no bus has one of that name."""
        return self._of(name)[1].fields(name)

    def faulty(
        self, name: str, values: Mapping[str, Value], wrong: Wrong | None
    ) -> can.Message | None:
        """The frame of the bus that has the message, as `Codec.faulty`."""
        bus, codec = self._of(name)
        frame = codec.faulty(name, values, wrong)
        if frame is not None:
            frame.channel = bus
        return frame

    def check(self, name: str, values: Mapping[str, Value], wrong: Wrong | None) -> None:
        """BenchError where `faulty` raises it."""
        self._of(name)[1].check(name, values, wrong)

    def decode(self, frame: can.Message) -> tuple[str, FrameValues] | None:
        """Name and values of a frame of the bus that is its channel, as `Codec.decode`."""
        codec = self.codecs.get(str(frame.channel))
        return None if codec is None else codec.decode(frame)

    def from_outside(self, frame: can.Message) -> str | None:
        """The message that the frame of a log is, if no node sends it; else None.

        Its channel is the name of a bus, or becomes that of the only one which has its identifier.
        A frame of a bus that nothing names is of no message.
        """
        if frame.channel not in self.codecs:
            known = [bus for bus, codec in self.codecs.items() if codec.knows(frame)]
            if len(known) != 1:
                return None
            frame.channel = known[0]
        return self.codecs[str(frame.channel)].from_outside(frame)

    def _of(self, name: str) -> tuple[str, Codec]:
        """The bus with the message, and its codec."""
        for bus, codec in self.codecs.items():
            if codec.has(name):
                return bus, codec
        raise BenchError(f"no bus has a message {name}")


class JoinedBus(can.BusABC):
    """Ends of several buses, as one of python-can: the channel of a frame names its bus."""

    def __init__(self, ends: Mapping[str, can.BusABC]) -> None:
        """The end of each bus, by the name of the bus; they are shut down together."""
        super().__init__(channel=", ".join(ends))
        self._ends = ends
        self.channel_info = ", ".join(ends)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Send the frame on its bus; raises as `can.BusABC.send`."""
        self._ends[str(msg.channel)].send(msg, timeout)

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        """The next frame of any bus."""
        limit = None if timeout is None else time.monotonic() + timeout
        while True:
            for name, end in self._ends.items():
                frame = end.recv(timeout=0)
                if frame is not None:
                    frame.channel = name
                    return frame, False
            rest = None if limit is None else limit - time.monotonic()
            if rest is not None and rest <= 0:
                return None, False
            self._wait(rest)

    def _wait(self, rest: float | None) -> None:
        """Until a frame may have come, or the time is over."""
        try:
            descriptors = [end.fileno() for end in self._ends.values()]
        except NotImplementedError:
            time.sleep(POLL if rest is None else min(POLL, rest))
        else:
            select.select(descriptors, [], [], rest)

    def shutdown(self) -> None:
        """Leave all buses."""
        super().shutdown()
        with ExitStack() as stack:
            for end in self._ends.values():
                stack.callback(end.shutdown)


def codec_of(codecs: Mapping[str, Codec]) -> Codec:
    """That of the only bus, or of all of them together."""
    return JoinedCodec(codecs) if len(codecs) > 1 else next(iter(codecs.values()))


def joined_bus(ends: Mapping[str, can.BusABC]) -> can.BusABC:
    """The end of the only bus, or all of them together."""
    return JoinedBus(ends) if len(ends) > 1 else next(iter(ends.values()))


def codec_at(codec: Codec, bus: str) -> Codec:
    """The codec of one bus."""
    return codec.codecs[bus] if isinstance(codec, JoinedCodec) else codec


def joined_servers(channels: Mapping[str, str], codec: Codec) -> Peer:
    """A peer that is a node of each bus, behind ``host:port``; BenchError where there is none."""
    ends: dict[str, can.BusABC] = {}
    for bus, channel in channels.items():
        fd = codec_at(codec, bus).has_fd
        try:
            ends[bus] = can.Bus(interface="ravenchart", channel=channel, name="bench", fd=fd)
        except (can.CanError, OSError) as fault:
            for end in ends.values():
                end.shutdown()
            raise BenchError(f"no bus at {channel}: {fault}") from None
    return Peer(joined_bus(ends), codec)


def by_bus(records: Mapping[str, OnFrame]) -> OnFrame:
    """A function that hands each frame to that of its bus; of one bus all frames are its own."""
    if len(records) == 1:
        return next(iter(records.values()))

    def record(frame: can.Message) -> None:
        records[str(frame.channel)](frame)

    return record
