# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""docs/faults.md says what the tests say."""

from __future__ import annotations

import ast

import pytest

from tests.support.faults import PAGE, ROOT, Row, page, rows


def test_the_page_is_what_the_tests_say() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(), "run `make docs`"


@pytest.mark.parametrize("row", rows(), ids=lambda row: row.test)
def test_a_row_is_complete_and_its_test_can_fail(row: Row) -> None:
    assert row.fault and row.found_by and row.reaction
    assert "|" not in "".join((row.fault, row.found_by, row.reaction, row.within))
    file, _, name = row.test.partition("::")
    tree = ast.parse((ROOT / file).read_text(encoding="utf-8"))
    (test,) = (n for n in tree.body if isinstance(n, ast.FunctionDef) and n.name == name)
    judged = [n for n in ast.walk(test) if isinstance(n, ast.Assert) or _calls_a_judge(n)]
    assert judged, f"{row.test} asserts nothing"


def _calls_a_judge(node: ast.AST) -> bool:
    """A helper of the test's own file that asserts."""
    return isinstance(node, ast.Call) and ast.unparse(node.func) == "played"


def test_the_matrix_has_every_kind_of_fault() -> None:
    text = " ".join(row.fault for row in rows())
    kinds = ("task", "loop", "stack", "dominant", "recessive", "cut", "queue", "bench", "frames")
    assert [kind for kind in kinds if kind not in text] == []
