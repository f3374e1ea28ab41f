# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A server on a free port of this machine, with a thread for each client."""

from __future__ import annotations

import socket
import threading
from abc import ABC, abstractmethod
from collections.abc import Iterable
from contextlib import suppress

from .examples import becomes


class Listener(ABC):
    """Listens from ``listen`` on, until it is closed."""

    def __init__(self) -> None:
        self._socket = socket.create_server(("127.0.0.1", 0))
        self.address = f"127.0.0.1:{self._socket.getsockname()[1]}"

    def listen(self) -> None:
        """Accept clients."""
        threading.Thread(target=self._accept, daemon=True).start()

    def close(self) -> None:
        """End, without a word to anybody."""
        with suppress(OSError):
            self._socket.shutdown(socket.SHUT_RDWR)
        self._socket.close()
        self.cut()

    def cut(self) -> None:
        """Drop every client without a word."""
        for link in self._links():
            with suppress(OSError):
                link.shutdown(socket.SHUT_RDWR)

    def _accept(self) -> None:
        with suppress(OSError):
            while True:
                link, _ = self._socket.accept()
                link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                threading.Thread(target=self._serve, args=(link,), daemon=True).start()

    def wait_for(self, clients: int) -> None:
        """Until so many clients are served: what is said before reaches none of them."""
        assert becomes(lambda: len(list(self._links())) >= clients), f"{clients} are awaited"

    @abstractmethod
    def _links(self) -> Iterable[socket.socket]:
        """The clients that are there."""

    @abstractmethod
    def _serve(self, link: socket.socket) -> None:
        """Serve one client, in its thread."""
