# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The running controller in a real browser, on the page of the workbench."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest
from playwright.sync_api import Locator, expect

from ravenchart.analysis.system.observed import read_map
from ravenchart.building import checking, generation, programs
from ravenchart.hw_can.bench.bus_client import RavenchartBus
from ravenchart.paths import ROOT
from ravenchart.running.held_files import trace_beside
from ravenchart.running.process import ControllerProcess
from ravenchart.running.vocabulary import BusVocabulary
from tests.support.browser import IN_BROWSER, BrowserPage, launched, serious
from tests.support.bus_server import BusServer
from tests.support.far_boards import HEAD, Board
from tests.support.far_end import FarEnd
from tests.support.processes import LAUNCHER
from tests.support.recorded import FOLDER
from tests.support.snapshot_files import held, number, snapshot
from tests.support.workbench import running

pytestmark = [*IN_BROWSER, pytest.mark.live]

PUMP = ROOT / "examples" / "pump" / "model.yaml"


def built(model: Path) -> Path:
    """The executable of the first node of a model, which is generated and built."""
    checked = checking.check(model)
    generation.write_program(checked)
    executables = [program.build() for program in programs.programs_of(checked)]
    return executables[0]


def _numbers(where: Locator, pattern: str) -> tuple[int, int]:
    """Both numbers of a text there, as soon as it is there."""
    expect(where).to_contain_text(re.compile(pattern))
    found = re.search(pattern, where.text_content() or "")
    assert found is not None
    return int(found[1]), int(found[2])


def test_the_live_tab_follows_a_controller_to_its_end(tmp_path: Path) -> None:
    executable = built(PUMP)
    with running(PUMP) as bench, launched() as browser:
        pane = BrowserPage(browser, bench.address)
        pane.page.get_by_role("tab", name="Live").click()
        shown = pane.page.locator("#outcome")
        expect(shown).to_contain_text("No controller of Infusion_System runs")
        process = ControllerProcess(executable, tmp_path / "trace.txt", 0)
        try:
            live = pane.page.get_by_role("region", name="Controller of board")
            expect(live.locator("h3")).to_contain_text("snapshot")
            expect(live.get_by_role("row", name="bed.Infusion Self_Test")).to_be_visible()
            expect(live).to_contain_text("Not seen: ")
            first = live.locator("h3").text_content() or ""
            expect(live.locator("h3")).not_to_have_text(first)
            live.get_by_role("button", name="bed.Infusion", exact=True).click()
            active = pane.page.locator(".paper g.active > title")
            expect(active).to_contain_text(["Self_Test"])
            assert serious(pane.page) == []
        finally:
            ended = process.stop(0.0)
        assert ended.exit_code == 0, ended.warnings
        expect(live.locator("h3")).to_contain_text("ended in order")
        pane.closed(bench.address)


def test_the_live_tab_has_the_responses_of_each_activity(tmp_path: Path) -> None:
    """From the trace of the run; without it from snapshots, of the last activities alone."""
    executable = built(PUMP)
    with running(PUMP) as bench, launched() as browser:
        pane = BrowserPage(browser, bench.address)
        pane.page.get_by_role("tab", name="Live").click()
        live = pane.page.get_by_role("region", name="Controller of board")
        ports = live.get_by_role("row", name="bed.ports 100 us 345 us")
        drive = live.get_by_role("row", name="bed.drive 50 us 845 us")
        process = ControllerProcess(executable, tmp_path / "trace.txt", 0)
        try:
            expect(live).to_contain_text("From the trace up to ")
            sampled, executed = _numbers(ports.get_by_role("cell").nth(5), r"([1-9]\d*) of (\d+)")
            assert sampled == executed  # each one ends before the next one begins
            expect(drive.locator("rect.exact")).not_to_have_count(0)
            expect(ports.get_by_role("img")).to_have_accessible_name(
                re.compile(
                    r"^Responses of bed.ports: \d+ of \d+ sampled; C 100 us, R 345 us; \d+ at"
                )
            )
            assert serious(pane.page) == []
        finally:
            process.stop(0.0)
        process = ControllerProcess(executable, tmp_path / "trace.txt", 0)
        assert process.snapshots is not None
        trace_beside(process.snapshots).unlink()
        try:
            expect(live).to_contain_text("the trace of this controller is not at hand")
            expect(drive.locator("rect.exact")).not_to_have_count(0)
            expect(ports.locator("rect")).to_have_count(0)
        finally:
            process.stop(0.0)
        pane.closed(bench.address)


def test_recorded_values_move_in_the_live_tab(tmp_path: Path) -> None:
    model = Path(shutil.copytree(FOLDER, tmp_path / "recorded")) / "model.yaml"
    executable = built(model)
    with running(model) as bench, launched() as browser:
        pane = BrowserPage(browser, bench.address)
        pane.page.get_by_role("tab", name="Live").click()
        process = ControllerProcess(executable, tmp_path / "trace.txt", 0)
        try:
            live = pane.page.get_by_role("region", name="Controller of board")
            plot = pane.page.get_by_role("img", name="giver.height over time")
            line = plot.locator("path")
            expect(line).to_have_attribute("d", re.compile(r"^M(\S+ ?)+H\S+V\S+H300$"))
            first = line.get_attribute("d") or ""
            expect(line).not_to_have_attribute("d", first)
            row = live.get_by_role("row", name="giver.height", exact=False)
            drawn, recorded = _numbers(row, r"(\d+) of (\d+) values drawn")
            assert 2 * drawn < recorded  # there are five in the period of a snapshot
            missed, of = _numbers(live, r"snapshots not looked at: (\d+) of (\d+)")
            assert of > 1 and of - missed >= drawn
            assert serious(pane.page) == []
        finally:
            ended = process.stop(0.0)
        assert ended.exit_code == 0, ended.warnings
        pane.closed(bench.address)


def test_the_live_tab_says_what_it_did_not_look_at(tmp_path: Path) -> None:
    """Of five snapshots the page looks at the first and the last one."""
    model = Path(shutil.copytree(FOLDER, tmp_path / "recorded")) / "model.yaml"
    generation.write_program(checking.check(model))
    text = (model.parent / "generated" / "trace.json").read_text(encoding="utf-8")
    names = read_map(text)
    heat = names.named("taker.heat", "value").number
    chart = names.named("taker.Counting", "region").number

    def written(sequence: int, values: int, transitions: int, listed: int) -> str:
        first = transitions - listed
        lines = [f"T {first + k} Transition {chart} 0" for k in range(listed)]
        lines.append(f"C TRANSITION {chart} {transitions} {transitions} 0")
        lines.append(f"C VALUE {heat} {values} {values * 1000} {values}")
        return snapshot(sequence, f"N {sequence * 10**8}", *lines, digest=names.digest)

    file = tmp_path / "recorded.live"
    file.write_text(written(1, 1, 3, 3))
    with (
        held(file),
        running(model, "--file", str(file)) as bench,
        launched() as browser,
    ):
        pane = BrowserPage(browser, bench.address)
        pane.page.get_by_role("tab", name="Live").click()
        live = pane.page.get_by_role("region", name="Controller of board")
        expect(live.locator("h3")).to_contain_text("snapshot 1")
        expect(live).to_contain_text("snapshots not looked at: 0 of 1; transitions and faults not")
        plot = live.get_by_role("row", name="taker.heat")
        expect(plot).not_to_contain_text("drawn")
        file.write_text(written(5, 41, 42, 32))
        expect(live.locator("h3")).to_contain_text("snapshot 5")
        expect(live).to_contain_text(
            "snapshots not looked at: 3 of 5; transitions and faults not listed: 7"
        )
        expect(plot).to_contain_text("2 of 41 values drawn")
        expect(live.get_by_role("columnheader", name=re.compile("^last 30 s"))).to_have_text(
            "last 30 s: one value of each snapshot"
        )
        assert serious(pane.page) == []
        pane.closed(bench.address)


def test_a_board_is_shown_by_its_serial_line() -> None:
    chart = number("bed.Infusion", "region")
    board = Board()
    with running(PUMP, "--file", board.port) as bench, launched() as browser:
        pane = BrowserPage(browser, bench.address)
        pane.page.get_by_role("tab", name="Live").click()
        live = pane.page.get_by_role("region", name="Controller of board")
        expect(live).to_contain_text("Not seen: ")
        board.says(*HEAD, f"T 1000000000 State {chart} 1", f"T 2000000000 Transition {chart} 0")
        row = live.get_by_role("row", name="bed.Infusion", exact=False).first
        expect(row).to_contain_text("1.0 s")
        row.get_by_role("button").click()
        expect(pane.page.locator(".paper g.active > title").first).to_be_attached()
        control = number("control", "processor")
        board.says("N 3000000000", f"P {control} 60 0 456000 171000", f"Q {chart} 2 3")
        expect(live.get_by_role("row", name="control").first).to_contain_text("456 us")
        expect(live.get_by_role("row", name="bed.Infusion 2 of 8")).to_be_visible()
        assert serious(pane.page) == []
        board.unplugged()
        expect(live.locator("h3")).to_contain_text("ENDED WITHOUT ITS REPORT")
        pane.closed(bench.address)
    board.close()


def test_the_bus_of_a_shell_is_shown_until_it_ends_and_then_that_of_the_next_one() -> None:
    with running(PUMP) as bench, launched() as browser:
        pane = BrowserPage(browser, bench.address)
        pane.page.get_by_role("tab", name="Live").click()
        bus = pane.page.get_by_role("region", name="Bus ward")
        for given in ("Clear", "Air"):
            shell = subprocess.Popen(
                [LAUNCHER, "shell", PUMP], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
                text=True,
            )  # fmt: skip
            try:
                expect(bus.locator("h3")).to_contain_text("ward: bus of a run, ", timeout=60_000)
                expect(bus.locator("h3")).not_to_contain_text("the run has ended", timeout=60_000)
                expect(bus.get_by_role("row", name="motor 0x")).to_contain_text("value 0 ul")
                assert shell.stdin is not None
                shell.stdin.write(f"send line value={given}\n")
                shell.stdin.flush()
                line = bus.get_by_role("row", name="line 0x")
                expect(line).to_contain_text(f"value {given}", timeout=30_000)
                assert serious(pane.page) == []
            finally:
                shell.communicate("quit\n")
            assert shell.returncode == 0
            expect(bus.locator("h3")).to_contain_text("the run has ended")
        pane.closed(bench.address)


def test_both_nodes_of_a_run_are_shown_with_their_bus(tmp_path: Path) -> None:
    model = Path(shutil.copytree(ROOT / "examples" / "two_nodes", tmp_path / "two")) / "model.yaml"
    built(model)
    with running(model) as bench, launched() as browser:
        pane = BrowserPage(browser, bench.address)
        pane.page.get_by_role("tab", name="Live").click()
        run = subprocess.Popen(
            [LAUNCHER, "run", model, "--seconds", "20"],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        )  # fmt: skip
        try:
            nodes = [
                pane.page.get_by_role("region", name=f"Controller of {name}")
                for name in ("panel", "drive")
            ]
            for node in nodes:
                expect(node.locator("h3")).to_contain_text("snapshot", timeout=60_000)
                first = node.locator("h3").text_content() or ""
                expect(node.locator("h3")).not_to_have_text(first)
                sampled = re.compile(r"^Responses of .*: [1-9]\d* of ")
                expect(node.get_by_role("img", name=sampled).first).to_be_visible()
            bus = pane.page.get_by_role("region", name="Bus ")
            expect(bus.first.locator("h3")).to_contain_text("bus of a run, ")
            assert serious(pane.page) == []
        finally:
            said, _ = run.communicate()
        assert run.returncode == 0, said
        for node in nodes:
            expect(node.locator("h3")).to_contain_text("ended in order")
        pane.closed(bench.address)


def test_a_bus_is_shown_with_its_load_and_the_last_values() -> None:
    """The bus of a board: no controller of the model runs on this machine."""
    server = BusServer()
    words = BusVocabulary.of(checking.check(PUMP, deadlines=False).system)
    board = FarEnd(RavenchartBus(server.channel), words)
    told = ("--interface", "ravenchart", "--channel", server.channel)
    with running(PUMP, *told) as bench, launched() as browser:
        pane = BrowserPage(browser, bench.address)
        pane.page.get_by_role("tab", name="Live").click()
        bus = pane.page.get_by_role("region", name="Bus ward")
        expect(bus).to_contain_text("in the analysis: 3.2 %")
        for number in range(30):
            board.say("display", {"given": number, "lamp": "Steady", "buzzer": "False"})
        row = bus.get_by_role("row", name="display 0x111")
        expect(row).to_contain_text("given 29 ul, lamp Steady, buzzer False")
        expect(bus).to_contain_text("frames: 30")
        assert serious(pane.page) == []
        server.close()
        expect(bus).to_contain_text("gone: ")
        pane.closed(bench.address)
    board.close()
