# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The docs as their reader does them: each call of a page, in its order, in a copied example."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import signal
import socket
import subprocess
import threading
import time
import tty
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, closing, contextmanager, suppress
from dataclasses import dataclass
from itertools import count
from pathlib import Path

import pytest

from ravenchart.paths import ROOT
from ravenchart.running import server
from ravenchart.running.snapshots import VARIABLE
from tests.support import evidence, live
from tests.support.examples import becomes
from tests.support.listening import Listener
from tests.support.once import made_once
from tests.support.page_calls import (
    Call,
    How,
    Page,
    calls_of_pages,
    listed_text,
    prompted,
    session,
    table,
)
from tests.support.processes import LAUNCHER, Marked
from tests.support.progress import without_progress

pytestmark = [pytest.mark.slow, pytest.mark.live, pytest.mark.clock]

PATIENCE = 180.0
"""Seconds for one call with its builds on a busy machine."""
HELD_UP = re.compile(
    r"observed to take .*, above its bound|ran for longer than its WCET|the host held the bench up"
)
PAGES, _ = table()


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with copies of all examples and a few models, one of them with evidence."""
    return made_once(tmp_path_factory, "calls of the docs", _make_home)


SCENARIO = """\
scenario: The bench of the pump only listens
steps:
  - {{wait: {wait}}}
expect:
  - {{lost: ward.lost_out, at_most: 400, because: sent before the bench was on the bus}}
"""
"""For the pump, which has events alone."""


def _make_home(folder: Path) -> None:
    shutil.copytree(ROOT / "examples", folder / "examples")
    shutil.copytree(ROOT / "tests/feature/library", folder / "tests/feature/library")
    for name, wait in (("scenario", "1 s"), ("long", "300 s")):
        path = folder / "examples" / "pump" / f"{name}.yaml"
        path.write_text(SCENARIO.format(wait=wait), encoding="utf-8")
    evidence.write(folder / "valve")


@dataclass
class Said:
    """A call that has begun, in a folder, and where it prints."""

    process: Marked
    printed: Path
    errors: Path

    def text(self) -> str:
        """All that it has printed."""
        return self.printed.read_text("utf-8") + without_progress(self.errors.read_text("utf-8"))

    def interrupted(self) -> int:
        """Ctrl-C; the exit status."""
        with suppress(ProcessLookupError):
            self.process.process.send_signal(signal.SIGINT)
        return self.process.process.wait(PATIENCE)


@dataclass
class Reader:
    """The reader of a page, in a folder."""

    folder: Path
    notes: Path
    """A folder for what calls print."""
    number: Iterator[int]

    @contextmanager
    def started(
        self, words: list[str], inside: str = ".", given: str = "", into: str | None = None
    ) -> Iterator[Said]:
        """A call of `ravenchart`; at the end no process of it is left."""
        where = self.folder / inside
        name = str(next(self.number))
        printed = where / into if into else self.notes / f"{name}.out"
        errors, typed = self.notes / f"{name}.err", self.notes / f"{name}.in"
        typed.write_text(given, encoding="utf-8")
        names = {"PYTHONPATH": str(ROOT), "BROWSER": "true"}
        with typed.open() as source, printed.open("w") as out, errors.open("w") as wrong:
            process = Marked(
                [LAUNCHER, *words], where, given=source, printed=out, errors=wrong, names=names
            )
        try:
            yield Said(process, printed, errors)
        finally:
            if process.process.poll() is None:
                process.process.terminate()
                with suppress(subprocess.TimeoutExpired):
                    process.process.wait(10.0)
            left = {} if process.gone(10.0) else process.alive()
            process.kill()
            process.process.wait()
        assert left == {}

    def called(self, words: list[str], into: str | None = None) -> str:
        """What a call prints that succeeds."""
        for _ in range(live.TIMES):
            with self.started(words, into=into) as one:
                status = one.process.process.wait(PATIENCE)
            if not HELD_UP.search(one.text()):
                break
        assert status == 0, one.text()
        return one.text()

    @contextmanager
    def beside(self, text: str) -> Iterator[None]:
        """A run for the time of a block, whose controllers have snapshots."""
        words = shlex.split(text)
        with self.started(words) as one:

            def is_found() -> bool:
                assert one.process.process.poll() is None, one.text()
                with self.started(["monitor", words[1], "--once"]) as asked:
                    return asked.process.process.wait(PATIENCE) == 0

            assert becomes(is_found), one.text()
            yield
            assert one.interrupted() == 130, one.text()

    @contextmanager
    def program(self, path: str, file: str, bus: str) -> Iterator[None]:
        """A program that `build` has printed, with snapshots in a file."""
        names = {
            VARIABLE: str(self.folder / file),
            "RAVENCHART_BUS_PORT": bus.rpartition(":")[2],
            "RAVENCHART_BUS_NAME": Path(file).stem,
        }
        process = Marked([path], self.folder, printed=subprocess.DEVNULL, names=names)
        try:
            assert becomes((self.folder / file).exists)
            time.sleep(0.5)  # the first snapshot is written
            yield
        finally:
            process.process.terminate()
            process.process.communicate(timeout=PATIENCE)
            process.kill()


class Board(Listener):
    """A board that writes a trace, over and over: to a pseudo-terminal, and to a socket."""

    def __init__(self, trace: Path) -> None:
        super().__init__()
        self._trace = trace.read_bytes().replace(b"END\n", b"")
        self._end, self._inner = os.openpty()
        tty.setraw(self._inner)
        self.device = os.ttyname(self._inner)
        self._over = threading.Event()
        self._clients: list[socket.socket] = []
        self.listen()
        self._writer = threading.Thread(target=self._write)
        self._writer.start()

    def _links(self) -> list[socket.socket]:
        return self._clients

    def _serve(self, link: socket.socket) -> None:
        self._clients.append(link)

    def _write(self) -> None:
        os.set_blocking(self._end, False)
        while not self._over.wait(0.2):
            with suppress(BlockingIOError):  # nobody reads
                os.write(self._end, self._trace[:2048].rpartition(b"\n")[0] + b"\n")
            for link in self._clients:
                with suppress(OSError):
                    link.sendall(self._trace[:2048].rpartition(b"\n")[0] + b"\n")

    def close(self) -> None:
        """Unplug it."""
        self._over.set()
        self._writer.join()
        super().close()
        os.close(self._end)
        os.close(self._inner)


@pytest.fixture
def reader(request: pytest.FixtureRequest, home: Path, tmp_path: Path) -> Reader:
    """One with the files of the page."""
    name: str = request.param
    page = PAGES[name]
    folder = home / page.folder
    folder.mkdir(exist_ok=True)
    for file, words in page.listed.items():
        _write(folder / file, listed_text(name, words))
    for file, text in page.written.items():
        _write(folder / file, text)
    return Reader(folder, tmp_path, count())


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


EXECUTED = [
    name for name, page in PAGES.items() if not all(how.excused for how in page.calls.values())
]


@pytest.mark.parametrize(
    ("reader", "name"), [(one, one) for one in EXECUTED], indirect=["reader"], ids=EXECUTED
)
def test_the_calls_of_a_page_end_as_it_says(reader: Reader, name: str) -> None:
    page = PAGES[name]
    for file, text in page.before.items():
        if not (reader.folder / file).exists():  # another page may have made it
            words, _, into = text.partition(" > ")
            reader.called(shlex.split(words), into or None)
    for call in calls_of_pages():
        if call.page == name and call.text in page.calls:
            how = page.calls[call.text]
            if not how.excused:
                executed(reader, page, call, how)


def executed(reader: Reader, page: Page, call: Call, how: How) -> None:
    """One call, made real; where the host withheld the core, once more."""
    for _ in range(live.TIMES):
        status, text = ended(reader, page, call, how)
        if not (status == 1 and HELD_UP.search(text)):
            break
    wanted = [how.status] if isinstance(how.status, int) else how.status
    assert status in wanted, f"{call.page}: ravenchart {call.text}: status {status}\n{text}"
    assert re.search(how.says, text), text
    if how.shown:
        assert set(session(call)) <= set(text.splitlines()), text


def ended(reader: Reader, page: Page, call: Call, how: How) -> tuple[int, str]:
    """The exit status of a call, and what it has printed."""
    with ExitStack() as stack:
        named = {**how.words, **page.words}
        if how.beside:
            stack.enter_context(reader.beside(how.beside))
        if how.programs:
            model = real(call.words[1], named)
            paths = re.findall(r"^built (\S+)", reader.called(["build", model]), re.M)
            _, channel = stack.enter_context(server.running("port=0", "bitrate=500000"))
            for part, file in how.programs.items():
                (path,) = (one for one in paths if part in one)
                stack.enter_context(reader.program(path, file, channel))
        if how.line:
            board = stack.enter_context(closing(Board(reader.folder / how.line)))
            named |= {
                "/dev/ttyUSB1": board.device,
                "socket://127.0.0.1:4555": f"socket://{board.address}",
            }
        if "--coverage" in call.words:
            patch = stack.enter_context(pytest.MonkeyPatch.context())
            patch.delenv("GPR_CONFIG", raising=False)  # the store of objects keeps no counts
        words = [real(word, named) for word in call.words]
        given = prompted(call) if how.given == "listed" else how.given
        one = stack.enter_context(reader.started(words, how.inside, given, call.into))
        process = one.process.process
        if not how.until:
            return process.wait(PATIENCE), one.text()
        seen = becomes(lambda: process.poll() is not None or re.search(how.until, one.text()))
        assert seen and process.poll() is None, (call, one.text())
        return one.interrupted(), one.text()


def real(word: str, named: Mapping[str, str]) -> str:
    """What a word of a page stands for."""
    for name, value in named.items():
        word = word.replace(name, value)
    return word
