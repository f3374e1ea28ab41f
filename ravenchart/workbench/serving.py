# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A page from its start to a request to stop: port, address, browser and signals."""

from __future__ import annotations

import asyncio
import gc
import os
import signal
import socket
import sys
import threading
import webbrowser
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import uvicorn

from ravenchart.failures import Unusable

from .guard import LARGEST, token
from .pages import Pages
from .publishing import Publisher

ADDRESS = "127.0.0.1"
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
PATIENCE = 5
"""Seconds that answers under way may take at the end."""


def serve(
    made: Callable[[], Pages],
    port: int,
    *,
    browser: bool,
    say: Callable[[str], None],
    serves: Callable[[str], None],
) -> None:
    """Show a page until a signal asks the process to end; the signal is then raised again.

    ``port`` 0: a free one. ``made`` reads the model. ``serves`` gets the address. Refused where
    the model has errors, Unusable where the port is taken.
    """
    with _bound(port) as listening:
        pages = made()
        gc.collect()
        gc.freeze()  # what is there now stays: no search for garbage in a change goes through it
        publisher = pages.publisher
        secret, number = token(), listening.getsockname()[1]
        address = f"http://{ADDRESS}:{number}/{secret}/"
        serves(address)
        if browser:
            _open(address, say)
        config = uvicorn.Config(
            pages.guarded(secret, number),
            http="h11", ws="none", lifespan="off", log_config=None, log_level="error",
            access_log=False, server_header=False, limit_concurrency=100,
            h11_max_incomplete_event_size=LARGEST, timeout_keep_alive=5,
            timeout_graceful_shutdown=PATIENCE,
        )  # fmt: skip
        with _heeding() as asked:
            asyncio.run(_served(_Server(config), publisher, listening, asked))
        publisher.shut()
    if asked:
        signal.raise_signal(asked[0])


class _Server(uvicorn.Server):
    """Signals are those of this program, not of the server."""

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Leave them alone."""
        yield


async def _served(
    server: _Server, publisher: Publisher, listening: socket.socket, asked: list[signal.Signals]
) -> None:
    """Serve until a signal comes."""
    loop = asyncio.get_running_loop()
    ends: set[asyncio.Task[None]] = set()

    def stop(number: signal.Signals) -> None:
        server.force_exit = bool(asked)
        asked.append(number)
        server.should_exit = True
        ends.add(asyncio.ensure_future(publisher.close()))

    for number in SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            loop.add_signal_handler(number, stop, number)
    publisher.start()
    await server.serve(sockets=[listening])
    await asyncio.gather(*ends)


@contextmanager
def _heeding() -> Iterator[list[signal.Signals]]:
    """Signals are collected for the time of a block, and afterwards handled as before."""
    before = {number: signal.getsignal(number) for number in SIGNALS}
    try:
        yield []
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextmanager
def _bound(port: int) -> Iterator[socket.socket]:
    """A socket that listens at a port of this machine alone."""
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as made:
        made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            made.bind((ADDRESS, port))
            made.listen(128)
        except OSError as problem:
            text = f"port {port} cannot be used: {problem.strerror}; choose another by --port"
            raise Unusable(text) from problem
        yield made


def _open(address: str, say: Callable[[str], None]) -> None:
    """Show the page in the user's browser, where this session has a screen."""
    screens = ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")
    if sys.platform.startswith("linux") and not any(os.environ.get(one) for one in screens):
        say("There is no screen here: open the address in a browser.")
        return

    def show() -> None:
        if not webbrowser.open(address):
            say("No browser was found: open the address in one.")

    threading.Thread(target=show, daemon=True).start()
