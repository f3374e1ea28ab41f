"""Every model under tests/bad_models gives exactly the text of its expect.txt."""

from __future__ import annotations

from pathlib import Path

import pytest

from gen.diagnostics import CODES, render
from gen.load import load

BAD_MODELS = Path(__file__).parent.parent / "bad_models"
CASES = sorted(path.name for path in BAD_MODELS.iterdir() if path.is_dir())


def messages(name: str, monkeypatch: pytest.MonkeyPatch) -> str:
    """What loading the case prints, with paths as seen from its directory."""
    monkeypatch.chdir(BAD_MODELS / name)
    loaded = load(Path("model.yaml"))
    return "\n".join(render(item, loaded.sources) for item in loaded.diagnostics) + "\n"


@pytest.mark.parametrize("name", CASES)
def test_bad_model_is_told_what_is_wrong_word_for_word(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    expected = (BAD_MODELS / name / "expect.txt").read_text(encoding="utf-8")
    assert messages(name, monkeypatch) == expected


@pytest.mark.parametrize("name", CASES)
def test_bad_model_gives_a_system_only_when_there_are_warnings_only(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(BAD_MODELS / name)
    loaded = load(Path("model.yaml"))
    assert (loaded.system is None) == any(item.is_error for item in loaded.diagnostics)


def test_nearly_every_code_is_shown_by_a_bad_model() -> None:
    shown = "\n".join((BAD_MODELS / name / "expect.txt").read_text() for name in CASES)
    unshown = [code for code in CODES if f"[{code}]" not in shown]
    # large or odd files, which the tests of the loader make in memory
    assert unshown == ["RV-0102", "RV-0103", "RV-0113"]
