# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The observation of one run of a controller: its trace file, read with the generator's map.

The file holds one record a line. Times are in nanoseconds from the controller's start. Counts
come after the ``T`` and ``V`` lines, and ten times a second where a monitor can watch. The last
counts are those of the run. Without ``END`` the run was cut off. The map names each element number.

    E clock                                     the machine's clock at the start
    M digest                                    of the program's model; a board repeats the line
    T time kind element value                   an event
    V time element value                        a recorded value
    P processor releases misses worst_response last_response    (the last not in older programs)
    A row worst_execution
    Q region waiting highest                    the queue of a chart
    H fault count, L what count, W host_latency, F feeds
    N now                                       before the counts that were read then
    END
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from ravenchart.gen.language.terms import NO_TIME, Ns

KINDS = frozenset(
    {"sent", "arrived", "handled", "raised", "activity", "transition", "state", "fault"}
)
"""The kinds of T lines, in lower case."""

FAULTS = (
    "Deadline_Miss", "Overrun", "Queue_Overflow", "Stale_Input", "Can_Error_Passive", "Can_Bus_Off",
    "Silence", "Protection_Error",
)  # fmt: skip
"""The faults in the order of their numbers, which is that of Ravenchart.Health.Fault_Kind."""

TRACE = "trace"
"""The word of the L line that counts records lost because the trace was full."""

VALUE = "value"
"""The kind of a V line, and of the elements that have V lines."""

VALUES = "values"
"""The word of the L line that counts values lost because the buffer was full."""

_GOOD = ("sent", "received")
"""Last words of the L lines that count no losses."""


class TraceError(Exception):
    """A trace or map that cannot be read; the text names the line of the file."""


@dataclass(frozen=True, slots=True)
class NumberedElement:
    """One numbered element; ``leaves`` are a region's or bus's, ``transitions`` a region's.

    A recorded value has the ``literals`` of its enumeration, or the ``unit`` of its integers.
    """

    number: int
    name: str
    kind: str
    origin: str
    leaves: tuple[str, ...] = ()
    transitions: tuple[str, ...] = ()
    literals: tuple[str, ...] = ()
    unit: str | None = None


@dataclass(frozen=True, slots=True)
class TraceMap:
    """The generator's map: the model, and its numbered elements."""

    system: str
    digest: str
    elements: Mapping[int, NumberedElement]
    cores: int = 1
    """The cores of its node: the records of each come in order, not those of all together."""

    def named(self, name: str, kind: str) -> NumberedElement:
        """The element of that kind and name, in any case; KeyError where there is none."""
        for element in self.elements.values():
            if element.kind == kind and element.name.lower() == name.lower():
                return element
        raise KeyError(name)

    def of_kind(self, kind: str) -> tuple[NumberedElement, ...]:
        """The elements of one kind, by number."""
        return tuple(e for _, e in sorted(self.elements.items()) if e.kind == kind)


@dataclass(frozen=True, slots=True)
class TraceRecord:
    """One T or V line; ``kind`` in lower case, ``text`` the name of the state or transition."""

    time: Ns
    kind: str
    element: NumberedElement
    value: int

    @property
    def text(self) -> str:
        """The leaf, transition or literal that ``value`` stands for, else the number itself."""
        choices = _choices(self.kind, self.element)
        return choices[self.value] if choices else str(self.value)

    @property
    def fault(self) -> str | None:
        """The name of its fault; None where the record is of no fault, or of an unknown one."""
        known = self.kind == "fault" and 0 <= self.value < len(FAULTS)
        return FAULTS[self.value] if known else None


@dataclass(frozen=True, slots=True)
class Releases:
    """The counts of one processor: releases, deadlines missed, longest and last response.

    The counts were read at ``now`` or a little later; None where the trace has no such time.
    ``last_response`` is that of the release that completed last; None in an older trace.
    """

    releases: int
    misses: int
    worst_response: Ns
    now: Ns | None = None
    last_response: Ns | None = None


@dataclass(frozen=True, slots=True)
class QueueFill:
    """How many events wait in the queue of a chart, and the most that ever waited."""

    waiting: int
    highest: int


@dataclass(frozen=True, slots=True)
class Visit:
    """A stay in one leaf state; ``end`` is None for the last one."""

    state: str
    start: Ns
    end: Ns | None


@dataclass(slots=True)
class Observation:
    """The contents of one trace file; keys are element names or words of the file."""

    map: TraceMap
    records: list[TraceRecord] = field(default_factory=list)
    values: list[TraceRecord] = field(default_factory=list)
    """The recorded values, in the order in which they were recorded."""
    processors: dict[str, Releases] = field(default_factory=dict)
    reports: list[tuple[str, Releases]] = field(default_factory=list)
    """All counts that processors had, in the order of their reports; ``processors`` has the last.
    Empty where ``parts`` has them."""
    parts: dict[str, Observation] = field(default_factory=dict, repr=False)
    """Where it joins several controllers, the observation of each, by node."""
    executions: dict[str, Ns] = field(default_factory=dict)
    queues: dict[str, QueueFill] = field(default_factory=dict)
    """The queues of events, by region."""
    faults: dict[str, int] = field(default_factory=dict)
    counts: dict[str, int] = field(default_factory=dict)
    """The L lines: frames sent and received, and all losses."""
    host_latency: Ns | None = None
    """Longest time for which the host withheld the core, where a probe measured it."""
    stolen: Ns | None = None
    """Time that a hypervisor took of the core during the whole run, as its kernel counts it."""
    now: Ns | None = None
    """When the counts were read, in the controller's own time."""
    read_at: Ns | None = None
    """When the processors of the next lines were looked at: by another core, before ``now``."""
    feeds: int | None = None
    """How often the supervision fed the watchdog, where there is one."""
    complete: bool = False
    digest: str = ""
    """SHA-256 of the model that the program was generated from, as the program prints it."""
    start: Ns = NO_TIME
    """The machine's clock when this controller's time was 0."""
    ready: Ns = NO_TIME
    """The time from which on all controllers ran."""

    @property
    def misses(self) -> int:
        """Deadlines missed on all processors."""
        return sum(p.misses for p in self.processors.values())

    @property
    def losses(self) -> dict[str, int]:
        """The counts of losses: all but frames sent and received."""
        return {what: n for what, n in self.counts.items() if what.rpartition(".")[2] not in _GOOD}

    @property
    def trace_lost(self) -> int:
        """Records that did not fit into the controller's trace buffer."""
        return sum(n for what, n in self.losses.items() if is_of(what, TRACE))

    @property
    def values_lost(self) -> int:
        """Recorded values that did not fit into the controller's buffer."""
        return sum(n for what, n in self.losses.items() if is_of(what, VALUES))

    @property
    def end(self) -> Ns:
        """Time of the last record."""
        last = [records[-1].time for records in (self.records, self.values) if records]
        return max(last, default=Ns(0))

    def of(self, kind: str, element: str) -> tuple[TraceRecord, ...]:
        """The records of one kind about one element, in order."""
        wanted = element.lower()
        return tuple(r for r in self.records if r.kind == kind and r.element.name.lower() == wanted)

    def visits(self, region: str) -> tuple[Visit, ...]:
        """The stays of one region in its leaf states, or of a controller on a bus, in order."""
        stays: list[Visit] = []
        for record in self.of("state", region):
            if stays and stays[-1].state == record.text:
                continue
            if stays:
                stays[-1] = Visit(stays[-1].state, stays[-1].start, record.time)
            stays.append(Visit(record.text, record.time, None))
        return tuple(stays)

    def states_visited(self) -> dict[str, tuple[str, ...]]:
        """The leaf states that each region, and controller, was in, each once, in first order."""
        return {
            element.name: tuple(dict.fromkeys(v.state for v in self.visits(element.name)))
            for element in (*self.map.of_kind("region"), *self.map.of_kind("bus"))
        }


def read_map(text: str, file: str = "trace.json") -> TraceMap:
    """The map in ``text``; TraceError when the text is not a map."""
    try:
        raw: Any = json.loads(text)
        elements = [_element(item) for item in raw["elements"]]
        numbered = {e.number: e for e in elements}
        if len(numbered) != len(elements):
            raise TraceError(f"{file}: error: two elements have the same id")
        cores = int(raw.get("cores", 1))
        return TraceMap(str(raw["system"]), str(raw["digest"]), numbered, cores)
    except json.JSONDecodeError as fault:
        raise TraceError(f"{file}:{fault.lineno}: error: not JSON: {fault.msg}") from None
    except (KeyError, TypeError, ValueError) as fault:
        raise TraceError(f"{file}: error: not a trace map: {_reason(fault)}") from None


def read_trace(lines: Iterable[str], trace_map: TraceMap, file: str = "trace") -> Observation:
    """The observation in the lines; TraceError names the first line that cannot be read."""
    seen = Observation(trace_map)
    for number, line in enumerate(lines, start=1):
        try:
            take_line(line, seen)
        except ValueError as fault:
            raise TraceError(f"{file}:{number}: error: {fault}") from None
    if trace_map.cores > 1:
        _put_in_order(seen)
    return seen


def _put_in_order(seen: Observation) -> None:
    """Put what several controllers or cores have noted in the order of its times."""
    for noted in (seen.records, seen.values):
        noted.sort(key=lambda record: record.time)


def of_model(seen: Observation, digest: str, file: str = "trace") -> None:
    """TraceError where the program that wrote a trace was not generated from this model."""
    if seen.digest != digest:
        found = f"has the digest {seen.digest[:12]}" if seen.digest else "has no digest"
        raise TraceError(
            f"{file}: error: the trace {found}, and the model has {digest[:12]}: the program that "
            "wrote it was generated from another model; generate, build and run again"
        )


def merged(parts: Mapping[str, Observation]) -> Observation:
    """The joint observation of several controllers on one machine, by node, as if of one.

    Times count from the first start of all. Elements are numbered anew. The words of counts
    begin with the name of their node.
    """
    first = min(part.start for part in parts.values())
    elements: dict[int, NumberedElement] = {}
    whole = Observation(TraceMap("", "", elements), start=first, complete=True, parts=dict(parts))
    for node, part in parts.items():
        own = {e: replace(e, number=e.number + len(elements)) for e in part.map.elements.values()}
        late = part.start - first
        for mine, theirs in ((whole.records, part.records), (whole.values, part.values)):
            mine += [replace(r, time=Ns(r.time + late), element=own[r.element]) for r in theirs]
        elements |= {e.number: e for e in own.values()}
        whole.processors |= part.processors
        whole.executions |= part.executions
        whole.queues |= part.queues
        whole.counts |= {f"{node}.{what}": n for what, n in part.counts.items()}
        for fault, n in part.faults.items():
            whole.faults[fault] = whole.faults.get(fault, 0) + n
        if part.host_latency is not None:
            whole.host_latency = max(whole.host_latency or Ns(0), part.host_latency)
        whole.complete = whole.complete and part.complete
        whole.ready = max(whole.ready, Ns(late))
        whole.digest = part.digest
        whole.map = replace(part.map, elements=elements)
    _put_in_order(whole)
    return whole


def take_line(line: str, seen: Observation) -> None:
    """Add one line to the observation; ValueError names the error of the line."""
    words = line.split()
    if words and seen.complete:
        raise ValueError("nothing may follow END")
    if words:
        _take(words, seen)


def _take(words: list[str], seen: Observation) -> None:
    match words:
        case ["T", time, kind, element, value]:
            if kind.lower() == VALUE:
                raise ValueError(f"unknown kind {kind!r}")
            seen.records.append(trace_record(time, kind, element, value, seen.map))
        case ["V", time, element, value]:
            seen.values.append(trace_record(time, VALUE, element, value, seen.map))
        case ["M", digest]:
            seen.digest = digest
        case ["E", clock]:
            seen.start = Ns(_count(clock))
        case ["N", now]:
            seen.now = seen.read_at = Ns(_count(now))
        case ["O", looked]:
            seen.read_at = Ns(_count(looked))
        case ["END"]:
            seen.complete = True
        case _:
            _take_count(words, seen)


def _take_count(words: list[str], seen: Observation) -> None:
    match words:
        case ["P", number, releases, misses, worst, *last] if len(last) <= 1:
            counts = Releases(
                _count(releases), _count(misses), Ns(_count(worst)), seen.read_at,
                Ns(_count(last[0])) if last else None,
            )  # fmt: skip
            name = _known(number, seen.map, "processor").name
            seen.processors[name] = counts
            seen.reports.append((name, counts))
        case ["Q", number, waiting, highest]:
            fill = QueueFill(_count(waiting), _count(highest))
            seen.queues[_known(number, seen.map, "region").name] = fill
        case ["A", number, worst]:
            seen.executions[_known(number, seen.map, "row").name] = Ns(_count(worst))
        case ["H", kind, count]:
            seen.faults[kind] = _count(count)
        case ["L", what, count]:
            seen.counts[what] = _count(count)
        case ["W", latency]:
            seen.host_latency = Ns(_count(latency))
        case ["F", feeds]:
            seen.feeds = _count(feeds)
        case _:
            raise ValueError(f"not a trace line: {' '.join(words)[:60]!r}")


def trace_record(time: str, kind: str, number: str, value: str, trace_map: TraceMap) -> TraceRecord:
    """The record in the words of a T line; ValueError names the error of the words."""
    name = kind.lower()
    if name not in KINDS and name != VALUE:
        raise ValueError(f"unknown kind {kind!r}")
    kinds = {"state": ("region", "bus"), "transition": ("region",), VALUE: (VALUE,)}.get(name, ())
    element = _known(number, trace_map, *kinds)
    record = TraceRecord(Ns(_number(time)), name, element, _number(value))
    choices = _choices(name, element)
    if choices is not None and not 0 <= record.value < len(choices):
        raise ValueError(f"{element.name} has no {name} number {value}")
    return record


def _choices(kind: str, element: NumberedElement) -> tuple[str, ...] | None:
    """The names of the values of such records; None where the values are numbers."""
    if kind == VALUE:
        return element.literals or None
    return {"state": element.leaves, "transition": element.transitions}.get(kind)


def is_of(what: str, label: str) -> bool:
    """Whether an L line has this label; of several controllers the node comes before it."""
    return what.lower().rpartition(".")[2] == label


def _known(number: str, trace_map: TraceMap, *kinds: str) -> NumberedElement:
    """The element with that number, of one of those kinds where any are given."""
    element = trace_map.elements.get(_number(number))
    if element is None:
        raise ValueError(f"the map has no element {number}")
    if kinds and element.kind not in kinds:
        wanted = " or a ".join(kinds)
        raise ValueError(f"element {number}, {element.name}, is a {element.kind}, not a {wanted}")
    return element


def _element(item: Any) -> NumberedElement:
    """One element of the map."""
    return NumberedElement(
        number=int(item["id"]),
        name=str(item["element"]),
        kind=str(item["kind"]),
        origin=str(item.get("origin", "")),
        leaves=tuple(map(str, item.get("leaves", ()))),
        transitions=tuple(map(str, item.get("transitions", ()))),
        literals=tuple(map(str, item.get("literals", ()))),
        unit=item.get("unit"),
    )


def _number(word: str) -> int:
    """An integer, in the only form that the controller writes."""
    digits = word.removeprefix("-")
    if not (digits.isascii() and digits.isdigit()) or len(digits) > 19:
        raise ValueError(f"{word[:20]!r} is not a number")
    return int(word)


def _count(word: str) -> int:
    """A number that is not negative."""
    number = _number(word)
    if number < 0:
        raise ValueError(f"{word} is negative")
    return number


def _reason(fault: Exception) -> str:
    """The text of an exception of the reader."""
    return f"{fault.args[0]} is missing" if isinstance(fault, KeyError) else str(fault)
