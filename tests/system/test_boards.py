# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Whole controllers on an emulated board, with a run-time library of the user.

They need what RAVENCHART_RTS names, a cross compiler and QEMU: see docs/boards.md.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from ravenchart import command_line
from ravenchart.analysis.system.observed import read_map, read_trace
from ravenchart.building import checking, programs, stacks, targets
from ravenchart.commands.simulate import interpreted
from ravenchart.failures import Unusable
from ravenchart.paths import ROOT
from ravenchart.running import boards
from ravenchart.stacks import symbols
from ravenchart.stacks.report import Stack
from ravenchart.tools import toolchain
from tests.support import board_stacks
from tests.support.interpreted import stimuli_of, system_of
from tests.system.test_logical_feature import MODELS as LOGICAL

EXAMPLES = ("three_components", "crossing", "pump", "surgical_robot", "cartesian_robot")
BOARD = "zynqmp"
OBSERVED = re.compile(r"^(\w+) +(\d+) +0 +[\d.]+ +[\d.]+ +[\d.]+ % +ok$", re.M)
"""A processor that met all its deadlines, within its bound."""


BUSY = """\
      for Turn in 1 .. {turns} loop
         Work := (Work * 3 + Turn) mod 8_191;
      end loop;
"""


@pytest.fixture(scope="module", autouse=True)
def board() -> targets.Board:
    """The board, or the reason why nothing here can run."""
    try:
        made = targets.board(targets.target(BOARD), None)
    except Unusable as missing:
        pytest.skip(str(missing))
    emulator = made.target.facts.emulator
    assert emulator is not None
    if not toolchain.have(emulator.command[0]):
        pytest.skip(f"{emulator.command[0]} is not on PATH; {emulator.hint}")
    return made


def run(example: str, report: Path, capsys: pytest.CaptureFixture[str], seconds: str) -> str:
    """Run an example on the board; what is printed."""
    words = ["run", str(ROOT / "examples" / example / "model.yaml"), "--target", BOARD]
    status = command_line.main([*words, "--seconds", seconds, "--report", str(report)])
    printed = capsys.readouterr()
    assert status == 0, printed.out + printed.err
    return printed.out


@pytest.mark.parametrize("example", EXAMPLES)
def test_every_bound_holds_on_the_board(
    example: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    printed = run(example, tmp_path, capsys, "2")
    assert "verdict: PASS" in printed
    assert OBSERVED.findall(printed)
    assert "withheld" not in printed


def test_no_stack_is_deeper_than_its_bound(board: targets.Board, tmp_path: Path) -> None:
    checked = checking.check(ROOT / "examples" / "cartesian_robot" / "model.yaml")
    program = programs.programs_of(checked)[0]
    image = program.build("release", board=board)
    listing = subprocess.run(
        [f"{board.compiler}-nm", "-S", image], capture_output=True, text=True, check=True
    )
    found = symbols.read(listing.stdout)
    emulator = board.target.facts.emulator
    assert emulator is not None
    words = boards.command(board, emulator, image, tmp_path / "serial.txt", 3_600.0)
    end = max(one.at + one.size for one in found if one.kind in "bB" and one.size)
    used = board_stacks.depths(board_stacks.memory_after(words, 10.0, end, tmp_path), found)
    bounds = {one.task: one for one in stacks.kept(image).stacks}
    tasks = {f"cartesian_robot__{n}__processor__processorTKB": n for n in
             ("reception", "trajectory", "control", "supervision")}  # fmt: skip
    assert tasks.keys() <= used.keys()
    for body, task in tasks.items():
        assert 256 < used[body] <= bounds[task].bound, (task, used[body], bounds[task].bound)
        assert bounds[task].path[-1].function != "the run-time library"  # its code is counted
    found_size, bound = bounds["interrupts"].size, bounds["interrupts"].bound
    assert found_size in (8_192, 32_768)  # of the run-time libraries of GNAT 12 and 15
    assert bound is not None and bound <= found_size


def test_the_driver_of_a_can_controller_against_a_peer(
    board: targets.Board, tmp_path: Path
) -> None:
    variables = {**board.scenario(), "CAN_DRIVER": "xilinx", "RAVENCHART_BUILD": str(tmp_path)}
    options = [*board.options(), "-p", "-q", "-P", "can_driver.gpr"]
    toolchain.run("gprbuild", options, ROOT / "tests" / "board", variables)
    emulator = board.target.facts.emulator
    assert emulator is not None
    report = tmp_path / "serial.txt"
    words = boards.command(board, emulator, tmp_path / "can_driver", report, 1.0)
    done = subprocess.run(words, capture_output=True, timeout=120, check=False)
    facts = report.read_text(encoding="ascii").splitlines()
    assert (done.returncode, len(facts)) == (0, 5), facts
    assert [fact for fact in facts if not fact.startswith("ok ")] == []


def test_an_exception_ends_the_controller_with_its_task_and_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    home = tmp_path / "robot"
    shutil.copytree(ROOT / "examples" / "cartesian_robot", home)
    body = home / "user" / "cartesian_robot-joint-activities.adb"
    text = body.read_text(encoding="utf-8")
    counter = "   Calls : Natural := 0;\n\n   Steps_Per_Second : constant"
    text = text.replace("   Steps_Per_Second : constant", counter, 1)
    before, behind = text.split("   procedure Position_Control", 1)
    thrown = (
        "begin\n      Calls := Calls + 1;\n      if Calls > 200 then\n         raise Program_Error;"
    )
    behind = behind.replace("begin\n", f"{thrown}\n      end if;\n", 1)
    text = f"{before}   procedure Position_Control{behind}"
    body.write_text(text, encoding="utf-8")
    line = 1 + text.splitlines().index("         raise Program_Error;")
    status = command_line.main(["run", str(home / "model.yaml"), "--target", BOARD])
    printed = " ".join(capsys.readouterr().out.split())
    assert status == 1
    assert (
        "the controller stopped itself: control has ended by an exception: "
        f"cartesian_robot-joint-activities.adb:{line}"
    ) in printed


def test_three_runs_are_the_same_bytes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    traces = []
    for number in range(3):
        run("three_components", tmp_path / str(number), capsys, "2")
        traces.append((tmp_path / str(number) / "serial.txt").read_bytes())
    assert len(traces[0].splitlines()) > 1_000
    assert traces[0] == traces[1] == traces[2]
    lines = traces[0].decode("ascii").splitlines()
    reports = [int(line.split()[1]) // 10**9 for line in lines if line.startswith("N ")]
    assert reports == [1, 2]  # one each second, the last one at the end
    assert len([line for line in lines if line.startswith("P ")]) == 2 * 3


def busy(home: Path, turns: int) -> None:
    """Make an activity of the robot longer by so many turns of a loop."""
    shutil.copytree(ROOT / "examples" / "cartesian_robot", home)
    body = home / "user" / "cartesian_robot-joint-activities.adb"
    text = body.read_text(encoding="utf-8")
    work = "   Work : Integer := 0 with Export;\n\n   Steps_Per_Second : constant"
    text = text.replace("   Steps_Per_Second : constant", work, 1)
    before, behind = text.split("   procedure Position_Control", 1)
    behind = behind.replace("   begin\n", f"   begin\n{BUSY.format(turns=turns)}", 1)
    body.write_text(f"{before}   procedure Position_Control{behind}", encoding="utf-8")


def times(home: Path, capsys: pytest.CaptureFixture[str]) -> tuple[int, dict[str, int]]:
    """The longest execution times on the board, in ns; the exit status before them."""
    words = ["measure", str(home / "model.yaml"), "--target", BOARD, "--seconds", "1", "--json"]
    status = command_line.main(words)
    rows = json.loads(capsys.readouterr().out)["result"]["measurement"]["rows"]
    return status, {one["row"]: one["measured"] for one in rows}


def test_a_longer_activity_is_measured_and_its_overrun_fails_the_run(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    row, wcet = "joint_x.position_control", 150_000
    busy(tmp_path / "none", 1)
    busy(tmp_path / "some", 1_000)
    assert times(tmp_path / "none", capsys) == times(tmp_path / "none", capsys)
    (first, base), (_, longer) = (times(tmp_path / name, capsys) for name in ("none", "some"))
    assert first == 0
    each = (longer[row] - base[row]) / 1_000
    assert each > 4  # an instruction of the loop takes 4 ns
    others = [name for name, time in base.items() if time and "position_control" not in name]
    apart = {name: abs(base[name] - longer[name]) for name in others}
    assert max(apart.values()) < each * 100, apart  # of the loop nothing is in them
    turns = {share: int((wcet * share - base[row]) / each) for share in (0.9, 1.1)}
    for share, count in turns.items():
        home = tmp_path / str(share)
        busy(home, count)
        report = home / "report"
        words = ["run", str(home / "model.yaml"), "--target", BOARD, "--seconds", "1"]
        status = command_line.main([*words, "--report", str(report)])
        printed = " ".join(capsys.readouterr().out.split())
        page = (report / "report.html").read_text(encoding="utf-8")
        if share < 1:
            assert (status, f"{row} ran" in printed) == (0, False), printed
            assert f"<td>{row}</td>" in page
        else:
            assert (status, f"{row} ran for" in printed) == (1, True)
            assert "above its WCET of 150 us" in printed
            assert f"{row} ran for 16" in printed  # 165 us and what the loop cannot hit
            assert f'<tr class="miss"><td>{row}</td>' in page


# --- Scenarios: the bench is in the time of the board ----------------------------------


def play(
    scenario: Path,
    report: Path,
    capsys: pytest.CaptureFixture[str],
    example: str = "cartesian_robot",
) -> tuple[int, str]:
    """Play a scenario with an example on boards; the exit status and what is printed."""
    model = ROOT / "examples" / example / "model.yaml"
    words = ["run", str(model), "--target", BOARD, "--scenario", str(scenario)]
    status = command_line.main([*words, "--report", str(report)])
    printed = capsys.readouterr()
    return status, printed.out + printed.err


def test_the_demo_of_the_robot_passes_on_the_board_and_is_the_same_each_time(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scenario = ROOT / "examples" / "cartesian_robot" / "scenario.yaml"
    runs = []
    for number in range(2):
        home = tmp_path / str(number)
        status, printed = play(scenario, home, capsys)
        assert status == 0, printed
        assert "verdict: PASS\n" in printed  # and the timing was judged
        assert len(OBSERVED.findall(printed)) == 4
        page = (home / "report.html").read_text(encoding="utf-8")
        assert "controller: target zynqmp, mode release" in page  # its stacks and memory
        runs.append([(home / name).read_bytes() for name in ("serial.txt", "positions.png")])
    assert len(runs[0][0].splitlines()) > 20_000
    assert runs[0] == runs[1]


def test_a_bench_that_falls_silent_stops_the_robot_on_the_board(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scenario = ROOT / "examples" / "cartesian_robot" / "lost_bench.yaml"
    status, printed = play(scenario, tmp_path, capsys)
    assert status == 0, printed
    assert "trace: joint_x.Motion in Drive" in printed


def test_a_scenario_that_does_not_hold_fails_the_run_on_the_board(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scenario = tmp_path / "wrong.yaml"
    scenario.write_text(
        "scenario: Ready without a command\nsteps:\n"
        "  - {wait_for: robot_status.condition, is: Ready, within: 200 ms}\n",
        encoding="utf-8",
    )
    status, printed = play(scenario, tmp_path / "report", capsys)
    text = " ".join(printed.split())
    assert status == 1
    assert "verdict: FAIL: wait for robot_status.condition = Ready: not within 0.2 s" in text
    assert "the trace is cut off" not in text  # the controller has ended by itself


def test_two_boards_on_one_bus_pass_their_scenario_and_are_the_same_each_time(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scenario = ROOT / "examples" / "two_nodes" / "scenario.yaml"
    runs = []
    for number in range(2):
        home = tmp_path / str(number)
        status, printed = play(scenario, home, capsys, "two_nodes")
        assert status == 0, printed
        assert "verdict: PASS\n" in printed
        assert len(OBSERVED.findall(printed)) == 4
        runs.append([(home / node / "serial.txt").read_bytes() for node in ("panel", "drive")])
    assert all(len(text.splitlines()) > 500 for text in runs[0])
    assert runs[0] == runs[1]


def test_two_boards_run_without_a_scenario(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    printed = run("two_nodes", tmp_path, capsys, "1")
    assert "verdict: PASS\n" in printed
    assert "servo.Drive         Standing, Following" in printed


KICKER = """\
with Interfaces;
with System.Storage_Elements;

package body Interrupts_Feature.Kicker_Type.Activities
with SPARK_Mode => Off
is
   Pending : Interfaces.Unsigned_32
   with
     Volatile,
     Address => System.Storage_Elements.To_Address (16#F901_020C#);
   --  Writing a one makes an interrupt pending: 96 is that of bit 0 (GIC-400,
   --  GICD_ISPENDR3).

   procedure Kick is
   begin
      Pending := 16#0600_0000#;
   end Kick;
end Interrupts_Feature.Kicker_Type.Activities;
"""


def interrupt_stack(board: targets.Board, model: Path) -> Stack:
    """The stack on which the program of a model handles its interrupts."""
    image = programs.programs_of(checking.check(model))[0].build("release", board=board)
    return next(one for one in stacks.kept(image).stacks if one.task == "interrupts")


def test_interrupts_release_processors_within_their_bounds_on_the_board(
    board: targets.Board, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """An activity makes both interrupts of the feature pending, every 60 ms."""
    home = tmp_path / "interrupts"
    shutil.copytree(ROOT / "tests" / "feature" / "interrupts", home)
    model = home / "model.yaml"
    text = model.read_text(encoding="utf-8")
    for old, new in (
        (
            "\nnodes:\n",
            "  Kicker_Type:\n    activities:\n"
            "      kick: {period: 60 ms, wcet: 20 us, body: user}\n\nnodes:\n",
        ),
        ("instances:\n", "instances:\n  kicker: {component: Kicker_Type, node: board}\n"),
        ("processors:\n", "processors:\n  kicking: {stack: 16 KiB, activities: [kicker.kick]}\n"),
    ):
        assert text.count(old) == 1
        text = text.replace(old, new)
    model.write_text(text, encoding="utf-8")
    (home / "user").mkdir()
    body = home / "user" / "interrupts_feature-kicker_type-activities.adb"
    body.write_text(KICKER, encoding="utf-8")
    words = ["run", str(model), "--target", BOARD, "--seconds", "2"]
    assert command_line.main([*words, "--report", str(tmp_path / "report")]) == 0
    printed = capsys.readouterr().out
    observed = {name: int(releases) for name, releases in OBSERVED.findall(printed)}
    assert {observed[name] for name in ("limiting", "turning")} == {34}
    assert re.search(r"^stopped +34 .* ok$", printed, re.M)
    assert "verdict: PASS" in printed
    plain = ROOT / "examples" / "three_components" / "model.yaml"
    deep, shallow = interrupt_stack(board, model), interrupt_stack(board, plain)
    assert deep.bound is not None and shallow.bound is not None
    assert deep.size is not None and deep.size >= deep.bound > shallow.bound  # a level more


@pytest.mark.parametrize("name", LOGICAL)
def test_logical_execution_times_give_the_values_of_the_simulation_on_the_board(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """On one core and on two, with other priorities too: always the same values."""
    home = tmp_path / "logical"
    shutil.copytree(ROOT / "tests" / "feature" / "logical", home)
    simulated = system_of((home / "model.yaml").read_text(encoding="utf-8"))
    (home / "model.yaml").write_text(LOGICAL[name], encoding="utf-8")
    report = tmp_path / "report"
    words = ["run", str(home / "model.yaml"), "--target", BOARD, "--seconds", "2"]
    assert command_line.main([*words, "--report", str(report)]) == 0
    assert "verdict: PASS" in capsys.readouterr().out
    names = read_map((home / "generated" / "trace.json").read_text(encoding="utf-8"))
    seen = read_trace((report / "trace.txt").read_text(encoding="ascii").splitlines(), names)
    assert seen.values_lost == 0
    wanted = interpreted(simulated, stimuli_of("- {until: 3 s}", simulated)).values
    elements = {one.element.name for one in seen.values}
    assert elements == {one.element for one in wanted}
    for element in elements:
        found = [one.value for one in seen.values if one.element.name == element]
        same = [one.value for one in wanted if one.element == element]
        assert len(found) >= 90 and found == same[: len(found)], element


# --- Several cores: the emulator executes one at a time --------------------------------


def test_the_scenario_of_two_cores_passes_on_the_board(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its times differ from run to run: turns of the cores end where the bench is asked."""
    scenario = ROOT / "examples" / "seam_tracker" / "scenario.yaml"
    status, printed = play(scenario, tmp_path, capsys, "seam_tracker")
    assert status == 0, printed
    assert "verdict: PASS" in printed
    released = {name: int(count) for name, count in OBSERVED.findall(printed)}
    assert released["motion"] > 500 and released["vision"] > 120  # on core 1, and on core 2
    assert len((tmp_path / "serial.txt").read_bytes().splitlines()) > 1_500


def test_mailboxes_of_every_kind_join_two_cores_of_the_board(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    home = tmp_path / "cores"
    shutil.copytree(ROOT / "tests" / "feature" / "cores", home)
    words = ["run", str(home / "model.yaml"), "--target", BOARD, "--seconds", "2"]
    command_line.main([*words, "--report", str(tmp_path / "report")])
    printed = capsys.readouterr().out
    assert len(OBSERVED.findall(printed)) == 4
    assert re.search(r"^filter.Work +Waiting, Quiet, Crowded *$", printed, re.M)
    assert re.search(r"^panel.Lamp +Dark, Bright *$", printed, re.M)
    assert re.search(r"verdict: FAIL: fault: Queue_Overflow, \d+ times\n", printed)  # meant so


ONE_BUS = (
    (r"  backup: \{bit_rate.*\n", ""),
    (r"  from_backup: .*\n", ""),
    (r"bus: backup, id: 0x020", "bus: flight, id: 0x021"),
    (r"bus: backup, id: 0x038", "bus: flight, id: 0x039"),
    (r"bus: backup", "bus: flight"),
    (r"receive_depth: 32, transmit_depth: 8", "receive_depth: 64, transmit_depth: 16"),
)
"""The autopilot with one bus for all messages: a board has no second one."""

UNCUT = (
    (r"bus:\n(  -.*\n)+", ""),
    (r"  - \{wait_for: path.value, is: Backup_Alone(.*\n)+?(?=  - \{stop_feedback)", ""),
    (r"  - \{region: selector.Paths, .*\n", ""),
    (r"  - \{lost: .*\n", ""),
    (r"  - \{fault: (Queue|Can).*\n", ""),
)
"""Its scenario without the part in which a bus is cut."""


def changed(file: Path, changes: tuple[tuple[str, str], ...]) -> None:
    """Change a file; each change has to apply."""
    text = file.read_text(encoding="utf-8")
    for old, new in changes:
        text, count = re.subn(old, new, text)
        assert count, old
    file.write_text(text, encoding="utf-8")


def test_three_boards_fly_the_aircraft_one_of_them_on_two_cores(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    home = tmp_path / "autopilot"
    shutil.copytree(ROOT / "examples" / "autopilot", home)
    changed(home / "model.yaml", ONE_BUS)
    changed(home / "scenario.yaml", UNCUT)
    words = ["run", str(home / "model.yaml"), "--target", BOARD]
    words += ["--scenario", str(home / "scenario.yaml"), "--report", str(tmp_path / "report")]
    status = command_line.main(words)
    printed = capsys.readouterr().out
    assert status == 0, printed
    steps = re.findall(
        r"^guide.Flight +On_Ground, Hands_On, Hold_Level, Way_Home *$", printed, re.M
    )
    assert len(steps) == 1
    released = re.findall(r"^(\w+) +(\d+) +0 +[\d.]+ +[\d.]+ +[\d.]+ % +(?:ok|host)", printed, re.M)
    assert len(released) == 11 and min(int(count) for _, count in released) > 40
