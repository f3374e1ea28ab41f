"""Each correction is applied: the wrong model gives its code, the corrected one checks clean."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.building import checking
from ravenchart.failures import Refused
from ravenchart.gen.diagnostics import CODES, render_all
from ravenchart.gen.emit.clashes import clashes
from ravenchart.gen.explanations import WIDTH, edited, explanations, text

WITHOUT = (
    "RV-0101",
    "RV-0102",
    "RV-0103",
    "RV-0104",
    "RV-0112",
    "RV-0402",
    "RV-0531",
    "RV-0803",
    "RV-0804",
    "RV-0907",
    "RV-0908",
    "RV-1001",
    "RV-1002",
    "RV-1003",
    "RV-1004",
    "RV-1005",
    "RV-1006",
    "RV-1007",
    "RV-1008",
    "RV-1009",
    "RV-1010",
    "RV-1110",
    "RV-1208",
    "RV-1301",
    "RV-1302",
    "RV-1303",
    "RV-1304",
    "RV-1305",
    "RV-1306",
    *(code for code in CODES if code.startswith("RV-14")),  # about a list, not about a model
    *(code for code in CODES if code.startswith("RV-15")),  # about a program; they have a reason
)
"""Codes that have no correction yet. The tuple may only become shorter."""


def said_of(folder: Path, model: str) -> str:
    """Every error and warning of a model and of its program; empty when there is none."""
    path = folder / "model.yaml"
    path.write_text(model, encoding="utf-8")
    try:
        checked = checking.check(path, finish=True)
    except Refused as refused:
        return str(refused)
    return checked.warnings + render_all(tuple(clashes(checked.system)), checked.sources)


CORRECTED = [code for code, one in explanations().items() if one.corrected is not None]


@pytest.mark.slow
@pytest.mark.parametrize("code", CORRECTED)
def test_the_correction_removes_the_error(code: str, tmp_path: Path) -> None:
    found = explanations()[code]
    assert found.wrong is not None and found.corrected is not None
    assert f"[{code}]" in said_of(tmp_path, found.wrong)
    assert said_of(tmp_path, found.corrected) == ""


@pytest.mark.parametrize("code", CODES)
def test_an_explanation_fits_the_terminal(code: str) -> None:
    assert [line for line in text(code).splitlines() if len(line) > WIDTH] == []


def test_codes_without_a_correction_are_listed() -> None:
    assert [code for code in CODES if code not in CORRECTED] == list(WITHOUT)
    assert len(WITHOUT) == 29 + 6 + 4


def test_an_edit_that_does_not_stand_once_is_refused() -> None:
    assert edited("a b", [("b", "c")]) == "a c"
    for old in ("x", "a"):
        with pytest.raises(ValueError, match="times in the model"):
            edited("a a", [(old, "c")])
