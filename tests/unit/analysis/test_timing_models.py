# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Small models of which a bound was once too low: what runs, and what is said of it now."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest

from ravenchart.analysis.findings.deadlines import findings
from ravenchart.analysis.present.sentences import verdict_line
from ravenchart.analysis.system.timing import Analysis
from ravenchart.gen.pipeline import load
from tests.support.certificates import certificate, compiled
from tests.support.timing_models import CHART, KEPT, QUEUE, SEVERAL, SWITCHES, analysed


def said(analysis: Analysis) -> list[str]:
    """What is found wrong with it."""
    return [f"{item.code} {item.message}" for item in findings(analysis)]


# --- A sporadic processor suspends itself twice ----------------------------------------


def test_a_sporadic_processor_waits_for_a_frame_and_for_its_separation() -> None:
    """Of a frame that comes early it pays four context switches."""
    found = analysed(SWITCHES, ("context_switch: 5 us", "context_switch: 50 us"))
    assert (
        found.response("reception").bound == 40_000 + 4 * 50_000 + 1 * (40_000 + 2 * 50_000) + 5_000
    )


def test_switches_that_were_not_counted_are_a_deadline_missed() -> None:
    """Frames every millisecond: 380 us of each are gone, where 280 us were counted.

    With those 280 us the processor would need 19.8 ms of its 20 ms.
    """
    fast = (("context_switch: 5 us", "context_switch: 50 us"), ("period: 2 ms", "period: 1 ms"))
    early = ("released_by: can0, period: 1 ms", "released_by: can0, period: 999 us")
    (one,) = said(analysed(SWITCHES, *fast, early))
    assert "work has no response-time bound: it and the tasks that preempt it need 110 %" in one


# --- Chains through queues and charts --------------------------------------------------


def latency_of(analysis: Analysis) -> tuple[int | None, int | None]:
    """Reaction and age of the only chain."""
    ((_, found),) = analysis.limited
    return found.reaction, found.age


def test_what_a_queue_does_not_renew_ages_as_long_as_what_fills_it() -> None:
    """A valve told every 10 ms, of a command that comes every 100 ms: as with a sampled port."""
    queued, sampled = analysed(QUEUE), analysed(QUEUE, (", kind: queued, depth: 4", ""))
    assert latency_of(queued)[0] == latency_of(sampled)[0]
    (_, old), (_, older) = latency_of(queued), latency_of(sampled)
    assert old is not None and older is not None
    assert 100_000_000 < older <= old < 125_000_000
    apart = "  port_work: {node: cpu, stack: 32 KiB, activities: [d.ports]}\n"
    moved = analysed(QUEUE, (apart, ""), ("[d.act]", "[d.ports, d.act]"))
    assert (latency_of(moved)[1] or 0) > 100_000_000


def test_an_age_through_what_is_not_always_sent_or_set_has_no_bound() -> None:
    body = ("[{send: valve, with: i}]", "[{if: i > 3, then: [{send: valve, with: i}]}]")
    assert (latency_of(analysed(QUEUE, body))[1] or 0) > 100_000_000  # what is sent, is of that
    always = analysed(KEPT, ("if: i > 3, then: [{set: level, to: i}]", "set: level, to: i"))
    assert (latency_of(always)[1] or 0) > 100_000_000
    some = analysed(KEPT)
    assert latency_of(some)[1] is None and latency_of(some)[0] == latency_of(always)[0]
    (one,) = findings(some)
    assert "the age of cmd has no bound" in one.message
    assert one.notes[0][1] == "d.look gives d.level a new value in some of its jobs only"


def test_an_event_that_waits_behind_others_has_no_bound() -> None:
    """One is taken in an execution, so each that waits before it is 20 ms more."""
    (one,) = findings(analysed(CHART))
    assert "the reaction of stop has no bound" in one.message
    assert [note for _, note in one.notes] == [
        "brk.Main takes events, time-outs and completions one by one, oldest first"
    ]
    watching = CHART[: CHART.index("          a: {from: Run")]
    watching += "          halt: {from: Run, to: Halted, when: stop > 3}\n"
    watching += "          go: {from: Halted, to: Run, when: stop < 3}\n"
    watching += CHART[CHART.index("    activities:\n      act") :]
    assert (latency_of(analysed(watching))[0] or 0) < 30_000_000


def test_two_senders_put_two_values_in_a_queue_that_gives_one() -> None:
    (one,) = [item for item in findings(analysed(SEVERAL)) if item.code == "RV-0905"]
    assert "the reaction of cmd has no bound" in one.message
    assert [note for _, note in one.notes] == [
        "one and two both send to d.i, which gives one in a job"
    ]
    alone = ("      two: {period: 20 ms, wcet: 100 us, body: [{send: o, with: cmd}]}\n", "")
    reaction, _ = latency_of(analysed(SEVERAL, alone, (", s.two", "")))
    assert reaction is not None and reaction < 30_000_000


def test_a_region_of_several_steps_puts_as_many_values_in_a_queue() -> None:
    region = """\
    regions:
      Main:
        {period: 20 ms, wcet: 100 us, queue: 1, steps: STEPS, initial: Run, states: {Run: {}},
         transitions: {go: {from: Run, to: Run, when: cmd > 3, effect: [{send: o, with: cmd}]}}}
"""
    old = SEVERAL[SEVERAL.index("    activities:\n      one") : SEVERAL.index("  Dst:")]
    text = SEVERAL.replace(old, region).replace("s.one", "s.Main").replace(", s.two", "")
    reaction, _ = latency_of(analysed(text, ("STEPS", "1")))
    assert reaction is not None and reaction < 30_000_000
    found = analysed(text, ("STEPS", "3"))
    (one, _) = findings(found)
    assert [note for _, note in one.notes] == [
        "d.ports takes one value in a job, and s.Main may put 3 values at once in"
    ]


# --- Queues and their depths -----------------------------------------------------------


def test_queues_that_may_be_full_are_errors_with_the_depth_that_holds_all() -> None:
    two = ("messages:\n", "messages:\n  b: {bus: can0, id: 0x101, to: d.j, period: 5 ms}\n")
    port = ("ports: {", "ports: {j: {in: Word, kind: queued, depth: 2}, ")
    fast = ("port_region: {period: 10 ms", "port_region: {period: 5 ms")
    assert said(analysed(QUEUE, two, port, fast)) == []
    short = ("receive_depth: 8, transmit_depth: 8", "receive_depth: 1, transmit_depth: 1")
    found = analysed(QUEUE, two, port, fast, short)
    assert said(found) == [
        "RV-0906 up to 2 frames of can0 may wait for reception, but `receive_depth` is 1: "
        "the queue can overflow"
    ]
    assert not found.schedulable and "queues too short: receive_depth" in verdict_line(found)
    (one,) = said(analysed(QUEUE, two, port, fast, ("depth: 2", "depth: 1")))
    assert one.startswith("RV-0906 up to 2 values may wait in d.j, but `depth` is 1")
    slow = analysed(QUEUE, two, port)
    (one,) = said(slow)
    assert one.startswith("RV-0907 any number of values may wait in d.j, but `depth` is 2")
    assert slow.schedulable
    expected = ("depth: 2}", "depth: 2, overflow: drop_oldest}")
    assert said(analysed(QUEUE, two, port, expected)) == []


# --- What other nodes send -------------------------------------------------------------


def test_frames_that_others_send_to_others_take_their_time(tmp_path: Path) -> None:
    lower = "  x: {bus: can0, id: 0x700, bytes: 8, period: 1 ms}\n"
    higher = "  y: {bus: can0, id: 0x10, bytes: 0, period: 2 ms}\n"
    alone = analysed(QUEUE)
    shared = analysed(QUEUE, ("chains:\n", f"{lower}{higher}chains:\n"))
    assert findings(shared) == ()
    assert [message.name for message in shared.system.messages] == ["cmd", "valve"]
    before, after = (one.found.responses["can0.valve"].bound for one in (alone, shared))
    assert before is not None and after is not None
    assert after == before + 270_000 + 110_000  # an x has begun, and a y goes before it
    (bus,) = shared.system.buses
    assert shared.bus_load(bus) == alone.bus_load(bus) + Fraction(27, 100) + Fraction(55, 1000)
    assert compiled(certificate(shared), tmp_path) == ""
    assert "can0.x" in {name for name in shared.messages}


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        ("id: 0x700, period: 1 ms", "RV-0608"),
        ("id: 0x700, bytes: 8", "RV-0609"),
        ("id: 0x110, bytes: 8, period: 1 ms", "RV-0607"),
        ("id: 0x700, bytes: 9, period: 1 ms", "RV-0616"),
    ],
)
def test_traffic_of_others_that_says_too_little_is_refused(line: str, problem: str) -> None:
    text = QUEUE.replace("chains:\n", f"  x: {{bus: can0, {line}}}\nchains:\n")
    result = load(Path("model.yaml"), lambda path, limit: text.encode()[:limit])
    assert any(item.code.startswith(problem) for item in result.diagnostics), result.diagnostics
    mine = text.replace(f"  x: {{bus: can0, {line}}}\n", "")
    mine = mine.replace("id: 0x110, to: d.i", "id: 0x110, bytes: 0, to: d.i")
    result = load(Path("model.yaml"), lambda path, limit: mine.encode()[:limit])
    assert [item.code for item in result.diagnostics] == ["RV-0616"]


def test_less_urgent_frames_go_between_those_of_a_queue_in_memory(tmp_path: Path) -> None:
    """One mailbox, loaded again after each frame: x may win each time, and does so four times."""
    sent = "".join(f"  v{n}: {{bus: can0, id: 0x13{n}, from: d.v{n}}}\n" for n in range(3))
    ports = "".join(f"v{n}: {{out: Word}}, " for n in range(3))
    body = "".join(f"{{send: v{n}, with: i}}, " for n in range(3))
    lower = "  x: {bus: can0, id: 0x700, bytes: 8, period: 400 us, deadline: 4 ms}\n"
    found = analysed(
        QUEUE,
        ("chains:\n", f"{sent}{lower}chains:\n"),
        ("ports: {", "ports: {" + ports),
        ("[{send: valve", "[" + body + "{send: valve"),
    )
    frames = {one.frame.name: one for one in found.frames(found.system.buses[0])}
    last = frames["can0.valve"]
    assert last.bound is not None
    #  four own frames of 65 bits, one received, and an x before each
    assert last.bound >= last.frame.jitter + 4 * (130_000 + 270_000)
    said = compiled(certificate(found), tmp_path)
    assert said == "", said
