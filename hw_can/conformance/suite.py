# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Runs the cases on two ends of a bus; an impossible case is skipped, never passed."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum

import can

from ravenchart.hw_can.bench.interfaces import fault_text

from .cases import CASES, LAST, ConformanceCase, Failed, Skipped, frame
from .ends import Ends, Setup, is_faulty

Progress = Callable[[str], None]


class CaseVerdict(Enum):
    """The verdict on a case."""

    PASSED = "passed"
    FAILED = "FAILED"
    SKIPPED = "skipped"


@dataclass(frozen=True, slots=True)
class CaseResult:
    """The result of one case: its observation, or the reason of its failure."""

    name: str
    verdict: CaseVerdict
    detail: str
    seconds: float


@dataclass(frozen=True, slots=True)
class SuiteResult:
    """The result of the suite. ``latencies`` in ns; ``rate`` in frames per second."""

    setup: Setup
    cases: tuple[CaseResult, ...]
    latencies: tuple[int, ...]
    rate: float | None

    def count(self, verdict: CaseVerdict) -> int:
        """The number of cases with this verdict."""
        return sum(case.verdict is verdict for case in self.cases)

    @property
    def seconds(self) -> float:
        """The time of all cases together."""
        return sum(case.seconds for case in self.cases)

    @property
    def passed(self) -> bool:
        """Whether no case failed, and at least one passed."""
        return self.count(CaseVerdict.FAILED) == 0 and self.count(CaseVerdict.PASSED) > 0


def run(
    ends: Ends, progress: Progress = lambda name: None, cases: Sequence[ConformanceCase] = CASES
) -> SuiteResult:
    """Run ``cases`` in order; once no frame arrives, the rest is skipped."""
    results: list[CaseResult] = []
    lost = False
    for case in cases:
        progress(case.name)
        began = time.monotonic()
        if lost:
            verdict, detail = CaseVerdict.SKIPPED, "the bus was lost before"
        else:
            verdict, detail = _run_one(ends, case)
            loss = _loss(ends) if verdict is CaseVerdict.FAILED else None
            if loss is not None:
                lost, detail = True, f"{detail}{loss}"
        results.append(CaseResult(case.name, verdict, detail, time.monotonic() - began))
    return SuiteResult(ends.setup, tuple(results), tuple(ends.latencies), ends.rate)


def _loss(ends: Ends) -> str | None:
    """Why no case can pass after one has failed, as its end; None when a frame still arrives."""
    if not ends.usable():
        return ""
    try:
        if ends.across([frame(LAST)]):
            return None
    except Exception as fault:
        return f"; no frame can be sent: {fault_text(fault)}"
    if ends.errors or is_faulty(ends.near):
        return "; no other node acknowledges a frame: connect one, or check the cable"
    return f"; no frame arrives within {ends.patience:g} s"


def _run_one(ends: Ends, case: ConformanceCase) -> tuple[CaseVerdict, str]:
    """Verdict and reason. Any exception of a driver is a failure of the case."""
    try:
        ends.drain()
        return CaseVerdict.PASSED, case.run(ends)
    except Skipped as reason:
        return CaseVerdict.SKIPPED, str(reason)
    except Failed as reason:
        return CaseVerdict.FAILED, str(reason)
    except NotImplementedError as missing:
        return CaseVerdict.SKIPPED, f"not implemented there: {fault_text(missing)}"
    except (can.CanError, OSError) as fault:
        return CaseVerdict.FAILED, fault_text(fault)
    except Exception as fault:
        return CaseVerdict.FAILED, f"the driver raised {fault_text(fault)}"


def histogram(latencies: Sequence[int]) -> tuple[tuple[int, int], ...]:
    """The number of ``latencies`` (ns) below each power of two in us, and not below the last.

    The powers go without a gap from the lowest to the highest that has any.
    """
    powers = [(latency // 1_000).bit_length() for latency in latencies]
    if not powers:
        return ()
    return tuple((2**power, powers.count(power)) for power in range(min(powers), max(powers) + 1))
