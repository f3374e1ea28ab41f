# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The running controllers on the page of the workbench, without a browser."""

from __future__ import annotations

import asyncio
import json
import shutil
import threading
from pathlib import Path
from types import SimpleNamespace

import pytest
from starlette.requests import Request

from ravenchart.building import programs
from ravenchart.building.checking import check
from ravenchart.command_line import main
from ravenchart.failures import UNUSABLE, WRONG
from ravenchart.paths import ROOT
from ravenchart.running.monitor_text import overlooked_in_words
from ravenchart.running.monitored import Overlooked, WatchedValue
from ravenchart.workbench.hub import Hub
from ravenchart.workbench.live import LiveView
from ravenchart.workbench.motion import LastValues
from ravenchart.workbench.requests import Save
from ravenchart.workbench.server import WorkbenchPages
from ravenchart.workbench.session import Session
from tests.support.recorded import MODEL
from tests.support.snapshot_files import (
    GENERATED,
    PUMP,
    held,
    number,
    processors,
    snapshot,
    trace_map,
)
from tests.support.workbench import PATIENCE, running

TWO_NODES = ROOT / "examples" / "two_nodes" / "model.yaml"

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


def test_a_save_that_takes_long_does_not_hold_up_what_is_shown_live(
    model: Path, file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    session = Session(model)
    hub = Hub(session, LiveView(model))
    pages = WorkbenchPages(hub)
    begun, ended = threading.Event(), threading.Event()

    def save(*, late: bool) -> tuple[str, ...]:
        begun.set()
        ended.wait(PATIENCE)
        return ()

    monkeypatch.setattr(session, "save", save)

    async def sequences() -> list[int]:
        saving = asyncio.create_task(hub.act(Save(kind="save", number=session.number, late=False)))
        await asyncio.to_thread(begun.wait, PATIENCE)
        found = []
        try:
            for number in range(1, 6):
                file.write_text(snapshot(number, *processors(40)))
                answer = await asyncio.wait_for(pages.live(Request({"type": "http"})), PATIENCE / 2)
                found.append(json.loads(bytes(answer.body))["nodes"][0]["sequence"])
            assert not saving.done()
        finally:
            ended.set()
            await saving
            await hub.close()
        return found

    file.write_text(snapshot(1, *processors(40)))
    with held(file):
        assert asyncio.run(sequences()) == [1, 2, 3, 4, 5]
    hub.shut()


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
    last = LastValues(check(MODEL).system, None)
    for second in range(100):
        warm = WatchedValue("giver.reading.warm", str(second % 2 == 1), "", 7, second * SECOND)
        heat = WatchedValue(
            "taker.heat", f"{second - 50}.5", "degC", 1 + 5 * second, second * SECOND
        )
        other = WatchedValue("nothing", "1", "", 1, second * SECOND)
        node = SimpleNamespace(now=second * SECOND + 1, values=[warm, heat, other])
        for _ in range(2):  # a value that was there at the look before is no new point
            lines = last.look(node)  # type: ignore[arg-type]
    assert set(lines) == {"giver.reading.warm", "taker.heat"}
    quantity, points, recorded = lines["taker.heat"]
    assert (quantity.value(points[0][1]), quantity.value(points[-1][1])) == (19.5, 49.5)
    assert [at for at, _ in points] == [second * SECOND for second in range(69, 100)]
    assert (len(points), recorded) == (31, 5 * 30 + 1)  # four of five are in no snapshot
    quantity, points, recorded = lines["giver.reading.warm"]
    assert (quantity.text(points[-1][1]), len(points), recorded) == ("False", 1, 1)


# --- Files that the user names ------------------------------------------------------


def restarted(text: str, later: int = 1) -> str:
    """The same of a controller that was started some ns later."""
    assert "E 84385114343632\n" in text
    return text.replace("E 84385114343632\n", f"E {84385114343632 + later}\n")


@pytest.mark.slow
def test_the_controller_of_a_file_is_shown_and_so_is_the_next_one_there(
    model: Path, tmp_path: Path
) -> None:
    file = tmp_path / "pump.live"
    file.write_text(snapshot(1, *processors(40)))
    live = LiveView(model, None, [f"board={file}"])
    digest = trace_map().digest
    with held(file) as process:
        live.begin(digest)
        found = live.look(digest)
        assert [node["process"] for node in found["nodes"]] == [process]
    ended = live.look(digest)
    assert ended["text"] == f"{file}: no controller writes this file now"
    assert [node["process"] for node in ended["nodes"]] == [None]
    file.unlink()
    assert live.look(digest)["text"] == f"{file}: no such file or directory"
    file.write_text(restarted(snapshot(7, *processors(41))))
    with held(file) as process:
        (node,) = live.look(digest)["nodes"]
        assert (node["process"], node["sequence"]) == (process, 7)
    live.close()


@pytest.mark.slow
def test_what_was_seen_of_a_controller_is_no_part_of_the_next_one(
    model: Path, tmp_path: Path
) -> None:
    """The next one has begun, in the same file, before a page looked again."""
    file = tmp_path / "pump.live"
    region = number("bed.Infusion", "region")

    def taken(count: int) -> list[str]:
        return [f"T {count * 1000} Transition {region} 0", f"C TRANSITION {region} {count} 1 0"]

    live = LiveView(model, None, [str(file)])
    digest = trace_map().digest
    file.write_text(snapshot(5, *processors(40), *taken(1)))
    with held(file):
        live.begin(digest)
        file.write_text(snapshot(9, *processors(40), *taken(4)))
        (node,) = live.look(digest)["nodes"]
        assert node["overlooked"] == overlooked_in_words(Overlooked(5, 3, 2))
        assert [one["at"] for one in node["last"]] == [1000, 4000]
        file.write_text(restarted(snapshot(2, *processors(3), *taken(2))))
        (node,) = live.look(digest)["nodes"]
        assert node["overlooked"] == overlooked_in_words(Overlooked(1, 0, 0))
        assert [one["at"] for one in node["last"]] == [2000]
        file.write_text(restarted(snapshot(3, *processors(3), digest="0" * 64), 2))
        found = live.look(digest)
        assert found["nodes"] == [] and "was generated from another model" in found["text"]
    live.close()


@pytest.mark.slow
def test_one_of_two_nodes_that_is_started_again_is_shown_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    model = Path(shutil.copytree(TWO_NODES.parent, tmp_path / "nodes")) / "model.yaml"
    checked = check(model)
    names = [one.node for one in programs.programs_of(checked)]
    files = {name: tmp_path / f"{name}.live" for name in names}
    for file in files.values():
        file.write_text(snapshot(1, "N 1000", digest=checked.system.digest))
    live = LiveView(model, None, [f"{name}={file}" for name, file in files.items()])
    first, second = files.values()
    with held(first):
        with held(second):
            live.begin(checked.system.digest)
        found = live.look(checked.system.digest)["nodes"]
        assert [one["process"] is None for one in found] == [False, True]
        second.unlink()  # as systemd does with the directory of a service
        second.write_text(restarted(snapshot(2, "N 1000", digest=checked.system.digest)))
        with held(second) as process:
            found = live.look(checked.system.digest)["nodes"]
            assert [one["process"] for one in found][1:] == [process]
            assert found[1]["sequence"] == 2
    live.close()


def test_a_file_is_refused_before_a_page_is_served(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "pump.live"
    words = ["workbench", str(PUMP), "--no-open", "--file", str(file)]
    assert main(words) == UNUSABLE
    assert "no such file" in capsys.readouterr().err
    file.write_text(snapshot(1, *processors(40), digest="0" * 64))
    assert main(words) == UNUSABLE
    assert "no controller writes this file now" in capsys.readouterr().err
    assert main([*words, "--file", f"board={file}"]) == UNUSABLE
    assert "the node board has a file already" in capsys.readouterr().err
    assert main([*words, "--replay", str(file)]) == UNUSABLE
    assert "leave --file out" in capsys.readouterr().err
    assert main(["workbench", str(TWO_NODES), "--no-open", "--file", str(file)]) == UNUSABLE
    assert "names no node: the model has" in capsys.readouterr().err
    with held(file):
        assert main(words) == WRONG
    captured = capsys.readouterr()
    assert "was generated from another model" in captured.err
    assert "http://" not in captured.out


def test_the_page_shows_the_controller_of_a_file(tmp_path: Path) -> None:
    file = tmp_path / "pump.live"
    file.write_text(snapshot(3, *processors(40)))
    with held(file) as process, running(PUMP, "--file", str(file)) as bench:
        found = bench.request("live").json
        assert [(one["process"], one["sequence"]) for one in found["nodes"]] == [(process, 3)]
