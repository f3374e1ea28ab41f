# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Breaks outside the regions: ceilings, the timing certificate, codecs, frames."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.emit.ada.declarations import GenericInstance, Object, Unit
from ravenchart.gen.emit.ada.expressions import (
    Arg,
    Call,
    Expr,
    IntegerLiteral,
    Membership,
    OperatorChain,
    bits,
    number,
)
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.certificate.certified import CERTIFICATE
from ravenchart.gen.model.signals import FD_SIZES

from .mutants import Broken, Units
from .nodes import Body, Spot, bodies, following, put, whole

_CEILINGS = ("Ceiling", "Transmit_Ceiling", "Receive_Ceiling")
_SHIFTS = ref("Interfaces.Shift_Left"), ref("Interfaces.Shift_Right")
_OTHERS = (
    ("format", ref("Ravenchart.Can.Standard"), ref("Ravenchart.Can.Extended")),
    *(
        ("family", ref("Ravenchart.Can.Any_Frames", one), ref("Ravenchart.Can.Any_Frames", other))
        for one, other in (("Classic", "Flexible"),)
    ),
    (
        "rate",
        ref("Ravenchart.Can.Fd_Frames.Constant_Rate"),
        ref("Ravenchart.Can.Fd_Frames.Switched_Rate"),
    ),
)
"""What is said of a frame besides its identifier and its length."""


def args_named(inside: Spot[object], *names: str) -> Iterator[Spot[Arg]]:
    """The associations with a parameter or component of one of these names."""
    return (one for one in inside.within(Arg) if one.node.name in names)


def ceiling(file: str, units: Units) -> Iterator[Broken]:
    """A protected object whose ceiling is one too low."""
    for instance in whole(units[file]).within(GenericInstance):
        for arg in args_named(instance, *_CEILINGS):
            match arg.node.value:
                case OperatorChain("+", (_, IntegerLiteral(level))):
                    lower = number(level - 1)
                    yield instance.node.name, "lower", put(arg.at("value", "operands", 1), lower)


def certificates(units: Units) -> list[Unit]:
    """The certificates of a program: each of its nodes has one."""
    return [unit for unit in units.values() if unit.name.last == CERTIFICATE]


def stated(units: Units) -> dict[str, int]:
    """The numbers that certificates state as they are, by their names."""
    return {
        one.node.name: one.node.value.value
        for unit in certificates(units)
        for one in whole(unit).within(Object)
        if isinstance(one.node.value, IntegerLiteral)
    }


def certificate(file: str, units: Units) -> Iterator[Broken]:
    """A claimed response time, a budget or a deadline that does not hold."""
    known = stated({file: units[file]})
    for one in whole(units[file]).within(Object):
        own, _, what = one.node.name.rpartition("_")
        if one.node.name not in known:
            continue
        value = one.at("value")
        if what == "R":
            yield own, "bound", put(value, number(known[one.node.name] - 1))
        elif what == "D" and f"{own}_R" in known:
            yield own, "deadline", put(value, number(known[f"{own}_R"] - 1))
        elif what == "Budget":
            yield own, "budget", put(value, number(known[one.node.name] + 1))


# --- codecs


def codec_in_code(file: str, units: Units) -> Iterator[Broken]:
    """A field at another bit, a value by another offset."""
    for one in bodies(units[file]):
        if one.is_expression:
            yield from _places(one)
        if one.name.startswith("Bits_Of_"):
            yield from _offsets(one)


def codec_declared(file: str, units: Units) -> Iterator[Broken]:
    """A field that is declared at another bit or of another width."""
    for one in bodies(units[file]):
        if one.is_expression:
            yield from _places(one)
            for chain in one.inner.within(OperatorChain):
                match chain.node:
                    case OperatorChain("and", (_, IntegerLiteral(value, 16))):
                        yield one.name, "width", put(chain.at("operands", 1), bits(value >> 1))


def _places(one: Body) -> Iterator[Broken]:
    """The bit where something stands is the next one."""
    for call in one.inner.within(Call):
        match call.node:
            case Call(name, (_, Arg(None, IntegerLiteral(by)))) if name in _SHIFTS:
                yield one.name, "bit", put(call.at("args", 1, "value"), number(by + 1))


def _offsets(one: Body) -> Iterator[Broken]:
    """What is added to or taken from a value is one more."""
    for chain in one.spot.within(OperatorChain):
        if chain.node.operator in ("+", "-"):
            for place, operand in enumerate(chain.node.operands[1:], 1):
                if isinstance(operand, IntegerLiteral):
                    more = number(operand.value + 1)
                    yield one.name, "offset", put(chain.at("operands", place), more)


# --- frames


def frame_in_code(file: str, units: Units) -> Iterator[Broken]:
    """A frame that is sent or expected with another identifier, format, length or bit rate."""
    own = bodies(units[file])
    made = [ref(one.name) for one in own if one.name.startswith("Frame_Of_")]
    for one in own:
        if one.name.startswith("Send_"):
            for call in one.spot.within(Call):
                if (other := following(call.node.name, made)) is not None:
                    yield one.name, "message", put(call.at("name"), other)
        whole_frames = [
            call for call in one.inner.within(Call) if _last(call.node) == "Whole_Frame"
        ]
        if whole_frames:
            yield from _frames(units, one.name, one.inner, *_by_name(one.inner))
        elif one.name == "Run_Receive":
            yield from _frames(units, one.name, one.inner, _asked(one), _carried(one))
        elif one.name == "Accepts":
            yield from _identifiers(units, one.name, _accepted(one))


def frame_declared(file: str, units: Units) -> Iterator[Broken]:
    """A row of the layout table that says so of a frame."""
    for one in whole(units[file]).within(Object):
        if one.node.type == ref("Row_Of_Frame"):
            yield from _frames(units, one.node.name, one, *_by_name(one))


def _last(call: Call) -> str:
    return call.name.last if isinstance(call.name, DottedName) else ""


def _by_name(where: Spot[object]) -> tuple[list[Spot[Expr]], list[Spot[Expr]]]:
    """The identifiers and the lengths that are given by the names of components."""
    ids, lengths = (
        [arg.at("value") for arg in args_named(where, name)] for name in ("Id", "Length")
    )
    return ids, lengths


def _asked(one: Body) -> list[Spot[Expr]]:
    """The identifiers with which that of a frame is compared."""
    return [
        chain.at("operands", 1)
        for chain in one.inner.within(OperatorChain)
        if chain.node.operator == "="
        and isinstance(left := chain.node.operands[0], Call)
        and _last(left) == "Id"
    ]


def _carried(one: Body) -> list[Spot[Expr]]:
    """The lengths that a frame must have."""
    return [
        call.at("args", 2, "value")
        for call in one.inner.within(Call)
        if _last(call.node) == "Carries"
    ]


def _accepted(one: Body) -> list[Spot[Expr]]:
    """The identifiers that a filter lets in, of which each test has some."""
    tests = one.inner.within(Membership)
    return [test.at("among", "choices", 0) for test in tests if test.node.item == ref("Id")]


def _number(units: Units, shown: Expr) -> int:
    """A literal's value, or that of a fact of the certificate."""
    if isinstance(shown, IntegerLiteral):
        return shown.value
    assert isinstance(shown, DottedName)
    return stated(units)[shown.last]


def _frames(
    units: Units,
    place: str,
    where: Spot[object],
    identifiers: list[Spot[Expr]],
    lengths: list[Spot[Expr]],
) -> Iterator[Broken]:
    yield from _identifiers(units, place, identifiers)
    for length in lengths:
        at = FD_SIZES.index(_number(units, length.node))
        if at > 0:
            yield place, "short", put(length, number(FD_SIZES[at - 1]))
        if at + 1 < len(FD_SIZES):
            yield place, "long", put(length, number(FD_SIZES[at + 1]))
    for what, *both in _OTHERS:
        for name in where.within(DottedName):
            if (other := following(name.node, both)) is not None:
                yield place, what, put(name, other)


def _identifiers(units: Units, place: str, found: list[Spot[Expr]]) -> Iterator[Broken]:
    for spot in found:
        yield place, "identifier", put(spot, number(_number(units, spot.node) ^ 1))
