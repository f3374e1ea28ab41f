# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The pictures of the documentation that show pages: `make pictures` makes them in Chromium."""

from __future__ import annotations

import io
import os
import shutil
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import chdir, contextmanager
from pathlib import Path

from PIL import Image
from playwright.sync_api import Browser, Locator, Page, expect

from ravenchart.paths import ROOT
from tests.support.browser import BrowserPage, launched
from tests.support.viewed_runs import ROBOT, WorkingRobot
from tests.support.workbench import running

PICTURES = ROOT / "docs" / "pictures"
PUMP = ROOT / "examples" / "pump"
WORKS = 8.0
"""Seconds for which the robot works."""

TRIES = 8
"""So often a picture of it is taken at the most."""


def taken(page: Page, name: str, part: Locator | None = None) -> None:
    """Write what the page shows, or a part of it."""
    page.mouse.move(0, 0)
    path = PICTURES / f"{name}.png"
    with Image.open(io.BytesIO((part or page).screenshot())) as whole:
        whole.convert("RGB").save(path, optimize=True)
    print(f"{path.relative_to(ROOT)}: {path.stat().st_size // 1024} KiB")


@contextmanager
def shown(browser: Browser, model: Path, height: int, *words: str, name: str) -> Iterator[Page]:
    """The page of a command, called in the folder of the model."""
    with chdir(model.parent), running(Path(model.name), *words, name=name) as bench:
        size = {"width": 1400 if name == "workbench" else 1280, "height": height}
        pane = BrowserPage(browser, bench.address, viewport=size)
        yield pane.page
        pane.closed(bench.address)


def workbench(browser: Browser, folder: Path) -> None:
    """An activity was moved to another processor, and two chains are too slow."""
    model = Path(shutil.copytree(ROBOT, folder / "moved")) / "model.yaml"
    with shown(browser, model, 860, name="workbench") as page:
        row = page.locator('.processors [data-row="joint_x.position_control"]')
        row.focus()
        page.keyboard.press("Shift+ArrowLeft")
        expect(page.locator("header .verdict")).to_contain_text("too slow")
        row.press("Enter")
        expect(page.get_by_text("Largest C with every limit kept")).to_contain_text("is not kept")
        page.get_by_role("tab", name="Buses").click()
        taken(page, "workbench")


def live(browser: Browser, robot: WorkingRobot) -> bool:
    """The robot moves: responses, states and the chart of a joint; its bus in another picture.

    False where the host has withheld the core from it: a picture should not show that.
    """
    with (
        shown(browser, robot.model, 1300, name="workbench") as page,
        ThreadPoolExecutor() as aside,
    ):
        page.get_by_role("tab", name="Live").click()
        expect(page.locator("#outcome")).to_contain_text("No controller of")
        run = aside.submit(robot.played, WORKS)
        region = page.get_by_role("region", name="Controller of controller")
        region.get_by_role("button", name="joint_x.Motion", exact=True).click()
        expect(page.locator(".paper g.active > title", has_text="Cruising")).to_have_count(1)
        taken(page, "live")
        taken(page, "live_bus", page.get_by_role("region", name="Bus robot_bus"))
        words = region.locator(".word").all_text_contents()
        run.result()
        return words == ["ok"] * 4


def replay(browser: Browser, robot: WorkingRobot) -> None:
    """The same run afterwards, at an instant at which a joint has just begun to move."""
    words = ("--replay", os.path.join("out", "trace.txt"))
    with shown(browser, robot.model, 1100, *words, name="workbench") as page:
        page.get_by_label("Go to, in s").fill("4.7")
        page.get_by_label("Go to, in s").press("Enter")
        expect(page.locator(".player .clock")).to_contain_text("4.700 s of")
        page.get_by_role("button", name="joint_x.Motion", exact=True).click()
        expect(page.locator(".paper g.active").first).to_be_attached()
        page.get_by_role("img", name="joint_x.drive.speed over time").scroll_into_view_if_needed()
        taken(page, "replay")


def charts_in_motion(browser: Browser, folder: Path) -> None:
    """The pump gives, and then there is air in the line."""
    model = Path(shutil.copytree(PUMP, folder / "pump")) / "model.yaml"
    events = model.with_name("events.yaml")
    given = events.read_text(encoding="utf-8").partition("# Air in the line.")[0]
    events.write_text(f"{given}- {{until: 6800 ms}}\n", encoding="utf-8")
    with shown(browser, model, 800, "--events", events.name, name="simulate") as page:
        page.get_by_label("line", exact=True).select_option("Air")
        page.get_by_role("button", name="Put line").click()
        page.get_by_role("button", name="One execution").click()
        expect(page.locator(".clock")).to_have_text("executed up to 6.850 s")
        page.locator(".paper g.cluster.active").last.scroll_into_view_if_needed()
        taken(page, "charts_in_motion")


def main() -> None:
    """All of them."""
    with tempfile.TemporaryDirectory(prefix="ravenchart-pictures-") as place, launched() as browser:
        workbench(browser, Path(place))
        charts_in_motion(browser, Path(place))
        robot = WorkingRobot(Path(place))
        if not any(live(browser, robot) for _ in range(TRIES)):
            print("live.png shows a robot from which the host withheld the core: try again")
        replay(browser, robot)


if __name__ == "__main__":
    main()
