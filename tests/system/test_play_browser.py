# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Charts in motion in a real browser: by pointer, by keyboard, and read aloud."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect

from ravenchart.paths import ROOT
from tests.support.browser import IN_BROWSER, BrowserPage, launched, serious
from tests.support.workbench import Running, command, environment, running

pytestmark = IN_BROWSER

PUMP = ROOT / "examples" / "pump" / "model.yaml"


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """One for all tests of this file."""
    with launched() as found:
        yield found


@pytest.fixture
def served() -> Iterator[Running]:
    """The page of the pump."""
    with running(PUMP, name="simulate") as found:
        yield found


@pytest.fixture
def shown(browser: Browser, served: Running) -> Iterator[BrowserPage]:
    """It in a browser; nothing may go wrong in it, and nothing may be asked of elsewhere."""
    found = BrowserPage(browser, served.address)
    yield found
    found.closed(served.address)


def active(shown: BrowserPage) -> list[str]:
    """The groups that the drawing highlights."""
    titles = shown.page.locator(".paper g.active > title").all_text_contents()
    return sorted(one.removeprefix("cluster ") for one in titles)


def test_states_and_transitions_are_highlighted_and_the_reasons_said(shown: BrowserPage) -> None:
    page = shown.page
    assert active(shown) == []
    page.get_by_role("button", name="One execution").click()
    expect(page.locator(".paper g.cluster.active")).to_have_count(1)
    assert active(shown) == ["Listening", "Self_Test", "Turning"]
    page.get_by_role("button", name="One execution").click()
    reasons = page.get_by_role("tabpanel")
    expect(reasons.locator("tr", has_text="again")).to_contain_text(
        "not yet due: 4950 ms left (99 executions)"
    )
    expect(reasons.locator("tr", has_text="heard")).to_contain_text(
        "its condition `fresh(line)` is false: fresh(line) = false"
    )
    page.get_by_role("button", name="Put line").click()
    expect(page.get_by_text("1 waiting for the release")).to_be_visible()
    page.get_by_role("button", name="Until it fires").click()
    expect(reasons.locator("tr.fired")).to_contain_text("heard")
    expect(page.locator(".paper text.taken")).to_have_text("when fresh(line)\u00a0\u00a0")
    expect(page.locator(".paper g.edge.taken")).to_have_count(2)
    assert "Sensor_Good" in active(shown)


def test_all_is_done_by_keys(shown: BrowserPage) -> None:
    page = shown.page
    clock = page.locator(".clock")
    page.keyboard.press("F8")
    expect(clock).to_have_text("executed up to 0.000 s")
    page.keyboard.press("Shift+F9")
    expect(clock).to_have_text("executed up to 5.000 s")
    page.keyboard.press("F9")
    expect(clock).to_have_text("executed up to 5.050 s")
    page.keyboard.press("Control+z")
    expect(clock).to_have_text("executed up to 5.000 s")
    page.keyboard.press("Control+Shift+z")
    expect(clock).to_have_text("executed up to 5.050 s")
    page.get_by_label("Duration").fill("2 s")
    page.get_by_label("Duration").press("Enter")
    expect(clock).to_have_text("executed up to 7.050 s")
    page.get_by_label("panel amount").fill("12")
    page.get_by_label("panel amount").press("Enter")
    expect(page.get_by_text("1 waiting for the release")).to_be_visible()


def test_arrow_keys_go_from_tab_to_tab_and_around(shown: BrowserPage) -> None:
    page = shown.page
    page.get_by_role("tab", name="Last execution").focus()
    for key, tab in (("ArrowRight", "Trace"), ("ArrowLeft", "Last execution"),
                     ("ArrowLeft", "Event file"), ("ArrowRight", "Last execution")):  # fmt: skip
        page.keyboard.press(key)
        expect(page.get_by_role("tab", name=tab)).to_be_focused()
        expect(page.get_by_role("tab", name=tab)).to_have_attribute("aria-selected", "true")


def test_what_is_refused_is_said_beside_the_field(shown: BrowserPage) -> None:
    page = shown.page
    page.get_by_label("panel amount").fill("many")
    page.get_by_role("button", name="Put panel").click()
    expect(page.get_by_role("form", name="Put panel").get_by_role("alert")).to_have_text(
        "a value of type Volume is 0 .. 1000000"
    )
    page.get_by_label("Duration").fill("soon")
    page.get_by_role("button", name="Wait").click()
    expect(page.get_by_role("alert").first).to_contain_text("`soon` is not a duration")


def test_another_chart_is_chosen(shown: BrowserPage) -> None:
    page = shown.page
    page.keyboard.press("F8")
    page.locator(".drawing select").select_option("bed.Keys")
    expect(page.locator("#situation-title")).to_have_text("bed.Keys")
    expect(page.locator(".paper g.node.active")).to_have_count(1)
    expect(page.locator(".paper title").first).to_have_text("Pump.Keys")


def test_the_event_file_is_saved_and_replayed(shown: BrowserPage, tmp_path: Path) -> None:
    page = shown.page
    page.keyboard.press("F8")
    page.get_by_role("button", name="Put line").click()
    page.keyboard.press("F9")
    page.get_by_role("tab", name="Event file").click()
    expect(page.locator(".lines")).to_contain_text("put: bed.line, value: Clear")
    with page.expect_download() as saved:
        page.get_by_role("link", name="Save as a file").click()
    events = tmp_path / "events.yaml"
    saved.value.save_as(events)
    page.get_by_role("tab", name="Trace").click()
    expect(page.get_by_role("tab", name="Trace")).to_have_attribute("aria-selected", "true")
    words = (str(PUMP), "--interpreter", "--events", str(events))
    done = subprocess.run(
        command(*words, name="simulate"), env=environment(), capture_output=True, text=True,
        check=True,
    )  # fmt: skip
    assert page.locator(".lines").text_content() == done.stdout.rstrip("\n")


def test_the_event_file_is_copied(shown: BrowserPage) -> None:
    page = shown.page
    shown.context.grant_permissions(["clipboard-read", "clipboard-write"])
    page.keyboard.press("F8")
    page.get_by_role("button", name="Put line").click()
    page.keyboard.press("F9")
    page.get_by_role("tab", name="Event file").click()
    expect(page.locator(".lines")).to_contain_text("put: bed.line")
    page.get_by_role("button", name="Copy").click()
    expect(page.get_by_text("Copied.")).to_be_visible()
    copied = page.evaluate("navigator.clipboard.readText()")
    assert copied == page.locator(".lines").text_content() and "put: bed.line" in copied


def test_a_browser_that_refuses_to_copy_says_what_to_do(shown: BrowserPage) -> None:
    page = shown.page
    page.evaluate("() => { navigator.clipboard.writeText = () => Promise.reject(new Error()); }")
    page.keyboard.press("F8")
    page.get_by_role("tab", name="Event file").click()
    page.get_by_role("button", name="Copy").click()
    expect(page.get_by_text("The browser refuses: select the text")).to_be_visible()


def test_the_end_is_told(shown: BrowserPage, served: Running) -> None:
    assert served.end() == 130
    expect(shown.page.get_by_role("alert")).to_contain_text("ravenchart simulate has ended")
    shown.wrong.clear()  # that the connection was lost is an error of the network


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [1280, 900, 400])
def test_axe_finds_nothing_serious_and_nothing_is_wider_than_the_window(
    browser: Browser, served: Running, scheme: str, width: int
) -> None:
    look = {"color_scheme": scheme, "viewport": {"width": width, "height": 800}}
    shown = BrowserPage(browser, served.address, **look)
    page = shown.page
    page.keyboard.press("F8")
    page.get_by_label("panel amount").fill("many")
    page.get_by_role("button", name="Put panel").click()
    page.get_by_text("What the model gives itself").click()
    page.keyboard.press("F9")
    found = []
    for tab in ("Last execution", "Trace", "Event file"):
        page.get_by_role("tab", name=tab).click()
        found += serious(page)
        assert page.evaluate("document.documentElement.scrollWidth") <= width
    shown.closed(served.address)
    assert found == []
