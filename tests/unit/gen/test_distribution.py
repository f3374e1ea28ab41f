# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Components on several nodes: messages of connections, receptions, and each node's program."""

from __future__ import annotations

import pytest

from ravenchart.analysis.findings import advice
from ravenchart.analysis.findings.claims import claims_of
from ravenchart.analysis.system.timing import analyse
from ravenchart.gen.derive.completion import on_one_node, programs
from ravenchart.gen.emit.program import generate
from ravenchart.gen.model.system import System
from tests.support.systems import stops_of
from tests.support.two_nodes import BUS, RECEPTION, TOGETHER, loaded, said, system_of


def refusal(*replacements: tuple[str, str]) -> str:
    found = loaded(*replacements)
    assert found.system is None
    return said(found)


def test_a_connection_between_nodes_is_a_message_with_the_period_of_its_sender() -> None:
    system = system_of()
    assert not system.connections
    assert [
        (m.name, str(m.source), [str(t) for t in m.targets], m.period) for m in system.messages
    ] == [
        ("supervisor_order", "supervisor.order", ["servo.order"], 20_000_000),
        ("servo_report", "servo.report", ["supervisor.report"], 20_000_000),
    ]
    assert {m.identifier for m in system.messages} == {1, 2}


def test_one_line_puts_both_on_one_node_without_a_message_or_a_reception() -> None:
    system = system_of(TOGETHER)
    assert not system.messages
    assert len(system.connections) == 2
    assert [p.name for p in system.processors] == ["supervision", "control"]
    assert {p.node for p in system.processors} == {"panel"}
    assert [p.nodes[0].name for p in programs(system)] == ["panel"]


def test_a_reception_without_node_is_on_each_node_that_receives() -> None:
    receptions = [p for p in system_of().processors if p.released_by]
    assert [(p.name, p.node, p.slots[0].element) for p in receptions] == [
        ("reception_panel", "panel", "link.receive_panel"),
        ("reception_drive", "drive", "link.receive_drive"),
    ]
    one_way = ("  - {from: servo.report, to: supervisor.report}\n", "")
    line = "  heard: {bus: link, id: 0x7, to: supervisor.report, period: 20 ms}\n"
    from_outside = ("processors:", f"messages:\n{line}processors:")
    without_chain = ("servo.tell, supervisor.plan]", "servo.tell]")
    assert len(system_of(one_way, from_outside, without_chain).processors) == 4


def test_a_message_of_the_model_carries_the_connections_of_its_port() -> None:
    line = "  told: {bus: link, id: 0x42, from: supervisor.order, deadline: 5 ms}\n"
    given = ("processors:", f"messages:\n{line}processors:")
    told = system_of(given).messages[0]
    assert (told.name, told.identifier, told.limit) == ("told", 0x42, 5_000_000)
    assert [str(target) for target in told.targets] == ["servo.order"]


LISTENER = """
components:
  Ear:
    ports:
      order: {in: Servo_Order}
    port_region: {period: 20 ms, wcet: 20 us}
    data:
      heard: {type: Position, initial: 0}
    activities:
      listen:
        period: 20 ms
        wcet: 20 us
        reads: [order]
        writes: [heard]
        body: [{set: heard, to: order.target}]
"""


def test_a_message_reaches_every_node_that_listens() -> None:
    listener = (
        ("  drive:\n", "  log: {context_switch: 10 us, critical_section: 5 us}\n  drive:\n"),
        ("  servo: {comp", "  listener: {component: Ear, node: log}\n  servo: {comp"),
        (
            "processors:",
            "processors:\n  logging: {stack: 8 KiB, "
            "activities: [link.watch, listener.ports, listener.listen]}",
        ),
        (
            "  - {from: servo.report",
            "  - {from: supervisor.order, to: listener.order}\n  - {from: servo.report",
        ),
        (
            "chains:\n",
            "chains:\n  heard: {path: [supervisor.plan, listener.listen], reaction: 90 ms}\n",
        ),
        ("system: Two_Nodes", LISTENER.strip() + "\nsystem: Two_Nodes"),
    )
    system = system_of(*listener)
    order = next(m for m in system.messages if m.name == "supervisor_order")
    assert [(one.node, one.element) for one in system.receptions(order)] == [
        ("drive", "link.supervisor_order.drive"),
        ("log", "link.supervisor_order.log"),
    ]
    assert [p.nodes[0].name for p in programs(system)] == ["panel", "log", "drive"]
    log = programs(system)[1]
    assert [(m.name, [str(end) for end in m.targets]) for m in log.messages] == [
        ("supervisor_order", ["listener.order"])
    ]
    found = analyse(system)
    assert found.schedulable
    assert {"link.supervisor_order.log", "link.supervisor_order.drive"} <= set(found.deliveries)
    way = stops_of("supervisor_order", "listener.order")
    steps = [hop.step.name for hop in found.latency(way).hops]
    assert "link.driver_rx.supervisor_order.log" in steps
    assert "Link_Supervisor_Order_Log_Handed" in _certificate(system)


def _certificate(system: System) -> str:
    files = generate(system, claims_of(analyse(system)))
    return files["log/two_nodes-timing_certificate.ads"]


def test_each_node_has_its_program_and_sees_the_other_as_outside() -> None:
    panel, drive = programs(system_of())
    for part, own, other in ((panel, "supervisor", "servo"), (drive, "servo", "supervisor")):
        assert [i.name for i in part.instances] == [own]
        sent = [m for m in part.messages if m.source is not None]
        received = [m for m in part.messages if m.targets]
        assert [m.name.partition("_")[0] for m in sent] == [own]
        assert [m.name.partition("_")[0] for m in received] == [other]
        assert not part.connections
        assert part.has_object("link.transmit")
        assert {task.node for task in part.tasks} == {part.nodes[0].name}


@pytest.mark.slow
def test_advice_is_given_where_a_chain_between_nodes_is_late() -> None:
    found = analyse(system_of(("reaction: 60 ms, age: 50 ms", "reaction: 10 ms")))
    assert not found.schedulable
    given = advice.of_model(found)
    assert given is not None


def test_objects_of_the_same_name_on_two_nodes_are_told_apart() -> None:
    names = [item.element for item in system_of().objects]
    assert len(set(names)) == len(names)
    assert {"panel.health", "drive.health", "panel.link.transmit", "drive.link.transmit"} <= set(
        names
    )


def test_objects_are_told_apart_where_a_node_has_the_name_of_the_bus() -> None:
    system = system_of(
        ("  drive:\n", "  link:\n"), ("Linear_Servo, node: drive", "Linear_Servo, node: link")
    )
    names = [item.element for item in system.objects]
    assert len(set(names)) == len(names)
    assert {"panel.link.transmit", "link.link.transmit"} <= set(names)


def test_a_simulation_has_both_on_one_node() -> None:
    one = on_one_node(system_of())
    assert len(one.nodes) == 1
    assert [(str(c.source), str(c.target)) for c in one.connections] == [
        ("supervisor.order", "servo.order"),
        ("servo.report", "supervisor.report"),
    ]


@pytest.mark.parametrize(
    ("replacements", "message"),
    [
        (
            [(f"buses:\n{BUS}", ""), (RECEPTION, "")],
            "declare a bus: between nodes, values travel as its messages",
        ),
        (
            [("servo.control, servo.tell]\n\n", "servo.control, servo.tell, supervisor.plan]\n\n")],
            "supervisor.plan is on panel, but control is on drive",
        ),
        (
            [("  control:\n", "  control:\n    on_deadline_miss: [supervisor.Servo_Lost]\n")],
            "but raises Servo_Lost of",
        ),
        ([("  control:\n", "  control:\n    core: 2\n")], "control is on core 2, but drive has 1"),
        (
            [("{released_by: link,", "{node: panel, released_by: link,")],
            "no processor receives the messages of link on drive",
        ),
    ],
)
def test_what_cannot_be_is_refused(replacements: list[tuple[str, str]], message: str) -> None:
    assert message in refusal(*replacements)
