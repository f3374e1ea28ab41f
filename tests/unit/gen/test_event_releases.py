# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Processors that the events of a region release: their chains, queues, code and virtual time."""

from __future__ import annotations

import random
from itertools import pairwise
from pathlib import Path

import pytest

from ravenchart.analysis.core.chains import HopKind, Latency
from ravenchart.analysis.findings.deadlines import findings
from ravenchart.analysis.system.depths import depths
from ravenchart.analysis.system.journeys import journeys
from ravenchart.analysis.system.observed import read_map, read_trace
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.behaviour.interpreter.branching import branched
from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.behaviour.interpreter.stimuli import Raised
from ravenchart.behaviour.rules import findings as of_behaviour
from ravenchart.building import checking, generation
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.text import print_unit
from ravenchart.gen.emit.instances.glue import emit_instances
from ravenchart.gen.emit.tables.trace_map import trace_json
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.instances import Events
from ravenchart.gen.model.raising import more_events, raised_at_once
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import Loaded, load
from ravenchart.independent.check import checked
from ravenchart.language_server.completing import proposals
from ravenchart.paths import ROOT

FOLDER = ROOT / "tests" / "feature" / "raised"
TEXT = (FOLDER / "model.yaml").read_text(encoding="utf-8")
MS = 1_000_000
Change = tuple[str, str]

CALM = "        queue: 2\n        initial: Calm"
OFTEN = ("      check:\n        period: 40 ms", "      check:\n        period: 20 ms")
"""The activity raises its two events as often as one of them can release the region."""


def changed(*changes: Change) -> str:
    text = TEXT
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    return text


def loaded(*changes: Change) -> Loaded:
    text = changed(*changes)
    return load(Path("model.yaml"), lambda path, limit: text.encode())


def system_of(*changes: Change) -> System:
    found = loaded(*changes)
    assert found.system is not None, [one.message for one in found.diagnostics]
    assert found.diagnostics == ()
    return found.system


def chain(found: Analysis, name: str) -> Latency:
    return next(latency for one, latency in found.limited if one.name == name)


def done(found: Analysis, row: str) -> int:
    bound = next(one.bound for _, one in found.rows() if one.row.name == row)
    assert bound is not None
    return bound


def reasons(found: Analysis) -> list[str]:
    return [text for one in findings(found) for _, text in one.notes]


# --- Bounds


def test_an_event_of_an_activity_waits_for_one_response_and_those_before_it() -> None:
    found = analyse(system_of())
    latency = chain(found, "tripped")
    kinds = [hop.step.hop for hop in latency.hops]
    assert kinds == [HopKind.SAMPLED, HopKind.WOKEN, HopKind.RELEASED]
    raised, taken, acted = (done(found, row) for row in ("guard.check", "guard.Watch", "guard.act"))
    #  of the two events that one execution may raise, the second waits a separation more
    assert latency.reaction == 40 * MS + raised + 20 * MS + taken + acted


def test_an_event_of_a_port_waits_for_one_response() -> None:
    found = analyse(system_of())
    sent, handled, taken = (done(found, row) for row in ("panel.scan", "keys.ports", "keys.Keys"))
    #  both are rows of one processor with different periods: the port region samples the queue
    queued = chain(found, "switched").hops[1]
    assert queued.step.hop is HopKind.QUEUED
    assert chain(found, "switched").reaction == 40 * MS + sent + (queued.wait or 0) + handled + (
        2 * taken
    )


def test_a_periodic_region_takes_events_without_bound() -> None:
    periodic = system_of(("released_by: guard.Watch, period: 20 ms, ", ""))
    (told,) = findings(analyse(periodic))
    assert told.message == "the chain tripped is broken: no values go from guard.check to guard.act"


def test_events_of_several_rows_have_no_bound() -> None:
    more = (
        "- {send: valve, with: wanted}",
        "- {send: valve, with: wanted}\n          - {if: wanted > 700, then: [{raise: Normal}]}",
    )
    found = analyse(system_of(more))
    assert chain(found, "tripped").reaction is None
    assert "guard.act raises events for guard.Watch as well" in reasons(found)


@pytest.mark.parametrize(
    ("change", "other"),
    [
        (("raises: []", "raises: [guard.Normal]"), "a fault, a bus or the shutdown"),
        (("Normal: {}}", "Normal: {external: true}}"), "the environment"),
        (
            (CALM, CALM.replace("initial", "on_overflow: Normal\n        initial")),
            "a full queue of guard.Watch",
        ),
    ],
)
def test_events_from_outside_have_no_bound(change: Change, other: str) -> None:
    system = system_of(change)
    why = f"{other} raises events for guard.Watch as well"
    assert more_events(system, Events("guard", "Watch"), "guard.check") == why
    assert chain(analyse(system), "tripped").reaction is None


def test_a_region_that_takes_completions_too_has_no_bound() -> None:
    worked = ("path: [panel.scan, keys.Keys], reaction", "path: [keys.Keys, keys.Work], reaction")
    found = analyse(system_of(worked))
    assert chain(found, "switched").reaction is None
    assert "keys.Work takes completions as well as events" in reasons(found)


def test_an_event_that_a_sporadic_row_raises_has_no_bound() -> None:
    changes = (
        ("path: [panel.scan, keys.Keys], reaction", "path: [keys.Keys, keys.Work], reaction"),
        ("cleared: {from: Clearing, to: Done}", "cleared: {from: Clearing, to: Done, on: Told}"),
    )
    why = "keys.Keys raises events for keys.Work, and is on a sporadic processor"
    assert why in reasons(analyse(system_of(*changes)))


def test_events_that_come_faster_than_the_separation_have_no_bound() -> None:
    found = analyse(system_of(OFTEN))
    assert chain(found, "tripped").reaction is None
    why = "guard.check may raise 2 events every 20 ms, but tripping is released every 20 ms at most"
    assert why in reasons(found)


def test_an_age_through_events_has_no_bound() -> None:
    found = analyse(system_of(("reaction: 70 ms", "age: 70 ms")))
    assert chain(found, "tripped").age is None
    assert "guard.check raises events for guard.Watch in some jobs only" in reasons(found)


def test_a_queue_is_compared_with_what_may_wait_where_one_row_fills_it() -> None:
    found = {one.what: (one.given, one.needed) for one in depths(analyse(system_of()))}
    assert found["events may wait in the queue of guard.Watch"] == (2, 2)
    assert found["events may wait in the queue of keys.Keys"] == (2, 1)
    assert "events may wait in the queue of keys.Work" not in found
    often = {one.what: one.needed for one in depths(analyse(system_of(OFTEN)))}
    assert often["events may wait in the queue of guard.Watch"] is None


def test_one_execution_raises_as_many_events_as_its_worst_step() -> None:
    system = system_of()
    assert raised_at_once(system, Events("guard", "Watch")) == {"guard.check": 2}
    assert raised_at_once(system, Events("keys", "Keys")) == {"keys.ports": 1}
    assert raised_at_once(system, Events("keys", "Work")) == {"keys.Keys": 2}


def test_it_counts_in_the_analysis_with_its_separation() -> None:
    (task,) = (t for t in analyse(system_of()).network.tasks if t.name == "tripping")
    assert (task.period, task.jitter, task.sporadic, task.suspensions) == (20 * MS, 0, True, 2)


# --- Code


def body_of(name: str) -> str:
    return next(
        print_unit(unit)
        for unit in emit_instances(system_of(), "")
        if unit.item.name == ref(f"Raised_Feature.{name}") and getattr(unit.item, "is_body", False)
    )


def test_an_event_is_noted_before_it_releases() -> None:
    body = body_of("Guard")
    assert 0 < body.index("Ravenchart.Traces.Raised") < body.index("Watch_Offers.Offer (")


def test_a_processor_waits_for_events_and_completions_once_its_region_has_started() -> None:
    body = body_of("Keys")
    start = body.index("procedure Await_Work is")
    words = " ".join(body[start : body.index("end Await_Work", start)].split())
    assert words.endswith(
        "begin if not Work_Region.Started then Run_Work (Unused); end if; "
        "if not Work_Region.Completed_Clearing then Work_Queue.Wait; end if;"
    )


def test_the_independent_checker_agrees(tmp_path: Path) -> None:
    path = tmp_path / "model.yaml"
    path.write_text(TEXT, encoding="utf-8")
    written = generation.write_program(checking.check(path))
    assert checked(path).disagreements == []
    certificate = next(written.folder.glob("*certificate.ads"))
    text = certificate.read_text(encoding="utf-8")
    old = "Tripping_T : constant := 20_000_000"
    assert old in text
    certificate.write_text(text.replace(old, "Tripping_T : constant := 30_000_000"), "utf-8")
    assert any("Tripping_T" in str(one) for one in checked(path).disagreements)


# --- Runs


def test_a_journey_follows_the_event_and_ends_where_none_is_raised() -> None:
    found = analyse(system_of())
    known = read_map(trace_json(found.system))
    lines = ["E 0"]
    for time, what in (
        (0, "check"),
        (40, "check"),
        (41, "High"),
        (42, "Watch"),
        (43, "act"),
        (80, "check"),
        (120, "check"),
    ):
        kind, row = ("raised", "event") if what == "High" else ("activity", "row")
        lines.append(f"T {time * MS} {kind} {known.named(f'guard.{what}', row).number} 0")
    seen = {one.chain: one for one in journeys(found, read_trace([*lines, "END"], known))}
    #  to the event of the execution at 40, whose input the one at 0 has just missed
    assert (seen["tripped"].count, seen["tripped"].observed) == (1, 43 * MS)


# --- Names


@pytest.mark.parametrize(("behind", "proposed"), [("released_by: guard.", "Watch")])
def test_an_editor_proposes_regions(behind: str, proposed: str) -> None:
    path = FOLDER / "model.yaml"
    found = proposals(path, str(path), TEXT.index(behind) + len(behind), {str(path): TEXT})
    words = [one.word for one in found]
    assert proposed in words and "check" not in words


def test_an_activity_releases_nothing() -> None:
    (told,) = loaded(("released_by: guard.Watch", "released_by: guard.check")).diagnostics
    assert (told.code, told.message) == ("RV-0305", "there is no port of Guard_Type named `check`")


def test_a_row_that_sends_a_message_is_not_released() -> None:
    change = (
        "processors:\n",
        "buses:\n  line: {bit_rate: 500 kbit/s, driver_wcet: 20 us, receive_depth: 4, "
        "transmit_depth: 4}\nmessages:\n  told: {bus: line, id: 0x100, from: guard.valve}\n"
        "processors:\n",
    )
    (told,) = [one.message for one in loaded(change).diagnostics]
    assert told.endswith("its processor sends guard.valve as the message told")


def test_an_invariant_that_is_not_proved_is_not_searched_either() -> None:
    change = (
        "    regions:\n      Watch:",
        "    never:\n      calm: in(Watch.Calm) and wanted > 0\n"
        "      low: in(Watch.Tripped) and level < 100\n    regions:\n      Watch:",
    )
    found = loaded(change)
    assert found.system is not None
    (told,) = of_behaviour(found.system)
    assert told.message.startswith("the invariant low is not proved")
    assert "nothing says how often guard.Watch is released" in str(told.hint)


# --- Virtual time


def event(at: int, name: str = "Normal") -> Raised:
    return Raised(Ns(at), "guard", name, None)


def test_regions_start_before_the_first_instant() -> None:
    machine = Machine(system_of())
    now, slots = next(machine.instants(Ns(0)))
    steps = [(one.at, one.region) for one in machine.execute(now, slots)]
    assert steps[:3] == [(0, "Watch"), (0, "Keys"), (0, "Work")]
    assert machine.earliest["tripping"] == 0


def test_two_branches_have_starts_of_their_own() -> None:
    machine = Machine(system_of())
    other = branched(machine)
    now, slots = next(machine.instants(Ns(0)))
    list(other.execute(now, slots))
    assert (machine.started, other.started) == (False, True)


@pytest.mark.parametrize("seed", range(3))
def test_no_event_is_lost_or_taken_twice(seed: int) -> None:
    chance = random.Random(seed)
    deep = (CALM, CALM.replace("2", "60"))
    machine = Machine(system_of(deep))
    run = machine.instances["guard"].regions["Watch"]
    given, taken = 0, []
    for now, slots in machine.instants(Ns(1_000 * MS)):
        raised = [event(now)] if chance.random() < 0.3 and now < 400 * MS else []
        given += len(raised)
        before = machine.earliest["tripping"]
        list(machine.execute(now, slots, raised))
        if machine.earliest["tripping"] != before:
            taken.append(now)
    #  check raises an event in every fifth or sixth of its executions
    own = sum(1 for k in range(26) if (k % 11 + 1) in (5, 10))
    assert len(taken) + len(run.queue) == given + own
    assert min(b - a for a, b in pairwise(taken)) >= 20 * MS
