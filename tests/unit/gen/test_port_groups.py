# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Groups of input ports: their rows in objects, bounds, virtual time, code, and in editors."""

from __future__ import annotations

import random
import re
from pathlib import Path

import pytest

from ravenchart.analysis.core.chains import HopKind
from ravenchart.analysis.system.graph import dependencies
from ravenchart.analysis.system.timing import analyse
from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.behaviour.interpreter.stimuli import Arrived
from ravenchart.behaviour.rules.outside import external_events
from ravenchart.command_line import main
from ravenchart.editing.edits import Document
from ravenchart.editing.places import ModelPlaces
from ravenchart.gen.derive.crossing import crossings
from ravenchart.gen.derive.senders import sending_rows
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.text import print_unit
from ravenchart.gen.emit.instances.glue import emit_instances
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.instances import End
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import Loaded, load
from ravenchart.language_server.completing import proposals
from ravenchart.language_server.model import model
from ravenchart.language_server.renaming import renamed
from ravenchart.paths import ROOT
from tests.support.as_groups import grouped

PATH = ROOT / "tests" / "feature" / "grouped" / "model.yaml"
SEGMENTED = ROOT / "tests" / "nodes" / "segmented" / "model.yaml"
TEXT = PATH.read_text(encoding="utf-8")
MS = 1_000_000


def loaded(*changes: tuple[str, str], text: str = TEXT) -> Loaded:
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    return load(Path("model.yaml"), lambda path, limit: text.encode())


def system_of(*changes: tuple[str, str]) -> System:
    found = loaded(*changes)
    assert found.system is not None, [one.message for one in found.diagnostics]
    assert found.diagnostics == ()
    return found.system


def test_each_port_has_one_row_that_handles_it() -> None:
    component = system_of().instance("joint").component
    rows = {row: [port.name for port in component.handled(row)] for row in component.handlers()}
    assert rows == {"ports": ["limit"], "fast": ["torque", "speed"], "slow": ["order"]}
    assert [timing.period // MS for timing in component.handlers().values()] == [20, 5, 40]


# --- Analysis


def test_only_the_tasks_of_a_port_share_its_objects() -> None:
    objects = {one.element: set(one.users) for one in system_of().objects}
    assert objects["joint.torque.mailbox"] == {"sensing", "driving"}
    assert objects["joint.limit.mailbox"] == {"moving"}
    assert objects["joint.limit"] == {"moving", "driving"}
    assert {"driving", "moving"} <= objects["joint.Motion.queue"]  # of `on_stale`, `on_arrival`


def test_the_event_of_a_port_is_raised_by_its_group() -> None:
    system = system_of()
    component = system.instance("joint").component
    assert set(external_events(component, system)) >= {
        ("Ordered", "slow"),
        ("Flooded", "slow"),
        ("Lost", "fast"),
    }


def test_a_chain_waits_for_the_row_that_handles_its_port() -> None:
    found = analyse(system_of())
    latency = next(latency for one, latency in found.limited if one.name == "brake")
    assert [(hop.step.name, hop.step.hop) for hop in latency.hops] == [
        ("arm.measure", HopKind.SAMPLED),
        ("joint.fast", HopKind.SAMPLED),
        ("joint.control", HopKind.RELEASED),
        ("brake.press", HopKind.WOKEN),
        ("brake.hold", HopKind.RELEASED),
    ]
    assert latency.hops[1].wait == 5 * MS


def test_the_graph_has_a_row_for_each_group() -> None:
    graph = dependencies(system_of())
    edges = [edge for edge in graph.edges if graph.edges[edge]["kind"] == "handles"]
    assert (End("joint", "torque"), End("joint", "fast")) in edges
    assert (End("joint", "limit"), End("joint", "ports")) in edges
    assert (End("joint", "torque"), End("joint", "ports")) not in edges


def test_the_group_sends_the_flow_control_of_a_value_in_several_frames(tmp_path: Path) -> None:
    rows = set()
    for seed in range(6):
        path = grouped(SEGMENTED.parent, tmp_path / str(seed), random.Random(seed))
        system = load(path).system
        assert system is not None
        for flow in (one for one in system.messages if one.controls):
            assert flow.source is not None
            component = system.instance(flow.source.instance).component
            row = component.handler(flow.source.name)
            assert sending_rows(system, flow) == (f"{flow.source.instance}.{row}",)
            assert flow.period == component.handlers()[row].period
            rows.add(row)
    assert len(rows) == 2  # in the port region, and in a group


def test_values_cross_to_the_core_of_a_group() -> None:
    found = loaded(
        ("board: {context_switch", "board: {cores: 2, context_switch"),
        ("sensing: {", "sensing: {core: 2, "),
    )
    told = {one.code for one in found.diagnostics if one.is_error}
    system = loaded(("board: {context_switch", "board: {cores: 2, context_switch")).system
    assert system is not None and crossings(system) == ()
    assert told == set()
    assert found.system is not None
    assert {one.element for one in crossings(found.system)} == {
        "joint.order",
        "joint.torque",
        "joint.speed",
        "brake.order",
    }


# --- Virtual time


def test_a_port_ages_in_executions_of_its_group() -> None:
    machine = Machine(system_of())
    states: dict[int, str] = {}
    for now, slots in machine.instants(Ns(300 * MS)):
        list(machine.execute(now, slots))
        states[now // MS] = machine.instances["joint"].ports["torque"].state
    #  the last torque is taken at 190 ms; `max_age` is 4 executions of 5 ms
    assert (states[190], states[210], states[215]) == ("fresh", "fresh", "stale")


def test_a_group_takes_the_values_of_its_ports_only() -> None:
    machine = Machine(system_of())
    seen = []
    for now, slots in machine.instants(Ns(45 * MS)):
        puts = [Arrived(now, End("joint", "limit"), 7)] if now == 5 * MS else []
        list(machine.execute(now, slots, puts))
        ports = machine.instances["joint"].ports
        seen.append((now // MS, ports["speed"].value, ports["limit"].value))
    #  the limit comes at 5 ms and waits for the port region; brake.tell gives another one
    assert [one[:2] for one in seen[:4]] == [(0, 1), (5, 2), (10, 3), (15, 4)]
    assert [one[2] for one in seen[:5]] == [0, 0, 0, 0, 7]


# --- Code


def test_each_row_handles_its_ports_in_a_procedure_of_its_own() -> None:
    units = emit_instances(system_of(), "")
    _, body = (print_unit(u) for u in units if u.item.name == ref("Grouped_Feature", "Joint"))
    for name, ports in (("Ports", ["Limit"]), ("Fast", ["Torque", "Speed"]), ("Slow", ["Order"])):
        (own,) = re.findall(rf"procedure Run_{name} .*?end Run_{name};", body, re.DOTALL)
        assert re.findall(r"(\w+)_Mailbox\.Take", own) == ports
        assert ("Limit => 4," in own) == (name == "Fast")  # 20 ms in executions of 5 ms


# --- Editors


def test_a_group_is_named_anew_in_tables_and_a_port_in_its_group() -> None:
    now = model(PATH, {})
    for place, uses in (
        ("        fast: {", ["joint.fast"]),
        ("      torque: {in", ["[torque, speed"]),
    ):
        offset = TEXT.index(place) + len(place) - len(place.lstrip())
        found = now.symbols.at(str(PATH), offset)
        assert found is not None
        symbol, _ = found
        (places,) = renamed(now, symbol, "another", {}).values()
        for use in uses:
            begin = TEXT.index(use) + use.index(symbol.name)
            assert (begin, begin + len(symbol.name)) in places


def test_an_editor_proposes_ports_in_a_group() -> None:
    behind = "slow: {period: 40 ms, wcet: 50 us, ports: ["
    offset = TEXT.index(behind) + len(behind)
    found = [one.word for one in proposals(PATH, str(PATH), offset, {str(PATH): TEXT})]
    assert {"limit", "order"} <= set(found)


@pytest.mark.parametrize("strategy", ["period", "locality", "slack"])
def test_rows_of_groups_are_allocated_anew(
    strategy: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["allocate", "--strategy", strategy, "--yaml", str(PATH)]) == 0
    text = capsys.readouterr().out
    assert "joint.fast" in text and "brake.press" in text


def test_the_workbench_finds_the_times_of_a_group() -> None:
    document = Document.of(TEXT)
    places = ModelPlaces({str(PATH): document})
    row = places.row("joint.fast")
    assert row is not None
    assert (row.kind, row.text("period"), row.text("deadline")) == ("ports", "5 ms", "4 ms")
    at = places.row_at("joint.fast")
    assert at is not None and (at[0].name, at[1]) == ("driving", 0)
