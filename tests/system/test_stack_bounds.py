# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Each build bounds the stacks of its tasks: no run uses more, and a smaller stack fails it."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import time
from pathlib import Path

import pytest

from ravenchart.building import checking, generation, programs, stacks
from ravenchart.failures import Refused
from ravenchart.paths import ROOT
from ravenchart.stacks import graph, symbols
from ravenchart.stacks.report import Memory
from tests.support import live, stack_use

pytestmark = pytest.mark.clock

BODY = "devices_feature-servo-activities.adb"
DAMPED = "   begin\n      return\n        Current\n"
"""Where the function `Damped` of the devices feature begins."""
HEAD = "package body Devices_Feature.Servo.Activities\nwith SPARK_Mode\nis\n"


@pytest.fixture(autouse=True)
def warnings_are_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is written here on purpose gives warnings."""
    monkeypatch.setenv("RAVENCHART_WARNINGS", "shown")


def _program(home: Path) -> programs.Program:
    checked = checking.check(home / "model.yaml")
    generation.write_program(checked)
    return programs.programs_of(checked)[0]


def _devices(tmp_path: Path, declarations: str = "", statements: str = "") -> Path:
    """The devices feature, with more in its function `Damped`."""
    home = tmp_path / "devices"
    shutil.copytree(ROOT / "tests" / "feature" / "devices", home)
    body = home / "user" / BODY
    _, _, text = body.read_text().partition("\n\n")  # behind the licence
    assert text.count(DAMPED) == 1 and text.startswith(HEAD)
    text = text.replace(DAMPED, f"{declarations}   begin\n{statements}{DAMPED[9:]}")
    body.write_text(f"{HEAD.replace('with SPARK_Mode', '')}{text.removeprefix(HEAD)}")
    return home


def _edit(home: Path, pattern: str, new: str) -> None:
    model = home / "model.yaml"
    text, count = re.subn(pattern, new, model.read_text(), count=1)
    assert count == 1
    model.write_text(text)


def _observed(image: Path, seconds: float, tmp_path: Path) -> dict[str, int]:
    """Body of each task, and the main program, to the bytes of stack of a run."""
    listing = subprocess.run(["nm", "-S", image], capture_output=True, text=True, check=True)
    found = symbols.read(listing.stdout)
    main = f"_ada_{image.name}"
    bodies = {s.name: (s.at, s.size) for s in found if graph.is_task(s.name) or s.name == main}
    told = {"RAVENCHART_CAN_PORT": "0", "RAVENCHART_TRACE": str(tmp_path / "trace")}
    with live.alone():
        process = subprocess.Popen([image], env=os.environ | told, stdout=subprocess.DEVNULL)
        try:
            time.sleep(seconds)
            assert process.poll() is None
            # a task that runs at the moment may not be inside a call
            seen: dict[str, int] = {}
            for _ in range(40):
                seen |= stack_use.depths(process.pid, image, bodies)
                if seen.keys() == bodies.keys():
                    break
                time.sleep(0.05)
            return seen
        finally:
            process.kill()
            process.wait()


def _compared(found: Memory, observed: dict[str, int], known: dict[str, str]) -> dict[str, int]:
    """Task to the bytes of a run; fails where they are more than its bound."""
    bounds = {one.task: one for one in found.stacks}
    for body, used in observed.items():
        one = bounds[known[body]]
        # the run is measured below the frame of the body, which the bound has in its first step
        assert used <= one.bound - one.path[0].bytes, (body, used, one.bound)
        assert used > 0
    return {known[body]: used for body, used in observed.items()}


@pytest.mark.slow
@pytest.mark.parametrize("mode", ["checks", "release"])
def test_no_task_of_the_robot_uses_more_than_its_bound(mode: str, tmp_path: Path) -> None:
    program = _program(ROOT / "examples" / "cartesian_robot")
    image = program.build(mode)
    root = "cartesian_robot"
    known = {f"{root}__{n}__processor__processorTKB": n for n in
             ("reception", "trajectory", "control", "supervision")}  # fmt: skip
    known[f"{root}__liveness_supervision__supervisor__supervisorTKB"] = "controller.supervisor"
    known[f"{root}__host_probe__probe__probeTKB"] = "controller.probe"
    known[f"{root}__robot_bus__controller__driver__readerTKBXnn"] = "robot_bus.reader"
    known[f"{root}__robot_bus__controller__driver__writerTKBXnn"] = "robot_bus.writer"
    known[f"_ada_{image.name}"] = "environment task"
    observed = _observed(image, 2.0, tmp_path)
    assert observed.keys() == known.keys()
    used = _compared(stacks.kept(image), observed, known)
    print(used)


RAISED = """      begin
         if Position > Angle'First then
            raise Constraint_Error with "handled here";
         end if;
      exception
         when Constraint_Error =>
            null;
      end;
"""


@pytest.mark.slow
def test_an_exception_that_is_handled_stays_within_the_allowance(tmp_path: Path) -> None:
    program = _program(_devices(tmp_path, statements=RAISED))
    image = program.build()
    known = "devices_feature__fast__processor__processorTKB"
    observed = _observed(image, 1.0, tmp_path)[known]
    found = stacks.kept(image)
    one = next(s for s in found.stacks if s.task == "fast")
    assert found.library is not None
    own = one.bound - found.library
    assert own < observed <= one.bound, (own, observed, one.bound)


WIDE = """      Wide : array (1 .. 16_000) of Character := (others => ' ');
      pragma Volatile (Wide);
"""
USED = """      Wide (Integer (abs Position) mod 16_000 + 1) := 'x';
"""


@pytest.mark.slow
def test_a_stack_of_half_its_bound_fails_the_build(tmp_path: Path) -> None:
    home = _devices(tmp_path, WIDE, USED)
    program = _program(home)
    image = program.build()
    one = next(s for s in stacks.kept(image).stacks if s.task == "fast")
    assert 16_000 + 12_288 < one.bound <= (one.size or 0) == 32_768
    half = one.bound // 2 // 1024
    _edit(home, r"(fast:\n    node: board\n    stack:) 32 KiB", rf"\1 {half} KiB")
    for _ in range(2):  # the second build has nothing to compile
        with pytest.raises(Refused) as refused:
            _program(home).build()
        said = str(refused.value)
        line = next(n for n, text in enumerate((home / "model.yaml").read_text().splitlines(), 1)
                    if "fast:" in text)  # fmt: skip
        assert f"model.yaml:{line}:3: error: the stack of fast is too small" in said
        assert f"up to {one.bound:,} bytes > {half * 1024:,} bytes [RV-1501]" in said
        assert "Devices_Feature.Servo.Activities.Damped" in said
        assert "12,288 bytes: the run-time library" in said
        least = -(-one.bound // 1024)
        assert f"write `stack: {least} KiB` or more" in said
    _edit(home, rf"stack: {half} KiB", f"stack: {least} KiB")
    _program(home).build()
    _edit(home, rf"stack: {least} KiB", f"stack: {least - 1} KiB")
    with pytest.raises(Refused, match="RV-1501"):
        _program(home).build()


@pytest.mark.slow
def test_the_robot_with_half_a_stack_fails_too(tmp_path: Path) -> None:
    home = tmp_path / "robot"
    shutil.copytree(ROOT / "examples" / "cartesian_robot", home)
    _edit(home, r"(  control:\n    node: controller\n    stack:) 32 KiB", r"\1 7 KiB")
    with pytest.raises(Refused) as refused:
        _program(home).build()
    assert "the stack of control is too small" in str(refused.value)
    assert str(refused.value).count("error:") == 1


RECURSION = """      if Position > 10 then
         return Damped (Position - 1, Velocity);
      end if;
"""
POINTER = """      type Maker is access function (X : Ravenchart.Number) return Current;
      function Plain (X : Ravenchart.Number) return Current is (Current (X));
      function Other (X : Ravenchart.Number) return Current is (Current (X / 2));
      Made : Maker := (if Position > 7 then Plain'Access else Other'Access);
      pragma Volatile (Made);
"""
DYNAMIC = """      Sized : String (1 .. Integer (abs Position) + 1) := (others => ' ');
      pragma Volatile (Sized);
"""
TOUCHED = """      Sized (1) := 'x';
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("declarations", "statements", "code", "words"),
    [
        ("", RECURSION, "RV-1502", "recursion: Devices_Feature.Servo.Activities.Damped -> "),
        (POINTER, "      if Wanted = 7 then\n         return Made (Wanted);\n      end if;\n",
         "RV-1503", "Devices_Feature.Servo.Activities.Damped calls through a pointer"),
        (DYNAMIC, TOUCHED,
         "RV-1504", "the size of the frame of Devices_Feature.Servo.Activities.Damped has"),
    ],
    ids=["recursion", "pointer", "dynamic"],
)  # fmt: skip
def test_what_has_no_bound_is_refused_where_it_stands(
    declarations: str, statements: str, code: str, words: str, tmp_path: Path
) -> None:
    home = _devices(tmp_path, declarations, statements)
    with pytest.raises(Refused) as refused:
        _program(home).build()
    said = str(refused.value)
    assert re.search(rf"{BODY}:\d+:\d+: error: {re.escape(words)}.*\[{code}\]", said), said
    assert said.count("error:") == 1


@pytest.mark.slow
@pytest.mark.parametrize("mode", ["checks", "release"])
@pytest.mark.parametrize("driver", ["loopback", "slcan", "bus", "socketcan", "ctucanfd"])
def test_with_each_driver_every_stack_has_a_bound(driver: str, mode: str) -> None:
    program = _program(ROOT / "examples" / "cartesian_robot")
    found = stacks.kept(program.build(mode, driver))
    assert all(one.size is None or one.bound <= one.size for one in found.stacks)
    drivers = [one for one in found.stacks if one.task.startswith("robot_bus.")]
    assert drivers and all(one.size == 65_536 for one in drivers)
    assert (found.flash, found.ram) == tuple(
        sum(getattr(one, kind) for one in found.parts) for kind in ("flash", "ram")
    )


@pytest.mark.slow
def test_objects_of_a_build_without_call_graphs_are_compiled_once_more(tmp_path: Path) -> None:
    program = _program(_devices(tmp_path))
    image = program.build()
    objects = stacks.objects_of(image)
    own = next(one for one in objects if one.name == BODY.replace(".adb", ".o"))
    own.with_suffix(".ci").unlink()
    assert stacks.without_graph(objects)
    program.build()
    assert not stacks.without_graph(objects)
    made = own.stat().st_mtime_ns
    program.build()
    assert own.stat().st_mtime_ns == made


@pytest.mark.slow
def test_a_build_with_nothing_to_do_looks_at_nothing_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    program = _program(_devices(tmp_path))
    image = program.build()

    def examined(made: stacks.BuiltProgram) -> Memory:
        raise AssertionError(made)

    monkeypatch.setattr(stacks, "examine", examined)
    assert program.build() == image
