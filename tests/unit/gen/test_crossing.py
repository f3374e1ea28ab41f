# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Values of ports between the cores of a node: what may cross, and the program that they get."""

from __future__ import annotations

from dataclasses import replace

import pytest

from ravenchart.analysis.findings.claims import claims_of
from ravenchart.analysis.system.timing import analyse
from ravenchart.gen.derive.completion import on_one_core
from ravenchart.gen.derive.crossing import core_of, crossings, other_cores
from ravenchart.gen.emit.program import generate
from ravenchart.gen.model.system import System
from tests.support.pump import loaded

MODEL = """\
system: Pair
types:
  Level: {range: [0, 1000]}
components:
  Giver:
    ports:
      level: {out: Level}
      order: {out: Level}
    data:
      held: {type: Level, initial: 7}
    activities:
      give:
        period: 10 ms
        wcet: 50 us
        body:
          - {send: level, with: held}
          - {send: order, with: held}
      also_give:
        period: 10 ms
        wcet: 50 us
        body:
          - {send: order, with: held}
  Taker:
    ports:
      level: {in: Level, max_age: 100 ms, on_stale: Lost}
      order: {in: Level, kind: queued, depth: 4, overflow: reject_newest, on_arrival: Ordered}
    port_region: {period: 5 ms, wcet: 20 us}
    events: [Lost, Ordered]
    regions:
      Work:
        period: 10 ms
        wcet: 30 us
        queue: 4
        initial: Idle
        states:
          Idle: {}
          Busy: {}
        transitions:
          begin_work: {from: Idle, to: Busy, on: Ordered}
          end_work: {from: Busy, to: Idle, on: Lost}
nodes:
  board: {context_switch: 5 us, critical_section: 2 us, trace: 64, cores: 2}
instances:
  left: {component: Giver, node: board}
  right: {component: Taker, node: board}
connections:
  - {from: left.level, to: right.level}
  - {from: left.order, to: right.order}
processors:
  giving:
    node: board
    stack: 16 KiB
    activities: [left.give, left.also_give]
  taking:
    node: board
    core: 2
    stack: 16 KiB
    activities: [right.ports, right.Work]
shutdown: {raises: [], grace: 0 ms}
"""
TWO_GIVERS = (
    ("[left.give, left.also_give]", "[left.give]"),
    (
        "  taking:\n",
        "  more:\n    {node: board, stack: 16 KiB, activities: [left.also_give]}\n  taking:\n",
    ),
)
REGIONS = MODEL[MODEL.index("    regions:\n") : MODEL.index("nodes:\n")]
NOTE = """\
    data:
      noted: {type: Level, initial: 0}
    activities:
      note: {period: 5 ms, wcet: 20 us, body: [{set: noted, to: order}]}
"""
ALSO = MODEL[MODEL.index("      also_give:\n") : MODEL.index("  Taker:\n")]
WOKEN = (
    (ALSO, ""),
    (", left.also_give", ""),
    (REGIONS, NOTE),
    ("right.Work", "right.note"),
    (", on_arrival: Ordered", ""),
    ("      level: {in: Level, max_age: 100 ms, on_stale: Lost}\n", ""),
    ("  - {from: left.level, to: right.level}\n", ""),
    ("    events: [Lost, Ordered]\n", ""),
    ("    core: 2\n", "    core: 2\n    released_by: right.order\n    period: 5 ms\n"),
)


def model(*changes: tuple[str, str]) -> str:
    text = MODEL
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    return text


def system(*changes: tuple[str, str]) -> System:
    found = loaded(model(*changes))
    assert found.system is not None, found.diagnostics
    return found.system


def program(of: System) -> dict[str, str]:
    return generate(of, claims_of(analyse(of)))


def test_values_of_ports_cross() -> None:
    found = crossings(system())
    assert [(c.element, c.senders, c.sent_on, c.taken_on) for c in found] == [
        ("right.level", ("giving",), 1, 2),
        ("right.order", ("giving",), 1, 2),
    ]


def test_no_protected_object_holds_them() -> None:
    both, one = system(), system(("    core: 2\n", ""))
    crossed = {"right.level.mailbox", "right.order.mailbox"}
    assert crossed <= {item.element for item in one.objects}
    assert not crossed & {item.element for item in both.objects}
    assert crossed <= {item.element for item in on_one_core(both).objects}


def test_every_object_has_its_users_on_one_core() -> None:
    both = system()
    cores = {task.element: task.core for task in both.tasks}
    cores |= {"main": 1, "board.reporter_2": 2}
    for item in both.objects:
        assert {cores[user] for user in item.users} <= {item.core}, item


def test_each_core_has_its_instances() -> None:
    both = system()
    assert [core_of(both, name) for name in ("left", "right")] == [1, 2]
    assert other_cores(both) == (2,)
    assert other_cores(system(("    core: 2\n", ""))) == ()


@pytest.mark.parametrize(
    ("changes", "messages"),
    [
        (
            [("overflow: reject_newest", "overflow: drop_oldest")],
            ["right.order, on core 2, drops its oldest value, but giving sends on core 1"],
        ),
        (TWO_GIVERS, ["right.order, on core 2, gets values from giving and more"]),
        (WOKEN, ["right.order, on core 2, releases a processor, but giving sends on core 1"]),
        (
            [
                ("right.ports, right.Work]", "right.ports]"),
                ("left.also_give]", "left.also_give, right.Work]"),
            ],
            ["right runs on two cores: ports on core 2, Work on core 1"],
        ),
        (
            [("    core: 2\n", "    core: 2\n    on_deadline_miss: [right.Lost]\n")],
            [],
        ),
        (
            [
                (
                    "[left.give, left.also_give]",
                    "[left.give, left.also_give]\n    on_deadline_miss: [right.Lost]",
                )
            ],
            ["right.Work.queue is shared by taking (core 2) and giving (core 1)"],
        ),
    ],
)
def test_what_cannot_cross_is_refused(changes: list[tuple[str, str]], messages: list[str]) -> None:
    found = loaded(model(*changes))
    told = [d for d in found.diagnostics if d.is_error]
    assert [d.message for d in told] == messages
    assert {d.code for d in told} <= {"RV-0711"}
    assert all(d.hint for d in told)
    together = model(*changes).replace("    core: 2\n", "")
    assert not [d for d in loaded(together).diagnostics if d.is_error]


def test_the_program_has_them_in_one_package() -> None:
    made = program(system())
    spec, body = made["pair-crossings.ads"], made["pair-crossings.adb"]
    assert "package Right_Level is new Ravenchart.Crossing_Samples" in spec
    assert "package Right_Order is new Ravenchart.Crossing_Queues" in spec
    assert "Crossings.Put_Right_Order (Item);" in made["pair-left.adb"]
    assert "Crossings.Right_Order.Take" in made["pair-right.adb"]
    assert "Mailbox" not in made["pair-right.adb"]
    #  the sender's core counts what the receiver has no room for
    assert "Health_Counts.Faults.Report" in body
    assert "Health_Counts_2" not in body


def test_each_core_counts_its_own_faults() -> None:
    made = program(system())
    here = {"pair-left.adb", "pair-giving.adb"}
    there = {"pair-right.adb", "pair-taking.adb", "pair-reports_2.adb"}
    for name in here | there:
        assert ("Trace_2" in made[name]) is (name in there), name
        assert ("Trace.Buffer" in made[name]) is (name in here), name
    assert "CPU => 2" in made["pair-taking.ads"]
    assert "CPU => 1" in made["pair_main.adb"]


def test_a_model_on_one_core_has_none_of_it() -> None:
    one = system(("    core: 2\n", ""))
    alone = replace(one, nodes=tuple(replace(node, cores=1) for node in one.nodes))
    for made in map(program, (one, alone)):
        assert not [name for name in made if "crossings" in name or "_2" in name]
        assert "CPU" not in "".join(made.values())
