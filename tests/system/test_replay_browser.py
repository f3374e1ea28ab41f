# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A recorded run in a real browser: played, stepped and moved by a slider, by keys alone too."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Locator, expect

from tests.support.browser import IN_BROWSER, BrowserPage, launched, serious
from tests.support.recordings import report, write
from tests.support.snapshot_files import PUMP, number, trace_map
from tests.support.workbench import Running, command, environment, running

pytestmark = IN_BROWSER

SECOND = 1_000_000_000
REGION = number("bed.Infusion", "region")


def _lines() -> Iterator[str]:
    """Twenty seconds: the self-test ends after five, and three records are lost in the last two."""
    element = trace_map().elements[REGION]
    yield from report(trace_map(), 0, 0, 0)
    yield f"T 1000 State {REGION} {element.leaves.index('Self_Test')}"
    yield f"T {5 * SECOND} Transition {REGION} {element.transitions.index('ready')}"
    yield f"T {5 * SECOND} State {REGION} {element.leaves.index('Programming')}"
    yield from report(trace_map(), 18 * SECOND, 360, 0)
    yield from report(trace_map(), 20 * SECOND, 400, 3)
    yield "END"


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    folder = tmp_path_factory.mktemp("replay")
    trace = write(folder / "trace.txt", trace_map(), list(_lines()))
    with running(PUMP, "--replay", str(trace)) as found:
        yield found


@pytest.fixture
def pane(bench: Running) -> Iterator[BrowserPage]:
    """A page at the first instant; nothing may go wrong in it."""
    bench.act(kind="pause")
    bench.act(kind="seek", at=0)
    with launched() as browser:
        found = BrowserPage(browser, bench.address)
        yield found
        found.closed(bench.address)


def active(pane: BrowserPage) -> Locator:
    """The states that the drawing shows as active."""
    return pane.page.locator(".paper g.active > title")


def test_a_run_is_stepped_played_and_moved_and_its_states_are_in_the_chart(
    pane: BrowserPage,
) -> None:
    page = pane.page
    expect(page.get_by_role("tab", name="Replay")).to_have_attribute("aria-selected", "true")
    live = page.get_by_role("region", name="Controller of board")
    clock = page.locator(".player .clock")
    expect(clock).to_have_text("0.000 s of 20.000 s")
    page.get_by_label("Go to, in s").fill("4.5")
    page.get_by_role("button", name="Go", exact=True).click()
    expect(clock).to_have_text("4.500 s of 20.000 s")
    live.get_by_role("button", name="bed.Infusion", exact=True).click()
    expect(active(pane)).to_contain_text(["Self_Test"])
    expect(page.locator(".paper g.taken")).to_have_count(0)
    page.get_by_role("button", name="Next", exact=True).click()
    expect(clock).to_have_text("5.000 s of 20.000 s")
    expect(live).to_contain_text("At this instant: transition bed.Infusion ready")
    expect(live.get_by_role("row", name="bed.Infusion Programming 0.0 s 1")).to_be_visible()
    expect(active(pane)).to_have_text(["Programming"])
    expect(page.locator(".paper g.taken")).not_to_have_count(0)
    page.get_by_role("button", name="Next", exact=True).click()
    expect(page.get_by_role("alert")).to_have_text("the trace has no later transition or fault")
    page.get_by_role("button", name="Play", exact=True).click()
    expect(clock).not_to_have_text("5.000 s of 20.000 s")
    page.get_by_role("button", name="Pause", exact=True).click()
    expect(page.get_by_role("button", name="Play", exact=True)).to_be_visible()
    slider = page.get_by_role("slider", name="Instant")
    slider.fill("19000")
    expect(clock).to_have_text("19.000 s of 20.000 s")
    expect(live.get_by_role("row", name="control")).to_contain_text("360")
    expect(page.locator(".player")).to_contain_text("Here 3 trace records, between 18.000 s and")
    slider.fill("2000")
    expect(live.get_by_role("row", name="bed.Infusion Self_Test 2.0 s 0")).to_be_visible()
    expect(active(pane)).to_contain_text(["Self_Test"])
    assert serious(page) == []
    page.get_by_role("tab", name="Findings").click()
    expect(active(pane)).to_have_count(0)


def test_a_run_is_replayed_by_keys_alone(pane: BrowserPage) -> None:
    page = pane.page
    clock = page.locator(".player .clock")
    page.get_by_role("slider", name="Instant").focus()
    page.keyboard.press("End")
    expect(clock).to_have_text("20.000 s of 20.000 s")
    expect(page.locator("#outcome")).to_contain_text("ended in order")
    page.keyboard.press("Home")
    expect(clock).to_have_text("0.000 s of 20.000 s")
    page.keyboard.press("ArrowRight")
    expect(clock).not_to_have_text("0.000 s of 20.000 s")
    page.keyboard.press("Space")
    expect(page.get_by_role("button", name="Pause", exact=True)).to_be_visible()
    page.keyboard.press("Space")
    expect(page.get_by_role("button", name="Play", exact=True)).to_be_visible()
    page.get_by_role("button", name="Play", exact=True).focus()
    page.keyboard.press("Tab")
    page.keyboard.press("Tab")
    expect(page.get_by_role("button", name="Previous", exact=True)).to_be_focused()


def test_a_simulation_is_replayed(tmp_path: Path) -> None:
    told = [str(PUMP), "--interpreter", "--events", str(PUMP.parent / "events.yaml")]
    words = command(*told, name="simulate")
    done = subprocess.run(words, env=environment(), capture_output=True, text=True, check=True)
    out = tmp_path / "out.txt"
    out.write_text(done.stdout)
    with running(PUMP, "--replay", str(out)) as bench, launched() as browser:
        pane = BrowserPage(browser, bench.address)
        page = pane.page
        live = page.get_by_role("region", name="Controller of Infusion_System")
        expect(live).to_contain_text("simulated, 0.000 s")
        page.get_by_role("button", name="Next", exact=True).click()
        expect(live).to_contain_text("At this instant: transition bed.Keys pressed")
        page.get_by_role("slider", name="Instant").fill("600")
        expect(live.get_by_role("row", name="bed.Infusion.Sensor Sensor_Good")).to_be_visible()
        live.get_by_role("button", name="bed.Infusion", exact=True).click()
        expect(active(pane)).to_contain_text(["Self_Test"])
        page.get_by_role("slider", name="Instant").press("End")
        expect(live).to_contain_text("19.000 s, the last line is here")
        assert serious(page) == []
        pane.closed(bench.address)


def test_why_a_board_has_ended_is_told(tmp_path: Path) -> None:
    said = "error: control has ended by an exception: infusion_system-bed.adb:12"
    trace = write(tmp_path / "board.txt", trace_map(), [f"T 1000 State {REGION} 0", "T 2", said])
    with running(PUMP, "--replay", str(trace)) as bench, launched() as browser:
        pane = BrowserPage(browser, bench.address)
        expect(pane.page.locator(".player")).to_contain_text(f"The controller said: {said}")
        expect(pane.page.locator(".player")).to_contain_text("The trace of board was cut off")
        pane.closed(bench.address)


def _releases() -> Iterator[str]:
    """Two releases of `control` and a report behind each: the second one has three activities."""
    control = number("control", "processor")
    jobs = {0: ("ports", "Keys", "Infusion", "turn", "fill", "drive", "show"),
            50_000_000: ("ports", "Keys", "Infusion", "drive")}  # fmt: skip
    yield from report(trace_map(), 0, 0, 0)
    for releases, (due, rows) in enumerate(jobs.items(), 1):
        for place, row in enumerate(rows, 1):
            yield f"T {due + place * 40_000} Activity {number(f'bed.{row}', 'row')} 0"
        last = 300_000 if releases == 1 else 1_500_000
        yield f"N {due + 2_000_000}"
        yield f"P {control} {releases} 0 {last} {last}"
    yield "END"


def test_the_responses_of_each_activity_are_beside_c_and_r(tmp_path: Path) -> None:
    trace = write(tmp_path / "trace.txt", trace_map(), list(_releases()))
    with running(PUMP, "--replay", str(trace)) as bench, launched() as browser:
        pane = BrowserPage(browser, bench.address)
        page = pane.page
        responses = page.get_by_role("table", name=re.compile("^Responses of activities"))
        ports = responses.get_by_role("row", name="bed.ports")
        expect(ports).to_contain_text("0 of 0")
        page.get_by_role("slider", name="Instant").fill("10")
        cells = ports.get_by_role("cell")
        expect(cells).to_contain_text(["bed.ports", "100 us", "345 us", "-", "80 us", "1 of 1"])
        show = responses.get_by_role("row", name="bed.show").get_by_role("img")
        expect(show).to_have_accessible_name(
            "Responses of bed.show: 1 of 1 sampled; C 50 us, R 895 us; 1 from 268.5 us to 313.3 us"
        )
        assert show.locator("rect.exact").count() == 1
        assert show.locator("rect.at-most").count() == 0
        page.get_by_role("slider", name="Instant").fill("55")
        expect(cells).to_contain_text(["bed.ports", "100 us", "345 us", "-", "80 us", "2 of 2"])
        drive = responses.get_by_role("row", name="bed.drive")
        expect(drive).to_contain_text("1.5 ms")
        expect(drive).to_contain_text("2 of 2")
        expect(drive.get_by_role("img")).to_have_accessible_name(
            "Responses of bed.drive: 2 of 2 sampled; C 50 us, R 845 us; "
            "1 at most 338 us, 1 from 1.437 ms to 1.521 ms"
        )
        expect(drive.locator("line.c")).to_be_attached()
        expect(drive.locator("line.r")).to_be_attached()
        expect(show.locator("rect.at-most")).to_have_count(0)
        assert serious(page) == []
        pane.closed(bench.address)


def test_two_pages_show_one_instant(pane: BrowserPage, bench: Running) -> None:
    bench.act(kind="seek", at=7 * SECOND)  # as another page asks
    expect(pane.page.locator(".player .clock")).to_have_text("7.000 s of 20.000 s")
