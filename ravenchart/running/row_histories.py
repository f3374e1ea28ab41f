# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The responses of activities up to any instant of a recorded run."""

from __future__ import annotations

from bisect import bisect_right
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import replace

from ravenchart.analysis.system.observed import Observation
from ravenchart.analysis.system.row_responses import (
    BINS,
    RowHistogram,
    RowSample,
    empty_histograms,
    executions_of,
    processors_of,
    samples,
)
from ravenchart.analysis.system.timing import Analysis
from ravenchart.gen.model.system import Processor, Slot

Count = tuple[int, int]
"""When a report was read, in ns, and how many releases had completed then."""


class RowHistory:
    """The responses of an activity in a run; the bins are the same at each instant."""

    def __init__(
        self, whole: RowHistogram, found: Sequence[RowSample], counts: Sequence[Count]
    ) -> None:
        """``whole``: without responses yet; ``found``: all, by time; ``counts``: executions."""
        self._counts = counts
        for one in found:
            whole.add(one)
        self._whole = whole
        self._times: defaultdict[tuple[bool, int], list[int]] = defaultdict(list)
        self._longest: dict[bool, list[tuple[int, int]]] = {True: [], False: []}
        for one in found:
            self._times[one.exact, whole.bin_of(one.response)].append(one.at)
            longest = self._longest[one.exact]
            if not longest or one.response > longest[-1][1]:
                longest.append((one.at, one.response))

    def at(self, now: int) -> RowHistogram:
        """The responses by the reports up to a time of the controller."""
        known = bisect_right(self._counts, now, key=lambda one: one[0])
        return replace(
            self._whole,
            executions=self._counts[known - 1][1] if known else 0,
            exact=self._bins(now, exact=True),
            at_most=self._bins(now, exact=False),
            longest=self._longest_at(now, exact=True),
            longest_at_most=self._longest_at(now, exact=False),
        )

    def _bins(self, now: int, *, exact: bool) -> list[int]:
        return [bisect_right(self._times.get((exact, k), ()), now) for k in range(BINS)]

    def _longest_at(self, now: int, *, exact: bool) -> int | None:
        found = self._longest[exact]
        known = bisect_right(found, now, key=lambda one: one[0])
        return found[known - 1][1] if known else None


def histories(analysis: Analysis, seen: Observation) -> Iterator[RowHistory]:
    """Those of all activities of a controller, in the order of the tables."""
    for processor in processors_of(analysis.system, seen):
        found: defaultdict[str, list[RowSample]] = defaultdict(list)
        for one in samples(processor, seen):
            found[one.row].append(one)
        for slot, whole in zip(
            processor.slots, empty_histograms(analysis, [processor]), strict=True
        ):
            yield RowHistory(whole, found[slot.element], list(_counts(processor, slot, seen)))


def _counts(processor: Processor, slot: Slot, seen: Observation) -> Iterator[Count]:
    """The executions of an activity in completed releases, by report."""
    for name, counts in seen.reports:
        if name.lower() == processor.name.lower():
            now = seen.end if counts.now is None else counts.now
            yield now, executions_of(processor, slot, counts.releases)
