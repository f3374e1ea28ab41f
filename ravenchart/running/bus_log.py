# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Logs of `ravenchart bus` and `ravenchart run`: what is on the bus, in a format of python-can.

A run also shows its frames to those who watch its bus (`bus_ring`).
"""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path

import can
from can.io.generic import MessageWriter
from can.io.logger import MESSAGE_WRITERS

from ravenchart.failures import Unusable
from ravenchart.hw_can.bench.bus_records import RECORD_BYTES, can_message, decode, greeting_of
from ravenchart.hw_can.bench.peer import OnFrame
from ravenchart.hw_can.bench.several import by_bus

from . import bus_ring
from .bus_ring import BusRing

CHUNK = 512 * RECORD_BYTES


def suffixes() -> str:
    """The formats, by suffix."""
    return ", ".join(sorted(suffix for suffix in MESSAGE_WRITERS if suffix))


@contextmanager
def written(path: Path | None, beside: Path | None = None, bus: str = "") -> Iterator[int]:
    """A descriptor for the server's records, which go to the log; it is whole after the block.

    They also go to a ring ``beside`` a program, of that ``bus`` where there are several. The one
    who uses the descriptor must have closed it by then. Raises OSError or Unusable where the log
    cannot be written.
    """
    with ExitStack() as stack:
        logger = None if path is None else stack.enter_context(_opened(path))
        ring = stack.enter_context(bus_ring.shown(beside, bus))
        reading, writing = os.pipe()
        source = stack.enter_context(open(reading, "rb", buffering=CHUNK))
        copying = threading.Thread(target=_copy, args=(source.read, logger, ring))
        copying.start()
        try:
            yield writing
        finally:
            os.close(writing)
            copying.join()


@contextmanager
def recorded(path: Path | None, bus: str, beside: Path | None = None) -> Iterator[OnFrame]:
    """A function that adds the frames of a bus to the log, if there is one; raises as `written`.

    It also adds them to a ring ``beside`` a program.
    """
    with ExitStack() as stack:
        logger = None if path is None else stack.enter_context(_opened(path))
        ring = stack.enter_context(bus_ring.shown(beside))

        def record(frame: can.Message) -> None:
            if ring is not None:
                ring.take(frame)
            if logger is not None:
                frame.channel = bus
                logger.on_message_received(frame)

        yield record


@contextmanager
def all_recorded(path: Path | None, buses: Sequence[str]) -> Iterator[OnFrame]:
    """The same for several buses, each with a log of its own as `log_of` names it."""
    with ExitStack() as stack:
        records = {
            bus: stack.enter_context(recorded(log_of(path, bus, buses), bus)) for bus in buses
        }
        yield by_bus(records)


def log_of(path: Path | None, bus: str, buses: Sequence[str]) -> Path | None:
    """The log of one of these buses: ``run-chassis.blf`` of several; None without a log."""
    if path is None or len(buses) == 1:
        return path
    return path.with_stem(f"{path.stem}-{bus}")


def _opened(path: Path) -> MessageWriter:
    try:
        return can.Logger(path)
    except OSError:
        raise
    except Exception as fault:  # of a format whose package is missing, for example
        raise Unusable(f"{path} cannot be written: {fault}") from None


def _copy(read: Callable[[int], bytes], logger: can.Listener | None, ring: BusRing | None) -> None:
    """Each record that is read, as a message of the log and in the ring.

    A log that cannot be written any more ends, and the bus does not wait for it.
    """
    octets = read(RECORD_BYTES)
    if len(octets) < RECORD_BYTES:
        return
    greeting = greeting_of(decode(octets))
    if ring is not None:
        ring.begin(greeting.start)
    while len(octets := read(RECORD_BYTES)) == RECORD_BYTES:
        if ring is not None:
            ring.put(octets)
        if logger is None:
            continue
        message = can_message(decode(octets), greeting.start)
        message.channel = greeting.name
        try:
            logger.on_message_received(message)
        except Exception as fault:  # a full disk, for example
            print(f"ravenchart: error: the log ends: {fault}", file=sys.stderr, flush=True)
            logger = None
