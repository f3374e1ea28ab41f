# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Stacks and memory of programs in the HTML reports of an analysis and of a run."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import pytest

from ravenchart.analysis.present.report import render_report
from ravenchart.building import checking, programs, stacks
from ravenchart.command_line import main
from ravenchart.failures import OK
from ravenchart.stacks.report import Memory, MemoryPart, PathStep, Stack
from tests.support import evidence

pytestmark = pytest.mark.slow

HEADING = ">Stacks and memory</h2>"


@pytest.fixture
def home(base: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the model; what is built of it would be below the folder of the test."""
    monkeypatch.setattr(programs, "work", lambda: tmp_path)
    return evidence.copy(base, tmp_path / "valve")


def memory(program: programs.Program, bound: int = 960) -> Memory:
    path = [PathStep("Valve_House.Work.Execute", bound, "")]
    tasks = [Stack("work", bound, 224, 0, 4_096, path), Stack("main", 10, 0, 0, None, [])]
    parts = [MemoryPart("codecs", 700, 0), MemoryPart("<runtime>", 300, 40)]
    return Memory(
        program.node, "zynqmp", "release", None, tasks, parts, 12_345, 40, program.digests()
    )


def keep(home: Path, found: Memory, mode: str = "release") -> None:
    """The record of a build, where the build puts it."""
    checked = checking.check(home / "model.yaml", deadlines=False)
    (program,) = programs.programs_of(checked)
    image = program.home("loopback", "zynqmp") / mode / f"{checked.stem}_main"
    image.parent.mkdir(parents=True, exist_ok=True)
    stacks.keep(image, found)


def analysed(home: Path) -> str:
    page = home / "report.html"
    assert main(["analyse", str(home / "model.yaml"), "--html", str(page)]) == OK
    return page.read_text(encoding="utf-8")


def the_program(home: Path) -> programs.Program:
    (program,) = programs.programs_of(checking.check(home / "model.yaml", deadlines=False))
    return program


def test_a_report_has_the_stacks_and_the_memory_of_the_last_build(home: Path) -> None:
    program = the_program(home)
    keep(home, memory(program, 500), "checks")
    (older,) = programs.build_home(program.checked, "loopback", "zynqmp").rglob("*.json")
    os.utime(older, (0, 0))
    keep(home, memory(program))
    text = analysed(home)
    assert HEADING in text
    assert f"{program.node}: target zynqmp, mode release" in text
    assert "Valve_House.Work.Execute <data" in text
    assert '<td class="n"><data value="3136">3,136</data></td>' in text  # the margin
    assert "23 %" in text  # of the stack
    assert '<td class="n">of the system</td><td class="n">-</td>' in text
    assert '<th class="n"><data value="12345">12,345</data></th>' in text
    assert "&lt;runtime&gt;" in text
    assert "is not built from these sources" not in text


def test_a_build_of_other_sources_does_not_count(home: Path) -> None:
    program = the_program(home)
    keep(home, memory(program))
    source = next(iter(sorted(program.generated.glob("*.adb"))))
    source.write_text(source.read_text(encoding="utf-8") + "--  changed\n", encoding="utf-8")
    text = analysed(home)
    assert HEADING in text
    assert f"The program of {program.node} is not built from these sources" in text
    assert "<code>ravenchart build MODEL</code>" in text
    assert "Valve_House.Work.Execute" not in text


@pytest.mark.slow
def test_a_build_of_another_model_does_not_count(home: Path) -> None:
    keep(home, memory(the_program(home)))
    assert "is not built from" not in analysed(home)
    model = home / "model.yaml"
    text = model.read_text(encoding="utf-8")
    assert "wcet: 30 us" in text
    model.write_text(text.replace("wcet: 30 us", "wcet: 31 us", 1), encoding="utf-8")
    assert "is not built from" in analysed(home)


def test_a_model_that_was_never_generated_has_no_build(home: Path) -> None:
    program = the_program(home)
    keep(home, memory(program))
    (program.generated / programs.TRACE_MAP).unlink()
    assert "is not built from" in analysed(home)


def test_an_allowance_for_the_library_is_named_as_such(home: Path) -> None:
    program = the_program(home)
    analysis = program.checked.analysis
    found = replace(memory(program), library=12_288)
    text = render_report(analysis, programs={"node": found})
    assert '<data value="12288">12,288</data> bytes for the run-time library' in text
    assert "an allowance, not a computed bound" in text
    assert HEADING not in render_report(analysis)
