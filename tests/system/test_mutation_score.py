# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Broken programs are caught by the compiler, by gnatprove or by a run; an unbroken one is clean.

The subject is a chart of three states, so that a proof takes seconds. Without gnatprove
the test is skipped, and says so.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from ravenchart.failures import ToolFailed
from ravenchart.gen.emit.program import generate, units_of_program
from ravenchart.gen.model.claims import Claims
from ravenchart.gen.model.system import System
from ravenchart.tools import toolchain
from tests.mutation.__main__ import Subject, mutants, tried
from tests.mutation.observing import Simulated
from tests.support.chart_models import chart_text

KINDS = ("target", "source", "missing action", "order", "time-out", "certificate")
STATES = """\
A:
  entry: [{set: place, to: if place > 50 then 0 else place + 1}]
  exit: [{set: place, to: if place > 50 then 0 else place + 2}]
B:
  initial: C
  entry: [{set: place, to: if place > 50 then 0 else place + 3}]
  states: {C: {entry: [{set: place, to: if place > 50 then 0 else place + 5}]}}
"""
TRANSITIONS = """\
go: {from: A, to: B, on: Go, effect: [{set: place, to: if place > 50 then 0 else place + 7}]}
back: {from: B, to: A, on: Stop, guard: place < 30}
late: {from: B, to: A, after: 30 ms}
"""


@pytest.fixture(scope="module")
def subject(tmp_path_factory: pytest.TempPathFactory) -> Subject:
    """A small chart with hierarchy, actions and a time-out."""
    model = tmp_path_factory.mktemp("small") / "model.yaml"
    model.write_text(chart_text(STATES, TRANSITIONS))
    return Subject("small", model, Simulated)


@pytest.mark.skipif(not toolchain.have("gnatprove"), reason="gnatprove is not on PATH")
def test_one_break_of_each_kind_is_caught(subject: Subject) -> None:
    chosen = [m for m in mutants(subject, 1, 1, KINDS) if m.part == "code"]
    assert {m.kind for m in chosen} == set(KINDS)
    outcomes = tried(subject, chosen, 2, ())
    assert [o.mutant.name for o in outcomes if o.survived] == []
    caught = {o.mutant.kind: o.verdict.by for o in outcomes}
    assert caught["certificate"] == "compiler"
    assert {caught["target"], caught["source"], caught["time-out"]} == {"gnatprove"}


@pytest.mark.skipif(not toolchain.have("gnatprove"), reason="gnatprove is not on PATH")
def test_an_effect_behind_the_entry_is_caught_by_tests_alone(tmp_path: Path) -> None:
    """As README and docs/architecture.md say: after it `place` is 32, and 29 when it comes late."""
    transitions = """\
go: {from: A, to: B, on: Go, effect: [{set: place, to: 24}]}
back: {from: B, to: A, on: Stop, guard: place > 30}
"""
    model = tmp_path / "model.yaml"
    model.write_text(chart_text(STATES, transitions))
    ordered = Subject("ordered", model, Simulated)
    late = [m for m in mutants(ordered, None, 1, ("order",)) if m.rule == "late"]
    assert {m.place for m in late} == {"Fire"}
    (outcome,) = tried(ordered, late, 1, ())
    assert outcome.verdict.by == "tests"


@pytest.mark.skipif(not toolchain.have("gnatprove"), reason="gnatprove is not on PATH")
def test_a_program_that_is_not_clean_is_no_subject(
    subject: Subject, monkeypatch: pytest.MonkeyPatch
) -> None:
    chosen = [m for m in mutants(subject, 1, 1, ("target",)) if m.part == "code"]

    def broken(system: System, bounds: Claims) -> Mapping[str, str]:
        units = units_of_program(system, bounds)
        changed = chosen[0].applied(units[chosen[0].file])
        return {**generate(system, bounds), chosen[0].file: changed}

    monkeypatch.setattr("tests.mutation.workbench.generate", broken)
    with pytest.raises(ToolFailed, match=r"postcondition|assertion"):
        tried(subject, chosen, 1, ())
