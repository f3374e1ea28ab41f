# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Conditions that nothing can change, and operators without an effect: refused, or left out."""

from __future__ import annotations

import pytest

from ravenchart.gen.language.terms import Literal, Operation
from tests.unit.gen.test_expressions import checked, refused, tree


@pytest.mark.parametrize(
    ("text", "column"),
    [
        ("1 = 1", 2),
        ("2 < 3", 2),
        ("length > 5 and 2 < 3", 17),
        ("length * 0 = 0", 11),
        ("if 1 = 1 then length else 4", 5),
        ("length = length", 7),
        ("colour /= colour", 7),
        ("length + 1 > length + 1", 11),
        ("true = false", 5),
    ],
)
def test_comparison_that_reads_nothing_or_itself_is_refused(text: str, column: int) -> None:
    assert refused(text) == ("RV-0417", column)


@pytest.mark.parametrize(
    ("text", "kept"),
    [
        ("not not (length > 5)", (">", "length", 5)),
        ("done = true", "done"),
        ("done /= true", ("not", "done")),
        ("false = done", ("not", "done")),
        ("not (done = false)", "done"),
        ("done and true", "done"),
        ("false or done", "done"),
        ("if done then true else false", "done"),
        ("if done then 3 else 3", 3),
        ("if true then length else other", "length"),
        ("abs(count)", "count"),
        ("abs(abs(length))", ("abs", "length")),
        ("-(-length)", "length"),
        ("length * 0", 0),
        ("2 * 3 + length", ("+", 6, "length")),
    ],
)
def test_operator_without_an_effect_is_left_out(text: str, kept: object) -> None:
    assert tree(checked(text).expression) == kept


def test_a_folded_number_keeps_its_unit() -> None:
    found = checked("length * 0")
    assert (found.expression, found.unit, found.bounds) == (Literal(0, None), "mm", (0, 0))


def test_comparison_that_ranges_alone_decide_is_kept() -> None:
    assert isinstance(checked("abs(length) >= 0").expression, Operation)
