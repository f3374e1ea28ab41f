# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Traces of several nodes as one, and how long values took along the chains in it."""

from __future__ import annotations

import pytest

from ravenchart.analysis.system.journeys import Journey, journeys
from ravenchart.analysis.system.observed import Observation, merged, read_map, read_trace
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.gen.derive.completion import programs
from ravenchart.gen.emit.tables.trace_map import trace_json
from tests.support.two_nodes import system_of

MS = 1_000_000


@pytest.fixture(scope="module")
def analysis() -> Analysis:
    return analyse(system_of())


def seen(analysis: Analysis, panel: list[str], drive: list[str], late: int = 0) -> Observation:
    """Both traces; lines as ``time kind element``, and the drive's time begins so much later."""
    parts = {}
    for part, lines in zip(programs(analysis.system), (panel, drive), strict=True):
        known = read_map(trace_json(part))
        node = part.nodes[0].name
        text = [f"E {5_000 * MS + (late if node == 'drive' else 0)}"]
        for line in lines:
            words = line.split()
            if words[0] == "A":
                text.append(f"A {known.named(words[1], 'row').number} {words[2]}")
                continue
            time, kind, name = words
            row = {"activity": "row", "sent": "message", "arrived": "port"}[kind]
            text.append(f"T {int(float(time) * MS)} {kind} {known.named(name, row).number} 0")
        parts[node] = read_trace([*text, "L trace 0", "END"], known)
    return merged(parts)


PANEL = [
    "0 activity supervisor.plan",  # before the drive runs: no reaction is counted from here
    "0.1 sent supervisor_order",
    "60 activity supervisor.plan",
    "60.1 sent supervisor_order",
    "80 activity supervisor.plan",
    "80.1 sent supervisor_order",
]
DRIVE = [
    "-7 activity servo.ports",
    "74 arrived servo.order",
    "78 activity servo.ports",
    "78.3 activity servo.control",
    "A servo.control 200000",
]


def test_times_of_all_nodes_count_from_the_first_start(analysis: Analysis) -> None:
    found = seen(analysis, PANEL, DRIVE, late=7 * MS)
    assert [r.time for r in found.of("arrived", "servo.order")] == [81 * MS]
    assert [r.time for r in found.of("sent", "supervisor_order")] == [
        MS // 10,
        601 * MS // 10,
        801 * MS // 10,
    ]
    times = [record.time for record in found.records]
    assert times == sorted(times)
    assert found.complete
    assert found.counts == {"panel.trace": 0, "drive.trace": 0}
    assert found.executions == {"servo.control": 200_000}


def test_a_reaction_is_to_what_the_run_before_has_just_missed(analysis: Analysis) -> None:
    planned = next(j for j in journeys(analysis, seen(analysis, PANEL, DRIVE, late=7 * MS)))
    bound = dict((c.name, found.reaction) for c, found in analysis.limited)["planned"]
    places = len(next(c.way for c, _ in analysis.limited if c.name == "planned"))
    # from the plan at 60, whose input was missed, to the control at 85.3 and its 0.2
    assert planned == Journey("planned", 1, 25_500_000, bound or 0, 60 * MS, places)
    assert not planned.exceeded


def test_a_reaction_above_its_bound_is_told(analysis: Analysis) -> None:
    found = journeys(analysis, seen(analysis, PANEL, DRIVE, late=50 * MS))
    assert [j.chain for j in found if j.exceeded] == ["planned"]


def test_a_job_that_sends_nothing_is_no_reaction(analysis: Analysis) -> None:
    panel = [*PANEL[:-1], "100 activity supervisor.plan", "100.1 sent supervisor_order"]
    drive = [
        *DRIVE[:1],
        *(f"{float(n.split()[0]) + 20} {n.split(maxsplit=1)[1]}" for n in DRIVE[1:4]),
    ]
    planned = next(j for j in journeys(analysis, seen(analysis, panel, drive, late=7 * MS)))
    # from the plan at 80; the one at 60 had sent nothing for what its run before had missed
    assert (planned.count, planned.observed) == (1, 25_300_000)


def test_what_never_arrives_is_no_reaction(analysis: Analysis) -> None:
    assert not journeys(analysis, seen(analysis, PANEL, DRIVE[:1], late=7 * MS))
