# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The running controllers on the page of the workbench, without a browser."""

from __future__ import annotations

import shutil
from pathlib import Path
from types import SimpleNamespace

import pytest

from ravenchart.building import programs
from ravenchart.building.checking import check
from ravenchart.running.monitored import WatchedValue
from ravenchart.workbench.live import LiveView
from ravenchart.workbench.motion import LastValues
from tests.support.recorded import MODEL
from tests.support.snapshot_files import (
    GENERATED,
    PUMP,
    held,
    processors,
    snapshot,
    trace_map,
)

SECOND = 1_000_000_000


@pytest.fixture
def model(tmp_path: Path) -> Path:
    """A copy of the pump with its generated program."""
    shutil.copytree(GENERATED, tmp_path / "pump" / "generated")
    return Path(shutil.copy(PUMP, tmp_path / "pump"))


@pytest.fixture
def file(tmp_path: Path, model: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where a controller of it writes snapshots; nothing else is built there."""
    monkeypatch.setattr(programs, "work", lambda: tmp_path)
    (home,) = programs.homes_of(model) or [_home(tmp_path, model)]
    (home / "checks").mkdir(parents=True)
    return home / "checks" / "infusion_system_main.live-1"


def _home(work: Path, model: Path) -> Path:
    home = programs.build_home(check(model), "slcan")
    assert home.is_relative_to(work)
    return home


@pytest.mark.slow
def test_what_runs_is_shown_until_it_ends_and_then_kept(model: Path, file: Path) -> None:
    live = LiveView(model)
    digest = trace_map().digest
    none = live.look(digest)
    assert none["nodes"] == [] and "No controller of Infusion_System runs" in none["text"]
    file.write_text(snapshot(1, *processors(40)))
    with held(file) as process:
        found = live.look(digest)
        (node,) = found["nodes"]
        assert (found["text"], node["process"], node["sequence"]) == ("", process, 1)
        file.write_text(snapshot(2, *processors(41)))
        assert live.look(digest)["nodes"][0]["sequence"] == 2
    ended = live.look(digest)
    assert ended["nodes"][0]["process"] is None and not ended["nodes"][0]["ended"]
    assert "No controller of Infusion_System runs" in ended["text"]


@pytest.mark.slow
def test_a_controller_of_an_earlier_model_is_not_shown_and_the_page_says_why(
    model: Path, file: Path
) -> None:
    live = LiveView(model)
    file.write_text(snapshot(1, *processors(40), digest="0" * 64))
    with held(file):
        for _ in range(2):
            found = live.look(trace_map().digest)
            assert found["nodes"] == []
            assert "was generated from another model" in found["text"]


def test_the_controllers_of_a_model_with_errors_are_not_looked_for(model: Path) -> None:
    found = LiveView(model).look(None)
    assert found == {
        "text": "The saved model has errors: its controllers are not looked for.", "nodes": [],
        "buses": [],
    }  # fmt: skip


def test_the_values_of_the_time_of_a_plot_are_kept_with_the_one_that_holds_on_into_it() -> None:
    last = LastValues(check(MODEL).system)
    for second in range(100):
        warm = WatchedValue("giver.reading.warm", str(second % 2 == 1), "", 1, second * SECOND)
        heat = WatchedValue("taker.heat", f"{second - 50}.5", "degC", 1, second * SECOND)
        other = WatchedValue("nothing", "1", "", 1, second * SECOND)
        node = SimpleNamespace(now=second * SECOND + 1, values=[warm, heat, other])
        for _ in range(2):  # a value that was there at the look before is no new point
            lines = last.look(node)  # type: ignore[arg-type]
    assert set(lines) == {"giver.reading.warm", "taker.heat"}
    quantity, points = lines["taker.heat"]
    assert (quantity.value(points[0][1]), quantity.value(points[-1][1])) == (19.5, 49.5)
    assert [at for at, _ in points] == [second * SECOND for second in range(69, 100)]
    quantity, points = lines["giver.reading.warm"]
    assert quantity.text(points[-1][1]) == "True"
