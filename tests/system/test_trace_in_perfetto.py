# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What `trace` writes, read by a foreign reader: Perfetto's viewer, without a network."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect

from ravenchart.building import checking, generation
from ravenchart.command_line import main
from tests.support.browser import IN_BROWSER, launched
from tests.support.perfetto import Opened, opened
from tests.support.recorded import FOLDER
from tests.support.trace_events import PUMP, events_of, lines_of, run_of_the_pump

pytestmark = IN_BROWSER

Slice = tuple[str, str, str, int, int]
"""Process, track, name, begin and length in ns; a mark has no length."""

SLICES = """
  select process.name as process, thread.name as track, slice.name as name, ts, dur
  from slice join thread_track on slice.track_id = thread_track.id
  join thread using (utid) join process using (upid)
"""
COUNTERS = """
  select process.name as process, track.name as name, ts, value
  from counter join process_counter_track as track on counter.track_id = track.id
  join process using (upid)
"""
PROBLEMS = """
  select name, value from stats
  where severity in ('error', 'data_loss') and value > 0
"""

VALUES = (
    "V 1000 giver.height -993", "V 1500 giver.hue Green", "V 2000 taker.heat -397",
    "V 20001000 giver.height 1000", "V 20001500 giver.hue Blue", "V 20002000 taker.heat 1250",
    "N 30000000",
)  # fmt: skip


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """One for all tests of this file."""
    with launched() as found:
        yield found


def exported(model: Path, trace: Path, folder: Path) -> Path:
    """The file for Perfetto."""
    out = folder / "run.json"
    assert main(["trace", str(model), str(trace), "--out", str(out)]) == 0
    return out


def slices(perfetto: Opened) -> list[Slice]:
    """All slices and marks that Perfetto has found."""
    found = perfetto.rows(SLICES, process="str", track="str", name="str", ts=0, dur=0)
    return sorted(found)


def written(out: Path) -> list[Slice]:
    """All that are in the file."""
    _, events, tracks = events_of(out)
    processes = {e["pid"]: e["args"]["name"] for e in events if e["name"] == "process_name"}
    return sorted(
        (
            processes[e["pid"]], tracks[e["pid"], e["tid"]], e["name"],
            round(1000 * e["ts"]), round(1000 * e.get("dur", 0)),
        )
        for e in events
        if e["ph"] in "Xi"
    )  # fmt: skip


def test_perfetto_finds_each_slice_and_mark_of_a_run_in_its_track(
    browser: Browser, tmp_path: Path
) -> None:
    out = exported(PUMP / "model.yaml", run_of_the_pump(tmp_path), tmp_path)
    with opened(browser, out) as perfetto:
        found = slices(perfetto)
        assert found == written(out) and len(found) > 10
        assert ("board", "bed.Infusion", "Self_Test", 1_500, 29_998_600) in found
        assert ("board", "bed.Infusion", "ready", 30_000_000, 0) in found
        assert perfetto.rows(PROBLEMS, name="str", value=0) == []
        expect(perfetto.page.locator("body")).to_contain_text("bed.Infusion.Motor")


def test_perfetto_shows_recorded_values_as_counters_and_slices(
    browser: Browser, tmp_path: Path
) -> None:
    model = Path(shutil.copytree(FOLDER, tmp_path / "recorded")) / "model.yaml"
    generation.write_program(checking.check(model))
    trace = tmp_path / "trace.txt"
    trace.write_text(lines_of(model.parent / "generated", *VALUES), encoding="ascii")
    out = exported(model, trace, tmp_path)
    with opened(browser, out) as perfetto:
        assert sorted(perfetto.rows(COUNTERS, process="str", name="str", ts=0, value=0)) == [
            ("board", "giver.height in mm value", 1_000, -993),
            ("board", "giver.height in mm value", 20_001_000, 1000),
            ("board", "taker.heat in degC value", 2_000, -39.7),
            ("board", "taker.heat in degC value", 20_002_000, 125),
        ]
        assert (
            slices(perfetto)
            == written(out)
            == [
                ("board", "giver.hue", "Blue", 20_001_500, 500),
                ("board", "giver.hue", "Green", 1_500, 20_000_000),
            ]
        )
        assert perfetto.rows(PROBLEMS, name="str", value=0) == []
