# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The signals of a CAN database as types and layouts of a model.

A value counts the scale of its signal: 0.1 degC is a unit. A signal that models have no such
words for, such as one of a negative scale, is imported as its raw counts, with the reason.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Set
from dataclasses import dataclass
from decimal import Decimal

from cantools.database.can import Signal

from ravenchart.gen.language.names import database_text_problem_of
from ravenchart.gen.model.signals import RAW_LIMIT, ByteOrder, positions
from ravenchart.gen.resolve.layouts import SIGNED_BITS

from .names import HIDDEN, Names

LITERALS = 256
"""Values of an enumeration with codes at most."""
BITS_OF_NAMES = 8
"""Of a signal whose values have names, though not all of them, at most."""
OTHER = "Other"
"""The literal for the values without a name."""
LONGEST_UNIT = 20
"""Characters of a unit at most."""


class Unsayable(Exception):  # noqa: N818
    """A message or signal has something that models have no words for; the text says what."""


@dataclass(frozen=True, slots=True)
class Words:
    """A signal in the words of a model."""

    literals: tuple[str, ...] | None
    """Of an enumeration; () for Boolean, None for an integer."""
    codes: tuple[int, ...]
    range: str
    """Of an integer: its definition."""
    keys: tuple[str, ...]
    """Of the layout."""
    raw: str | None = None
    """Why it counts raw values, if it does."""
    renamed: tuple[tuple[str, str], ...] = ()
    """Literals that have another name than in the database."""
    limits: tuple[int, int] = (0, 0)
    """Of an integer: its least and its greatest value."""
    other: int | None = None
    """The raw value that is sent for the last literal, that of all other raw values."""
    named: tuple[tuple[int, str], ...] = ()
    """Of an integer: values that have a name in the database."""

    def has(self, code: int) -> bool:
        """Has a raw value a place in the model? Of an integer without an offset."""
        if self.literals is None:
            return self.limits[0] <= code <= self.limits[1]
        return code in self.codes and code != self.other

    def literal(self, code: int) -> str:
        """How a model writes a raw value."""
        if self.literals is None:
            return str(code)
        return ("False", "True")[code] if not self.literals else self.literals[self._at(code)]

    def _at(self, code: int) -> int:
        return self.codes.index(code)


def signal_words(signal: Signal, *, taken: Set[str] = frozenset()) -> Words:
    """A signal in a model's words; `Unsayable` when a model cannot even have its raw counts.

    ``taken`` are names that no literal may have.
    """
    try:
        return _exact_words(signal, taken)
    except Unsayable as reason:
        return raw_words(signal, str(reason))


def _layout(signal: Signal) -> tuple[str, ...]:
    keys = [f"start: {signal.start}", f"width: {signal.length}"]
    keys += ["order: motorola"] if signal.byte_order == "big_endian" else []
    keys += ["signed: true"] if _is_signed(signal) else []
    return tuple(keys)


def _is_signed(signal: Signal) -> bool:
    return signal.is_signed and not signal.conversion.is_float


def raw_words(signal: Signal, reason: str) -> Words:
    """Its raw value, whatever it stands for; `Unsayable` where that has too many bits."""
    low, high = _by_width(signal)
    if max(-low, high) >= RAW_LIMIT:
        raise Unsayable(f"it has more than {SIGNED_BITS} bits")
    definition = f"{{range: [{low}, {high}]}}"
    return Words(None, (), definition, _layout(signal), reason, limits=(low, high))


def unsigned_words(signal: Signal, reason: str) -> Words:
    """Its raw value as a number from 0 on, although it is signed."""
    high = (1 << signal.length) - 1
    if high >= RAW_LIMIT:
        raise Unsayable(f"it has more than {SIGNED_BITS} bits")
    keys = tuple(key for key in _layout(signal) if not key.startswith("signed"))
    return Words(None, (), f"{{range: [0, {high}]}}", keys, reason, limits=(0, high))


def _exact_words(signal: Signal, taken: Set[str]) -> Words:
    if signal.conversion.is_float:
        raise Unsayable("it is a floating-point number")
    scale, offset = _exact(signal.conversion.scale), _exact(signal.conversion.offset)
    if scale <= 0:
        raise Unsayable(f"its scale is {scale}")
    low, high = _raw_range(signal, scale, offset)
    choices = named_values(signal)
    if choices and not _is_number(signal, choices, (low, high)):
        return _enumeration(signal, choices, (low, high), taken)
    low, high = min((low, *choices)), max((high, *choices))
    counts = offset / scale
    if counts != int(counts):
        raise Unsayable("its offset is no whole number of counts")
    if signal.is_multiplexer and counts:
        raise Unsayable("a multiplexor has no offset")
    low, high = low + int(counts), high + int(counts)
    if max(-low, high) >= RAW_LIMIT:
        raise Unsayable(f"it has values of more than {SIGNED_BITS} bits")
    unit = signal.unit or ""
    if scale != 1:
        unit = f"{scale:f} {unit}".strip()
    if len(unit) > LONGEST_UNIT or not unit.isprintable() or '"' in unit or "\\" in unit:
        raise Unsayable(f"its unit `{unit}` is not one of at most {LONGEST_UNIT} characters")
    shown = f', unit: "{unit}"' if unit else ""
    keys = (*_layout(signal), f"offset: {int(counts)}")
    named = tuple((code + int(counts), name) for code, name in choices.items())
    definition = f"{{range: [{low}, {high}]{shown}}}"
    return Words(None, (), definition, keys, limits=(low, high), named=named)


def named_values(signal: Signal) -> dict[int, str]:
    """The names of its raw values, as far as it has bits for them."""
    low, high = _by_width(signal)
    names = ((int(code), str(name)) for code, name in (signal.conversion.choices or {}).items())
    return {code: name for code, name in sorted(names) if low <= code <= high}


def _is_number(signal: Signal, choices: Mapping[int, str], limits: tuple[int, int]) -> bool:
    """Do its values count something, so that names are those of single numbers?

    They do where it has a scale or an offset. Where a value within its limits has no name, they
    also do in these cases:

    - it has a unit or more than 8 bits;
    - one value alone of many has a name;
    - no value within its limits has a name.
    """
    if signal.conversion.scale != 1 or signal.conversion.offset != 0:
        return True
    within = sum(limits[0] <= code <= limits[1] for code in choices)
    if within == limits[1] - limits[0] + 1 and len(choices) <= LITERALS:
        return False
    several = len(choices) > 1 or signal.length == 1
    some = several and signal.length <= BITS_OF_NAMES and not signal.unit
    return not some or not within


def _enumeration(
    signal: Signal, choices: Mapping[int, str], limits: tuple[int, int], taken: Set[str]
) -> Words:
    """The names of its values, and one for the other values where there are some."""
    if choices == {0: "False", 1: "True"} and limits == (0, 1):
        return Words((), (0, 1), "", _layout(signal))
    names = Names()
    names.avoid(taken | HIDDEN)
    literals = tuple(names.new(text) for text in choices.values())
    renamed = tuple(
        pair for pair in zip(choices.values(), literals, strict=True) if len(set(pair)) > 1
    )
    codes, keys, other = tuple(choices), _layout(signal), None
    if not all(code in choices for code in range(limits[0], limits[1] + 1)):
        other = _free(signal, choices, limits)
        literals, codes = (*literals, names.new(OTHER)), (*codes, other)
    keys += (f"codes: [{', '.join(map(str, codes))}]",)
    keys += () if other is None else (f"other: {literals[-1]}",)
    kept = [f'{new}: "{old}"' for old, new in renamed if _is_kept(old, choices)]
    keys += (f"value_names: {{{', '.join(kept)}}}",) if kept else ()
    return Words(literals, codes, "", keys, None, renamed, other=other)


def _is_kept(name: str, choices: Mapping[int, str]) -> bool:
    """Can the database of the model have this name for the value?"""
    alone = list(choices.values()).count(name) == 1
    return alone and database_text_problem_of(name) is None


def _free(signal: Signal, choices: Mapping[int, str], limits: tuple[int, int]) -> int:
    """The raw value to send for values without a name: the start value, or the least."""
    first = signal.raw_initial
    if isinstance(first, int) and first not in choices and limits[0] <= first <= limits[1]:
        return first
    return next(code for code in range(limits[0], limits[1] + 1) if code not in choices)


def _exact(value: float | int) -> Decimal:
    return Decimal(repr(value)) if isinstance(value, float) else Decimal(value)


def _by_width(signal: Signal) -> tuple[int, int]:
    if _is_signed(signal):
        return -(1 << signal.length - 1), (1 << signal.length - 1) - 1
    return 0, (1 << signal.length) - 1


def _raw_range(signal: Signal, scale: Decimal, offset: Decimal) -> tuple[int, int]:
    """The least and the greatest raw value: by the limits that are given, and by the width."""
    low, high = _by_width(signal)
    if signal.minimum is not None and signal.maximum is not None:
        first, last = (
            (_exact(limit) - offset) / scale for limit in (signal.minimum, signal.maximum)
        )
        low, high = max(low, math.ceil(first)), min(high, math.floor(last))
    if low > high:
        raise Unsayable("it has no value within its limits")
    return low, high


# --- where it is in the frame ------------------------------------------------


HALF = 32
"""Bits of a piece of a signal that is too wide."""


def pieces_of(signal: Signal) -> tuple[Signal, ...]:
    """The signal itself, or pieces of it where it has more bits than a model's number.

    Two pieces are `_High` and `_Low`; more are numbered from the least significant one on.
    """
    if signal.length <= SIGNED_BITS:
        return (signal,)
    bits = bits_in_frame(signal)
    pieces = [bits[low : low + HALF] for low in range(0, len(bits), HALF)]
    names = ["Low", "High"] if len(pieces) == 2 else [str(n) for n in range(len(pieces))]
    intel = signal.byte_order == "little_endian"
    made = [
        Signal(
            f"{signal.name}_{name}",
            piece[0] if intel else piece[-1],
            len(piece),
            byte_order=signal.byte_order,
            multiplexer_ids=signal.multiplexer_ids,
            multiplexer_signal=signal.multiplexer_signal,
        )
        for name, piece in zip(names, pieces, strict=True)
    ]
    return tuple(reversed(made))


def bits_in_frame(signal: Signal) -> tuple[int, ...]:
    """Its bits in the frame, the least significant first."""
    intel = signal.byte_order == "little_endian"
    order = ByteOrder.INTEL if intel else ByteOrder.MOTOROLA
    return positions(signal.start, signal.length, order)
