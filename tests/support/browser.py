# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A local page in Chromium as Debian has it: what goes wrong in it, and how it reads aloud."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser, Page, expect, sync_playwright

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")

IN_BROWSER = [
    pytest.mark.clock,
    pytest.mark.slow,
    pytest.mark.skipif(
        CHROMIUM is None, reason="Chromium is missing: `scripts/setup.sh browser` installs it"
    ),
]
"""The marks of tests that need it."""

PATIENCE = 20_000
"""Milliseconds for what a page does on a busy machine."""

SERIOUS = ("serious", "critical")


@contextmanager
def launched() -> Iterator[Browser]:
    """Chromium without a screen, for the time of a block."""
    arguments = ["--no-sandbox"] if os.getuid() == 0 else []
    with sync_playwright() as started:
        found = started.chromium.launch(executable_path=CHROMIUM, args=arguments)
        yield found
        found.close()


class BrowserPage:
    """A page with a drawing, and what went wrong in it."""

    def __init__(self, browser: Browser, address: str, **look: Any) -> None:
        self.context = browser.new_context(**({"viewport": {"width": 1400, "height": 900}} | look))
        self.page: Page = self.context.new_page()
        self.page.set_default_timeout(PATIENCE)
        expect.set_options(timeout=PATIENCE)
        self.wrong: list[str] = []
        self.page.on("pageerror", lambda error: self.wrong.append(str(error)))
        self.page.on("console", lambda one: self._heard(one.type, one.text))
        self.asked: list[str] = []
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.page.goto(address)
        expect(self.page.locator(".paper svg")).to_be_visible()

    def _heard(self, kind: str, text: str) -> None:
        if kind == "error" and "status of 4" not in text:
            self.wrong.append(text)

    def closed(self, address: str) -> None:
        """Close it: nothing may have gone wrong, and nothing have been asked of elsewhere."""
        self.context.close()
        assert self.wrong == []
        assert [url for url in self.asked if not url.startswith((address, "data:"))] == []


def serious(page: Page) -> list[str]:
    """What axe finds of weight: the rule and the element."""
    answer = Axe().run(page).response
    return [
        f"{one['id']}: {node['html'][:200]} {node['failureSummary'][:200]}"
        for one in answer["violations"]
        if one["impact"] in SERIOUS
        for node in one["nodes"]
    ]
