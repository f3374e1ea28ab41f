# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Two slcan adapters on one bus: frame lines of each TCP client go to the others."""

from __future__ import annotations

import socket
from contextlib import suppress

from .listening import Listener

FRAMES = b"tTrRdDbB"


class SlcanRelay(Listener):
    """An adapter for each TCP client."""

    def __init__(self) -> None:
        super().__init__()
        self.channel = f"socket://{self.address}"
        self._clients: list[socket.socket] = []
        self.listen()

    def _links(self) -> list[socket.socket]:
        return self._clients

    def _serve(self, link: socket.socket) -> None:
        self._clients.append(link)
        rest = b""
        with suppress(OSError):
            while data := link.recv(4096):
                *lines, rest = (rest + data).split(b"\r")
                passing = b"".join(line + b"\r" for line in lines if line[:1] in FRAMES and line)
                for other in self._clients:
                    if other is not link and passing:
                        other.sendall(passing)
