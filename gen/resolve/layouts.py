# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The signals of a message, from their forms in the model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from ravenchart.gen.files.located import TextPlace
from ravenchart.gen.files.schema_frames import MessageForm, SignalForm
from ravenchart.gen.language.names import Findings, NameUse, alike_in_databases, meant
from ravenchart.gen.language.terms import EnumerationType, IntegerType, RecordType, ScalarType, Type
from ravenchart.gen.model.authentication import FRESHNESS, MAC, REST
from ravenchart.gen.model.protection import PROFILES
from ravenchart.gen.model.signals import (
    FD_SIZES,
    RAW_LIMIT,
    ByteOrder,
    Signal,
    automatic,
    bits_of,
    length_of,
    overlaps,
    packed,
    room_of,
    scalars_of,
    width_for,
)
from ravenchart.gen.origins import Origin

from .authentication import trailer_of
from .values import constant

LAYOUT = "RV-0614"
"""A signal cannot be laid out as given."""
ROOM = "RV-0615"
"""Two signals share bits, or one reaches beyond the frame."""
SIZE = "RV-0616"
"""There is no frame of that length, or it is too short."""

DATABASE = "RV-0622"
"""Two names in databases are equal."""

SIGNED_BITS = 62
"""Bits of a signed signal at most: its values are computed in 64."""


def layout_of(
    name: str, form: MessageForm, type_: Type, findings: Findings
) -> tuple[Signal, ...] | None:
    """The signals of a message with a value of that type; None where they are not sound."""
    given = {key.lower(): key for key in form.signals or {}}
    known = scalars_of(type_)
    sound = not form.lost("signals") and not form.dropped("signals")
    names = [field or "value" for field, _ in known]
    for lowered, entry in given.items():
        if lowered not in [one.lower() for one in names]:
            message = f"{type_.name}, the type of {name}, has no field `{entry}`"
            at = form.entry_at("signals", entry)
            findings.error(LAYOUT, at, message, hint=meant(entry, names))
            sound = False
    named = {} if not isinstance(type_, RecordType) else {f.name.lower(): f for f in type_.fields}
    for lowered, entry in given.items():
        if lowered in named:
            one = named[lowered]
            at = form.entry_at("signals", entry)
            findings.uses.append(NameUse(one.name, at, "field", one.origin))
    if form.multiplexor is not None and form.multiplexor.lower() in named:
        one = named[form.multiplexor.lower()]
        findings.uses.append(NameUse(one.name, form.at("multiplexor"), "field", one.origin))
    maker = _Maker(name, form, findings)
    selector = maker.selector(known)
    signals: list[Signal] = []
    starts: dict[str, int] = {}
    for field, scalar in known:
        key = given.get((field or "value").lower())
        if selector is not None and selector.field == field:
            made: Signal | None = selector
            if key is not None and form.signals and form.signals[key].start is not None:
                starts[selector.name] = selector.start
        elif key is None or form.signals is None:
            made = automatic(field, scalar)
        else:
            made = maker.signal(form.signals[key], key, field, scalar, selector)
            if made is not None and form.signals[key].start is not None:
                starts[made.name] = made.start
        if made is None:
            sound = False
        else:
            signals.append(replace(made, selects=selector is not None and selector.field == field))
    if not sound or (form.multiplexor is not None and selector is None):
        return None
    laid = packed(signals, starts, maker.header)
    return laid if maker.named_once(laid) and maker.fits(laid) else None


def size_of(
    name: str, form: MessageForm, signals: tuple[Signal, ...], findings: Findings
) -> int | None:
    """Bytes of the frame: those given, or as few as do; None where there is no such frame."""
    fd = form.format == "fd"
    trailer = trailer_of(form)
    needed = length_of(signals, fd=fd, trailer=trailer) if signals else 0
    if form.bytes is None or (signals and bits_of(signals) > room_of(fd=fd)):
        return needed
    sizes = (0, *FD_SIZES) if fd else range(9)
    if form.bytes not in sizes:
        message = f"there is no frame of {form.bytes} bytes"
        if fd:
            hint = f"CAN FD has {', '.join(map(str, sizes))}"
        else:
            hint = "a classic frame has up to 8; write `format: fd` for more"
        findings.error(SIZE, form.at("bytes"), message, hint=hint)
        return None
    if form.bytes < needed:
        message = f"{name} needs {needed} bytes, but `bytes` is {form.bytes}"
        if trailer:
            message += f"; freshness value and MAC take {trailer}"
        findings.error(SIZE, form.at("bytes"), message, hint="leave `bytes` out, or give more")
        return None
    return form.bytes


@dataclass(frozen=True, slots=True)
class _Maker:
    """Makes the signals of one message."""

    name: str
    form: MessageForm
    findings: Findings

    @property
    def header(self) -> frozenset[int]:
        """The bits that the protection of the message takes."""
        given = self.form.protection
        return frozenset() if given is None else PROFILES[given.profile].header

    def wrong(self, key: str, part: str | None, message: str, hint: str | None = None) -> None:
        """An error at a key of a signal, or at the signal itself."""
        at = self._at(key, part)
        self.findings.error(LAYOUT, at, message, hint=hint)

    def _at(self, key: str, part: str | None) -> Origin:
        given = (self.form.signals or {}).get(key)
        if part is None or given is None:
            return self.form.entry_at("signals", key)
        return given.at_key(part)

    def selector(self, known: Sequence[tuple[str | None, ScalarType]]) -> Signal | None:
        """The multiplexor, as far as it is known before it has its place."""
        text = self.form.multiplexor
        if text is None:
            return None
        for field, scalar in known:
            if field is not None and field.lower() == text.lower():
                own = next((k for k in self.form.signals or {} if k.lower() == text.lower()), None)
                given = SignalForm() if own is None else (self.form.signals or {})[own]
                return self.signal(given, field, field, scalar, None)
        at = self.form.at("multiplexor")
        message = f"the value of {self.name} has no field `{text}`"
        names = [field for field, _ in known if field is not None]
        self.findings.error(LAYOUT, at, message, hint=meant(text, names))
        return None

    def signal(
        self,
        form: SignalForm,
        key: str,
        field: str | None,
        scalar: ScalarType,
        selector: Signal | None,
    ) -> Signal | None:
        """One signal as given; it starts at 0 where that is left open."""
        before = self.findings.count()
        is_selector = (self.form.multiplexor or "").lower() == key.lower()
        codes = self._codes(form, key, scalar)
        offset = form.offset
        if isinstance(scalar, EnumerationType):
            if offset is not None:
                self.wrong(key, "offset", f"{scalar.name} is an enumeration and has no `offset`")
            offset = 0
        elif offset is None:
            offset = 0 if form.signed or is_selector else scalar.first
        order = ByteOrder(form.order)
        made = Signal(field, scalar, form.start or 0, 1, offset, form.signed, order, codes)
        made = self._with_other(form, key, made)
        made = self._with_width(form, key, made)
        if order is ByteOrder.MOTOROLA and form.start is None:
            hint = "give the place of its most significant bit"
            self.wrong(key, "order", f"the Motorola signal `{key}` has no `start`", hint)
        pages = self._pages(form, key, selector)
        if is_selector and (form.signed or offset):
            hint = "leave `signed` and `offset` out"
            message = f"the raw values of the multiplexor `{key}` must be its values, from 0 on"
            self.wrong(key, None, message, hint)
        names = self._value_names(form, key, made)
        made = replace(
            made, pages=pages, database_name=form.database_name, value_names=tuple(names.items())
        )
        return None if self.findings.count() > before else made

    def _value_names(self, form: SignalForm, key: str, made: Signal) -> dict[str, str]:
        """The names of literals in databases: each value of the signal has another name."""
        given = form.value_names or {}
        if given and isinstance(made.type, IntegerType):
            message = f"{made.type.name} is no enumeration and has no `value_names`"
            self.wrong(key, "value_names", message)
            return {}
        coded = made.named_codes
        own = {name.lower(): name for name in coded}
        found: dict[str, str] = {}
        for text, name in given.items():
            if text.lower() not in own:
                message = f"no value of `{key}` is `{text}`"
                self.wrong(key, "value_names", message, meant(text, coded))
                return {}
            found[own[text.lower()]] = name
        called = [found.get(name, name) for name in coded]
        twice = next((name for name in called if called.count(name) > 1), None)
        if twice is not None:
            at = self._at(key, "value_names")
            message = f"two values of `{key}` are named `{twice}` in the database"
            self.findings.error(DATABASE, at, message, hint="give one of them another name")
        return found

    def _codes(self, form: SignalForm, key: str, scalar: ScalarType) -> tuple[int, ...]:
        if form.codes is None:
            return ()
        if isinstance(scalar, IntegerType):
            self.wrong(key, "codes", f"{scalar.name} is no enumeration and has no `codes`")
            return ()
        if len(form.codes) != len(scalar.literals) or len(set(form.codes)) < len(form.codes):
            count = len(scalar.literals)
            message = f"`codes` must be {count} different numbers, one for each of {scalar.name}"
            self.wrong(key, "codes", message)
            return ()
        return tuple(form.codes)

    def _with_other(self, form: SignalForm, key: str, made: Signal) -> Signal:
        """The same with the literal for all other raw values, where one is given."""
        if form.other is None:
            return made
        if isinstance(made.type, IntegerType):
            self.wrong(key, "other", f"{made.type.name} is no enumeration and has no `other`")
            return made
        names = made.type.literals
        other = next((name for name in names if name.lower() == form.other.lower()), None)
        if other is None:
            message = f"{made.type.name} has no value `{form.other}`"
            self.wrong(key, "other", message, meant(form.other, names))
        return replace(made, codes=made.codes or tuple(range(len(names))), other=other)

    def _with_width(self, form: SignalForm, key: str, made: Signal) -> Signal:
        low, high = made.raw_range
        if low < 0 and not form.signed:
            hint = "write `signed: true`, or another offset"
            message = f"the raw values of `{key}` are {low} .. {high}, but it is not signed"
            self.wrong(key, None, message, hint)
            return made
        needed = width_for(low, high, signed=form.signed)
        width = needed if form.width is None else form.width
        if width < needed:
            hint = f"write `width: {needed}`, or leave it out"
            message = f"`{key}` has {width} bits, but its raw values {low} .. {high} need {needed}"
            self.wrong(key, "width", message, hint)
        elif (form.signed and width > SIGNED_BITS) or high >= RAW_LIMIT:
            message = f"`{key}` has {width} bits" if form.signed else f"`{key}` has raw values"
            message += f"; a signed signal has {SIGNED_BITS} at most"
            if not form.signed:
                message = f"`{key}` has raw values up to {high}; the limit is 2^62 - 1"
            self.wrong(key, None, message)
        return replace(made, width=width)

    def _pages(self, form: SignalForm, key: str, selector: Signal | None) -> tuple[int, ...]:
        if form.when is None:
            return ()
        if selector is None:
            if not self.form.lost("multiplexor") and self.form.multiplexor is None:
                hint = "write `multiplexor:` and the field that selects the page"
                self.wrong(key, "when", f"{self.name} has no multiplexor", hint)
            else:
                self.findings.lose()
            return ()
        given = form.when if isinstance(form.when, list) else [form.when]
        place = form.place("when")
        places = [place]
        if isinstance(form.when, list):
            places = [TextPlace(form.item_at("when", index)) for index in range(len(given))]
        found = [
            constant(one, at, selector.name, selector.type, self.findings)
            for one, at in zip(given, places, strict=True)
        ]
        if selector.other is not None and selector.other in found:
            message = f"`{selector.other}` stands for many raw values of `{selector.name}`"
            self.wrong(key, "when", message, "name values that have one raw value each")
            return ()
        return tuple(sorted({selector.raw(one) for one in found if one is not None}))

    def named_once(self, signals: tuple[Signal, ...]) -> bool:
        """Whether databases can tell the signals of the message by their names."""
        before = self.findings.count()
        for signal, other in alike_in_databases(signals, self._added):
            alike = "a signal of the protection" if other is None else f"`{other.name}`"
            message = f"`{signal.name}` and {alike} of {self.name} are both named "
            message += f"`{signal.in_database}` in the database"
            key = next(k for k in self.form.signals or {} if k.lower() == signal.name.lower())
            hint = "give one of them another `database_name`"
            self.findings.error(DATABASE, self._at(key, "database_name"), message, hint=hint)
        return self.findings.count() == before

    @property
    def _added(self) -> tuple[str, ...]:
        """The names of the signals of protection and authentication."""
        given = self.form.protection
        header = () if given is None else PROFILES[given.profile].fields
        trailer = () if self.form.authentication is None else (FRESHNESS, MAC, REST)
        return (*(one.name for one in header), *trailer)

    def fits(self, signals: tuple[Signal, ...]) -> bool:
        """Whether no two share bits, and none reaches beyond the longest frame there is."""
        before = self.findings.count()
        keys = {key.lower(): key for key in self.form.signals or {}}
        for first, second in overlaps(signals):
            named = keys.get(second.name.lower()) or keys.get(first.name.lower(), second.name)
            shared = min(set(first.bits()) & set(second.bits()))
            message = f"`{first.name}` and `{second.name}` share bit {shared} of {self.name}"
            hint = "give one of them another `start`"
            self.findings.error(ROOM, self.form.entry_at("signals", named), message, hint=hint)
        for signal in signals:
            if held := self.header & set(signal.bits()):
                message = f"`{signal.name}` of {self.name} takes bit {min(held)}, which is of the "
                message += "header of its protection"
                at = self.form.entry_at("signals", keys.get(signal.name.lower(), signal.name))
                after = max(self.header) + 1
                hint = f"the header ends before bit {after}: give another `start`, or leave it out"
                self.findings.error(ROOM, at, message, hint=hint)
        if self.form.signals is None:
            return True  # `payloads_fit` says what is too long
        room = 8 * self.form.bytes if self.form.bytes is not None else None
        if room is None:
            room = room_of(fd=self.form.format == "fd" or self.form.transport is not None)
        for signal in signals:
            last = max(signal.bits())
            key = keys.get(signal.name.lower())
            if last >= room and key is not None:
                message = (
                    f"`{signal.name}` of {self.name} reaches to bit {last}, but the frame has "
                    f"{room} bits"
                )
                hint = "another `start`, a longer frame (`bytes`), or `format: fd`"
                self.findings.error(ROOM, self._at(key, None), message, hint=hint)
        return self.findings.count() == before
