# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The responses of activities from a trace: exact ones, upper estimates, and none after losses."""

from __future__ import annotations

from dataclasses import replace

import pytest

from ravenchart.analysis.present.report import RunReport, render_report
from ravenchart.analysis.system.observed import Observation, merged, read_map, read_trace
from ravenchart.analysis.system.row_responses import (
    BINS,
    RowHistogram,
    RowSample,
    executions_of,
    row_histograms,
    rows_executed,
    samples,
)
from ravenchart.analysis.system.timing import analyse
from ravenchart.gen.derive.completion import programs
from ravenchart.gen.emit.tables.trace_map import trace_json
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.system import Processor
from tests.support.responses import MS, desk, desk_map, lines, random_run, work
from tests.support.two_nodes import system_of

RUN = (
    "B 0.1 own.Control", "B 1.0 own.toil", "B 2.0 own.rest",  # done at 2.5
    "B 10.2 own.Control", "B 11.1 own.toil",  # done at 12.0
    "P 15 work 2 2.0",
)  # fmt: skip
"""Release 0 with all activities, and release 1 without `rest`."""


def of(*told: str) -> Observation:
    return read_trace(lines(*told), desk_map())


def found(processor: Processor, seen: Observation) -> list[tuple[str, float, bool]]:
    """The samples: activity, response in ms, whether it is exact."""
    return [(one.row, one.response / MS, one.exact) for one in samples(processor, seen)]


def exact(seen: Observation) -> list[tuple[str, float]]:
    return [(row, response) for row, response, is_exact in found(work(), seen) if is_exact]


def at_most(seen: Observation) -> list[tuple[str, float]]:
    return [(row, response) for row, response, is_exact in found(work(), seen) if not is_exact]


def test_the_last_activity_is_exact_and_the_others_end_before_the_next_one() -> None:
    assert found(work(), of(*RUN)) == [
        ("own.toil", 2.0, True),  # of release 1
        ("own.Control", 1.0, False),
        ("own.toil", 2.0, False),
        ("own.Control", 1.1, False),
    ]
    numbers = {
        one.name: (sum(one.exact), sum(one.at_most), one.executions, one.longest,
                   one.longest_at_most)
        for one in row_histograms(desk(), of(*RUN))
    }  # fmt: skip
    assert numbers == {
        "own.Control": (0, 2, 2, None, 1_100_000),
        "own.toil": (1, 1, 2, 2_000_000, 2_000_000),
        "own.rest": (0, 0, 1, None, None),
    }


def test_responses_count_from_the_offset_of_the_processor() -> None:
    late = replace(work(), offset=Ns(50_000))
    assert ("own.Control", 0.95, False) in found(late, of(*RUN))


def test_a_release_that_begins_after_the_next_one_is_due_keeps_its_number() -> None:
    seen = of(
        "B 11.0 own.Control", "B 12.0 own.toil", "B 13.0 own.rest",  # release 0, done at 14
        "B 14.1 own.Control", "B 15.0 own.toil",  # release 1, done at 15.5
        "P 16 work 2 5.5",
    )  # fmt: skip
    assert at_most(seen) == [("own.Control", 12.0), ("own.toil", 13.0), ("own.Control", 5.0)]
    assert exact(seen) == [("own.toil", 5.5)]


AFTER = (
    "B 20.1 own.Control", "B 21.0 own.toil", "B 22.5 own.rest",
    "P 25 work 3 4.0",
    "B 30.1 own.Control", "B 31.0 own.toil",
    "P 35 work 4 1.5",
)  # fmt: skip


@pytest.mark.parametrize("gone", [0, 1, 2, 3, 4])
def test_between_two_reports_with_a_lost_record_nothing_is_estimated(gone: int) -> None:
    whole = of(*RUN, *AFTER)
    later = [("own.Control", 1.0), ("own.toil", 2.5), ("own.Control", 1.0)]
    first = [("own.Control", 1.0), ("own.toil", 2.0), ("own.Control", 1.1)]
    assert at_most(whole) == [*first, *later]
    lost = of(*RUN[:gone], *RUN[gone + 1 :], *AFTER)
    assert at_most(lost) == later
    assert exact(lost) == exact(whole)


def test_a_later_report_does_not_help_what_was_lost_after_the_one_before() -> None:
    assert at_most(of(*RUN, AFTER[0], *AFTER[2:])) == [
        ("own.Control", 1.0), ("own.toil", 2.0), ("own.Control", 1.1), ("own.Control", 1.0),
    ]  # fmt: skip


def test_a_whole_cycle_that_was_lost_is_noticed() -> None:
    assert at_most(of(*RUN[5:], *AFTER)) == [
        ("own.Control", 1.0), ("own.toil", 2.5), ("own.Control", 1.0),
    ]  # fmt: skip


def test_records_after_the_last_report_are_not_sampled() -> None:
    more = of(*RUN, "B 20.1 own.Control", "B 21.0 own.toil")
    assert found(work(), more) == found(work(), of(*RUN))


def test_an_activity_with_a_phase_is_in_other_releases() -> None:
    slots = [replace(one, phase=1) if one.element == "own.rest" else one for one in work().slots]
    shifted = replace(work(), slots=tuple(slots))
    assert [rows_executed(shifted, n) for n in range(2)] == [
        ("own.Control", "own.toil"),
        ("own.Control", "own.toil", "own.rest"),
    ]
    assert [executions_of(shifted, slots[2], n) for n in range(6)] == [0, 0, 1, 1, 2, 2]
    assert [executions_of(work(), work().slots[2], n) for n in range(6)] == [0, 1, 1, 2, 2, 3]
    seen = of(
        "B 0.1 own.Control", "B 1.0 own.toil",
        "B 10.2 own.Control", "B 11.1 own.toil", "B 12.0 own.rest",
        "P 15 work 2 2.5",
    )  # fmt: skip
    assert found(shifted, seen) == [
        ("own.rest", 2.5, True),
        ("own.Control", 1.0, False),
        ("own.Control", 1.1, False),
        ("own.toil", 2.0, False),
    ]
    assert at_most(seen) == []  # the order is that of no two releases of the other table


def test_a_trace_of_an_older_program_has_no_responses() -> None:
    text = [line.rpartition(" ")[0] if line[0] == "P" else line for line in lines(*RUN)]
    assert found(work(), read_trace(text, desk_map())) == []


def test_of_a_processor_that_a_bus_releases_only_last_responses_are_known() -> None:
    system = system_of()
    panel = next(part for part in programs(system) if part.nodes[0].name == "panel")
    names = read_map(trace_json(panel))
    told = (
        "P 10 reception_panel 0 0",
        "B 12.0 link.receive_panel", "P 20 reception_panel 1 0.2",
        "P 30 reception_panel 1 0.2",
        "B 32.0 link.receive_panel", "B 33.0 link.receive_panel", "P 40 reception_panel 3 0.3",
    )  # fmt: skip
    seen = read_trace(lines(*told, names=names), names)
    (reception,) = (one for one in system.processors if one.name == "reception_panel")
    assert found(reception, seen) == [
        ("link.receive_panel", 0.2, True),
        ("link.receive_panel", 0.3, True),
    ]
    rows = {one.name: one for one in row_histograms(analyse(system), seen)}
    assert rows["link.receive_panel"].executions == 3


def test_each_release_of_a_sporadic_processor_is_as_the_first_one() -> None:
    sporadic = replace(work(), released_by="link")
    assert rows_executed(sporadic, 1) == ("own.Control", "own.toil", "own.rest")
    assert executions_of(sporadic, sporadic.slots[2], 5) == 5
    assert found(sporadic, of(*RUN)) == [("own.rest", 2.0, True)]


def test_the_releases_of_each_node_count_from_its_own_start() -> None:
    """Both nodes note their first release; the drive starts 7 ms later."""
    system = system_of()
    parts = {}
    for part in programs(system):
        names, node = read_map(trace_json(part)), part.nodes[0].name
        processor = next(
            one for one in system.processors if one.node == node and one.released_by is None
        )
        begins = [f"B {0.1 * k:.1f} {row}" for k, row in enumerate(rows_executed(processor, 0), 1)]
        start = 5000 + (7 if node == "drive" else 0)
        report = f"P 9 {processor.name} 1 {0.9 if node == 'drive' else 0.8}"
        text = [f"E {start * MS}", *lines(*begins, report, names=names), "END"]
        parts[node] = read_trace(text, names)
    rows = {one.name: one for one in row_histograms(analyse(system), merged(parts))}
    assert rows["servo.tell"].longest == 900_000
    assert rows["supervisor.plan"].longest == 800_000
    assert rows["link.watch_drive"].longest_at_most == 200_000
    assert rows["servo.control"].longest_at_most == 500_000
    assert [one.processor for one in rows.values()].count("control") == 5


# --- Bins -----------------------------------------------------------------------------------


def sample(response: int, *, is_exact: bool = True) -> RowSample:
    return RowSample("own.toil", Ns(response), is_exact, Ns(0))


def test_the_bins_reach_to_r_or_to_r_times_a_power_of_two() -> None:
    one = RowHistogram("own.toil", "work", 50, 200, 10)
    for response in (0, 1, 10, 11, 200):
        one.add(sample(response))
    one.add(sample(95, is_exact=False))
    assert one.width == 10
    assert one.exact == [3, 1, *[0] * (BINS - 3), 1]
    assert one.at_most == [*[0] * 9, 1, *[0] * (BINS - 10)]
    one.add(sample(801, is_exact=False))  # 80.1 widths: three doublings
    assert one.width == 80
    assert one.exact == [4, 0, 1, *[0] * (BINS - 3)]
    assert one.at_most == [0, 1, *[0] * 8, 1, *[0] * (BINS - 11)]
    assert (one.longest, one.longest_at_most) == (200, 801)


@pytest.mark.parametrize("losses", [0, 1, 30])
@pytest.mark.parametrize("seed", range(20))
def test_no_response_of_a_random_run_is_wrong(seed: int, losses: int) -> None:
    """Each sample is one of its activity, no estimate is of another release; bins have all."""
    told, true = random_run(seed, losses)
    seen = read_trace(told, desk_map())
    all_samples = list(samples(work(), seen))
    counted = [one for one in true if one.release < seen.processors["work"].releases]
    responses = {(one.row, one.response) for one in counted if one.ends_by is None}
    estimates = sorted((one.row, one.ends_by) for one in counted if one.ends_by is not None)
    estimated = sorted((one.row, one.response) for one in all_samples if not one.exact)
    assert {(one.row, one.response) for one in all_samples if one.exact} <= responses
    assert estimated == estimates if not losses else set(estimated) <= set(estimates)
    assert estimated
    for row in row_histograms(desk(), seen):
        mine = [one for one in all_samples if one.row == row.name]
        assert sum(row.exact) + sum(row.at_most) == len(mine) <= row.executions
        assert row.width * BINS >= max((one.response for one in mine), default=0)


# --- The report ------------------------------------------------------------------------------


def test_the_report_of_a_run_has_a_histogram_of_each_activity() -> None:
    run = RunReport("A run", True, "all good", (), (), (), True, of(*RUN))
    text = render_report(desk(), run)
    assert "Responses of activities beside C and R" in text
    toil = next(one for one in row_histograms(desk(), of(*RUN)) if one.name == "own.toil")
    assert (toil.bound, toil.width) == (2_025_000, 101_250)
    said = "Responses of own.toil: 1 from 1923.8 to 2025 us, 1 at most 2025 us"
    assert f'aria-label="{said}"' in text
    assert "2 of 2</td>" in text
    assert "0 of 1</td>" in text
    assert 'aria-label="Responses of own.rest: none"' in text
