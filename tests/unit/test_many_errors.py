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
