# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The two nodes of the example: built, run on one bus, and cut off from each other."""

from __future__ import annotations

import io
import json
import re
from collections.abc import Callable
from pathlib import Path

import can
import pytest
from rich.console import Console

from ravenchart.building import checking, generation, programs
from ravenchart.commands import simulate
from ravenchart.hw_can.bench.peer import Codec
from ravenchart.paths import ROOT
from ravenchart.running.controllers import controller
from ravenchart.running.result import RunOutcome
from ravenchart.running.runs import RunRequest, run_model
from tests.support import live
from tests.support.faults import shows
from tests.support.two_nodes import by_chart

pytestmark = pytest.mark.alone

EXAMPLE = ROOT / "examples" / "two_nodes"
SERVO = "servo: {component: Linear_Servo, node: "
STARTED = 2_000_000_000
"""Both nodes run by then, in ns; the scenarios disturb the bus later."""


def copied(
    to: Path, node: str = "drive", change: Callable[[str], str] = lambda text: text
) -> checking.Checked:
    """The example with its servo on that node, and its program written."""
    to.mkdir()
    for source in EXAMPLE.glob("*.yaml"):
        (to / source.name).write_text(change(source.read_text()))
    text = (to / "model.yaml").read_text()
    assert text.count(f"{SERVO}drive") == 1
    (to / "model.yaml").write_text(text.replace(f"{SERVO}drive", SERVO + node))
    checked = checking.check(to / "model.yaml")
    assert not checked.warnings
    generation.write_program(checked)
    return checked


@pytest.fixture(scope="module")
def checked(tmp_path_factory: pytest.TempPathFactory) -> checking.Checked:
    return copied(tmp_path_factory.mktemp("two_nodes") / "apart")


def played(checked: checking.Checked, scenario: str, to: Path) -> str:
    """What a run of the scenario prints, which must pass; its traces are in ``to``."""
    controllers = tuple(controller(made) for made in programs.programs_of(checked))
    shown = io.StringIO()
    request = RunRequest(
        checked.analysis,
        controllers,
        checked.folder / "generated",
        checked.folder / f"{scenario}.yaml",
        0.0,
        to,
    )

    def play() -> RunOutcome:
        shown.truncate(shown.seek(0))
        outcome = run_model(request, Console(file=shown, width=80))
        assert outcome is not None, shown.getvalue()
        return outcome

    assert live.played(play).passed, shown.getvalue()
    assert (to / "report.html").is_file()
    return shown.getvalue()


@pytest.mark.slow
@pytest.mark.parametrize(("scenario", "chains"), [("scenario", True), ("cut_bus", False)])
def test_both_nodes_do_what_the_scenario_expects(
    checked: checking.Checked, tmp_path: Path, scenario: str, *, chains: bool
) -> None:
    shown = played(checked, scenario, tmp_path)
    assert ("longest reactions of chains" in shown) == chains


@pytest.mark.slow
def test_a_run_of_several_nodes_writes_a_log_of_its_bus(
    checked: checking.Checked, tmp_path: Path
) -> None:
    """Whether the run passes is not asked: the host may be slow."""
    nodes = tuple(controller(made) for made in programs.programs_of(checked))
    log, generated = tmp_path / "bus.blf", checked.folder / "generated"
    request = RunRequest(checked.analysis, nodes, generated, None, 1.0, tmp_path, log)
    assert run_model(request, Console(file=io.StringIO())) is not None
    database = Codec.from_file(generated / "link.dbc")
    with can.LogReader(log) as reader:
        frames = list(reader)
    named = {one[0] for one in map(database.decode, frames) if one is not None}
    assert named == {"supervisor_order", "servo_report"}
    assert [f.timestamp for f in frames] == sorted(f.timestamp for f in frames)


def faults(to: Path, node: str) -> tuple[int, int]:
    """How often the controller of a node became error-passive and bus-off, as it reports."""
    counts = dict(re.findall(r"^H (\w+) (\d+)$", (to / f"trace-{node}.txt").read_text(), re.M))
    found = {kind.lower(): int(count) for kind, count in counts.items()}
    return found["can_error_passive"], found["can_bus_off"]


def noted(checked: checking.Checked, to: Path, node: str, kind: str, element: str) -> list[int]:
    """When the trace of a node notes something of an element, in ns."""
    folder = checked.folder / "generated" / node
    rows = json.loads((folder / "trace.json").read_text())["elements"]
    numbers = {str(row["id"]) for row in rows if row["element"] == element}
    lines = (line.split() for line in (to / f"trace-{node}.txt").read_text().splitlines())
    return [
        int(words[1])
        for words in lines
        if words[0] == "T" and words[2].lower() == kind and words[3] in numbers
    ]


@pytest.mark.slow
@shows(
    "the bus is cut between two nodes",
    found_by="the state of the CAN controller, read by `watch`; stale input",
    reaction="`on_error_passive`; the servo is safe, and follows when the bus is whole",
    within="100 ms from silence to the safe state",
)
def test_who_is_alone_is_error_passive_and_never_bus_off(
    checked: checking.Checked, tmp_path: Path
) -> None:
    played(checked, "cut_bus", tmp_path)
    # the bench acknowledges what the drive sends while the bus is cut
    for node, cut_off in (("panel", 1), ("drive", 0)):
        passive, off = faults(tmp_path, node)
        # whichever starts first is alone until the other does
        assert passive in (cut_off, cut_off + 1)
        assert off == 0
        found = noted(checked, tmp_path, node, "fault", f"{node}.link")
        assert len([at for at in found if at >= STARTED]) == cut_off


@pytest.mark.slow
@shows(
    "the bus is held dominant",
    found_by="the state of the CAN controller, read by `watch`",
    reaction="`on_error_passive` on both nodes; the safe state, and back",
    within="50 ms from silence to the safe state",
)
def test_a_bus_that_is_held_dominant_makes_both_error_passive(
    checked: checking.Checked, tmp_path: Path
) -> None:
    played(checked, "held_dominant", tmp_path)
    for node in ("panel", "drive"):
        # whichever starts first is alone until the other does, and then passive once more
        assert faults(tmp_path, node) in ((1, 0), (2, 0))
        found = noted(checked, tmp_path, node, "fault", f"{node}.link")
        assert len([at for at in found if at >= STARTED]) == 1


@pytest.mark.slow
@shows(
    "the bus is held recessive",
    found_by="the state of the CAN controller, read by `watch`",
    reaction="`on_bus_off` on both nodes, recovery after the given delay; the safe state, and back",
    within="70 ms from silence to the safe state; the event within 5 ms of the fault",
)
def test_a_bus_that_is_held_recessive_makes_both_bus_off_again_and_again(
    checked: checking.Checked, tmp_path: Path
) -> None:
    played(checked, "held_recessive", tmp_path)
    for node, component in (("panel", "supervisor"), ("drive", "servo")):
        _, off = faults(tmp_path, node)
        # 100 ms of delay from one to the next, and the look that finds it
        assert 10 <= off <= 20
        events = noted(checked, tmp_path, node, "raised", f"{component}.Bus_Failed")
        assert len(events) >= off
        # the event is raised by the look that finds the fault, and the chart takes it then
        found = noted(checked, tmp_path, node, "fault", f"{node}.link")
        assert len(found) >= off
        assert all(any(0 <= e - f < 5_000_000 for e in events) for f in found)


@pytest.mark.slow
@shows(
    "the bus is held recessive, and the chart has to request recovery",
    found_by="the state of the CAN controller, read by `watch`",
    reaction="both nodes recover when the charts request it, and no more often",
    within="200 ms between requests",
)
def test_charts_that_request_recovery_bring_both_nodes_back(tmp_path: Path) -> None:
    checked = copied(tmp_path / "asked", change=by_chart)
    out = tmp_path / "out"
    played(checked, "held_recessive", out)
    for node, component in (("panel", "supervisor"), ("drive", "servo")):
        asked = noted(checked, out, node, "raised", f"{component}.Rejoin")
        _, off = faults(out, node)
        # once in 200 ms: so often the node tries the bus again, and no oftener
        assert 5 <= len(asked) <= 15
        assert off <= len(asked) + 1


@pytest.mark.slow
def test_one_line_moves_the_servo_and_no_component_changes(
    checked: checking.Checked, tmp_path: Path
) -> None:
    one = copied(tmp_path / "together", "panel")
    apart, together = (c.folder / "generated" for c in (checked, one))
    assert [p.node for p in programs.programs_of(one)] == ["panel"]
    compared = 0
    for component, node in (("linear_servo", "drive"), ("traveller", "panel")):
        for source in (apart / node).glob(f"two_nodes-{component}*"):
            assert source.read_bytes() == (together / "panel" / source.name).read_bytes()
            compared += 1
    assert compared >= 8
    assert not list((together / "panel").glob("*link*"))
    programs.programs_of(one)[0].build()


@pytest.mark.slow
def test_a_simulation_does_the_same_on_one_node_and_on_two(
    checked: checking.Checked, tmp_path: Path
) -> None:
    one = copied(tmp_path / "together", "panel")
    events = tmp_path / "events.yaml"
    events.write_text("- {until: 3 s}\n")
    apart, together, interpreted = (
        simulate.simulated(which, events, interpreter=alone, as_json=False)
        for which, alone in ((checked, False), (one, False), (checked, True))
    )
    assert apart == together == interpreted
    assert "Homeward.entry" in apart


def test_a_simulation_raises_the_events_of_the_bus_from_its_events_file(
    checked: checking.Checked, tmp_path: Path
) -> None:
    events = tmp_path / "events.yaml"
    events.write_text(
        "- {at: 500 ms, raise: servo.Bus_Failed}\n"
        "- {at: 700 ms, raise: servo.Bus_Back}\n"
        "- {until: 1 s}\n"
    )
    simulated, interpreted = (
        simulate.simulated(checked, events, interpreter=alone, as_json=False)
        for alone in (False, True)
    )
    assert simulated == interpreted
    times = re.findall(r"^ *(\S+ \w+).*(Safe_Off_Bus\.(?:entry|exit))", simulated, re.M)
    assert [behaviour for _, behaviour in times] == ["Safe_Off_Bus.entry", "Safe_Off_Bus.exit"]
