# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Commands bound to devices and tasks: what is generated, and what the analysis counts."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from ravenchart.analysis.present.figures import figures
from ravenchart.analysis.system.timing import analyse
from ravenchart.behaviour.rules import findings
from ravenchart.building import checking, generation
from ravenchart.commands import simulate
from ravenchart.failures import Refused
from ravenchart.gen.diagnostics import render
from ravenchart.gen.emit.program import generate, program, simulated_drivers, user_units
from ravenchart.gen.model.claims import Claims
from ravenchart.gen.model.commands import Device
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import Loaded, load
from ravenchart.paths import ROOT
from tests.support.systems import stops_of

MODEL = (ROOT / "tests" / "feature" / "devices" / "model.yaml").read_text()

SPEEDOMETER = {
    "device_types:": """device_types:
  Speedometer: {axes: 4, provides: {Get_Velocity: 7 us}}""",
    "  Arm: {array": """  Meter: {type: Speedometer}
  Measured: {facade: [Arm, Meter]}
  Arm: {array""",
    "servo_1.Joints, to: Arm": "servo_1.Joints, to: Measured",
}


def _loaded(text: str) -> Loaded:
    return load(Path("model.yaml"), lambda path, limit: text.encode())


def _system(changes: dict[str, str]) -> System:
    text = MODEL
    for old, new in changes.items():
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    made = _loaded(text)
    assert made.system is not None, "\n".join(
        render(item, made.sources) for item in made.diagnostics
    )
    return made.system


def _text(system: System) -> str:
    return "\n".join(made.item.text for made in program(system, Claims(), system))


def _wcets(system: System) -> dict[str, int]:
    return {slot.element: slot.timing.wcet for p in system.processors for slot in p.slots}


def test_the_work_of_devices_is_in_the_wcet_of_who_calls_them() -> None:
    us = {row: wcet / 1000 for row, wcet in _wcets(_system({})).items()}
    # the position of both boards; position and current of both; the force
    assert us["servo_1.Estimate"] == 50 + 2 * 10
    assert us["servo_1.Control"] == 100 + 2 * 10 + 2 * 15
    assert us["boss.Watch"] == 20 + 8
    # a step enables or disables both boards, once each at most
    assert us["boss.Power"] == 200 + 8 + 2 * 5 + 2 * 5


def test_a_region_may_call_in_each_of_its_steps() -> None:
    more = _wcets(_system({"        initial: Off": "        steps: 3\n        initial: Off"}))
    assert more["boss.Power"] == 200_000 + 8_000 + 3 * 20_000


def test_a_device_that_several_tasks_call_has_the_highest_of_their_priorities() -> None:
    system = _system({})
    levels = {p.name: p.priority for p in system.processors}
    board = system.object("Board_1")
    assert set(board.users) == {"fast", "slow"}
    assert board.ceiling == max(levels.values())
    assert board.section == 15_000  # its longest command
    assert not system.has_object("Sensor")  # one task calls it


def test_what_stands_in_is_there_while_nothing_provides_the_command() -> None:
    system = _system({})
    text = _text(system)
    assert "Estimated_Board.Read (Get_Velocity_Value);" in text
    assert any("estimate_fallback" in name for name in user_units(system))


def test_nothing_is_left_of_a_stand_in_where_the_command_is_provided() -> None:
    system = _system(SPEEDOMETER)
    text = _text(system)
    assert "Meter.Get_Velocity (Get_Velocity_Value);" in text
    for gone in ("Estimate", "Last_Own"):
        assert gone not in text
    assert not any("estimate" in name for name in user_units(system))
    assert "servo_1.Estimate" not in _wcets(system)
    assert _wcets(system)["servo_1.Control"] == 157_000


def test_the_user_sees_the_same_whatever_provides_a_command() -> None:
    files = [
        {made.unit.file_name: made.item.text for made in program(system, Claims(), system)}
        for system in (_system({}), _system(SPEEDOMETER))
    ]
    name = "devices_feature-servo-activities.ads"
    assert files[0][name] == files[1][name]


def test_a_call_that_nobody_has_to_take_is_no_call() -> None:
    assert "Call_Ring;" not in _text(_system({}))
    assert "if Call_Ring" not in _text(_system({}))
    bell = {
        "provides: {Get_Force: 8 us}": "provides: {Get_Force: 8 us, Ring: 1 us}",
        "servo_1.Joints, to: Arm": "servo_1.Joints, to: Robot",
    }
    assert "if Call_Ring_Asked then\n         Call_Ring;" in _text(_system(bell))


def test_a_facade_leaves_no_trace() -> None:
    system = _system({})
    assert [device.name for device in system.devices] == ["Board_1", "Board_2", "Arm", "Sensor"]
    assert "Robot" not in _text(system)


def test_arrays_may_be_made_of_arrays() -> None:
    zeros, more = ", initial: {", ", initial: {axis_5: 0, axis_6: 0, "
    six = {
        "  Arm: {array: [Board_1, Board_2]}": """  Board_3: {type: Io_Board}
  Pair: {array: [Board_1, Board_2]}
  Arm: {array: [Board_3, Pair]}""",
        "        axes: 4": "        axes: 6",
        f"Estimated: {{type: Speed_X4{zeros}": f"Estimated: {{type: Speed_X6{more}",
        f"Last: {{type: Angle_X4{zeros}": f"Last: {{type: Angle_X6{more}",
    }
    system = _system(six)
    text = _text(system)
    assert "Pair.Get_Position (Part_2);" in text
    arm = next(d for d in system.devices if d.name == "Arm")
    assert isinstance(arm, Device) and arm.axes == 6


def test_simulated_drivers_are_written_for_simulated_types_only() -> None:
    assert len(simulated_drivers(_system({}))) == 4
    own = {"  Force_Sensor:\n    body: simulated": "  Force_Sensor:\n    body: user"}
    system = _system(own)
    assert len(simulated_drivers(system)) == 2
    assert "user/devices_feature-force_sensor.adb" in user_units(system)


def test_types_may_be_used_by_their_axes_only_where_there_are_such() -> None:
    made = _loaded(MODEL.replace("type: Speed_X4", "type: Speed_X3"))
    assert any("no type named `Speed_X3`" in item.message for item in made.diagnostics)


@pytest.mark.parametrize("section", ["commands", "devices", "bindings", "device_types"])
def test_a_section_that_is_wrong_in_form_is_reported_once(section: str) -> None:
    lines = MODEL.splitlines()
    start = lines.index(f"{section}:")
    end = next(n for n in range(start + 1, len(lines)) if lines[n] and not lines[n].startswith(" "))
    made = _loaded("\n".join([*lines[:start], f"{section}: 7", *lines[end:]]) + "\n")
    errors = [item for item in made.diagnostics if item.is_error]
    assert [item.code for item in errors] == ["RV-0203"]


def test_generation_is_the_same_twice() -> None:
    system = _system({})
    claims = Claims()
    assert generate(system, claims) == generate(system, claims)


def test_a_command_may_give_anything_in_its_type() -> None:
    # the force begins at 0: a condition that 0 does not meet is no impossible one
    system = _system({"guard: Get_Force <= 50 and Peak <= 50": "guard: Get_Force > 50"})
    assert not findings(system)


def test_the_interpreter_refuses_a_model_with_bindings(tmp_path: Path) -> None:
    (tmp_path / "model.yaml").write_text(MODEL)
    checked = checking.check(tmp_path / "model.yaml")
    with pytest.raises(Refused) as refused:
        simulate.simulated(checked, tmp_path / "events", interpreter=True, as_json=False)
    line = MODEL.splitlines().index("bindings:") + 2
    path = tmp_path / "model.yaml"
    assert str(refused.value) == (
        f"{path}:{line}:5: error: the interpreter knows no drivers: it executes no models with "
        f"bindings [RV-1008]\n{path}:{line}:5: hint: leave out `--interpreter`: the program in "
        "virtual time has them"
    )


def test_a_simulated_device_is_the_users_once_it_is_written(tmp_path: Path) -> None:
    (tmp_path / "model.yaml").write_text(MODEL)
    checked = checking.check(tmp_path / "model.yaml")
    drivers = [tmp_path / name for name in simulated_drivers(checked.system)]
    drivers[0].parent.mkdir(parents=True)
    drivers[0].write_text("--  mine\n")
    generation.write_program(checked)
    assert drivers[0].read_text() == "--  mine\n"
    assert all("starting point" in driver.read_text() for driver in drivers[1:])
    drivers[1].write_text("--  mine, too\n")
    generation.write_program(checked)
    assert drivers[1].read_text() == "--  mine, too\n"


REQUESTS = (ROOT / "tests" / "feature" / "requests" / "model.yaml").read_text()


def _requests(*changes: tuple[str, str]) -> System:
    text = REQUESTS
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    made = _loaded(text)
    assert made.system is not None, [item.message for item in made.diagnostics]
    return made.system


def test_a_queue_of_requests_has_the_ceiling_of_callers_and_server() -> None:
    queue = _requests().object("mover_1.Motion.queue")
    assert set(queue.users) == {"moving", "planning", "pushing"}
    assert queue.ceiling == max(p.priority for p in _requests().processors)


def test_a_reply_that_nobody_takes_is_given_all_the_same() -> None:
    spec = "Home_Reply : out Requests_Feature.Outcome"
    text = " ".join(_text(_requests()).split())
    assert spec in text and " Home_Reply : Requests_Feature.Outcome;" in text
    alone = _requests(
        ("Home: {on_reply: Homed}", "Home: {}"),
        ("on: Homed, guard: event = Well", "after: 20 ms"),
        ("Homed: {type: Outcome}, ", ""),
    )
    text = " ".join(_text(alone).split())
    assert spec in text and " Unused_Home_Reply : Requests_Feature.Outcome;" in text


def test_a_reply_that_is_looked_at_has_a_board_and_others_have_none() -> None:
    system = _requests()
    assert set(system.object("boss_1.Get_Limit_Reply").users) == {"moving", "planning"}
    assert not system.has_object("boss_1.Home_Reply")
    text = _text(system)
    assert "Take_Get_Limit" in text and "Get_Limit_Reply_Board.Write (Reply);" in text


def test_who_serves_requests_calls_devices_for_each_of_them() -> None:
    called = _requests(
        ("  Mover:\n", "  Mover:\n    requires: {Stop: {commands: [Reset]}}\n"),
        ("        writes: [Goal]\n", "        writes: [Goal]\n        calls: [Reset]\n"),
        ("bindings:\n", "bindings:\n  - {from: mover_1.Stop, to: Brake_1}\n"),
    )
    assert _wcets(called)["mover_1.Serve"] == 100_000 + 2 * 4_000
    assert "moving" in called.object("Brake_1").users


def test_every_command_is_accounted_for_by_its_binding() -> None:
    found = json.loads(json.dumps(figures(analyse(_requests()))))["commands"]
    of = {(one["caller"], one["command"]): one for one in found}
    assert {key: one["how"] for key, one in of.items()} == {
        ("boss_1.Plan", "Set_Goal"): "queued",
        ("boss_1.Plan", "Hold"): "queued",
        ("boss_1.Plan", "Home"): "queued",
        ("boss_1.Plan", "Get_Limit"): "queued",
        ("boss_1.Plan", "Get_Place"): "copied",
        ("boss_1.Plan", "Reset"): "direct",
        ("hurry_1.Push", "Set_Goal"): "queued",
    }
    # the driver works in the WCET of its caller; a queue waits for the server's next execution
    assert of["boss_1.Plan", "Reset"]["wcet"] == 4_000
    assert of["boss_1.Plan", "Home"]["wcet"] == 0
    assert 20_000_000 < of["boss_1.Plan", "Home"]["executed"] < 26_000_000


def test_a_chain_goes_through_a_queue_of_requests() -> None:
    system = _requests(
        ("        while: Mood.Calm\n", ""),
        (
            "shutdown:",
            "chains:\n  push: {path: [hurry_1.Push, mover_1.Serve], reaction: 60 ms}\nshutdown:",
        ),
    )
    assert system.chains[0].way == stops_of("hurry_1.Push", "hurry_1.Set_Goal", "mover_1.Serve")
    reaction = analyse(system).limited[0][1].reaction
    # a push waits for the next execution of its server: longer than that takes, and no longer
    # than a period of each and the time that both need
    assert reaction is not None and 20_000_000 <= reaction <= 26_000_000


def test_a_published_item_leads_on_to_who_reads_the_command() -> None:
    chains = "chains:\n  seen: {path: [mover_1.Move, boss_1.Plan], age: 1 s}\nshutdown:"
    system = _requests(("shutdown:", chains))
    assert system.chains[0].way == stops_of("mover_1.Move", "mover_1.Now", "boss_1.Plan")


def test_caller_is_the_same_whether_a_command_is_queued_or_direct() -> None:
    direct = _requests(
        ("provides: {Reset: 4 us}", "provides: {Reset: 4 us, Set_Goal: 3 us}"),
        (
            "  - {from: hurry_1.Motion, to: mover_1.Motion}",
            "  - {from: hurry_1.Motion, to: Brake_1}",
        ),
    )
    files = [
        {made.unit.file_name: made.item.text for made in program(system, Claims(), system)}
        for system in (_requests(), direct)
    ]
    for unit in ("hurry.ads", "hurry-flows.ads", "hurry-flows.adb", "hurry-mood.adb"):
        name = f"requests_feature-{unit}"
        assert files[0][name] == files[1][name]
    spec = "procedure Call_Set_Goal (Item : Requests_Feature.Place) is"
    assert all(spec in one["requests_feature-hurry_1.adb"] for one in files)
