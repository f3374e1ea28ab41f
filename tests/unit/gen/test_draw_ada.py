# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Charts drawn from generated Ada: the picture is that of the model they came from."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from ravenchart.command_line import main
from ravenchart.failures import WRONG
from ravenchart.gen.draw.ada_chart import picture_of_ada
from ravenchart.gen.draw.ada_text import NotDeclaredError
from ravenchart.gen.draw.chart import chart_dot
from ravenchart.gen.draw.picture import Picture, Shape
from ravenchart.gen.emit.ada.text import print_unit
from ravenchart.gen.emit.charts.declared import emit_region
from ravenchart.gen.emit.components.packages import emit_component
from ravenchart.gen.model.component import Component
from ravenchart.paths import ROOT
from tests.support.every_construct import every_construct
from tests.support.plant_model import plant

CHARTS = sorted(
    path
    for path in (ROOT / "examples").glob("*/generated/*.ads")
    if "function Target" in path.read_text()
)


def _texts(component: Component | None = None) -> dict[str, str]:
    """The specs of the component and of its region, by file name."""
    component = component or every_construct()
    system = replace(plant(), components=(component,))
    region = emit_region(system, component, component.region("Life"), "header")
    units = (emit_component(system, component, "header"), *region)
    return {unit.file_name: print_unit(unit) for unit in units}


def _picture() -> Picture:
    return picture_of_ada("plant-every-life.ads", _texts().get)


def _renamed(old: str, new: str) -> Component:
    """The component with another name of one transition."""
    component = every_construct()
    life = component.region("Life")
    moves = tuple(replace(t, name=new if t.name == old else t.name) for t in life.transitions)
    regions = (replace(life, transitions=moves), *component.regions[1:])
    return replace(component, regions=regions)


def _arrows(chart: Picture) -> set[tuple[str, str, str]]:
    return {(a.source, a.target, a.label.text) for a in chart.arrows}


def test_states_stand_where_the_model_has_them() -> None:
    chart = _picture()
    around = {v.name: places[0] for v, places in chart.vertices()}
    assert chart.title == "Every.Life"
    assert chart.area.initial == "Idle"
    assert around["Deepest"] == ("Inner", "")
    assert around["Inner"] == ("Work", "")
    assert around["L_End"] == ("Both", "Left_Half")
    assert around["R2"] == ("Both", "Right_Half")
    assert {a.initial for (owner, _), a in chart.areas() if owner == "Both"} == {"L1", "R1"}


def test_transitions_have_source_trigger_guard_and_target_of_the_declared_form() -> None:
    arrows = _arrows(_picture())
    for arrow in (
        ("Idle", "First", "Go [Item.Value_Level < 9]"),
        ("First", "Pick", "time-out Decide"),
        ("Inner", "Work_End", "when Ins.Probe.State = Ravenchart.Stale"),
        ("L1", "L_End", "Go"),
        ("Both", "Failed", "Left"),
        ("Pick", "Second", "[Data.Level <= 3]"),
    ):
        assert arrow in arrows


def test_joins_and_forks_are_bars() -> None:
    arrows = {arrow[:2] for arrow in _arrows(_picture())}
    join = "Right_Join_Then_Joined_Join"
    assert {("R2", join), ("L1", join), (join, "Idle")} <= arrows
    assert {("Pick", "Much_Fork"), ("Much_Fork", "R2"), ("Much_Fork", "L1")} <= arrows


def test_what_an_execution_passes_has_its_symbol() -> None:
    shapes = {v.name: v.shape for v, _ in _picture().vertices()}
    assert shapes["Pick"] is Shape.CHOICE
    assert shapes["Recent"] is Shape.HISTORY
    assert shapes["All_Of_It"] is Shape.DEEP_HISTORY


def test_internal_transitions_and_deferrals_stand_in_their_state() -> None:
    inside = {v.name: [b.text for b in v.behaviours] for v, _ in _picture().vertices()}
    assert inside["Work"] == ["Note"]
    assert inside["Idle"] == ["Go / defer"]


def test_a_transition_named_like_a_deferral_is_drawn_as_a_transition() -> None:
    texts = _texts(_renamed("note", "defer_portion"))
    assert "Defer_Portion" in texts["plant-every-life.ads"]
    chart = picture_of_ada("plant-every-life.ads", texts.get)
    inside = {v.name: [b.text for b in v.behaviours] for v, _ in chart.vertices()}
    assert (inside["Work"], inside["Idle"]) == (["Note"], ["Go / defer"])


def test_a_shallow_history_that_enters_a_state_named_like_a_deep_one_is_shallow() -> None:
    texts = _texts()
    spec = texts["plant-every-life.ads"]
    beside = "Top => Shallow_Work (Past), In_Left_Half => Life_States.Deep_Water"
    changed = spec.replace("Top => Shallow_Work (Past)", beside, 1)
    assert changed != spec
    chart = picture_of_ada("plant-every-life.ads", {**texts, "plant-every-life.ads": changed}.get)
    shapes = {v.name: v.shape for v, _ in chart.vertices()}
    assert (shapes["Recent"], shapes["All_Of_It"]) == (Shape.HISTORY, Shape.DEEP_HISTORY)


def test_a_changed_target_is_seen_in_the_picture() -> None:
    texts = _texts()
    spec = texts["plant-every-life.ads"]
    changed = spec.replace("Top => Life_States.Work_End", "Top => Life_States.Second", 1)
    assert changed != spec
    wrong = picture_of_ada("plant-every-life.ads", {**texts, "plant-every-life.ads": changed}.get)
    assert _arrows(wrong) - _arrows(_picture()) == {
        ("Inner", "Second", "when Ins.Probe.State = Ravenchart.Stale")
    }


@pytest.mark.parametrize("path", CHARTS, ids=lambda path: path.name)
def test_every_generated_chart_can_be_drawn(path: Path) -> None:
    chart = picture_of_ada(path.name, lambda name: path.with_name(name).read_text())
    assert chart.arrows or any(v.behaviours for v, _ in chart.vertices())
    assert chart_dot(chart) == chart_dot(chart)


def test_the_examples_have_charts() -> None:
    assert len(CHARTS) >= 7


def test_a_text_without_declared_form_is_refused() -> None:
    texts = {"p-c.ads": "package P.C with SPARK_Mode is\nend P.C;", "p.ads": "package P is end P;"}
    with pytest.raises(NotDeclaredError, match=r"p-c\.ads: no functions Enabled and Target"):
        picture_of_ada("p-c.ads", texts.get)
    with pytest.raises(NotDeclaredError, match="that of its component"):
        picture_of_ada("alone.ads", texts.get)


def test_the_command_draws_from_ada(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name, text in _texts().items():
        (tmp_path / name).write_text(text)
    spec = tmp_path / "plant-every-life.ads"
    assert main(["draw", "--from-ada", str(spec), "--format", "plantuml"]) == 0
    drawn = (tmp_path / "drawings" / "Every.Life.puml").read_text()
    assert "Idle --> First : Go [Item.Value_Level < 9]" in drawn
    assert main(["draw", "--from-ada", str(tmp_path / "plant-every.ads")]) == WRONG
    assert "of a region and that of its component" in capsys.readouterr().err
