# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The report: one HTML file that needs nothing else, for the screen and for paper."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from markupsafe import Markup

from ravenchart.analysis.core.responses import Response
from ravenchart.analysis.findings import advice
from ravenchart.analysis.findings.differences import Differences
from ravenchart.analysis.system.authentication import authentications
from ravenchart.analysis.system.commands import command_times
from ravenchart.analysis.system.graph import component_view
from ravenchart.analysis.system.journeys import Journey
from ravenchart.analysis.system.network import frame_length
from ravenchart.analysis.system.observed import Observation
from ravenchart.analysis.system.protection import protected
from ravenchart.analysis.system.row_responses import BINS, row_histograms
from ravenchart.analysis.system.supervision import watches
from ravenchart.analysis.system.timing import Analysis
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.buses import Bus
from ravenchart.stacks.report import Memory

from . import plots
from .bars import row_of, stream_row
from .page import page
from .picture import draw
from .rows import chain_picture, histogram_of, hop_cells, instants_of
from .sentences import (
    binding_lines,
    families,
    growth_line,
    instant_lines,
    offset_lines,
    stream_lines,
    verdict_line,
)

SHOWN_CHAINS = 40
"""Chains that the report lists at most."""

SCALED = 12
"""Tasks at most for which the report has a factor."""


@dataclass(frozen=True, slots=True)
class StepRow:
    """One step of a scenario: its text, its outcome, its time (s from the start)."""

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

    ``withheld`` is the longest time for which the host withheld the core, as far as the
    controller measured it. The analysis does not count this time.
    """

    task: str
    releases: int
    misses: int
    observed: int
    bound: int | None
    withheld: int = 0

    @property
    def explained(self) -> bool:
        """Whether the observed response is above the bound by no more than the host withheld."""
        return self.exceeded and self.observed <= (self.bound or 0) + self.withheld

    @property
    def word(self) -> str:
        """The verdict on the task: in order, late because of the host, or late."""
        if not self.misses and not self.exceeded:
            return "ok"
        if self.explained:
            return "host"
        return "MISS" if self.misses else "ABOVE"

    @property
    def exceeded(self) -> bool:
        """Whether the observed response is longer than the bound."""
        return self.bound is not None and self.observed > self.bound

    @property
    def ratio(self) -> Fraction:
        """Observed over bound; 0 without a bound."""
        return Fraction(self.observed, self.bound) if self.bound else Fraction(0)


@dataclass(frozen=True, slots=True)
class RunReport:
    """The part of a report about a run. ``pictures`` are (caption, SVG text).

    ``comparable`` is false where the controller had no real-time priorities: the
    bounds do not hold for such a run.
    """

    title: str
    passed: bool
    verdict: str
    notes: tuple[str, ...]
    steps: tuple[StepRow, ...]
    frames: tuple[FrameRow, ...]
    comparable: bool
    observation: Observation | None
    journeys: tuple[Journey, ...] = ()
    pictures: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class Execution:
    """Longest observed execution of one row, beside its WCET; ``times`` has all known ones."""

    row: str
    observed: int
    wcet: int
    times: tuple[int, ...] = ()

    @property
    def exceeded(self) -> bool:
        """Whether the observed execution is longer than the WCET."""
        return self.observed > self.wcet


def executions(analysis: Analysis, seen: Observation) -> tuple[Execution, ...]:
    """The rows that ran, closest to their WCET first."""
    rows = [
        Execution(slot.element, seen.executions[slot.element], slot.timing.wcet)
        for slot in analysis.system.slots
        if slot.element in seen.executions
    ]
    return tuple(sorted(rows, key=lambda row: -Fraction(row.observed, max(1, row.wcet))))


def _withheld(analysis: Analysis, bounds: Mapping[str, int | None], late: Ns, stolen: Ns) -> Ns:
    """The longest time for which the host may have kept the core from one response.

    A stall can begin right after a probe woke. The probe measures the rest of the stall at its
    next wake-up: up to a period less. Several stalls in one response are no longer than the
    whole stolen time. A probe within its own bound has seen none.
    """
    unseen = [
        node.probe.period
        for node in analysis.system.nodes
        if node.probe is not None and late > (bounds.get(f"{node.name}.probe".lower()) or 0)
    ]
    return Ns(max(late + max(unseen), stolen)) if unseen else late


def compare(analysis: Analysis, seen: Observation) -> tuple[Comparison, ...]:
    """Each processor's longest response beside its bound, closest to the bound first."""
    bounds = {r.task.name.lower(): r.bound for r in analysis.responses}
    withheld = _withheld(analysis, bounds, seen.host_latency or Ns(0), seen.stolen or Ns(0))
    rows = [
        Comparison(
            name,
            p.releases,
            p.misses,
            p.worst_response,
            bounds.get(name.lower()),
            withheld,
        )
        for name, p in seen.processors.items()
    ]
    return tuple(sorted(rows, key=lambda row: -row.ratio))


def render_report(
    analysis: Analysis,
    run: RunReport | None = None,
    earlier: Differences | None = None,
    programs: Mapping[str, Memory | None] | None = None,
) -> str:
    """The report as HTML text; ``earlier`` has the differences from another version.

    ``programs`` has the stacks and the memory of the program of each node, None where the
    program is not built. Without ``programs`` the report has no such section.
    """
    context = _context(analysis, run) | {"compared_with": earlier, "programs": programs}
    return page("report.html", context)


def _context(analysis: Analysis, run: RunReport | None) -> dict[str, Any]:
    """The variables of the template."""
    system = analysis.system
    picture = draw(component_view(system))
    factors = _factors(analysis)
    return {
        "system": system,
        "analysis": analysis,
        "verdict": verdict_line(analysis),
        "good": analysis.schedulable,
        "growth": growth_line(analysis),
        "binding": binding_lines(analysis),
        "advice": advice.lines(advice.of_model(analysis)),
        "tasks": [_item(analysis, n) for n in analysis.worst_first() if n in analysis.tasks]
        + [stream_row(one) for one in analysis.streams],
        "streams": stream_lines(analysis),
        "buses": [_bus(analysis, bus) for bus in system.buses],
        "commands": tuple(command_times(analysis)),
        "limited": [
            (chain.name, hop_cells(found), found, chain_picture(found))
            for chain, found in analysis.limited
        ],
        "chains": [
            (hop_cells(found), found, way)
            for found, way in zip(analysis.chains, analysis.ways.between_messages(), strict=True)
        ][:SHOWN_CHAINS],
        "chains_left": max(0, len(analysis.chains) - SHOWN_CHAINS),
        "by_offsets": offset_lines(analysis.responses),
        "instants_given": instant_lines(system),
        "factors": factors,
        "room": Markup(plots.figure_svg(plots.room(factors, _whole(analysis))))
        if factors
        else None,
        "pictured": _instants(analysis),
        "objects": [(item, _names(item.users)) for item in system.objects if len(item.users) > 1],
        "private": sum(1 for item in system.objects if len(item.users) <= 1),
        "graph": None if picture is None else Markup(picture),
        "run": run,
        "pictures": [(c, Markup(svg)) for c, svg in run.pictures] if run else [],
        "compared": compare(analysis, run.observation) if run and run.observation else (),
        "executions": executions(analysis, run.observation) if run and run.observation else (),
        "responses": row_histograms(analysis, run.observation) if run and run.observation else (),
        "bins": BINS,
        "histograms": _histograms(run),
        "visits": _visits(run),
        "watches": watches(analysis),
        "protected": protected(analysis),
        "authenticated": authentications(analysis),
        "transfers": tuple(analysis.transfers.values()),
        "modes": [m for m in analysis.system.messages if m.transmission is not None],
    }


def _item(analysis: Analysis, name: str) -> dict[str, Any]:
    """The row of a task or message, with the rows of its table."""
    row = row_of(analysis.network, analysis.found, name) | {
        "origin": analysis.origin(name),
        "plain": analysis.plain.from_event(name),
        "rows": _rows(analysis, name),
    }
    if name in analysis.tasks:
        row["longest"] = analysis.tasks[name].wcet
    return row


def _rows(analysis: Analysis, name: str) -> list[dict[str, Any]]:
    """The activities of a task inside its job: each with its own deadline."""
    task = analysis.tasks.get(name)
    response = analysis.found.responses[name]
    slots = {} if task is None else {slot.element: slot for slot in task.slots}
    rows = []
    for row in response.rows if isinstance(response, Response) else ():
        slot = slots[row.row.name]
        deadline = slot.timing.deadline
        scale = max(deadline, row.bound)
        rows.append(
            {
                "slot": slot,
                "bound": row.bound,
                "slack": deadline - row.bound,
                "width": 100 * row.bound / scale,
                "deadline_at": 100 * deadline / scale,
            }
        )
    return rows


def _bus(analysis: Analysis, bus: Bus) -> dict[str, Any]:
    """A bus and its messages, most urgent first."""
    messages = []
    for sent in analysis.frames(bus):
        message = analysis.messages[sent.frame.name]
        length = frame_length(message, bus)
        bits = length.nominal + length.data
        row = _item(analysis, sent.frame.name)
        received = [
            analysis.deliveries[one.element]
            for one in analysis.system.receptions(message)
            if one.element in analysis.deliveries
        ]
        messages.append(row | {"message": message, "bits": bits, "received": received})
    return {"bus": bus, "load": analysis.bus_load(bus), "messages": messages}


def _whole(analysis: Analysis) -> Fraction | None:
    return None if analysis.scaling is None else analysis.scaling.factor


def _factors(analysis: Analysis) -> list[tuple[str, Fraction]]:
    """The factor of each of the tightest tasks alone; a driver's work counts together."""
    tight = [name for name in analysis.worst_first() if name in analysis.tasks]
    found = []
    for name, members in list(families(tight).items())[:SCALED]:
        scaling = analysis.scaling_of(*members)
        if scaling is not None:
            found.append((name, scaling.factor))
    return sorted(found, key=lambda pair: pair[1])


def _instants(analysis: Analysis) -> list[tuple[str, int, Markup]]:
    """The critical instants of processors, of other tasks such as drivers, and of frames."""
    tight = analysis.worst_first()
    tasks = [name for name in tight if name in analysis.tasks]
    tables = [name for name in tasks if analysis.tasks[name].slots]
    drivers = list(families(name for name in tasks if not analysis.tasks[name].slots).values())
    kinds = (tables, [members[0] for members in drivers], [n for n in tight if n not in tasks])
    return [one for names in kinds for one in instants_of(analysis.found, names)]


def _histograms(run: RunReport | None) -> list[tuple[str, Markup]]:
    """How often each reaction time of the chains was observed."""
    return [
        (
            one.chain,
            histogram_of(one.times, (("bound", one.bound), ("limit", one.limit)), "reaction"),
        )
        for one in (run.journeys if run else ())
        if one.times
    ]


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
