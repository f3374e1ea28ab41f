# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The server of the workbench: beside what every page has, diffs, sources and how far to grow."""

from __future__ import annotations

import asyncio

from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route

from . import requests
from .hub import Hub
from .pages import Pages, refusal
from .view import source_text


class WorkbenchPages(Pages):
    """The answers to what the page of the workbench asks."""

    first = "page.html"

    def __init__(self, hub: Hub) -> None:
        """For one session."""
        super().__init__(hub)
        self.hub = hub

    def read(self, body: bytes) -> requests.PageRequest:
        """The message of a request, or `MalformedError`."""
        return requests.read(body)

    def own_routes(self) -> list[Route]:
        """The routes of the workbench beside those of every page."""
        return [
            Route("/diff", self.diff),
            Route("/source", self.source),
            Route("/growth", self.growth),
            Route("/live", self.live),
        ]

    async def live(self, request: Request) -> Response:
        """The controllers of the saved model that run now, or those of the replay.

        A look does not wait for the thread of the session, which may save for seconds.
        """
        digest = self.hub.session.saved_digest
        return JSONResponse(await asyncio.to_thread(self.hub.live.look, digest))

    async def diff(self, request: Request) -> Response:
        """The changes that a save would make."""
        found = await self.hub.ask(lambda session: (session.number, session.diff()))
        return JSONResponse({"number": found[0], "diff": found[1]})

    async def source(self, request: Request) -> Response:
        """The text of a file of the model."""
        file = request.query_params.get("file", "")
        found = await self.hub.ask(lambda session: source_text(session, file))
        return refusal(404, "the model has no such file") if found is None else JSONResponse(found)

    async def growth(self, request: Request) -> Response:
        """How far the WCET of a row may grow."""
        found = await self.hub.growth(request.query_params.get("row", ""))
        return refusal(409, "a later question took its place") if not found else JSONResponse(found)
