"""The report: one HTML file that needs nothing else, for the screen and for paper."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape
from markupsafe import Markup

from . import units
from .graph import component_view
from .observed import Observation
from .picture import draw
from .timing import Analysis
from .words import families, growth_line, verdict_line

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
    bounds = {r.task.name.lower(): r.bound for r in analysis.responses}
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


def _context(analysis: Analysis, run: RunReport | None) -> Mapping[str, Any]:
    """What the template shows."""
    system = analysis.system
    picture = draw(component_view(system))
    found = analysis.ways.between_messages()
    return {
        "system": system,
        "analysis": analysis,
        "verdict": verdict_line(analysis),
        "good": analysis.schedulable,
        "growth": growth_line(analysis),
        "loads": [],
        "tasks": [],
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


def _names(elements: Iterable[str]) -> str:
    """The names in a row, families with their number."""
    return ", ".join(
        name if len(members) == 1 else f"{name} ({len(members)})"
        for name, members in families(elements).items()
    )


def _visits(run: RunReport | None) -> list[tuple[str, str, int]]:
    """(region, states in order of first visit, number of stays) for each region of the run."""
    if run is None or run.observation is None:
        return []
    seen = run.observation
    return [
        (region, ", ".join(states), len(seen.visits(region)))
        for region, states in seen.states_visited().items()
    ]
