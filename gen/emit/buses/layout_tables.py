# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The layout table of a message in Ada, its frame, and the contracts that name them.

A row has the numbers of a signal as the model gives them; `Ravenchart.Can.Layouts` gives the row
its meaning. Nothing here is shared with `coding`, which makes the bodies of the codecs: an error
on one side is a contract that cannot be proved.
"""

from __future__ import annotations

from collections.abc import Sequence

from ravenchart.gen.emit.ada.declarations import Decl, Object, Param, Subprogram, SubtypeDeclaration
from ravenchart.gen.emit.ada.expressions import (
    TRUE,
    Attribute,
    CaseExpr,
    Choice,
    Expr,
    Holder,
    Indexed,
    OperatorChain,
    Prefix,
    Range,
    arguments,
    between,
    bits,
    both,
    call,
    chain,
    equal,
    member,
    number,
    plain,
    record,
    signed,
)
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import NUMBER, ada_case, literal, type_name
from ravenchart.gen.emit.ada.statements import Do, do
from ravenchart.gen.language.terms import EnumerationType, IntegerType
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.signals import ByteOrder, Signal
from ravenchart.gen.model.system import System

LAYOUTS = ref("Ravenchart.Can.Layouts")
"""The meaning of the rows of layout tables."""

LEMMAS = ref("Ravenchart.Can.Layout_Lemmas")
"""Lemmas on the bits of a signal of a longer frame, by words."""


FD = ref("Ravenchart.Can.Fd_Frames")
"""Words of longer frames, and their bit rates."""

ANY = ref("Ravenchart.Can.Any_Frames")
"""Frames of both families."""


FRAME_ROW = SubtypeDeclaration("Row_Of_Frame", ref(LAYOUTS, "Frame_Row"))
"""A short name: those of messages may be long."""

FITS = "Fits_In"
"""Does a frame hold all signals of a layout?"""


def frame_row(message: Message) -> Object:
    """The frame that carries a message."""
    columns = {
        "Family": ref(ANY, "Flexible" if message.fd else "Classic"),
        "Id": number(message.identifier),
        "Format": ref("Ravenchart.Can", "Extended" if message.extended else "Standard"),
        "Length": number(message.length),
    }
    made = record(columns)
    return Object(_frame_name(message), FRAME_ROW.name, made, constant=True)


def is_framed(message: Message, frame: Expr) -> Expr:
    """Is a frame the one of a message, by the table?"""
    return call(ref(LAYOUTS, "Is_Framed"), frame, ref("Codecs", _frame_name(message)))


def is_received(message: Message, codec: str) -> Expr:
    """Does the filter let a message in, and does its frame hold all its signals?"""
    row = ref("Codecs", _frame_name(message))
    accepted = call("Accepts", ref(row, "Id"), ref(row, "Format"))
    return both(accepted, call(ref("Codecs", codec, FITS), ref(row)))


class LayoutTable:
    """The rows of one message, in the package of its codec."""

    def __init__(self, system: System, signals: Sequence[Signal]) -> None:
        """The table of these signals."""
        self.system, self.signals = system, signals

    def row(self, signal: Signal) -> list[Decl]:
        """The row of a signal, and the codes of its literals where the model gives some."""
        columns = {
            "Start": number(signal.start),
            "Width": number(signal.width),
            "Order": ref(LAYOUTS, _ORDERS[signal.order]),
            "Signed": ref(str(signal.signed)),
            "Offset": number(signal.offset),
        }
        made = record(columns)
        rows: list[Decl] = [Object(_row(signal), ref(LAYOUTS, "Signal"), made, constant=True)]
        if signal.codes:
            rows.append(self._codes(signal))
        if signal.other is not None:
            rows.append(self._stands_for(signal))
        return rows

    def _stands_for(self, signal: Signal) -> Subprogram:
        """Which raw values stand for each literal: one, or for the other values the rest."""
        assert isinstance(signal.type, EnumerationType)
        raw, codes = ref("Raw"), signal.named_codes
        taken = map(signed, sorted(codes.values()))
        rest = Prefix("not", member(raw, *taken)) if codes else TRUE
        facts = tuple(
            (
                literal(self.system, signal.type, name),
                equal(raw, number(codes[name])) if name in codes else rest,
            )
            for name in signal.type.literals
        )
        item = Param("Item", "in", type_name(self.system, signal.type))
        given = (Param("Raw", "in", Attribute(NUMBER, "Base")), item)
        return Subprogram(_meant(signal), given, "Boolean", expression=CaseExpr(ref("Item"), facts))

    def _codes(self, signal: Signal) -> Subprogram:
        assert isinstance(signal.type, EnumerationType)
        pairs = zip(signal.type.literals, signal.codes, strict=True)
        codes = tuple(
            (literal(self.system, signal.type, name), number(code)) for name, code in pairs
        )
        item = Param("Item", "in", type_name(self.system, signal.type))
        return Subprogram(_code(signal), (item,), NUMBER, expression=CaseExpr(ref("Item"), codes))

    def fits(self) -> Subprogram:
        """Does a frame hold all signals?"""
        held = [call(ref(LAYOUTS, "Holds"), ref("Row"), ref(_row(s))) for s in self.signals]
        row = Param("Row", "in", ref(LAYOUTS, "Frame_Row"))
        return Subprogram(FITS, (row,), "Boolean", expression=both(*held))

    def bits_in(self, signal: Signal, frame: Holder) -> Expr:
        """The bits of a signal, by its row."""
        return call(ref(LAYOUTS, "Raw"), frame, ref(_row(signal)))

    def lemmas_of_bits(self, signal: Signal, frame: Holder) -> tuple[Expr, tuple[Do, ...]]:
        """By words what `bits_in` of a longer frame is, and the lemmas that say so.

        Provers reckon a row and a frame at once very slowly. An error here is a precondition
        that fails.
        """
        upwards = signal.order is ByteOrder.INTEL
        byte, bit = divmod(signal.start, 8)
        first = signal.start if upwards else 8 * byte + 7 - bit
        word, last = first // 64, (first + signal.width - 1) // 64
        if upwards:
            shift = first % 64
        else:
            shift = (first + signal.width if last > word else -first - signal.width) % 64
        name = f"{_ORDERS[signal.order]}_{'Over' if last > word else 'Within'}"
        ones = bits((1 << signal.width) - 1)
        row = ref(_row(signal))
        given = arguments(frame, row, number(word), number(shift))
        words: list[Expr] = [Indexed(frame, plain(index)) for index in range(word, last + 1)]
        if not upwards:
            words = [call(ref(LAYOUTS, "Reversed"), one) for one in words]
        ways = ["Right"] if last == word else ["Right", "Left"] if upwards else ["Left", "Right"]
        by = [shift, 64 - shift]
        parts = [
            call(ref("Interfaces", f"Shift_{way}"), one, number(places))
            for way, one, places in zip(ways, words, by, strict=False)
        ]
        taken = OperatorChain("and", (chain("or", parts, number(0)), ones))
        mask = do(ref(LEMMAS, "Lemma_Mask"), row, ones)
        return taken, (mask, Do(ref(LEMMAS, f"Lemma_{name}"), given))

    def number_in(self, signal: Signal, frame: Holder) -> Expr:
        """The raw value of a signal of a frame, by its row."""
        return call(ref(LAYOUTS, "Number_In"), frame, ref(_row(signal)))

    def counted(self, signal: Signal, raw: Expr) -> Expr:
        """The raw value that bits are, by the row."""
        return call(ref(LAYOUTS, "Counted"), raw, ref(_row(signal)))

    def raw_value(self, signal: Signal, item: Expr) -> Expr:
        """The raw value that stands for a value of the model."""
        if signal.codes:
            return call(_code(signal), item)
        if isinstance(signal.type, EnumerationType):
            return call(Attribute(type_name(self.system, signal.type), "Pos"), item)
        value = call(NUMBER, item)
        return OperatorChain("-", (value, ref(_row(signal), "Offset"))) if signal.offset else value

    def stands_for(self, signal: Signal, raw: Expr, item: Expr) -> Expr:
        """Does a raw value that was received stand for a value of the model?"""
        if signal.other is not None:
            return call(_meant(signal), raw, item)
        return equal(raw, self.raw_value(signal, item))

    def has_value(self, signal: Signal, raw: Expr) -> Expr:
        """Does a raw value stand for something?"""
        if signal.other is not None:
            return TRUE
        match self._raw_values(signal):
            case [Range(low, high)] if low == high:
                return equal(raw, low)
            case values:
                return member(raw, *values)

    def _raw_values(self, signal: Signal) -> list[Choice]:
        """All raw values that stand for something."""
        if signal.codes:
            return [signed(code) for code in sorted(signal.codes)]
        if isinstance(signal.type, IntegerType):
            return [between(signal.type.first - signal.offset, signal.type.last - signal.offset)]
        return [between(0, len(signal.type.literals) - 1)]


_ORDERS = {ByteOrder.INTEL: "Intel", ByteOrder.MOTOROLA: "Motorola"}


def _frame_name(message: Message) -> str:
    return f"Frame_{ada_case(message.name)}"


def _row(signal: Signal) -> str:
    return f"Signal_{ada_case(signal.name)}"


def _meant(signal: Signal) -> str:
    return f"Stands_For_{ada_case(signal.name)}"


def _code(signal: Signal) -> str:
    return f"Code_Of_{ada_case(signal.name)}"


def place(signal: Signal) -> str:
    """Where a signal stands, in words."""
    if signal.order is ByteOrder.INTEL:
        words = f"bits {signal.start} .. {signal.start + signal.width - 1}"
    else:
        words = f"{signal.width} bits from {signal.start} on, the most significant first"
    return f"{words}, signed" if signal.signed else words
