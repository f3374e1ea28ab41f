# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The verdict on a run: every reason why it failed, in words."""

from __future__ import annotations

import signal
from collections.abc import Iterator, Sequence
from itertools import pairwise

from ravenchart import rounded
from ravenchart.analysis.present.report import Comparison, StepRow
from ravenchart.analysis.system.journeys import Journey
from ravenchart.analysis.system.observed import Observation
from ravenchart.gen.model.system import Processor, System
from ravenchart.hw_can.bench.forms import TraceCheck
from ravenchart.hw_can.bench.runner import ScenarioResult

from .expected import longest_withheld
from .process import Ended


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


OWN_TIME = 100_000_000
"""Time in ns by which releases may lag behind where no real-time priority orders them."""


def stops(ended: Ended) -> Iterator[str]:
    """Why the controller ended unasked: the first of all reasons for which a run fails."""
    yield from (f"the controller stopped itself: {reason}" for reason in ended.reasons)
    if ended.exit_code < 0 and not ended.killed:
        yield f"the controller was ended by {_signal(-ended.exit_code)}"


def _signal(number: int) -> str:
    """A signal by its name; of SIGSEGV what leads to it."""
    name = signal.Signals(number).name if number in set(signal.Signals) else f"signal {number}"
    if number == signal.SIGSEGV:
        name += ": a stack overflow, or an access to memory that it does not have"
    return name


def unaccounted(
    system: System, seen: Observation, compared: Sequence[Comparison], *, real_time: bool
) -> Iterator[str]:
    """Processors whose releases do not agree with the time that went by.

    A release must have completed when its longest response was over: the deadline, what was
    observed of others, and what the host withheld. No release begins before it is due.
    """
    withheld = max(seen.stolen or 0, longest_withheld(compared))
    own = 0 if real_time else OWN_TIME
    for processor in system.processors:
        counts = seen.processors.get(processor.name)
        if counts is None:
            if seen.complete and seen.processors:
                yield f"the trace does not say how often {processor.name} was released"
            continue
        if counts.now is None:
            yield f"the trace does not say when the releases of {processor.name} were counted"
            continue
        limit = max(processor.deadline, counts.worst_response) + withheld + own
        least = _due(processor, counts.now - limit)
        most = _due(processor, counts.now) + 1
        if processor.released_by is None and counts.releases < least:
            yield (
                f"{processor.name} completed {counts.releases} releases in "
                f"{rounded.instant(counts.now)} s, but at least {least} were due by then"
            )
        elif counts.releases > most:
            yield (
                f"{processor.name} completed {counts.releases} releases in "
                f"{rounded.instant(counts.now)} s, but no more than {most} were due by then"
            )


def _due(processor: Processor, elapsed: int) -> int:
    """Releases that are due until then; of a sporadic processor at most."""
    since = elapsed - processor.offset
    return 0 if since < 0 else since // processor.period + 1


def failures(
    ended: Ended,
    result: ScenarioResult | None,
    seen: Observation | None,
    checks: Sequence[StepRow],
    compared: Sequence[Comparison],
    took: Sequence[Journey] = (),
) -> Iterator[str]:
    """Every reason for which the run failed; none when it passed.

    A response that is too long by no more than the host is known to have withheld
    the core is no failure: the bounds hold for a core that the controller has. Nor is
    a reaction in a run in which that happened, nor one that is too long by no more than
    that time at each place of its chain.
    """
    withheld = longest_withheld(compared)
    if result is not None:
        yield from (f"{s.text}: {s.outcome}" for s in result.steps if not s.passed)
        if result.not_run and all(s.passed for s in result.steps):
            yield f"{result.not_run} steps were not run"
    yield from (f"{c.text}: {c.outcome}" for c in checks if not c.passed)
    if ended.killed:
        yield "the controller did not end when asked to, and was killed"
    elif ended.exit_code > 0 and not ended.reasons:
        yield f"the controller ended with exit code {ended.exit_code}"
    if seen is not None:
        if not seen.complete:
            yield "the trace is cut off: its END line is missing"
        if seen.trace_lost:
            yield f"{seen.trace_lost} trace records were lost"
        if seen.values_lost:
            yield f"{seen.values_lost} recorded values were lost"
        if seen.complete and not seen.processors:
            yield "the trace holds no processor's counts"
    if ended.real_time:
        yield from (
            f"{row.task} was observed to take {_above(row.observed, row.bound or 0)}"
            for row in compared
            if row.exceeded and not row.explained
        )
        yield from (
            f"the chain {row.chain} was observed to react after {_above(row.observed, row.bound)}"
            for row in took
            if row.exceeded
            and not row.is_explained(withheld)
            and not any(other.explained for other in compared)
        )


def _above(observed: int, bound: int) -> str:
    """An observed time that is above its bound."""
    longest, limit = rounded.beside(observed, bound)
    return f"{longest}, above its bound of {limit}"


def _reached(check: TraceCheck, seen: Observation) -> tuple[bool, str, float]:
    """Whether the region reached the state, in words, and when (s in the trace)."""
    if check.region not in seen.states_visited():
        return False, f"the trace map has no region {check.region}", 0.0
    entries = [v.start for v in seen.visits(check.region) if v.state == check.reaches]
    if not entries:
        visited = ", ".join(seen.states_visited()[check.region]) or "none"
        return False, f"never: it visited {visited}", 0.0
    entered = entries[-1]
    passed, outcome = True, f"at {rounded.instant(entered)} s"
    if check.within is not None and check.port is not None:
        arrivals = [record.time for record in seen.of("arrived", check.port)]
        if not arrivals:
            return False, f"nothing arrived at {check.port}", entered / 1e9
        since = arrivals[-1] if check.after_last else _silence(arrivals)
        delay = next((e for e in entries if e >= since), entered) - since
        passed, outcome = 0 <= delay / 1e9 <= check.within, f"after {rounded.up(delay)}"
    if check.then is not None:
        later = [v.start for v in seen.visits(check.region) if v.state == check.then]
        if not later or later[-1] < entries[0]:
            return False, f"{outcome}, but never in {check.then} later", entered / 1e9
        outcome += f", then at {rounded.instant(later[-1])} s"
    return passed, outcome, entered / 1e9


def _silence(arrivals: Sequence[int]) -> int:
    """The arrival before the longest time without one."""
    gaps = [(later - time, time) for time, later in pairwise(arrivals)]
    return max(gaps, default=(0, arrivals[-1]), key=lambda gap: gap[0])[1]
