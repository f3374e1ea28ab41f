# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Contracts of activities: what they may name, and what they become in Ada."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.gen.derive.kept import kept_of
from ravenchart.gen.emit.program import generate
from ravenchart.gen.language.names import LONG_NAME
from ravenchart.gen.language.terms import named
from ravenchart.gen.model.claims import Claims
from ravenchart.gen.model.component import Activity, Component
from ravenchart.gen.model.notation import shown_expression
from ravenchart.proof.contracts import HELPS
from ravenchart.proof.spark_results import Open
from ravenchart.proof.unproved import findings
from tests.support.pump import loaded

TEXT = """
system: Plant
types:
  Level: {range: [0, 100], unit: l}
  Mode: {values: [Idle, Busy]}
  Tank: {fields: {level: Level, mode: Mode}}
components:
  Unit:
    parameters: {limit: {type: Level, default: 80}}
    ports: {sensed: {in: Level}, opening: {out: Level}, shown: {out: Mode}}
    port_region: {period: 10 ms, wcet: 10 us}
    data:
      tank: {type: Tank, initial: {level: 0, mode: Idle}}
      spare: {type: Level, initial: 0}
      count: {type: Level, initial: 1}
    regions:
      Main:
        period: 10 ms
        wcet: 10 us
        initial: A
        states: {A: {}, B: {}}
        transitions: {go: {from: A, to: B, after: 1 s}, back: {from: B, to: A, after: 1 s}}
    activities:
      user:
        period: 10 ms
        wcet: 10 us
        reads: [tank, sensed, limit]
        writes: [tank, spare]
        sends: [opening]
        USER
        body: user
      flow:
        period: 10 ms
        wcet: 10 us
        FLOW
        body:
          - {if: in(Main.A), then: [{set: count, to: limit}, {send: shown, with: Idle}]}
nodes: {board: {context_switch: 1 us, critical_section: 1 us}}
instances: {one: {component: Unit, node: board}, two: {component: Unit, node: board}}
connections: [{from: one.opening, to: two.sensed}, {from: two.opening, to: one.sensed}]
processors:
  work:
    node: board
    stack: 16 KiB
    activities:
      [one.ports, two.ports, one.Main, two.Main, one.user, two.user, one.flow, two.flow]
shutdown: {raises: [], grace: 0 ms}
"""


def text(user: str = "", flow: str = "", more: str = "") -> str:
    """The model with contracts; ``more`` replaces the lists of the user's activity."""
    found = TEXT.replace("        USER\n", f"        {user}\n" if user else "")
    found = found.replace("        FLOW\n", f"        {flow}\n" if flow else "")
    old, _, new = more.partition(" -> ")
    assert not more or found.count(old) == 1
    return found.replace(old, new) if more else found


def component(user: str = "", flow: str = "") -> Component:
    """The component of the model, in which nothing is wrong."""
    result = loaded(text(user, flow))
    assert result.system is not None, result.diagnostics
    return result.system.components[0]


def said(user: str = "", flow: str = "", more: str = "") -> list[tuple[str, str, str | None]]:
    """The errors of a model: code, message and hint."""
    found = loaded(text(user, flow, more)).diagnostics
    return [(one.code, one.message, one.hint) for one in found if one.is_error]


def activity(found: Component, name: str) -> Activity:
    """An activity of the component."""
    return named(found.activities, name)


# --- the language


def test_a_condition_and_a_list_of_conditions_are_the_same() -> None:
    one = activity(component("requires: tank.level < limit"), "user")
    several = activity(component("requires: [tank.level < limit]"), "user")
    assert [shown_expression(c.condition) for c in one.requires] == ["tank.level < limit"]
    assert [c.condition for c in several.requires] == [c.condition for c in one.requires]


def test_a_condition_knows_its_line() -> None:
    found = activity(component("ensures: [tank.level < limit, spare = 0]"), "user")
    line = text("ensures: [tank.level < limit, spare = 0]").split("\n")
    places = [(c.origin.line, c.origin.column) for c in found.ensures]
    number = next(i for i, one in enumerate(line, 1) if "ensures" in one)
    assert places == [(number, 19), (number, 39)]


def test_old_is_the_value_before() -> None:
    found = activity(component("ensures: tank.level >= old(tank.level)"), "user")
    assert shown_expression(found.ensures[0].condition) == "tank.level >= old(tank.level)"


@pytest.mark.parametrize(
    ("user", "code", "message", "hint"),
    [
        (
            "requires: count > 1",
            "RV-0420",
            "user does not read `count`",
            "add `count` to `reads`",
        ),
        (
            "requires: spare > 1",
            "RV-0420",
            "user does not read `spare`",
            "add `spare` to `reads`",
        ),
        ("requires: in(Main.A)", "RV-0420", "user does not read `Main`", "add `Main` to `reads`"),
        (
            "requires: opening > 1",
            "RV-0420",
            "`opening` has no value before user sends it",
            "state the condition in `ensures`",
        ),
        (
            "ensures: shown = Busy",
            "RV-0420",
            "user does not send on `shown`",
            "add `shown` to `sends`, or to `calls` if it is a command",
        ),
        (
            "ensures: spare > old(spare)",
            "RV-0420",
            "user does not read `spare`",
            "add `spare` to `reads`",
        ),
        (
            "ensures: tank.level > old(limit)",
            "RV-0419",
            "user does not write `limit`",
            "name it without `old`: the execution does not change it",
        ),
        (
            "requires: tank.level > old(tank.level)",
            "RV-0419",
            "`old` has a meaning only in `ensures`",
            "name the data item itself",
        ),
        (
            "ensures: tank.level > old(tank.level + 1)",
            "RV-0409",
            "`old` takes the name of a data item, or of a field of it",
            None,
        ),
    ],
)
def test_what_a_contract_cannot_name(user: str, code: str, message: str, hint: str | None) -> None:
    assert said(user) == [(code, message, hint)]


@pytest.mark.parametrize(
    ("user", "more"),
    [
        ("requires: count > 1", "[tank, sensed, limit] -> [tank, sensed, limit, count]"),
        ("requires: in(Main.A)", "[tank, sensed, limit] -> [tank, sensed, limit, Main]"),
        ("ensures: spare > old(spare)", "[tank, sensed, limit] -> [tank, sensed, limit, spare]"),
        ("ensures: shown = Busy", "sends: [opening] -> sends: [opening, shown]"),
        ("ensures: tank.level > limit", ""),
        ("ensures: opening > 1", ""),
    ],
)
def test_what_a_hint_says_helps(user: str, more: str) -> None:
    assert said(user, more=more) == []


@pytest.mark.parametrize(
    ("user", "code"),
    [
        ("requires: tank.level", "RV-0404"),
        ("requires: tank.level > Busy", "RV-0410"),
        ("requires: tank.level > sensd", "RV-0403"),
        ("requires: tank.level >", "RV-0401"),
        ("ensures: {set: spare, to: 1}", "RV-0203"),
        ("ensures: [{set: spare, to: 1}]", "RV-0203"),
    ],
)
def test_conditions_are_conditions_of_the_language(user: str, code: str) -> None:
    assert [found[0] for found in said(user)] == [code]


def test_a_guard_has_no_old() -> None:
    found = said(more="in(Main.A), then -> old(count) > 1, then")
    assert [one[:2] for one in found] == [("RV-0419", "`old` has a meaning only in `ensures`")]


def test_a_flow_is_bound_by_what_it_does() -> None:
    assert said(flow="ensures: spare = 0") == [
        (
            "RV-0420",
            "the flow of flow does not read or write `spare`",
            "leave `spare` out of the contract",
        )
    ]
    assert said(flow="ensures: opening = 0")[0][1] == "the flow of flow does not send on `opening`"
    assert said(flow="ensures: ['count >= min(old(count), limit)', shown = Idle]") == []


def test_what_is_malformed_is_the_only_thing_said() -> None:
    found = said(flow='requires: ""\n        ensures: count >= old(count)')
    assert [one[0] for one in found] == ["RV-0203"]


# --- the program


def program(user: str = "", flow: str = "") -> dict[str, str]:
    """The generated files."""
    result = loaded(text(user, flow))
    assert result.system is not None, result.diagnostics
    return generate(result.system, Claims())


def squeezed(found: str) -> str:
    """The text with one space where there were several."""
    return " ".join(found.split())


def test_a_contract_is_pre_and_post_of_the_procedure() -> None:
    files = program(
        "requires: [tank.level < limit, stale(sensed)]\n"
        "        ensures: [opening = old(tank.level), tank.mode = Busy]"
    )
    spec = squeezed(files["plant-unit-activities.ads"])
    assert (
        "with Global => null, Pre => Tank.Level < Limit and then Sensed.State = Ravenchart.Stale, "
        "Post => Opening = Tank'Old.Level and then Tank.Mode = Plant.Busy;"
    ) in spec
    assert "use type Ravenchart.Freshness;" in spec


def test_what_a_flow_sends_is_ensured_where_it_sends() -> None:
    files = program(flow="ensures: shown = Idle")
    spec = squeezed(files["plant-unit-flows.ads"])
    assert "Post => (if Send_Shown then Shown = Plant.Idle);" in spec


def test_a_value_before_is_given_to_the_procedure() -> None:
    spec = program(flow="ensures: old(count) < count or count = old(count)")
    assert "Count : in out Plant.Level" in squeezed(spec["plant-unit-flows.ads"])


def test_data_that_are_required_keep_what_their_writer_ensures() -> None:
    user = "requires: tank.level < 95\n        ensures: tank.level <= 90 and spare = 0"
    files = program(user)
    spec = squeezed(files["plant-unit.ads"])
    assert (
        "function Tank_Is_Kept (Item : Plant.Tank) return Boolean is (Item.Level <= 90);"
    ) in spec
    assert "subtype Tank is Plant.Tank with Predicate => Tank_Is_Kept (Tank);" in spec
    assert "Spare_Is_Kept" not in spec  # nothing requires anything of it
    assert "Tank_Own : Unit.Kept.Tank :=" in squeezed(files["plant-one.adb"])


def test_a_long_name_fits_the_lines() -> None:
    """Names up to 24 characters always fit."""
    user = "requires: tank.level < 95\n        ensures: tank.level <= 90"
    result = loaded(text(user).replace("tank", "T" + "a" * (LONG_NAME - 1)))
    assert result.system is not None, result.diagnostics
    for name, found in generate(result.system, Claims()).items():
        assert name.endswith(".json") or max(map(len, found.split("\n"))) <= 79, name


def test_the_compiler_is_quiet_about_the_only_value_of_a_type() -> None:
    found = text("requires: only = 5\n        ensures: only = 5")
    found = found.replace("  Mode:", "  Only: {range: [5, 5]}\n  Mode:")
    found = found.replace("      tank: {", "      only: {type: Only, initial: 5}\n      tank: {")
    found = found.replace("[tank, s", "[only, s").replace("[tank, spare]", "[only, spare]")
    result = loaded(found)
    assert result.system is not None, result.diagnostics
    spec = generate(result.system, Claims())["plant-unit.ads"]
    assert "pragma Warnings (Off" in spec and "Only_Is_Kept" in spec


def test_a_model_without_contracts_has_none_in_ada() -> None:
    for name, found in program().items():
        assert not {"Pre =>", "Is_Kept", "Kept."} & {*found.split()}, name


@pytest.mark.parametrize(
    ("ensured", "known"),
    [
        ("tank.level <= 90", ["tank.level <= 90"]),
        ("[tank.level <= 90, tank.level > 1]", ["tank.level <= 90"]),  # it is 0 at first
        ("tank.level <= 90 and tank.mode = Idle", ["tank.level <= 90", "tank.mode = Idle"]),
        ("tank.level <= 90 or tank.mode = Busy", ["tank.level <= 90 or tank.mode = Busy"]),
        ("not (tank.level > 90)", ["not tank.level > 90"]),
        ("tank.level <= max(limit, 1)", []),
        ("tank.level <= old(tank.level)", []),
        (
            "(if tank.mode = Idle then tank.level else 1) * 2 < 1",
            ["(if tank.mode = Idle then tank.level else 1) * 2 < 1"],
        ),
        ("(if tank.mode = Idle then 1 else tank.level) * 2 < 1", []),
        ("max(abs(tank.level - 1), 2) = 2", ["max(abs(tank.level - 1), 2) = 2"]),
    ],
)
def test_what_is_known_of_a_data_item(ensured: str, known: list[str]) -> None:
    result = loaded(text(f"requires: tank.level < 95\n        ensures: {ensured}"))
    assert result.system is not None, result.diagnostics
    (found,) = result.system.components
    kept = kept_of(result.system, found, named(found.data, "tank"))
    assert [shown_expression(one) for one in kept] == known


# --- what gnatprove leaves

USER = """[tank.level < 95,
                   limit > 5 and tank.mode = Idle]
        ensures: [if tank.level > 5 then opening = 0 else opening > 1, tank.level <= 90]"""


@pytest.mark.parametrize(
    ("file", "entity", "at", "check", "element", "line"),
    [
        (
            "generated/plant-unit-activities.ads",
            "Plant.Unit.Activities.User",
            "Opening > 1",
            "postcondition might fail, cannot prove Opening > 1",
            "Unit.user.ensures",
            "ensures: [if",
        ),
        (
            "generated/plant-one.adb",
            "Plant.One.Run_User",
            "Unit.Activities.User",
            "precondition might fail, cannot prove Tank.Mode = Plant.idle (e.g. when Limit = 5)",
            "Unit.user.requires",
            "limit > 5 and",
        ),
        (
            "generated/plant-two.adb",
            "Plant.Two.Run_User",
            "Unit.Activities.User",
            "precondition might fail, cannot prove Tank.Level < 95",
            "Unit.user.requires",
            "requires: [tank.level",
        ),
    ],
)
def test_a_check_of_a_contract_names_the_condition(
    tmp_path: Path, file: str, entity: str, at: str, check: str, element: str, line: str
) -> None:
    user = f"requires: {USER}"
    for name, found in program(user).items():
        place = tmp_path / "generated" / name
        place.parent.mkdir(exist_ok=True)
        place.write_text(found)
    lines = (tmp_path / file).read_text().split("\n")
    number = next(i for i, one in enumerate(lines) if at in one)
    name = Path(file).name
    column = lines[number].index(at) + 1
    rule = f"VC_{check.partition(' ')[0].upper()}"
    one = Open(name, number + 1, column, rule, entity)
    system = loaded(text(user)).system
    assert system is not None
    told = f"{name}:{number + 1}:{column}: medium: {check}"
    (unproved,) = findings(told, [one], system, tmp_path, [tmp_path / "generated"])
    assert unproved.element == element
    assert unproved.origin is not None
    assert line in text(user).split("\n")[unproved.origin.line - 1]
    assert unproved.help == HELPS[element.rpartition(".")[2]]


def test_another_precondition_is_about_no_contract(tmp_path: Path) -> None:
    """One of the runtime, in the same procedure."""
    place = tmp_path / "plant-one.adb"
    place.write_text("      Unit.Event_Lists.Append (Box, Item);\n")
    one = Open(place.name, 1, 7, "VC_PRECONDITION", "Plant.One.Run_User")
    system = loaded(text("requires: tank.level < 95")).system
    assert system is not None
    told = f"{place.name}:1:7: medium: precondition might fail"
    (unproved,) = findings(told, [one], system, tmp_path, [tmp_path])
    assert unproved.element == "one"
