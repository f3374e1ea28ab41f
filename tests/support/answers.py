# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What a command prints with `--json`, held against docs/answer.schema.json."""

from __future__ import annotations

import json
from functools import cache
from typing import Any

import pytest

from ravenchart.command_line import main
from ravenchart.paths import ROOT


@cache
def _validator() -> Any:
    jsonschema = pytest.importorskip("jsonschema", reason="`make setup` installs jsonschema")
    text = (ROOT / "docs" / "answer.schema.json").read_text(encoding="utf-8")
    return jsonschema.Draft202012Validator(json.loads(text))


def valid(text: str) -> dict[str, Any]:
    """The one object in a text; it is as the schema says."""
    answer = json.loads(text)
    assert isinstance(answer, dict)
    errors = [f"{one.json_path}: {one.message}" for one in _validator().iter_errors(answer)]
    assert errors == []
    return answer


def answered(capsys: pytest.CaptureFixture[str], *words: object, status: int = 0) -> dict[str, Any]:
    """The answer of a command, which ends with that status."""
    capsys.readouterr()
    try:
        ended = main([*map(str, words), "--json"])
    except SystemExit as wrong:
        assert isinstance(wrong.code, int)
        ended = wrong.code
    out, errors = capsys.readouterr()
    answer = valid(out)
    assert (ended, answer["status"]) == (status, status), errors + out
    assert answer["format"] == 1
    return answer
