# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A request of the page as a change of texts."""

from __future__ import annotations

from dataclasses import dataclass

from ravenchart.editing import edits
from ravenchart.editing.edits import Document, LayoutError
from ravenchart.editing.evaluation import Evaluation, Texts, content
from ravenchart.editing.places import ModelPlaces, NamedEntry
from ravenchart.editing.tables import moved
from ravenchart.gen.files.schema_deployment import PRIORITIES
from ravenchart.gen.language.quantities import LONGEST, parsed_duration

from .publishing import RefusedRequestError
from .requests import Move, SetProcessor, SetTime


class ChangeRefusedError(RefusedRequestError):
    """A change cannot be made; the text says why, and what to do."""


@dataclass(frozen=True, slots=True)
class Changed:
    """The files after a change, and what it was."""

    texts: Texts
    label: str


def changed(state: Evaluation, wish: Move | SetTime | SetProcessor) -> Changed:
    """The files with one change; `ChangeRefusedError` where it cannot be made in the text."""
    try:
        match wish:
            case Move():
                return _moved(state, wish)
            case SetTime():
                return _timed(state, wish)
            case SetProcessor():
                return _set_up(state, wish)
    except LayoutError as problem:
        raise ChangeRefusedError(str(problem)) from problem


def _moved(state: Evaluation, wish: Move) -> Changed:
    """A row in another table, or at another place of its own."""
    places = state.places
    found = places.row_at(wish.row)
    if found is None:
        raise ChangeRefusedError(f"no processor has the row {wish.row}")
    source, number = found
    target = _processor(places, wish.to)
    row = places.table(source)[number].element
    if source.name == target.name and number == wish.place:
        return Changed(state.texts, "")
    documents = moved(places, wish.row, target.name, wish.place)
    now = ModelPlaces({**places.documents, **documents}).row_at(wish.row)
    assert now is not None, "it was put there"
    place = now[1]
    label = f"{row}: place {number + 1} of {source.name} to {place + 1}"
    if source.name != target.name:
        label = f"{row}: {source.name} to {target.name}"
    return Changed(_with(state, documents), label)


def _timed(state: Evaluation, wish: SetTime) -> Changed:
    """A time of what a row runs."""
    row = state.places.row(wish.row)
    if row is None:
        raise ChangeRefusedError(f"the model does not declare {wish.row}")
    key = row.keys.get(wish.key)
    if key is None:
        raise ChangeRefusedError(f"the {wish.key} of {wish.row} is that of its processor")
    if wish.value is None and wish.key != "deadline":
        raise ChangeRefusedError(f"{row.owner}.{row.name} needs a {wish.key}")
    name = f"{row.owner}.{row.name}" if row.kind != "receive" else row.owner
    value = None if wish.value is None else _duration(wish.value)
    return _entry(state, row.entry, name, key, value, ("wcet", "period"))


def _set_up(state: Evaluation, wish: SetProcessor) -> Changed:
    """A period, deadline or priority of a processor."""
    processor = _processor(state.places, wish.processor)
    value = wish.value
    if wish.key == "priority":
        if value is not None and not (isinstance(value, int) and value in PRIORITIES):
            first, last = PRIORITIES[0], PRIORITIES[-1]
            raise ChangeRefusedError(f"a priority is a whole number from {first} to {last}")
        text = None if value is None else str(value)
    else:
        text = None if value is None else _duration(str(value))
    behind = ("period", "stack") if wish.key != "period" else ("stack",)
    return _entry(state, processor, processor.name, wish.key, text, behind)


def _entry(
    state: Evaluation,
    entry: NamedEntry,
    name: str,
    key: str,
    value: str | None,
    behind: tuple[str, ...],
) -> Changed:
    """A key of an entry with another value; a new one stands behind the first of ``behind``."""
    document, mapping = _document(state.places, entry.file), entry.mapping
    now = mapping.scalar(key)
    if value is None:
        made = edits.without_entry(document, mapping, key)
    elif now is not None:
        made = edits.with_value(document, now, value)
    else:
        after = next((one for one in behind if mapping.scalar(one) is not None), behind[-1])
        made = edits.with_entry(document, mapping, after, key, value)
    before, after_it = "none" if now is None else now.value, value or "none"
    return Changed(_with(state, {entry.file: made}), f"{key} of {name}: {before} to {after_it}")


def _duration(text: str) -> str:
    """A duration as it is written in the model."""
    value = parsed_duration(text.strip())
    if value is None:
        raise ChangeRefusedError(
            f"`{text}` is not a duration: write a number and ns, us, ms or s, such as `20 ms`"
        )
    if not 0 < value <= LONGEST:
        raise ChangeRefusedError(
            f"`{text}` is outside the range: a duration is at most one hour, not 0"
        )
    return text.strip()


def _processor(places: ModelPlaces, name: str) -> NamedEntry:
    found = places.processors.get(name.lower())
    if found is None:
        raise ChangeRefusedError(f"there is no processor named {name}")
    return found


def _document(places: ModelPlaces, file: str) -> Document:
    found = places.documents[file]
    assert found is not None, "an entry stands in a document"
    return found


def _with(state: Evaluation, documents: dict[str, Document]) -> Texts:
    """The files with some of them changed."""
    new = {name: content(made, state.texts[name]) for name, made in documents.items()}
    return {name: new.get(name, old) for name, old in state.texts.items()}
