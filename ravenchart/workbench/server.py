"""The server of the workbench: a page, the state as a stream, and messages that change it."""

from __future__ import annotations

from collections.abc import AsyncIterator
from dataclasses import asdict
from importlib import resources

from starlette.applications import Starlette
from starlette.requests import ClientDisconnect, Request
from starlette.responses import JSONResponse, Response, StreamingResponse
from starlette.routing import Route
from starlette.types import ASGIApp

from ravenchart.failures import Failure
from ravenchart.reported import found_of

from . import requests
from .changes import ChangeRefusedError
from .guard import LARGEST, Guard
from .hub import Hub, OldError
from .session import InvalidError
from .view import source

TYPES = {"html": "text/html", "js": "text/javascript", "css": "text/css", "svg": "image/svg+xml"}
PAGE = "page.html"
MOST_PAGES = 16
"""Pages that show one session at once."""


def application(hub: Hub, token: str, port: int) -> ASGIApp:
    """What answers to requests at a port of this machine."""
    app = _Application(hub)
    hosts = (f"127.0.0.1:{port}", f"localhost:{port}")
    return Guard(app.routed(), token, hosts)


def assets() -> dict[str, tuple[bytes, str]]:
    """The files of the page by name, with their types: all that is served of the disk."""
    folder = resources.files("ravenchart.workbench").joinpath("assets")
    found = {}
    for file in folder.iterdir():
        kind = TYPES.get(file.name.rpartition(".")[2])
        if kind is not None:
            found[file.name] = (file.read_bytes(), kind)
    return found


class _Application:
    """The answers to what a page asks."""

    def __init__(self, hub: Hub) -> None:
        self.hub = hub
        self.assets = assets()
        self.pages = 0

    def routed(self) -> Starlette:
        """The routes, below the token that the guard has compared."""
        routes = [
            Route("/", self.page),
            Route("/state", self.state),
            Route("/events", self.events),
            Route("/diff", self.diff),
            Route("/source", self.source),
            Route("/growth", self.growth),
            Route("/drawing", self.drawing),
            Route("/act", self.act, methods=["POST"]),
            Route("/{name}", self.asset),
        ]
        return Starlette(
            routes=routes,
            exception_handlers={Failure: _failed, 404: _missing, 405: _missing},
        )

    async def page(self, request: Request) -> Response:
        """The page itself."""
        content, kind = self.assets[PAGE]
        return Response(content, media_type=kind)

    async def asset(self, request: Request) -> Response:
        """A file of the page."""
        found = self.assets.get(request.path_params["name"])
        return await _missing(request) if found is None else Response(found[0], media_type=found[1])

    async def state(self, request: Request) -> Response:
        """The state now."""
        return Response(self.hub.state, media_type="application/json")

    async def events(self, request: Request) -> Response:
        """Every state from now on, as server-sent events."""
        if self.pages >= MOST_PAGES:
            return _error(503, f"{MOST_PAGES} pages are open already: close one")
        return StreamingResponse(self._stream(), media_type="text/event-stream")

    async def _stream(self) -> AsyncIterator[bytes]:
        self.pages += 1
        try:
            async for state in self.hub.states():
                yield b"event: state\ndata: " + state + b"\n\n" if state else b": alive\n\n"
        finally:
            self.pages -= 1

    async def diff(self, request: Request) -> Response:
        """What a save would change."""
        found = await self.hub.ask(lambda session: (session.number, session.diff()))
        return JSONResponse({"number": found[0], "diff": found[1]})

    async def source(self, request: Request) -> Response:
        """The text of a file of the model."""
        file = request.query_params.get("file", "")
        found = await self.hub.ask(lambda session: source(session, file))
        return _error(404, "the model has no such file") if found is None else JSONResponse(found)

    async def growth(self, request: Request) -> Response:
        """How far the WCET of a row may grow."""
        found = await self.hub.growth(request.query_params.get("row", ""))
        return _error(409, "a later question took its place") if not found else JSONResponse(found)

    async def drawing(self, request: Request) -> Response:
        """A drawing."""
        asked = request.query_params
        found = await self.hub.drawing(asked.get("name", ""), asked.get("mark"))
        return _error(404, "the model has no such drawing") if not found else JSONResponse(found)

    async def act(self, request: Request) -> Response:
        """Do what a message asks for."""
        if request.headers.get("content-type", "").partition(";")[0] != "application/json":
            return _error(415, "a message is JSON: content-type application/json")
        try:
            body = await _body(request)
            if body is None:
                return _error(413, f"a message has at most {LARGEST} bytes")
            state = await self.hub.act(requests.read(body))
        except requests.MalformedError as problem:
            return _error(400, str(problem))
        except OldError as problem:
            return _error(409, str(problem))
        except InvalidError as problem:
            found = [asdict(found_of(one)) for one in problem.found]
            return _error(422, str(problem), findings=found, late=problem.late)
        except ChangeRefusedError as problem:
            return _error(422, str(problem))
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


async def _missing(request: Request, problem: Exception | None = None) -> Response:
    return _error(404, "the workbench has nothing there")


async def _failed(request: Request, problem: Exception) -> Response:
    """An outside program is missing or has failed."""
    return _error(500, str(problem))


def _error(status: int, text: str, **more: object) -> Response:
    return JSONResponse({"error": text} | more, status)
