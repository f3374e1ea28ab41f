# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Progress is counted in units, with the time that is left; in a pipe silence is short."""

from __future__ import annotations

import time

import pytest

from ravenchart import terminal
from ravenchart.tools.steps import COMPILING, PROVING, Announced

pytestmark = pytest.mark.clock


def _told(phases: tuple[str, ...], times: list[float], counts: list[tuple[int, int]]) -> list[str]:
    told: list[str] = []
    clock = iter(times)
    steps = Announced(phases, told.append, lambda: next(clock))
    for done, units in counts:
        assert steps.takes(f"completed {done} out of {units} ({done * 100 // units}%)...\n")
    assert not steps.takes("unit.adb:1:2: medium: overflow check might fail\n")
    return told


def test_a_proof_has_two_phases_and_the_time_left_of_the_second() -> None:
    times = [0.0, 5.0, 9.0, 10.0, 20.0, 30.0, 300.0]
    assert _told(PROVING, times, [(1, 3), (3, 3), (1, 3), (2, 3), (3, 3)]) == [
        "1 of 3 units read",
        "3 of 3 units read",
        "1 of 3 units proved, about 2 s left",
        "2 of 3 units proved, about 6 s left",
        "3 of 3 units proved",
    ]


def test_a_compilation_finds_more_units_on_the_way() -> None:
    assert _told(COMPILING, [0.0, 2.0, 6.0], [(1, 3), (2, 6), (6, 6)]) == [
        "1 of 3 units compiled, about 4 s left",
        "2 of 6 units compiled, about 12 s left",
        "6 of 6 units compiled",
    ]


def test_lines_of_progress_are_those_of_a_process_of_the_command_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(terminal, "SILENCE", 0.01)
    monkeypatch.setattr(terminal, "SHORTEST", 0.01)
    for is_process in (False, True):
        if is_process:
            terminal.LINES.set()
        try:
            with terminal.stages("compile board") as tell:
                time.sleep(0.1)
                tell("1 of 2 units compiled")
                time.sleep(0.1)
        finally:
            terminal.LINES.clear()
        lines = capsys.readouterr().err.splitlines()
        assert bool(lines) == is_process
    assert lines[0] == "compile board (0 s)"
    assert lines[-1] == "compile board: 1 of 2 units compiled (0 s)"
    time.sleep(0.05)
    assert capsys.readouterr().err == ""
