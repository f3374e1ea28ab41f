# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Calls in the docs are executed: those of examples here, those of each other command elsewhere."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.command_line import main
from ravenchart.paths import ROOT
from tests.support.listings import calls, listings, script

HERE = {"analyse", "check", "check-certificate", "explain", "generate", "simulate"}
"""Commands that take seconds and leave the examples as they are."""

ELSEWHERE = {
    "allocate": "tests/unit/ravenchart/test_allocate_command.py",
    "build": "tests/system/test_wheel.py",
    "bus": "tests/system/test_wheel.py",
    "doctor": "tests/system/test_wheel.py",
    "evidence": "tests/unit/ravenchart/test_evidence.py",
    "export-dbc": "tests/unit/ravenchart/test_export_dbc.py",
    "import": "tests/unit/ravenchart/test_import_database.py",
    "loopback": "tests/system/test_wheel.py",
    "measure": "tests/system/test_measure.py",
    "monitor": "tests/system/test_watched_controllers.py",
    "new": "tests/system/test_wheel.py",
    "prove": "tests/system/test_wheel.py",
    "requirements": "tests/unit/ravenchart/test_evidence.py",
    "run": "tests/system/test_wheel.py",
    "shell": "tests/system/test_shell_sessions.py",
    "tests": "tests/unit/behaviour/test_cases.py",
    "trace": "tests/unit/gen/test_recorded_values.py",
    "workbench": "tests/support/workbench.py",
}
"""Commands of other listings, and a file of the tests that calls them."""

WORDS = [
    words[1:]
    for one in listings()
    if one.language in ("sh", "console")
    for words in calls(script(one))
    if words[0].removeprefix(".venv/bin/") == "ravenchart"
]


def is_here(words: list[str]) -> bool:
    """Whether a call names files of this repository, or none."""
    if words[0] not in HERE:
        return False
    return words[0] == "explain" or words[1].startswith(("examples/", "tests/"))


CALLS = sorted({tuple(words) for words in WORDS if is_here(words)})


@pytest.mark.parametrize("words", CALLS, ids=" ".join)
def test_a_call_of_the_docs_succeeds(
    words: tuple[str, ...],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    named = [
        str(ROOT / word) if word.startswith(("examples/", "tests/")) else word for word in words
    ]
    assert main(named) == 0
    assert capsys.readouterr().out or list(tmp_path.iterdir())
    if "--html" in words:
        assert (tmp_path / words[words.index("--html") + 1]).is_file()


def test_every_other_command_of_the_docs_is_called_by_a_test() -> None:
    assert len(CALLS) > 15
    assert {words[0] for words in WORDS} - HERE == set(ELSEWHERE)
    assert {words[0] for words in CALLS} == HERE
    lost = [
        command
        for command, file in ELSEWHERE.items()
        if f'"{command}"' not in (ROOT / file).read_text(encoding="utf-8")
    ]
    assert lost == []
