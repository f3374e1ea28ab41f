# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""How scalars become the bits of a signal and back: the step from values to bits.

Provers treat integers and bits apart, so each step between them is a function of its own,
proved by itself. Scalars that are coded alike share one, which is named after their
type; those with a coding given in the model have their own.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from ravenchart.gen.emit.ada.declarations import Aspect, Object, Param, Subprogram
from ravenchart.gen.emit.ada.expressions import (
    TRUE,
    Attribute,
    CaseExpr,
    Expr,
    IfExpr,
    IntegerLiteral,
    OperatorChain,
    Power,
    Prefix,
    Range,
    RangeConstrained,
    between,
    bits,
    both,
    call,
    chain,
    equal,
    member,
    number,
    result,
    signed,
)
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import NUMBER, ada_case, literal, type_name
from ravenchart.gen.emit.ada.statements import Pragma, Return
from ravenchart.gen.language.terms import EnumerationType, IntegerType
from ravenchart.gen.model.signals import Signal, automatic
from ravenchart.gen.model.system import System

WORD = ref("Interfaces.Unsigned_64")
AS_BITS = "Whole_As_Bits"
"""A number in as many bits as it has: by itself, which provers are slow to see elsewhere."""


def unsigned(width: int) -> DottedName:
    """The type of so many bits."""
    return ref("Interfaces", f"Unsigned_{width}")


def container(signal: Signal) -> DottedName:
    """The smallest type of bits that holds a signal: provers work bit by bit."""
    return unsigned(next(n for n in (8, 16, 32, 64) if signal.width <= n))


def all_of(*facts: Expr) -> Expr:
    """``and then`` over facts, without those that are always so."""
    return both(*(fact for fact in facts if fact != TRUE))


def within_width(raw: Expr, signal: Signal) -> Expr | None:
    """Are the bits no more than the signal has? None: its type of bits has no more."""
    if container(signal) == unsigned(signal.width):
        return None
    return OperatorChain("<=", (raw, bits((1 << signal.width) - 1)))


def is_plain(signal: Signal) -> bool:
    """Is it coded as where nothing is given, in as many bits, wherever it stands?"""
    usual = automatic(signal.field, signal.type)
    return (signal.coding, container(signal)) == (usual.coding, container(usual))


class Coding:
    """The functions for one signal's coding.

    The value of given bits is an expression function, by which its inverse is stated. The
    coding of a type stands in the package of the codecs, that of a signal in its codec's
    package. A fixed word and one name of the model make each name, so no two are the same.
    """

    def __init__(self, system: System, signal: Signal) -> None:
        """For a signal of a codec."""
        self.system, self.signal = system, signal
        self.is_shared = is_plain(signal)
        of_type = f"Type_{ada_case(signal.type.name)}"
        self.name = of_type if self.is_shared else f"Signal_{ada_case(signal.name)}"
        self.bits_of = f"Bits_Of_{self.name}"
        self.value_of = f"Value_Of_{self.name}"
        self.ada_type = type_name(system, signal.type)
        self.container = container(signal)

    @property
    def is_wide_number(self) -> bool:
        """Does it need `as_bits`?"""
        return self.container == WORD and isinstance(self.signal.type, IntegerType)

    def valid(self, raw: Expr) -> Expr:
        """Do these bits stand for a value?"""
        low, high = self.signal.raw_range
        if self.signal.other is not None:
            return TRUE
        if self.signal.codes:
            patterns = sorted(self._pattern(code) for code in self.signal.codes)
            return member(raw, *map(signed, patterns))
        full = 1 << self.signal.width
        if low == high:  # the compiler warns of a limit that can only be met
            return equal(raw, number(low % full))
        if high - low + 1 == full and within_width(raw, self.signal) is None:
            return TRUE
        if low > 0 and high == full - 1 and within_width(raw, self.signal) is None:
            return OperatorChain(">=", (raw, number(low)))
        if low >= 0:
            if low:
                return member(raw, between(low, high))
            return OperatorChain("<=", (raw, number(high)))
        if high < 0:
            return member(raw, between(full + low, full + high))
        return member(raw, between(0, high), between(full + low, full - 1))

    def spec(self) -> Subprogram:
        """The function that gives the value of bits."""
        raw, valid = ref("Raw"), self.valid(ref("Raw"))
        return Subprogram(
            self.value_of,
            (Param("Raw", "in", self.container),),
            self.ada_type,
            aspects=() if valid == TRUE else (Aspect("Pre", valid),),
            expression=self._value(raw),
        )

    def body(self) -> Subprogram:
        """The bits of a value."""
        found = result(self.bits_of)
        survives = equal(call(self.value_of, found), ref("Item"))
        made = Subprogram(
            self.bits_of,
            (Param("Item", "in", self.ada_type),),
            self.container,
            aspects=(Aspect("Post", all_of(self.valid(found), survives)),),
        )
        if self.signal.codes:
            return replace(made, expression=CaseExpr(ref("Item"), self._by_literal()))
        if isinstance(self.signal.type, EnumerationType):
            position = call(Attribute(self.ada_type, "Pos"), ref("Item"))
            return replace(made, expression=call(self.container, position))
        #  provers go from integers to bits in steps: a number, its bits, what they count
        last: Expr = number((1 << self.signal.width) - 1)
        made_bits = self.container
        if self.is_wide_number:
            last = OperatorChain("-", (Power(2, self.signal.width), number(1)))
            made_bits = ref(AS_BITS)
        counted = RangeConstrained(NUMBER, Range(number(0), last))
        whole = Object("Whole", counted, self._whole(), constant=True)
        raw = Object("Raw", self.container, call(made_bits, ref("Whole")), constant=True)
        kept = Pragma("Assert", (equal(call(NUMBER, ref("Raw")), ref("Whole")),))
        return replace(made, declarations=(whole, raw), body=(kept, Return(ref("Raw"))))

    def _pattern(self, code: int) -> int:
        """A code as its bits."""
        return code % (1 << self.signal.width)

    def of_other(self) -> Expr:
        """The bits that are sent for the literal of all other raw values."""
        assert self.signal.other is not None
        return bits(self._pattern(int(self.signal.raw(self.signal.other))))

    def _by_literal(self, *, other_last: bool = False) -> list[tuple[DottedName, Expr]]:
        """Each literal with the bits of its code."""
        assert isinstance(self.signal.type, EnumerationType)
        found = zip(self.signal.type.literals, self.signal.codes, strict=True)
        pairs = sorted(found, key=lambda pair: other_last and pair[0] == self.signal.other)
        return [
            (literal(self.system, self.signal.type, name), number(self._pattern(code)))
            for name, code in pairs
        ]

    def _value(self, raw: Expr) -> Expr:
        """The value that bits stand for."""
        signal = self.signal
        if signal.codes:
            *first, (last, _) = self._by_literal(other_last=True)
            tests = tuple((equal(raw, code), name) for name, code in first)
            return IfExpr(tests, last) if tests else last
        if isinstance(signal.type, EnumerationType):
            return call(Attribute(self.ada_type, "Val"), raw)
        low, high = signal.raw_range
        counted = call(NUMBER, raw)
        above = _more(counted, signal.offset)
        below = _more(counted, signal.offset - (1 << signal.width))
        if low < 0 <= high:
            above = IfExpr(((OperatorChain("<=", (counted, number(high))), above),), below)
        return call(self.ada_type, below if high < 0 else above)

    def _whole(self) -> Expr:
        """The bits of a number as an integer from 0 on."""
        low, high = self.signal.raw_range
        offset = self.signal.offset
        counted = call(NUMBER, ref("Item"))
        above = _more(counted, -offset)
        below = _more(counted, (1 << self.signal.width) - offset)
        if low < 0 <= high:
            return IfExpr(((OperatorChain(">=", (counted, number(offset))), above),), below)
        return below if high < 0 else above


def as_bits() -> Subprogram:
    """`AS_BITS`."""
    whole = ref("Whole")
    return Subprogram(
        AS_BITS,
        (Param("Whole", "in", NUMBER),),
        WORD,
        aspects=(
            Aspect("Pre", OperatorChain(">=", (whole, number(0)))),
            Aspect("Post", equal(call(NUMBER, result(AS_BITS)), whole)),
        ),
        expression=call(WORD, whole),
    )


def _more(term: Expr, addend: int) -> Expr:
    """The sum, as people write it."""
    if not addend:
        return term
    return OperatorChain("+" if addend > 0 else "-", (term, number(abs(addend))))


def choice_of_value(
    system: System, signal: Signal, value: int | str
) -> DottedName | IntegerLiteral | Prefix:
    """A value of a signal's type, as a choice."""
    if isinstance(signal.type, EnumerationType):
        return literal(system, signal.type, str(value))
    return signed(int(value))


def word_bits(signal: Signal, words: Callable[[int], Expr]) -> Expr:
    """The bits of a signal, taken out of the words of a frame."""
    parts: list[Expr] = []
    for piece in signal.pieces():
        word = words(piece.word)
        if piece.start:
            word = call("Interfaces.Shift_Right", word, number(piece.start))
        part: Expr = OperatorChain("and", (word, bits((1 << piece.width) - 1)))
        parts.append(call("Interfaces.Shift_Left", part, number(piece.low)) if piece.low else part)
    whole = chain("or", parts)
    return whole if container(signal) == WORD else call(container(signal), whole)


def placed(signal: Signal, local: str, word: int) -> list[Expr]:
    """The bits of a signal where they stand in one word of the frame."""
    widened: Expr = ref(local) if container(signal) == WORD else call(WORD, ref(local))
    pieces = signal.pieces()
    parts: list[Expr] = []
    for piece in pieces:
        if piece.word != word:
            continue
        part = widened
        if len(pieces) > 1:
            if piece.low:
                part = call("Interfaces.Shift_Right", part, number(piece.low))
            part = OperatorChain("and", (part, bits((1 << piece.width) - 1)))
        parts.append(
            call("Interfaces.Shift_Left", part, number(piece.start)) if piece.start else part
        )
    return parts
