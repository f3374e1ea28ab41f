# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Claims on stacks and tables of memory in a folder of evidence, by the record of a build."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from ravenchart.building import checking, programs, stacks
from ravenchart.evidence import facts, folder
from ravenchart.failures import Unusable
from ravenchart.stacks.report import Memory, MemoryPart, PathStep, Stack
from tests.support.evidence import verdicts


def _memory(home: Path, library: int | None = None) -> Path:
    """The record of a build of the program that is there."""
    checked = checking.check(home / "model.yaml", deadlines=False)
    (program,) = programs.programs_of(checked)
    path = [PathStep("Valve_House.Work.Execute", 900, ""), PathStep("Ada.Real_Time.Clock", 60, "")]
    tasks = [Stack(one.name, 960, 0, 0, one.stack_bytes, path) for one in checked.system.processors]
    parts = [MemoryPart("codecs", 700, 0), MemoryPart("runtime", 300, 40)]
    found = Memory(
        program.node, "zynqmp", "release", library, tasks, parts, 1000, 40, program.digests()
    )
    file = home / "memory.json"
    stacks.write(found, file)
    return file


def _stack_claims(home: Path, file: Path) -> tuple[dict[str, str], folder.FolderTexts]:
    gathered = facts.gather(home / "model.yaml", None, [home / "proof.toml"], memory=[file])
    found = folder.make(gathered)
    return {id_: v for id_, v in verdicts(found).items() if id_.startswith("stack-")}, found


def test_a_record_of_a_build_shows_that_stacks_are_large_enough(home: Path) -> None:
    found, folder_ = _stack_claims(home, _memory(home))
    assert found == {"stack-reception": "met", "stack-work": "met"}
    page = folder_.texts["index.html"]
    assert "Stacks and memory" in page and "Valve_House.Work.Execute 900" in page
    assert ">codecs</td><td>700<" in page
    assert json.loads(folder_.texts["evidence.json"])["memory"][0]["stacks"][0]["bound"] == 960


def test_an_allowance_for_the_library_is_a_part_that_is_not_shown(home: Path) -> None:
    found, _ = _stack_claims(home, _memory(home, library=12_288))
    assert found == {"stack-reception": "partly", "stack-work": "partly"}


def test_a_record_of_other_sources_shows_nothing(home: Path) -> None:
    file = _memory(home)
    body = next((home / "generated").glob("*-work.adb"))
    body.write_bytes(body.read_bytes() + b"--  edited\n")
    found, _ = _stack_claims(home, file)
    assert found == {"stack-reception": "not met", "stack-work": "not met"}


def test_a_record_without_the_task_or_with_less_stack_shows_nothing(home: Path) -> None:
    file = _memory(home)
    record = stacks.read_record(file)
    record.stacks[0].bound = (record.stacks[0].size or 0) + 1
    record.stacks[1].size = 1
    first = record.stacks[0].task
    stacks.write(record, file)
    assert set(_stack_claims(home, file)[0].values()) == {"not met"}
    assert first in {"reception", "work"}
    stacks.write(replace(record, stacks=[]), file)
    assert set(_stack_claims(home, file)[0].values()) == {"not met"}


def test_what_is_no_record_of_a_build_is_said(home: Path) -> None:
    file = home / "memory.json"
    file.write_text("{}")
    with pytest.raises(Unusable, match="is no record of stacks and memory"):
        facts.gather(home / "model.yaml", None, [home / "proof.toml"], memory=[file])
