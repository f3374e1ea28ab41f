# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Expressions as they are printed: parentheses where Ada asks for them, and filled lines."""

from __future__ import annotations

import pytest

from ravenchart.gen.emit.ada.expression_text import expr_layout
from ravenchart.gen.emit.ada.expressions import Expr, OperatorChain, Prefix, Range, call, member
from ravenchart.gen.emit.ada.layout import laid_out
from ravenchart.gen.emit.ada.named import ref

A, B, C = ref("A"), ref("B"), ref("C")


def _both(operator: str, left: Expr, right: Expr) -> OperatorChain:
    return OperatorChain(operator, (left, right))


@pytest.mark.parametrize(
    ("made", "text"),
    [
        (_both("*", _both("/", _both("+", A, B), C), A), "(A + B) / C * A"),
        (_both("/", A, _both("*", B, C)), "A / (B * C)"),
        (_both("*", A, _both("/", B, C)), "A * (B / C)"),
        (_both("-", A, _both("+", B, C)), "A - (B + C)"),
        (_both("-", _both("+", A, B), C), "A + B - C"),
        (_both("+", A, _both("-", B, C)), "A + (B - C)"),
        (_both("**", A, _both("*", B, C)), "A ** (B * C)"),
        (_both(">", _both("+", A, B), _both("*", B, C)), "A + B > B * C"),
        (_both("=", _both("=", A, B), C), "(A = B) = C"),
        (_both("and then", _both("or else", A, B), C), "(A or else B) and then C"),
        (_both("and then", _both("and then", A, B), C), "(A and then B) and then C"),
        (_both("or else", member(A, Range(B, C)), B), "A in B .. C or else B"),
        (Prefix("not", _both("=", A, B)), "not (A = B)"),
        (Prefix("-", _both("*", A, B)), "-(A * B)"),
        (_both("*", Prefix("-", A), B), "(-A) * B"),
        (_both("&", A, _both("&", B, C)), "A & (B & C)"),
    ],
)
def test_parentheses_stand_where_the_precedence_asks_for_them(made: Expr, text: str) -> None:
    assert laid_out(expr_layout(made), 76) == text


def test_operands_and_positional_arguments_fill_lines() -> None:
    names = [ref(f"Name_{n}") for n in range(8)]
    assert laid_out(expr_layout(OperatorChain("+", tuple(names))), 40) == (
        "Name_0 + Name_1 + Name_2 + Name_3\n+ Name_4 + Name_5 + Name_6 + Name_7"
    )
    assert laid_out(expr_layout(call("Sum_Of", *names)), 40) == (
        "Sum_Of (Name_0, Name_1, Name_2, Name_3,\n   Name_4, Name_5, Name_6, Name_7)"
    )
