# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Each correction is applied: the wrong files give their code, the corrected ones none."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from ravenchart.building import checking
from ravenchart.command_line import main
from ravenchart.commands.explain import write
from ravenchart.failures import Refused
from ravenchart.gen.diagnostics import CODES
from ravenchart.gen.explanations import WIDTH, Example, edited, explanations, text
from ravenchart.running import scenarios


def reported(
    example: Example,
    home: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> tuple[bool, set[str]]:
    """Whether the commands of an example succeed at home, and the codes that they print."""
    write(example, home)
    monkeypatch.chdir(home)
    status = 0
    for line in example.command.splitlines():
        name, *words = shlex.split(line)
        if name == "run":  # the scenario alone: a run takes seconds
            try:
                scenarios.checked(Path(words[-1]), checking.check(Path(words[0])).system)
            except Refused as refused:
                print(refused)
                status = 1
        else:
            status = main([name, *words])
    out, err = capsys.readouterr()
    return status == 0, set(re.findall(r"\[(RV-\d{4})\]$", f"{out}{err}", re.M))


REMAIN = {"RV-1007": {"RV-1110"}}
"""Codes that stay: a simulation can get stuck only where the check was not finished."""


@pytest.mark.slow
@pytest.mark.parametrize("code", CODES)
def test_the_correction_removes_the_error(
    code: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    found = explanations()[code]
    _, codes = reported(found.wrong, tmp_path / "wrong", monkeypatch, capsys)
    assert code in codes
    corrected = reported(found.corrected, tmp_path / "corrected", monkeypatch, capsys)
    assert corrected == (True, REMAIN.get(code, set()))


@pytest.mark.parametrize("code", CODES)
def test_an_explanation_fits_the_terminal(code: str) -> None:
    assert [line for line in text(code).splitlines() if len(line) > WIDTH] == []


def test_an_edit_that_does_not_stand_once_is_refused() -> None:
    files = {"one": "a a", "two": "b"}
    assert edited(files, [("b", "c", 3)]) == {"one": "a a", "two": "ccc"}
    for old in ("x", "a"):
        with pytest.raises(ValueError, match="times in the files"):
            edited(files, [(old, "c")])
