# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The timing certificate: the compiler accepts what holds, and refuses a nanosecond less."""

from __future__ import annotations

import os
import re
from dataclasses import replace
from pathlib import Path

import pytest

from ravenchart.analysis.system.timing import analyse
from ravenchart.building import checking
from ravenchart.paths import ROOT
from tests.support.certificates import certificate, changed, compiled, numbers, random_system
from tests.support.systems import shared, system, task

CLAIMS = ("_R", "_Busy", r"_W(?:_\d+)?", "_Turn", "_Done", "_Reaction", "_Age", r"_Wait_\d+")
"""How numbers end that the analysis claims."""


@pytest.fixture(scope="module")
def robot_text() -> str:
    return certificate(
        checking.check(ROOT / "examples" / "cartesian_robot" / "model.yaml").analysis
    )


@pytest.mark.slow
def test_every_claim_of_the_robot_is_exact(robot_text: str, tmp_path: Path) -> None:
    """Each one lowered by a nanosecond is refused, and the message names what it is about."""
    name = "Cartesian_Robot"
    assert compiled(robot_text, tmp_path, name) == ""
    for ending in CLAIMS:
        for number in numbers(robot_text, ending):
            said = compiled(changed(robot_text, number, -1), tmp_path, name)
            assert "error: " in said, number
            told = re.findall(r"error: (chain )?(\S+) (?:can|claims)", said)
            names = [f"{chain.strip()}_{element}".strip("_") for chain, element in told]
            about = [name.replace(".", "_").lower() for name in names]
            assert any(number.lower().startswith(name) for name in about), (number, said)


def test_every_claim_of_tasks_messages_and_chains_is_there(robot_text: str) -> None:
    found = [number for ending in CLAIMS for number in numbers(robot_text, ending)]
    assert len([n for n in found if n.endswith("_R")]) == 14 + 8
    assert "Chain_X_Loop_Reaction" in found and "Chain_Status_Age" in found
    assert "Robot_Bus_X_Feedback_Turn" in found and "Joint_X_Position_Control_Done" in found


@pytest.mark.parametrize(
    ("number", "task"),
    [
        ("Coordinator_Summarise_Wcet", "supervision"),
        ("Joint_Z_Position_Control_Wcet", "control"),
        ("Robot_Bus_Driver_Rx_X_Feedback_Wcet", "robot_bus.driver_rx.x_feedback"),
        ("Controller_Supervisor_Wcet", "controller.supervisor"),
        ("Controller_Context_Switch", "reception"),
        ("Controller_Critical_Section", "trajectory"),
    ],
)
def test_a_wcet_or_overhead_raised_does_not_compile(
    robot_text: str, tmp_path: Path, number: str, task: str
) -> None:
    said = compiled(changed(robot_text, number, 1), tmp_path, "Cartesian_Robot")
    assert f"{task} claims a wrong response time" in said


def test_a_wcet_past_its_slack_cannot_be_claimed_away(robot_text: str, tmp_path: Path) -> None:
    """Whoever raises the claim as well meets the deadline instead."""
    text = changed(robot_text, "Supervision_D", -20_000_000 + 3_404_999)
    said = compiled(text, tmp_path, "Cartesian_Robot")
    assert "supervision can miss its deadline" in said


@pytest.mark.slow
@pytest.mark.parametrize("by_priority", [False, True])
def test_random_systems_are_certified_to_the_nanosecond(by_priority: bool, tmp_path: Path) -> None:
    """Rows of different periods, several jobs, errors, CAN FD, transmit buffers of both kinds."""
    made = several = flexible = 0
    for seed in range(60):
        found = analyse(random_system(seed, by_priority=by_priority))
        if not found.found.met:
            continue
        text = certificate(found)
        said = compiled(text, tmp_path)
        assert said == "", (seed, said)
        made += 1
        several += "_W_2" in text
        flexible += "_Head" in text and "_Data_Rate" in text
        for ending in ("_R", "_Busy", r"_W(?:_\d+)?"):
            for number in numbers(text, ending)[seed % 3 :: 3]:
                assert compiled(changed(text, number, -1), tmp_path), (seed, number)
    assert made >= 20 and several >= 3 and flexible >= 3, (made, several, flexible)


@pytest.mark.slow
def test_two_hundred_tasks_add_under_ten_seconds_to_a_build(tmp_path: Path) -> None:
    tasks = []
    for index in range(200):
        period = 1_000_000 * (10, 20, 50, 100, 200)[index // 40]
        tasks.append(task(f"task_{index}", 200 - index, period * 7 // 2_000, period))
    one = system(tasks, [shared("store", 200, 1_000, "task_0", "task_199")])
    node = replace(one.nodes[0], critical_section=one.objects[0].section)
    one = replace(one, nodes=(node,))
    before = os.times()
    found = analyse(one)
    text = certificate(found)
    assert compiled(text, tmp_path) == ""
    assert found.schedulable
    spent = [now - then for now, then in zip(os.times()[:4], before[:4], strict=True)]
    assert sum(spent) < 10  # of processor time, the compiler's included
    said = compiled(changed(text, "Task_150_Wcet", 1), tmp_path)
    assert "task_150 claims a wrong response time" in said
