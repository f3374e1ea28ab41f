# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A recorded run shown again: at each instant what a monitor had shown, and a clock of its own."""

from __future__ import annotations

import random
import shutil
from dataclasses import asdict
from pathlib import Path
from typing import Any

import pytest

from ravenchart.analysis.system.observed import TraceError, read_map
from ravenchart.building import checking
from ravenchart.building.checking import Checked
from ravenchart.command_line import main
from ravenchart.gen.language.terms import Ns
from ravenchart.running.replaying import MOST_POINTS, ReplayedRun
from ravenchart.running.traces.files import read_traces
from tests.support import recorded
from tests.support.recordings import monitored, random_trace, report, write
from tests.support.snapshot_files import PUMP, number, trace_map

SECOND = 1_000_000_000


class HandClock:
    """A clock that the test moves; in s."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture(scope="module")
def checked() -> Checked:
    return checking.check(PUMP)


@pytest.fixture
def clock() -> HandClock:
    return HandClock()


def opened(checked: Checked, folder: Path, lines: list[str], clock: HandClock) -> ReplayedRun:
    """A replay of the pump's trace with these lines."""
    path = write(folder / "trace.txt", trace_map(), lines)
    return ReplayedRun(checked.analysis, read_traces(checked, [path]), clock)


def plain(node: Any, *others: str) -> dict[str, Any]:
    """A node as the page gets it, without what differs by intent."""
    left = ("process", "real_time", "ended", "not_seen", *others)
    return {name: value for name, value in asdict(node).items() if name not in left}


RUN = [
    f"T 1000 State {number('bed.Infusion', 'region')} 0",
    f"T {SECOND} Transition {number('bed.Infusion', 'region')} 0",
    f"T {SECOND} State {number('bed.Infusion', 'region')} 1",
    *report(trace_map(), 2 * SECOND, 40, 0),
    f"T {3 * SECOND} Transition {number('bed.Infusion', 'region')} 1",
    *report(trace_map(), 4 * SECOND, 80, 5),
    "END",
]


@pytest.mark.parametrize("seed", range(4))
def test_what_is_shown_at_an_instant_is_what_a_monitor_had_shown(
    seed: int, checked: Checked, tmp_path: Path, clock: HandClock
) -> None:
    lines = random_trace(trace_map(), seed)
    replay = opened(checked, tmp_path, lines, clock)
    (controller,) = replay.controllers
    times = [int(line.split()[1]) for line in lines if line[0] in "TVN"]
    for at in random.Random(seed).sample([*times, *(time + 1 for time in times)], 60):
        if at < replay.end:
            expected = monitored(checked.analysis, trace_map(), lines, at)
            assert plain(controller.node(at)) == plain(expected)


def test_the_way_to_an_instant_makes_no_difference(
    checked: Checked, tmp_path: Path, clock: HandClock
) -> None:
    replay = opened(checked, tmp_path, random_trace(trace_map(), 11), clock)
    (controller,) = replay.controllers
    chance = random.Random(1)
    instants = [chance.randrange(replay.end + 1) for _ in range(40)]
    first = {at: asdict(controller.node(at)) for at in sorted(instants)}
    for at in (*reversed(sorted(instants)), *instants):
        replay.seek(at)
        assert replay.at == at
        assert asdict(controller.node(replay.at)) == first[at]


def test_time_goes_on_at_a_speed_rests_and_ends(
    checked: Checked, tmp_path: Path, clock: HandClock
) -> None:
    replay = opened(checked, tmp_path, RUN, clock)
    assert (replay.at, replay.end, replay.playing) == (0, 4 * SECOND, False)
    clock.now += 1
    assert replay.at == 0
    replay.play()
    clock.now += 1.5
    assert (replay.at, replay.playing) == (1.5 * SECOND, True)
    replay.set_speed(0.5)
    clock.now += 1
    assert replay.at == 2 * SECOND
    replay.pause()
    clock.now += 9
    assert replay.at == 2 * SECOND
    replay.set_speed(4)
    assert not replay.playing
    replay.play()
    clock.now += 0.25
    assert replay.at == 3 * SECOND
    replay.seek(SECOND)
    clock.now += 0.5
    assert replay.at == 3 * SECOND and replay.playing
    clock.now += 5
    assert (replay.at, replay.playing) == (4 * SECOND, False)
    replay.play()  # once more from the beginning
    assert replay.at == 0 and replay.playing


def test_an_instant_outside_the_trace_is_its_first_or_last(
    checked: Checked, tmp_path: Path, clock: HandClock
) -> None:
    replay = opened(checked, tmp_path, RUN, clock)
    replay.seek(99 * SECOND)
    assert replay.at == replay.end
    replay.seek(-1)
    assert replay.at == 0


def test_a_step_leads_to_the_next_record_of_its_kind_and_back(
    checked: Checked, tmp_path: Path, clock: HandClock
) -> None:
    replay = opened(checked, tmp_path, RUN, clock)
    replay.play()
    instants = []
    while replay.step("event", back=False):
        instants.append(replay.at)
    assert instants == [SECOND, 3 * SECOND] and not replay.playing
    assert replay.at == 3 * SECOND, "without a further record it stays"
    assert replay.step("event", back=True) and replay.at == SECOND
    assert replay.step("record", back=True) and replay.at == 1000
    assert not replay.step("record", back=True)
    assert not replay.step("value", back=False)
    assert [replay.controllers[0].count(what) for what in ("event", "value", "record")] == [2, 0, 4]


def test_all_records_of_an_instant_are_told(
    checked: Checked, tmp_path: Path, clock: HandClock
) -> None:
    (controller,) = opened(checked, tmp_path, RUN, clock).controllers
    region = trace_map().named("bed.Infusion", "region")
    assert list(controller.records(SECOND)) == [
        ("transition", "bed.Infusion", region.transitions[0]),
        ("state", "bed.Infusion", region.leaves[1]),
    ]
    assert list(controller.records(SECOND + 1)) == []


def test_counts_are_those_of_the_last_report_and_what_has_none_is_said(
    checked: Checked, tmp_path: Path, clock: HandClock
) -> None:
    (controller,) = opened(checked, tmp_path, RUN, clock).controllers
    before, during, end = (controller.node(at) for at in
                           (SECOND, 3 * SECOND, 4 * SECOND))  # fmt: skip
    assert before.processors == []
    assert any("the trace has none before 2.000 s" in text for text in before.not_seen)
    assert any(one.waiting is not None for one in before.queues)
    assert {one.completed for one in during.processors} == {40}
    assert controller.counted(3 * SECOND) == 2 * SECOND
    assert {one.completed for one in end.processors} == {80}
    assert (during.process, during.ended, end.process, end.ended) == (0, False, None, True)
    assert (during.lost, end.lost) == ({}, {"trace": 5})


def test_lost_records_are_said_with_the_times_between_which_they_were_lost(
    checked: Checked, tmp_path: Path, clock: HandClock
) -> None:
    (controller,) = opened(checked, tmp_path, RUN, clock).controllers
    (gap,) = controller.gaps
    assert (gap.after, gap.until, gap.what, gap.count) == (2 * SECOND, 4 * SECOND, "trace", 5)


def test_a_trace_that_was_cut_off_ends_where_it_was(
    checked: Checked, tmp_path: Path, clock: HandClock
) -> None:
    cut = RUN[: RUN.index(f"N {4 * SECOND}")]
    replay = opened(checked, tmp_path, cut, clock)
    (controller,) = replay.controllers
    assert replay.end == 3 * SECOND and not controller.is_whole
    node = controller.node(replay.end)
    assert (node.process, node.ended) == (None, False)


def test_a_trace_of_another_model_or_a_broken_one_is_refused_with_its_place(
    checked: Checked, tmp_path: Path
) -> None:
    other = write(tmp_path / "other.txt", trace_map(), RUN, digest="0" * 64)
    with pytest.raises(TraceError, match=r"other\.txt: error: .* generated from another model"):
        read_traces(checked, [other])
    broken = write(tmp_path / "broken.txt", trace_map(), [*RUN[:2], "T 5 State 9999 0"])
    with pytest.raises(TraceError, match=r"broken\.txt:5: error: the map has no element 9999"):
        read_traces(checked, [broken])


def test_of_very_many_values_the_extremes_are_left_at_every_instant(tmp_path: Path) -> None:
    model = Path(shutil.copytree(recorded.FOLDER, tmp_path / "recorded")) / "model.yaml"
    assert main(["generate", str(model)]) == 0
    names = read_map((model.parent / "generated" / "trace.json").read_text(encoding="utf-8"))
    heat = names.named("taker.heat", "value").number
    chance = random.Random(5)
    values = [(n * 1_000_000, chance.randrange(100)) for n in range(20_000)]
    values[7_123], values[9_999] = (values[7_123][0], 900), (values[9_999][0], -300)
    lines = [f"V {at} {heat} {value}" for at, value in values]
    trace = write(tmp_path / "trace.txt", names, [*lines, "END"])
    checked = checking.check(model)
    (controller,) = ReplayedRun(checked.analysis, read_traces(checked, [trace])).controllers
    for last in (*range(10_000_500_000, 12_000_000_000, 77_000_000), 10_000_500_000):
        first = last - 8_000_000_000
        _, points, number = controller.points("taker.heat", Ns(first), Ns(last))
        inside = [one for one in values if first - 1_000_000 <= one[0] <= last]
        assert number in (len(inside), len(inside) - 1)  # one before the time holds on into it
        assert points == sorted(set(points)) and set(points) <= set(inside)
        assert len(points) <= MOST_POINTS + 8, "a part of an interval at either end"
        assert {values[7_123], values[9_999], inside[-1]} <= set(points)
        assert points[0][0] <= first < points[1][0]


def test_queues_are_not_known_where_records_were_lost_before_the_first_report(
    checked: Checked, tmp_path: Path, clock: HandClock
) -> None:
    lossy = [*RUN[:3], *report(trace_map(), 4 * SECOND, 80, 5), "END"]
    (controller,) = opened(checked, tmp_path, lossy, clock).controllers
    assert {one.waiting for one in controller.node(SECOND).queues} == {None}
