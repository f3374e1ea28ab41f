# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Devices with registers: started before the first release, made safe on every way to the end.

The simulated registers of tests/feature/registers write each change of a control or DAC register
to standard error; the driver that is tried is the one that is proved.
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest

from ravenchart.building import checking, generation, programs
from ravenchart.command_line import main
from ravenchart.failures import Refused
from ravenchart.paths import ROOT
from tests.support.faults import shows
from tests.support.stopped import raise_in

pytestmark = pytest.mark.live

CASE = ROOT / "tests" / "feature" / "registers"

FLOW = """\
        body:
          - {set: Far, to: "Get_Position.axis_1 > 20"}
          - {call: Set_Current, with: {axis_1: 10, axis_2: -10}}
"""

BODY = """\
{context}package body Registers_Feature.Servo.Activities
with SPARK_Mode => Off
is
   Turns : Natural := 0
   with Volatile;

   procedure Control
     (Get_Position     : Angle_X2;
      Far              : out Boolean;
      Set_Current      : out Current_X2;
      Call_Set_Current : out Boolean) is
   begin
      Turns := Turns + 1;
      if Turns = 5 then
         {fault}
      end if;
      Far := Get_Position.Axis_1 > 20;
      Set_Current := (Axis_1 => 10, Axis_2 => -10);
      Call_Set_Current := True;
   end Control;
end Registers_Feature.Servo.Activities;
"""

STARTED = [
    "LEFT_UNIT DAC 512",
    "LEFT_UNIT CONTROL 1",
    "RIGHT_UNIT DAC 512",
    "RIGHT_UNIT CONTROL 1",
]
DRIVEN = ["LEFT_UNIT DAC 522", "RIGHT_UNIT DAC 502"]
SAFE = [
    "LEFT_UNIT DAC 512",
    "LEFT_UNIT CONTROL 0",
    "RIGHT_UNIT DAC 512",
    "RIGHT_UNIT CONTROL 0",
]


def _built(folder: Path, change: dict[str, str] | None = None) -> Path:
    """The program of the case, with its model changed."""
    shutil.copytree(CASE, folder, dirs_exist_ok=True)
    model = folder / "model.yaml"
    text = model.read_text()
    for old, new in (change or {}).items():
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    model.write_text(text)
    checked = checking.check(model)
    generation.write_program(checked)
    return programs.programs_of(checked)[0].build(stacks_needed=False)  # one overflows


def _run(program: Path, seconds: float, **variables: str) -> tuple[int, list[str], list[str]]:
    """Exit status, changes of registers, and errors of a run that is asked to stop."""
    process = subprocess.Popen(
        [program], env={**os.environ, **variables}, stderr=subprocess.PIPE, text=True
    )
    try:
        _, said = process.communicate(timeout=seconds)
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGTERM)
        _, said = process.communicate(timeout=10)
    lines = said.splitlines()
    registers = [line for line in lines if "_UNIT " in line]
    return process.returncode, registers, [line for line in lines if line.startswith("error")]


@pytest.mark.slow
def test_devices_start_before_the_first_release_and_are_safe_behind_a_stop(tmp_path: Path) -> None:
    status, registers, errors = _run(_built(tmp_path), 1)
    assert (status, errors) == (0, [])
    assert registers == [*STARTED, *DRIVEN, *SAFE]


@shows(
    "a device fails its self-test",
    found_by="`Self_Test` of its driver, before the first release",
    reaction="no command acts, all devices are made safe, exit status 1; the device is named",
    within="5 s",
)
def test_a_failed_self_test_names_the_device_and_nothing_is_ever_driven(tmp_path: Path) -> None:
    program = _built(tmp_path)
    begun = time.monotonic()
    status, registers, errors = _run(program, 10, BROKEN_DRIVE="RIGHT_UNIT")
    assert time.monotonic() - begun < 5
    assert status == 1
    assert len(errors) == 1 and "the device Right has failed" in errors[0]
    # the DAC is in its middle already: making safe takes the enable bits back
    assert registers == [*STARTED, "LEFT_UNIT CONTROL 0", "RIGHT_UNIT CONTROL 0"]


FAULTS = {
    "a task that dies": ("", "raise Program_Error;", "fast has ended by PROGRAM_ERROR"),
    "a task that never ends its release": (
        "with Ada.Real_Time;\n\n",
        "delay until Ada.Real_Time.Time_Last;",
        "fast is silent",
    ),
    "a frame wider than the stack": (
        "",
        """declare
            procedure Wide;
            procedure Wide is
               Place : array (1 .. 20_000) of Natural with Volatile;
            begin
               Place (1) := Turns;
            end Wide;
         begin
            Wide;
         end;""",
        "fast has ended by STORAGE_ERROR: a stack overflow",
    ),
    "an access to memory that is not there": (
        "with System;\n\n",
        """declare
            Nothing : Natural
            with Import, Volatile, Address => System.Null_Address;
         begin
            Turns := Nothing;
         end;""",
        "fast has ended by STORAGE_ERROR: a stack overflow, or an access to memory",
    ),
}


@pytest.mark.slow
@shows(
    "a task dies, hangs or overflows its stack while its devices are driven",
    found_by="the fallback handler of task termination; liveness supervision",
    reaction="the main program makes the devices safe, exit status 1",
)
@pytest.mark.parametrize("fault", FAULTS)
def test_a_failure_of_a_task_makes_the_devices_safe(fault: str, tmp_path: Path) -> None:
    context, statement, reason = FAULTS[fault]
    shutil.copytree(CASE, tmp_path, dirs_exist_ok=True)
    body = tmp_path / "user" / "registers_feature-servo-activities.adb"
    body.write_text(BODY.replace("{fault}", statement).replace("{context}", context))
    change = {FLOW: "        writes: [Far]\n        calls: [Set_Current]\n        body: user\n"}
    status, registers, errors = _run(_built(tmp_path, change), 10)
    assert status == 1
    assert any(reason in line for line in errors), errors
    assert registers == [*STARTED, *DRIVEN, *SAFE]


@shows(
    "an exception in the main program while devices are driven",
    found_by="the last-chance handler",
    reaction="it makes the devices safe, exit status 1, with the reason",
    within="5 s",
)
def test_an_exception_in_the_main_program_makes_the_devices_safe(tmp_path: Path) -> None:
    process = subprocess.Popen([_built(tmp_path)], stderr=subprocess.PIPE, text=True)
    assert process.stderr is not None
    said = [process.stderr.readline() for _ in (*STARTED, *DRIVEN)]
    raise_in(process.pid, process.pid)
    rest = process.stderr.read()  # communicate() would not have what readline() has buffered
    assert process.wait(5) == 1
    assert [line.rstrip() for line in said] == [*STARTED, *DRIVEN]
    reason, *registers = rest.splitlines()
    assert reason.startswith("error: the main program has ended by CONSTRAINT_ERROR: ")
    assert registers == SAFE


@pytest.mark.slow
@shows(
    "a processor is silent, and the main program no longer runs",
    found_by="liveness supervision",
    reaction="the supervisor makes the devices safe and ends the process, exit status 1",
)
def test_a_supervisor_makes_devices_safe_where_the_main_program_cannot(tmp_path: Path) -> None:
    program = _built(tmp_path)
    generated = tmp_path / "generated"
    source = generated / "registers_feature_main.adb"
    # a main program that no longer runs, and processors that go on and count as silent
    text = source.read_text()
    assert text.count("   loop\n") == 1
    asleep = "   loop\n      delay until Ada.Real_Time.Time_Last;\n"
    source.write_text(text.replace("   loop\n", asleep))
    supervision = generated / "registers_feature-liveness_supervision.adb"
    text = supervision.read_text()
    assert text.count("Is_Silent :=") == 2
    supervision.write_text(text.replace("Is_Silent :=", "Is_Silent := Elapsed > 500_000_000 or"))
    home = {"RAVENCHART_BUILD": str(program.parents[1]), "CAN_DRIVER": "loopback", "MODE": "checks"}
    subprocess.run(
        ["gprbuild", "-q", "-p", "-P", "registers_feature.gpr"],
        cwd=generated,
        env={**os.environ, **home, "GPR_PROJECT_PATH": str(ROOT)},
        check=True,
    )
    for _ in range(8):  # a processor that lost its urgency goes on, wherever it lost it
        status, registers, errors = _run(program, 10)
        assert status == 1
        assert len(errors) == 3 and "did not end the controller in time" in errors[2], errors
        assert registers == [*STARTED, *DRIVEN, *SAFE]


def test_registers_of_the_hardware_need_an_address(tmp_path: Path) -> None:
    _built(tmp_path)
    with pytest.raises(Refused, match="the device Right has no address"):
        main_program = programs.programs_of(checking.check(tmp_path / "model.yaml"))[0]
        main_program.build(registers="hardware")


def test_registers_of_the_hardware_are_at_their_addresses(tmp_path: Path) -> None:
    right = "Right: {type: Drive, "
    _built(tmp_path, {right: f"{right}address: 0x4000_1000, "})
    program = programs.programs_of(checking.check(tmp_path / "model.yaml"))[0]
    built = program.build(registers="hardware")
    code = subprocess.run(["objdump", "-d", built], capture_output=True, text=True, check=True)
    for address in (0x4000_0000, 0x4000_0004, 0x4000_1008):
        assert f"0x{address:x}" in code.stdout, hex(address)


def test_a_simulation_starts_the_devices(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    shutil.copytree(CASE, tmp_path, dirs_exist_ok=True)
    events = tmp_path / "events.yaml"
    events.write_text("- {until: 300 ms}\n")
    given = ["simulate", str(tmp_path / "model.yaml"), "--events", str(events)]
    assert main(given) == 0
    assert "Tuned" in capsys.readouterr().out
    monkeypatch.setenv("BROKEN_DRIVE", "LEFT_UNIT")
    assert main(given) != 0
    assert "a device has not started" in capsys.readouterr().err
