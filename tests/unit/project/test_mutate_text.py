# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Breaks of Ada that people wrote: what is broken, and what is left alone."""

from __future__ import annotations

import pytest

from ravenchart.paths import ROOT
from tests.mutation.hand_written import EXPLAINED, UNITS
from tests.mutation.report import explanations, reason_of
from tests.mutation.text_rules import KINDS, mutants_of

UNIT = """\
package body Gates
  with SPARK_Mode
is

   Width : constant := 3;

   function Is_Open (G : Gate) return Boolean
   is (G.Left < Width and then not G.Locked)
   with Global => null, Post => Is_Open'Result = not G.Shut;

   procedure Lemma_Open (G : Gate) is
   begin
      pragma Assert (G.Left < Width);
   end Lemma_Open;

   procedure Close (G : in out Gate; Ok : out Boolean) is
   begin
      --  Left < 0 cannot be.
      Lemma_Open (G);
      pragma Assert (G.Left > 0);
      G.Left := G.Left - 1;
      Ok := True;
   end Close;

   task body Watch is
   begin
      loop
         delay until Due;
         Mask := 16#FE#;
      end loop;
   end Watch;

end Gates;
"""
EXPECTED = {
    "comparison": {("Is_Open", "G.Left <= Width")},
    "equality": set(),
    "number": {("Close", "G.Left := G.Left - 2;")},
    "sign": {("Close", "G.Left := G.Left + 1;")},
    "connective": {
        ("Is_Open", "Width or else not"),
        ("Is_Open", "and then G.Locked"),
    },
    "truth": {("Close", "Ok := False;")},
    "hexadecimal": {("Watch", "Mask := 16#FF#;")},
    "left out": {("Close", "null;"), ("Watch", "null;")},
}


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_program_is_broken_and_what_is_proof_is_not(kind: str) -> None:
    found = [one for one in mutants_of("gates.adb", UNIT) if one.kind == kind]
    added = {
        (one.place, line)
        for one in found
        for line in one.diff(UNIT).splitlines()
        if line.startswith("+")
    }
    assert len(found) == {"connective": 2, "left out": 4}.get(kind, len(EXPECTED[kind]))
    for place, text in EXPECTED[kind]:
        assert any(where == place and text in line for where, line in added), (text, added)


def test_every_unit_of_runtime_and_hal_is_among_them() -> None:
    made = {
        unit.stem: len(mutants_of(unit.name, (ROOT / unit).read_text()))
        for unit in UNITS
        if unit.suffix == ".adb"
    }
    assert len(made) > 30
    without = {name for name, number in made.items() if number == 0}
    assert without == {
        "ravenchart-can-controllers",
        "ravenchart-can-layout_lemmas",
        "ravenchart-clock_ticks",
    }


def test_each_explanation_is_of_a_mutant_of_today() -> None:
    known = explanations(EXPLAINED)
    assert known
    texts = {unit.name: (ROOT / unit).read_text() for unit in UNITS}
    for one in known:
        text = texts[one.subject]
        own = mutants_of(one.subject, text)
        assert any(reason_of([one], one.subject, m, m.diff(text)) for m in own), one.diff
