# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The names of the model in a DBC whose messages, signals and values have others.

Scenarios and reports have the names of the model. The generated DBC has those of the database that
a message was imported from, and attributes with the names of the model.
"""

from __future__ import annotations

from collections import OrderedDict

from cantools.database import Database
from cantools.database.can import Signal
from cantools.database.can.formats.dbc.dbc_specifics import DbcSpecifics
from cantools.database.conversion import BaseConversion
from cantools.database.namedsignalvalue import NamedSignalValue

MESSAGE, SIGNAL, VALUES = "ModelMessage", "ModelSignal", "ModelValues"
"""The attributes of a message and of a signal: the names in the model."""


def as_in_model(database: Database) -> Database:
    """The same database, its messages and signals renamed to the names of the model."""
    for message in database.messages:
        message.name = _own(message.dbc, MESSAGE, message.name)
        names = {one.name: _own(one.dbc, SIGNAL, one.name) for one in message.signals}
        for signal in message.signals:
            _name_values(signal)
            signal.name = names[signal.name]
            if signal.multiplexer_signal is not None:
                signal.multiplexer_signal = names[signal.multiplexer_signal]
        message.refresh()
    database.refresh()
    return database


def _name_values(signal: Signal) -> None:
    """Give the values of a signal the names of the model."""
    told = _own(signal.dbc, VALUES, "")
    if told:
        pairs = (one.partition("=") for one in told.split())
        choices = OrderedDict[int, str | NamedSignalValue](
            (int(code), NamedSignalValue(int(code), name)) for code, _, name in pairs
        )
        signal.conversion = BaseConversion.factory(
            scale=signal.conversion.scale, offset=signal.conversion.offset, choices=choices
        )


def _own(specifics: DbcSpecifics | None, attribute: str, name: str) -> str:
    found = None if specifics is None else specifics.attributes.get(attribute)
    return name if found is None else str(found.value)
