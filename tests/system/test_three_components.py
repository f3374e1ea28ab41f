# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The classic allocation: three components of three regions on three processors."""

from __future__ import annotations

import re
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from ravenchart.analysis.system.observed import Observation, TraceRecord, read_map, read_trace
from ravenchart.building import checking, generation, programs
from ravenchart.gen.model.system import System

pytestmark = pytest.mark.clock


def _observed(checked: checking.Checked, executable: Path, folder: Path) -> Observation:
    """One second of the program, asked to end by SIGTERM."""
    trace = folder / "trace"
    process = subprocess.Popen([executable], env={"RAVENCHART_TRACE": str(trace)})
    time.sleep(1.2)
    process.send_signal(signal.SIGTERM)
    assert process.wait(5) == 0
    names = read_map((checked.folder / "generated" / "trace.json").read_text())
    return read_trace(trace.read_text().splitlines(), names)


def _first(records: list[TraceRecord], kind: str, element: str, start: int) -> int:
    """Index of the first such record from ``start`` on."""
    for index in range(start, len(records)):
        found = records[index]
        if found.kind == kind and found.element.name == element:
            return index
    raise AssertionError(f"no {kind} of {element} from record {start} on")


def test_a_token_goes_from_out_port_to_out_port_in_the_order_of_the_framework(
    stations: tuple[checking.Checked, Path], tmp_path: Path
) -> None:
    records = _observed(*stations, tmp_path).records
    at = 0
    for kind, element in (
        ("sent", "one.token_out"),  # out port of the sender
        ("arrived", "two.token_in"),  # mailbox of the receiver
        ("handled", "two.token_in"),  # its port handler: blackboard, then event
        ("transition", "two.Handling"),  # the event makes the transition
        ("state", "two.Handling"),
        ("activity", "two.work"),  # the do activity of the new state
        ("raised", "two.Worked"),
        ("transition", "two.Handling"),
        ("sent", "two.token_out"),  # and out again
        ("arrived", "three.token_in"),
    ):
        at = _first(records, kind, element, at) + 1


def test_the_token_comes_round(stations: tuple[checking.Checked, Path], tmp_path: Path) -> None:
    seen = _observed(*stations, tmp_path)
    assert len(seen.of("arrived", "one.token_in")) >= 3
    assert seen.faults["Queue_Overflow"] == 0
    assert set(seen.states_visited()["two.Handling"]) == {"Empty", "Holding"}


def _users(system: System, element: str) -> set[str]:
    return set(system.object(element).users)


def test_processors_2_and_3_both_touch_component_2(
    stations: tuple[checking.Checked, Path],
) -> None:
    system = stations[0].system
    assert all(len(c.regions) + 1 == 3 for c in system.components)
    assert _users(system, "two.held") == {"processor_2", "processor_3"}
    ceiling = max(t.priority for t in system.tasks if t.element in _users(system, "two.held"))
    assert system.object("two.held").ceiling == ceiling


@pytest.mark.slow
def test_moving_an_activity_is_one_line_and_the_token_still_goes_round(
    copy_of: Callable[[str], Path],
    tmp_path: Path,
) -> None:
    folder = copy_of("three_components")
    model = folder / "model.yaml"
    text = model.read_text()
    line = next(x for x in text.splitlines(keepends=True) if x.strip().startswith("- two.work"))
    moved = text.replace(line, "").replace(
        "      - three.Watching\n", "      - three.Watching\n" + line
    )
    assert sorted(moved.splitlines()) == sorted(text.splitlines())
    model.write_text(moved)
    before = {p.name: p.read_text() for p in (folder / "generated").glob("*station*")}
    checked = checking.check(model)
    generation.write_program(checked)
    after = {p.name: p.read_text() for p in (folder / "generated").glob("*station*")}
    assert before == after, "the component's own code does not know where it runs"
    seen = _observed(checked, programs.programs_of(checked)[0].build(), tmp_path)
    assert len(seen.of("arrived", "one.token_in")) >= 3
    body = (folder / "generated" / "three_components-processor_2.adb").read_text()
    assert re.search(r"when Two_Work =>\s+Two.Run_Work \(Executed\);", body)
