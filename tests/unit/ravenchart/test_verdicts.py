# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Verdicts of provers that are kept: proofs alone, under the tool's version; no cache is needed."""

from __future__ import annotations

import shutil
import socket
import socketserver
import subprocess
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from ravenchart.proof import verdicts
from ravenchart.proof.verdicts import Memcached, served

pytestmark = pytest.mark.clock

PROVED = b"unsat\n(:rlimit-count 5832)"


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty cache folder."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "ravenchart"


def asked(address: str, *requests: bytes) -> bytes:
    """All that a server of the memcached protocol answers."""
    host, port = address.split(":")
    with socket.create_connection((host, int(port)), 5) as connection:
        for request in requests:
            connection.sendall(request)
        connection.shutdown(socket.SHUT_WR)
        with connection.makefile("rb") as answer:
            return answer.read()


def put(address: str, key: bytes, answer: bytes) -> bytes:
    return asked(address, b"set %b 0 0 %d\r\n%b\r\n" % (key, len(answer), answer))


def got(address: str, key: bytes) -> bytes:
    return asked(address, b"get %b\r\n" % key)


HIT = b"VALUE k 0 %d\r\n%b\r\nEND\r\n" % (len(PROVED), PROVED)
MISS = b"END\r\n"


def test_a_proof_is_kept_for_later_runs_of_the_same_tool() -> None:
    with served("one") as server:
        assert got(server, b"k") == MISS
        assert put(server, b"k", PROVED) == b"STORED\r\n"
    with served("one") as server:
        assert got(server, b"k") == HIT
    with served("other") as server:
        assert got(server, b"k") == MISS


@pytest.mark.parametrize(
    "answer",
    [
        b"unknown\n",
        b"timeout\n",
        b"sat\n",
        b"",
        b'{"error": "no prover", "results": []}',
        b'{"results": [{"id": 1, "result": true}, {"id": 2, "result" : false}]}',
    ],
)
def test_what_is_not_a_proof_is_not_kept(answer: bytes) -> None:
    with served("one") as server:
        assert put(server, b"k", answer) == b"STORED\r\n"
        assert got(server, b"k") == MISS


def test_binary_answers_and_several_requests_of_one_connection() -> None:
    answer = b'{"results": [{"result": true}]}\r\nEND\r\n\x00'
    with served("one") as server:
        both = asked(
            server, b"set k 0 0 %d\r\n%b\r\n" % (len(answer), answer), b"get k\r\n", b"huh\r\n"
        )
    assert both == b"STORED\r\nVALUE k 0 %d\r\n%b\r\nEND\r\nERROR\r\n" % (len(answer), answer)


def test_a_store_that_is_broken_or_cannot_be_written_is_no_store(home: Path) -> None:
    (home / "verdicts").mkdir(parents=True)
    (home / "verdicts" / "proved.db").write_bytes(b"no database" * 100)
    with served("one") as server:
        assert put(server, b"k", PROVED) == b"STORED\r\n"
        assert got(server, b"k") == MISS


def test_the_oldest_go_when_there_are_too_many(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(verdicts, "KEPT_BYTES", 100)
    with served("one") as server:
        for number in range(20):
            put(server, b"k%d" % number, PROVED)
            time.sleep(0.002)
    with served("one") as server:
        found = [number for number in range(20) if got(server, b"k%d" % number) != MISS]
    assert found
    assert found[-1] == 19
    assert found == list(range(found[0], 20))
    assert len(found) < 5


@contextmanager
def memcached() -> Iterator[str]:
    """A real memcached on a free port."""
    if shutil.which("memcached") is None:
        pytest.skip("memcached is not installed: apt-get install memcached")
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
    words = ["memcached", "-l", "127.0.0.1", "-p", str(port), "-U", "0", "-u", "nobody"]
    process = subprocess.Popen(words)
    try:
        until = time.monotonic() + 10
        while time.monotonic() < until:
            try:
                socket.create_connection(("127.0.0.1", port), 1).close()
                break
            except OSError:
                time.sleep(0.02)
        yield f"127.0.0.1:{port}"
    finally:
        process.kill()
        process.wait()


def test_a_second_machine_takes_the_proofs_of_the_first_from_a_memcached(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with memcached() as shared:
        with served("one", Memcached(shared)) as server:
            put(server, b"k", PROVED)
        monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "second"))
        with served("one", Memcached(shared)) as server:
            assert got(server, b"k") == HIT
    with served("one") as server:  # and has them by itself from then on
        assert got(server, b"k") == HIT


class Liar(socketserver.StreamRequestHandler):
    """Answers that no memcached gives."""

    def handle(self) -> None:
        self.rfile.readline()
        self.wfile.write(b"VALUE k 0 3000\r\nunsat\r\nEND\r\n")


def test_a_memcached_that_fails_is_not_asked_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(verdicts, "PATIENCE", 0.3)
    with (
        socket.create_server(("127.0.0.1", 0)) as silent,  # never answers
        served("one", Memcached(f"127.0.0.1:{silent.getsockname()[1]}")) as server,
    ):
        began = time.monotonic()
        for _ in range(10):
            assert got(server, b"k") == MISS
        assert put(server, b"k", PROVED) == b"STORED\r\n"
        assert got(server, b"k") == HIT
        assert time.monotonic() - began < 2.5  # one wait, not ten


def test_a_truncated_answer_of_a_memcached_is_no_verdict() -> None:
    with socketserver.TCPServer(("127.0.0.1", 0), Liar) as liar:
        thread = threading.Thread(target=liar.serve_forever, args=(0.05,))
        thread.start()
        try:
            with served("one", Memcached(f"127.0.0.1:{liar.server_address[1]}")) as server:
                assert got(server, b"k") == MISS
        finally:
            liar.shutdown()
            thread.join()


@pytest.mark.parametrize("address", ["", ":11211", "host:no", "host:0", "host:65536"])
def test_an_address_that_is_none_is_refused(address: str) -> None:
    with pytest.raises(ValueError):
        Memcached(address)
