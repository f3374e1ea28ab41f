# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The CAN database (DBC) of a bus, written by cantools from the same layout as the codecs.

Physical values are what the model's values count: a value of a type in `0.1 degC` is
a tenth of its number.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Sequence
from decimal import Decimal

from cantools.database import Database
from cantools.database.can import Message as DbcMessage
from cantools.database.can import Node
from cantools.database.can import Signal as DbcSignal
from cantools.database.can.formats.dbc.dbc_attribute import DbcAttribute
from cantools.database.can.formats.dbc.dbc_attribute_definition import DbcAttributeDefinition
from cantools.database.can.formats.dbc.dbc_specifics import DbcSpecifics
from cantools.database.conversion import BaseConversion
from cantools.database.namedsignalvalue import NamedSignalValue

from ravenchart.gen.language.terms import EnumerationType, IntegerType
from ravenchart.gen.language.units import count_of
from ravenchart.gen.model.authentication import Authentication
from ravenchart.gen.model.buses import Bus, Message
from ravenchart.gen.model.instances import End
from ravenchart.gen.model.protection import Protection
from ravenchart.gen.model.signals import ByteOrder, Signal, range_of
from ravenchart.gen.model.system import System

OUTSIDE = "Outside"
"""The sender of what comes from beyond the system."""


def emit_dbc(system: System, bus: Bus) -> str:
    """The text of the bus's database."""
    own = [m for m in system.messages if m.bus == bus.name]
    messages = [_message(system, m) for m in own]
    nodes = [Node(name=n.in_database, comment=None) for n in system.nodes]
    nodes.append(Node(name=OUTSIDE, comment=None))
    specifics = _specifics(bus, own)
    database = Database(messages=messages, nodes=nodes, version="", dbc_specifics=specifics)
    text = str(database.as_dbc_string(sort_signals=None))
    return text.replace("\r\n", "\n").rstrip("\n") + "\n"


PROFILE = DbcAttributeDefinition[str]("E2EProfile", "", "BO_", "STRING")
DATA_IDS = DbcAttributeDefinition[str]("E2EDataIDs", "", "BO_", "STRING")
"""Of a protected message: its profile, and its data identifiers as hexadecimal numbers."""

KEY = DbcAttributeDefinition[str]("SecOCKey", "", "BO_", "STRING")
DATA_ID = DbcAttributeDefinition[str]("SecOCDataID", "", "BO_", "STRING")
"""Of an authenticated message: the name of its key, and its data identifier in hexadecimal."""


MODEL_MESSAGE = DbcAttributeDefinition[str]("ModelMessage", "", "BO_", "STRING")
MODEL_SIGNAL = DbcAttributeDefinition[str]("ModelSignal", "", "SG_", "STRING")
"""Of a message and a signal with a `database_name`: what the model calls it."""
MODEL_VALUES = DbcAttributeDefinition[str]("ModelValues", "", "SG_", "STRING")
"""Of a signal with `value_names`: each raw value with what the model calls it, `0=Off 1=On`."""


def _specifics(bus: Bus, messages: Sequence[Message]) -> DbcSpecifics | None:
    """The attributes that the messages need."""
    made = _flexible(bus) if any(m.fd for m in messages) else None
    if any(m.protection for m in messages):
        made = made or DbcSpecifics()
        made.attribute_definitions.update({one.name: one for one in (PROFILE, DATA_IDS)})
    if any(m.authentication for m in messages):
        made = made or DbcSpecifics()
        made.attribute_definitions.update({one.name: one for one in (KEY, DATA_ID)})
    if any(m.database_name or any(s.database_name for s in m.signals) for m in messages):
        made = made or DbcSpecifics()
        renamed = (MODEL_MESSAGE, MODEL_SIGNAL)
        made.attribute_definitions.update({one.name: one for one in renamed})
    if any(s.value_names for m in messages for s in m.signals):
        made = made or DbcSpecifics()
        made.attribute_definitions[MODEL_VALUES.name] = MODEL_VALUES
    return made


Attributes = list[tuple[DbcAttributeDefinition[str], str]]
"""Attributes with their values."""


def _attributes(message: Message) -> Attributes:
    """Those of a message that is protected, authenticated, or has another name in the model."""
    found: Attributes = []
    match message.check:
        case Protection() as own:
            ids = " ".join(f"{one:X}" for one in own.data_ids or (own.data_id,))
            found += [(PROFILE, str(own.name)), (DATA_IDS, ids)]
        case Authentication() as own:
            found += [(KEY, own.key), (DATA_ID, f"{own.data_id:X}")]
        case None:
            pass
    return found + _renamed(message, MODEL_MESSAGE)


def _renamed(one: Message | Signal, kind: DbcAttributeDefinition[str]) -> Attributes:
    return [] if one.database_name is None else [(kind, one.name)]


def _valued(signal: Signal) -> Attributes:
    if not signal.value_names:
        return []
    named = (f"{code}={name}" for name, code in signal.named_codes.items())
    return [(MODEL_VALUES, " ".join(named))]


def _with(attributes: Attributes) -> DbcSpecifics | None:
    found = ((kind.name, DbcAttribute(value, kind)) for kind, value in attributes)
    return DbcSpecifics(attributes=OrderedDict(found)) if attributes else None


def _flexible(bus: Bus) -> DbcSpecifics:
    """The attributes of a CAN FD database: with these cantools gives the format of each frame."""
    kind = DbcAttributeDefinition[str]("BusType", "CAN", None, "STRING")
    switched = "0" if bus.data_rate is None else "1"
    switch = DbcAttributeDefinition[str]("CANFD_BRS", switched, "BO_", "ENUM", choices=["0", "1"])
    return DbcSpecifics(
        attributes=OrderedDict({"BusType": DbcAttribute("CAN FD", kind)}),
        attribute_definitions=OrderedDict({"BusType": kind, "CANFD_BRS": switch}),
    )


def _message(system: System, message: Message) -> DbcMessage:
    receivers = list(dict.fromkeys(_node(system, end) for end in message.targets)) or [OUTSIDE]
    #  no signal of a value stands in its segments
    signals = () if message.transport else message.signals
    selector = next((s for s in signals if s.selects), None)
    return DbcMessage(
        frame_id=message.identifier,
        name=message.in_database,
        length=message.length,
        signals=[
            *(_signal(s, selector, receivers) for s in signals),
            *(_header(message, receivers)),
            *(_trailer(message, receivers)),
        ],
        senders=[OUTSIDE if message.source is None else _node(system, message.source)],
        cycle_time=_cycle_time(system, message),
        is_extended_frame=message.extended,
        is_fd=message.fd,
        dbc_specifics=_with(_attributes(message)),
        sort_signals=None,
    )


def _cycle_time(system: System, message: Message) -> int | None:
    """In ms; None where nothing bounds the time to the next frame."""
    longest, source = message.longest, message.source
    if source is not None and message.transmission is None:
        component = system.instance(source.instance).component
        if any(source.name in activity.may_send for activity in component.activities):
            return None
    return None if longest is None else longest // 1_000_000


def _node(system: System, end: End) -> str:
    name = system.instance(end.instance).node
    return next(node.in_database for node in system.nodes if node.name == name)


def _header(message: Message, receivers: list[str]) -> list[DbcSignal]:
    """The fields of the protection."""
    fields = () if message.protection is None else message.protection.profile.fields
    return [
        DbcSignal(
            name=field.name,
            start=field.start,
            length=field.width,
            minimum=0,
            maximum=(1 << field.width) - 1,
            receivers=receivers,
        )
        for field in fields
    ]


def _trailer(message: Message, receivers: list[str]) -> list[DbcSignal]:
    """The fields of the authentication, the highest byte first."""
    own = message.authentication
    fields = () if own is None else own.fields(message.length)
    return [
        DbcSignal(
            name=field.name,
            start=8 * field.byte + 7,
            length=8 * field.size,
            byte_order="big_endian",
            minimum=0,
            maximum=(1 << 8 * field.size) - 1,
            receivers=receivers,
        )
        for field in fields
    ]


def _signal(signal: Signal, selector: Signal | None, receivers: list[str]) -> DbcSignal:
    choices: OrderedDict[int, str | NamedSignalValue] | None = None
    low, high = signal.raw_range
    scale, unit = Decimal(1), None
    if isinstance(signal.type, EnumerationType):
        pairs = ((code, name) for name, code in signal.codes_in_database.items())
        choices = OrderedDict[int, str | NamedSignalValue](pairs)
        if signal.other is not None:
            low, high = range_of(signal.width, signed=signal.signed)
    elif isinstance(signal.type, IntegerType):
        scale, unit = count_of(signal.type.unit)
        low, high = signal.type.first, signal.type.last
    conversion = BaseConversion.factory(
        scale=_plain(scale), offset=_plain(signal.offset * scale), choices=choices
    )
    is_paged = bool(signal.pages) and selector is not None
    return DbcSignal(
        name=signal.in_database,
        start=signal.start,
        length=signal.width,
        byte_order="little_endian" if signal.order is ByteOrder.INTEL else "big_endian",
        is_signed=signal.signed,
        conversion=conversion,
        minimum=_plain(low * scale),
        maximum=_plain(high * scale),
        unit=unit,
        receivers=receivers,
        is_multiplexer=signal.selects,
        multiplexer_ids=list(signal.pages) if is_paged else None,
        multiplexer_signal=selector.in_database if is_paged and selector is not None else None,
        dbc_specifics=_with([*_renamed(signal, MODEL_SIGNAL), *_valued(signal)]),
    )


def _plain(value: Decimal | int) -> int | float:
    """A number as cantools takes it: whole ones stay exact."""
    return int(value) if value == int(value) else float(value)
