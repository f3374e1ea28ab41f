# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Who may talk to a local page: what its own address opened, and no other.

The address holds a random token. A page of another origin does not know it, and a name that
another server resolves to this machine (DNS rebinding) is not among the hosts. So both are
refused before anything is read of the request.
"""

from __future__ import annotations

import secrets
from collections.abc import Collection

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

TOKEN_BYTES = 24

LARGEST = 16 * 1024
"""Bytes of a message to the server at most."""

HEADERS = {
    "cache-control": "no-store",
    "content-security-policy": "default-src 'none'; script-src 'self'; style-src 'self'; "
    "img-src 'self' data:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "referrer-policy": "no-referrer",
    "x-content-type-options": "nosniff",
}
"""Of every answer: no content from elsewhere, no frame around it, and no referrer to others."""


def token() -> str:
    """A new token."""
    return secrets.token_urlsafe(TOKEN_BYTES)


class Guard:
    """Lets requests through whose host, origin, token and length are right; see above.

    The token is the first part of the path, and is taken off.
    """

    def __init__(self, app: ASGIApp, token: str, hosts: Collection[str]) -> None:
        """Before ``app``; ``hosts`` are names with port, as browsers send them."""
        self.app = app
        self.token = token.encode()
        self.hosts = frozenset(hosts)
        self.origins = frozenset(f"http://{host}" for host in hosts)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse it."""
        if scope["type"] != "http":
            return  # no WebSocket and no lifespan: the settings of the server exclude them
        refusal = self._refusal(scope)
        if refusal is not None:
            status, text = refusal
            await JSONResponse({"error": text}, status, HEADERS)(scope, receive, send)
            return

        async def with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message).update(HEADERS)
            await send(message)

        root = f"/{self.token.decode()}"
        inner = dict(scope) | {"root_path": root}
        await self.app(inner, receive, with_headers)

    def _refusal(self, scope: Scope) -> tuple[int, str] | None:
        """Why a request is refused: the status, and a text for people."""
        headers = Headers(scope=scope)
        if headers.getlist("host") not in [[host] for host in self.hosts]:
            return 421, "this host is not that of the page: open the address that was printed"
        if any(origin not in self.origins for origin in headers.getlist("origin")):
            return 403, "pages of other origins get no answer"
        if headers.get("sec-fetch-site", "none") not in ("none", "same-origin"):
            return 403, "pages of other sites get no answer"
        first = scope["path"].split("/", 2)[1] if scope["path"].startswith("/") else ""
        if not secrets.compare_digest(first.encode("utf-8", "replace"), self.token):
            return 403, "the token is wrong: open the address that was printed"
        length = headers.get("content-length", "0")
        if not length.isascii() or not length.isdigit() or int(length[:12]) > LARGEST:
            return 413, f"a message has at most {LARGEST} bytes"
        return None
