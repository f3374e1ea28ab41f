"""The verdict on a run: every reason why it failed, in words."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from analysis.observed import Observation
from analysis.report import Comparison, StepRow
from analysis.units import microseconds
from hw_can.bench.runner import ScenarioResult
from hw_can.bench.scenario import TraceCheck
from ravenchart.demo.process import Ended


def step_rows(result: ScenarioResult, checks: Sequence[StepRow]) -> tuple[StepRow, ...]:
    """The scenario's steps, and behind them the checks of the trace."""
    steps = (StepRow(s.text, s.outcome, s.passed, s.began) for s in result.steps)
    return (*steps, *checks)


def check_trace(checks: Sequence[TraceCheck], seen: Observation) -> tuple[StepRow, ...]:
    """How each expectation about the trace fared."""
    rows = []
    for check in checks:
        passed, outcome, at = _reached(check, seen)
        rows.append(StepRow(str(check), outcome, passed, at))
    return tuple(rows)


def failures(
    ended: Ended,
    result: ScenarioResult | None,
    seen: Observation | None,
    checks: Sequence[StepRow],
    compared: Sequence[Comparison],
) -> Iterator[str]:
    """Every reason for which the run failed; none when it passed.

    A response that is too long by no more than the host is known to have withheld
    the core is no failure: the bounds hold for a core that the controller has.
    """
    if result is not None:
        yield from (f"{s.text}: {s.outcome}" for s in result.steps if not s.passed)
        if result.not_run and all(s.passed for s in result.steps):
            yield f"{result.not_run} steps were not run"
    yield from (f"{c.text}: {c.outcome}" for c in checks if not c.passed)
    if ended.killed:
        yield "the controller did not end when asked to, and was killed"
    elif ended.exit_code != 0:
        yield f"the controller ended with exit code {ended.exit_code}"
    if seen is not None:
        if not seen.complete:
            yield "the trace is cut off: its END line is missing"
        if seen.trace_lost:
            yield f"{seen.trace_lost} trace records were lost"
        if seen.complete and not seen.processors:
            yield "the trace holds no processor's counts"
        excused = {row.task for row in compared if row.explained}
        yield from (
            f"{name} missed {p.misses} of {p.releases} deadlines"
            for name, p in seen.processors.items()
            if p.misses and name not in excused
        )
    if ended.real_time:
        yield from (
            f"{row.task} was observed to take {microseconds(row.observed)} us, "
            f"above its bound of {microseconds(row.bound or 0)} us"
            for row in compared
            if row.exceeded and not row.explained
        )


def _reached(check: TraceCheck, seen: Observation) -> tuple[bool, str, float]:
    """Whether the region reached the state, in words, and when (s in the trace)."""
    if check.region not in seen.states_visited():
        return False, f"the trace map has no region {check.region}", 0.0
    entries = [v.start for v in seen.visits(check.region) if v.state == check.reaches]
    if not entries:
        visited = ", ".join(seen.states_visited()[check.region]) or "none"
        return False, f"never: it visited {visited}", 0.0
    entered = entries[-1]
    if check.within is None or check.after_last is None:
        return True, f"at {entered / 1e9:.3f} s", entered / 1e9
    arrivals = seen.of("arrived", check.after_last)
    if not arrivals:
        return False, f"nothing arrived at {check.after_last}", entered / 1e9
    delay = (entered - arrivals[-1].time) / 1e9
    outcome = f"after {delay * 1e3:.1f} ms"
    return 0 <= delay <= check.within, outcome, entered / 1e9
