# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Each transition and state in generated Ada says where it stands in the model."""

from __future__ import annotations

import re

import pytest

from ravenchart.building import checking
from ravenchart.gen.emit.ada.declarations import EnumType, Package, Unit
from ravenchart.gen.emit.ada.naming import where
from ravenchart.gen.emit.ada.statements import Comment
from ravenchart.gen.emit.ada.text import WIDTH, print_unit
from ravenchart.gen.emit.program import generate
from ravenchart.gen.model.claims import Claims
from ravenchart.gen.origins import Origin
from ravenchart.paths import ROOT

NOTE = re.compile(r"--  \[(\w+)\] (\S+):(\d+)((?:, \S+:\d+)*)")
MODELS = ("examples/pump", "examples/cartesian_robot", "tests/feature/corners")


@pytest.mark.parametrize("folder", MODELS)
def test_every_transition_and_state_names_its_line(folder: str) -> None:
    path = ROOT / folder / "model.yaml"
    system = checking.check(path, deadlines=False).system
    told: set[str] = set()
    for name, text in generate(system, Claims()).items():
        if not name.endswith(".ads"):
            continue
        for what, file, line, _ in NOTE.findall(text):
            told.add(what)
            row = (path.parent / file).read_text("utf-8").splitlines()[int(line) - 1]
            first = re.split("_Then_|Restore_|Default_Of_|Defer_.*_In_", what)
            assert any(part and part.lower() in row.lower() for part in first), (name, what, row)
    for component in {i.component.name: i.component for i in system.instances}.values():
        for region in component.regions:
            assert {state.name for state in region.states} <= told
            fired = {t.name for t in region.transitions}
            assert all(any(name in one for one in told) for name in fired)


LONG = "x" * 50


@pytest.mark.parametrize("folder", [LONG, f"{LONG}/{LONG}/{LONG}"])
def test_a_long_note_stands_before_its_literal(folder: str) -> None:
    model = Origin("project/model.yaml", 1, 1)
    note = where("a", [Origin(f"project/{folder}/model.yaml", 12, 1)], model)
    literals = EnumType("Leaf", ("A", "B"), (note, Comment("")))
    text = print_unit(Unit("", (), Package("P", (literals,))))
    rows = text.splitlines()
    assert any("x/model.yaml:12" in row for row in rows) and "      A," in rows
    assert max(map(len, rows)) <= WIDTH
