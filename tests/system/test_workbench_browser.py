# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The workbench in a real browser, Debian's Chromium: by drag, by keyboard, and read aloud."""

from __future__ import annotations

import re
import shutil
import statistics
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Locator, expect

from ravenchart.paths import ROOT
from tests.support.browser import IN_BROWSER, BrowserPage, launched, serious
from tests.support.can_frames import within
from tests.support.workbench import Running, running
from tests.support.workbench_speed import SHOWN, hundred, shown

pytestmark = IN_BROWSER


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """One for all tests of this file."""
    with launched() as found:
        yield found


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A copy of the robot's model, with a comment at a row."""
    for path in (ROOT / "examples" / "cartesian_robot").glob("*.yaml"):
        shutil.copy(path, tmp_path)
    model = tmp_path / "model.yaml"
    text = model.read_text(encoding="utf-8")
    row = "      - joint_x.Monitoring\n"
    assert text.count(row) == 1
    model.write_text(text.replace(row, "      - joint_x.Monitoring  # watches the drive\n"))
    return tmp_path


@pytest.fixture
def bench(folder: Path) -> Iterator[Running]:
    """A workbench of it."""
    with running(folder / "model.yaml") as found:
        yield found


class Pane(BrowserPage):
    """A page that shows the workbench."""

    def row(self, name: str) -> Locator:
        """The row of a table."""
        return self.page.locator(f'.processors [data-row="{name}"]')

    def rows(self, processor: str) -> list[str]:
        """The table of a processor."""
        names = self.page.locator(f'[data-processor="{processor}"] .row .name')
        return names.all_text_contents()

    def bound(self, processor: str) -> Locator:
        """The response of a processor, in words."""
        return self.page.locator(f'[data-processor="{processor}"] .response .number')


@pytest.fixture
def pane(browser: Browser, bench: Running) -> Iterator[Pane]:
    """One page; nothing may go wrong in it, and nothing may be asked of elsewhere."""
    found = Pane(browser, bench.address)
    yield found
    found.closed(bench.address)


def test_a_row_is_dragged_to_another_processor_saved_and_its_comment_kept(
    pane: Pane, folder: Path
) -> None:
    page = pane.page
    before = pane.bound("trajectory").text_content()
    on = page.locator(".components .declared", has_text="Monitoring").get_by_role("button")
    on = on.filter(has_text="joint_x").locator(".on")
    expect(on).to_have_text("control")
    target = pane.row("joint_y.trajectory_step")
    pane.row("joint_x.Monitoring").drag_to(target, target_position={"x": 20, "y": 3})
    expect(pane.bound("trajectory")).not_to_have_text(before or "")
    expect(pane.bound("trajectory")).to_contain_text("saved 865 us")
    expect(on).to_have_text("trajectory")
    expect(page.locator('[data-processor="trajectory"] .row .name')).to_have_text([
        "joint_x.trajectory_step", "joint_x.Monitoring", "joint_y.trajectory_step",
        "joint_z.trajectory_step",
    ])  # fmt: skip
    old = {path.name: path.read_text(encoding="utf-8") for path in folder.iterdir()}
    page.get_by_role("button", name="Save …").click()
    diff = page.get_by_role("dialog").locator(".diff")
    expect(diff.locator(".added")).to_have_text("+      - joint_x.Monitoring  # watches the drive")
    expect(diff.locator(".removed")).to_have_count(1)
    page.get_by_role("dialog").get_by_role("button", name="Save", exact=True).click()
    expect(page.get_by_role("dialog")).to_have_count(0)
    expect(page.get_by_role("button", name="Save …")).to_be_disabled()
    new = {path.name: path.read_text(encoding="utf-8") for path in folder.iterdir()}
    line = "      - joint_x.Monitoring  # watches the drive\n"
    assert new.pop("model.yaml") == old.pop("model.yaml").replace(line, "").replace(
        "      - joint_y.trajectory_step\n", f"{line}      - joint_y.trajectory_step\n"
    )
    assert new == old
    page.get_by_role("button", name="Undo").click()
    expect(page.get_by_role("button", name="Save …")).to_be_enabled()
    assert "joint_x.Monitoring" in pane.rows("control")


def test_a_stream_is_the_last_response_and_has_nothing_to_change(
    browser: Browser, folder: Path
) -> None:
    model = folder / "model.yaml"
    text = model.read_text(encoding="utf-8")
    trace = "    trace: 4096\n"
    assert text.count(trace) == 1
    model.write_text(text.replace(trace, f"{trace}    stream: {{wcet: 6 ms}}\n"))
    with running(model) as bench:
        pane = Pane(browser, bench.address)
        rows = pane.page.locator(".processors article")
        stream = pane.page.locator('[data-stream="controller.stream"]')
        expect(stream).to_contain_text("lowest priority")
        expect(stream.locator(".response .number")).to_have_text(
            re.compile(r"^R \S+ ms of 100 ms$")
        )
        expect(stream).to_contain_text(re.compile(r"Its snapshots are at most \d+ ms apart\."))
        expect(rows.last).to_have_attribute("data-stream", "controller.stream")
        expect(stream.locator("input, li")).to_have_count(0)
        before = stream.locator(".response").text_content()
        pane.row("joint_x.trajectory_step").click()
        field = pane.page.locator(".controls").get_by_label("WCET C")
        field.fill("1 ms")
        field.press("Enter")
        expect(stream.locator(".response .number")).to_contain_text("saved")
        assert stream.locator(".response").text_content() != before
        assert serious(pane.page) == []
        pane.closed(bench.address)


def test_a_processor_that_is_on_several_nodes_has_a_bar_on_each(browser: Browser) -> None:
    with running(ROOT / "examples" / "two_nodes" / "model.yaml") as bench:
        pane = Pane(browser, bench.address)
        reception = pane.page.locator('[data-processor="reception"]')
        for node in ("panel", "drive"):
            copy = reception.locator(f'[data-node="{node}"]')
            expect(copy).to_contain_text(re.compile(rf"^on {node}, priority \d+ok"))
            expect(copy.locator(".number")).to_have_text(re.compile(r"^R \d+ us of 1 ms$"))
            expect(copy.locator(".bar .part.own")).to_be_visible()
        assert serious(pane.page) == []
        first, second = pane.page.evaluate(FIRST_CHARACTERS)
        assert first < second  # `/` is in front of the path, though its end is what stays
        pane.closed(bench.address)


FIRST_CHARACTERS = """() => {
  const model = document.querySelector("header .model");
  const text = document.createTreeWalker(model, NodeFilter.SHOW_TEXT).nextNode();
  const left = (place) => {
    const range = document.createRange();
    range.setStart(text, place);
    range.setEnd(text, place + 1);
    return range.getBoundingClientRect().left;
  };
  return [left(0), left(1)];
}"""
"""How far to the right the first two characters of the model's path are."""


def test_a_row_is_moved_by_keys_and_keeps_the_focus(pane: Pane) -> None:
    page = pane.page
    row = "joint_x.Monitoring"
    pane.row(row).focus()
    page.keyboard.press("Shift+ArrowUp")
    expect(page.locator('[data-processor="control"] .row .name').first).to_have_text(row)
    expect(pane.row(row)).to_be_focused()
    page.keyboard.press("Shift+ArrowRight")
    expect(page.locator('[data-processor="supervision"] .row .name').first).to_have_text(row)
    expect(pane.row(row)).to_be_focused()
    page.keyboard.press("Shift+ArrowLeft")
    page.keyboard.press("Shift+ArrowDown")
    expect(page.locator('[data-processor="control"] .row .name').nth(1)).to_have_text(row)
    page.keyboard.press("ArrowDown")
    expect(pane.row("joint_x.position_control")).to_be_focused()
    for _ in range(4):
        page.keyboard.press("Control+z")
    expect(page.get_by_role("button", name="Undo")).to_be_disabled()
    page.keyboard.press("Control+Shift+z")
    expect(page.get_by_role("button", name="Undo")).to_be_enabled()


def test_arrow_keys_go_from_one_outcome_to_the_next(pane: Pane) -> None:
    page = pane.page
    page.get_by_role("tab", name="Findings").focus()
    page.keyboard.press("ArrowRight")
    expect(page.get_by_role("tab", name="Chains")).to_be_focused()
    expect(page.get_by_role("tab", name="Chains")).to_have_attribute("aria-selected", "true")


def test_a_move_by_keys_changes_the_bound_and_is_saved_by_keys(pane: Pane, folder: Path) -> None:
    page, row, model = pane.page, "joint_x.Monitoring", folder / "model.yaml"
    before = pane.bound("trajectory").text_content() or ""
    assert before == "R 865 us of 5 ms"
    pane.row(row).focus()
    page.keyboard.press("Shift+ArrowLeft")
    expect(pane.bound("trajectory")).not_to_have_text(before)
    expect(pane.bound("trajectory")).to_contain_text("saved 865 us")
    assert model.read_text(encoding="utf-8").count(row) == 1
    page.keyboard.press("Control+s")
    save = page.get_by_role("dialog").get_by_role("button", name="Save", exact=True)
    expect(save).to_be_enabled()
    for _ in range(10):
        if save.evaluate("button => button === document.activeElement"):
            break
        page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    expect(page.get_by_role("dialog")).to_have_count(0)
    expect(page.get_by_role("button", name="Save …")).to_be_disabled()
    line = f"      - {row}  # watches the drive\n      - joint_y.trajectory_step\n"
    assert line in model.read_text(encoding="utf-8")
    page.keyboard.press("Control+z")
    expect(pane.bound("trajectory")).to_contain_text("R 865 us of 5 ms, saved ")


def test_a_move_changes_chains_and_messages_in_their_tabs(pane: Pane) -> None:
    page = pane.page
    panel = page.get_by_role("tabpanel")
    page.get_by_role("tab", name="Chains").click()
    chain = panel.get_by_role("row", name=re.compile("^x_loop reaction"))
    expect(chain.locator("td.number")).to_have_text(["22.145 ms", "22.145 ms", "25 ms"])
    pane.row("joint_x.position_control").drag_to(pane.row("joint_x.trajectory_step"))
    expect(page.get_by_role("tab", name="Findings")).to_have_attribute("aria-selected", "true")
    page.get_by_role("tab", name="Chains").click()
    expect(chain.locator("td.number")).to_have_text(["32.36 ms", "22.145 ms", "25 ms"])
    expect(chain.locator(".word")).to_have_text("MISS")
    page.get_by_role("tab", name="Buses").click()
    message = panel.get_by_role("row", name=re.compile("^x_set_point"))
    expect(message.locator("td.number").nth(2)).to_have_text("3.3 ms")
    expect(message.locator("td.number.moved")).to_have_text("4.3 ms")
    page.keyboard.press("Control+z")
    expect(message.locator("td.number").nth(2)).to_have_text("4.3 ms")
    expect(message.locator("td.number.moved")).to_have_count(0)


@pytest.mark.parametrize(
    ("label", "value", "line", "wrong"),
    [
        ("Period", "20 ms", "period: 20 ms", "soon"),
        ("Priority", "3", "priority: 3", "high"),
        ("Deadline", "8 ms", "deadline: 8 ms", "-1 ms"),
    ],
)
def test_a_field_of_a_processor_is_changed_saved_and_taken_back(
    pane: Pane, folder: Path, label: str, value: str, line: str, wrong: str
) -> None:
    page, model = pane.page, folder / "model.yaml"
    before = model.read_text(encoding="utf-8")
    shown = page.locator('[data-processor="supervision"]')
    field = shown.get_by_label(label, exact=True)
    follows = field.get_attribute("placeholder")
    field.fill(wrong)
    field.press("Enter")
    expect(field).to_have_attribute("aria-invalid", "true")
    assert page.get_by_role("button", name="Save …").is_disabled()
    field.fill(value)
    field.press("Enter")
    expect(page.get_by_role("button", name="Save …")).to_be_enabled()
    expect(field).to_have_value(value)
    page.get_by_role("button", name="Save …").click()
    dialog = page.get_by_role("dialog")
    expect(dialog.locator(".added")).to_contain_text([line])
    assert model.read_text(encoding="utf-8") == before
    field.evaluate("input => input.blur()")
    dialog.get_by_role("button", name="Cancel").click()
    field.fill("")
    field.press("Enter")
    expect(page.get_by_role("button", name="Save …")).to_be_disabled()
    assert field.get_attribute("placeholder") == follows
    assert model.read_text(encoding="utf-8") == before


def test_the_buttons_of_a_selected_row_do_the_same(pane: Pane) -> None:
    page = pane.page
    row = "joint_x.Monitoring"
    pane.row(row).press("Enter")
    expect(pane.row(row)).to_have_attribute("aria-expanded", "true")
    page.get_by_role("button", name="Later").click()
    expect(page.locator('[data-processor="control"] .row .name').nth(2)).to_have_text(row)
    page.get_by_label("Move to").select_option("supervision")
    expect(page.locator('[data-processor="supervision"] .row .name').last).to_have_text(row)
    expect(page.get_by_text("Largest C with every limit kept:")).to_contain_text(
        re.compile(r"\d+ us")
    )


def test_a_longer_wcet_is_infeasible_in_words_and_its_save_asked_for(
    pane: Pane, folder: Path
) -> None:
    page = pane.page
    before = (folder / "joint.yaml").read_bytes()
    field = page.locator(".declared", has_text="position_control").get_by_label("C", exact=True)
    field.fill("4 ms")
    field.press("Enter")
    panel = page.get_by_role("tabpanel")
    expect(panel).to_contain_text("control has no response-time bound")
    expect(panel).to_contain_text("shorten worst-case execution times")
    expect(page.locator("header .verdict")).to_contain_text("deadlines may be missed")
    page.get_by_role("tab", name="Chains").click()
    expect(panel.locator(".word.bad").first).to_have_text("MISS")
    page.get_by_role("tab", name="Room and advice").click()
    expect(panel).to_contain_text("all execution times must shrink by")
    page.keyboard.press("Control+s")
    page.get_by_role("dialog").get_by_role("button", name="Save", exact=True).click()
    expect(page.get_by_role("dialog")).to_contain_text("a deadline or limit is not kept")
    assert (folder / "joint.yaml").read_bytes() == before
    page.get_by_role("dialog").get_by_role("button", name="Save all the same").click()
    expect(page.get_by_role("dialog")).to_have_count(0)
    assert b"wcet: 4 ms" in (folder / "joint.yaml").read_bytes()


def test_tables_that_a_search_finds_become_a_change(pane: Pane) -> None:
    page = pane.page
    names = page.locator("[data-processor]")
    before = names.count()
    page.get_by_role("tab", name="Allocation").click()
    page.get_by_label("Look for").select_option("as few processors as possible")
    page.get_by_role("button", name="Search", exact=True).click()
    expect(page.get_by_role("status").filter(has_text="Found:")).to_contain_text(
        "every deadline is met"
    )
    assert serious(page) == []
    page.get_by_role("button", name="Put these tables").click()
    expect(names).not_to_have_count(before)
    expect(page.get_by_role("button", name="Undo")).to_have_attribute(
        "title", "rows allocated by fewest"
    )
    page.get_by_role("button", name="Undo").click()
    expect(names).to_have_count(before)


def test_an_error_is_shown_with_its_location_and_the_last_good_figures(pane: Pane) -> None:
    page = pane.page
    bound = pane.bound("control").text_content() or ""
    field = page.locator(".declared", has_text="position_control").get_by_label("T", exact=True)
    field.fill("15 ms")
    field.press("Enter")
    expect(page.get_by_role("alert")).to_contain_text("The model has errors, see Findings.")
    expect(page.get_by_role("tabpanel")).to_contain_text("RV-0704")
    expect(pane.bound("control")).to_have_text(bound)
    field.fill("nonsense")
    field.press("Enter")
    expect(page.get_by_role("alert").last).to_contain_text("`nonsense` is not a duration")
    expect(field).to_have_attribute("aria-invalid", "true")
    field.press("Escape")
    expect(field).to_have_value("15 ms")


def test_a_click_on_a_drawing_shows_the_source(pane: Pane) -> None:
    page = pane.page
    page.locator(".drawing select").select_option("Joint.Motion")
    page.get_by_role(
        "button", name=re.compile("^Braking, source joint.yaml|^Braking, source .*joint")
    ).first.click()
    here = page.locator(".source .line.here")
    expect(here).to_contain_text("Braking: {}")
    expect(here).to_be_in_viewport()
    page.locator(".drawing select").select_option("structure")
    page.locator(".paper text.link", has_text="joint_z.supervise").click()
    expect(here).to_contain_text("- joint_z.supervise")


def test_a_drawing_is_zoomed(pane: Pane) -> None:
    drawing = pane.page.locator(".paper svg")
    fitted = drawing.get_attribute("width") or ""
    pane.page.get_by_role("button", name="100 %").click()
    whole = drawing.evaluate("svg => String(Math.round(svg.dataset.width))")
    expect(drawing).to_have_attribute("width", whole)
    assert float(whole) > float(fitted)
    pane.page.get_by_role("button", name="Zoom in").click()
    expect(drawing).to_have_attribute(
        "width", drawing.evaluate("svg => String(Math.round(svg.dataset.width * 1.25))")
    )
    pane.page.get_by_role("button", name="Fit").click()
    expect(drawing).to_have_attribute("width", fitted)


def test_two_browsers_see_the_same(pane: Pane, browser: Browser, bench: Running) -> None:
    other = Pane(browser, bench.address)
    pane.row("joint_x.Monitoring").focus()
    pane.page.keyboard.press("Shift+ArrowRight")
    expect(other.page.locator('[data-processor="supervision"] .row .name').nth(1)).to_have_text(
        "joint_x.Monitoring"
    )
    other.page.get_by_role("button", name="Undo").click()
    expect(pane.page.get_by_role("button", name="Undo")).to_be_disabled()
    both = '[data-processor="control"] .row .name'
    expect(other.page.locator(both)).to_have_text(pane.rows("control"))
    assert other.wrong == []
    other.context.close()


def test_a_change_outside_is_shown_and_not_overwritten(pane: Pane, folder: Path) -> None:
    page, path = pane.page, folder / "joint.yaml"
    field = page.locator(".declared", has_text="position_control").get_by_label("C", exact=True)
    field.fill("160 us")
    field.press("Enter")
    expect(page.get_by_role("button", name="Save …")).to_be_enabled()
    theirs = path.read_text(encoding="utf-8") + "# theirs\n"
    path.write_text(theirs, encoding="utf-8")
    expect(page.get_by_role("alert")).to_contain_text("changed on the disk")
    assert path.read_text(encoding="utf-8") == theirs
    page.get_by_role("button", name="Show the files on the disk").click()
    expect(field).to_have_value("150 us")
    page.get_by_role("button", name="Undo").click()
    expect(field).to_have_value("160 us")


def test_the_end_of_the_workbench_is_told(pane: Pane, bench: Running) -> None:
    assert bench.end() == 130
    expect(pane.page.get_by_role("alert")).to_contain_text("The workbench has ended")
    pane.wrong.clear()  # that the connection was lost is an error of the network


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [1400, 900, 400])
def test_axe_finds_nothing_serious(
    browser: Browser, bench: Running, scheme: str, width: int
) -> None:
    pane = Pane(
        browser, bench.address, color_scheme=scheme, viewport={"width": width, "height": 900}
    )
    page = pane.page
    pane.row("coordinator.Mission").click()
    field = page.locator(".declared", has_text="Mission").get_by_label("C", exact=True)
    field.fill("19 ms")
    field.press("Enter")
    expect(page.locator(".findings li").first).to_be_visible()
    found = []
    for tab in ("Findings", "Chains", "Buses", "Room and advice", "Source"):
        page.get_by_role("tab", name=tab).click()
        found += serious(page)
    page.get_by_role("button", name="Save …").click()
    expect(page.get_by_role("dialog").locator(".added").first).to_be_visible()
    found += serious(page)
    pane.context.close()
    assert found == []


def test_nothing_is_wider_than_the_window(browser: Browser, bench: Running) -> None:
    for width in (1400, 1100, 900, 600, 400):
        pane = Pane(browser, bench.address, viewport={"width": width, "height": 900})
        assert pane.page.evaluate("document.documentElement.scrollWidth") <= width
        pane.context.close()


@pytest.mark.alone
def test_a_change_of_a_hundred_activities_is_on_the_page_soon(
    browser: Browser, tmp_path: Path
) -> None:
    taken = shown(browser, hundred(tmp_path))
    print(f"median {statistics.median(taken):.0f} ms, longest {max(taken):.0f} ms")
    assert statistics.median(taken) < SHOWN


def test_a_change_is_drawn_once(pane: Pane) -> None:
    """The state comes twice: as the answer, and in the stream, where the advice follows it."""
    page = pane.page
    page.evaluate(COUNTED)
    field = page.locator(".declared .times .field:nth-child(2) input").first
    field.fill("7 us")
    field.press("Enter")
    assert within(lambda: page.evaluate("window.advised"))
    assert page.evaluate("window.drawn") == 1


COUNTED = """() => {
  const parse = JSON.parse;
  window.drawn = 0;
  JSON.parse = (text) => {
    const found = parse(text);
    if (found?.undo && found.room === null) window.drawn += 1;
    if (found?.undo && found.room !== null) window.advised = true;
    return found;
  };
}"""
"""Counts how often a changed state is drawn before its advice."""
