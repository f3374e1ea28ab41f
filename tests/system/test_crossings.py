# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Values between two cores: whole and in order under load, and a step out of order is found."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

from ravenchart.paths import ROOT

pytestmark = [
    pytest.mark.live,
    pytest.mark.skipif(
        not {0, 1} <= os.sched_getaffinity(0), reason="needs the processors 0 and 1 of the machine"
    ),
]

SOURCES = ROOT / "spark_runtime" / "src"
MODELS = ROOT / "proofs" / "interleavings"
LONG = "RAVENCHART_LONG_TESTS" in os.environ
HANGS = 600.0 if LONG else 60.0
"""Seconds after which a program does not end."""
BUILDS = {"checks": ("-O1", "-gnata"), "release": ("-O2", "-gnatp")}
FILL = "      Slots.Write (Place (Pair, Halves (Pair)), Item);  --  Fill\n"
SHOW = "      Newest := Halves;  --  Show_Half\n"
PUT = "         Slots.Write (Free, Item);  --  Fill\n"
TAIL = "         Tail   := Following (Free);  --  Show\n"
WRONG = {
    "a half is shown before it is filled": ("crossing_boards", FILL + SHOW, SHOW + FILL),
    "the writer does not avoid the reader": (
        "crossing_boards",
        "      Pair   := Reading;  --  Avoid\n      Pair   := 1 - Pair;\n",
        "      Pair   := Latest;\n",
    ),
    "one half of each pair only": ("crossing_boards", "1 - Halves (Pair)", "Halves (Pair)"),
    "an element is shown before it is there": ("crossing_queues", PUT + TAIL, TAIL + PUT),
    "a full queue is taken for an empty one": (
        "crossing_queues",
        "if Following (Free) = First then",
        "if False then",
    ),
}
"""The bodies with an error: unit, text, and the wrong text.

A place that is released before it is read does no harm: the ring has one place to spare.
"""
STEPS = {
    "Avoid": ("four_slot_steps", "1 - B.Reading", "B.Reading"),
    "Fill": ("four_slot_steps", "1 - B.Newest (B.Writer_Pair)", "B.Newest (B.Writer_Pair)"),
    "Announce": ("four_slot_steps", "B.Reading := B.Reader_Pair;", "null;"),
    "Find_Room": ("ring_steps", "Following (R, R.Tail) /= R.Head", "R.Tail /= R.Head"),
    "End_Copy": ("ring_steps", "R.Taken    := R.Taken + 1;", "null;"),
}
"""Steps of the models with an error."""


def program(folder: Path, build: str) -> Path:
    """The test program, with the bodies of ``folder`` before those of the runtime."""
    folder.mkdir(exist_ok=True)
    places = (folder, ROOT / "tests" / "ada", SOURCES, ROOT / "spark_runtime" / "native")
    command = ["gnatmake", "-q", "-gnat2012", *BUILDS[build], *(f"-I{place}" for place in places)]
    command += [f"-gnatec={ROOT / 'spark_runtime' / 'ravenscar.adc'}"]
    command += [str(ROOT / "tests" / "ada" / "test_crossings.adb"), "-o", str(folder / "program")]
    subprocess.run(command, cwd=folder, check=True, capture_output=True, timeout=300)
    return folder / "program"


def facts(ran: Path, trials: int) -> tuple[list[str], list[str]]:
    """The facts that hold, and those that do not; a program that hangs has no facts."""
    try:
        done = subprocess.run(
            [ran, str(trials)], capture_output=True, text=True, timeout=HANGS, check=False
        )
    except subprocess.TimeoutExpired:
        return [], ["it does not end"]
    lines = done.stdout.splitlines()
    wrong = [line for line in lines if line.startswith("not ok ")]
    assert wrong or done.returncode == 0, done.stdout + done.stderr
    return [line for line in lines if line.startswith("ok ")], wrong


@pytest.mark.parametrize("build", BUILDS)
def test_values_cross_whole_and_in_order(tmp_path: Path, build: str) -> None:
    """Two million values through each of a board, a sample and a queue; in a long run 10**8."""
    held, wrong = facts(program(tmp_path / "right", build), 1000 if LONG else 20)
    assert wrong == []
    assert len(held) == 10


@pytest.mark.slow
@pytest.mark.parametrize("what", WRONG)
def test_a_step_out_of_order_is_found(tmp_path: Path, what: str) -> None:
    unit, old, new = WRONG[what]
    text = (SOURCES / f"ravenchart-{unit}.adb").read_text(encoding="utf-8")
    assert text.count(old) == 1
    folder = tmp_path / "wrong"
    folder.mkdir()
    (folder / f"ravenchart-{unit}.adb").write_text(text.replace(old, new), encoding="utf-8")
    _, wrong = facts(program(folder, "release"), 50)
    assert wrong


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("gnatprove") is None, reason="gnatprove is not installed")
@pytest.mark.parametrize("step", STEPS)
def test_a_wrong_step_is_not_proved(tmp_path: Path, step: str) -> None:
    unit, old, new = STEPS[step]
    shutil.copytree(MODELS, tmp_path / "models")
    body = tmp_path / "models" / f"{unit}.adb"
    text = body.read_text(encoding="utf-8")
    assert text.count(old) == 1
    body.write_text(text.replace(old, new), encoding="utf-8")
    project = tmp_path / "models.gpr"
    project.write_text(
        'project Models is\n   for Source_Dirs use ("models");\n'
        '   for Object_Dir use "obj";\n   for Create_Missing_Dirs use "True";\nend Models;\n',
        encoding="utf-8",
    )
    command = ["gnatprove", "-P", str(project), "--level=1", "--report=fail", "-u", body.name]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    assert "might fail" in done.stdout + done.stderr
