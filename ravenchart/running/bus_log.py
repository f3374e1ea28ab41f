# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Logs of `ravenchart bus` and `ravenchart run`: what is on the bus, in a format of python-can."""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import can
from can.io.generic import MessageWriter
from can.io.logger import MESSAGE_WRITERS

from ravenchart.failures import Unusable
from ravenchart.hw_can.bench.bus_records import RECORD_BYTES, can_message, decode, greeting_of
from ravenchart.hw_can.bench.peer import OnFrame, unrecorded

CHUNK = 512 * RECORD_BYTES


def suffixes() -> str:
    """The formats, by suffix."""
    return ", ".join(sorted(suffix for suffix in MESSAGE_WRITERS if suffix))


@contextmanager
def written(path: Path) -> Iterator[int]:
    """A descriptor for the server's records, which go to the log; it is whole after the block.

    The one who uses it must have closed it by then. Raises OSError or Unusable where the
    log cannot be written.
    """
    reading, writing = os.pipe()
    with open(reading, "rb", buffering=CHUNK) as source, _opened(path) as logger:
        copying = threading.Thread(target=_copy, args=(source.read, logger))
        copying.start()
        try:
            yield writing
        finally:
            os.close(writing)
            copying.join()


@contextmanager
def recorded(path: Path | None, bus: str) -> Iterator[OnFrame]:
    """A function that adds the frames of a bus to the log, if there is one; raises as `written`."""
    if path is None:
        yield unrecorded
        return

    def record(frame: can.Message) -> None:
        frame.channel = bus
        logger.on_message_received(frame)

    with _opened(path) as logger:
        yield record


def _opened(path: Path) -> MessageWriter:
    try:
        return can.Logger(path)
    except OSError:
        raise
    except Exception as fault:  # of a format whose package is missing, for example
        raise Unusable(f"{path} cannot be written: {fault}") from None


def _copy(read: Callable[[int], bytes], logger: can.Listener) -> None:
    """Each record that is read, as a message of the log.

    A log that cannot be written any more ends, and the bus does not wait for it.
    """
    octets = read(RECORD_BYTES)
    if len(octets) < RECORD_BYTES:
        return
    greeting = greeting_of(decode(octets))
    broken = False
    while len(octets := read(RECORD_BYTES)) == RECORD_BYTES:
        if broken:
            continue
        message = can_message(decode(octets), greeting.start)
        message.channel = greeting.name
        try:
            logger.on_message_received(message)
        except Exception as fault:  # a full disk, for example
            print(f"ravenchart: error: the log ends: {fault}", file=sys.stderr, flush=True)
            broken = True
