# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Mutants: where rules find their places, which are chosen, when an explanation counts."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from ravenchart.building import checking, generation
from ravenchart.gen.emit.program import generate, simulation
from ravenchart.paths import ROOT
from tests.mutation.__main__ import EXPLAINED, SUBJECTS
from tests.mutation.catalogue import KINDS, mutants_of
from tests.mutation.mutants import NOTE, Files, Mutant, sampled
from tests.mutation.report import Outcome, as_json, explanations, reason_of, survivors, table
from tests.mutation.source import arms, branches, conjuncts, statements, subprogram
from tests.mutation.workbench import Verdict, Workbench

ADA = """\
package body P is
   function In_A (Now : Occurrence) return Selection is
     (if Now = On_X and then Data.N < 4
         then T1
      elsif Now = On_X
         then T2
      else None)
   with Post => Is_Selection (In_A'Result, Now);

   procedure Fire (Chosen : Firing) is
      procedure Exit_A is
      begin
         Self.N := 1;
      end Exit_A;
   begin
      case Chosen is
         when T1 =>
            Exit_A;
            Enter_B;
         when T2 =>
            null;
      end case;
      Self.Started := True;
   end Fire;
end P;
"""


@pytest.fixture(scope="module")
def rich() -> Files:
    """The rich chart's program."""
    checked = checking.check(ROOT / "tests" / "feature" / "rich" / "model.yaml")
    files = generate(checked.system, generation.claims(checked))
    return {n: t for n, t in files.items() if n.endswith((".ads", ".adb"))}


def test_an_if_expression_is_read_with_its_conditions_and_values() -> None:
    one = subprogram(ADA, "In_A")
    assert one is not None and one.is_expression and one.line == 2
    found = [(b.head.of(ADA), b.body.of(ADA)) for b in branches(ADA, one.inner)]
    assert found == [("Now = On_X and then Data.N < 4", "T1"), ("Now = On_X", "T2"), ("", "None")]
    first = branches(ADA, one.inner)[0].head
    assert [s.of(ADA) for s in conjuncts(ADA, first)] == ["Now = On_X", "Data.N < 4"]


def test_a_body_is_read_with_its_statements_and_arms() -> None:
    one = subprogram(ADA, "Fire")
    assert one is not None and not one.is_expression
    case, last = statements(ADA, one.inner)
    assert last.of(ADA) == "Self.Started := True;"
    rows = arms(ADA, case)
    assert [r.head.of(ADA) for r in rows] == ["T1", "T2"]
    assert [s.of(ADA) for s in statements(ADA, rows[0].body)] == ["Exit_A;", "Enter_B;"]


def test_every_kind_but_codecs_and_frames_has_mutants_in_the_rich_chart(rich: Files) -> None:
    of_models_alone = {"period"}
    of_buses = {"codec", "frame"}
    assert set(KINDS) - {m.kind for m in mutants_of(rich)} == of_buses | of_models_alone


def test_codecs_have_mutants_in_the_robot() -> None:
    checked = checking.check(ROOT / "examples" / "cartesian_robot" / "model.yaml")
    files = generate(checked.system, generation.claims(checked))
    rules = {(m.kind, m.rule) for m in mutants_of(files) if m.kind == "codec"}
    assert rules == {("codec", "bit"), ("codec", "offset"), ("codec", "width")}


def test_frames_have_mutants_in_the_robot() -> None:
    checked = checking.check(ROOT / "examples" / "cartesian_robot" / "model.yaml")
    files = generate(checked.system, generation.claims(checked))
    found = [m for m in mutants_of(files) if m.kind == "frame"]
    sizes = {"identifier", "format", "short", "long"}
    assert {m.rule for m in found if m.place == "Frame_Of_X_Set_Point"} == sizes
    assert {m.rule for m in found if m.place == "Frame_X_Set_Point"} == {*sizes, "family"}
    assert {m.rule for m in found if m.place == "Run_Receive"} == {*sizes, "family"}
    assert {m.rule for m in found if m.place == "Send_X_Set_Point"} == {"message"}
    assert {m.rule for m in found if m.place == "Accepts"} == {"identifier"}


def test_each_mutant_is_another_text_and_the_same_every_time(rich: Files) -> None:
    mutants = mutants_of(rich)
    texts = {(m.file, m.applied(rich[m.file])) for m in mutants}
    assert len({m.key for m in mutants}) == len(mutants) == len(texts)
    assert all(m.applied(rich[m.file]) != rich[m.file] for m in mutants)
    assert mutants == mutants_of(dict(reversed(list(rich.items()))))


def test_each_mutant_of_a_region_is_found_in_the_program_for_simulation(rich: Files) -> None:
    checked = checking.check(ROOT / "tests" / "feature" / "rich" / "model.yaml")
    noted = simulation(checked.system)
    twins = {m.key: m for m in mutants_of(noted)}
    for mutant in mutants_of(rich):
        if "-plant-" in mutant.file:
            twin = twins[mutant.key]
            assert _replacements(twin, noted) == _replacements(mutant, rich), mutant.name


def _replacements(mutant: Mutant, files: Files) -> list[tuple[str, str]]:
    """The edits, without what a program for simulation notes."""
    pairs = ((e.span.of(files[mutant.file]), e.text) for e in mutant.edits)
    return [(_unnoted(old), _unnoted(new)) for old, new in pairs]


def _unnoted(text: str) -> str:
    return re.sub(rf"^ *{re.escape(NOTE)} [^;]*;\n", "", text, flags=re.M)


def test_the_model_is_broken_as_well() -> None:
    text = (ROOT / "tests" / "feature" / "rich" / "model.yaml").read_text()
    found = {m.row for m in mutants_of({"model.yaml": text})}
    kinds = ("target", "source", "trigger", "guard", "history", "deferral", "time-out", "period")
    assert {f"{kind}, model" for kind in kinds} <= found


def test_a_sample_has_some_of_each_kind_and_depends_on_the_seed_alone(rich: Files) -> None:
    mutants = mutants_of(rich)
    chosen = sampled(mutants, 2, seed=1)
    assert chosen == sampled(mutants, 2, seed=1) != sampled(mutants, 2, seed=2)
    assert {m.kind for m in chosen} == {m.kind for m in mutants}
    rows = [m.row for m in chosen]
    assert all(rows.count(row) <= 2 for row in rows)
    assert sampled(mutants, None, seed=1) == mutants


def test_an_explanation_counts_only_while_the_text_is_the_same(rich: Files, tmp_path: Path) -> None:
    mutant = mutants_of(rich)[0]
    diff = mutant.diff(rich[mutant.file])
    path = tmp_path / "explained.toml"
    row = f'[[equivalent]]\nsubject = "rich"\nplace = "{mutant.place}"\n'
    path.write_text(f"{row}reason = 'it does the same'\ndiff = '''\n{diff}\n'''\n")
    known = explanations(path)
    assert reason_of(known, "rich", mutant, diff) == "it does the same"
    assert reason_of(known, "rich", mutant, diff.replace("Enter", "Exit")) == ""
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


def test_the_report_counts_by_kind_and_shows_what_survived(rich: Files) -> None:
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
    checked = checking.check(ROOT / "examples" / "three_components" / "model.yaml")
    files = generate(checked.system, generation.claims(checked))
    order = [m for m in mutants_of(files) if m.kind == "order"]
    assert order
    diffs = [mutant.diff(files[mutant.file]) for mutant in order]
    over = re.compile(r"^[-+].*\n +Self\.Started :=.*\n[-+]|^[-+] +Self\.Started :=", re.M)
    assert not [diff for diff in diffs if over.search(diff)]
