# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A timeline as CSV, as MDF 4, and as JSON in the trace event format that Perfetto and Chrome open.

The format: "Trace Event Format" (Google). Times (``ts``, ``dur``) are in microseconds. A slice is a
complete event (``X``), a mark an instant event (``i``), a value a counter event (``C``), and names
are metadata events (``M``).
"""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from ravenchart.failures import Unusable
from ravenchart.gen.language.terms import Ns

from . import mdf
from .timeline import Timeline, Track
from .values import Series

FIRST_TID = 100
"""Before the numbers of threads: one that is equal to its process's is called the main thread."""

COLUMNS = ("time_ns", "node", "kind", "element", "detail", "unit")


def as_csv(timeline: Timeline) -> str:
    """The records in order of time, then the counts of the end, which have no time."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for row in timeline.rows:
        at = "" if row.at is None else row.at
        writer.writerow((at, row.process, row.kind, row.element, row.detail, row.unit))
    return text.getvalue()


def as_events(timeline: Timeline) -> str:
    """One JSON object, with one event a line."""
    head = {"displayTimeUnit": "ns", "otherData": _about(timeline)}
    lines = ",\n".join(json.dumps(one) for one in _events(timeline))
    return f'{json.dumps(head)[:-1]}, "traceEvents": [\n{lines}\n]}}\n'


def as_mdf(timeline: Timeline) -> bytes:
    """The recorded values, and the states of the charts that `record` names, as MDF 4."""
    if not timeline.series and not timeline.states:
        raise Unusable("the model records no values: name ports and data items under `record:`")
    return mdf.written([*timeline.series, *timeline.states], _about(timeline))


FORMATS: Mapping[str, Callable[[Timeline], bytes]] = {
    ".csv": lambda timeline: as_csv(timeline).encode(),
    ".json": lambda timeline: as_events(timeline).encode(),
    ".mf4": as_mdf,
}
"""By the suffix of the file."""


def _about(timeline: Timeline) -> dict[str, str]:
    """Facts about the whole trace; each loss is named."""
    lost = {f"lost {what}": str(number) for what, number in timeline.lost.items()}
    complete = "yes" if timeline.complete else "no: the run did not end by itself"
    return {"system": timeline.system, "complete": complete, **lost}


def _events(timeline: Timeline) -> Iterator[dict[str, Any]]:
    processes: dict[str, int] = {}
    places: dict[Track, dict[str, int]] = {}
    for number, track in enumerate(timeline.tracks, 1):
        if track.process not in processes:
            processes[track.process] = len(processes) + 1
            yield _named("process", processes[track.process], 0, track.process)
        place = {"pid": processes[track.process], "tid": FIRST_TID + number}
        places[track] = place
        yield _named("thread", **place, name=track.name)
        yield {
            "name": "thread_sort_index", "ph": "M", **place, "args": {"sort_index": number},
        }  # fmt: skip
    timed: list[tuple[Ns, dict[str, Any]]] = []
    for one in timeline.slices:
        event: dict[str, Any] = {
            "name": one.name, "cat": one.kind, "ph": "X", "ts": _us(one.start),
            "dur": _us(Ns(one.end - one.start)), **places[one.track],
        }  # fmt: skip
        if one.open:
            event["args"] = {"open": "it was so at the end of the trace"}
        timed.append((one.start, event))
    for mark in timeline.marks:
        event = {
            "name": mark.name, "cat": mark.kind, "ph": "i", "ts": _us(mark.at), "s": "t",
            **places[mark.track],
        }  # fmt: skip
        if mark.more:
            event["args"] = mark.more
        timed.append((mark.at, event))
    for series in timeline.series:
        timed += _counter(series, processes.setdefault(series.process, len(processes) + 1))
    yield from (event for _, event in sorted(timed, key=lambda found: found[0]))


def _counter(series: Series, pid: int) -> Iterator[tuple[Ns, dict[str, Any]]]:
    """The samples of a counter; an enumeration has slices, and none."""
    quantity = series.quantity
    name = f"{series.name} in {quantity.unit}" if quantity.unit else series.name
    for at, number in () if quantity.literals else series.points:
        sample = {"ph": "C", "ts": _us(at), "pid": pid, "args": {"value": quantity.value(number)}}
        yield at, {"name": name, "cat": "value", **sample}


def _named(what: str, pid: int, tid: int, name: str) -> dict[str, Any]:
    return {"name": f"{what}_name", "ph": "M", "pid": pid, "tid": tid, "args": {"name": name}}


def _us(time: Ns) -> float | int:
    """A time in us, exact."""
    return time // 1000 if time % 1000 == 0 else time / 1000
