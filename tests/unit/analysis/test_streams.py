# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The stream of a node: its response, what it changes, the depth of the trace, and how it shows."""

from __future__ import annotations

import random
from dataclasses import replace
from io import StringIO
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree as Xml

import pytest
from rich.console import Console

from ravenchart.analysis.core import holistic
from ravenchart.analysis.exchange import FORMATS
from ravenchart.analysis.exchange.mast_text import Attributes, parse
from ravenchart.analysis.findings.claims import claims_of
from ravenchart.analysis.findings.deadlines import findings
from ravenchart.analysis.present.figures import figures
from ravenchart.analysis.present.report import render_report
from ravenchart.analysis.present.table import show
from ravenchart.analysis.system.stream import StreamResponse, network_with_streams
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.command_line import main
from ravenchart.gen.emit.program import generate
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.nodes import DRAIN_PERIOD, SNAPSHOT_PERIOD, MonitorStream
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import load
from ravenchart.paths import ROOT
from tests.support.listings import one_of
from tests.support.mast_models import by_kind, number, words
from tests.support.pump import loaded
from tests.support.timing_models import SWITCHES, worker

MS = 1_000_000

MODEL = (
    f"system: Desk\n{worker('1 ms', '5 ms')}"
    + """\
nodes:
  board: {context_switch: 10 us, critical_section: 5 us, trace: 64, stream: {wcet: 10 ms}}
instances:
  own: {component: Worker, node: board}
processors:
  work: {stack: 16 KiB, on_deadline_miss: [own.Late], activities: [own.Control, own.toil]}
shutdown: {raises: [own.Late], grace: 10 ms}
"""
)


def of_text(text: str) -> Analysis:
    found = loaded(text)
    assert found.system is not None, found.diagnostics
    return analyse(found.system)


def changed(old: str, new: str) -> Analysis:
    assert MODEL.count(old) == 1
    return of_text(MODEL.replace(old, new))


def only(analysis: Analysis) -> StreamResponse:
    (one,) = analysis.streams
    return one


def example(name: str) -> System:
    system = load(ROOT / "examples" / name / "model.yaml").system
    assert system is not None
    return system


def with_streams(system: System, wcet: int = 2 * MS) -> System:
    nodes = (replace(n, stream=MonitorStream(n.origin, Ns(wcet))) for n in system.nodes)
    return replace(system, nodes=tuple(nodes))


# --- The response ----------------------------------------------------------------------


def test_the_response_is_that_of_the_main_program_below_all_tasks() -> None:
    """By hand: w = 10 + 20 * 2 * 0.01 + ceil(w / 10) * (6 + 2 * 0.01) ms has w = 28.46 ms."""
    one = only(of_text(MODEL))
    assert one.bound == 28_460_000
    assert one.holds
    assert one.unread == 33_460_000
    assert one.apart == 133_460_000
    assert one.load == pytest.approx(0.602 + 0.104)


def test_a_tick_makes_the_main_program_late_and_each_release_takes_time() -> None:
    """By hand: w = 10.4 + 20 * 0.1 + ceil((w + 1) / 10) * (6.02 + 0.1) ms has w = 36.88 ms."""
    ticking = "trace: 64, tick: {period: 1 ms, wcet: 0 us}, release: 100 us"
    assert only(changed("trace: 64", ticking)).bound == 36_880_000 + 1_000_000


def test_no_other_bound_changes() -> None:
    for name in ("pump", "surgical_robot", "two_nodes"):
        system = example(name)
        before, now = analyse(system), analyse(with_streams(system, 50 * MS))
        assert now.streams
        assert now.found.responses == before.found.responses
        assert (now.loads, now.schedulable) == (before.loads, before.schedulable)
        assert [found for _, found in now.limited] == [found for _, found in before.limited]


def test_each_node_has_its_own() -> None:
    found = analyse(with_streams(example("two_nodes"), 6 * MS)).streams
    assert [one.name for one in found] == ["panel.stream", "drive.stream"]
    assert [one.bound for one in found] == [8_000_000, 8_220_000]


def test_the_stream_of_a_node_with_cores_is_on_the_first() -> None:
    cores = "trace: 64, cores: 2, "
    assert only(changed("trace: 64, ", cores)).response.task.core == "board.1"
    second = MODEL.replace("trace: 64, ", cores).replace("work: {", "work: {core: 2, ")
    assert only(of_text(second.replace("[own.Late], grace", "[], grace"))).bound == 10_400_000


TICK = 100_000
"""The step of the simulation, in ns."""


@pytest.mark.parametrize("seed", range(40))
def test_a_simulated_main_program_is_within_the_bounds(seed: int) -> None:
    """The loop of the program, below one task of a random phase."""
    dice = random.Random(seed)
    snapshot, drain = dice.randint(10, 150), dice.randint(1, 15)
    period, phase = dice.choice((20, 50, 100, 250)), dice.randint(0, 250)
    work = max(1, period * dice.randint(10, 60) // 100)
    text = MODEL.replace("context_switch: 10 us", "context_switch: 0 us")
    text = text.replace("wcet: 1 ms", "wcet: 5 us")
    text = text.replace("wcet: 5 ms", f"wcet: {work * 100 - 5} us")
    text = text.replace("period: 10 ms", f"period: {period * 100} us")
    one = only(of_text(text.replace("wcet: 10 ms", f"wcet: {(snapshot + 20 * drain) * 100} us")))
    late, unread, apart = _simulated(snapshot, drain, work, period, phase)
    if one.bound is not None and one.unread is not None and one.apart is not None:
        assert late <= one.bound
        assert unread <= one.unread
        assert apart <= one.apart


def _simulated(
    snapshot: int, drain: int, work: int, period: int, phase: int
) -> tuple[int, int, int]:
    """The longest response, time between two ends of drains, and between two of snapshots.

    All given times are in ticks, the results in ns.
    """
    free, waiting = [], 0
    for tick in range(20_000):
        waiting += work if (tick - phase) % period == 0 else 0
        free.append(waiting == 0)
        waiting = max(0, waiting - 1)

    def spent(now: int, ticks: int) -> int:
        while ticks and now < len(free):
            ticks -= free[now]
            now += 1
        return now

    now = due = next_snapshot = emptied = late = unread = 0
    written = [0]
    while now < len(free):
        now = spent(max(now, due), drain)
        unread, emptied = max(unread, now - emptied), now
        if now >= next_snapshot:
            next_snapshot = now + SNAPSHOT_PERIOD // TICK
            now = spent(now, snapshot)
            written.append(now)
        late = max(late, now - due)
        due += DRAIN_PERIOD // TICK
    apart = max(later - earlier for earlier, later in pairwise(written[1:]))
    return late * TICK, unread * TICK, apart * TICK


# --- Findings --------------------------------------------------------------------------


def said(analysis: Analysis) -> list[str]:
    return [f"{one.code} {one.message}" for one in findings(analysis)]


def test_a_core_without_time_for_the_stream_is_a_warning() -> None:
    full = changed("wcet: 10 ms", "wcet: 40 ms")
    assert said(full) == [
        "RV-0911 board.stream has no response-time bound: it and the tasks that preempt it need "
        "101 % of the core, more than all of it"
    ]
    (one,) = findings(full)
    assert not one.is_error
    assert full.schedulable
    (note,) = one.notes
    assert note[1] == "work, period 10 ms, preempts board.stream: 60 % of the core"
    assert "stream: {" in MODEL.splitlines()[one.origin.line - 1]
    assert said(changed("wcet: 10 ms", "wcet: 30 ms")) == []


def test_snapshots_that_are_late_are_a_warning() -> None:
    """By hand, with a tick: w = 39.4 + ceil((w + 1) / 10) * 6.02 ms has w = 105.62 ms."""
    ticking = "wcet: 39 ms}, tick: {period: 1 ms, wcet: 0 us}"
    late = changed("wcet: 10 ms}", ticking)
    assert said(late) == [
        "RV-0911 board.stream does not keep ten snapshots a second: R = 107 ms > T = 100 ms"
    ]
    assert only(late).load < 1
    assert "Its snapshots are at most 212 ms apart: not ten a second." in shown(late)
    assert said(changed("wcet: 10 ms}", ticking.replace("39", "35"))) == []


def test_a_stream_below_a_task_without_bound_is_not_blamed() -> None:
    assert [line[:7] for line in said(changed("wcet: 5 ms", "wcet: 9500 us"))] == ["RV-0902"]


def test_a_trace_that_is_too_short_is_a_warning_and_its_hint_is_enough() -> None:
    """By hand: 4 jobs in 33.46 ms note 3 records of the chart and 1 of toil, the shutdown 2."""
    short = changed("trace: 64", "trace: 8")
    needed = only(short).waiting
    assert needed == 18
    (one,) = findings(short)
    assert (one.code, one.is_error) == ("RV-0912", False)
    assert one.message == (
        "up to 18 records may wait in the trace of board within 33.5 ms, but `trace` is 8"
    )
    assert one.hint is not None and "give it `trace: 18`" in one.hint
    assert said(changed("trace: 64", "trace: 18")) == []
    assert said(changed("trace: 64", "trace: 17")) != []
    assert said(changed("trace: 64, ", "")) == []


def test_a_job_that_ends_within_the_time_counts_as_well() -> None:
    """By hand: 24.94 ms without a drain meet 3 arrivals, and a job that arrived 6.025 ms before."""
    one = only(changed("wcet: 10 ms", "wcet: 7500 us"))
    assert (one.unread, one.waiting) == (24_940_000, 4 * 4 + 2)


def test_a_trace_is_not_judged_where_the_stream_or_a_task_is_late() -> None:
    text = MODEL.replace("trace: 64", "trace: 2, tick: {period: 1 ms, wcet: 0 us}")
    assert [line[:7] for line in said(of_text(text))] == ["RV-0912"]
    late = text.replace("wcet: 10 ms", "wcet: 39 ms")
    assert [line[:7] for line in said(of_text(late))] == ["RV-0911"]
    missed = of_text(text.replace("work: {", "work: {deadline: 5 ms, "))
    assert [line[:7] for line in said(missed)] == ["RV-0901"]
    assert only(missed).records is None


def test_a_stream_below_tasks_whose_release_has_no_bound_has_none_either() -> None:
    """A bus that cannot carry its frame in time; the core is nearly idle."""
    text = SWITCHES.replace(
        "critical_section: 5 us", "critical_section: 5 us, stream: {wcet: 2 ms}"
    )
    text = text.replace("wcet: 14000 us", "wcet: 100 us")
    assert only(of_text(text)).holds
    lost = of_text(text.replace("500 kbit/s", "10 kbit/s"))
    assert only(lost).bound is None
    assert only(lost).load < 1
    assert "RV-0911" not in "".join(said(lost))


@pytest.mark.parametrize(
    ("given", "code", "words"),
    [
        ("{wcet: 0 ms}", "RV-0205", "`wcet` must be longer than 0"),
        ("{wcet: 101 ms}", "RV-0703", "the stream may take 101 ms, longer than its period, 100 ms"),
        ("{wcet: 2 ms, period: 1 s}", "RV-0201", "the key `period` is unknown here"),
        ("{}", "RV-0202", "`stream` needs the key `wcet`"),
        ("{wcet: 1 us}", "RV-0709", "the critical section of board may take 5 us"),
    ],
)
def test_a_bad_stream_is_an_error_in_its_line(given: str, code: str, words: str) -> None:
    text = MODEL.replace("{wcet: 10 ms}", given)
    (one,) = loaded(text).diagnostics
    assert (one.code, one.is_error) == (code, True)
    assert one.message.startswith(words)
    assert "board:" in text.splitlines()[one.origin.line - 1]


# --- What it leaves as it is -----------------------------------------------------------


def test_the_generated_program_is_the_same_with_a_stream() -> None:
    system = example("surgical_robot")
    streamed = with_streams(system)
    made = [generate(one, claims_of(analyse(one))) for one in (system, streamed)]
    assert made[0] == made[1]


def test_without_a_stream_nothing_shows_one() -> None:
    analysis = analyse(example("pump"))
    assert analysis.streams == ()
    assert "streams" not in figures(analysis)
    assert "lowest priority" not in render_report(analysis) + shown(analysis)


def test_the_periods_are_those_of_the_program() -> None:
    snapshots = (ROOT / "spark_runtime/native/ravenchart-hosts-snapshots.adb").read_text()
    assert f"Milliseconds ({SNAPSHOT_PERIOD // MS})" in snapshots
    (main,) = (ROOT / "examples/pump/generated").glob("*_main.adb")
    assert f"Milliseconds ({DRAIN_PERIOD // MS})" in main.read_text()
    assert SNAPSHOT_PERIOD % DRAIN_PERIOD == 0


# --- How it shows ----------------------------------------------------------------------


def shown(analysis: Analysis) -> str:
    out = StringIO()
    show(analysis, Console(file=out, width=80))
    return out.getvalue()


def test_the_stream_is_the_last_row_of_the_tasks() -> None:
    text = shown(of_text(MODEL))
    assert max(map(len, text.splitlines())) <= 80
    rows = text.splitlines()
    (row,) = [line.split() for line in rows if line.startswith("board.stream (lowest priority)")]
    assert row[3:] == ["100", "100", "10", "0", "0", "28.5", "71.5", "ok"]
    assert "board.stream is the main program, below all tasks: core load 70.6 % with it." in rows
    assert "Its snapshots are at most 134 ms apart." in rows
    assert "At most 18 records wait in its trace: 64 is enough." in rows


def test_the_page_has_the_lines_of_the_pump() -> None:
    said = {
        line.rstrip() for line in shown(analyse(with_streams(example("pump"), 6 * MS))).splitlines()
    }
    page = one_of("docs/monitor.md", "board.stream", "text").text
    assert [line for line in page.splitlines() if line not in said | {"..."}] == []


def test_the_report_has_the_row_its_parts_and_the_limits() -> None:
    page = render_report(of_text(MODEL))
    assert page.count("board.stream (lowest priority)") == 2
    assert "Its snapshots are at most 134 ms apart." in page


def test_the_figures_have_the_stream() -> None:
    assert figures(of_text(MODEL))["streams"] == [
        {
            "stream": "board.stream",
            "node": "board",
            "period": 100_000_000,
            "wcet": 10_000_000,
            "response": 28_460_000,
            "reason": None,
            "met": True,
            "load": "353/500",
            "unread": 33_460_000,
            "apart": 133_460_000,
            "trace": 64,
            "records": 18,
            "values": 0,
        }
    ]


# --- For other tools -------------------------------------------------------------------


@pytest.mark.parametrize("name", ["pump", "two_nodes", "cartesian_robot"])
def test_as_a_task_the_stream_has_its_bound_and_no_other_changes(name: str) -> None:
    analysis = analyse(with_streams(example(name), 6 * MS))
    found = holistic.analyse(network_with_streams(analysis.network, analysis.streams))
    assert analysis.streams
    assert {one.name: found.responses[one.name].bound for one in analysis.streams} == {
        one.name: one.bound for one in analysis.streams
    }
    for task, response in analysis.found.responses.items():
        assert found.responses[task].bound == response.bound, task


def test_without_a_stream_the_network_is_the_same() -> None:
    network = analyse(example("pump")).network
    assert network_with_streams(network, ()) == network


def test_exports_have_the_stream_at_the_lowest_priority(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = tmp_path / "model.yaml"
    model.write_text(MODEL)
    texts = {}
    for tool in FORMATS:
        assert main(["analyse", str(model), "--export", tool]) == 0
        texts[tool] = capsys.readouterr().out
    kinds = by_kind(parse(texts["mast"]))
    (server,) = [s for s in kinds["Scheduling_Server"] if s.word("Name") == "board_stream_server"]
    policy = server.get("Server_Sched_Parameters")
    assert isinstance(policy, Attributes)
    assert policy.word("The_Priority") == "1"
    (job,) = [one for one in kinds["Operation"] if one.word("Name") == "board_stream_job"]
    assert number(job, "Worst_Case_Execution_Time") == 10 * MS + 19 * 2 * 10_000
    assert len(words(job, "Composite_Operation_List")) == 3
    root = Xml.fromstring(texts["cheddar"])
    levels = {
        task.findtext("name"): int(task.findtext("priority") or 0)
        for task in root.iter("periodic_task")
    }
    assert levels["board_stream"] == min(levels.values()) < levels["work"]
    assert "board_stream.in_event_model = model.PJdEventModel(P=100000000, J=0)" in texts["pycpa"]
    plain = MODEL.replace(", stream: {wcet: 10 ms}", "")
    assert plain != MODEL
    model.write_text(plain)
    for tool in FORMATS:
        assert main(["analyse", str(model), "--export", tool]) == 0
        assert "stream" not in capsys.readouterr().out
