"""The CAN database (DBC) of a bus, written by cantools from the same layout as the codecs."""

from __future__ import annotations

from collections import OrderedDict

from cantools.database import Database
from cantools.database.can import Message as DbcMessage
from cantools.database.can import Node
from cantools.database.can import Signal as DbcSignal
from cantools.database.conversion import BaseConversion
from cantools.database.namedsignalvalue import NamedSignalValue

from ..model import Bus, Message, Signal, System
from ..terms import EnumerationType, IntegerType

OUTSIDE = "Outside"
"""The sender of what comes from beyond the system."""


def emit_dbc(system: System, bus: Bus) -> str:
    """The text of the bus's database."""
    messages = [_message(system, m) for m in system.messages if m.bus == bus.name]
    nodes = [Node(name=n.name, comment=None) for n in system.nodes]
    nodes.append(Node(name=OUTSIDE, comment=None))
    database = Database(messages=messages, nodes=nodes, version="")
    text = str(database.as_dbc_string(sort_signals=None))
    return text.replace("\r\n", "\n").rstrip("\n") + "\n"


def _message(system: System, message: Message) -> DbcMessage:
    node = system.nodes[0].name
    sender = node if message.source is not None else OUTSIDE
    receiver = node if message.targets else OUTSIDE
    return DbcMessage(
        frame_id=message.identifier,
        name=message.name,
        length=message.length,
        signals=[_signal(s, receiver) for s in message.signals],
        senders=[sender],
        cycle_time=message.period // 1_000_000,
        is_extended_frame=message.extended,
        sort_signals=None,
    )


def _signal(signal: Signal, receiver: str) -> DbcSignal:
    choices: OrderedDict[int, str | NamedSignalValue] | None = None
    unit = None
    low, high = 0, (1 << signal.width) - 1
    if isinstance(signal.type, EnumerationType):
        choices = OrderedDict[int, str | NamedSignalValue](enumerate(signal.type.literals))
        high = len(signal.type.literals) - 1
    elif isinstance(signal.type, IntegerType):
        unit, low, high = signal.type.unit, signal.type.first, signal.type.last
    conversion = BaseConversion.factory(scale=1, offset=signal.offset, choices=choices)
    return DbcSignal(
        name=signal.field or "value",
        start=signal.start,
        length=signal.width,
        byte_order="little_endian",
        is_signed=False,
        conversion=conversion,
        minimum=low,
        maximum=high,
        unit=unit,
        receivers=[receiver],
    )
