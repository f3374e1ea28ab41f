# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Faults of a controller as a model hears of them: rows, events, recovery, and their time."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.analysis.findings.claims import claims_of
from ravenchart.analysis.system.timing import analyse
from ravenchart.behaviour.rules import findings
from ravenchart.gen.derive.completion import programs
from ravenchart.gen.diagnostics import render
from ravenchart.gen.emit.program import generate
from ravenchart.gen.emit.tables.trace_map import CONTROLLER_STATES, elements
from ravenchart.gen.files.load import read_file
from ravenchart.gen.model.system import System, Work
from ravenchart.gen.pipeline import load
from tests.support.two_nodes import AFTER, MODEL, TOGETHER, by_chart, loaded, said, system_of


def program_of(system: System, node: str) -> dict[str, str]:
    """The files of a node's program, by name."""
    files = generate(system, claims_of(analyse(system)))
    return {path.removeprefix(f"{node}/"): text for path, text in files.items() if node in path}


def requested() -> System:
    """The example, whose charts request recovery by themselves."""

    def read(path: Path, most: int) -> bytes:
        return by_chart(read_file(path, most).decode()).encode()

    found = load(MODEL, read)
    assert found.system is not None, said(found)
    assert not found.diagnostics, said(found)
    assert not list(findings(found.system))
    return found.system


def test_each_node_of_the_bus_watches_its_own_controller() -> None:
    system = system_of()
    rows = {
        (p.name, slot.element, slot.timing.period, slot.timing.wcet)
        for p in system.processors
        for slot in p.slots
        if slot.work is Work.BUS_WATCH
    }
    assert rows == {
        ("supervision", "link.watch_panel", 20_000_000, 50_000),
        ("control", "link.watch_drive", 20_000_000, 50_000),
    }
    panel, drive = programs(system)
    assert panel.buses[0].on_bus_off == (("supervisor", "Bus_Failed"),)
    assert drive.buses[0].on_bus_off == (("servo", "Bus_Failed"),)


def test_a_watch_is_in_the_responses_of_its_processor() -> None:
    slower = system_of(
        ("watch: {period: 20 ms, wcet: 50 us}", "watch: {period: 20 ms, wcet: 90 us}")
    )
    one, other = (analyse(s).found.from_event("supervision") for s in (system_of(), slower))
    assert one is not None and other is not None
    assert other - one == 40_000


def test_who_watches_and_who_requests_may_block_others_on_the_controller() -> None:
    users = {o.element: set(o.users) for o in system_of().objects}
    assert "control" in users["drive.link.transmit"]
    assert "supervision" in users["panel.link.transmit"]
    queues = {o.element: set(o.users) for o in requested().objects}
    assert "control" in queues["drive.link.transmit"]
    assert "control" in queues["servo.Drive.queue"]


@pytest.mark.parametrize(("delay", "looks"), [("100 ms", 5), ("101 ms", 6), ("1 ms", 1)])
def test_a_delay_is_counted_in_whole_looks(delay: str, looks: int) -> None:
    system = system_of((AFTER, AFTER.replace("100 ms", delay)))
    assert system.buses[0].recovery_looks == looks
    body = program_of(system, "drive")["two_nodes-link-watch.adb"]
    assert f"Look_Count := {looks};" in body
    assert "Controller.Request_Recovery;" in body


def test_without_a_policy_the_driver_recovers_at_once() -> None:
    files = program_of(system_of((AFTER, "")), "drive")
    assert "Recovery => Ravenchart.Can.Automatic" in files["two_nodes-link.ads"]
    assert "Request_Recovery" not in "".join(files.values())


def test_a_chart_requests_recovery_by_an_event() -> None:
    files = program_of(requested(), "drive")
    assert "Recovery => Ravenchart.Can.On_Request" in files["two_nodes-link.ads"]
    assert files["two_nodes-servo.adb"].count("Link.Controller.Request_Recovery;") == 1
    assert "Request_Recovery" not in files["two_nodes-link-watch.adb"]


def test_the_report_has_the_counts_of_the_controller() -> None:
    reports = " ".join(program_of(system_of(), "drive")["two_nodes-reports.adb"].split())
    for kind, count in (("Error_Passive", "Passive_Entries"), ("Bus_Off", "Off_Entries")):
        assert f"Faults (Ravenchart.Health.Can_{kind}) := Link_Faults.{count};" in reports


def test_the_trace_has_the_states_of_each_controller() -> None:
    found = [e for part in programs(system_of()) for e in elements(part) if e.kind == "bus"]
    assert [(e.element, e.leaves) for e in found] == [
        ("panel.link", CONTROLLER_STATES),
        ("drive.link", CONTROLLER_STATES),
    ]


def test_on_one_node_there_is_no_bus_and_nothing_to_watch() -> None:
    found = loaded(TOGETHER)
    assert found.system is not None and not found.diagnostics, said(found)
    rows = [slot.work for p in found.system.processors for slot in p.slots]
    assert Work.BUS_WATCH not in rows


def test_a_processor_of_watches_alone_is_on_each_node_of_the_bus() -> None:
    system = system_of(
        ("activities: [link.watch, supervisor.ports", "activities: [supervisor.ports"),
        ("activities: [link.watch, servo.ports", "activities: [servo.ports"),
        ("  supervision:\n", "  guard: {stack: 8 KiB, activities: [link.watch]}\n  supervision:\n"),
    )
    found = [(p.name, p.node, p.period, p.slots[0].element) for p in system.processors]
    assert [one for one in found if one[0].startswith("guard")] == [
        ("guard_panel", "panel", 20_000_000, "link.watch_panel"),
        ("guard_drive", "drive", 20_000_000, "link.watch_drive"),
    ]
    generate(system, claims_of(analyse(system)))


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("watch: {period: 20 ms,", "watch: {period: 25 ms,", "is no multiple of 20 ms"),
        ("wcet: 50 us}", "wcet: 50 us, deadline: 40 us}", "longer than its deadline"),
        (AFTER, "    recovery: sometimes\n", "must be `automatic`"),
        (AFTER, "    recovery: {when: 3 ms}\n", "one of the keys `after`, `on`"),
        (AFTER, "    recovery: {after: 0 ms}\n", "longer than 0"),
        (AFTER, "    recovery: {on: [servo.Told]}\n", "nothing on panel can request recovery"),
        ("[servo.Bus_Back, supervisor", "[servo.Nothing, supervisor", "named `Nothing`"),
        ("[link.receive]}", "[link.watch]}", "its table is `- link.receive`, and nothing else"),
    ],
)
def test_what_is_wrong_is_told_where_it_stands(old: str, new: str, words: str) -> None:
    found = loaded((old, new))
    assert found.system is None
    texts = [render(one, found.sources) for one in found.diagnostics]
    assert any(words in text and "model.yaml:" in text for text in texts), texts
