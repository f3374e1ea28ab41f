# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""States of charts by name: from the snapshots of a controller that runs on this machine."""

from __future__ import annotations

import asyncio
import io
import os
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from rich.console import Console

from ravenchart.analysis.system.observed import read_map
from ravenchart.command_line import main
from ravenchart.failures import Unusable
from ravenchart.gen.model.statechart import PseudoKind
from ravenchart.hw_can.bench.peer import BenchError
from ravenchart.paths import ROOT
from ravenchart.running.chart_names import charts_of
from ravenchart.running.remote import NoAnswerError, RemoteSystem, connect
from ravenchart.running.shell import Shell
from ravenchart.running.vocabulary import BusVocabulary, WordError
from tests.support.answers import answered
from tests.support.far_end import ROBOT, FarEnd, system_of
from tests.support.snapshot_files import held, snapshot

pytestmark = pytest.mark.clock

MODEL = ROBOT / "model.yaml"
MAP = read_map((ROBOT / "generated" / "trace.json").read_text("utf-8"))
NS = 1_000_000_000
ZERO = {"x": 0, "y": 0, "z": 0}
PUMP = ROOT / "examples" / "pump" / "model.yaml"
MODELS = [ROOT / "examples" / "cartesian_robot" / "model.yaml", PUMP]
MODELS += [ROOT / "examples" / name / "model.yaml" for name in ("qhsmtst", "fatigue_rig")]
PRINTED = pytest.CaptureFixture[str]


class Controller:
    """The file of snapshots of a robot that was started now, and what it says next."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._start = time.monotonic_ns()
        self._sequence = 0
        path.write_text("")
        self.says()

    def says(self, lost: int = 0, **states: str) -> None:
        """A snapshot of now: the Mission or others have entered these states half a second ago."""
        self._sequence += 1
        now = time.monotonic_ns() - self._start
        lines = [f"N {now}", f"L trace {lost}"]
        for name, state in states.items():
            region = MAP.named(f"coordinator.{name}", "region")
            entered = now - NS // 2
            lines.append(f"C STATE {region.number} 1 {entered} {region.leaves.index(state)}")
        text = snapshot(self._sequence, *lines, digest=MAP.digest, start=self._start)
        file = os.open(self.path, os.O_WRONLY)
        os.pwrite(file, text.encode(), 0)
        os.ftruncate(file, len(text))
        os.close(file)


@pytest.fixture
def owner(tmp_path: Path) -> Iterator[ExitStack]:
    """Holds the lock of the controller's file until it is closed, as the controller would."""
    (tmp_path / "live").write_text("")
    with ExitStack() as stack:
        stack.enter_context(held(tmp_path / "live"))
        yield stack


@pytest.fixture
def controller(owner: ExitStack, tmp_path: Path) -> Controller:
    return Controller(tmp_path / "live")


@pytest.fixture
def near(
    far: FarEnd, controller: Controller, request: pytest.FixtureRequest
) -> Iterator[RemoteSystem]:
    where = request.node.name
    with connect(MODEL, interface="virtual", channel=where, files=[controller.path]) as one:
        yield one


def later(seconds: float, controller: Controller, state: str) -> None:
    threading.Timer(seconds, lambda: controller.says(Mission=state)).start()


@pytest.mark.parametrize("name", ["Mission", "coordinator.Mission"])
def test_a_state_is_waited_for_by_the_name_of_its_chart(
    near: RemoteSystem, controller: Controller, name: str
) -> None:
    controller.says(Mission="Homing")
    later(0.2, controller, "Ready")
    assert 0.15 < near.wait_for(name, "Ready", 5) < 5
    assert near.wait_for(name, "Ready", 5) < 0.1  # it still is there


def test_a_coroutine_waits_while_others_go_on(near: RemoteSystem, controller: Controller) -> None:
    controller.says(Mission="Homing")

    async def both() -> tuple[float, int]:
        async def turns() -> int:
            await asyncio.sleep(0.1)
            controller.says(Mission="Ready")
            return 1

        return await asyncio.gather(near.state("Mission", "Ready", timeout=5), turns())

    took, turned = asyncio.run(both())
    assert 0.05 < took < 5 and turned


def test_a_state_from_before_the_command_does_not_count(
    near: RemoteSystem, controller: Controller
) -> None:
    controller.says(Mission="Ready")
    near.send("Home", **ZERO)
    with pytest.raises(NoAnswerError):
        near.wait_for("Mission", "Ready", 0.1)
    controller.says(Mission="Ready")
    assert near.wait_for("Mission", "Ready", 5) < 1


def test_without_the_state_the_error_says_the_last_one(
    near: RemoteSystem, controller: Controller, owner: ExitStack
) -> None:
    text = "coordinator.Mission was not Ready within 0.05 s: "
    with pytest.raises(NoAnswerError) as silent:
        near.wait_for("Mission", "Ready", 0.05)
    trace = "the snapshots of controller have no such chart\n  hint: give the node the key `trace`"
    assert str(silent.value) == text + trace
    controller.says(Mission="Homing", lost=3)
    with pytest.raises(TimeoutError, match=r"last Homing for .* ms, seen .* ms ago; 3 tr"):
        asyncio.run(near.state("Mission", "Ready", timeout=0.05))
    controller.says(Mission="Homing")
    owner.close()
    began = time.monotonic()
    with pytest.raises(
        NoAnswerError, match=r"the controller has ended; last Homing for 50\d(\.\d)? ms$"
    ):
        near.wait_for("Mission", "Ready", 30)
    assert time.monotonic() - began < 10


def test_closing_ends_who_waits(near: RemoteSystem, controller: Controller) -> None:
    controller.says(Mission="Homing")
    threading.Timer(0.1, near.close).start()
    with pytest.raises(BenchError, match="the bus was left"):
        near.wait_for("Mission", "Ready", 30)
    assert near.charts == {}


@pytest.mark.parametrize(
    ("name", "state", "text"),
    [
        ("Mision", "Ready", "there is no field or chart `Mision`\n"
         "  hint: did you mean `Mission`?"),
        ("coordinator.Mision", "Ready", "there is no field or chart `coordinator.Mision`\n"
         "  hint: did you mean `coordinator.Mission`?"),
        ("Motion", "Idle", "`Motion` may be several things\n"
         "  hint: write `joint_x.Motion` or `joint_y.Motion` or `joint_z.Motion`"),
        ("Mission", "Redy", "`coordinator.Mission` has no state `Redy`\n"
         "  hint: did you mean `Ready`?"),
        ("Mission", 3, "`coordinator.Mission` has no state `3`\n"
         "  hint: one of Active, Waiting, Homing, "),
    ],
)  # fmt: skip
def test_names_that_there_are_not_get_the_nearest(
    near: RemoteSystem, name: str, state: str | int, text: str
) -> None:
    with pytest.raises(WordError) as refused:
        near.wait_for(name, state)
    assert str(refused.value).startswith(text)


def test_without_snapshots_the_error_says_what_to_do(
    far: FarEnd, request: pytest.FixtureRequest
) -> None:
    with connect(MODEL, interface="virtual", channel=request.node.name) as near:
        assert near.charts == {}
        with pytest.raises(WordError) as refused:
            near.wait_for("Mission", "Ready")
    assert str(refused.value) == (
        "the states of the chart `coordinator.Mission` are not seen: no snapshots of the node "
        "controller are read\n  hint: on this machine, start its controller with "
        "RAVENCHART_MONITOR=FILE, and give `--file FILE` (`files` of `connect`); elsewhere, wait "
        "for a field: coordinator sends robot_status.condition, robot_status.x, robot_status.y"
    )


def test_a_file_that_no_controller_writes_is_refused(tmp_path: Path) -> None:
    (tmp_path / "live").write_text("")
    with pytest.raises(Unusable, match="no controller writes this file now"):
        connect(MODEL, interface="virtual", channel="x", files=[tmp_path / "live"])


def test_the_shell_waits_for_states_and_shows_them(
    near: RemoteSystem, controller: Controller
) -> None:
    out = io.StringIO()
    shell = Shell(near, Console(file=out, width=80, highlight=False))
    controller.says(Mission="Homing")
    assert shell.do("status Mission joint_x.Motion")
    head, mission, motion = out.getvalue().splitlines()
    assert head.split() == ["chart", "age", "s", "state"]
    assert mission.split()[0] == "coordinator.Mission" and "Homing for " in mission
    assert motion.split()[0] == "joint_x.Motion" and "no active state" in motion
    later(0.1, controller, "Ready")
    assert shell.do("wait_for Mission Ready 2 s")
    assert shell.do("status")
    assert "Mission is Ready after " in out.getvalue()
    assert out.getvalue().splitlines()[-1].split()[2] == "Ready"


def test_the_answer_of_a_script_has_the_states(
    far: FarEnd,
    controller: Controller,
    request: pytest.FixtureRequest,
    monkeypatch: pytest.MonkeyPatch,
    capsys: PRINTED,
) -> None:
    controller.says(Mission="Ready")
    bus = ("--interface", "virtual", "--channel", request.node.name)
    monkeypatch.setattr("sys.stdin", io.StringIO("wait_for Mission Ready 2 s\n"))
    result = answered(capsys, "shell", MODEL, *bus, "--file", controller.path)["result"]
    assert result["commands"][0]["passed"]
    assert result["charts"].pop("coordinator.Mission") == "Ready"
    assert {*result["charts"].values()} == {None}


def test_a_file_without_an_interface_is_refused(tmp_path: Path, capsys: PRINTED) -> None:
    assert main(["shell", str(MODEL), "--file", str(tmp_path / "live")]) == 2
    assert "--file goes with --interface" in capsys.readouterr().err


@pytest.mark.parametrize("model", MODELS, ids=lambda path: path.parent.name)
def test_charts_have_the_names_and_states_of_the_trace(model: Path) -> None:
    system = system_of(model)
    traced = {
        element.name: element
        for path in (model.parent / "generated").rglob("trace.json")
        for element in read_map(path.read_text("utf-8")).of_kind("region")
    }
    charts = charts_of(system)
    assert [*charts] == [*traced]
    passed = {
        one.name
        for instance in system.instances
        for region in instance.component.regions
        for one in region.pseudostates
        if one.kind is not PseudoKind.TERMINATE
    }
    for name, chart in charts.items():
        leaves = {leaf for inside in chart.states.values() for leaf in inside}
        assert leaves == {*traced[name].leaves} - passed, name


def test_a_composite_state_is_any_of_its_leaves_in_its_region() -> None:
    charts = charts_of(system_of(PUMP))
    top = charts["bed.Infusion"].states
    assert "Sensor_Good" not in top and "Sensor_Good" in charts["bed.Infusion.Sensor"].states
    composites = {name: leaves for name, leaves in top.items() if leaves != {name}}
    assert composites
    for name, leaves in composites.items():
        assert leaves > set() and name not in leaves
    words = BusVocabulary.of(system_of(PUMP))
    assert words.chart("Motor") == words.chart("Infusion.Motor") == charts["bed.Infusion.Motor"]
