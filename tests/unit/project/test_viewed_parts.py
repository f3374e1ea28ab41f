# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The parts of a run that are compared: which releases are in each, and which are too long."""

from __future__ import annotations

import pytest

from ravenchart.analysis.present.report import Comparison
from ravenchart.analysis.system.observed import (
    NumberedElement,
    Observation,
    TraceMap,
    TraceRecord,
)
from ravenchart.gen.language.terms import Ns
from ravenchart.running.process import Ended
from ravenchart.running.result import RunOutcome
from tests.support.viewed_parts import LAST_VALUES, PERIODS, NoPartError, part_of

MS = 1_000_000
RELEASES = 40
BOUND = 2 * MS


def outcome(late: int, *failures: str, withheld: int = 0) -> RunOutcome:
    """A run in which each response is 1 ms, but the one of `control` that was due late is 3 ms."""
    values = [
        TraceRecord(
            Ns(number * period + (3 * MS if (name, number) == ("control", late) else MS)),
            "value", NumberedElement(1, LAST_VALUES[name], "value", ""), 0,
        )
        for name, period in PERIODS.items()
        for number in range(RELEASES)
    ]  # fmt: skip
    seen = Observation(TraceMap("robot", "", {}), values=sorted(values, key=lambda one: one.time))
    compared = tuple(
        Comparison(name, RELEASES, 0, 3 * MS if name == "control" else MS, BOUND, withheld)
        for name in PERIODS
    )
    ended = Ended(0, killed=False, real_time=True, warnings=())
    return RunOutcome("", None, None, seen, ended, (), compared, (), failures, (), None)


def test_a_response_above_its_bound_is_found_in_the_part_in_which_it_was_due() -> None:
    run = outcome(15)
    before, within = part_of("before", run, 0, 100 * MS), part_of("within", run, 100 * MS, 200 * MS)
    assert {name: len(taken) for name, taken in before.responses.items()} == {
        "trajectory": 20, "control": 10, "supervision": 5,
    }  # fmt: skip
    assert before.exceeded == []
    assert within.responses["control"] == [*[MS] * 5, 3 * MS, *[MS] * 4]
    assert within.exceeded == ["within: control took 3000000 ns, its bound is 2000000 ns"]
    explained = outcome(15, withheld=MS)
    assert part_of("within", explained, 100 * MS, 200 * MS).exceeded == []


@pytest.mark.parametrize(
    ("run", "begin", "end", "why"),
    [(outcome(1), -1, 5, "no part of a run"), (outcome(1), 5, 5, "no part of a run"),
     (outcome(1), 0, 900 * MS, "no part of a run"), (outcome(1, "lost"), 0, 5, "failed: lost")],
)  # fmt: skip
def test_a_part_that_a_run_does_not_have_is_refused(
    run: RunOutcome, begin: int, end: int, why: str
) -> None:
    with pytest.raises(NoPartError, match=why):
        part_of("part", run, begin, end)
