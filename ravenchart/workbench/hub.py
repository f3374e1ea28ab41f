"""The session between the pages that show it: one thread changes it, and all pages see it."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

from ravenchart.building import drawings
from ravenchart.gen.draw.svg import mark

from .aside import Aside
from .changes import ChangeRefusedError
from .evaluation import Evaluation
from .requests import Move, PageRequest, Rewind, Save, SetProcessor, SetTime, Settle
from .session import Session
from .view import located, view

T = TypeVar("T")

POLL = 0.5
"""Seconds between two looks at the files."""

PAUSE = 0.4
"""Seconds without a change after which advice is looked for."""

BEAT = 15.0
"""Seconds after which a page hears that the server lives."""

OLD = "the model has changed meanwhile: look at the state now, then repeat the change"


class OldError(Exception):
    """A change was asked for of a state that is no longer shown."""

    def __init__(self) -> None:
        super().__init__(OLD)


class Hub:
    """What pages ask goes to the session one after the other, and comes back to all of them."""

    def __init__(self, session: Session) -> None:
        """For one session; to be made before the event loop runs."""
        self.session = session
        self._thread = ThreadPoolExecutor(1, "session")
        self._artist = ThreadPoolExecutor(1, "drawings")
        self._advice, self._growth = Aside(), Aside()
        self._drawn: dict[str, str] = {}
        self._room: tuple[int, list[str]] = (-1, [])
        self.state = self._dumped()
        self._news = asyncio.Condition()
        self._version = 0
        self._closing = False
        self._tasks: set[asyncio.Task[None]] = set()

    # --- The life of it

    def start(self) -> None:
        """Begin to look at the files, and for advice."""
        self._spawn(self._watch())
        self._spawn(self._advise(self.session.number))

    async def close(self) -> None:
        """End all pages' streams, and the processes aside."""
        self._closing = True
        for task in self._tasks:
            task.cancel()
        async with self._news:
            self._news.notify_all()
        self._advice.stop()
        self._growth.stop()

    def shut(self) -> None:
        """Wait for what the threads are doing."""
        self._thread.shutdown(cancel_futures=True)
        self._artist.shutdown(cancel_futures=True)

    def _spawn(self, work: Any) -> None:
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def ask(self, about: Callable[[Session], T]) -> T:
        """What a function finds in the session, while no change is under way."""
        return await self._run(lambda: about(self.session))

    async def _run(self, act: Callable[[], T]) -> T:
        return await asyncio.get_running_loop().run_in_executor(self._thread, act)

    # --- Changes

    async def act(self, wish: PageRequest) -> bytes:
        """Do what a message asks for; the state after it. `ChangeRefusedError`, `OldError`."""
        number = self.session.number
        try:
            state = await self._run(lambda: self._acted(wish))
        except ChangeRefusedError:
            if self.session.number != number:  # a file was found to have changed outside
                await self._publish(await self._run(self._dumped))
            raise
        await self._publish(state)
        return state

    def _acted(self, wish: PageRequest) -> bytes:
        if wish.number != self.session.number:
            raise OldError
        match wish:
            case Move() | SetTime() | SetProcessor():
                self.session.change(wish)
            case Rewind(kind=kind):
                self.session.step(-1 if kind == "undo" else 1)
            case Save(late=late):
                self.session.save(late=late)
            case Settle(kind=kind):
                self.session.take() if kind == "take" else self.session.keep()
        return self._dumped()

    def _dumped(self) -> bytes:
        number, lines = self._room
        room = lines if number == self.session.number else None
        return json.dumps(view(self.session) | {"room": room}).encode()

    async def _publish(self, state: bytes) -> None:
        """Show a state to all pages, and look for advice on it."""
        if state == self.state:
            return
        self.state = state
        self._version += 1
        async with self._news:
            self._news.notify_all()
        self._spawn(self._advise(self.session.number))

    # --- What the pages hear

    async def states(self) -> AsyncIterator[bytes]:
        """Every state from now on, the newest where there were several; b"" for a beat."""
        seen = -1
        while not self._closing:
            if seen != self._version:
                seen = self._version
                yield self.state
                continue
            if not await self._heard(seen):
                yield b""

    async def _heard(self, seen: int) -> bool:
        """Wait for a version after that one, or the end; False after a beat without."""
        try:
            async with asyncio.timeout(BEAT), self._news:
                await self._news.wait_for(lambda: self._closing or self._version != seen)
        except TimeoutError:
            return False
        return True

    async def _watch(self) -> None:
        """Look at the files, and show what has changed outside."""
        while True:
            await asyncio.sleep(POLL)
            if await self._run(self.session.look):
                await self._publish(await self._run(self._dumped))

    async def _advise(self, number: int) -> None:
        """Find the advice on a state, once it has stood for a while, and show it."""
        await asyncio.sleep(PAUSE)
        session = self.session
        if number != session.number or self._room[0] == number or session.now.analysis is None:
            return
        answer = await self._advice.ask(session.path, session.now.texts)
        if answer and number == session.number:
            self._room = number, answer["lines"]
            await self._publish(await self._run(self._dumped))

    async def growth(self, row: str) -> dict[str, Any] | None:
        """How far the WCET of a row may grow, with those that share it; None: asked too late."""
        texts, rows = await self.ask(lambda session: (session.now.texts, _alike(session.now, row)))
        if not rows:
            return {"wcet": None, "text": "not known while the model has errors"}
        return await self._growth.ask(self.session.path, texts, rows=rows)

    async def drawing(self, name: str, known: str | None) -> dict[str, Any] | None:
        """A drawing with what it shows; without ``svg`` where the page has it. None: no such."""
        made = await self._run(lambda: self._dot(name))
        if made is None:
            return None
        dot, places = made
        told: dict[str, Any] = {"mark": mark(dot), "places": places}
        if told["mark"] == known:
            return told
        loop = asyncio.get_running_loop()
        return told | {"svg": await loop.run_in_executor(self._artist, lambda: self._svg(dot))}

    def _dot(self, name: str) -> tuple[str, list[dict[str, Any]]] | None:
        analysis = self.session.good.analysis
        dot = None if analysis is None else drawings.text(analysis.system, name)
        return None if dot is None else (dot, located(self.session, name))

    def _svg(self, dot: str) -> str:
        """What Graphviz makes of it; the last hundred drawings are kept."""
        found = self._drawn.pop(dot, None) or drawings.svg(dot)
        self._drawn[dot] = found
        if len(self._drawn) > 100:
            del self._drawn[next(iter(self._drawn))]
        return found


def _alike(now: Evaluation, row: str) -> list[str]:
    """The rows of all tables whose WCET is declared where that of ``row`` is."""
    declared = now.places.row(row)
    if declared is None or now.analysis is None:
        return []
    elements = [slot.element for slot in now.analysis.system.slots]
    mine = declared.entry.key
    return [e for e in elements if (one := now.places.row(e)) and one.entry.key is mine]
