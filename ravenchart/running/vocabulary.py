# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The words of a model's buses: the messages, their fields and values, by the model's names.

With them are the charts, whose states snapshots show. Scenarios, the shell and `RemoteSystem` look
their words up here. The messages are those of the CAN databases, which the bench uses, too.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches

import cantools
from cantools.database.can import Message as DbcMessage
from cantools.database.can import Signal as DbcSignal

from ravenchart.gen.emit.buses.dbc import emit_dbc
from ravenchart.gen.model.buses import Bus
from ravenchart.gen.model.system import System
from ravenchart.hw_can.bench.naming import as_in_model
from ravenchart.hw_can.bench.peer import OUTSIDE, Codec, Value
from ravenchart.hw_can.bench.protection import HEADER
from ravenchart.hw_can.bench.several import codec_of

from .chart_names import NamedChart, charts_of

TRUTH = {"False", "True"}
"""The names of the values of a Boolean: none of them is a command."""


class WordError(ValueError):
    """A name or a value that the bus does not have; the text has a hint behind it."""

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(f"{message}\n  hint: {hint}" if hint else message)


@dataclass(frozen=True, slots=True)
class BusVocabulary:
    """The messages of the buses of a system, or of some of them."""

    system: System
    buses: tuple[Bus, ...]
    messages: Mapping[str, DbcMessage]
    codec: Codec
    partial: frozenset[tuple[str, str]]
    """Fields, by message, that have values without a name; these are numbers."""
    commands: Mapping[str, tuple[str, str]] = field(default_factory=dict)
    """Literals that are commands: each is a value of one field, of one message from outside."""
    charts: Mapping[str, NamedChart] = field(default_factory=dict)
    """The charts of all instances, by `instance.Region`."""

    @staticmethod
    def of(system: System, buses: Sequence[Bus] = ()) -> BusVocabulary:
        """That of these buses of a system; of all without them."""
        buses = tuple(buses) or system.buses
        messages: dict[str, DbcMessage] = {}
        codecs: dict[str, Codec] = {}
        for bus in buses:
            database = cantools.database.load_string(emit_dbc(system, bus), "dbc")
            assert isinstance(database, cantools.database.Database)
            database = as_in_model(database)
            codecs[bus.name] = Codec(database)
            messages |= {message.name: message for message in database.messages}
        partial = {(m.name, s.name) for m in system.messages for s in m.signals if s.other}
        commands = dict(_commands(messages.values()))
        codec, charts = codec_of(codecs), charts_of(system)
        return BusVocabulary(system, buses, messages, codec, frozenset(partial), commands, charts)

    @property
    def where(self) -> str:
        """The buses in words."""
        return " and ".join(bus.name for bus in self.buses)

    def outside(self) -> list[str]:
        """The messages that no node of the model sends."""
        return [name for name, one in self.messages.items() if one.senders == [OUTSIDE]]

    def fields(self, message: str) -> dict[str, DbcSignal]:
        """The fields of a message that its sender gives: not the header of its protection."""
        signals = self.messages[message].signals
        return {one.name: one for one in signals if one.name not in HEADER}

    def observable(self) -> list[str]:
        """Every field that a frame can be waited for by, `message.field`."""
        return [f"{name}.{one}" for name in self.messages for one in self.fields(name)]

    def order(self, name: str, fields: Mapping[str, Value]) -> tuple[str, dict[str, Value]]:
        """The message that a name and fields stand for, and its fields; WordError.

        The name is that of a message from outside, or a command: then the field that has the
        command is given with it.
        """
        message, given = name, dict(fields)
        if name in self.commands:
            message, carrier = self.commands[name]
            if carrier in given:
                raise WordError(f"`{carrier}` is `{name}` already", f"leave `{carrier}` out")
            given = {carrier: name, **given}
        outside = self.outside()
        if message not in outside:
            known = [*self.commands, *outside]
            if message in self.messages:
                told = f"`{message}` is sent by the controller itself"
                raise WordError(told, f"to send: {', '.join(known)}" if known else "")
            raise WordError(f"there is no command or message `{name}`", hint_of(name, known))
        known_fields = self.fields(message)
        if not known_fields:
            told = f"`{message}` travels in several frames (ISO 15765-2), which cannot be sent here"
            raise WordError(told)
        for one, value in given.items():
            if one not in known_fields:
                told = f"`{message}` has no field `{one}`"
                raise WordError(told, hint_of(one, [*known_fields]))
            misfit = self.misfit(message, known_fields[one], value)
            if misfit is not None:
                raise WordError(misfit)
        return message, given

    def missing(self, message: str, given: Mapping[str, Value]) -> list[str]:
        """The fields that are not given. None of a message with pages, whose fields depend."""
        if self.messages[message].is_multiplexed():
            return []
        return [one for one in self.fields(message) if one not in given]

    def signal(self, text: str, *, or_chart: bool = False) -> tuple[str, DbcSignal]:
        """The message and the field of `message.field`, or of a field of one message; WordError.

        Where it may also be a chart, the error says so.
        """
        message, dot, name = text.partition(".")
        if dot and message in self.messages and name in self.fields(message):
            return message, self.fields(message)[name]
        owners = [] if dot else self._owners(text)
        if len(owners) == 1:
            return owners[0], self.fields(owners[0])[text]
        if owners:
            told = f"`{text}` is a field of {' and '.join(owners)}"
            raise WordError(told, f"write `{owners[0]}.{text}`")
        if or_chart:
            hint = hint_of(text, [*self.observable(), *self.charts], self._short())
            raise WordError(f"there is no field or chart `{text}`", hint)
        raise WordError(f"no message has a field `{text}`", self._instead(text))

    def _owners(self, field_name: str) -> list[str]:
        """The messages of the controller that have a field."""
        outside = self.outside()
        return [m for m in self.messages if m not in outside and field_name in self.fields(m)]

    def _instead(self, text: str) -> str:
        """Which field may be meant: of a chart, those that its instance sends."""
        for chart in self.charts.values():
            if text == chart.name or chart.name.endswith(f".{text}"):
                told = f"the states of the chart {text} are in no message"
                fields = self.sent_by(chart)
                return f"{told}; {chart.instance} sends {', '.join(fields)}" if fields else told
        return hint_of(text, self.observable())

    def chart(self, text: str) -> NamedChart | None:
        """The chart of `instance.Region`, or of an end of one such name; None: no chart is meant.

        Raises WordError where the text may mean several things.
        """
        if text in self.observable():
            return None
        names = [text] if text in self.charts else self._short().get(text, [])
        places = [] if "." in text else [f"{one}.{text}" for one in self._owners(text)]
        if not names or (len(names) == 1 and not places):
            return self.charts[names[0]] if names else None
        several = " or ".join(f"`{one}`" for one in (*places, *names))
        raise WordError(f"`{text}` may be several things", f"write {several}")

    def _short(self) -> dict[str, list[str]]:
        """Charts by each end of their names that begins behind a dot."""
        found: dict[str, list[str]] = {}
        for name in self.charts:
            end = name
            while "." in end:
                end = end.partition(".")[2]
                found.setdefault(end, []).append(name)
        return found

    def leaves(self, chart: NamedChart, state: Value) -> frozenset[str]:
        """The leaf states that a state of a chart has inside it; WordError for no state of it."""
        if state not in chart.states:
            hint = hint_of(str(state), chart.states)
            raise WordError(f"`{chart.name}` has no state `{state}`", hint)
        return chart.states[str(state)]

    def sent_by(self, chart: NamedChart) -> list[str]:
        """The fields of all messages that the instance of a chart sends."""
        return [
            f"{message.name}.{name}"
            for message in self.system.messages
            if message.source is not None
            and message.source.instance == chart.instance
            and message.name in self.messages
            for name in self.fields(message.name)
        ]

    def misfit(
        self, message: str, signal: DbcSignal, value: Value, *, by_name: bool = False
    ) -> str | None:
        """Why a field has no such value: it is none of its names, or no number in its range.

        Values that arrive are given ``by_name``, where they have names.
        """
        low, high = signal.minimum, signal.maximum
        assert low is not None and high is not None
        if signal.choices is None:
            fits = not isinstance(value, str) and low <= value <= high
        else:
            coded = not isinstance(value, str) and value in signal.choices
            named = value in [str(choice) for choice in signal.choices.values()]
            other = (message, signal.name) in self.partial and isinstance(value, int) and not coded
            fits = named or (coded and not by_name) or (other and low <= int(value) <= high)
        if fits:
            return None
        return f"`{signal.name}` must be {self.range_of(message, signal)}, not `{value}`"

    def range_of(self, message: str, signal: DbcSignal) -> str:
        """The values of a field in words, with their unit."""
        low, high = signal.minimum, signal.maximum
        if signal.choices is None:
            unit = "" if signal.unit is None else f", in {signal.unit}"
            return f"a number from {low} to {high}{unit}"
        names = ", ".join(str(choice) for choice in signal.choices.values())
        other = (message, signal.name) in self.partial
        return f"one of {names}" + (f", or another number from {low} to {high}" if other else "")


def _commands(messages: Iterable[DbcMessage]) -> Iterator[tuple[str, tuple[str, str]]]:
    """Each literal of one field alone, of all that comes from outside, and that field."""
    found: dict[str, list[tuple[str, str]]] = {}
    names = set()
    for message in messages:
        names.add(message.name)
        for signal in message.signals if message.senders == [OUTSIDE] else ():
            for choice in (signal.choices or {}).values():
                found.setdefault(str(choice), []).append((message.name, signal.name))
    for literal, places in found.items():
        if len(places) == 1 and literal not in names | TRUTH:
            yield literal, places[0]


def hint_of(name: str, known: Iterable[str], more: Iterable[str] = ()) -> str:
    """The hint for a name that is not known; ``more`` are names that are not listed."""
    names = [*known]
    every = [*names, *more]
    near = get_close_matches(name, every, 1) or [n for n in every if n.lower() == name.lower()]
    if near:
        return f"did you mean `{near[0]}`?"
    return f"one of {', '.join(names)}" if names else ""
