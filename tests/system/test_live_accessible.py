# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The tab Live read aloud and in both colour schemes, on a wide and a narrow screen."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect

from ravenchart.analysis.system.observed import FAULTS, TraceMap, read_map
from ravenchart.building import checking, generation
from ravenchart.hw_can.bench.bus_client import RavenchartBus
from ravenchart.running.vocabulary import BusVocabulary
from tests.support.browser import IN_BROWSER, BrowserPage, launched, serious
from tests.support.bus_server import BusServer
from tests.support.far_end import FarEnd
from tests.support.snapshot_files import PUMP, held, snapshot
from tests.support.workbench import Running, running

pytestmark = IN_BROWSER

RECORDED = """
record:
  - bed.motor
  - bed.display
"""


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """One for all tests of this file."""
    with launched() as found:
        yield found


def written(names: TraceMap) -> str:
    """A snapshot with all that the tab can show: what is in order, what is late, what is lost."""
    control, reception = (names.named(n, "processor").number for n in ("control", "reception"))
    regions = [one.number for one in names.of_kind("region")]
    infusion = names.named("bed.Infusion", "region").number
    return snapshot(
        30,
        f"T 1000000000 Transition {infusion} 0",
        f"T 1500000000 Fault {control} {FAULTS.index('Deadline_Miss')}",
        "N 2000000000",
        f"P {reception} 5 0 30000 20000",
        f"P {control} 40 1 90000000 301195",
        *(f"Q {number} 1 7" for number in regions[:1]),
        "H Deadline_Miss 1", "L trace 2", "L ward.lost_out 3",
        *(f"C STATE {number} 1 900000000 0" for number in regions),
        f"C TRANSITION {infusion} 1 1000000000 0",
        *(f"C VALUE {one.number} 20 1900000000 0" for one in names.of_kind("value")),
        *(f"C ARRIVED {one.number} 7 1900000000 1" for one in names.of_kind("port")),
        digest=names.digest,
    )  # fmt: skip


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    """A workbench that watches a controller of the pump and its bus."""
    folder = tmp_path_factory.mktemp("pump")
    model = Path(shutil.copy(PUMP, folder))
    model.write_text(model.read_text("utf-8") + RECORDED, "utf-8")
    checked = checking.check(model)
    generation.write_program(checked)
    names = read_map((folder / "generated" / "trace.json").read_text("utf-8"))
    file = folder / "pump.live"
    file.write_text(written(names), "ascii")
    server = BusServer()
    board = FarEnd(RavenchartBus(server.channel), BusVocabulary.of(checked.system))
    told = ("--file", str(file), "--interface", "ravenchart", "--channel", server.channel)
    with held(file), running(model, *told) as found:
        board.say("display", {"given": 3, "lamp": "Steady", "buzzer": "False"})
        yield found
    board.close()
    server.close()


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [1400, 400])
def test_axe_finds_nothing_serious_in_the_tab_live(
    browser: Browser, bench: Running, scheme: str, width: int
) -> None:
    pane = BrowserPage(
        browser, bench.address, color_scheme=scheme, viewport={"width": width, "height": 900}
    )
    pane.page.get_by_role("tab", name="Live").click()
    live = pane.page.get_by_role("region", name="Controller of board")
    expect(live.locator("h3")).to_contain_text("snapshot 30")
    expect(live.get_by_role("row", name="control").first).to_contain_text("MISS")
    expect(live.locator(".error")).not_to_have_count(0)
    expect(live.locator(".plot svg")).not_to_have_count(0)
    bus = pane.page.get_by_role("region", name="Bus ward")
    expect(bus.get_by_role("row", name="display 0x111")).to_be_visible()
    live.get_by_role("button", name="bed.Infusion", exact=True).click()
    expect(pane.page.locator(".paper g.active").first).to_be_attached()
    assert pane.page.evaluate("document.documentElement.scrollWidth") <= width
    found = serious(pane.page)
    pane.page.set_viewport_size({"width": width, "height": 3000})  # nothing has to be scrolled
    found += serious(pane.page)
    pane.closed(bench.address)
    assert found == []
