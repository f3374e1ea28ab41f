# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Device types with registers, parameters, operations at start and end, and events."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from ravenchart.building import checking, generation
from ravenchart.failures import Refused
from ravenchart.gen.diagnostics import render
from ravenchart.gen.emit.program import generate
from ravenchart.gen.model.claims import Claims
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import load
from ravenchart.paths import ROOT

MODEL = (ROOT / "tests" / "feature" / "registers" / "model.yaml").read_text()
SUPERVISION = "    supervision: {period: 10 ms, wcet: 50 us, margin: 250 ms}\n"


def _system(changes: dict[str, str]) -> System:
    text = MODEL
    for old, new in changes.items():
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    made = load(Path("model.yaml"), lambda path, limit: text.encode())
    assert made.system is not None, "\n".join(
        render(item, made.sources) for item in made.diagnostics
    )
    return made.system


def _refusal(changes: dict[str, str]) -> str:
    text = MODEL
    for old, new in changes.items():
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    made = load(Path("model.yaml"), lambda path, limit: text.encode())
    assert made.system is None
    return "\n".join(render(item, made.sources) for item in made.diagnostics)


def _file(system: System, name: str) -> str:
    return generate(system, Claims())[f"registers_feature{name}"]


def test_a_device_with_a_start_is_shared_with_the_main_program_and_the_supervisor() -> None:
    system = _system({})
    right = system.object("Right")
    assert right.users == ("fast", "main", "board.supervisor")
    supervisor = next(t for t in system.tasks if t.element == "board.supervisor")
    assert right.ceiling == supervisor.priority
    assert right.section == 30_000  # Calibrate is its longest


def test_making_safe_counts_among_the_longest_calls() -> None:
    longer = {"make_safe: 20 us": "make_safe: 80 us"}
    assert "longer than all of board.supervisor, 50 us" in _refusal(longer)
    system = _system(longer | {SUPERVISION: SUPERVISION.replace("50 us", "90 us")})
    assert system.object("Right").section == 80_000


def test_a_device_that_only_starts_is_not_shared_with_the_supervisor() -> None:
    system = _system({"    make_safe: 20 us\n": ""})
    assert system.object("Right").users == ("fast", "main")
    assert "Make_All_Safe" not in _file(system, "_main.adb")
    assert "Give_Up => Ravenchart.Failures.Give_Up" in _file(system, "-liveness_supervision.ads")


def test_the_main_program_makes_devices_safe_behind_the_grace_and_before_the_report() -> None:
    text = _file(_system({"grace: 0 ms": "grace: 50 ms"}), "_main.adb")
    grace, safe = text.index("for Unused in 1 .. 10"), text.index("Make_All_Safe")
    assert grace < safe < text.index("Reports.Put_All")


def test_the_supervisor_makes_devices_safe_before_it_ends_the_program() -> None:
    system = _system({})
    assert "Give_Up => Give_Up" in _file(system, "-liveness_supervision.ads")
    text = _file(system, "-liveness_supervision.adb")
    body = text[text.index("procedure Give_Up is") :]
    assert 0 < body.index("Device_Lifecycle.Make_All_Safe;") < body.index("Failures.Give_Up;")


def test_without_supervision_there_is_none_to_take_the_main_programs_place() -> None:
    system = _system({SUPERVISION: ""})
    assert system.object("Right").users == ("fast", "main")
    assert "Make_All_Safe" in _file(system, "_main.adb")


def test_a_simulated_driver_has_no_registers_and_no_parameters() -> None:
    files = generate(_system({"    body: user\n": "    body: simulated\n"}), Claims())
    assert not [name for name in files if "registers.ad" in name or "units" in name]
    spec = files["registers_feature-drive.ads"]
    assert "Unit" not in spec and "Global => null" in spec
    assert "RAVENCHART_REGISTERS" not in files["registers_feature.gpr"]


def test_the_value_of_a_parameter_is_that_of_the_device_or_the_default() -> None:
    text = _file(_system({}), "-drive_units.ads")
    assert "(Left_Unit => 4, Right_Unit => 8)" in text
    assert "(Left_Unit => Registers_Feature.Forward," in text
    assert "Right_Unit => Registers_Feature.Backward)" in text


def test_each_register_is_at_the_address_of_its_device_and_its_offset() -> None:
    text = _file(_system({}), "-drive_registers.ads")
    assert "Read_Dac" not in text and "Write_Status" not in text
    files = generate(_system({}), Claims())
    body = files["hardware/registers_feature-drive_registers.adb"]
    for name, address in (("Control", "0000"), ("Status", "0002"), ("Dac", "0008")):
        at = body.index(f"Left_{name} : ")
        assert f"To_Address (16#4000_{address}#)" in body[at : at + 200]
    assert "Right_Dac : Interfaces.Unsigned_32 := 0 with Atomic;" in body


def test_asking_for_an_event_is_in_the_wcet_of_the_port_handler() -> None:
    system = _system({})
    (slot,) = (s for p in system.processors for s in p.slots if s.element == "tuner_1.ports")
    assert slot.timing.wcet == 20_000 + 5_000
    assert "slow" in system.object("Left").users
    assert "Left.Limit_Reached (Told_Told_Now, Told_Told);" in _file(system, "-tuner_1.adb")


def test_an_array_has_no_events_of_its_members() -> None:
    told = _refusal({"{from: tuner_1.Joint, to: Left}": "{from: tuner_1.Joint, to: Both}"})
    assert "Both does not provide the event Limit_Reached" in told


def test_an_event_of_another_number_of_axes_is_refused() -> None:
    per_axis = "argument: Angle, per_axis: true}\n  Calibrate"
    told = _refusal(
        {
            "argument: Angle}\n  Calibrate": per_axis,
            "    body: user\n": "    axes: 2\n    body: simulated\n",
            "axes: 2, commands": "axes: 4, commands",
            "{axis_1: 10, axis_2: -10}": "{axis_1: 1, axis_2: 1, axis_3: 1, axis_4: 1}",
        }
    )
    assert "[RV-1205]" in told and "Limit_Reached of Left carries Angle_X2" in told


@pytest.mark.parametrize("supervised", [True, False])
def test_the_certificate_of_such_a_model_holds(supervised: bool, tmp_path: Path) -> None:
    (tmp_path / "model.yaml").write_text(MODEL if supervised else MODEL.replace(SUPERVISION, ""))
    generation.write_program(checking.check(tmp_path / "model.yaml"))
    text = (tmp_path / "generated" / "registers_feature-timing_certificate.ads").read_text()
    assert "Right_Section" in text


BUS = (
    "buses:\n  line: {bit_rate: 500 kbit/s, driver_wcet: 40 us, receive_depth: 8,"
    " transmit_depth: 8WATCH}\nnodes:\n"
)


def test_a_bus_that_nothing_uses_has_no_code(tmp_path: Path) -> None:
    for name, text in (
        ("with", MODEL.replace("nodes:\n", BUS.replace("WATCH", ""))),
        ("without", MODEL),
    ):
        (tmp_path / name).mkdir()
        (tmp_path / name / "model.yaml").write_text(text)
        generation.write_program(checking.check(tmp_path / name / "model.yaml"))
    units = {
        name: {one.name for one in (tmp_path / name / "generated").glob("*.ad?")}
        for name in ("with", "without")
    }
    assert units["with"] == units["without"]
    assert (tmp_path / "with" / "generated" / "line.dbc").exists()


def test_a_watched_bus_that_nothing_uses_has_no_program(tmp_path: Path) -> None:
    watched = BUS.replace("WATCH", ", watch: {period: 20 ms, wcet: 50 us}")
    text = MODEL.replace("nodes:\n", watched)
    text = re.sub(r"(activities: \[)", r"\1line.watch, ", text, count=1)
    (tmp_path / "model.yaml").write_text(text)
    with pytest.raises(Refused, match=r"sends and receives nothing on line .RV-0804"):
        generation.write_program(checking.check(tmp_path / "model.yaml"))
