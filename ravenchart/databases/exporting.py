# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart export-dbc`: the database of a bus, with the parts that a model has no words for.

A message that is still as it was imported is written as the database had it: names, comments,
attributes, scales, multiplexors. The other ones are written as the model has them.
"""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass, field
from pathlib import Path

import cantools
from cantools.database import Database
from cantools.database.can import Message as DbcMessage
from cantools.database.can.formats.dbc.dbc_specifics import DbcSpecifics

from ravenchart.gen.emit.buses.dbc import emit_dbc
from ravenchart.gen.model.buses import Bus, Message
from ravenchart.gen.model.system import System

from .database import read_database
from .fields import fields_of, raw_fields
from .names import Names

MILLISECOND = 1_000_000
"""In nanoseconds."""


@dataclass(slots=True)
class Exported:
    """A database, and what of the original one is not in it."""

    text: str
    notes: list[str] = field(default_factory=list)


def exported(system: System, bus: Bus, original: Path | None, *, lenient: bool = False) -> Exported:
    """The database of a bus. ``original`` is what its messages were imported from.

    Refused when ``original`` cannot be read.
    """
    own = emit_dbc(system, bus)
    if original is None:
        return Exported(own)
    first = read_database(original, lenient=lenient)
    made = cantools.database.load_string(own, "dbc", strict=False)
    assert isinstance(made, Database)
    names = dict(zip(first.messages, Names.of_each([m.name for m in first.messages]), strict=True))
    found = Exported("")
    messages: list[DbcMessage] = []
    kept: set[DbcMessage] = set()
    own_names: set[str] = set()
    for message in (m for m in system.frames if m.bus == bus.name):
        like = _original(message, names)
        if like is not None and _as_imported(message, like):
            kept.add(like)
            if (message.longest or 0) != (like.cycle_time or 0) * MILLISECOND:
                like.cycle_time = (message.longest or 0) // MILLISECOND
            messages.append(like)
            continue
        if message.is_foreign:
            found.notes.append(f"{message.name} is left out: others send it to others")
            continue
        messages.append(made.get_message_by_name(message.in_database))
        own_names.add(message.name)
        why = "has another layout or identifier" if message.name in names.values() else "is not"
        found.notes.append(f"{message.name} is as in the model: it {why} in {original.name}")
    found.notes += [
        f"{m.name} of {original.name} is not in the model"
        for m, name in names.items()
        if m not in kept and name not in own_names
    ]
    nodes = list(first.nodes)
    nodes += [node for node in made.nodes if node.name not in {one.name for one in first.nodes}]
    database = Database(
        messages=messages,
        nodes=nodes,
        buses=first.buses,
        version=first.version or "",
        dbc_specifics=_specifics(first, made),
        strict=False,
    )
    text = str(database.as_dbc_string(sort_signals=None))
    found.text = text.replace("\r\n", "\n").rstrip("\n") + "\n"
    return found


def _original(message: Message, names: dict[DbcMessage, str]) -> DbcMessage | None:
    """The message of the database with that identifier; of several the one of that name."""
    alike = [
        one for one in names
        if (one.frame_id, one.is_extended_frame) == (message.identifier, message.extended)
    ]  # fmt: skip
    return next((one for one in alike if names[one] == message.name), next(iter(alike), None))


def _as_imported(message: Message, like: DbcMessage) -> bool:
    """Has the model the fields that `import` makes of it, bit by bit?"""
    if not message.signals:
        return not message.source and message.length >= like.length
    sends = message.source is not None
    fields = fields_of(like, taken=frozenset(), sends=sends).fields or raw_fields(like)
    expected = {(one.bits, one.pages) for one in fields}
    return expected == {(one.bits(), frozenset(one.pages)) for one in message.signals}


def _specifics(first: Database, made: Database) -> DbcSpecifics:
    """The attributes of the original, and those that the model's messages need."""
    found = DbcSpecifics() if first.dbc is None else deepcopy(first.dbc)
    if made.dbc is not None:
        for name, attribute in made.dbc.attributes.items():
            found.attributes.setdefault(name, attribute)
        for name, definition in made.dbc.attribute_definitions.items():
            found.attribute_definitions.setdefault(name, definition)
    return found
