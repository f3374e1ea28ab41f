# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Arrays of instances in editors and in the workbench."""

from __future__ import annotations

import pytest

from ravenchart.editing.evaluation import Evaluation, evaluate
from ravenchart.editing.places import ModelPlaces
from ravenchart.language_server.completing import proposals
from ravenchart.language_server.model import OpenModel, model
from ravenchart.language_server.renaming import NotRenamedError, renamed
from ravenchart.language_server.symbols import ModelSymbol
from ravenchart.paths import ROOT
from ravenchart.workbench.changes import changed
from ravenchart.workbench.requests import Move, SetTime

PATH = ROOT / "tests/feature/arrays/model.yaml"
FEATURE = PATH.read_text(encoding="utf-8")


def opened(text: str) -> OpenModel:
    return model(PATH, {str(PATH): text})


def symbol(now: OpenModel, text: str, behind: str) -> ModelSymbol:
    """The name that begins behind some text."""
    found = now.symbols.at(str(PATH), text.index(behind) + len(behind))
    assert found is not None
    return found[0]


def with_name(now: OpenModel, text: str, one: ModelSymbol, new: str) -> str:
    (spans,) = renamed(now, one, new, {str(PATH): text}).values()
    for start, end in sorted(spans, reverse=True):
        text = text[:start] + new + text[end:]
    return text


# --- Language server -------------------------------------------------------------------


@pytest.mark.parametrize(
    "behind",
    [
        "{from: driver.wanted, to: ",
        "on_deadline_miss: [",
        "  driver: {component: Pilot, node: board}\n  ",
    ],
)
def test_the_name_of_an_array_is_one_symbol(behind: str) -> None:
    now = opened(FEATURE)
    wheel = symbol(now, FEATURE, behind)
    assert (wheel.name, wheel.kind) == ("wheel", "instance")
    assert len(wheel.tokens) == 1 + FEATURE.count("wheel_*")
    assert wheel.declared is not None
    assert FEATURE[wheel.declared[1] :].startswith("wheel:\n")


def test_another_name_of_an_array_changes_its_stars_and_its_elements() -> None:
    text = FEATURE.replace("raises: [wheel_*.Release]", "raises: [wheel_3.Release]")
    now = opened(text)
    made = with_name(now, text, symbol(now, text, "{from: driver.wanted, to: "), "rim")
    assert made == text.replace("wheel_", "rim_").replace("  wheel:\n", "  rim:\n")


def test_another_name_of_an_array_inside_a_composite() -> None:
    now = opened(FEATURE)
    made = with_name(now, FEATURE, symbol(now, FEATURE, "- axle_*."), "cell")
    assert made == FEATURE.replace("gauge_*", "cell_*").replace("gauge:", "cell:")


def test_a_numbered_port_that_a_star_stands_for_keeps_its_name() -> None:
    now = opened(FEATURE)
    one = symbol(now, FEATURE, "Panel:\n    ports:\n      ")
    with pytest.raises(NotRenamedError, match="there is no port of Panel named `speed_1`"):
        renamed(now, one, "rate", {str(PATH): FEATURE})


def test_an_editor_proposes_stars_and_elements() -> None:
    for behind in ("activities: [driver.steer, ", "{from: driver.wanted, to: "):
        offset = FEATURE.index(behind) + len(behind)
        text = f"{FEATURE[:offset]}w.{FEATURE[offset:].partition('.')[2]}"
        words = [one.word for one in proposals(PATH, str(PATH), offset + 1, {str(PATH): text})]
        assert {"wheel_*", "wheel_1", "wheel_4"} <= set(words)
        assert words.index("wheel_*") < words.index("wheel_1")


def test_an_editor_proposes_what_all_elements_have() -> None:
    behind = "activities: [driver.steer, wheel_*."
    offset = FEATURE.index(behind) + len(behind)
    words = {one.word for one in proposals(PATH, str(PATH), offset, {str(PATH): FEATURE})}
    assert words == {"ports", "Rolling", "control"}


def test_an_editor_proposes_the_key_count() -> None:
    text = FEATURE.replace("    count: 4\n", "    co\n")
    offset = text.index("    co\n") + len("    co")
    assert "count" in {one.word for one in proposals(PATH, str(PATH), offset, {str(PATH): text})}


# --- Workbench -------------------------------------------------------------------------


def wish_to_move(**given: object) -> Move:
    return Move.model_validate({"number": 0, "kind": "move", **given})


def wish_of_time(**given: object) -> SetTime:
    return SetTime.model_validate({"number": 0, "kind": "time", **given})


def state(text: str = FEATURE) -> Evaluation:
    return evaluate(PATH, {str(PATH): text.encode()})


def rows(places: ModelPlaces, processor: str) -> list[str]:
    return [row.element for row in places.table(places.processors[processor])]


def after(wish: Move | SetTime, text: str = FEATURE) -> tuple[Evaluation, str]:
    made = changed(state(text), wish).texts[str(PATH)].decode()
    found = state(made)
    assert not [one for one in found.found if one.is_error]
    return found, made


def test_the_workbench_sees_the_rows_of_all_elements() -> None:
    places = state().places
    system = state().loaded.system
    assert system is not None
    for processor in system.processors:
        assert rows(places, processor.name.lower()) == [one.element for one in processor.slots]
    gauge, wheel = places.components["gauge"], places.components["wheel"]
    assert places.instances_of(wheel) == [f"wheel_{number}" for number in range(1, 5)]
    assert places.instances_of(gauge) == [
        f"axle_{axle}.gauge_{number}" for axle in (1, 2) for number in (1, 2)
    ]


def test_a_row_of_an_element_moves_alone() -> None:
    found, made = after(wish_to_move(row="wheel_3.control", to="displays", place=0))
    assert rows(found.places, "displays")[0] == "wheel_3.control"
    assert rows(found.places, "wheels")[-3:] == [f"wheel_{n}.control" for n in (1, 2, 4)]
    assert "wheel_*.Rolling, wheel_1.control, wheel_2.control, wheel_4.control]" in made
    assert made.count("shadow_*.follow\n") == 1


def test_a_row_moves_between_those_of_an_array() -> None:
    found, made = after(wish_to_move(row="driver.steer", to="displays", place=2))
    assert rows(found.places, "displays")[:4] == [
        "shadow_1.ports", "shadow_2.ports", "driver.steer", "shadow_3.ports",
    ]  # fmt: skip
    assert "      - shadow_2.ports\n      - driver.steer\n      - shadow_3.ports\n" in made


def test_a_row_moves_behind_those_of_an_array_which_stay_one_item() -> None:
    found, made = after(wish_to_move(row="driver.steer", to="displays", place=4))
    assert rows(found.places, "displays")[4] == "driver.steer"
    assert "      - shadow_*.ports\n      - driver.steer\n      - shadow_*.follow\n" in made


@pytest.mark.parametrize("apart", [9, pytest.param(3, marks=pytest.mark.slow)])
def test_any_row_moves_to_any_place(apart: int) -> None:
    places = state().places
    for source, target in (("wheels", "displays"), ("displays", "wheels"), ("wheels", "wheels")):
        for row in rows(places, source)[::apart]:
            for place in range(0, len(rows(places, target)), apart + 1):
                wanted = [one for one in rows(places, target) if one != row]
                wanted.insert(place, row)
                made = changed(state(), wish_to_move(row=row, to=target, place=place)).texts
                assert rows(evaluate(PATH, made).places, target) == wanted


def test_a_time_of_an_element_is_that_of_all_of_them() -> None:
    _, made = after(wish_of_time(row="wheel_2.control", key="wcet", value="120 us"))
    assert made == FEATURE.replace("wcet: 100 us", "wcet: 120 us")
