# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What the language server knows of names: every use, and another name for each."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.language_server.model import model
from ravenchart.language_server.renaming import NotRenamedError, renamed
from ravenchart.language_server.symbols import ModelSymbol
from ravenchart.paths import ROOT

TWO_NODES = ROOT / "examples" / "two_nodes" / "model.yaml"
KINDS = ROOT / "tests" / "feature" / "kinds" / "model.yaml"
LAYOUTS = ROOT / "tests" / "feature" / "flexible" / "model.yaml"
LOGICAL = ROOT / "tests" / "feature" / "logical" / "model.yaml"
CALLED = ROOT / "tests" / "feature" / "called" / "model.yaml"
RAISED = ROOT / "tests" / "feature" / "raised" / "model.yaml"
GROUPED = ROOT / "tests" / "feature" / "grouped" / "model.yaml"
NESTED = ROOT / "tests" / "feature" / "composites" / "model.yaml"


def _symbols(path: Path) -> list[ModelSymbol]:
    return [one for one in model(path, {}).symbols.all() if one.declared is not None]


@pytest.mark.slow
@pytest.mark.parametrize("path", [TWO_NODES, LAYOUTS, NESTED, LOGICAL, RAISED, GROUPED])
def test_every_name_that_is_declared_can_be_changed(path: Path) -> None:
    now = model(path, {})
    symbols = _symbols(path)
    assert len(symbols) > 30
    for symbol in symbols:
        places = renamed(now, symbol, "Another_Name", {})
        assert sum(map(len, places.values())) == len(symbol.tokens)


def test_a_name_of_which_others_are_made_is_not_changed() -> None:
    now = model(KINDS, {})
    made = {}
    for symbol in _symbols(KINDS):
        try:
            renamed(now, symbol, "Another_Name", {})
        except NotRenamedError as problem:
            made[symbol.name] = str(problem)
    assert set(made) == {"Home", "Get_Limit", "Move_By"}, made
    assert "`Home_Reply`" in made["Home"]


def test_a_name_that_would_take_over_the_uses_of_another_is_refused(tmp_path: Path) -> None:
    text = TWO_NODES.read_text()
    path = tmp_path / "model.yaml"
    path.write_text(text)
    now = model(path, {})
    for symbol in now.symbols.all():
        other = next((s for s in _symbols(path) if s.kind == symbol.kind and s is not symbol), None)
        if symbol.declared is None or other is None or other.name == symbol.name:
            continue
        with pytest.raises(NotRenamedError):
            renamed(now, symbol, other.name, {})


def test_an_interface_that_releases_a_processor_is_named_anew_there_too() -> None:
    now = model(CALLED, {})
    text = CALLED.read_text(encoding="utf-8")
    found = now.symbols.at(str(CALLED), text.index("      Motion:\n        queue") + 6)
    assert found is not None
    places = renamed(now, found[0], "Drive", {})
    lines = {text.count("\n", 0, start) for spans in places.values() for start, _ in spans}
    for number in (1, 2):
        at = text.index(f"released_by: mover_{number}.Motion")
        assert text.count("\n", 0, at) in lines
