# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The surgical robot in all its deployments: one application, whatever the equipment."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from ravenchart.building import checking, generation, programs, written
from ravenchart.command_line import main
from ravenchart.gen.emit.program import generate
from ravenchart.paths import ROOT
from ravenchart.proof import proving
from ravenchart.tools import toolchain

HERE = ROOT / "examples" / "surgical_robot"
LINE = "Robot: {facade: [Boards, Wrist]}"

SENSED = {
    "position, velocity and force": ("[Boards, Speeds, Wrist]", set()),
    "position and force": ("[Boards, Wrist]", {"Differ"}),
    "position and velocity": ("[Boards, Speeds]", {"Presume"}),
    "position": ("[Boards]", {"Differ", "Presume"}),
    "velocity and force": ("[Amplifiers, Speeds, Wrist]", {"Follow"}),
    "velocity": ("[Amplifiers, Speeds]", {"Follow", "Presume"}),
    "force": ("[Amplifiers, Wrist]", {"Follow", "Differ"}),
    "position by the tracker": ("[Amplifiers, Camera]", {"Differ", "Presume"}),
}
"""What the facade of the robot is then, and which stand-ins are needed."""

STAND_INS = {"Follow", "Differ", "Presume"}

LONG = "RAVENCHART_LONG_TESTS" in os.environ

Variant = Callable[[str, str, str], checking.Checked]


@pytest.fixture
def variant(tmp_path: Path) -> Variant:
    """The example with one line of one file changed."""

    def make(file: str, old: str, new: str) -> checking.Checked:
        folder = tmp_path / "robot"
        shutil.copytree(HERE, folder)
        text = (folder / file).read_text()
        assert text.count(old) == 1
        (folder / file).write_text(text.replace(old, new))
        return checking.check(folder / "model.yaml")

    return make


def _sources(checked: checking.Checked, *names: str) -> dict[str, str]:
    generated = checked.folder / "generated"
    return {name: (generated / f"surgical_robot-{name}").read_text() for name in names}


def _bodies(folder: Path) -> dict[str, bytes]:
    """What the user wrote."""
    found = (folder / "user").rglob("*.ad*")
    return {str(path.relative_to(folder)): path.read_bytes() for path in found}


@pytest.mark.slow
@pytest.mark.parametrize("sensed", SENSED)
def test_every_way_to_sense_is_built_with_its_stand_ins_only(sensed: str, variant: Variant) -> None:
    members, needed = SENSED[sensed]
    checked = variant("software_control.yaml", LINE, f"Robot: {{facade: {members}}}")
    assert not checked.warnings
    written = generation.write_program(checked)
    assert written.untouched == ()
    programs.programs_of(checked)[0].build()
    everything = "\n".join(
        path.read_text() for path in (checked.folder / "generated").glob("*.ad[sb]")
    )
    assert {name for name in STAND_INS if name in everything} == needed


def test_the_application_is_the_same_whatever_is_sensed(tmp_path: Path) -> None:
    seen = []
    names = ("servo.ads", "servo-activities.ads", "supervisor.ads", "supervisor-task_of_arm.adb")
    for number, (members, _) in enumerate(SENSED.values()):
        folder = tmp_path / str(number)
        shutil.copytree(HERE, folder)
        file = folder / "software_control.yaml"
        file.write_text(file.read_text().replace(LINE, f"Robot: {{facade: {members}}}"))
        checked = checking.check(folder / "model.yaml")
        generation.write_program(checked)
        seen.append(_sources(checked, *names))
        users = {
            path.relative_to(folder): path.read_bytes() for path in folder.rglob("user/**/*.ad*")
        }
        assert users == {
            path.relative_to(HERE): path.read_bytes() for path in HERE.rglob("user/**/*.ad*")
        }
    assert all(one == seen[0] for one in seen)


@pytest.mark.slow
@pytest.mark.parametrize("level", ["supervisory_control.yaml", "interface_only.yaml"])
def test_the_level_of_control_is_chosen_by_a_line(level: str, variant: Variant) -> None:
    checked = variant("model.yaml", "software_control.yaml", level)
    generation.write_program(checked)
    programs.programs_of(checked)[0].build()
    units = {path.name for path in (checked.folder / "generated").glob("*.ads")}
    assert "surgical_robot-drives.ads" in units
    assert "surgical_robot-servo_1.ads" not in units


DEPLOYMENTS = [
    *(("software_control.yaml", LINE, f"Robot: {{facade: {m}}}") for m, _ in SENSED.values()),
    ("model.yaml", "software_control.yaml", "supervisory_control.yaml"),
    ("model.yaml", "software_control.yaml", "drive_over_can.yaml"),
    ("model.yaml", "software_control.yaml", "interface_only.yaml"),
]


@pytest.mark.skipif(not LONG, reason="minutes of proof each: `make test-long` proves them all")
@pytest.mark.parametrize(
    "change", DEPLOYMENTS, ids=[*SENSED, "drives", "drive over CAN", "interface only"]
)
def test_every_deployment_is_proved(change: tuple[str, str, str], variant: Variant) -> None:
    if not toolchain.have("gnatprove"):
        pytest.skip(toolchain.INSTALL_HINT["gnatprove"])
    checked = variant(*change)
    generation.write_program(checked)
    (made,) = programs.programs_of(checked)
    driver = programs.default_driver(checked)
    proof = proving.prove(made.proof(driver, warnings="error"))
    assert proof.clean, proof.summary()
    assert proof.results.outside == ()
    assert proof.results.checks > 100


def test_the_supervisor_is_the_same_over_its_own_servo_loop_and_over_drives(
    tmp_path: Path,
) -> None:
    names = ("supervisor.ads", "supervisor-task_of_arm.ads", "supervisor-task_of_arm.adb")
    seen: list[dict[str, str]] = []
    glue: list[str] = []
    for level in ("software_control.yaml", "supervisory_control.yaml"):
        folder = tmp_path / level
        shutil.copytree(HERE, folder)
        model = folder / "model.yaml"
        model.write_text(model.read_text().replace("software_control.yaml", level))
        checked = checking.check(model)
        generation.write_program(checked)
        seen.append(_sources(checked, *names))
        glue += _sources(checked, "supervisor_1.adb").values()
    assert seen[0] == seen[1]
    assert "Servo_1.Put_Motion" in glue[0] and "Drives.Hold;" in glue[1]


@pytest.mark.slow
def test_a_drive_over_can_replaces_the_servo_by_a_line(
    variant: Variant, capsys: pytest.CaptureFixture[str]
) -> None:
    checked = variant("model.yaml", "software_control.yaml", "drive_over_can.yaml")
    assert not checked.warnings
    assert generation.write_program(checked).untouched == ()
    (made,) = programs.programs_of(checked)
    made.build()
    generated = checked.folder / "generated"
    application = ("supervisor.ads", "supervisor-task_of_arm.ads", "supervisor-task_of_arm.adb")
    here = {
        name: (HERE / "generated" / f"surgical_robot-{name}").read_text() for name in application
    }
    assert _sources(checked, *application) == here
    assert _bodies(checked.folder) == _bodies(HERE)
    assert not list(generated.glob("*servo*"))
    assert "Drive_1.Put_Motion" in (generated / "surgical_robot-supervisor_1.adb").read_text()
    flows = (generated / "surgical_robot-can_drive-flows.ads").read_text()
    assert " Seen : out Surgical_Robot.Angle_X4" in " ".join(flows.split())  # field by field
    #  the servo's body lies there, and is no part of what is proved
    proved = made.proved_units()
    assert "surgical_robot-can_drive-activities.adb" in proved
    assert not [name for name in proved if "servo" in name]
    #  what the drive reports is the position that the supervisor waits for
    events = checked.folder / "events.yaml"
    moved = "{axis_1: 290, axis_2: -300, axis_3: 100, axis_4: 0}"
    events.write_text(
        f"- {{at: 500 ms, put: drive_1.Positions, value: {moved}}}\n- {{until: 1 s}}\n"
    )
    assert main(["simulate", str(checked.path), "--events", str(events)]) == 0
    *_, last = capsys.readouterr().out.splitlines()
    assert last == "0.500 supervisor_1.Task_Of_Arm: Reaching.exit, there.effect, Holding.entry"


def test_generated_files_are_those_in_the_repository() -> None:
    checked = checking.check(HERE / "model.yaml")
    made = generate(checked.system, generation.claims(checked))
    home = HERE / "generated"
    files = (p for p in home.rglob("*") if p.is_file())
    there = {p.relative_to(home).as_posix(): p.read_text() for p in files}
    assert made == {name: text for name, text in there.items() if name != written.MANIFEST}
