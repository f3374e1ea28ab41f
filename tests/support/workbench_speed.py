# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""How long a change of a model of a hundred activities takes: its analysis, and until it is shown.

The aims are those of a person who moves rows about: the outcome is there at once.
"""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from pathlib import Path

from playwright.sync_api import Browser

from ravenchart.workbench.requests import Move, SetTime
from ravenchart.workbench.session import Session
from ravenchart.workbench.view import whole_view
from tests.support.browser import BrowserPage
from tests.support.workbench import running
from tests.support.workbench_models import hundred_activities

ANALYSED = 200.0
"""Milliseconds from the message of a page to the new state for all pages."""

SHOWN = 300.0
"""Milliseconds from the key to the frame of the page that shows another response."""

CHANGES = 10

CHANGE = """async (value) => {
  const field = document.querySelector(".declared .times .field:nth-child(2) input");
  const bound = () => document.querySelector('[data-processor="p20"] .response').textContent;
  const before = bound();
  field.focus();
  field.value = value;
  field.dispatchEvent(new Event("input", { bubbles: true }));
  const begin = performance.now();
  field.dispatchEvent(new KeyboardEvent("keydown", { key: "Enter", bubbles: true }));
  while (bound() === before) {
    if (performance.now() - begin > 20000) throw new Error(`with ${value} it is still ${before}`);
    await new Promise((resolve) => requestAnimationFrame(resolve));
  }
  return performance.now() - begin;
}"""
"""Types a WCET, and waits for the frame that shows another response; the ms between."""


def hundred(folder: Path) -> Path:
    """The model, written into a folder."""
    model = folder / "model.yaml"
    model.write_text(hundred_activities(), encoding="utf-8")
    return model


def analysed(session: Session) -> Iterator[float]:
    """The processor time of each change of that model, in ms: rows are moved, times are set."""
    for number in range(CHANGES):
        begin = time.process_time()
        if number % 2:
            row, place = "u3.act0", number % 7
            session.change(Move(kind="move", row=row, to="p10", place=place, number=0))
        else:
            value = f"{101 + number} us"
            session.change(SetTime(kind="time", row="u0.act0", key="wcet", value=value, number=0))
        json.dumps(whole_view(session))
        yield 1000 * (time.process_time() - begin)


def shown(browser: Browser, model: Path) -> list[float]:
    """The time until each change of that model is on a page, in ms."""
    with running(model) as bench:
        pane = BrowserPage(browser, bench.address)
        taken = [pane.page.evaluate(CHANGE, f"{101 + number} us") for number in range(CHANGES)]
        pane.closed(bench.address)
    return [float(each) for each in taken]
