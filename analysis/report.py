"""The report: one HTML file that needs nothing else, for the screen and for paper."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape
from markupsafe import Markup

from . import units
from .bus_load import bus_loads
from .graph import chains, component_view
from .observed import Observation
from .picture import draw
from .response_times import Analysis, Response, Verdict
from .table import WORDS, growth_line, verdict_line

SHOWN_CHAINS = 40
"""How many chains the report lists at most."""


@dataclass(frozen=True, slots=True)
class StepRow:
    """One step of a scenario: what it asked, how it ended, when (s from the start)."""

    text: str
    outcome: str
    passed: bool
    at: float


@dataclass(frozen=True, slots=True)
class FrameRow:
    """How many frames of one message the bench sent or received."""

    message: str
    direction: str
    count: int


@dataclass(frozen=True, slots=True)
class Comparison:
    """Longest response seen of one task, beside its bound (None: none known).

    ``withheld`` is the longest time for which the host kept the core to itself, as
    far as the controller measured it: the analysis does not know of that.
    """

    task: str
    releases: int
    misses: int
    observed: int
    bound: int | None
    withheld: int = 0

    @property
    def explained(self) -> bool:
        """What was seen is above the bound by no more than the host withheld."""
        return self.exceeded and self.observed <= (self.bound or 0) + self.withheld

    @property
    def word(self) -> str:
        """How the task fared: in order, by the host's fault, or not."""
        if not self.misses and not self.exceeded:
            return "ok"
        if self.explained:
            return "host"
        return "MISS" if self.misses else "ABOVE"

    @property
    def exceeded(self) -> bool:
        """What was seen is longer than the bound."""
        return self.bound is not None and self.observed > self.bound

    @property
    def ratio(self) -> float:
        """Observed over bound; 0 without a bound."""
        return self.observed / self.bound if self.bound else 0.0


@dataclass(frozen=True, slots=True)
class RunReport:
    """What a run adds to the report. ``pictures`` are (caption, SVG text).

    ``comparable`` is false where the controller had no real-time priorities: what
    was seen then says nothing about the bounds.
    """

    title: str
    passed: bool
    verdict: str
    notes: tuple[str, ...]
    steps: tuple[StepRow, ...]
    frames: tuple[FrameRow, ...]
    comparable: bool
    observation: Observation | None
    pictures: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class Execution:
    """Longest execution seen of one row, beside the worst case that the model claims."""

    row: str
    observed: int
    claimed: int

    @property
    def exceeded(self) -> bool:
        """What was seen is longer than the claim."""
        return self.observed > self.claimed


def executions(analysis: Analysis, seen: Observation) -> tuple[Execution, ...]:
    """The rows that ran, closest to their claim first."""
    slots = [slot for processor in analysis.system.processors for slot in processor.slots]
    rows = [
        Execution(slot.element, seen.executions[slot.element], slot.timing.wcet)
        for slot in slots
        if slot.element in seen.executions
    ]
    return tuple(sorted(rows, key=lambda row: -Fraction(row.observed, max(1, row.claimed))))


def compare(analysis: Analysis, seen: Observation) -> tuple[Comparison, ...]:
    """Each processor's longest response beside its bound, closest to the bound first."""
    bounds = {r.task.element.lower(): r.bound for r in analysis.responses}
    rows = [
        Comparison(
            name,
            p.releases,
            p.misses,
            p.worst_response,
            bounds.get(name.lower()),
            seen.host_latency or 0,
        )
        for name, p in seen.processors.items()
    ]
    return tuple(sorted(rows, key=lambda row: -row.ratio))


def render(analysis: Analysis, run: RunReport | None = None) -> str:
    """The report as HTML text."""
    environment = Environment(
        loader=PackageLoader("analysis"),
        autoescape=select_autoescape(default=True),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {
        "us": units.microseconds,
        "duration": units.duration,
        "percent": units.percent,
        "seconds": units.seconds,
    }
    return environment.get_template("report.html").render(_context(analysis, run))


def families(elements: Iterable[str]) -> dict[str, list[str]]:
    """Elements by a common name: those that differ in their last part only share one.

    ``bus.driver_rx.a`` and ``bus.driver_rx.b`` are ``bus.driver_rx.*``; what stands
    alone keeps its own name.
    """
    found: dict[str, list[str]] = {}
    for element in elements:
        head, dot, _ = element.rpartition(".")
        found.setdefault(f"{head}.*" if dot else element, []).append(element)
    return {name if len(all_) > 1 else all_[0]: all_ for name, all_ in found.items()}


def _context(analysis: Analysis, run: RunReport | None) -> Mapping[str, Any]:
    """What the template shows."""
    system = analysis.system
    picture = draw(component_view(system))
    found = chains(system)
    loads = bus_loads(system)
    return {
        "system": system,
        "analysis": analysis,
        "verdict": verdict_line(analysis),
        "good": analysis.schedulable and all(b.share <= 1 for b in loads),
        "growth": growth_line(analysis),
        "loads": loads,
        "tasks": [_task(r) for r in analysis.worst_first()],
        "objects": [(item, _names(item.users)) for item in system.objects if len(item.users) > 1],
        "private": sum(1 for item in system.objects if len(item.users) <= 1),
        "rows": {p.name: [s.element for s in p.slots] for p in system.processors},
        "graph": None if picture is None else Markup(picture),
        "chains": found[:SHOWN_CHAINS],
        "chains_left": max(0, len(found) - SHOWN_CHAINS),
        "run": run,
        "pictures": [(c, Markup(svg)) for c, svg in run.pictures] if run else [],
        "compared": compare(analysis, run.observation) if run and run.observation else (),
        "executions": executions(analysis, run.observation) if run and run.observation else (),
        "visits": _visits(run),
    }


def _task(response: Response) -> dict[str, Any]:
    """One task's row, its parts as shares of the deadline (or of R where that is longer)."""
    task, bound = response.task, response.bound
    scale = max(task.deadline, bound or 0)
    parts = (
        ("jitter", task.jitter),
        ("blocking", response.blocked),
        ("own", response.own - response.worst_job * task.period),
        ("interference", sum(share.time for share in response.interference)),
    )
    return {
        "response": response,
        "task": task,
        "shares": _shares(response),
        "word": WORDS[response.verdict],
        "met": response.verdict is Verdict.MET,
        "deadline_at": 100 * task.deadline / scale,
        "parts": [(name, 100 * time / scale) for name, time in _within(parts, bound) if time > 0],
    }


def _names(elements: Iterable[str]) -> str:
    """The names in a row, families with their number."""
    return ", ".join(
        name if len(members) == 1 else f"{name} ({len(members)})"
        for name, members in families(elements).items()
    )


def _shares(response: Response) -> list[tuple[str, str, int]]:
    """(name, how it adds up, time) for each interferer or family, most first."""
    by_name = {share.element: share for share in response.interference}
    rows = []
    for name, members in families(by_name).items():
        each = [by_name[m] for m in members]
        time = sum(share.time for share in each)
        releases = sum(share.releases for share in each)
        same = len({Fraction(share.time, share.releases) for share in each}) == 1
        sum_of = f"{releases} x {units.microseconds(time // releases)}" if same else ""
        rows.append((name, sum_of, time))
    return sorted(rows, key=lambda row: -row[2])


def _within(parts: tuple[tuple[str, int], ...], bound: int | None) -> list[tuple[str, int]]:
    """The parts of a bar that is ``bound`` long in all; empty without a bound.

    For a later job of the busy period the periods before its release are taken
    off its own time first, then off what stands before and after it.
    """
    if bound is None:
        return []
    kept: list[tuple[str, int]] = []
    debt = 0
    for name, time in sorted(parts, key=lambda part: part[1]):
        rest = max(0, time + debt)
        debt = min(0, time + debt)
        kept.append((name, rest))
    order = [name for name, _ in parts]
    return sorted(kept, key=lambda part: order.index(part[0]))


def _visits(run: RunReport | None) -> list[tuple[str, str, int]]:
    """(region, states in order of first visit, number of stays) for each region of the run."""
    if run is None or run.observation is None:
        return []
    seen = run.observation
    return [
        (region, ", ".join(states), len(seen.visits(region)))
        for region, states in seen.states_visited().items()
    ]
