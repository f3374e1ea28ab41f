# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What the rules of behaviour found is taken again for the same content, and for no other."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.behaviour import rules
from ravenchart.building import check_cache, checking
from ravenchart.command_line import main
from ravenchart.failures import Refused
from ravenchart.gen.diagnostics import Diagnostic
from ravenchart.gen.model.system import System
from ravenchart.tools import kept
from tests.bench.random_models import random_model


@pytest.fixture
def looked(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[str]:
    """The systems that the rules of behaviour look at, with an empty cache."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    names: list[str] = []
    findings = rules.findings

    def counted(system: System, effort: int) -> tuple[Diagnostic, ...]:
        names.append(system.name)
        return findings(system, effort)

    monkeypatch.setattr("ravenchart.behaviour.rules.findings", counted)
    return names


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A small chart."""
    found = tmp_path / "model.yaml"
    found.write_text(random_model(8, 1), encoding="utf-8")
    return found


@pytest.mark.slow
def test_check_generate_and_build_look_once(
    looked: list[str], path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    said = []
    for command in ("check", "check", "generate", "build"):
        assert main([command, str(path)]) == 0
        said.append(capsys.readouterr().err)
    assert looked == ["Random_8"]
    assert said[0] == said[1] == said[2] == said[3]


def test_another_content_is_looked_at(looked: list[str], path: Path) -> None:
    before = checking.check(path)
    text = path.read_text(encoding="utf-8")
    guard = "guard: count > 99 and count < 9\n            'on': E"
    path.write_text(text.replace("'on': E", guard, 1), encoding="utf-8")
    with pytest.raises(Refused, match="RV-1102"):
        checking.check(path)
    path.write_text(text, encoding="utf-8")
    assert checking.check(path).warnings == before.warnings
    assert len(looked) == 2


def test_another_tool_is_another_key(monkeypatch: pytest.MonkeyPatch) -> None:
    sources = {"model.yaml": ("system: A",)}
    first = check_cache.key(sources)
    monkeypatch.setattr(check_cache, "_tool", lambda: ["another"])
    assert check_cache.key(sources) != first


def test_unfinished_check_is_kept_and_finished_by_check_alone(
    looked: list[str], path: Path
) -> None:
    for _ in range(2):
        assert "RV-1110" in checking.check(path, effort=0).warnings
    assert len(looked) == 1
    assert "RV-1110" in checking.check(path, effort=0, finish=True).warnings
    assert len(looked) == 2
    assert "RV-1110" not in checking.check(path).warnings
    assert "RV-1110" not in checking.check(path, effort=0).warnings
    assert len(looked) == 3


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"found": [[1]]}', '{"found": 3}'])
def test_an_entry_that_cannot_be_read_is_none(looked: list[str], path: Path, text: str) -> None:
    first = checking.check(path)
    (entry,) = kept.folder(check_cache.KIND).glob("*.json")
    entry.write_text(text, encoding="utf-8")
    assert checking.check(path).warnings == first.warnings
    assert len(looked) == 2
