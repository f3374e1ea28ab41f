# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The signals of one message as fields of a model: all that fit together.

A model has one multiplexor for a message, no signals that share bits, and 64 fields. A signal
that breaks this is degraded or left out by itself. The message stays.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Set
from dataclasses import dataclass, field, replace

from cantools.database.can import Message, Signal

from .signals import (
    HALF,
    Unsayable,
    Words,
    bits_in_frame,
    pieces_of,
    raw_words,
    signal_words,
    unsigned_words,
)

MOST = 64
"""Fields of a record at most."""


@dataclass(frozen=True, slots=True)
class ImportedField:
    """A signal of the database, or bits of several of them, in a model's words."""

    signal: Signal
    words: Words
    pages: frozenset[int] = frozenset()
    """Raw values of the multiplexor with which it is in the frame; none: it always is."""
    told: str | None = None
    """The difference from the database that the words do not show."""

    @property
    def bits(self) -> tuple[int, ...]:
        """Its bits in the frame, the least significant first."""
        return bits_in_frame(self.signal)

    def clashes(self, other: ImportedField) -> bool:
        """Do both have a bit in some frame?"""
        apart = self.pages and other.pages and not self.pages & other.pages
        return not apart and bool(set(self.bits) & set(other.bits))


@dataclass(slots=True)
class Fields:
    """The fields that the signals of a message become."""

    message: Message
    taken: Set[str]
    """Names that no literal may have, in lower case."""
    selector: ImportedField | None = None
    """The multiplexor of the model."""
    fields: list[ImportedField] = field(default_factory=list)
    left_out: list[tuple[Signal, str]] = field(default_factory=list)
    """Signals that no field has, with the reason."""

    def of_selector(self, value: int) -> int:
        """A value of the multiplexor as the raw value that the model has for it."""
        signal = None if self.selector is None else self.selector.signal
        return value % (1 << signal.length) if signal is not None and signal.is_signed else value


def fields_of(message: Message, *, taken: Set[str], sends: bool) -> Fields:
    """The fields of a message. One that is sent has constants where signals are left out."""
    found = Fields(message, taken)
    found.selector = _selector(found)
    loose: list[ImportedField] = []
    for signal in message.signals:
        if found.selector is not None and signal is found.selector.signal:
            found.fields.append(found.selector)
        else:
            _add(found, signal, loose)
    found.fields += _merged(found, loose)
    _shorten(found)
    if sends:
        found.fields += _constants(found)
    return found


def raw_fields(message: Message) -> list[ImportedField]:
    """The bytes of a message without signals."""
    told = "is raw bits: the message has no signals"
    return [
        replace(_raw(f"Data_{run[0]}", run), told=told) for run in _runs(range(8 * message.length))
    ]


def _selector(found: Fields) -> ImportedField | None:
    """The multiplexor with the most signals among those that are always there."""
    message = found.message
    roots = [
        s for s in message.signals
        if s.is_multiplexer and not s.multiplexer_ids and not s.conversion.is_float
        and max(bits_in_frame(s)) < 8 * message.length
    ]  # fmt: skip
    if not roots:
        return None
    signal = max(roots, key=lambda s: len(_paged_by(message, s)))
    pages = {page for one in _paged_by(message, signal) for page in one.multiplexer_ids or ()}
    try:
        if signal.is_signed:
            return ImportedField(signal, unsigned_words(signal, "a multiplexor has no sign"))
        words = signal_words(signal, taken=found.taken)
        if not all(words.has(page) for page in pages):
            reason = "some values of the multiplexor have no name, or are beyond its limits"
            words = raw_words(signal, reason)
    except Unsayable:
        return None
    return ImportedField(signal, words)


def _paged_by(message: Message, selector: Signal) -> list[Signal]:
    return [s for s in message.signals if s.multiplexer_ids and _chooser(message, s) is selector]


def _chooser(message: Message, signal: Signal) -> Signal | None:
    """The multiplexor of a signal; a message with one alone need not name it."""
    selectors = [s for s in message.signals if s.is_multiplexer and s is not signal]
    named = [s for s in selectors if s.name == signal.multiplexer_signal]
    if named:
        return named[0]
    return selectors[0] if len(selectors) == 1 else None


def _pages(found: Fields, signal: Signal) -> tuple[frozenset[int], str | None]:
    """Where it is, by the model's multiplexor, and what the model cannot say of that."""
    one: Signal | None = signal
    inner: str | None = None
    seen: list[Signal] = []
    while one is not None and one.multiplexer_ids and one not in seen:
        seen.append(one)
        chooser = _chooser(found.message, one)
        if found.selector is not None and chooser is found.selector.signal:
            values = (found.of_selector(page) for page in one.multiplexer_ids)
            room = 1 << chooser.length
            return frozenset(page for page in values if 0 <= page < room), inner
        values_shown = ", ".join(map(str, one.multiplexer_ids[:4]))
        more = ", ..." if len(one.multiplexer_ids) > 4 else ""
        of = "its multiplexor" if chooser is None else chooser.name
        inner = inner or f"it counts only where {of} is {values_shown}{more}"
        one = chooser
    return frozenset(), inner


def _add(found: Fields, signal: Signal, loose: list[ImportedField]) -> None:
    """A signal that is not the model's multiplexor."""
    pages, inner = _pages(found, signal)
    if signal.multiplexer_ids and not pages and inner is None:
        found.left_out.append((signal, "its multiplexor has no such value"))
        return
    for part in pieces_of(signal):
        if max(bits_in_frame(part)) >= 8 * found.message.length:
            reason = f"it reaches beyond the {found.message.length} bytes of its frame"
            found.left_out.append((part, reason))
            continue
        try:
            words = (
                signal_words(part, taken=found.taken) if inner is None else raw_words(part, inner)
            )
        except Unsayable as problem:
            found.left_out.append((part, str(problem)))
            continue
        half = part is not signal and signal.conversion.is_float
        told = f"is part of the raw bits of a floating-point number ({signal.length} bits)"
        new = ImportedField(part, words, pages, told if half else None)
        if inner is not None:
            loose.append(new)
        elif clash := _clash(found, new):
            found.left_out.append((part, f"it shares bits with {clash.signal.name}"))
        else:
            found.fields.append(new)


def _clash(found: Fields, new: ImportedField) -> ImportedField | None:
    others = found.fields if found.selector is None else [found.selector, *found.fields]
    return next((other for other in others if new.clashes(other)), None)


def _merged(found: Fields, loose: list[ImportedField]) -> Iterator[ImportedField]:
    """Signals of inner multiplexors: those that may share bits become raw bits together."""
    groups: list[list[ImportedField]] = []
    for new in loose:
        own = [new]
        while hit := next((g for g in groups if any(_meet(own, one) for one in g)), None):
            groups.remove(hit)
            own = [*hit, *own]
        groups.append(own)
    for group in groups:
        always = any(not one.pages for one in group)
        pages = frozenset[int]() if always else frozenset().union(*(one.pages for one in group))
        held = {
            bit for other in found.fields
            if not (pages and other.pages and not pages & other.pages) for bit in other.bits
        }  # fmt: skip
        bits = {bit for one in group for bit in one.bits}
        if len(group) == 1 and not bits & held:
            yield group[0]
            continue
        names = ", ".join(dict.fromkeys(one.signal.name for one in group))
        for run in _runs(bits - held):
            name = f"{group[0].signal.name[:16]}_Bits_{run[0]}"
            shown = f"is bits {run[0]} to {run[-1]} of the frame, which {names} share"
            yield replace(_raw(name, run), pages=pages, told=shown)


def _meet(group: list[ImportedField], other: ImportedField) -> bool:
    """Can raw bits of the whole group and of another signal be in one frame?"""
    pages = frozenset().union(*(one.pages for one in group))
    always = any(not one.pages for one in group)
    if not always and other.pages and not pages & other.pages:
        return False
    return any(set(one.bits) & set(other.bits) for one in group)


def _shorten(found: Fields) -> None:
    """At most as many fields as a record has: the last ones become raw bits together."""
    pool = [one for one in found.fields if one is not found.selector]
    rest: list[ImportedField] = []
    made: list[ImportedField] = []
    while len(found.fields) - len(rest) + len(made) > MOST and len(rest) < len(pool):
        rest.insert(0, pool[len(pool) - 1 - len(rest)])
        made = []
        for pages in dict.fromkeys(one.pages for one in rest):
            alike = [one for one in rest if one.pages == pages]
            names = ", ".join(one.signal.name for one in alike)
            for run in _runs(bit for one in alike for bit in one.bits):
                name = f"Bits_{run[0]}" + (f"_{min(pages)}" if pages else "")
                told = f"is bits {run[0]} to {run[-1]} of the frame: a value has {MOST} fields at "
                told += f"most; of {names}"
                made.append(replace(_raw(name, run), pages=pages, told=told))
    gone = {id(one) for one in rest}
    found.fields = [one for one in found.fields if id(one) not in gone] + made


def _constants(found: Fields) -> Iterator[ImportedField]:
    """The bits that only signals have which are left out, as they are sent."""
    held = {bit for one in found.fields for bit in one.bits}
    values: dict[int, int] = {}
    for signal, _ in found.left_out:
        first = signal.raw_initial
        first = int(first) if isinstance(first, int) else 0
        for place, bit in enumerate(bits_in_frame(signal)):
            if bit not in held and bit < 8 * found.message.length:
                values.setdefault(bit, first >> place & 1)
    room = MOST - len(found.fields)
    for run in list(_runs(values))[: max(0, room)]:
        value = sum(values[bit] << place for place, bit in enumerate(run))
        made = _raw(f"Reserved_{run[0]}", run)
        words = replace(made.words, range=f"{{range: [{value}, {value}]}}")
        words = replace(words, keys=(*words.keys, "offset: 0"))
        told = f"is sent as {value}: it stands for bits of signals that are left out"
        yield replace(made, words=words, told=told)


def _raw(name: str, run: range) -> ImportedField:
    signal = Signal(name, run[0], len(run), byte_order="little_endian")
    return ImportedField(signal, replace(raw_words(signal, ""), raw=None))


def _runs(bits: Iterable[int]) -> Iterator[range]:
    """Bits that stand together, in pieces of at most 32."""
    order = sorted(set(bits))
    while order:
        count = 1
        while count < min(len(order), HALF) and order[count] == order[0] + count:
            count += 1
        yield range(order[0], order[0] + count)
        del order[:count]
