# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A local page that runs as a process, spoken to as a browser does and as an attacker would."""

from __future__ import annotations

import http.client
import json
import os
import queue
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.support.processes import ROOT

PATIENCE = 60.0
"""Seconds for a start, a state or an end on a busy machine."""


@dataclass
class Reply:
    """The answer to one request."""

    status: int
    headers: Mapping[str, str]
    body: bytes

    @property
    def json(self) -> Any:
        """What it says."""
        return json.loads(self.body)


@dataclass
class Running:
    """The process, with its address taken apart."""

    process: subprocess.Popen[str]
    port: int
    token: str
    lines: list[str]

    @property
    def address(self) -> str:
        """As it was printed."""
        return f"http://127.0.0.1:{self.port}/{self.token}/"

    def request(
        self,
        path: str,
        body: bytes | None = None,
        headers: Mapping[str, str] | None = None,
        method: str | None = None,
        *,
        token: str | None = None,
        whole: bool = False,
    ) -> Reply:
        """One request, below the token unless the path is ``whole``."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE)
        target = path if whole else f"/{self.token if token is None else token}/{path}"
        given = dict(headers or {})
        kind = method or ("GET" if body is None else "POST")
        connection.putrequest(kind, target, skip_host="host" in given, skip_accept_encoding=True)
        if body is not None and "transfer-encoding" not in given:
            given.setdefault("content-length", str(len(body)))
            given.setdefault("content-type", "application/json")
        for name, value in given.items():
            connection.putheader(name, value)
        connection.endheaders(body)
        answer = connection.getresponse()
        found = Reply(answer.status, dict(answer.getheaders()), answer.read())
        connection.close()
        return found

    def state(self) -> Any:
        """The state now."""
        return self.request("state").json

    def act(self, **message: Any) -> Reply:
        """A message about the state now."""
        told = {"number": self.state()["number"]} | message
        return self.request("act", json.dumps(told).encode())

    def stream(self) -> queue.Queue[Any]:
        """A page that is open: the states that it is told."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE)
        connection.request("GET", f"/{self.token}/events")
        answer = connection.getresponse()
        told: queue.Queue[Any] = queue.Queue()

        def listen() -> None:
            try:
                for line in answer:
                    if line.startswith(b"data: "):
                        told.put(json.loads(line[6:]))
            except (OSError, http.client.HTTPException, ValueError, AttributeError):
                pass  # the connection was closed
            told.put(None)

        threading.Thread(target=listen, daemon=True).start()
        return told

    def end(self, number: int = signal.SIGINT) -> int:
        """Ask it to end; its exit status."""
        self.process.send_signal(number)
        return self.process.wait(PATIENCE)


def refuses_malformed(page: Running, body: bytes) -> None:
    """A malformed message is refused with the reason, and changes nothing."""
    number = page.state()["number"]
    reply = page.request("act", body)
    assert reply.status == 400
    assert reply.json["error"].startswith("malformed message: ")
    assert page.state()["number"] == number


def refuses_other_types_and_methods(page: Running) -> None:
    """A message is JSON, and is posted where messages go."""
    message = b'{"kind": "undo", "number": 0}'
    assert page.request("act", message, {"content-type": "text/plain"}).status == 415
    assert page.request("act").status == 404
    assert page.request("state", message).status == 404


def command(*words: str, name: str = "workbench") -> list[str]:
    """The words of a call."""
    return [sys.executable, "-P", "-m", "ravenchart.start", name, *words]


def environment() -> dict[str, str]:
    """Where the package is found."""
    return {**os.environ, "PYTHONPATH": str(ROOT)}


@contextmanager
def running(
    model: Path, *words: str, name: str = "workbench", installed: Path | None = None
) -> Iterator[Running]:
    """A page of a model for the time of a block, without a browser; that of the workbench.

    The program is that of the checkout, or the ``installed`` one.
    """
    told = (str(model), "--no-open", *words)
    call = [str(installed), name, *told] if installed else command(*told, name=name)
    process = subprocess.Popen(
        call, cwd=model.parent,
        env={**os.environ, "PYTHONPATH": ""} if installed else environment(),
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
    )  # fmt: skip
    assert process.stdout is not None
    lines = []
    found = None
    while found is None and (line := process.stdout.readline()):  # progress may come before
        lines.append(line)
        found = re.search(r"http://127\.0\.0\.1:(\d+)/([\w-]+)/$", line.strip())
    if found is None:
        process.kill()
        raise AssertionError("".join(lines))
    bench = Running(process, int(found[1]), found[2], lines)
    threading.Thread(target=lambda: lines.extend(process.stdout or ()), daemon=True).start()
    try:
        yield bench
    finally:
        if process.poll() is None:
            process.terminate()
            process.wait(PATIENCE)  # its streams end with it


def pieces(bench: Running) -> dict[str, bytes]:
    """What a browser loads for the page: its style and, one from the other, its modules."""
    found: dict[str, bytes] = {}
    wanted = re.findall(r'(?:src|href)="([\w.]+)"', bench.request("").body.decode())
    while wanted:
        name = wanted.pop()
        if name not in found:
            answer = bench.request(name)
            assert answer.status == 200, name
            found[name] = answer.body
            wanted += re.findall(r'^import .* from "\./([\w.]+)";', answer.body.decode(), re.M)
    return found


def until(told: queue.Queue[Any], number: int) -> Any:
    """The first state of a page with at least that number."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        state = told.get(timeout=PATIENCE)
        if state is None or state["number"] >= number:
            return state
    raise TimeoutError(f"no state {number}")
