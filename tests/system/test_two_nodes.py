"""The two nodes of the example: built, run on one bus, and cut off from each other."""

from __future__ import annotations

import io
import shutil
from pathlib import Path

import pytest
from rich.console import Console

from ravenchart import simulate, steps
from ravenchart.run import RunRequest, controller, run_model
from ravenchart.toolchain import ROOT

EXAMPLE = ROOT / "examples" / "two_nodes"
SERVO = "servo: {component: Linear_Servo, node: "


def copied(to: Path, node: str = "drive") -> steps.Checked:
    """The example with its servo on that node, and its program written."""
    to.mkdir()
    for source in EXAMPLE.glob("*.yaml"):
        shutil.copy(source, to)
    text = (to / "model.yaml").read_text()
    assert text.count(f"{SERVO}drive") == 1
    (to / "model.yaml").write_text(text.replace(f"{SERVO}drive", SERVO + node))
    checked = steps.check(to / "model.yaml")
    assert not checked.warnings
    steps.write_program(checked)
    return checked


@pytest.fixture(scope="module")
def checked(tmp_path_factory: pytest.TempPathFactory) -> steps.Checked:
    return copied(tmp_path_factory.mktemp("two_nodes") / "apart")


@pytest.mark.parametrize(("scenario", "chains"), [("scenario", True), ("cut_bus", False)])
def test_both_nodes_do_what_the_scenario_expects(
    checked: steps.Checked, tmp_path: Path, scenario: str, *, chains: bool
) -> None:
    controllers = tuple(controller(made) for made in steps.programs_of(checked))
    shown = io.StringIO()
    request = RunRequest(
        checked.analysis,
        controllers,
        checked.folder / "generated",
        checked.folder / f"{scenario}.yaml",
        0.0,
        tmp_path,
    )
    passed = run_model(request, Console(file=shown, width=80))
    assert passed, shown.getvalue()
    assert ("longest reactions of chains" in shown.getvalue()) == chains
    assert (tmp_path / "report.html").is_file()


def test_one_line_moves_the_servo_and_no_component_changes(
    checked: steps.Checked, tmp_path: Path
) -> None:
    one = copied(tmp_path / "together", "panel")
    apart, together = (c.folder / "generated" for c in (checked, one))
    assert [p.node for p in steps.programs_of(one)] == ["panel"]
    compared = 0
    for component, node in (("linear_servo", "drive"), ("traveller", "panel")):
        for source in (apart / node).glob(f"two_nodes-{component}*"):
            assert source.read_bytes() == (together / "panel" / source.name).read_bytes()
            compared += 1
    assert compared >= 8
    assert not list((together / "panel").glob("*link*"))
    steps.programs_of(one)[0].build()


def test_a_simulation_does_the_same_on_one_node_and_on_two(
    checked: steps.Checked, tmp_path: Path
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
