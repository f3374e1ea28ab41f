# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Expressions: grammar, types, literals, units and bounds."""

from __future__ import annotations

import pytest

from ravenchart.gen.files.located import TextPlace
from ravenchart.gen.language.expressions import Malformed, Term, parse
from ravenchart.gen.language.intervals import apply, quotient
from ravenchart.gen.language.names import Findings, NameScope
from ravenchart.gen.language.terms import (
    BOOLEAN,
    BUILT_IN,
    EnumerationType,
    Expression,
    Field,
    InState,
    IntegerType,
    Literal,
    Name,
    Operation,
    PortTest,
    Reading,
    RecordType,
    Type,
)
from ravenchart.gen.origins import Origin
from ravenchart.gen.resolve.typed import fitting, read_expression
from ravenchart.gen.resolve.vocabulary import CheckedExpression, Vocabulary

PLACE = TextPlace(Origin("m.yaml", 7, 11), exact=True)
LENGTH = IntegerType("Length", BUILT_IN, -100, 100, "mm")
SPEED = IntegerType("Speed", BUILT_IN, -10, 10, "mm/s")
COUNT = IntegerType("Count", BUILT_IN, 1, 5, None)
COLOUR = EnumerationType("Colour", BUILT_IN, ("Red", "Green"))
SIGN = EnumerationType("Sign", BUILT_IN, ("Red", "Stop"))
POSE = RecordType(
    "Pose", BUILT_IN, (Field("x", BUILT_IN, LENGTH), Field("colour", BUILT_IN, COLOUR))
)


def vocabulary() -> Vocabulary:
    """A few names of every kind."""
    readable: NameScope[tuple[Reading, str, Type]] = NameScope("name")
    for kind, name, type_ in (
        (Reading.DATA, "length", LENGTH),
        (Reading.DATA, "other", LENGTH),
        (Reading.DATA, "done", BOOLEAN),
        (Reading.DATA, "colour", COLOUR),
        (Reading.PARAMETER, "count", COUNT),
        (Reading.PARAMETER, "speed", SPEED),
        (Reading.PORT, "pose", POSE),
    ):
        readable.declare(name, None, (kind, name, type_))
    inputs: NameScope[str] = NameScope("input port")
    inputs.declare("pose", None, "pose")
    states: NameScope[str] = NameScope("state of Motion")
    states.declare("Idle", None, "Idle")
    regions: NameScope[NameScope[str]] = NameScope("region")
    regions.declare("Motion", None, states)
    return Vocabulary(readable, inputs, regions, frozenset(("red", "green", "stop")))


def checked(text: int | bool | str) -> CheckedExpression:
    """The sound expression that a text stands for."""
    findings = Findings()
    result = read_expression(text, PLACE, vocabulary(), findings)
    assert result is not None, findings.items
    assert findings.items == []
    return result


def refused(text: str) -> tuple[str, int]:
    """The code of the one error in a text, and its column in the text."""
    findings = Findings()
    assert read_expression(text, PLACE, vocabulary(), findings) is None
    assert len(findings.items) == 1, findings.items
    return findings.items[0].code, findings.items[0].origin.column - PLACE.origin.column


def tree(expression: Expression) -> object:
    """An expression as nested tuples, short enough to compare."""
    match expression:
        case Operation(operator=operator, operands=operands):
            return (operator, *(tree(operand) for operand in operands))
        case Name(name=name, field=None):
            return name
        case Name(name=name, field=field):
            return f"{name}.{field}"
        case Literal(value=value):
            return value
        case InState(region, state):
            return f"in {region}.{state}"
        case PortTest(port, state):
            return f"{state} {port}"


# --- Grammar -------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("length + 2 * other", ("+", "length", ("*", 2, "other"))),
        ("length - other - 1", ("-", ("-", "length", "other"), 1)),
        ("-length + 1", ("+", ("neg", "length"), 1)),
        ("- 5", -5),
        ("-(length)", ("neg", "length")),
        ("0x10 + 1_000", 1016),
        ("done or done and not done", ("or", "done", ("and", "done", ("not", "done")))),
        ("(done or done) and done", ("and", ("or", "done", "done"), "done")),
        ("not length < 3", ("not", ("<", "length", 3))),
        ("pose.x /= 0", ("/=", "pose.x", 0)),
        ("POSE.X = 0", ("=", "pose.x", 0)),
        ("fresh(pose) and not in(Motion.Idle)", ("and", "fresh pose", ("not", "in Motion.Idle"))),
        ("not in(motion.idle)", ("not", "in Motion.Idle")),
        ("clamp(length, 0, 5)", ("clamp", "length", 0, 5)),
        ("if done then 1 else if done then 2 else 3", ("if", "done", 1, ("if", "done", 2, 3))),
        ("length\n  + 1", ("+", "length", 1)),
        ("index_of", None),
    ],
)
def test_operators_bind_as_the_reference_says(text: str, expected: object) -> None:
    if expected is None:
        assert refused(text)[0] == "RV-0403"
    else:
        assert tree(checked(text).expression) == expected


def test_number_and_boolean_stand_for_themselves() -> None:
    assert checked(5).expression == Literal(5, None)
    assert checked(-5).expression == Literal(-5, None)
    assert checked(True).expression == Literal("True", BOOLEAN)
    assert checked("false").expression == Literal("False", BOOLEAN)


@pytest.mark.parametrize(
    ("text", "at"),
    [
        ("length +", 7),
        ("(length", 6),
        ("length < 1 < 2", 11),
        ("length == 1", 8),
        ("length != 1", 7),
        ("done && done", 5),
        ("1.5", 1),
        ("length length", 7),
        ("done ordone", 5),
        ("done and if done then done else done", 9),
        ("min(1,)", 6),
        ("if done then 1", 13),
        ("in(Motion)", 9),
        ("", 0),
        ("é", 0),
    ],
)
def test_malformed_expression_is_refused_where_it_goes_wrong(text: str, at: int) -> None:
    found = parse(text)
    assert isinstance(found, Malformed)
    assert (found.code, found.at) == ("RV-0401", at)


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("a == b", "equality is `=`"),
        ("a != b", "inequality is `/=`"),
        ("a && b", "write `and`"),
        ("a % b", "there is no remainder operator"),
        ("a mod b = 0", "there is no remainder operator"),
        ("a modus", None),
    ],
)
def test_operator_of_another_language_is_answered_with_ours(text: str, hint: str | None) -> None:
    found = parse(text)
    assert isinstance(found, Malformed)
    assert found.hint == hint


@pytest.mark.parametrize(
    "text", ["not " * 61 + "a", "-" * 400 + "1", "1" + "+1" * 200, "1+" * 2000 + "1"]
)
def test_long_and_deep_expressions_are_refused(text: str) -> None:
    found = parse(text)
    assert isinstance(found, Malformed)
    assert found.code == "RV-0402"


def test_parentheses_do_not_count_as_depth() -> None:
    assert isinstance(parse("(" * 500 + "a" + ")" * 500), Term)


# --- Types and literals ----------------------------------------------------------


def test_literal_takes_the_type_of_the_other_operand() -> None:
    for text in ("colour = Red", "Red = colour", "colour = (if done then Red else Green)"):
        operation = checked(text).expression
        assert isinstance(operation, Operation)
        assert operation.type is BOOLEAN
        assert "Sign" not in repr(operation)


def test_literal_goes_before_a_name_of_another_type() -> None:
    words = vocabulary()
    words.readable.declare("red", None, (Reading.DATA, "red", LENGTH))
    findings = Findings()
    found = read_expression("colour = Red", PLACE, words, findings)
    assert found is not None
    assert tree(found.expression) == ("=", "colour", "Red")


def test_literal_is_given_back_as_declared() -> None:
    assert tree(checked("colour = RED").expression) == ("=", "colour", "Red")


def test_literal_takes_the_type_of_its_target() -> None:
    findings = Findings()
    value = fitting("if done then Red else Stop", PLACE, "sign", SIGN, vocabulary(), findings)
    assert isinstance(value, Operation)
    assert value.type is SIGN


@pytest.mark.parametrize(
    ("text", "code", "at"),
    [
        ("Red = Green", "RV-0410", 6),
        ("colour = Stop", "RV-0410", 9),
        ("colour < Green", "RV-0404", 0),
        ("length = colour", "RV-0404", 7),
        ("length and done", "RV-0404", 0),
        ("not 5", "RV-0404", 4),
        ("done + 1", "RV-0404", 0),
        ("pose = pose", "RV-0404", 5),
        ("pose + 1", "RV-0404", 0),
        ("length.x = 1", "RV-0403", 0),
        ("pose.y = 1", "RV-0403", 0),
        ("lenght = 1", "RV-0403", 0),
        ("fresh(length)", "RV-0305", 6),
        ("fresh(pose.x)", "RV-0404", 6),
        ("in(Motion.Busy)", "RV-0305", 3),
        ("in(Movement.Idle)", "RV-0305", 3),
        ("sqrt(length)", "RV-0409", 0),
        ("abs(1, 2)", "RV-0409", 0),
        ("abs()", "RV-0409", 0),
        ("if length then 1 else 2", "RV-0404", 3),
        ("if done then 1 else done", "RV-0404", 3),
    ],
)
def test_wrong_operand_is_refused_where_it_stands(text: str, code: str, at: int) -> None:
    if text in ("colour < Green", "length = colour", "pose = pose"):
        assert refused(text)[0] == code
    else:
        assert refused(text) == (code, at)


def test_errors_of_both_operands_are_reported() -> None:
    findings = Findings()
    assert read_expression("lenght < 1 and cuont < 1", PLACE, vocabulary(), findings) is None
    assert [item.hint for item in findings.items] == [
        "did you mean `length`?",
        "did you mean `count`?",
    ]


def test_text_in_several_lines_is_located_at_its_beginning() -> None:
    findings = Findings()
    read_expression(
        "length +\n lenght", TextPlace(PLACE.origin, exact=False), vocabulary(), findings
    )
    assert findings.items[0].origin == PLACE.origin


# --- Units -----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "unit"),
    [
        ("length + other", "mm"),
        ("length + 1", "mm"),
        ("2 + length", "mm"),
        ("length * count", "mm"),
        ("2 * length", "mm"),
        ("length / count", "mm"),
        ("abs(length)", "mm"),
        ("max(1, length)", "mm"),
        ("if done then 0 else length", "mm"),
        ("count * count", None),
        ("-speed", "mm/s"),
    ],
)
def test_unit_of_a_result_is_that_of_its_operands(text: str, unit: str | None) -> None:
    assert checked(text).unit == unit


@pytest.mark.parametrize(
    "text",
    [
        "length + speed",
        "length + count",
        "length = speed",
        "min(length, speed)",
        "clamp(length, 0, speed)",
        "length * speed",
        "length / (length + 200)",
        "count / (length + 200)",
        "if done then length else speed",
    ],
)
def test_different_units_are_refused(text: str) -> None:
    assert refused(text)[0] == "RV-0405"


def test_unit_of_the_target_is_checked() -> None:
    for text, code in (("speed", "RV-0405"), ("count", "RV-0405"), ("5", None)):
        findings = Findings()
        fitting(text, PLACE, "length", LENGTH, vocabulary(), findings)
        assert [item.code for item in findings.items] == ([] if code is None else [code])


# --- Bounds ----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "bounds"),
    [
        ("length + other", (-200, 200)),
        ("length - 5", (-105, 95)),
        ("-length", (-100, 100)),
        ("count * count", (1, 25)),
        ("length * -3", (-300, 300)),
        ("length / count", (-100, 100)),
        ("length / -3", (-33, 33)),
        ("abs(length)", (0, 100)),
        ("abs(count)", (1, 5)),
        ("min(length, 0)", (-100, 0)),
        ("max(length, 0)", (0, 100)),
        ("clamp(length, 0, 50)", (0, 50)),
        ("clamp(length, -500, 500)", (-100, 100)),
        ("if done then length else 500", (-100, 500)),
        ("if length < 10 then length else 0", (-100, 9)),
        ("if length <= 10 then 0 else length", (0, 100)),
        ("if length >= 0 and length < 10 then length else 0", (0, 9)),
        ("if length < 0 or length > 10 then 0 else length", (0, 10)),
        ("if not (length < 0) then length else 0", (0, 100)),
        ("if 5 > length then length else 0", (-100, 4)),
        ("if length = 7 then length else 0", (0, 7)),
        ("if count /= 1 then count else 3", (2, 5)),
        ("if length > other then length else other", (-100, 100)),
        ("if length < -500 then length else 0", (-100, 100)),
    ],
)
def test_bounds_hold_every_value_and_no_more(text: str, bounds: tuple[int, int]) -> None:
    found = checked(text)
    assert found.bounds == bounds
    if isinstance(found.expression, Operation):
        assert (found.expression.low, found.expression.high) == bounds


def test_division_rounds_towards_zero() -> None:
    assert [quotient(a, b) for a, b in ((7, 2), (-7, 2), (7, -2), (-7, -2))] == [3, -3, -3, 3]
    assert apply("/", ((-7, 7), (2, 3))) == (-3, 3)


@pytest.mark.parametrize("text", ["1 / length", "1 / 0", "count / (count - 3)"])
def test_divisor_that_may_be_zero_is_refused(text: str) -> None:
    findings = Findings()
    assert read_expression(text, PLACE, vocabulary(), findings) is None
    assert findings.items[0].code in ("RV-0405", "RV-0406")


def test_condition_that_excludes_zero_allows_the_division() -> None:
    assert checked("count /= 1 and 6 / (count - 1) > 1").type is BOOLEAN
    assert checked("if count > 1 then 6 / (count - 1) else 0").bounds == (0, 6)


def test_result_over_64_bits_is_refused() -> None:
    assert refused("9223372036854775807 + length")[0] == "RV-0408"
    assert refused("9223372036854775808")[0] == "RV-0408"


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("length + 1", "limit it, for example by `min(length + 1, 100)`"),
        ("length - 1", "limit it, for example by `max(length - 1, -100)`"),
        ("2 * length", "limit it, for example by `clamp(2 * length, -100, 100)`"),
        ("500", None),
    ],
)
def test_value_that_may_leave_its_target_is_refused_with_a_remedy(
    text: str, hint: str | None
) -> None:
    findings = Findings()
    assert fitting(text, PLACE, "length", LENGTH, vocabulary(), findings) is None
    assert [(item.code, item.hint) for item in findings.items] == [("RV-0407", hint)]
    if hint is not None:
        remedy = hint.split("`")[1]
        assert fitting(remedy, PLACE, "length", LENGTH, vocabulary(), findings) is not None
