# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The server of the charts in motion: beside what every page has, the event file."""

from __future__ import annotations

import json
from typing import Any

from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from ravenchart.building import drawings

from ..pages import Pages, error
from ..publishing import Publisher
from ..requests import PageRequest
from . import requests
from .session import Play
from .view import arrows, view


class PlayHub(Publisher):
    """Publishes a play."""

    def __init__(self, play: Play) -> None:
        """For one play; to be made before the event loop runs."""
        self.play = play
        super().__init__(play)

    def _dumped(self) -> bytes:
        return json.dumps(view(self.play)).encode()

    def _do(self, wish: PageRequest) -> None:
        assert isinstance(wish, requests.PLAY_REQUESTS)
        self.play.do(wish)

    def _drawing(self, name: str) -> tuple[str, dict[str, Any]] | None:
        dot = None if name == drawings.STRUCTURE else drawings.text(self.play.system, name)
        return None if dot is None else (dot, {"arrows": arrows(self.play, name)})


class PlayPages(Pages):
    """The answers to what the page of the charts asks."""

    first = "play.html"

    def __init__(self, hub: PlayHub) -> None:
        """For one play."""
        super().__init__(hub)
        self.hub = hub

    def read(self, body: bytes) -> PageRequest:
        """The message of a request, or `MalformedError`."""
        return requests.read(body)

    def own_routes(self) -> list[Route]:
        """The event file, to be saved."""
        return [Route("/events.yaml", self.event_file)]

    async def event_file(self, request: Request) -> Response:
        """The event file of what was done."""
        text = json.loads(self.hub.state)["file"]
        if text is None:
            return error(404, "nothing was executed yet: there is no event file")
        headers = {"content-disposition": 'attachment; filename="events.yaml"'}
        return Response(text, media_type="application/yaml", headers=headers)
