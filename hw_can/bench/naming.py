"""The names of the model in a DBC whose messages and signals have others.

Scenarios and reports have the names of the model. The generated DBC has those of the database that
a message was imported from, and attributes that say what the model calls it.
"""

from __future__ import annotations

from cantools.database import Database
from cantools.database.can.formats.dbc.dbc_specifics import DbcSpecifics

MESSAGE, SIGNAL = "ModelMessage", "ModelSignal"
"""The attributes of a message and of a signal: the name in the model."""


def as_in_model(database: Database) -> Database:
    """The same database, its messages and signals renamed to what the model calls them."""
    for message in database.messages:
        message.name = _own(message.dbc, MESSAGE, message.name)
        names = {one.name: _own(one.dbc, SIGNAL, one.name) for one in message.signals}
        for signal in message.signals:
            signal.name = names[signal.name]
            if signal.multiplexer_signal is not None:
                signal.multiplexer_signal = names[signal.multiplexer_signal]
        message.refresh()
    database.refresh()
    return database


def _own(specifics: DbcSpecifics | None, attribute: str, name: str) -> str:
    found = None if specifics is None else specifics.attributes.get(attribute)
    return name if found is None else str(found.value)
