"""The log of `ravenchart bus`: what is on the bus, in one of python-can's formats."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import can
from can.io.logger import MESSAGE_WRITERS

from ravenchart.hw_can.bench.bus_records import RECORD_BYTES, decode, greeting_of, message_of

CHUNK = 512 * RECORD_BYTES


def suffixes() -> str:
    """The formats, by suffix."""
    return ", ".join(sorted(suffix for suffix in MESSAGE_WRITERS if suffix))


@contextmanager
def written(path: Path) -> Iterator[int]:
    """A descriptor for the server's records, which go to the log; it is whole after the block.

    The one who uses it must have closed it by then. Raises OSError or ValueError where the
    log cannot be written.
    """
    reading, writing = os.pipe()
    with open(reading, "rb", buffering=CHUNK) as source, can.Logger(path) as logger:
        copying = threading.Thread(target=_copy, args=(source.read, logger))
        copying.start()
        try:
            yield writing
        finally:
            os.close(writing)
            copying.join()


def _copy(read: Callable[[int], bytes], logger: can.Listener) -> None:
    """Each record that is read, as a message of the log."""
    octets = read(RECORD_BYTES)
    if len(octets) < RECORD_BYTES:
        return
    greeting = greeting_of(decode(octets))
    while len(octets := read(RECORD_BYTES)) == RECORD_BYTES:
        message = message_of(decode(octets), greeting.start)
        message.channel = greeting.name
        logger.on_message_received(message)
