# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The state of a session as the page gets it: one JSON object, complete each time.

Times are in ns beside a text for people. Declarations come from the text of the files, so they
are there also while the model has errors. The figures are then those of the last good state.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

from ravenchart import rounded
from ravenchart.analysis.present.bars import row_of, stream_row
from ravenchart.analysis.present.sentences import lines_of_stream, overload_lines, verdict_line
from ravenchart.analysis.system.latencies import Latency
from ravenchart.analysis.system.timing import Analysis
from ravenchart.analysis.units import TENTH, microseconds
from ravenchart.building import drawings
from ravenchart.editing.evaluation import Evaluation, document
from ravenchart.editing.places import TIMES, DeclaredRow, ItemRow, ModelPlaces, NamedEntry
from ravenchart.editing.tables import copies_on_nodes
from ravenchart.gen.files.spans import YamlScalar
from ravenchart.gen.language.quantities import shown
from ravenchart.gen.model.system import Chain
from ravenchart.gen.origins import Origin
from ravenchart.reported import found_of

from . import pictures
from .session import Session

Json = dict[str, Any]


def whole_view(session: Session) -> Json:
    """All that the page shows."""
    now, good, saved = session.now, session.good.analysis, session.saved.analysis
    assert good is not None, "a session begins with a model without errors"
    assert saved is not None
    where = _Where(now)
    return {
        "number": session.number,
        "model": str(session.path),
        "system": good.system.name,
        "files": list(now.texts),
        "dirty": session.dirty,
        "undo": session.undo_label,
        "redo": session.redo_label,
        "outside": list(session.outside),
        "stale": now.analysis is None,
        "met": now.analysis is not None and good.schedulable,
        "verdict": verdict_line(good) if now.analysis is not None else "The model has errors.",
        "saved_verdict": verdict_line(saved),
        "overloads": list(overload_lines(good.loads)),
        "findings": [asdict(found_of(one)) for one in now.found],
        "loads": _loads(good, saved),
        "components": list(_components(where)),
        "processors": list(_processors(where, good, saved)),
        "streams": list(_streams(good, saved)),
        "messages": list(_messages(good, saved)),
        "chains": list(_chains(good, saved)),
        "drawings": list(drawings.names(good.system)),
    }


def _place(origin: Origin) -> Json:
    return {"file": origin.file, "line": origin.line, "column": origin.column}


class _Where:
    """The places of a state, with the line of each."""

    def __init__(self, now: Evaluation) -> None:
        self.places: ModelPlaces = now.places
        self.allocated: dict[str, str] = {}
        for processor in self.places.processors.values():
            for row in self.places.table(processor):
                self.allocated.setdefault(row.element.lower(), processor.name)

    def at(self, file: str, scalar: YamlScalar) -> Json:
        """The location of a scalar."""
        found = self.places.documents[file]
        before = "" if found is None else found.text[: scalar.start]
        line_start = max(before.rfind("\n"), before.rfind("\r")) + 1
        lines = before.count("\n") or before.count("\r")
        return {"file": file, "line": lines + 1, "column": len(before) - line_start + 1}


# --- Components ------------------------------------------------------------------------


def _components(where: _Where) -> Iterator[Json]:
    """The components with their rows, and where each instance runs them."""
    for component in where.places.components.values():
        instances = where.places.instances_of(component)
        yield {
            "name": component.name,
            **where.at(component.file, component.key),
            "instances": instances,
            "rows": [
                {
                    **_declared(where, row),
                    "runs": [
                        {
                            "row": f"{instance}.{row.name}",
                            "on": where.allocated.get(f"{instance}.{row.name}".lower()),
                        }
                        for instance in instances
                    ],
                }
                for row in where.places.rows(component)
            ],
        }


def _declared(where: _Where, row: DeclaredRow) -> Json:
    """The declaration of a row: its kind and its times, as they are written."""
    return {
        "name": row.name,
        "owner": row.owner,
        "kind": row.kind,
        **where.at(row.entry.file, row.entry.key),
        "times": {time: row.text(time) for time in TIMES},
        "settable": list(row.keys),
    }


# --- Processors ------------------------------------------------------------------------


def _processors(where: _Where, good: Analysis, saved: Analysis) -> Iterator[Json]:
    """The processors in the order of the model, each with its table.

    One of a bus that several nodes join has a task on each of them: its ``copies``.
    """
    by_name = {one.name.lower(): one for one in good.system.processors}
    responses = {row.row.name.lower(): row.bound for _, row in good.rows()}
    slots = {slot.element.lower(): slot.timing for slot in good.system.slots}
    for entry in where.places.processors.values():
        own = by_name.get(entry.name.lower())
        copies = [] if own is not None else copies_on_nodes(good.system.processors, entry.name)
        one = next(iter(copies), own)
        levels = {copy.priority for copy in copies}
        yield {
            "name": entry.name,
            **where.at(entry.file, entry.key),
            "node": _written(entry, "node") if own is None else own.node,
            "released_by": _written(entry, "released_by"),
            "core": None if own is None else own.core,
            "written": {key: _written(entry, key) for key in ("period", "deadline", "priority")},
            "period": None if one is None else shown(one.period),
            "deadline": None if one is None else shown(one.deadline),
            "priority": None if one is None or len(levels) > 1 else one.priority,
            **(_response(good, saved, own.name) if own is not None else {"bound": None}),
            "copies": [
                {"node": copy.node, "priority": copy.priority, **_response(good, saved, copy.name)}
                for copy in copies
            ],
            "rows": [
                _row(where, entry, one, responses, slots) for one in where.places.table(entry)
            ],
        }


def _written(entry: NamedEntry, key: str) -> str | None:
    found = entry.mapping.scalar(key)
    return None if found is None else found.value


def _row(
    where: _Where,
    entry: NamedEntry,
    one: ItemRow,
    responses: dict[str, int],
    slots: dict[str, Any],
) -> Json:
    """A row of a table: its times as written, or as they follow, and its response."""
    row, timing = where.places.row(one.element), slots.get(one.element.lower())
    declared: Json = {"kind": None, "times": {}, "settable": []}
    if row is not None:
        declared = _declared(where, row)
    follows = {} if timing is None else {t: shown(getattr(timing, t)) for t in TIMES}
    return {
        "row": one.element,
        "kind": declared["kind"],
        "owner": declared.get("owner"),
        "times": {time: declared["times"].get(time) or follows.get(time) for time in TIMES},
        "written": declared["times"],
        "settable": declared["settable"],
        "response": responses.get(one.element.lower()),
        "declared": {key: declared.get(key) for key in ("file", "line", "column")},
        **where.at(entry.file, one.item),
    }


def _response(good: Analysis, saved: Analysis, name: str) -> Json:
    """The response of a task or message against its deadline, and what it was when saved."""
    row = row_of(good.network, good.found, name)
    before = saved.found.from_event(name) if name in saved.found.responses else None
    task = good.tasks.get(name)
    return _beside(row, row["longest"] if task is None else task.wcet, before)


def _streams(good: Analysis, saved: Analysis) -> Iterator[Json]:
    """The streams to monitors, which nothing on the page changes."""
    before = {one.name: one.bound for one in saved.streams}
    for one in good.streams:
        yield {
            "name": one.name,
            **_place(one.origin),
            "core": one.response.task.core,
            "said": list(lines_of_stream(one)),
            **_beside(stream_row(one), one.response.task.wcet, before.get(one.name)),
        }


def _beside(row: Json, wcet: int, before: int | None) -> Json:
    """A row of the report as the page gets it, and the bound ``before`` of the saved model."""
    return {
        "bound": row["bound"],
        "bound_text": _us(row["bound"]),
        "limit": row["deadline"],
        "limit_text": microseconds(row["deadline"]),
        "slack_text": None if row["slack"] is None else microseconds(row["slack"] // TENTH * TENTH),
        "wcet_text": microseconds(wcet),
        "word": row["word"],
        "met": row["met"],
        "reason": row["reason"],
        "bar": [{"kind": kind, "share": round(share, 3)} for kind, share in row["bar"]],
        "deadline_at": round(row["deadline_at"], 3),
        "saved": before,
        "saved_text": _us(before),
        "saved_at": None if before is None else _share(before, row["bound"], row["deadline"]),
    }


def _share(time: int, bound: int | None, deadline: int) -> float:
    """Where a time is on the bar of a response."""
    return round(min(100.0, 100 * time / max(deadline, bound or 0)), 3)


def _us(ns: int | None) -> str | None:
    return None if ns is None else microseconds(ns)


# --- Buses, loads, chains --------------------------------------------------------------


def _messages(good: Analysis, saved: Analysis) -> Iterator[Json]:
    """The frames of each bus, most urgent first."""
    for bus in good.system.buses:
        for response in good.frames(bus):
            message = good.messages[response.frame.name]
            yield {
                "name": message.name,
                "bus": bus.name,
                "identifier": message.shown_identifier,
                "period": shown(message.period),
                **_place(message.origin),
                **_response(good, saved, response.frame.name),
            }


def _loads(good: Analysis, saved: Analysis) -> list[Json]:
    """The load of each core and bus, now and when saved."""
    buses = {bus.name for bus in good.system.buses}
    return [
        {
            "name": name,
            "kind": "bus" if name in buses else "core",
            "share": min(100.0, round(float(100 * load), 2)),
            "text": rounded.percent(load),
            "over": load > 1,
            "saved_text": rounded.percent(saved.loads[name]) if name in saved.loads else None,
        }
        for name, load in good.loads.items()
    ]


def _chains(good: Analysis, saved: Analysis) -> Iterator[Json]:
    """The chains with limits, now and when saved."""
    before = {chain.name: found for chain, found in saved.limited}
    for chain, found in good.limited:
        yield {
            "name": chain.name,
            **_place(chain.origin),
            "met": found.met,
            "limits": list(_limits(chain, found, before.get(chain.name))),
        }


def _limits(chain: Chain, found: Latency, before: Latency | None) -> Iterator[Json]:
    """The bound of a chain's reaction or age beside its limit."""
    for what in ("reaction", "age"):
        limit, bound = getattr(chain, what), getattr(found, what)
        if limit is not None:
            was = None if before is None else getattr(before, what)
            yield {
                "what": what,
                "bound": bound,
                "bound_text": _us(bound),
                "limit": limit,
                "limit_text": microseconds(limit),
                "met": bound is not None and bound <= limit,
                "saved": was,
                "saved_text": _us(was),
            }


# --- Sources and drawings --------------------------------------------------------------


def source_text(session: Session, file: str) -> Json | None:
    """The text of a file of the model as it is now; None of any other file."""
    content = session.now.texts.get(file)
    if content is None:
        return None
    made = document(content)
    text = content.decode("utf-8", "replace") if made is None else made.text
    return {"file": file, "lines": text.splitlines()}


def located(session: Session, name: str) -> list[Json]:
    """Where what a drawing shows stands."""
    analysis = session.good.analysis
    assert analysis is not None
    found = pictures.locations(analysis.system, name)
    return [{"title": title, "text": text, **_place(at)} for title, text, at in found]
