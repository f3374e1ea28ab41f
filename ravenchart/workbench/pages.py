# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The common part of every page's server: files, the state as a stream, and messages."""

from __future__ import annotations

from collections.abc import AsyncIterator, Mapping
from importlib import resources

from starlette.applications import Starlette
from starlette.requests import ClientDisconnect, Request
from starlette.responses import JSONResponse, Response, StreamingResponse
from starlette.routing import Route
from starlette.types import ASGIApp

from ravenchart.failures import Failure

from .guard import LARGEST, Guard
from .publishing import OldError, Publisher, RefusedRequestError
from .requests import MalformedError, PageRequest

TYPES = {"html": "text/html", "js": "text/javascript", "css": "text/css", "svg": "image/svg+xml"}
MOST_PAGES = 16
"""Pages that show one session at once."""


def assets() -> Mapping[str, tuple[bytes, str]]:
    """The files of the pages by name, with their types: all that is served of the disk."""
    folder = resources.files("ravenchart.workbench").joinpath("assets")
    found = {}
    for file in folder.iterdir():
        kind = TYPES.get(file.name.rpartition(".")[2])
        if kind is not None:
            found[file.name] = (file.read_bytes(), kind)
    return found


class Pages:
    """The answers to what a page asks."""

    first: str
    """The file that is the page."""

    def __init__(self, publisher: Publisher) -> None:
        """For what a publisher publishes."""
        self.publisher = publisher
        self.assets = assets()
        self.pages = 0

    def read(self, body: bytes) -> PageRequest:
        """The message of a request, or `MalformedError`."""
        raise NotImplementedError

    def own_routes(self) -> list[Route]:
        """The routes beside those of every page."""
        raise NotImplementedError

    def guarded(self, token: str, port: int) -> ASGIApp:
        """The application that answers requests at a port of this machine."""
        return Guard(self.routed(), token, (f"127.0.0.1:{port}", f"localhost:{port}"))

    def routed(self) -> Starlette:
        """The routes, below the token that the guard has compared."""
        routes = [
            Route("/", self.page),
            Route("/state", self.state),
            Route("/events", self.events),
            Route("/drawing", self.drawing),
            Route("/act", self.act, methods=["POST"]),
            *self.own_routes(),
            Route("/{name}", self.asset),
        ]
        handlers = {Failure: _failed, 404: missing, 405: missing}
        return Starlette(routes=routes, exception_handlers=handlers)

    async def page(self, request: Request) -> Response:
        """The page itself."""
        content, kind = self.assets[self.first]
        return Response(content, media_type=kind)

    async def asset(self, request: Request) -> Response:
        """A file of the page."""
        found = self.assets.get(request.path_params["name"])
        return await missing(request) if found is None else Response(found[0], media_type=found[1])

    async def state(self, request: Request) -> Response:
        """The state now."""
        return Response(self.publisher.state, media_type="application/json")

    async def events(self, request: Request) -> Response:
        """Every state from now on, as server-sent events."""
        if self.pages >= MOST_PAGES:
            return refusal(503, f"{MOST_PAGES} pages are open already: close one")
        return StreamingResponse(self._stream(), media_type="text/event-stream")

    async def _stream(self) -> AsyncIterator[bytes]:
        self.pages += 1
        try:
            async for state in self.publisher.states():
                yield b"event: state\ndata: " + state + b"\n\n" if state else b": alive\n\n"
        finally:
            self.pages -= 1

    async def drawing(self, request: Request) -> Response:
        """A drawing."""
        asked = request.query_params
        found = await self.publisher.drawing(asked.get("name", ""), asked.get("mark"))
        return refusal(404, "the model has no such drawing") if not found else JSONResponse(found)

    async def act(self, request: Request) -> Response:
        """Do what a message asks for."""
        if request.headers.get("content-type", "").partition(";")[0] != "application/json":
            return refusal(415, "a message is JSON: content-type application/json")
        try:
            body = await _body(request)
            if body is None:
                return refusal(413, f"a message has at most {LARGEST} bytes")
            state = await self.publisher.act(self.read(body))
        except MalformedError as problem:
            return refusal(400, str(problem))
        except OldError as problem:
            return refusal(409, str(problem))
        except RefusedRequestError as problem:
            return refusal(422, str(problem), **problem.more())
        return Response(state, media_type="application/json")


async def _body(request: Request) -> bytes | None:
    """The body of a request; None of one that is too long, however it is sent."""
    body = b""
    try:
        async for part in request.stream():
            body += part
            if len(body) > LARGEST:
                return None
    except ClientDisconnect:
        return b""
    return body


async def missing(request: Request, problem: Exception | None = None) -> Response:
    """There is no such thing."""
    return refusal(404, "there is nothing of that name")


async def _failed(request: Request, problem: Exception) -> Response:
    """An outside program is missing or has failed."""
    return refusal(500, str(problem))


def refusal(status: int, text: str, **more: object) -> Response:
    """An answer that refuses."""
    return JSONResponse({"error": text} | more, status)
