# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Tasks that die or no longer end a release: seen, reported with the reason, and answered."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from ravenchart.analysis.system.observed import Observation
from ravenchart.building import checking, generation, programs, stacks
from ravenchart.command_line import main
from ravenchart.paths import ROOT
from ravenchart.running import runs as run
from ravenchart.running.controllers import controller
from ravenchart.running.result import RunOutcome
from tests.support.faults import shows
from tests.support.modes import MODES

pytestmark = [pytest.mark.live, pytest.mark.slow]

SECONDS = 2.0

BODY = """\
with Ada.Environment_Variables;
with Ada.Real_Time;
with Early;

package body Three_Components.Station.Activities
with SPARK_Mode => Off
is
   use type Ada.Real_Time.Time;
   use type Ravenchart.Number;

   Fault : constant Character :=
     Ada.Environment_Variables.Value ("RAVENCHART_TEST_FAULT", "none") (1);

   Turns : Natural := 0
   with Volatile;

   Busy_Until : Ada.Real_Time.Time := Ada.Real_Time.Time_First;

   function Deeper (Turn : Natural) return Natural;

   function Deeper (Turn : Natural) return Natural is
      Place : array (1 .. 1_000) of Natural := (others => Turn)
      with Volatile;
   begin
      Place (2) := Turn;
      return (if Turn = 0 then 0 else Deeper (Place (1) + 1) + Place (2));
   end Deeper;

   procedure Wide;

   procedure Wide is
      Place : array (1 .. 20_000) of Natural
      with Volatile;
   begin
      Place (1) := 1;
      Place (2) := Place (1);
   end Wide;
   --  More than all of the stack: its start is in that of another thread.

   procedure Work
     (Token_In     : Station.Token_In_View;
      Held         : out Three_Components.Token;
      Raise_Worked : out Boolean) is
   begin
      Turns := Turns + 1;
      if Turns = 10 and then Fault = 'a' then
         pragma Assert (Turns = 11);
      elsif Turns = 10 and then Fault = 'r' then
         raise Program_Error with "by hand";
      elsif Turns = 10 and then Fault = 'o' then
         Turns := Deeper (1);
      elsif Turns = 10 and then Fault = 'w' then
         Wide;
      elsif Turns = 10 and then Fault = 's' then
         delay until Ada.Real_Time.Time_Last;
      elsif Turns = 10 and then Fault = 'l' then
         while Turns = 10 loop
            null;
         end loop;
      elsif Turns = 10 and then Fault = 'b' then
         Busy_Until := Ada.Real_Time.Clock + Ada.Real_Time.Milliseconds (800);
         while Ada.Real_Time.Clock < Busy_Until loop
            null;
         end loop;
      end if;
      Held := Token'Min (Token_In.Value, 999) + 1;
      Early.Mark;
      Raise_Worked := True;
   end Work;
end Three_Components.Station.Activities;
"""

EARLY = """\
with Ada.Environment_Variables;

package body Early
with SPARK_Mode => Off
is
   procedure Mark is null;
begin
   if Ada.Environment_Variables.Value ("RAVENCHART_TEST_FAULT", "none")
     = "elaboration"
   then
      raise Program_Error with "in elaboration";
   end if;
end Early;
"""
"""A package of the user's that the binder elaborates before those of the runtime."""

WATCHED = re.compile(r" +(supervision|on_silence): .*\n")

OWN = re.compile(r"(        body:\n          - set: held.*?          - raise: Worked\n)", re.S)


@dataclass(frozen=True)
class Faulty:
    """The three components with a fault in a user's body: how a run of them ended."""

    result: RunOutcome
    fed: int

    @property
    def seen(self) -> Observation:
        """Its trace."""
        assert self.result.observation is not None
        return self.result.observation


Built = tuple[checking.Checked, programs.Program, Path]
"""A model, its program and the executable."""

Breaking = Callable[..., Faulty]


def _model(folder: Path) -> Path:
    """The example, with the work of a station in Ada; no stale files of it."""
    model = folder / "model.yaml"
    text, changed = OWN.subn("        body: user\n", model.read_text())
    assert changed == 1
    model.write_text(text)
    (folder / "user").mkdir()
    body = folder / "user" / "three_components-station-activities.adb"
    body.write_text(BODY)
    (folder / "user" / "early.ads").write_text(
        "package Early with SPARK_Mode => Off is\n   procedure Mark;\nend Early;\n"
    )
    (folder / "user" / "early.adb").write_text(EARLY)
    return model


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str, bool], Built]:
    """A function that builds the example with the faulty body once for each mode."""
    made: dict[tuple[str, bool], Built] = {}

    def build(mode: str, supervised: bool) -> Built:
        if (mode, supervised) not in made:
            folder = tmp_path_factory.mktemp("faulty") / "three_components"
            shutil.copytree(ROOT / "examples" / "three_components", folder)
            model = _model(folder)
            if not supervised:
                text, changed = WATCHED.subn("", model.read_text())
                assert changed == 3
                model.write_text(text)
            checked = checking.check(model)
            generation.write_program(checked)
            program = programs.programs_of(checked)[0]
            image = program.build(mode, stacks_needed=False)  # one fault is recursion
            made[mode, supervised] = checked, program, image
        return made[mode, supervised]

    return build


@pytest.fixture
def breaking(
    built: Callable[[str, bool], Built], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Breaking:
    """A function that runs the example with a fault in it."""

    def broken(fault: str, mode: str, *, supervised: bool = True) -> Faulty:
        checked, program, executable = built(mode, supervised)
        watchdog = tmp_path / "watchdog"
        watchdog.write_bytes(b"")
        monkeypatch.setenv("RAVENCHART_WATCHDOG", str(watchdog))
        monkeypatch.setenv("RAVENCHART_TEST_FAULT", fault)
        result = run.run_alone(
            executable,
            program.generated / "trace.json",
            SECONDS,
            tmp_path / "report",
            analysis=checked.analysis,
        )
        return Faulty(result, watchdog.stat().st_size)

    return broken


DEATHS = (
    ("assert", "checks", "ASSERTION_ERROR"),
    ("raise", "release", "PROGRAM_ERROR: by hand"),
)


@shows(
    "a task ends by an exception or a false assertion",
    found_by="the fallback handler of task termination",
    reaction="shutdown of the model, report, exit status 1; the verdict names task and reason",
    within="1 s, half of the run",
)
@pytest.mark.parametrize(("fault", "mode", "reason"), DEATHS)
def test_a_task_that_dies_ends_the_controller_with_its_name_and_its_reason(
    breaking: Breaking, fault: str, mode: str, reason: str
) -> None:
    found = breaking(fault, mode)
    assert found.result.ended.exit_code == 1
    first = found.result.failures[0]
    assert first.startswith("the controller stopped itself: processor_3 has ended by ")
    assert reason in first
    assert found.result.verdict.endswith(first)
    assert found.seen.complete  # the report is written on this way too
    assert found.seen.end < SECONDS * 1e9 / 2


@shows(
    "an endless loop in a user body",
    found_by="liveness supervision",
    reaction="`Silence` once, events of `on_silence`, no feeding of the watchdog, exit status 1",
    within="deadline + margin + one period of the supervision; 0.5 s more for a busy host",
)
@pytest.mark.parametrize("mode", MODES)
def test_an_endless_loop_is_found_once_and_answered_by_the_chart(
    breaking: Breaking, mode: str
) -> None:
    found = breaking("loop", mode)
    seen = found.seen
    assert found.result.ended.exit_code == 1
    assert "processor_3 is silent" in found.result.failures[0]
    assert seen.faults["Silence"] == 1
    faults = seen.of("fault", "processor_3")
    assert len(faults) == 1
    #  processor_1 is more urgent than the loop, and its chart has reacted
    assert "Alone" in seen.states_visited()["one.Watching"]
    alone = next(v.start for v in seen.visits("one.Watching") if v.state == "Alone")
    assert alone >= faults[0].time
    #  found within deadline, margin, a period of the supervision, and what a busy host takes
    counts = seen.processors["processor_3"]
    due = counts.releases * 10_000_000
    assert due + 260_000_000 <= faults[0].time <= due + 260_000_000 + 10_000_000 + 500_000_000
    #  from then on nothing feeds the watchdog
    assert seen.feeds == found.fed
    assert 0 < found.fed <= faults[0].time // 10_000_000


def test_a_processor_that_was_silent_and_comes_back_goes_on_in_the_grace(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "three_components"
    shutil.copytree(ROOT / "examples" / "three_components", folder)
    model = _model(folder)
    text = model.read_text()
    assert text.count("grace: 0 ms") == 1
    model.write_text(text.replace("grace: 0 ms", "grace: 1200 ms"))
    checked = checking.check(model)
    generation.write_program(checked)
    program = programs.programs_of(checked)[0]
    monkeypatch.setenv("RAVENCHART_TEST_FAULT", "busy")
    trace = program.generated / "trace.json"
    image = program.build(stacks_needed=False)
    result = run.run_alone(image, trace, SECONDS, tmp_path / "report")
    #  it has lost its urgency, but none of its protected objects
    assert "processor_3 is silent" in result.failures[0]
    assert not any("has ended" in failure for failure in result.failures), result.failures
    assert result.observation is not None
    fault = result.observation.of("fault", "processor_3")[0].time
    assert result.observation.processors["processor_3"].releases * 10_000_000 > fault


@shows(
    "a task that sleeps for ever, in a node without `supervision`",
    found_by="the verdict of a run: releases against elapsed time",
    reaction="the run fails",
)
def test_a_run_without_supervision_sees_that_releases_are_missing(breaking: Breaking) -> None:
    found = breaking("sleep", "checks", supervised=False)
    assert found.result.ended.exit_code == 0
    #  on a busy host others may have missed a deadline, but not a release
    (missing,) = (failure for failure in found.result.failures if "releases in" in failure)
    assert re.fullmatch(
        r"processor_3 completed \d+ releases in [\d.]+ s, but at least \d+ were due by then",
        missing,
    )


def test_the_command_fails_and_its_last_lines_have_the_reason(
    built: Callable[[str, bool], Built],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    model = built("checks", True)[0].path
    monkeypatch.setenv("RAVENCHART_TEST_FAULT", "assert")
    monkeypatch.setattr(programs.Program, "_examine", lambda *_: None)  # one fault is recursion
    monkeypatch.setattr(stacks, "kept", lambda _: None)
    assert main(["run", str(model), "--seconds", "2", "--report", str(tmp_path / "report")]) == 1
    last = capsys.readouterr().out.rstrip().splitlines()[-2:]
    assert any("verdict: FAIL" in line and "ASSERTION_ERROR" in line for line in last)


@shows(
    "a stack overflow, by depth or by one wide frame",
    found_by="the guard page of the stack; the fallback handler of task termination",
    reaction="shutdown of the model, report, exit status 1; the verdict names the task",
    within="1 s, half of the run",
)
@pytest.mark.parametrize("fault", ["overflow", "wide"])
@pytest.mark.parametrize("mode", MODES)
def test_a_stack_overflow_ends_the_task_and_the_controller_shuts_down(
    breaking: Breaking, fault: str, mode: str
) -> None:
    found = breaking(fault, mode)
    assert found.result.ended.exit_code == 1
    assert found.result.failures[0] == (
        "the controller stopped itself: processor_3 has ended by STORAGE_ERROR: a stack overflow,"
        " or an access to memory that the task does not have"
    )
    assert found.seen.complete
    assert found.seen.end < SECONDS * 1e9 / 2


@shows(
    "an exception in the elaboration of a package, a user's included",
    found_by="the last-chance handler",
    reaction="no task starts; exit status 1, with the reason",
    within="5 s",
)
@pytest.mark.parametrize("mode", MODES)
def test_an_exception_in_elaboration_ends_the_process(
    built: Callable[[str, bool], Built], mode: str
) -> None:
    _, _, executable = built(mode, True)
    for _ in range(5):
        ended = subprocess.run(
            [executable],
            env=os.environ | {"RAVENCHART_TEST_FAULT": "elaboration"},
            capture_output=True,
            text=True,
            timeout=5,
        )
        assert ended.returncode == 1
        assert ended.stderr == (
            "error: the main program has ended by PROGRAM_ERROR: in elaboration\n"
        )


@shows(
    "a sporadic task hangs with a frame in its hands",
    found_by="liveness supervision",
    reaction="`Silence` once, the chart ends the mission, the run fails",
)
def test_a_sporadic_processor_that_hangs_is_found_and_the_mission_ends(
    copy_of: Callable[[str], Path], tmp_path: Path
) -> None:
    """The reception of the Cartesian robot hangs, with a frame in its hands."""
    folder = copy_of("cartesian_robot")
    checked = checking.check(folder / "model.yaml")
    generation.write_program(checked)
    program = programs.programs_of(checked)[0]
    reception = program.generated / "cartesian_robot-reception.adb"
    text = reception.read_text()
    call = "            Robot_Bus.Receiver.Run_Receive (Executed);\n"
    assert text.count(call) == 1
    hang = "            delay until Ada.Real_Time.Time_Last;\n"
    reception.write_text(f"with Ada.Real_Time;\n{text.replace(call, call + hang)}")
    result = run.run_controller(
        program.build(),
        program.generated / "trace.json",
        program.generated / "robot_bus.dbc",
        folder / "scenario.yaml",
        5.0,
        tmp_path / "report",
        analysis=checked.analysis,
    )
    assert not result.passed
    assert "reception is silent" in result.failures[0]
    seen = result.observation
    assert seen is not None
    assert seen.faults["Silence"] == 1
    assert len(seen.of("fault", "reception")) == 1
    assert "Shut_Down" in seen.states_visited()["coordinator.Mission"]


@shows(
    "a false assertion in a task of the surgical robot",
    found_by="the fallback handler of task termination",
    reaction="exit status 1; the verdict names file and line",
)
def test_a_false_assertion_in_the_servo_of_the_surgical_robot_fails_the_run(
    copy_of: Callable[[str], Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = copy_of("surgical_robot")
    body = folder / "user" / "surgical_robot-servo-activities.adb"
    line = "      Call_Set_Current := True;\n"
    text = body.read_text()
    assert text.count(line) == 1
    body.write_text(text.replace(line, f"{line}      pragma Assert (Get_Velocity.Axis_1 > 9);\n"))
    told = ["run", str(folder / "model.yaml"), "--seconds", "2", "--report", str(tmp_path / "out")]
    assert main(told) == 1
    said = " ".join(capsys.readouterr().out.split())
    assert "verdict: FAIL: the controller stopped itself: servo_loop has ended by" in said
    assert "ASSERTION_ERROR: surgical_robot-servo-activities.adb" in said


@shows(
    "a task of one of two nodes ends by an exception",
    found_by="the fallback handler of task termination",
    reaction="the run of both fails",
)
def test_of_two_nodes_the_one_whose_task_dies_fails_the_run_of_both(
    copy_of: Callable[[str], Path], tmp_path: Path
) -> None:
    folder = copy_of("two_nodes")
    checked = checking.check(folder / "model.yaml")
    generation.write_program(checked)
    made = {one.node: one for one in programs.programs_of(checked)}
    table = made["drive"].generated / "two_nodes-control.adb"
    call = "      case Item is\n"
    text = table.read_text()
    assert text.count(call) == 1
    dies = """\
      if Item = Servo_Control then
         raise Program_Error with "here";
      end if;
"""
    table.write_text(text.replace(call, dies + call))
    result = run.run_nodes(
        [controller(one) for one in made.values()],
        checked.analysis,
        folder / "generated",
        None,
        2.0,
        tmp_path / "report",
    )
    assert result.failures[0] == (
        "the controller stopped itself: control has ended by PROGRAM_ERROR: here"
    )
    assert result.ended.exit_code == 1
