"""Two slcan adapters on one bus: frame lines of each TCP client go to the others."""

from __future__ import annotations

import socket
import threading
from contextlib import suppress

FRAMES = b"tTrRdDbB"


class SlcanRelay:
    """Listens on a free port of this machine; one thread for each client."""

    def __init__(self) -> None:
        self._socket = socket.create_server(("127.0.0.1", 0))
        self.channel = f"socket://127.0.0.1:{self._socket.getsockname()[1]}"
        self._clients: list[socket.socket] = []
        threading.Thread(target=self._accept, daemon=True).start()

    def cut(self) -> None:
        """Drop every client without a word."""
        for link in self._clients:
            with suppress(OSError):
                link.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        """End."""
        with suppress(OSError):
            self._socket.shutdown(socket.SHUT_RDWR)
        self._socket.close()
        self.cut()

    def _accept(self) -> None:
        with suppress(OSError):
            while True:
                link, _ = self._socket.accept()
                link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                self._clients.append(link)
                threading.Thread(target=self._serve, args=(link,), daemon=True).start()

    def _serve(self, link: socket.socket) -> None:
        rest = b""
        with suppress(OSError):
            while data := link.recv(4096):
                *lines, rest = (rest + data).split(b"\r")
                passing = b"".join(line + b"\r" for line in lines if line[:1] in FRAMES and line)
                for other in self._clients:
                    if other is not link and passing:
                        other.sendall(passing)
