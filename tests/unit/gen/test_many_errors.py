# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Of very many errors the first are printed, and the others are counted."""

from __future__ import annotations

from ravenchart.gen.diagnostics import MOST, error, render_all
from ravenchart.gen.origins import Origin


def test_the_first_of_many_errors_are_printed_and_the_rest_is_counted() -> None:
    found = [error("RV-1005", Origin("e.yaml", n, 1), f"wrong {n}") for n in range(1, 2_001)]
    lines = render_all(found, {}).splitlines()
    assert lines[0] == "e.yaml:1:1: error: wrong 1 [RV-1005]"
    assert lines[MOST - 1] == f"e.yaml:{MOST}:1: error: wrong {MOST} [RV-1005]"
    assert lines[MOST:] == ["1,900 more errors or warnings are not shown"]


def test_a_few_errors_are_all_printed() -> None:
    found = [error("RV-1005", Origin("e.yaml", n, 1), "wrong") for n in range(1, MOST + 1)]
    assert len(render_all(found, {}).splitlines()) == MOST


def test_a_name_that_is_not_declared_is_printed_once_with_its_other_uses() -> None:
    places = [Origin("e.yaml", n, 3) for n in range(1, 8)]
    found = [error("RV-0305", place, "there is no type named `Level`") for place in places]
    other = error("RV-0305", Origin("e.yaml", 9, 1), "there is no type named `Speed`")
    assert render_all([*found, other], {}).splitlines() == [
        "e.yaml:1:3: error: there is no type named `Level` [RV-0305]",
        "e.yaml:1:3: note: also at e.yaml:2:3, e.yaml:3:3, e.yaml:4:3, e.yaml:5:3 and 2 more",
        "e.yaml:9:1: error: there is no type named `Speed` [RV-0305]",
    ]
    assert "note" not in render_all([found[0], other], {})
