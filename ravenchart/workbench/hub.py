# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The session of a model between the pages that show it, with the advice on it."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable
from typing import Any, TypeVar

from ravenchart.building import drawings
from ravenchart.editing.evaluation import Evaluation

from . import pictures
from .aside import Aside
from .changes import ChangeRefusedError
from .live import LiveView
from .publishing import Publisher
from .replay import ReplayView
from .requests import (
    Move,
    PageRequest,
    PlayOrPause,
    Rewind,
    Save,
    SearchTables,
    Seek,
    SetProcessor,
    SetSpeed,
    SetTime,
    Settle,
    StepTo,
    TakeTables,
)
from .searching import Search
from .session import Session
from .view import located, whole_view

T = TypeVar("T")

POLL = 0.5
"""Seconds between two looks at the files."""

PAUSE = 0.4
"""Seconds without a change after which advice is looked for."""


class Hub(Publisher):
    """Publishes a session, looks at its files; processes aside find advice and tables."""

    def __init__(
        self,
        session: Session,
        live: LiveView | ReplayView,
        scheduler: str | None = None,
    ) -> None:
        """For one session; to be made before the event loop runs.

        ``live`` is closed with it. ``scheduler``: the address of a Dask scheduler whose workers
        rank tables.
        """
        self._scheduler = scheduler
        self.session = session
        self.live = live
        self.replay = live if isinstance(live, ReplayView) else None
        self._room: tuple[int, list[str]] = (-1, [])
        self._search: Search | None = None
        super().__init__(session)
        self._advice, self._growth = Aside(), Aside()
        self._tables: Aside | None = None

    # --- The life of it

    def start(self) -> None:
        """Begin to look at the files, and for advice."""
        self._spawn(self._watch())
        self._spawn(self._advise(self.session.number))

    async def close(self) -> None:
        """End all pages' streams, and the processes aside; leave the bus."""
        await super().close()
        if isinstance(self.live, LiveView):
            await asyncio.to_thread(self.live.close)
        self._advice.stop()
        self._growth.stop()
        if self._tables is not None:
            self._tables.stop()

    async def ask(self, about: Callable[[Session], T]) -> T:
        """The result of a function of the session, while no change is under way."""
        return await self._run(lambda: about(self.session))

    # --- Changes

    def _do(self, wish: PageRequest) -> None:
        match wish:
            case Move() | SetTime() | SetProcessor():
                self.session.change(wish)
            case Rewind(kind=kind):
                self.session.step(-1 if kind == "undo" else 1)
            case Save(late=late):
                self.session.save(late=late)
            case Settle(kind=kind):
                self.session.take() if kind == "take" else self.session.keep()
            case SearchTables(strategy=strategy):
                if self.session.now.analysis is None:
                    raise ChangeRefusedError("the model has errors: correct them, then search")
                self._search = Search(strategy, self.session.now.texts)
            case TakeTables(kind=kind):
                if self._search is None:
                    raise ChangeRefusedError("no search has been started")
                if kind == "adopt":
                    self._search.adopt(self.session)
                    self._search = None
            case PlayOrPause() | SetSpeed() | Seek() | StepTo():
                if self.replay is None:
                    raise ChangeRefusedError("nothing is replayed: start with --replay FILE")
                self.replay.do(wish)

    async def act(self, wish: PageRequest) -> bytes:
        """Do what a message asks for; what a search does goes on by itself."""
        state = await super().act(wish)
        match wish:
            case SearchTables() if self._search is not None:
                self._spawn(self._seek(self._search))
            case TakeTables():
                if self._tables is not None:
                    self._tables.stop()
        return state

    def _dumped(self) -> bytes:
        number, lines = self._room
        room = lines if number == self.session.number else None
        search = None if self._search is None else self._search.told(self.session)
        more = {"room": room, "search": search, "replay": self.replay is not None}
        return json.dumps(whole_view(self.session) | more).encode()

    def _published(self) -> None:
        """Look for advice on the state that is shown now."""
        self._spawn(self._advise(self.session.number))

    # --- What goes on by itself

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

    async def _seek(self, search: Search) -> None:
        """Follow a search to its end, and show the best so far."""
        self._tables = self._tables or Aside()
        more = {"strategy": search.strategy, "scheduler": self._scheduler}
        async for best in self._tables.answers(self.session.path, search.texts, **more):
            search.fault = best.pop("fault", None)
            search.best = best or (search.best if search.fault else None)
            await self._publish(await self._run(self._dumped))
        search.running = False
        await self._publish(await self._run(self._dumped))

    async def growth(self, row: str) -> dict[str, Any] | None:
        """How far the WCET of a row may grow, with those that share it; None: asked too late."""
        texts, rows = await self.ask(lambda session: (session.now.texts, _alike(session.now, row)))
        if not rows:
            return {"wcet": None, "text": "not known while the model has errors"}
        return await self._growth.ask(self.session.path, texts, rows=rows)

    def _drawing(self, name: str) -> tuple[str, dict[str, Any]] | None:
        analysis = self.session.good.analysis
        dot = None if analysis is None else drawings.text(analysis.system, name)
        if analysis is None or dot is None:
            return None
        chart = drawings.charts(analysis.system).get(name)
        arrows = {} if chart is None else pictures.arrows(chart[1])
        return dot, {"places": located(self.session, name), "arrows": arrows}


def _alike(now: Evaluation, row: str) -> list[str]:
    """The rows of all tables whose WCET is declared where that of ``row`` is."""
    declared = now.places.row(row)
    if declared is None or now.analysis is None:
        return []
    elements = [slot.element for slot in now.analysis.system.slots]
    mine = declared.entry.key
    return [e for e in elements if (one := now.places.row(e)) and one.entry.key is mine]
