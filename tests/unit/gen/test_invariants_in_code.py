# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Which invariants become contracts of the code, with which facts, and what is said of the rest."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.behaviour.rules import inductive, moves
from ravenchart.behaviour.rules.inductive import contracts
from ravenchart.building import checking
from ravenchart.command_line import main
from ravenchart.gen.model.notation import shown_expression
from ravenchart.gen.model.safety import Fact
from ravenchart.gen.model.system import System
from ravenchart.paths import ROOT
from tests.support.behaviour_models import model, region

ACROSS = region(
    "Main",
    "{A: {}, B: {}, C: {}, Way: {kind: choice}}",
    "go: {from: A, to: B, on: Go, effect: [{set: count, to: 7}]}\n"
    "on: {from: B, to: Way, on: Go}\n"
    "far: {from: Way, to: C, guard: level > 5}\n"
    "near: {from: Way, to: A, guard: else}\n"
    "stop: {from: C, to: A, on: Stop, effect: [{set: count, to: 0}]}",
)
TWO = region(
    "Main",
    "{A: {regions: {Left: {initial: L1, states: {L1: {}, L2: {entry: [{set: armed, to: true}]}}}, "
    "Right: {initial: R1, states: {R1: {}, R2: {}}}}}}",
    "left: {from: L1, to: L2, on: Go}\n"
    "right: {from: R1, to: R2, when: armed}\n"
    "reset: {from: L2, to: L1, when: level > 5, effect: [{set: armed, to: false}]}",
)


def facts_of(system: System) -> list[str]:
    """The facts of every region, as `check` prints them."""
    return [
        f"{fact.vertex}: {shown_expression(fact.condition(system.components[0]))}"
        for safe in contracts(system).regions
        for fact in safe.facts
    ]


def proved(system: System) -> list[str]:
    """The invariants that are contracts of the code."""
    return [name for safe in contracts(system).regions for name in safe.invariants]


def reasons(system: System) -> list[str]:
    """Why the others are not."""
    return [one.message for one in contracts(system).found]


def test_an_inductive_invariant_needs_no_fact() -> None:
    system = model(ACROSS, never="{much: count > 7}")
    assert proved(system) == ["much"]
    assert facts_of(system) == []
    assert reasons(system) == []


def test_what_a_state_is_entered_with_is_a_fact_of_the_places_before() -> None:
    system = model(ACROSS, never="{empty: in(Main.C) and count /= 7}")
    assert proved(system) == ["empty"]
    assert facts_of(system) == ["B: count = 7", "Way: count = 7"]


def test_what_does_not_hold_is_no_contract() -> None:
    system = model(ACROSS, never="{early: in(Main.A) and count = 7}")
    assert proved(system) == []
    assert reasons(system) == [
        "the invariant early is checked on the model alone: no facts about single data items were "
        "found with which each transition keeps it"
    ]


def test_a_relation_of_two_items_is_found_only_where_the_condition_says_it() -> None:
    chart = region(
        "Main",
        "{A: {}, B: {}, C: {}}",
        "go: {from: A, to: B, on: Go, "
        "effect: [{set: count, to: level}, {set: armed, to: level > 5}]}\n"
        "again: {from: B, to: C, on: Go}",
    )
    said = "armed and count <= 5"
    assert proved(model(chart, never=f"{{here: in(Main.C) and {said}}}")) == []
    assert proved(model(chart, never=f"{{ever: {said}, here: in(Main.C) and {said}}}")) == [
        "ever",
        "here",
    ]


def test_two_regions_are_checked_on_the_model_alone() -> None:
    second = region("Other", "{D: {}, E: {}}", "over: {from: D, to: E, on: Go}", initial="D")
    system = model(ACROSS, second, never="{two: in(Main.C) and in(Other.D) and count = 0}")
    assert proved(system) == []
    assert "not about the states of one region" in reasons(system)[0]
    assert contracts(system).found[0].code == "RV-1111"


def test_data_of_another_writer_are_checked_on_the_model_alone() -> None:
    second = region(
        "Other",
        "{D: {}, E: {}}",
        "over: {from: D, to: E, on: Go, effect: [{set: armed, to: true}]}",
        initial="D",
    )
    system = model(ACROSS, second, never="{two: in(Main.C) and armed and count = 0}")
    assert proved(system) == []


def test_data_that_nothing_writes_are_constants() -> None:
    assert proved(model(ACROSS, never="{armed: in(Main.C) and armed}")) == ["armed"]


def test_a_guard_that_an_earlier_region_may_break_is_not_relied_on() -> None:
    """``right`` asks for ``armed``, which ``reset`` takes back in the same step."""
    assert proved(model(TWO, never="{unarmed: in(Main.R2) and in(Main.L1) and not armed}")) == []


def test_a_guard_is_relied_on_where_the_transition_is_alone() -> None:
    chart = TWO.replace("when: level > 5", "on: Stop").replace("to: false", "to: true")
    system = model(chart, never="{early: in(Main.R2) and not armed}")
    assert proved(system) == ["early"]
    assert contracts(system).regions[0].alone == ("right",)


def test_a_region_that_is_too_large_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(moves, "MOST_POSITIONS", 2)
    assert "its region is too large" in reasons(model(ACROSS, never="{much: count > 7}"))[0]
    monkeypatch.undo()
    monkeypatch.setattr(inductive, "MOST_QUESTIONS", 1)
    assert "its region is too large" in reasons(model(ACROSS, never="{much: count > 7}"))[0]


def test_a_region_that_ends_is_said() -> None:
    chart = region(
        "Main",
        "{A: {}, B: {}, The_End: {kind: terminate}}",
        "go: {from: A, to: B, on: Go, effect: [{set: count, to: 7}]}\n"
        "finish: {from: B, to: The_End, on: Stop}",
    )
    assert "ends in a terminate" in reasons(model(chart, never="{much: count > 7}"))[0]


def test_a_history_may_enter_any_leaf_that_it_can_remember() -> None:
    chart = region(
        "Main",
        "{A: {}, P: {initial: B, states: {H: {kind: history}, "
        "B: {entry: [{set: armed, to: false}]}, C: {entry: [{set: armed, to: true}]}}}}",
        "enter: {from: A, to: H, on: Go}\n"
        "further: {from: B, to: C, on: Go}\n"
        "leave: {from: P, to: A, on: Stop}",
    )
    assert proved(model(chart, never="{b: in(Main.B) and armed, c: in(Main.C) and not armed}")) == [
        "b",
        "c",
    ]


def test_facts_name_ranges_as_a_model_writes_them() -> None:
    system = model(ACROSS)
    component = system.components[0]

    def words(*spans: tuple[int, int], data: str = "count") -> str:
        return shown_expression(Fact("A", data, None, spans).condition(component))

    assert words((3, 3)) == "count = 3"
    assert words((0, 4)) == "count <= 4"
    assert words((5, 100)) == "count >= 5"
    assert words((0, 1), (5, 6)) == "count <= 1 or count >= 5 and count <= 6"
    assert words((1, 1), data="armed") == "armed"
    assert words((0, 0), data="armed") == "not armed"
    assert words() == "false"


def test_the_pump_needs_one_fact(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(ROOT / "examples" / "pump" / "model.yaml")]) == 0
    told = capsys.readouterr()
    assert "alarm_while_running, alarm_without_sound, overdose" in told.out
    assert "their proof uses: in May_Go_On, speed = 0" in told.out
    assert "RV-1111" not in told.err


def test_all_invariants_of_the_crossing_are_contracts() -> None:
    found = checking.check(ROOT / "examples" / "crossing" / "model.yaml")
    (safe,) = found.system.safe_regions
    assert len(safe.invariants) == 4
    assert safe.alone == ("walk",)


@pytest.mark.slow
def test_a_model_that_was_checked_before_has_the_same_contracts(tmp_path: Path) -> None:
    text = (ROOT / "examples" / "crossing" / "model.yaml").read_text()
    (tmp_path / "model.yaml").write_text(f"# {tmp_path}\n{text}")
    first = checking.check(tmp_path / "model.yaml").system.safe_regions
    assert first == checking.check(tmp_path / "model.yaml").system.safe_regions != ()
