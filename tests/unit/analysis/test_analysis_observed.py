# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Reading a controller's trace: what it tells, and what is refused."""

from __future__ import annotations

import json
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravenchart.analysis.system.observed import (
    FAULTS,
    Observation,
    QueueFill,
    Releases,
    TraceError,
    Visit,
    read_map,
    read_trace,
)
from ravenchart.gen.language.terms import Ns
from ravenchart.paths import ROOT
from tests.support.robot_files import trace_map

MAP = read_map(trace_map(["x"]))

GOOD = """\
T 0 STATE 10 0
T 10 STATE 3 0
T 1000 Arrived 11 0
T 2000 TRANSITION 10 0
T 2000 State 10 1
T 3000 STATE 10 1
T 9000 STATE 10 0
T 9500 FAULT 1 0
P 1 500 2 812345
A 2 99000
H DEADLINE_MISS 2
L trace 0
L field.received 3
L field.lost_in 2
W 120000
END
"""


def read(text: str) -> Observation:
    return read_trace(text.splitlines(), MAP, "trace.txt")


def test_a_complete_trace_tells_everything() -> None:
    seen = read(GOOD)
    assert seen.complete
    assert (seen.processors["control"].releases, seen.misses) == (500, 2)
    assert seen.processors["control"].worst_response == 812_345
    assert seen.executions == {"joint_x.position_control": 99_000}
    assert (seen.faults, seen.losses) == ({"DEADLINE_MISS": 2}, {"trace": 0, "field.lost_in": 2})
    assert (seen.trace_lost, seen.end, seen.host_latency) == (0, 9_500, 120_000)


def test_a_processor_has_its_last_response_where_the_program_reports_it() -> None:
    older, newer = (read(f"N 7\nP 1 9 1 500{last}\nEND\n") for last in ("", " 300"))
    assert older.processors == {"control": Releases(9, 1, Ns(500), Ns(7))}
    assert newer.processors == {"control": Releases(9, 1, Ns(500), Ns(7), Ns(300))}


def test_a_queue_of_a_chart_has_its_fill_and_the_highest() -> None:
    assert read("Q 10 1 4\nQ 10 0 5\n").queues == {"joint_x.Motion": QueueFill(0, 5)}


def test_states_are_read_as_visits_and_repetitions_are_one() -> None:
    assert read(GOOD).visits("joint_x.Motion") == (
        Visit("Idle", 0, 2_000),  # type: ignore[arg-type]
        Visit("Seeking", 2_000, 9_000),  # type: ignore[arg-type]
        Visit("Idle", 9_000, None),  # type: ignore[arg-type]
    )
    assert read(GOOD).states_visited() == {
        "coordinator.Mission": ("Waiting",),
        "joint_x.Motion": ("Idle", "Seeking"),
    }


def test_transitions_and_arrivals_are_found_by_name() -> None:
    seen = read(GOOD)
    assert [r.text for r in seen.of("transition", "JOINT_X.motion")] == ["start_homing"]
    assert [r.time for r in seen.of("arrived", "joint_x.feedback")] == [1_000]


def test_a_trace_without_its_last_line_is_incomplete() -> None:
    assert not read(GOOD.removesuffix("END\n")).complete
    assert not read("").complete


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("T 1 STATE 10", "not a trace line: 'T 1 STATE 10'"),
        ("X 1 2", "not a trace line: 'X 1 2'"),
        ("T x STATE 10 0", "'x' is not a number"),
        ("T 1 STATE 10 99", "joint_x.Motion has no state number 99"),
        ("T 1 STATE 10 -1", "joint_x.Motion has no state number -1"),
        ("T 1 TRANSITION 10 1", "joint_x.Motion has no transition number 1"),
        ("T 1 STATE 11 0", "element 11, joint_x.feedback, is a port, not a region or a bus"),
        ("T 1 SENT 77 0", "the map has no element 77"),
        ("T 1 DREAMT 10 0", "unknown kind 'DREAMT'"),
        ("P 10 1 2 3", "element 10, joint_x.Motion, is a region, not a processor"),
        ("P 1 -1 0 0", "-1 is negative"),
        ("P 1 1 0 5 -1", "-1 is negative"),
        ("P 1 1 0", "not a trace line: 'P 1 1 0'"),
        ("P 1 1 0 5 4 3", "not a trace line: 'P 1 1 0 5 4 3'"),
        ("Q 1 0 0", "element 1, control, is a processor, not a region"),
        ("Q 10 0", "not a trace line: 'Q 10 0'"),
        ("A 2 9999999999999999999999", "'99999999999999999999' is not a number"),
        ("H KIND", "not a trace line: 'H KIND'"),
        ("T 1_0 STATE 10 0", "'1_0' is not a number"),
    ],
)
def test_a_malformed_line_is_named_with_its_reason(line: str, reason: str) -> None:
    with pytest.raises(TraceError) as caught:
        read(f"T 0 STATE 10 0\n{line}\nEND\n")
    assert str(caught.value) == f"trace.txt:2: error: {reason}"


def test_nothing_may_follow_the_last_line() -> None:
    with pytest.raises(TraceError, match=r"^trace.txt:2: error: nothing may follow END$"):
        read("END\nEND\n")


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("{", "trace.json:1: error: not JSON"),
        ("[]", "trace.json: error: not a trace map"),
        ("{}", "trace.json: error: not a trace map: elements is missing"),
        ('{"elements": [{"id": 1}]}', "trace.json: error: not a trace map: element is missing"),
        ('{"elements": [{"id": "x", "element": "", "kind": ""}]}', "error: not a trace map"),
        ('{"elements": 3}', "error: not a trace map"),
    ],
)
def test_a_malformed_map_is_an_error_in_words(text: str, reason: str) -> None:
    with pytest.raises(TraceError) as caught:
        read_map(text)
    assert reason in str(caught.value)


def test_a_map_with_the_same_number_twice_is_refused() -> None:
    content = json.loads(trace_map(["x"]))
    content["elements"].append(content["elements"][0])
    with pytest.raises(TraceError, match="the same id"):
        read_map(json.dumps(content))


def test_elements_are_found_by_kind() -> None:
    assert [e.name for e in MAP.of_kind("region")] == ["coordinator.Mission", "joint_x.Motion"]
    assert MAP.named("Control", "processor").number == 1
    with pytest.raises(KeyError):
        MAP.named("control", "region")


@given(st.lists(st.text(alphabet="TPAHLEND 0123456789-STAE\u00b2x", max_size=24), max_size=6))
def test_any_text_is_read_or_refused_in_words(lines: list[str]) -> None:
    try:
        read_trace(lines, MAP)
    except TraceError as fault:
        assert str(fault).startswith("trace:")


def test_faults_have_the_names_and_the_order_of_the_runtime() -> None:
    spec = (ROOT / "spark_runtime" / "src" / "ravenchart-health.ads").read_text(encoding="utf-8")
    kinds = re.search(r"type Fault_Kind is\s*\(([^)]*)\)", spec)
    assert kinds is not None
    assert tuple(name.strip() for name in kinds[1].split(",")) == FAULTS
