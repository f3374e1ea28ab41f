# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Mutants: where rules find their places, which are chosen, when an explanation counts."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from ravenchart.building import checking, generation
from ravenchart.gen.emit.ada.declarations import Package, Param, Subprogram, Unit
from ravenchart.gen.emit.ada.expressions import (
    TRUE,
    IfExpr,
    OperatorChain,
    both,
    equal,
    number,
)
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.statements import NULL, Assign, Case, Do, do
from ravenchart.gen.emit.ada.text import print_unit
from ravenchart.gen.emit.ada.walking import rewritten
from ravenchart.gen.emit.program import units_of_program, units_of_simulation
from ravenchart.paths import ROOT
from tests.mutation.__main__ import EXPLAINED, SUBJECTS
from tests.mutation.catalogue import KINDS, mutants_of
from tests.mutation.firing_rules import NOTE
from tests.mutation.mutants import Mutant, Units, sampled
from tests.mutation.nodes import (
    Spot,
    bodies,
    body_of,
    conjuncts,
    exchanged,
    following,
    lists_in,
    moved_behind,
    put,
    statements,
    whole,
    written,
)
from tests.mutation.report import Outcome, as_json, explanations, reason_of, survivors, table
from tests.mutation.workbench import Verdict, Workbench

NOW, T1, T2 = ref("Now"), ref("T1"), ref("T2")
GUARD = OperatorChain("<", (ref("Data.N"), number(4)))
SELECTION = IfExpr(
    (
        (both(equal(NOW, ref("On_X")), GUARD), T1),
        (equal(NOW, ref("On_X")), T2),
    ),
    ref("None"),
)
CASE = Case(ref("Chosen"), [("T1", (do("Exit_A"), do("Enter_B"))), ("T2", (NULL,))])
UNIT = Unit(
    "",
    (),
    Package(
        "P",
        (
            Subprogram(
                "In_A", (Param("Now", "in", "Occurrence"),), "Selection", expression=SELECTION
            ),
            Subprogram(
                "Fire",
                declarations=(Subprogram("Exit_A", body=(Assign("Self.N", number(1)),)),),
                body=(CASE, Assign("Self.Started", TRUE)),
            ),
        ),
        is_body=True,
    ),
)


@pytest.fixture(scope="module")
def rich() -> Units:
    """The rich chart's program."""
    return _units("tests/feature/rich")


def _units(folder: str) -> Units:
    checked = checking.check(ROOT / folder / "model.yaml")
    return units_of_program(checked.system, generation.claims(checked))


def test_each_node_has_a_place_at_which_another_can_stand() -> None:
    selection = body_of(UNIT, "In_A")
    assert selection is not None and selection.is_expression
    (first, second) = (selection.inner.at("branches", place) for place in range(2))
    assert [spot.node for spot in conjuncts(first.at(0))] == [equal(NOW, ref("On_X")), GUARD]
    changed = written(UNIT, exchanged(first.at(1), second.at(1)))
    assert [value for _, value in _inner(changed, "In_A").branches] == [T2, T1]
    assert _inner(changed, "Fire") is _inner(UNIT, "Fire")
    assert written(changed, (*put(first.at(1), T1), *put(second.at(1), T2))) == UNIT
    assert written(UNIT, ()) is UNIT


def test_what_moves_behind_another_passes_what_stands_between() -> None:
    row: tuple[object, ...] = (do("Set"), do("Claim"), do("Enter"))
    places = [Spot((place,), one) for place, one in enumerate(row)]
    assert written(row, moved_behind(places[0], places[2])) == (NULL, row[1], row[2], row[0])


def _inner(unit: Unit, name: str) -> Any:
    one = body_of(unit, name)
    assert one is not None
    return one.inner.node


def test_a_body_is_found_with_those_in_it_and_its_lists_of_statements() -> None:
    assert [one.name for one in bodies(UNIT)] == ["In_A", "Fire", "Exit_A"]
    fire = body_of(UNIT, "Fire")
    assert fire is not None and fire.fires and not fire.is_expression
    assert [one.node for one in statements(fire.inner)] == list(fire.spot.node.body or ())
    lists = list(lists_in(fire.inner))
    assert [one.node for one in lists] == [(do("Exit_A"), do("Enter_B")), (NULL,)]
    changed = written(UNIT, put(lists[0], (NULL,)))
    assert [body for _, body in _inner(changed, "Fire")[0].branches] == [(NULL,), (NULL,)]


def test_names_follow_each_other_in_a_circle() -> None:
    assert following("b", ["a", "b", "a", "c"]) == "c"
    assert following("c", ["a", "b", "c"]) == "a"
    assert following("a", ["a", "a"]) is None is following("d", ["a", "b"])


def test_every_kind_but_codecs_and_frames_has_mutants_in_the_rich_chart(rich: Units) -> None:
    of_models_alone = {"period"}
    of_buses = {"codec", "frame"}
    assert set(KINDS) - {m.kind for m in mutants_of(rich)} == of_buses | of_models_alone


def test_codecs_have_mutants_in_the_robot() -> None:
    units = _units("examples/cartesian_robot")
    rules = {(m.kind, m.rule) for m in mutants_of(units) if m.kind == "codec"}
    assert rules == {("codec", "bit"), ("codec", "offset"), ("codec", "width")}


def test_frames_have_mutants_in_the_robot() -> None:
    units = _units("examples/cartesian_robot")
    found = [m for m in mutants_of(units) if m.kind == "frame"]
    sizes = {"identifier", "format", "short", "long"}
    assert {m.rule for m in found if m.place == "Frame_Of_X_Set_Point"} == sizes
    assert {m.rule for m in found if m.place == "Frame_X_Set_Point"} == {*sizes, "family"}
    assert {m.rule for m in found if m.place == "Run_Receive"} == {*sizes, "family"}
    assert {m.rule for m in found if m.place == "Send_X_Set_Point"} == {"message"}
    assert {m.rule for m in found if m.place == "Accepts"} == {"identifier"}


def test_each_mutant_is_another_text_and_the_same_every_time(rich: Units) -> None:
    mutants = mutants_of(rich)
    texts = {(m.file, m.applied(rich[m.file])) for m in mutants}
    assert len({m.key for m in mutants}) == len(mutants) == len(texts)
    assert all(m.applied(rich[m.file]) != print_unit(rich[m.file]) for m in mutants)
    assert mutants == mutants_of(dict(reversed(list(rich.items()))))


def test_each_mutant_of_a_region_is_found_in_the_program_for_simulation(rich: Units) -> None:
    checked = checking.check(ROOT / "tests" / "feature" / "rich" / "model.yaml")
    noted = units_of_simulation(checked.system)
    twins = {m.key: m for m in mutants_of(noted)}
    for mutant in mutants_of(rich):
        if "-plant-" in mutant.file:
            twin = twins[mutant.key]
            assert _replacements(twin, noted) == _replacements(mutant, rich), mutant.name


def _replacements(mutant: Mutant, units: Units) -> list[tuple[object, object]]:
    """The old nodes and the new ones, without what a program for simulation notes."""
    spot = whole(units[mutant.file])
    pairs = ((spot.at(*one.path).node, one.node) for one in mutant.puts)
    return [(_unnoted(old), _unnoted(new)) for old, new in pairs]


def _unnoted(node: object) -> object:
    def without(part: object) -> object | None:
        if type(part) is not tuple or not any(map(_notes, part)):
            return None
        return rewritten(tuple(one for one in part if not _notes(one)), without)

    return rewritten(node, without)


def _notes(statement: object) -> bool:
    return isinstance(statement, Do) and statement.name == NOTE


def test_the_model_is_broken_as_well() -> None:
    text = (ROOT / "tests" / "feature" / "rich" / "model.yaml").read_text()
    found = {m.row for m in mutants_of({"model.yaml": text})}
    kinds = ("target", "source", "trigger", "guard", "history", "deferral", "time-out", "period")
    assert {f"{kind}, model" for kind in kinds} <= found


def test_a_sample_has_some_of_each_kind_and_depends_on_the_seed_alone(rich: Units) -> None:
    mutants = mutants_of(rich)
    chosen = sampled(mutants, 2, seed=1)
    assert chosen == sampled(mutants, 2, seed=1) != sampled(mutants, 2, seed=2)
    assert {m.kind for m in chosen} == {m.kind for m in mutants}
    rows = [m.row for m in chosen]
    assert all(rows.count(row) <= 2 for row in rows)
    assert sampled(mutants, None, seed=1) == mutants


def test_an_explanation_counts_only_while_the_text_is_the_same(rich: Units, tmp_path: Path) -> None:
    mutant = mutants_of(rich)[0]
    diff = mutant.diff(rich[mutant.file])
    path = tmp_path / "explained.toml"
    row = f'[[equivalent]]\nsubject = "rich"\nplace = "{mutant.place}"\n'
    path.write_text(f"{row}reason = 'it does the same'\ndiff = '''\n{diff}\n'''\n")
    known = explanations(path)
    assert reason_of(known, "rich", mutant, diff) == "it does the same"
    assert reason_of(known, "rich", mutant, diff.replace("+", "-")) == ""
    assert reason_of(known, "robot", mutant, diff) == ""


@pytest.mark.slow
def test_each_explanation_is_of_a_mutant_of_today(tmp_path: Path) -> None:
    known = explanations(EXPLAINED)
    for subject in SUBJECTS:
        own = [one for one in known if one.subject == subject.name]
        if not own:
            continue
        files = Workbench(subject.model, tmp_path / subject.name, node=subject.node).files
        texts = [(m, m.diff(files[m.file])) for m in mutants_of(files)]
        for one in own:
            assert any(reason_of([one], subject.name, *pair) for pair in texts), one.reason
        known = [one for one in known if one not in own]
    assert not known


def test_the_report_counts_by_kind_and_shows_what_survived(rich: Units) -> None:
    first, second = mutants_of(rich)[:2]
    outcomes = [
        Outcome("rich", first, "-a\n+b", Verdict("gnatprove", "postcondition might fail")),
        Outcome("rich", second, "-c\n+d", Verdict(None)),
    ]
    last = table(outcomes).splitlines()[-1].split()
    assert last == ["all", "2", "0", "1", "0", "0", "0", "1"]
    assert survivors(outcomes).endswith("-c\n+d") and "-a" not in survivors(outcomes)
    found = json.loads(as_json(outcomes))
    assert found["kinds"]["target"]["survived"] == 1
    assert [m["caught_by"] for m in found["mutants"]] == ["gnatprove", None]


def test_that_a_region_has_started_is_exchanged_with_nothing() -> None:
    units = _units("examples/three_components")
    order = [m for m in mutants_of(units) if m.kind == "order"]
    assert order
    diffs = [mutant.diff(units[mutant.file]) for mutant in order]
    over = re.compile(r"^[-+].*\n +Self\.Started :=.*\n[-+]|^[-+] +Self\.Started :=", re.M)
    assert not [diff for diff in diffs if over.search(diff)]
