# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Processors that a queued port releases: their chains, queues, code and virtual time."""

from __future__ import annotations

import random
from itertools import pairwise
from pathlib import Path

import pytest

from ravenchart.analysis.core.chains import HopKind
from ravenchart.analysis.findings.advice import lines, of_model
from ravenchart.analysis.findings.deadlines import findings
from ravenchart.analysis.system.depths import depths
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.behaviour.interpreter.branching import branched
from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.behaviour.interpreter.stimuli import Arrived
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.text import print_unit
from ravenchart.gen.emit.instances.glue import emit_instances
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.instances import End
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import load
from ravenchart.language_server.completing import proposals
from ravenchart.paths import ROOT

TEXT = (ROOT / "tests" / "feature" / "releases" / "model.yaml").read_text(encoding="utf-8")
MS = 1_000_000

SELDOM = (
    (
        "position: {out: Level}\n    port_region: {period: 10 ms",
        "position: {out: Level}\n    port_region: {period: 20 ms",
    ),
    ("period: 10 ms\n        wcet: 300 us", "period: 20 ms\n        wcet: 300 us"),
    ("released_by: drive.level, period: 10 ms", "released_by: drive.level, period: 20 ms"),
)
"""The drive has the period of its sender."""


def system_of(*changes: tuple[str, str]) -> System:
    text = TEXT
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    loaded = load(Path("model.yaml"), lambda path, limit: text.encode())
    assert loaded.system is not None, [one.message for one in loaded.diagnostics]
    assert loaded.diagnostics == ()
    return loaded.system


def chain(found: Analysis, name: str = "follow") -> tuple[int | None, int | None]:
    known = next(latency for one, latency in found.limited if one.name == name)
    return known.reaction, known.age


def done(found: Analysis, row: str) -> int:
    bound = next(one.bound for _, one in found.rows() if one.row.name == row)
    assert bound is not None
    return bound


def test_a_value_waits_for_one_response_at_most() -> None:
    found = analyse(system_of())
    sent, handled, moved = (
        done(found, row) for row in ("gauge.measure", "drive.ports", "drive.move")
    )
    latency = next(latency for one, latency in found.limited if one.name == "follow")
    assert [hop.step.hop for hop in latency.hops] == [
        HopKind.SAMPLED,
        HopKind.WOKEN,
        HopKind.RELEASED,
    ]
    assert latency.reaction == 20 * MS + sent + handled + moved
    assert latency.age == sent + handled + moved
    assert latency.renewal == 20 * MS


def test_a_periodic_receiver_takes_a_period_more() -> None:
    released, _ = chain(analyse(system_of()))
    periodic, _ = chain(analyse(system_of(("released_by: drive.level, period: 10 ms, ", ""))))
    assert released is not None and periodic is not None
    assert periodic > released + 9 * MS


def test_what_samples_behind_it_counts_the_period_of_the_sender() -> None:
    found = analyse(system_of(("reaction: 50 ms}", "age: 50 ms}")))
    _, age = chain(found, "shown")
    _, before = chain(found)
    assert before is not None
    assert age == before + 20 * MS + done(found, "panel.Lamp")


def test_a_separation_over_the_period_of_the_sender_has_no_bound() -> None:
    found = analyse(
        system_of(
            ("period: 20 ms\n        wcet: 200 us", "period: 5 ms\n        wcet: 200 us"),
            ("measuring: {deadline: 10 ms, ", "measuring: {"),
        )
    )
    assert chain(found) == (None, None)
    told = list(findings(found))
    why = "gauge.measure may send every 5 ms, but driving is released every 10 ms at most"
    assert why in [text for one in told for _, text in one.notes]
    assert any("any number of values may wait in drive.level" in one.message for one in told)


def test_a_chain_that_begins_with_such_a_row_has_no_bound() -> None:
    changed = ("[gauge.measure, drive.move], reaction", "[drive.move, panel.Lamp], reaction")
    found = analyse(system_of(changed))
    assert chain(found) == (None, None)
    why = "drive.move runs only when a value for drive.level comes"
    assert why in [text for one in findings(found) for _, text in one.notes]


def test_an_age_behind_what_is_sent_now_and_then_has_one_reason_and_a_hint_that_works() -> None:
    old = "path: [gauge.measure, drive.move], reaction: 30 ms, age: 10 ms}"
    new = "path: [gauge.measure, valve.act], reaction: 90 ms"
    often = ("30 ms", "20 ms")
    (told,) = findings(analyse(system_of((old, new + ", age: 90 ms}"), often)))
    assert told.message == "the age of follow has no bound; its limit is 90 ms"
    why = "gauge.measure gives gauge.order a new value in some of its jobs only"
    assert [text for _, text in told.notes] == [why]
    assert told.hint == "limit the reaction instead"
    assert not list(findings(analyse(system_of((old, new + "}"), often))))


def test_where_deadlines_are_met_no_execution_time_is_to_blame() -> None:
    old = "path: [gauge.measure, drive.move], reaction: 30 ms, age: 10 ms}"
    found = of_model(analyse(system_of((old, "path: [gauge.measure, valve.act], age: 90 ms}"))))
    assert found is not None
    assert not any("all else" in line for line in lines(found))


def test_several_values_of_one_execution_wait_for_each_other() -> None:
    blown = "  shown: {path: [panel.Lamp, horn.blow], reaction: 50 ms}"
    found = analyse(
        system_of(("  shown: {path: [gauge.measure, panel.Lamp], reaction: 50 ms}", blown))
    )
    reaction, _ = chain(found, "shown")
    handled = done(found, "horn.ports")
    within = 10 * MS + done(found, "panel.Lamp") + handled + 5 * MS + done(found, "horn.blow")
    assert reaction == within
    waiting = {one.what: (one.given, one.needed) for one in depths(found)}
    assert waiting["values may wait in horn.order"] == (4, 2)


def test_several_values_may_come_too_often() -> None:
    seldom = (
        ("order: {in: Order, kind: queued, depth: 4}\n    port_region: {period: 5 ms", 6),
        ("      blow:\n        period: 5 ms", 6),
        ("released_by: horn.order, period: 5 ms", 6),
    )
    changes = [(old, old.replace("5 ms", f"{new} ms")) for old, new in seldom]
    found = analyse(
        system_of(
            *changes,
            (
                "  shown: {path: [gauge.measure, panel.Lamp], reaction: 50 ms}",
                "  shown: {path: [panel.Lamp, horn.blow], reaction: 50 ms}",
            ),
        )
    )
    assert chain(found, "shown") == (None, None)
    why = "panel.Lamp may send 2 values every 10 ms, but blowing is released every 6 ms at most"
    assert why in [text for one in findings(found) for _, text in one.notes]


def test_its_queue_is_compared_with_what_may_wait() -> None:
    found = {one.what: (one.given, one.needed) for one in depths(analyse(system_of()))}
    assert found["values may wait in drive.level"] == (2, 1)


def test_it_counts_in_the_analysis_with_its_separation() -> None:
    (task,) = (t for t in analyse(system_of()).network.tasks if t.name == "driving")
    assert (task.period, task.jitter, task.sporadic, task.suspensions) == (10 * MS, 0, True, 2)


def test_an_arrival_is_noted_before_it_releases() -> None:
    body = next(
        print_unit(unit)
        for unit in emit_instances(system_of(), "")
        if unit.item.name == ref("Releases_Feature.Drive") and getattr(unit.item, "is_body", False)
    )
    assert body.index("Elements.Drive_Level, 0") < body.index("Level_Offers.Offer (")


@pytest.mark.parametrize(
    ("behind", "proposed"),
    [("driving: {released_by: ", "valve"), ("driving: {released_by: drive.", "level")],
)
def test_an_editor_proposes_instances_and_their_ports(behind: str, proposed: str) -> None:
    path = ROOT / "tests" / "feature" / "releases" / "model.yaml"
    offset = TEXT.index(behind) + len(behind)
    found = proposals(path, str(path), offset, {str(path): TEXT})
    assert proposed in [one.word for one in found]


def test_a_name_that_is_neither_bus_nor_instance_is_told_so() -> None:
    text = TEXT.replace("released_by: drive.level", "released_by: measuring")
    (told,) = load(Path("model.yaml"), lambda path, limit: text.encode()).diagnostics
    assert (told.code, told.message) == ("RV-0305", "there is no bus or instance named `measuring`")
    assert told.hint == "name a bus, or a queued input port as `instance.port`"


def test_the_table_of_a_port_that_is_sampled_is_not_judged() -> None:
    text = TEXT.replace("released_by: drive.level", "released_by: panel.position")
    told = load(Path("model.yaml"), lambda path, limit: text.encode()).diagnostics
    assert [one.code for one in told] == ["RV-0715", "RV-0715"]  # sampled, and beside a region


# --- Virtual time


def put(end: str, value: int, at: int) -> Arrived:
    instance, _, port = end.rpartition(".")
    return Arrived(Ns(at), End(instance, port), value)


def test_a_value_is_handled_at_the_instant_at_which_it_was_sent() -> None:
    machine = Machine(system_of())
    now, slots = next(machine.instants(Ns(0)))
    assert now == 0
    list(machine.execute(now, slots))
    assert machine.instances["drive"].ports["level"].value == 1
    assert not machine.instances["drive"].mailboxes["level"].waiting


def test_the_separation_is_kept_and_values_wait() -> None:
    machine = Machine(system_of(*SELDOM))
    seen = []
    for now, slots in machine.instants(Ns(80 * MS)):
        puts = [put("drive.level", 700, 10 * MS)] if now == 10 * MS else []
        list(machine.execute(now, slots, puts))
        waiting = len(machine.instances["drive"].mailboxes["level"].waiting)
        seen.append((now // MS, machine.instances["drive"].ports["level"].value, waiting))
    #  1 comes at 0; 700 at 10 waits for 20, where 2 comes and waits for 40, and so on
    assert seen[:5] == [(0, 1, 0), (10, 1, 1), (20, 700, 1), (30, 700, 1), (40, 2, 1)]


def test_two_branches_have_separations_of_their_own() -> None:
    machine = Machine(system_of(*SELDOM))
    now, slots = next(machine.instants(Ns(0)))
    other = branched(machine)
    list(other.execute(now, slots))
    assert (machine.earliest["driving"], other.earliest["driving"]) == (0, 20 * MS)


def test_an_urgent_one_runs_before_what_is_less_urgent() -> None:
    machine = Machine(system_of())
    now, slots = next(machine.instants(Ns(0)))
    list(machine.execute(now, slots))
    #  driving (D = 5 ms) is above showing (D = 10 ms), whose port region has seen its value
    assert machine.instances["panel"].ports["position"].value == 1


@pytest.mark.parametrize("seed", range(3))
def test_nothing_is_lost_or_handled_twice(seed: int) -> None:
    chance = random.Random(seed)
    machine = Machine(system_of(*SELDOM, ("kind: queued, depth: 2}", "kind: queued, depth: 60}")))
    given = 0
    handled = []
    for now, slots in machine.instants(Ns(1_000 * MS)):
        puts = [put("drive.level", 0, now)] if chance.random() < 0.1 and now < 400 * MS else []
        given += len(puts)
        before = machine.earliest["driving"]
        list(machine.execute(now, slots, puts))
        if machine.earliest["driving"] != before:
            handled.append(now)
    left = len(machine.instances["drive"].mailboxes["level"].waiting)
    assert len(handled) + left == given + 51
    assert min(b - a for a, b in pairwise(handled)) >= 20 * MS
