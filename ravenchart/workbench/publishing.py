# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A session between the pages that show it: one thread changes it, and all pages see it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Coroutine
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Protocol, TypeVar

from ravenchart.building import drawings
from ravenchart.gen.draw.svg import mark

from .requests import PageRequest

T = TypeVar("T")

BEAT = 15.0
"""Seconds after which a page gets a sign that the server lives."""

MOST_DRAWINGS = 100
"""Drawings that are kept."""

OLD = "the page shows an earlier state: look at the state now, then repeat the request"


class OldError(Exception):
    """Something was asked for of a state that is no longer shown."""

    def __init__(self) -> None:
        super().__init__(OLD)


class RefusedRequestError(Exception):
    """A request of a page cannot be carried out; the text says why, and what to do."""

    def more(self) -> dict[str, Any]:
        """The further facts that the page gets beside the text."""
        return {}


class Numbered(Protocol):
    """A session whose states are numbered."""

    @property
    def number(self) -> int:
        """Of the state that is shown: counts everything that people can see change."""
        ...


class Publisher:
    """Carries out the requests of pages one after the other; all pages get the new state."""

    def __init__(self, session: Numbered) -> None:
        """To be made before the event loop runs."""
        self._numbered = session
        self._thread = ThreadPoolExecutor(1, "session")
        self._artist = ThreadPoolExecutor(1, "drawings")
        self._drawn: dict[str, str] = {}
        self._news = asyncio.Condition()
        self._version = 0
        self._closing = False
        self._tasks: set[asyncio.Task[None]] = set()
        self.state = self._dumped()

    # --- Defined for each kind of session

    def _dumped(self) -> bytes:
        """The state as JSON."""
        raise NotImplementedError

    def _do(self, wish: PageRequest) -> None:
        """Do what a message asks for of the state that is shown; `RefusedRequestError`."""
        raise NotImplementedError

    def _drawing(self, name: str) -> tuple[str, dict[str, Any]] | None:
        """The DOT text of a drawing, and what the page gets beside it; None: no such."""
        raise NotImplementedError

    # --- The life of it

    def start(self) -> None:
        """Begin with what goes on by itself."""

    async def close(self) -> None:
        """End all pages' streams."""
        self._closing = True
        for task in self._tasks:
            task.cancel()
        async with self._news:
            self._news.notify_all()

    def shut(self) -> None:
        """Wait for what the threads are doing."""
        self._thread.shutdown(cancel_futures=True)
        self._artist.shutdown(cancel_futures=True)

    def _spawn(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _run(self, act: Callable[[], T]) -> T:
        return await asyncio.get_running_loop().run_in_executor(self._thread, act)

    # --- Changes

    async def act(self, wish: PageRequest) -> bytes:
        """Do what a message asks for; the state after it. `RefusedRequestError`, `OldError`."""
        number = self._numbered.number
        try:
            state = await self._run(lambda: self._acted(wish))
        except RefusedRequestError:
            if self._numbered.number != number:  # something else was found to have changed
                await self._publish(await self._run(self._dumped))
            raise
        await self._publish(state)
        return state

    def _acted(self, wish: PageRequest) -> bytes:
        if wish.number != self._numbered.number:
            raise OldError
        self._do(wish)
        return self._dumped()

    async def _publish(self, state: bytes) -> None:
        """Show a state to all pages."""
        if state == self.state:
            return
        self.state = state
        self._version += 1
        async with self._news:
            self._news.notify_all()
        self._published()

    def _published(self) -> None:
        """All pages see another state."""

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

    async def drawing(self, name: str, known: str | None) -> dict[str, Any] | None:
        """A drawing with what it shows; without ``svg`` where the page has it. None: no such."""
        made = await self._run(lambda: self._drawing(name))
        if made is None:
            return None
        dot, beside = made
        told: dict[str, Any] = {"mark": mark(dot)} | beside
        if told["mark"] == known:
            return told
        loop = asyncio.get_running_loop()
        return told | {"svg": await loop.run_in_executor(self._artist, lambda: self._svg(dot))}

    def _svg(self, dot: str) -> str:
        """The drawing that Graphviz makes of a text; the last drawings are kept."""
        found = self._drawn.pop(dot, None) or drawings.svg(dot)
        self._drawn[dot] = found
        if len(self._drawn) > MOST_DRAWINGS:
            del self._drawn[next(iter(self._drawn))]
        return found
