"""How scalars become the bits of a signal and back: the step from values to bits.

Provers take integers and bits apart, so each step between them is a function of its own,
proved by itself. Scalars that are coded alike share one, which is named after their
type; those with a coding given in the model have their own.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from ..model import System
from ..signals import Signal, automatic
from ..terms import EnumerationType
from .ada import (
    TRUE,
    Aspect,
    CaseExpr,
    Chain,
    Expr,
    IfExpr,
    Object,
    Param,
    Ref,
    Return,
    Subprogram,
    both,
    call,
    chain,
    equal,
    member,
    number,
)
from .naming import ada_case, type_name

WORD = "Interfaces.Unsigned_64"
NUMBER = "Ravenchart.Number"


def container(signal: Signal) -> str:
    """The smallest type of bits that holds a signal: provers work bit by bit."""
    return f"Interfaces.Unsigned_{next(n for n in (8, 16, 32, 64) if signal.width <= n)}"


def bits(value: int) -> Ref:
    """A pattern of bits."""
    return Ref(f"16#{value:X}#")


def all_of(*facts: Expr) -> Expr:
    """``and then`` over facts, without those that are always so."""
    return both(*(fact for fact in facts if fact != TRUE))


def within_width(raw: Expr, signal: Signal) -> Expr | None:
    """Are the bits no more than the signal has? None: its type of bits has no more."""
    if container(signal) == f"Interfaces.Unsigned_{signal.width}":
        return None
    return Chain("<=", (raw, bits((1 << signal.width) - 1)))


def is_plain(signal: Signal) -> bool:
    """Is it coded as where nothing is given, wherever it stands?"""
    return signal.coding == automatic(signal.field, signal.type).coding


class Coding:
    """What is emitted for one signal's coding; ``owner`` names the codec it belongs to."""

    def __init__(self, system: System, signal: Signal, owner: str) -> None:
        """For a signal of the codec of that name."""
        self.system, self.signal = system, signal
        of_type = ada_case(signal.type.name)
        self.name = of_type if is_plain(signal) else f"{owner}_{ada_case(signal.name)}"
        self.bits_of = f"Bits_Of_{self.name}"
        self.value_of = f"{self.name}_Of_Bits"
        self.code_of = f"Code_Of_{self.name}"
        self.ada_type = type_name(system, signal.type)
        self.container = container(signal)

    def raw_integer(self, value: str) -> Expr:
        """The bits of ``value`` as an integer from 0 on."""
        if self.signal.codes:
            return call(self.code_of, Ref(value))
        if isinstance(self.signal.type, EnumerationType):
            return call(f"{self.ada_type}'Pos", Ref(value))
        counted = call(NUMBER, Ref(value))
        offset = self.signal.offset
        raw: Expr = Chain("-", (counted, number(offset))) if offset else counted
        low, high = self.signal.raw_range
        if low >= 0:
            return raw
        below = Chain("+", (raw, number(1 << self.signal.width)))
        if high < 0:
            return below
        return IfExpr(((Chain(">=", (raw, number(0))), raw),), below)

    def valid(self, raw: Expr) -> Expr:
        """Do these bits stand for a value?"""
        low, high = self.signal.raw_range
        if high - low + 1 == 1 << self.signal.width and within_width(raw, self.signal) is None:
            return TRUE
        if self.signal.codes:
            patterns = sorted(self._pattern(code) for code in self.signal.codes)
            return member(raw, " | ".join(f"{pattern:_}" for pattern in patterns))
        if not self.signal.signed:
            below = Chain("<=", (raw, number(high)))
            return both(Chain(">=", (raw, number(low))), below) if low else below
        full, last = 1 << self.signal.width, (1 << self.signal.width) - 1
        if high < 0:
            return member(raw, f"{full + low:_} .. {full + high:_}")
        positive = f"{max(low, 0):_} .. {high:_}"
        return member(raw, positive if low >= 0 else f"{positive} | {full + low:_} .. {last:_}")

    def spec(self) -> list[Subprogram]:
        """What the specs of codecs speak of: codes."""
        if not self.signal.codes:
            return []
        return [
            Subprogram(
                self.code_of,
                (Param("Item", "in", self.ada_type),),
                NUMBER,
                expression=CaseExpr(Ref("Item"), tuple(self._by_literal())),
            )
        ]

    def _pattern(self, code: int) -> int:
        """A code as its bits."""
        return code % (1 << self.signal.width)

    def _by_literal(self) -> list[tuple[str, Expr]]:
        """Each literal with the bits of its code."""
        assert isinstance(self.signal.type, EnumerationType)
        pairs = zip(self.signal.type.literals, self.signal.codes, strict=True)
        return [
            (literal_name(self.system, self.signal, name), number(self._pattern(code)))
            for name, code in pairs
        ]

    def functions(self) -> tuple[Subprogram, Subprogram]:
        """To the bits and back, for the body."""
        return self._bits(), self._value()

    def _bits(self) -> Subprogram:
        result = Ref(f"{self.bits_of}'Result")
        raw = self.raw_integer("Item")
        taken: Expr = call(self.container, raw)
        if self.signal.codes:
            taken = CaseExpr(Ref("Item"), tuple(self._by_literal()))
        same = equal(call(NUMBER, result), raw)
        made = Subprogram(
            self.bits_of,
            (Param("Item", "in", self.ada_type),),
            self.container,
            aspects=(Aspect("Post", all_of(self.valid(result), same)),),
        )
        if not isinstance(raw, IfExpr):
            return replace(made, expression=taken)
        #  bits of one number: of two, provers lose what they stand for
        whole = Object("Whole", f"{NUMBER} range 0 .. {self._last:_}", raw, constant=True)
        back = Return(call(self.container, Ref("Whole")))
        return replace(made, declarations=(whole,), body=(back,))

    @property
    def _last(self) -> int:
        """The highest pattern."""
        return (1 << self.signal.width) - 1

    def _value(self) -> Subprogram:
        signal = self.signal
        bits_ = call(NUMBER, Ref("Raw"))
        if signal.codes:
            *first, (last, _) = self._by_literal()
            tests = tuple((equal(Ref("Raw"), code), Ref(name)) for name, code in first)
            result: Expr = IfExpr(tests, Ref(last)) if tests else Ref(last)
        elif isinstance(signal.type, EnumerationType):
            result = call(f"{self.ada_type}'Val", Ref("Raw"))
        else:
            result = call(self.ada_type, self._whole(bits_))
        back, valid = self.raw_integer(f"{self.value_of}'Result"), self.valid(Ref("Raw"))
        return Subprogram(
            self.value_of,
            (Param("Raw", "in", self.container),),
            self.ada_type,
            aspects=(
                *([] if valid == TRUE else [Aspect("Pre", valid)]),
                Aspect("Post", equal(bits_, back)),
            ),
            expression=result,
        )

    def _whole(self, raw: Expr) -> Expr:
        """The value that bits stand for, given as an integer from 0 on."""
        low, high = self.signal.raw_range
        offset, full = self.signal.offset, 1 << self.signal.width
        above = Chain("+", (raw, number(offset))) if offset else raw
        if low >= 0:
            return above
        below = Chain("+", (raw, number(offset - full)))
        if high < 0:
            return below
        return IfExpr(((Chain("<=", (raw, number(high))), above),), below)


def literal_name(system: System, signal: Signal, value: int | str) -> str:
    """A value of a signal's type, as a choice."""
    if not isinstance(signal.type, EnumerationType):
        return f"{int(value):_}"
    name = ada_case(str(value))
    return name if signal.type.name == "Boolean" else f"{ada_case(system.name)}.{name}"


def word_bits(signal: Signal, words: Callable[[int], str]) -> Expr:
    """The bits of a signal, taken out of the words of a frame."""
    parts: list[Expr] = []
    for piece in signal.pieces():
        word = words(piece.word)
        shifted = f"Interfaces.Shift_Right ({word}, {piece.start})" if piece.start else word
        part: Expr = Ref(f"{shifted} and 16#{(1 << piece.width) - 1:X}#")
        parts.append(call("Interfaces.Shift_Left", part, number(piece.low)) if piece.low else part)
    if len(parts) > 1:
        parts = [Ref(f"({p.text})") if isinstance(p, Ref) else p for p in parts]
    whole = chain("or", parts)
    return whole if container(signal) == WORD else call(container(signal), whole)


def placed(signal: Signal, local: str, word: int) -> list[Expr]:
    """The bits of a signal where they stand in one word of the frame."""
    widened: Expr = Ref(local) if container(signal) == WORD else call(WORD, Ref(local))
    pieces = signal.pieces()
    parts: list[Expr] = []
    for piece in pieces:
        if piece.word != word:
            continue
        part = widened
        if len(pieces) > 1:
            if piece.low:
                part = call("Interfaces.Shift_Right", part, number(piece.low))
            part = Chain("and", (part, bits((1 << piece.width) - 1)))
        parts.append(
            call("Interfaces.Shift_Left", part, number(piece.start)) if piece.start else part
        )
    return parts
