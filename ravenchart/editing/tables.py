# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rows of processors put together anew in a model's text; what stays as it is keeps its text.

A table takes over the processor of which it has most rows, with its name, comments and keys. A
table without one becomes a processor of its own, and a processor that has lost all rows goes.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from ravenchart.allocation.proposals import WantedTable, free_name, stack_text
from ravenchart.analysis.units import duration
from ravenchart.gen.files import spans
from ravenchart.gen.files.spans import YamlScalar, plain_tree
from ravenchart.gen.model.system import Processor, System

from . import edits
from .edits import Document, LayoutError, TakenItem
from .evaluation import Evaluation, Texts, content, evaluate
from .places import ModelPlaces, NamedEntry

TIMES = ("period", "offset", "deadline")
"""The keys of a processor that a table says, in ns."""


@dataclass(slots=True)
class _Files:
    """The files of a model while they are changed."""

    documents: dict[str, Document | None]

    @property
    def places(self) -> ModelPlaces:
        return ModelPlaces(self.documents)

    def document(self, entry: NamedEntry) -> Document:
        found = self.documents[entry.file]
        assert found is not None, "an entry stands in a document"
        return found

    def processor(self, name: str) -> NamedEntry:
        return self.places.processors[name.lower()]

    def change(self, name: str, make: Callable[[Document, NamedEntry], Document]) -> None:
        """Put what is made of the document of a processor in its place."""
        entry = self.processor(name)
        self.documents[entry.file] = make(self.document(entry), entry)

    def texts(self, before: Texts) -> Texts:
        return {
            name: old if (made := self.documents[name]) is None else content(made, old)
            for name, old in before.items()
        }


def moved(places: ModelPlaces, row: str, to: str, place: int) -> dict[str, Document]:
    """The documents in which a row is in the table of that processor; both are there.

    ``place`` is counted from 0 and as in the table without the row. Where an item stands for the
    rows of all elements of an array, and one of them moves or another goes between them, each of
    them gets an item of its own.
    """
    files = _Files(dict(places.documents))
    home = places.row_at(row)
    if home is not None and home[0].name.lower() != to.lower():
        _without_phase(files, home[0].name, row)
    item = _taken(files, row, stays=edits.is_flow(files.processor(to).mapping, "activities"))
    number = _item_at(files, to, place)
    files.change(
        to, lambda now, entry: edits.with_item(now, entry.mapping, "activities", number, item)
    )
    return {
        name: made
        for name, made in files.documents.items()
        if made is not None and made is not places.documents[name]
    }


def rearranged(path: Path, state: Evaluation, tables: Sequence[WantedTable]) -> Texts:
    """The texts of the model at ``path`` with these tables.

    Priorities follow from deadlines; where those alone give another order, each is written.
    `LayoutError` where the text does not allow it; then nothing has changed.
    """
    files = _Files(dict(state.places.documents))
    rows = Counter(row.lower() for table in tables for row in table.rows)
    shared = next((row for row, count in rows.items() if count > 1), None)
    if shared is not None:
        raise LayoutError(
            f"{shared} goes to a processor of each node, and the text has it once: "
            "`ravenchart allocate --yaml` prints what to write"
        )
    homes = processors_for(files.places, tables)
    names = [home or _added(files, table) for table, home in zip(tables, homes, strict=True)]
    for table, name in zip(tables, names, strict=True):
        for place, row in enumerate(table.rows):
            found = files.places.row_at(row)
            if found is None or (found[0].name, found[1]) != (name, place):
                files.documents |= moved(files.places, row, name, place)
    _without_empty(files, names)
    for entry in list(files.places.processors.values()):
        files.change(entry.name, lambda now, one: edits.without_entry(now, one.mapping, "priority"))
    _set_values(files, _understood(path, files, state), tables, names)
    _set_reactions(files, tables, names)
    _set_priorities(files, _understood(path, files, state), tables, names)
    return files.texts(state.texts)


def processors_for(places: ModelPlaces, tables: Sequence[WantedTable]) -> list[str | None]:
    """The processor that each table takes over: of those with most of its rows, the first."""
    shared: list[tuple[int, int, str]] = []
    for number, table in enumerate(tables):
        rows = {row.lower() for row in table.rows}
        for processor in places.processors.values():
            count = sum(row.element.lower() in rows for row in places.table(processor))
            sporadic = processor.mapping.scalar("released_by") is not None
            if count and sporadic is (table.released_by is not None):
                shared.append((-count, number, processor.name))
    homes: list[str | None] = [None] * len(tables)
    for _, number, name in sorted(shared, key=lambda one: one[:2]):
        if homes[number] is None and name not in homes:
            homes[number] = name
    return homes


def _added(files: _Files, table: WantedTable) -> str:
    """A processor more, with the first row of a table; its name."""
    found = files.places.row_at(table.rows[0])
    if found is None:
        raise LayoutError(f"no processor has the row {table.rows[0]}")
    origin, _ = found
    name = free_name(table.name, files.places.processors)
    item = _taken(files, table.rows[0], stays=False)
    root = files.document(origin).root
    around = root.mapping("processors")
    assert around is not None, "a processor stands there"
    keys = {"node": table.node} if table.node else {}
    keys |= {"core": str(table.core)} if table.core > 1 else {}
    keys |= {"period": duration(table.period), "stack": stack_text(table.stack_bytes)}
    files.documents[origin.file] = edits.with_block(
        files.document(origin), around, origin.name, name, keys, "activities", item
    )
    return name


def _taken(files: _Files, row: str, *, stays: bool) -> TakenItem:
    """A row out of its table; its comment goes along unless it ``stays``."""
    found = files.places.row_at(row)
    if found is None:
        raise LayoutError(f"no processor has the row {row}")
    name, place = found[0].name, found[1]
    number = _written_out(files, name, place)
    source = files.processor(name)
    files.documents[source.file], item = edits.without_item(
        files.document(source), source.mapping, "activities", number, comment_stays=stays
    )
    return item


def _item_at(files: _Files, name: str, place: int) -> int:
    """The number of the item before which something can stand at that place of a table."""
    rows = files.places.table(files.processor(name))
    if place >= len(rows):
        return len(files.places.items(files.processor(name)))
    if place and rows[place - 1].number == rows[place].number:
        return _written_out(files, name, place)
    return rows[place].number


def _written_out(files: _Files, name: str, place: int) -> int:
    """The number of the item of a row of a table; it gets one of its own where it has none.

    The rows of an array then have an item each; a comment stays with the first of them.
    """
    rows = files.places.table(files.processor(name))
    number = rows[place].number
    others = [row.element for row in rows if row.number == number]
    if len(others) == 1:
        return number

    def first(now: Document, entry: NamedEntry) -> Document:
        return edits.with_value(now, files.places.items(entry)[number], others[0])

    def further(now: Document, entry: NamedEntry, behind: int, element: str) -> Document:
        item = TakenItem(element, element)
        return edits.with_item(now, entry.mapping, "activities", number + behind, item)

    files.change(name, first)
    for behind, element in enumerate(others[1:], 1):
        files.change(name, partial(further, behind=behind, element=element))
    return number + others.index(rows[place].element)


def _without_empty(files: _Files, kept: Sequence[str]) -> None:
    """Processors that have lost all rows go, and a section of a file with the last of them."""
    for entry in list(files.places.processors.values()):
        if entry.name in kept or files.places.table(entry):
            continue
        files.change(entry.name, _without)


def _without_phase(files: _Files, processor: str, row: str) -> None:
    """Remove the phase of a row, which is one in the table that the row leaves.

    Where an entry stands for several rows, each of the others gets one of its own.
    """
    phases = files.processor(processor).mapping.mapping("phases")
    for key, value in () if phases is None else phases.entries:
        rows = files.places.named(key.value)
        others = [one for one in rows if one.lower() != row.lower()]
        if len(others) < len(rows) and isinstance(value, YamlScalar):
            for one in reversed(others):
                files.change(processor, partial(_with_phase, key.value, one, value.value))
            files.change(processor, partial(_without_phase_of, key.value))


def _with_phase(
    behind: str, row: str, value: str, document: Document, entry: NamedEntry
) -> Document:
    return edits.with_entry(document, _phases(entry), behind, row, value)


def _without_phase_of(key: str, document: Document, entry: NamedEntry) -> Document:
    """Without an entry of `phases`, and without these where it is the only one."""
    if len(_phases(entry).entries) == 1:
        return edits.without_entry(document, entry.mapping, "phases")
    return edits.without_entry(document, _phases(entry), key)


def _phases(entry: NamedEntry) -> spans.YamlMapping:
    found = entry.mapping.mapping("phases")
    assert found is not None, "it has phases"
    return found


def _without(document: Document, entry: NamedEntry) -> Document:
    around = document.root.mapping("processors")
    assert around is not None, "a processor stands there"
    last = len(around.entries) == 1
    parent, key = (document.root, "processors") if last else (around, entry.name)
    return edits.without_block(document, parent, key)


def _understood(path: Path, files: _Files, before: Evaluation) -> System:
    """The model that the changed texts describe."""
    found = evaluate(path, files.texts(before.texts))
    if found.loaded.system is None:
        raise LayoutError(f"the tables do not fit the text: {found.found[0].message}")
    return found.loaded.system


def _set_values(
    files: _Files, system: System, tables: Sequence[WantedTable], names: Sequence[str]
) -> None:
    """Set the times and stacks of the tables, where they do not follow from the rows."""
    for table, name in zip(tables, names, strict=True):
        now = _copy(system.processors, name)
        for key in TIMES:
            wanted = getattr(table, key)
            if getattr(now, key) != wanted:
                files.change(name, partial(_with_time, key=key, value=duration(wanted)))
        if now.stack_bytes < table.stack_bytes:
            files.change(name, partial(_with_stack, value=stack_text(table.stack_bytes)))


def _set_reactions(files: _Files, tables: Sequence[WantedTable], names: Sequence[str]) -> None:
    """A table raises what the processors raised that its rows come from."""
    for table, name in zip(tables, names, strict=True):
        for key, events in table.raises.items():
            found = files.processor(name).mapping.get(key)
            written = [] if found is None else [str(one) for one in plain_tree(found)]
            known = {one.lower() for text in written for one in files.places.named(text)}
            for event in (one for one in events if one.lower() not in known):
                files.change(name, partial(_with_event, key=key, event=event))


def _with_event(document: Document, entry: NamedEntry, key: str, event: str) -> Document:
    found = entry.mapping.get(key)
    if isinstance(found, spans.Sequence) and found.items:
        item = TakenItem(event, event)
        return edits.with_item(document, entry.mapping, key, len(found.items), item)
    if found is not None:
        raise LayoutError(f"`{key}` is not a list with events: edit the file")
    return edits.with_entry(document, entry.mapping, _behind(entry), key, f"[{event}]", [event])


def _set_priorities(
    files: _Files, system: System, tables: Sequence[WantedTable], names: Sequence[str]
) -> None:
    """The priorities, where the deadlines alone give others."""
    wanted = {name: table.priority for table, name in zip(tables, names, strict=True)}
    if all(_copy(system.processors, n).priority == level for n, level in wanted.items()):
        return
    for name, level in wanted.items():
        files.change(name, partial(_with_key, key="priority", value=str(level)))


def copies_on_nodes(processors: Sequence[Processor], name: str) -> list[Processor]:
    """The copies of a processor that stands once in the text and is on several nodes."""
    return [one for one in processors if one.name.lower() == f"{name}_{one.node}".lower()]


def _copy(processors: Sequence[Processor], name: str) -> Processor:
    """The processor of that name, or the first of its copies on several nodes."""
    own = (one for one in processors if one.name == name)
    return next(own, None) or copies_on_nodes(processors, name)[0]


def _with_time(document: Document, entry: NamedEntry, key: str, value: str) -> Document:
    now = entry.mapping.scalar(key)
    if now is not None:
        return edits.with_value(document, now, value)
    return _with_key(document, entry, key, value)


def _with_stack(document: Document, entry: NamedEntry, value: str) -> Document:
    now = entry.mapping.scalar("stack")
    return document if now is None else edits.with_value(document, now, value)


def _with_key(document: Document, entry: NamedEntry, key: str, value: str) -> Document:
    return edits.with_entry(document, entry.mapping, _behind(entry), key, value)


def _behind(entry: NamedEntry) -> str:
    """The key of a processor behind which a new one stands."""
    return "period" if entry.mapping.scalar("period") is not None else "stack"
