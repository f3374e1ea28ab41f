# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What is derived: priorities, tables, tasks, shared objects and their ceilings."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from ravenchart.gen.derive.completion import prioritised
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.system import Processor, System
from ravenchart.gen.pipeline import load
from tests.support.pump import system_of

ROOT = Path(__file__).parents[3]


def example(name: str) -> System:
    """The system of an example."""
    system = load(ROOT / "examples" / name / "model.yaml").system
    assert system is not None
    return system


def with_deadlines(*deadlines: tuple[int, int]) -> list[Processor]:
    """Processors with these (deadline, given priority or 0)."""
    one = system_of().processors[1]
    return [replace(one, deadline=Ns(d), priority=p) for d, p in deadlines]


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ([(30, 0), (10, 0), (20, 0)], [1, 3, 2]),
        ([(10, 0), (10, 0), (10, 0)], [3, 2, 1]),
        ([(30, 2), (10, 0), (20, 0)], [2, 3, 1]),
        ([(30, 30), (10, 0), (20, 0)], [30, 2, 1]),
        ([(30, 5), (10, 5)], [5, 5]),
        ([], []),
    ],
)
def test_shorter_deadline_has_the_larger_priority(
    given: list[tuple[int, int]], expected: list[int]
) -> None:
    assert [p.priority for p in prioritised(with_deadlines(*given))] == expected


def test_rows_run_in_every_nth_release() -> None:
    processor = system_of().processors[1]
    assert (processor.period, processor.deadline) == (10_000_000, 10_000_000)
    assert [(slot.name, slot.divisor, slot.phase) for slot in processor.slots] == [
        ("ports", 1, 0),
        ("Control", 1, 0),
        ("tell", 2, 0),
    ]
    assert processor.cycle == 2


def test_deadline_of_a_processor_is_the_shortest_of_its_table() -> None:
    short = system_of(
        (
            "        wcet: 30 us\n        body",
            "        wcet: 30 us\n        deadline: 5 ms\n        body",
        )
    )
    assert short.processors[1].deadline == 5_000_000
    given = system_of(("stack: 16 KiB,", "stack: 16 KiB, deadline: 8 ms,"))
    assert given.processors[1].deadline == 8_000_000
    both = system_of(
        ("wcet: 30 us\n        body", "wcet: 30 us\n        deadline: 5 ms\n        body"),
        ("stack: 16 KiB,", "stack: 16 KiB, deadline: 8 ms,"),
    )
    assert both.processors[1].deadline == 5_000_000


def test_wcet_is_the_table_and_the_rows_are_told() -> None:
    tasks = {task.element: task for task in system_of().tasks}
    assert tasks["regulation"].wcet == 20_000 + 30_000 + 30_000
    assert tasks["reception"].wcet == 20_000
    rows = [(slot.element, slot.divisor, slot.phase) for slot in tasks["regulation"].slots]
    assert rows == [("north.ports", 1, 0), ("north.Control", 1, 0), ("north.tell", 2, 0)]


def test_what_a_driver_does_follows_the_sender_or_the_frame() -> None:
    released = {task.element: task.released_by for task in system_of().tasks}
    assert released == {
        "reception": None,
        "regulation": None,
        "can_bus.driver_rx.level_in": "can_bus.level_in",
        "can_bus.driver_tx.valve_out": "regulation",
    }


def test_driver_tasks_stand_above_all_processors() -> None:
    system = system_of(("stack: 16 KiB,", "stack: 16 KiB, priority: 9,"))
    tasks = {task.element: task for task in system.tasks}
    assert (tasks["reception"].priority, tasks["regulation"].priority) == (1, 9)
    assert tasks["can_bus.driver_rx.level_in"].priority == 10
    assert tasks["can_bus.driver_tx.valve_out"].priority == 10


def test_driver_task_of_a_message_has_the_message_s_period() -> None:
    system = system_of()
    drivers = [task for task in system.tasks if ".driver_" in task.element]
    assert [(t.element, t.period, t.deadline, t.wcet) for t in drivers] == [
        ("can_bus.driver_rx.level_in", 10_000_000, 10_000_000, 20_000),
        ("can_bus.driver_tx.valve_out", 20_000_000, 20_000_000, 20_000),
    ]


def test_ceiling_is_the_highest_priority_of_the_users() -> None:
    for system in (system_of(), example("cartesian_robot"), example("three_components")):
        priorities = {task.element: task.priority for task in system.tasks} | {"main": 0}
        for item in system.objects:
            assert item.ceiling == max(priorities[user] for user in item.users)
            assert len(set(item.users)) == len(item.users)
            assert item.section == system.nodes[0].critical_section


def test_every_element_has_one_object() -> None:
    for system in (system_of(), example("cartesian_robot"), example("three_components")):
        elements = [item.element for item in system.objects]
        assert len(set(elements)) == len(elements)


def test_small_model_has_exactly_these_objects() -> None:
    found = {item.element: item.users for item in system_of().objects}
    drivers = ("can_bus.driver_rx.level_in", "can_bus.driver_tx.valve_out")
    assert found == {
        "north.level.mailbox": ("reception", "regulation"),
        "north.level": ("regulation",),
        "north.wanted": ("regulation",),
        "north.Control": ("regulation",),
        "north.Control.queue": ("regulation",),
        "can_bus.transmit": ("regulation", *drivers),
        "can_bus.receive": (*drivers, "reception"),
        "reception.monitor": ("reception",),
        "regulation.monitor": ("regulation",),
        "health": ("reception", "regulation", "main"),
    }


def test_objects_of_the_robot_have_the_users_that_the_model_implies() -> None:
    found = {item.element: set(item.users) for item in example("cartesian_robot").objects}
    assert found["joint_x.goal"] == {"supervision", "trajectory"}
    assert found["joint_x.order.mailbox"] == {"supervision", "control"}
    assert found["joint_x.feedback.mailbox"] == {"reception", "control"}
    assert found["joint_x.feedback"] == {"control", "supervision"}
    assert found["joint_x.Motion"] == {"supervision", "control"}
    assert found["joint_x.Motion.queue"] == {"supervision", "control"}
    assert "joint_x.Monitoring.queue" not in found
    supervisor = "controller.supervisor"
    assert found["coordinator.Mission.queue"] == {"supervision", "main", supervisor}
    assert found["control.monitor"] == {"control", supervisor}
    assert found["controller.supervisor.board"] == {supervisor, "main"}


def test_trace_is_there_only_when_it_has_room() -> None:
    elements = [item.element for item in system_of().objects]
    assert "trace" not in elements
    traced = system_of(("critical_section: 2 us", "critical_section: 2 us, trace: 10"))
    assert "trace" in [item.element for item in traced.objects]


def test_do_activity_uses_the_state_that_it_works_in() -> None:
    system = example("three_components")
    assert set(system.object("two.Handling").users) == {"processor_2", "processor_3"}


def test_do_activity_that_completes_its_state_shares_two_objects_with_the_region() -> None:
    system = load(ROOT / "tests" / "feature" / "done" / "model.yaml").system
    assert system is not None
    for element in ("unit_1.work.visit", "unit_1.work.done"):
        item = system.object(element)
        assert (item.users, item.ceiling) == (("regions", "workers"), 2)
    others = [o.element for o in example("three_components").objects]
    assert not [one for one in others if one.endswith((".visit", ".done"))]


def test_moving_a_row_moves_priorities_and_users_along() -> None:
    path = ROOT / "examples" / "three_components" / "model.yaml"
    text = path.read_text()
    line = next(one for one in text.splitlines(True) if "- two.work" in one)
    moved = text.replace(line, "").replace(
        "      - three.Watching\n", "      - three.Watching\n" + line, 1
    )
    system = load(Path("m.yaml"), lambda path, limit: moved.encode()).system
    assert system is not None
    assert system.processor_of("two.work").name == "processor_2"
    assert set(system.object("two.Handling").users) == {"processor_2"}


def test_probe_stands_above_all_other_tasks() -> None:
    probed = system_of(
        ("critical_section: 2 us", "critical_section: 2 us, probe: {period: 1 ms, wcet: 5 us}")
    )
    probe = next(task for task in probed.tasks if task.element == "board.probe")
    others = [task.priority for task in probed.tasks if task is not probe]
    assert (probe.period, probe.deadline, probe.wcet) == (1_000_000, 1_000_000, 5_000)
    assert probe.priority > max(others)
