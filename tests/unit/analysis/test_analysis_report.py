# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What people read: findings, the terminal table, the HTML report."""

from __future__ import annotations

import io
import re
from dataclasses import replace
from html.parser import HTMLParser
from itertools import pairwise

import pytest
from rich.console import Console

from ravenchart.analysis.findings import advice
from ravenchart.analysis.findings.deadlines import findings
from ravenchart.analysis.present.report import (
    FrameRow,
    RunReport,
    StepRow,
    compare,
    executions,
    render_report,
)
from ravenchart.analysis.present.sentences import binding_lines
from ravenchart.analysis.present.table import LEGEND, show
from ravenchart.analysis.system.critical import schedule
from ravenchart.analysis.system.observed import Observation, read_map, read_trace
from ravenchart.analysis.system.timing import analyse
from ravenchart.analysis.units import duration, exact_time, microseconds
from ravenchart.gen.derive.ways import routed
from ravenchart.gen.diagnostics import render as render_diagnostic
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.system import Chain, System
from ravenchart.gen.pipeline import load
from ravenchart.paths import ROOT
from tests.support.certificates import random_system
from tests.support.plant_model import plant
from tests.support.pump import system_of
from tests.support.robot_files import trace_map
from tests.support.systems import bus, message, shared, stops_of, system, task


def late() -> System:
    tasks = [
        task("can_rx", 3, 700_000, 2_000_000, line=12),
        task("trajectory", 2, 1_000_000, 5_000_000, line=20),
        task("control", 1, 4_300_000, 10_000_000, 9_000_000, line=41),
        task("logger", 0, 9_000_000, 10_000_000, line=50),
    ]
    return system(tasks, [shared("goal", 2, 5_000, "trajectory", "control")])


def test_a_missed_deadline_reads_like_a_compilers_error() -> None:
    first, second = findings(analyse(late()))
    assert render_diagnostic(second, {}) == (
        "model.yaml:41:3: error: control misses its deadline: R = 9.8 ms > D = 9 ms [RV-0901]\n"
        "model.yaml:41:3: note: control itself runs for up to 4.3 ms\n"
        "model.yaml:12:3: note: can_rx, period 2 ms, preempts control: 5 x 700 us = 3.5 ms\n"
        "model.yaml:20:3: note: trajectory, period 5 ms, preempts control: 2 x 1 ms = 2 ms\n"
        "model.yaml:41:3: hint: lengthen its period, or move an activity to a processor with a "
        "longer period"
    )
    assert first.message == (
        "logger has no response-time bound: it and the tasks that preempt it need 188 % of the "
        "core, more than all of it"
    )


def test_the_blocker_is_named_with_its_object() -> None:
    tasks = [task("fast", 2, 900, 1000, 1000, line=3), task("slow", 1, 250, 10_000, line=5)]
    (only,) = findings(analyse(system(tasks, [shared("store", 2, 200, "fast", "slow")])))
    assert "slow may block fast for 0.2 us inside store" in [text for _, text in only.notes]


def test_an_overloaded_bus_is_a_finding() -> None:
    (full,) = findings(analyse(system([], (), [bus()], [message("a", period=200_000)])))
    assert (full.code, full.message) == ("RV-0903", "bus may be loaded to 135 %")
    assert full.notes[-1][1] == (
        "1 error that depends on this is left out: check again when this is corrected"
    )


def test_a_message_that_is_late_says_what_goes_before_it() -> None:
    messages = [message("a", 1, period=500_000), message("b", 2, length=0, period=10_000_000)]
    slow = replace(messages[1], deadline=Ns(300_000))
    (only,) = findings(analyse(system([], (), [bus()], [messages[0], slow])))
    assert only.message == "message b misses its deadline: R = 380 us > D = 300 us"
    assert "a goes before b: 1 x 270 us = 270 us" in [
        text.removeprefix("bus.") for _, text in only.notes
    ]


def chain(*path: str, reaction: int) -> System:
    wanted = Chain("flow", plant().origin, stops_of(*path), Ns(reaction), None)
    return routed(replace(plant(), chains=(wanted,)))


def test_chains_that_are_broken_or_late_are_findings() -> None:
    (gap,) = findings(analyse(chain("pump.drive", "raw_level", reaction=1)))
    assert gap.code == "RV-0904"
    assert gap.message == "the chain flow is broken: no values go from pump.drive to raw_level"
    (late,) = findings(analyse(chain("raw_level", "valve_position", reaction=1_000_000)))
    assert late.code == "RV-0905"
    assert re.fullmatch(r"the reaction of flow may take \d+(\.\d+)? ms; .* is 1 ms", late.message)
    assert findings(analyse(chain("raw_level", "valve_position", reaction=10**9))) == ()


def test_a_reception_that_loses_frames_is_a_finding() -> None:
    change = ("released_by: can_bus, period: 1 ms", "released_by: can_bus, period: 11 ms")
    (only,) = findings(analyse(system_of(change)))
    assert only.message == (
        "reception takes a frame every 11 ms, but its messages need 110 % of that rate: "
        "frames will be lost"
    )
    change = ("released_by: can_bus, period: 1 ms", "released_by: can_bus, period: 10 ms")
    analysis = analyse(system_of(change))
    assert not analysis.schedulable
    (only,) = findings(analysis)
    assert only.message.endswith("100 % of that rate: a frame may wait without bound")


def test_what_limits_a_system_is_said_in_a_sentence() -> None:
    tasks = [task("plan", 2, 620_000, 2_000_000), task("axis", 1, 510_000, 2_000_000, 1_000_000)]
    (line,) = binding_lines(analyse(system(tasks)))
    assert line == "axis misses by 130 us: 54.9 % of its response is plan"
    (line,) = binding_lines(analyse(system(tasks[:1])))
    assert line == (
        "plan is the tightest, with a slack of 1.38 ms: 100 % of its response is its own execution"
    )


def inverted() -> System:
    """`high` waits for 1.7 ms of `low`, so 0.3 ms are left for its 0.4; the other way both fit."""
    return system([task("high", 1, 400_000, 2_000_000), task("low", 2, 1_700_000, 10_000_000)])


def test_what_to_change_is_said_on_the_terminal_and_in_the_report() -> None:
    expected = (
        "To meet all deadlines, one of these is enough:",
        "priorities of cpu in this order: high, low",
        "WCET of low less by 5.9 %: 1.7 ms to 1.59 ms",
        "WCET of high less by 25 %: 400 us to 300 us",
        "A longer period (up to 10 times) of one alone is not enough: high, low.",
    )
    for text in (printed(inverted()), Page(render_report(analyse(inverted()))).text):
        places = [text.index(line) for line in expected]
        assert places == sorted(places)


def test_where_nothing_suffices_alone_it_is_told_what_helps_most() -> None:
    """0.9 + 0.8 + 0.5: without the first 1.3 is left, 1 / 1.3 = 0.769; without the last 1.7."""
    tasks = [task(n, p, c, 1_000_000) for n, p, c in
             (("a", 3, 900_000), ("b", 2, 800_000), ("c", 1, 500_000))]  # fmt: skip
    lines = advice.lines(advice.of_model(analyse(system(tasks))))
    assert lines[:4] == (
        "No change of one WCET, period or order alone would meet all deadlines.",
        "  without a, all else must still shrink by 23.2 %",
        "  without b, all else must still shrink by 28.7 %",
        "  without c, all else must still shrink by 41.2 %",
    )
    assert "Shortening one of these alone is not enough: a, b, c." in lines


def test_a_tight_system_is_told_what_gives_it_room_and_one_with_room_nothing() -> None:
    tasks = [task("a", 2, 500, 1_000), task("b", 1, 450, 1_000)]
    text = printed(system(tasks))
    assert "To let all execution times grow by 20 %, one of these is enough:" in text
    assert "WCET of a less by 23.4 %" in text  # 1.2 (383 + 450) <= 1000
    assert "Possible changes" in render_report(analyse(system(tasks)))
    for some in ([tasks[0]], []):
        assert advice.of_model(analyse(system(some))) is None


@pytest.mark.parametrize("one", [random_system(seed) for seed in range(20)])
def test_a_critical_instant_takes_exactly_the_window(one: System) -> None:
    for response in analyse(one).responses:
        slices = schedule(response)
        if response.bound is not None and slices:
            assert slices[-1].end == sum(s.end - s.start for s in slices) == response.window
            assert slices[-1].name == response.task.name
            assert all(a.end == b.start for a, b in pairwise(slices))


def test_a_schedulable_system_has_no_findings() -> None:
    assert findings(analyse(plant())) == ()


def printed(one: System, *, terminal: bool = False) -> str:
    out = io.StringIO()
    console = Console(file=out, width=80, highlight=False, force_terminal=terminal)
    show(analyse(one), console)
    return out.getvalue()


def test_the_table_says_the_verdict_first_and_marks_failures_in_words() -> None:
    lines = printed(late()).splitlines()
    assert lines[0].startswith("Sample: 2 of 4 deadlines may be missed: logger and 1 more; ")
    assert "".join(lines[:2]).endswith("overloaded: cpu (188 %)")
    assert "cpu is overloaded: what runs on it needs 188 % of its time" in lines
    body = lines[lines.index("") + 2 : lines.index(LEGEND.format("ms").splitlines()[0])]
    assert [line.split()[0] for line in body] == ["logger", "control", "can_rx", "trajectory"]
    assert [line.split()[-1] for line in body] == ["NONE", "MISS", "ok", "ok"]


@pytest.mark.parametrize("one", [late(), plant()])
def test_the_table_fits_80_columns_and_has_no_colour_outside_a_terminal(one: System) -> None:
    text = printed(one)
    assert max(map(len, text.splitlines())) <= 80
    assert "\x1b" not in text
    assert "\x1b" in printed(one, terminal=True)


def test_long_names_are_folded_and_not_cut() -> None:
    one = system([task("robot_bus.driver_rx." + "x" * 60, 1, 1_000, 1_000_000_000)])
    assert printed(one).replace("\n", "").count("x") >= 60


class Page(HTMLParser):
    """Collects tags and text, and complains of tags that do not pair up."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in ("meta", "br"):
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data


def test_the_report_is_one_well_formed_file_without_outside_references() -> None:
    text = render_report(analyse(plant()))
    page = Page(text)
    assert page.open == []
    assert not [tag for tag, _ in page.tags if tag in ("link", "img", "iframe")]
    assert not re.findall(r'(?:src|href)="(?!#)|url\((?!#)', text)
    for phrase in (
        "every deadline is met",
        "Lehoczky",
        "Reference Manual, D.3",
        "sensor.filtered",
        "raw_level",
        "55 + 10 s bits",
        "5" * 64,
    ):
        assert phrase in page.text


def test_the_bars_parts_add_up_to_the_response() -> None:
    text = render_report(analyse(plant()))
    bars = re.findall(r'aria-label="response against deadline">(.*?)<span class="deadline"', text)
    widths = [sum(map(float, re.findall(r"width:([\d.]+)%", bar))) for bar in bars]
    found = analyse(plant())
    names = [name for name in found.worst_first() if name in found.tasks]
    names += [sent.frame.name for sent in found.frames(plant().buses[0])]
    shares = [100 * (found.found.from_event(n) or 0) / found.found.deadline(n) for n in names]
    assert widths == pytest.approx(shares, abs=0.01)


def test_names_are_escaped() -> None:
    one = system([task("<b>&amp;", 1, 1_000, 2_000)])
    assert "&lt;b&gt;&amp;amp;" in render_report(analyse(one))


def test_the_same_analysis_gives_the_same_bytes() -> None:
    assert render_report(analyse(late())) == render_report(analyse(late()))


def observation() -> Observation:
    lines = ["T 5 STATE 10 0", "T 900 STATE 10 1", "P 1 100 0 300000", "L trace 0", "END"]
    return read_trace(lines, read_map(trace_map(["x"])))


def run_report(*, comparable: bool = True) -> RunReport:
    return RunReport(
        title="A short run",
        passed=True,
        verdict="every step passed",
        notes=("a <note>",),
        steps=(StepRow("wait 1 s", "done", True, 0.0), StepRow("pull x", "broken", False, 1.0)),
        frames=(FrameRow("robot_status", "from controller", 12),),
        comparable=comparable,
        observation=observation(),
        pictures=(("A picture", "<svg></svg>"),),
    )


@pytest.mark.slow
def test_a_run_adds_its_steps_states_frames_and_observations() -> None:
    page = Page(render_report(analyse(plant()), run_report()))
    for phrase in (
        "Run: PASS",
        "A short run",
        "a <note>",
        "Idle, Seeking",
        "robot_status",
        "A picture",
        "FAILED",
        "Observed beside bound",
    ):
        assert phrase in page.text
    assert "Not comparable" not in page.text
    assert "Not comparable" in render_report(analyse(plant()), run_report(comparable=False))


def test_observed_times_stand_beside_the_bound_of_the_same_task() -> None:
    (row,) = compare(analyse(plant()), observation())
    assert (row.task, row.observed, row.exceeded) == ("control", 300_000, False)
    assert row.bound == analyse(plant()).response("control").bound


@pytest.mark.parametrize(
    ("late", "stolen", "withheld"),
    [
        (35_000, 0, 35_000),
        (35_000, 20_000_000, 35_000),
        (35_001, 0, 1_035_001),
        (35_001, 20_000_000, 20_000_000),
    ],
)
def test_stalls_that_a_probe_saw_may_be_longer_than_it_was_late(
    late: int, stolen: int, withheld: int
) -> None:
    found = load(ROOT / "examples" / "cartesian_robot" / "model.yaml").system
    assert found is not None
    analysis = analyse(found)
    assert analysis.response("controller.probe").bound == 35_000
    seen = replace(observation(), host_latency=Ns(late), stolen=Ns(stolen))
    assert {row.withheld for row in compare(analysis, seen)} == {withheld}


def test_executions_stand_beside_the_wcets_of_the_model() -> None:
    seen = observation()
    times = {"sensor.filter": 900_000, "pump.drive": 1_000_001, "elsewhere.x": 1}
    seen.executions.update({row: Ns(time) for row, time in times.items()})
    rows = executions(analyse(plant()), seen)
    assert [(r.row, r.wcet, r.exceeded) for r in rows] == [
        ("pump.drive", 1_000_000, True),
        ("sensor.filter", 1_000_000, False),
    ]


def test_times_read_as_people_write_them() -> None:
    assert [duration(n) for n in (0, 5, 1_500, 250_000, 10_000_000, 2 * 10**9)] == [
        "0 us",
        "5 ns",
        "1500 ns",
        "250 us",
        "10 ms",
        "2 s",
    ]
    assert [microseconds(n) for n in (0, 1, 1_000, 12_345, -2_500)] == [
        "0",
        "0.1",
        "1",
        "12.4",
        "-2.5",
    ]


@pytest.mark.parametrize(
    ("ns", "expected"),
    [
        (0, "0 us"), (50, "0.05 us"), (999_900, "999.9 us"), (1_000_000, "1 ms"),
        (14_560_000, "14.56 ms"), (5_000_001, "5.000001 ms"), (-130_000, "-130 us"),
        (2_000_000_000, "2000 ms"),
    ],
)  # fmt: skip
def test_an_exact_time_is_in_ms_from_1_ms_on(ns: int, expected: str) -> None:
    assert exact_time(ns) == expected
