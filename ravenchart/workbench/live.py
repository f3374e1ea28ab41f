# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The running controllers of the model and its bus, as `ravenchart monitor` shows them."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path
from threading import Lock
from typing import Any

from ravenchart.building import checking
from ravenchart.building.checking import Checked
from ravenchart.failures import Failure, said_of
from ravenchart.running import monitoring
from ravenchart.running.monitor_text import overlooked_in_words
from ravenchart.running.watched import WatchedController

from .live_buses import PAUSE, LiveBuses
from .motion import LastValues, shown_node


class LiveView:
    """The controllers and the bus as pages see them; any thread may look."""

    def __init__(
        self,
        path: Path,
        buses: tuple[str, Sequence[str]] | None = None,
        files: Sequence[str] = (),
    ) -> None:
        """For the model at ``path``; ``buses`` are an interface of python-can and its channels.

        ``files``: as of `monitoring.given`, in place of the controllers that are found. The serial
        lines of boards are among them.
        """
        self._path = path
        self._given = files
        self._buses = LiveBuses(buses)
        self._next_look = 0.0
        self._text = ""
        self._other = ""
        """The message about a program of another model, while no other program is seen."""
        self._lock = Lock()
        self._checked: Checked | None = None
        self._digest: str | None = None
        self._stack = ExitStack()
        self._watched: list[WatchedController] = []
        self._values: list[LastValues] = []

    def begin(self, digest: str) -> None:
        """Watch the controllers of the saved model, as `monitoring.watching` does."""
        with self._lock:
            self._attach(digest)

    def look(self, digest: str | None) -> dict[str, Any]:
        """The nodes and the bus as they are now; ``text`` says why there is none, or no other.

        ``digest`` is that of the saved model, None where it has errors.
        """
        with self._lock:
            text = ""
            try:
                for one in self._watched:
                    one.look()
            except Failure as problem:  # it is another program now: watched until it is ours again
                self._watched, self._values, self._next_look = [], [], 0.0
                self._stack.close()
                self._other = _without_prefix(problem)
            if digest is None:
                text = "The saved model has errors: its controllers are not looked for."
            elif all(one.node.process is None for one in self._watched) or digest != self._digest:
                text = self._found(digest)
            if any(one.sequence for one in self._watched):
                self._other = ""
            if self._checked is not None:
                runs = any(one.node.process is not None for one in self._watched)
                self._buses.join(self._checked, runs=runs, rings=not self._given)
            text = " ".join(part for part in (text or self._other, self._buses.text) if part)
            return {"text": text, "nodes": list(self._nodes()), "buses": self._buses.look()}

    def close(self) -> None:
        """Leave controllers and bus."""
        with self._lock:
            self._leave()

    def _leave(self) -> None:
        self._watched, self._values = [], []
        self._stack.close()
        self._buses.close()

    def _nodes(self) -> Iterator[dict[str, Any]]:
        for number, one in enumerate(self._watched):
            assert self._checked is not None
            system = self._checked.system
            if self._values[number].start != one.start:
                self._values[number] = LastValues(system, one.start)
            lines = self._values[number].look(one.node)
            one.add_responses()
            yield shown_node(system, one.node, one.last, lines) | {
                "age": one.age,
                "overlooked": overlooked_in_words(one.overlooked),
            }

    def _found(self, digest: str) -> str:
        """As `_attach`, or why that fails.

        Beside a bus, at which pages look all the time, it is not done more often.
        """
        now = time.monotonic()
        if not self._buses.are_seen or digest != self._digest or now >= self._next_look:
            self._next_look = now + PAUSE
            try:
                self._text = self._attach(digest)
            except Failure as problem:
                self._text = _without_prefix(problem)
            except OSError as problem:
                self._text = said_of(problem)
        return self._text

    def _attach(self, digest: str) -> str:
        """Watch what runs now, in place of what has ended; why there is nothing to watch."""
        if self._checked is None or digest != self._digest:
            self._checked, self._digest = None, digest
            self._leave()
            self._checked = checking.check(self._path, deadlines=False)
        if self._given:
            files = monitoring.given(self._checked, self._given)
        else:
            files = monitoring.found(self._checked, lambda text: None)
        if not files:
            text = monitoring.none_runs(self._checked)
            return f"{text[0].upper()}{text[1:]}."
        with ExitStack() as made:
            watched = made.enter_context(monitoring.watching(self._checked, files))
            self._stack.close()
            self._stack, self._watched = made.pop_all(), watched
            self._values = [LastValues(self._checked.system, one.start) for one in watched]
        return ""


def _without_prefix(problem: Failure) -> str:
    return str(problem).removeprefix("ravenchart: error: ")
