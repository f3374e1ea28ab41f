# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Verdicts of provers, kept by the text of the formula: only changed formulas are proved again.

gnatprove asks a server of the memcached text protocol (its switch ``--memcached-server``) before
it starts a prover. `served` is such a server for the time of one run. It keeps verdicts in a
file of the cache folder, and asks a memcached for those that it has not, where one is given. A
memcached that fails makes the proof slower. The verdicts of both are trusted: ASM-016.

Only proofs are kept: no time limit that a prover ran into, so another run may still find one.
"""

from __future__ import annotations

import hashlib
import re
import socket
import socketserver
import sqlite3
import threading
import time
import zlib
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from typing import IO

from ravenchart.paths import cache

KEPT_BYTES = 400_000_000
"""The oldest verdicts above this go."""
MEMCACHED_PORT = 11211
PATIENCE = 2.0
"""So long a memcached may take for an answer, in s; then it is not asked again in this run."""

_UNPROVED = re.compile(rb'"(result|proof_result)"\s*:\s*false|"error"\s*:')


@contextmanager
def served(tool: str, memcached: Memcached | None = None) -> Iterator[str]:
    """The server for one run of a tool of that version; what ``--memcached-server`` wants.

    Raises OSError where the machine has no port for it.
    """
    server = VerdictServer(("127.0.0.1", 0), _Asked)
    server.prefix = hashlib.sha256(tool.encode()).hexdigest()[:16]
    server.store = _Store(cache() / "verdicts" / "proved.db")
    server.memcached = memcached
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05})
    thread.start()
    try:
        yield f"localhost:{server.server_address[1]}"
    finally:
        server.shutdown()
        thread.join()
        server.server_close()
        server.store.close()


def is_proof(answer: bytes) -> bool:
    """Whether a prover, or gnatprove's own stage before it, has proved all it was asked."""
    if answer.startswith(b"{"):
        return not _UNPROVED.search(answer)
    return answer.startswith(b"unsat")


class _Store:
    """The verdicts of this machine. One that cannot be read or written is none."""

    def __init__(self, path: Path) -> None:
        self._lock = threading.Lock()
        self._file: sqlite3.Connection | None = None
        with suppress(OSError, sqlite3.Error):
            path.parent.mkdir(parents=True, exist_ok=True)
            self._file = sqlite3.connect(path, timeout=10, check_same_thread=False)
            self._file.execute("pragma journal_mode = wal")
            self._file.execute("pragma synchronous = off")
            self._file.execute(
                "create table if not exists verdicts (key text primary key, used real, answer blob)"
            )

    def get(self, key: str) -> bytes | None:
        with self._lock, suppress(sqlite3.Error, zlib.error):
            if self._file is not None:
                query = "select answer from verdicts where key = ?"
                row = self._file.execute(query, (key,)).fetchone()
                return zlib.decompress(row[0]) if row else None
        return None

    def set(self, key: str, answer: bytes) -> None:
        with self._lock, suppress(sqlite3.Error):
            if self._file is not None:
                row = key, time.time(), zlib.compress(answer)
                self._file.execute("insert or replace into verdicts values (?, ?, ?)", row)
                self._file.commit()

    def close(self) -> None:
        """Drop the oldest where there are too many."""
        with self._lock, suppress(sqlite3.Error):
            if self._file is not None:
                with closing(self._file) as file:
                    file.execute(
                        "delete from verdicts where key in (select key from (select key, sum("
                        "length(answer)) over (order by used desc) as total from verdicts)"
                        " where total > ?)",
                        (KEPT_BYTES,),
                    )
                    file.commit()


class Memcached:
    """A memcached of the team: each call is a connection; after a failure it is left alone.

    ``address`` is HOST or HOST:PORT. Raises ValueError for a port that is none.
    """

    def __init__(self, address: str) -> None:
        host, _, port = address.partition(":")
        self._address = host, int(port or MEMCACHED_PORT)
        if not host or not 0 < self._address[1] < 2**16:
            raise ValueError(address)
        self._alive = True

    def get(self, key: str) -> bytes | None:
        with self._asked(b"get %b\r\n" % key.encode()) as answer:
            if answer is not None:
                words = answer.readline().split()
                if len(words) == 4 and words[0] == b"VALUE":
                    found = answer.read(int(words[3]))
                    return found if len(found) == int(words[3]) else None
        return None

    def set(self, key: str, value: bytes) -> None:
        request = b"set %b 0 0 %d\r\n%b\r\n" % (key.encode(), len(value), value)
        with self._asked(request) as answer:
            if answer is not None:
                answer.readline()

    @contextmanager
    def _asked(self, request: bytes) -> Iterator[IO[bytes] | None]:
        if not self._alive:
            yield None
            return
        try:
            with socket.create_connection(self._address, PATIENCE) as connection:
                connection.sendall(request)
                with connection.makefile("rb") as answer:
                    yield answer
        except (OSError, ValueError):
            self._alive = False


class VerdictServer(socketserver.ThreadingTCPServer):
    daemon_threads = True
    request_queue_size = 64
    prefix: str
    store: _Store
    memcached: Memcached | None

    def get(self, key: str) -> bytes | None:
        found = self.store.get(key)
        if found is None and self.memcached is not None:
            found = self.memcached.get(key)
            if found is not None and is_proof(found):
                self.store.set(key, found)
        return found if found is not None and is_proof(found) else None

    def set(self, key: str, answer: bytes) -> None:
        if is_proof(answer):
            self.store.set(key, answer)
            if self.memcached is not None:
                self.memcached.set(key, answer)


class _Asked(socketserver.StreamRequestHandler):
    """The commands ``get KEY`` and ``set KEY FLAGS EXPIRES LENGTH`` of the memcached protocol."""

    server: VerdictServer

    def handle(self) -> None:
        with suppress(OSError, ValueError):
            for line in self.rfile:
                match line.split():
                    case [b"get", key]:
                        answer = self.server.get(f"{self.server.prefix}-{key.decode()}")
                        if answer is not None:
                            self.wfile.write(b"VALUE %b 0 %d\r\n" % (key, len(answer)))
                            self.wfile.write(answer + b"\r\n")
                        self.wfile.write(b"END\r\n")
                    case [b"set", key, _, _, length]:
                        answer = self.rfile.read(int(length))
                        self.rfile.readline()
                        self.server.set(f"{self.server.prefix}-{key.decode()}", answer)
                        self.wfile.write(b"STORED\r\n")
                    case _:
                        self.wfile.write(b"ERROR\r\n")
