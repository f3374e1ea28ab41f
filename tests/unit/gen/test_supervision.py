# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Liveness supervision: its task and its objects, its certificate, and the verdict on releases."""

from __future__ import annotations

import signal
from dataclasses import replace

import pytest

from ravenchart.analysis.present.page import both
from ravenchart.analysis.present.report import Comparison, render_report
from ravenchart.analysis.system.observed import Observation, Releases, TraceMap, read_trace
from ravenchart.analysis.system.timing import analyse
from ravenchart.gen.emit.nodes.supervision import END_MARGIN
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.nodes import SUPERVISOR
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import load
from ravenchart.paths import ROOT
from ravenchart.running import judge
from ravenchart.running.process import Ended

MS = 1_000_000
STATIONS = ROOT / "examples" / "three_components"


def example(name: str) -> System:
    """The system of an example."""
    system = load(ROOT / "examples" / name / "model.yaml").system
    assert system is not None
    return system


def _without(system: System) -> System:
    """The same tasks, apart from the supervisor's."""
    tasks = tuple(t for t in system.tasks if not t.element.endswith(SUPERVISOR))
    return replace(system, tasks=tasks)


def test_the_supervisor_is_above_processors_and_drivers_and_below_the_probe() -> None:
    order = [t.element for t in sorted(example("cartesian_robot").tasks, key=lambda t: -t.priority)]
    assert order[:2] == ["controller.probe", "controller.supervisor"]


def test_its_demand_is_in_every_response_of_its_core() -> None:
    system = example("three_components")
    with_it = {r.task.name: r.bound for r in analyse(system).responses}
    without = {r.task.name: r.bound for r in analyse(_without(system)).responses}
    supervisor = next(t for t in system.tasks if t.element == "board.supervisor")
    node = system.nodes[0]
    demand = supervisor.wcet + 2 * node.context_switch
    assert with_it["board.supervisor"] == demand + node.critical_section
    for processor in system.processors:
        bound, before = with_it[processor.name], without[processor.name]
        assert bound is not None and before is not None
        assert bound == before + demand


def test_ceilings_reach_the_supervisor_where_it_calls() -> None:
    system = example("three_components")
    top = next(t.priority for t in system.tasks if t.element == "board.supervisor")
    ceilings = {item.element: item.ceiling for item in system.objects}
    called = [f"{p.name}.monitor" for p in system.processors] + ["health", "trace"]
    called += ["board.supervisor.board", "one.Watching.queue"]
    assert {ceilings[name] for name in called} == {top}
    assert ceilings["two.Handling.queue"] < top


def test_the_program_supervises_each_processor_from_the_most_urgent_on() -> None:
    generated = STATIONS / "generated"
    spec = (generated / "three_components-liveness_supervision.ads").read_text()
    body = (generated / "three_components-liveness_supervision.adb").read_text()
    places = [spec.index(f"Processor_{n}_Watch") for n in (1, 2, 3)]
    assert places == sorted(places)
    assert f"Patience => {END_MARGIN:_}" in spec
    assert body.count("One.Offer (Starter.Station_Silent);") == 2
    certificate = (generated / "three_components-timing_certificate.ads").read_text()
    assert "Processor_1_L : constant := Processor_1_D + Board_Margin;" in certificate
    assert (
        "Processor_1_S : constant :=\n     Processor_1_L + Board_Supervisor_T + Board_Supervisor_R;"
        in certificate
    )


def test_a_model_without_supervision_has_no_such_task() -> None:
    system = example("pump")
    assert not [t for t in system.tasks if t.element.endswith(SUPERVISOR)]
    assert not list((ROOT / "examples" / "pump" / "generated").glob("*liveness*"))


@pytest.mark.slow
def test_the_report_says_how_soon_silence_is_found_or_that_nothing_looks_for_it() -> None:
    text = render_report(analyse(example("three_components")))
    #  deadline and margin; then a period of the supervisor and its response
    cells = f'<td class="n">{both(260_000_000)}</td><td class="n">{both(270_075_000)}</td>'
    assert f"<td>processor_2</td>{cells}" in text
    assert "<td>one.Station_Silent</td>" in text
    bare = render_report(analyse(example("pump")))
    assert "Nothing supervises board: no task finds a processor" in bare


# --- The verdict -----------------------------------------------------------------------


def _seen(system: System, now: int | None, **counts: int) -> Observation:
    """A trace that counts these releases; of the other processors those that were due."""
    found = Observation(TraceMap("", "", {}), complete=True)
    for one in system.processors:
        due = (now or 0) // one.period
        worst = Ns(one.period // 4)
        many = counts.get(one.name, due)
        found.processors[one.name] = Releases(many, 0, worst, None if now is None else Ns(now))
    return found


def _unaccounted(seen: Observation, withheld: int = 0, *, real_time: bool = True) -> list[str]:
    rows = [Comparison("processor_1", 1, 0, Ns(1), 2, Ns(withheld))]
    system = example("three_components")
    return list(judge.unaccounted(system, seen, rows, real_time=real_time))


def test_releases_that_agree_with_the_time_are_no_failure() -> None:
    assert _unaccounted(_seen(example("three_components"), 1_000 * MS)) == []


@pytest.mark.parametrize(("least", "withheld", "real_time"), [(100, 0, True), (90, 100, True)])
def test_releases_that_are_missing_fail_a_run(least: int, withheld: int, real_time: bool) -> None:
    system = example("three_components")
    #  the release that was due at 1000 ms has not had its deadline
    enough = _seen(system, 1_000 * MS, processor_3=least)
    assert _unaccounted(enough, withheld * MS, real_time=real_time) == []
    short = _seen(system, 1_000 * MS, processor_3=least - 1)
    assert _unaccounted(short, withheld * MS, real_time=real_time) == [
        f"processor_3 completed {least - 1} releases in 1.000 s, but at least {least} were due "
        "by then"
    ]


def test_without_real_time_priorities_releases_may_lag_behind() -> None:
    system = example("three_components")
    lagging = _seen(system, 1_000 * MS, processor_3=90)
    assert _unaccounted(lagging, real_time=False) == []
    assert _unaccounted(lagging) != []


def test_more_releases_than_were_due_fail_a_run() -> None:
    system = example("three_components")
    (failure,) = _unaccounted(_seen(system, 1_000 * MS, processor_1=103))
    assert (
        failure
        == "processor_1 completed 103 releases in 1.000 s, but no more than 102 were due by then"
    )


def test_what_a_trace_does_not_count_fails_a_run() -> None:
    system = example("three_components")
    seen = _seen(system, 1_000 * MS)
    del seen.processors["processor_2"]
    assert _unaccounted(seen) == ["the trace does not say how often processor_2 was released"]
    timeless = _unaccounted(_seen(system, None))
    assert timeless[0] == "the trace does not say when the releases of processor_1 were counted"
    assert len(timeless) == 3


def test_the_counts_of_a_trace_have_the_time_at_which_they_were_read() -> None:
    lines = ["N 1500", "F 7", "END"]
    seen = read_trace(lines, TraceMap("", "", {}))
    assert (seen.now, seen.feeds, seen.complete) == (1500, 7, True)


@pytest.mark.parametrize(
    ("ended", "expected"),
    [
        (Ended(0, False, True, ("error: is no reason here",)), []),
        (
            Ended(1, False, True, ("warning: slow", "error: control has ended by X")),
            ["the controller stopped itself: control has ended by X"],
        ),
        (
            Ended(-signal.SIGSEGV, False, True, ()),
            [
                "the controller was ended by SIGSEGV: a stack overflow, or an access to memory "
                "that it does not have"
            ],
        ),
        (Ended(-signal.SIGKILL, True, True, ()), []),
        (Ended(2, False, True, ()), []),
    ],
)
def test_why_a_controller_stopped_itself(ended: Ended, expected: list[str]) -> None:
    assert list(judge.stops(ended)) == expected
