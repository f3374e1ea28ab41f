# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Drawings of charts: every construct, the same bytes, nothing on top of anything else."""

from __future__ import annotations

import json
import re
import subprocess
from itertools import combinations
from pathlib import Path
from xml.etree import ElementTree

import pytest

from ravenchart.building import drawings
from ravenchart.commands import draw
from ravenchart.gen.draw import structure_text
from ravenchart.gen.draw.chart import chart_dot
from ravenchart.gen.draw.look import ROOM
from ravenchart.gen.draw.mermaid import mermaid
from ravenchart.gen.draw.picture import Arrow, Label, Picture, picture
from ravenchart.gen.draw.plantuml import plantuml
from ravenchart.gen.draw.structure import structure_dot
from ravenchart.gen.draw.wrapping import wrapped
from ravenchart.gen.pipeline import load
from ravenchart.paths import ROOT
from ravenchart.tools import toolchain
from ravenchart.tools.toolchain import ToolMissing
from tests.support.every_construct import every_construct
from tests.support.plant_model import plant
from tests.support.random_charts import model_of


def _picture() -> Picture:
    component = every_construct()
    return picture(component, component.region("Life"))


DOT = chart_dot(_picture())
SHOWN = DOT.replace(ROOM, "")


def test_a_simple_state_has_a_compartment_with_its_behaviours() -> None:
    assert re.search(r'"Idle" .*<b>Idle</b>.*<hr/>.*entry / set: level, to: 0<br', SHOWN)
    assert "Go / defer<br" in SHOWN
    assert "do / feed (every 20 ms)<br" in SHOWN


def test_internal_transitions_stand_in_the_compartment_and_are_no_edges() -> None:
    assert re.search(
        r'"header Work" .*exit / raise: Left<br[^>]*>Note / set: level, to: 2<br', SHOWN
    )
    assert DOT.count("Note / ") == 1


def test_orthogonal_regions_are_dashed_clusters_inside_their_state() -> None:
    both = DOT.index('subgraph "cluster Both"')
    left = DOT.index('subgraph "cluster Both Left_Half"')
    assert both < left < DOT.index('subgraph "cluster Both Right_Half"')
    assert DOT[left:].split("}")[0].count("dashed") == 1


@pytest.mark.parametrize(
    ("vertex", "look"),
    [
        ("initial  Life", 'shape="circle", style="filled"'),
        ("Work_End", 'shape="doublecircle"'),
        ("Pick", 'shape="diamond"'),
        ("Meet", 'shape="circle"'),
        ("Recent", 'label="H"'),
        ("All_Of_It", 'label="H*"'),
        ("Split", 'shape="box"'),
        ("Gather", 'shape="box"'),
        ("Dead", 'label="\u00d7"'),
    ],
)
def test_every_pseudostate_has_its_symbol(vertex: str, look: str) -> None:
    line = next(x for x in DOT.splitlines() if x.strip().startswith(f'"{vertex}" ['))
    assert look in line


def _edges(text: str) -> set[tuple[str, str, str]]:
    found = re.findall(r'"([^"]*)" -> "([^"]*)"(?: \[(.*)\])?;', text)
    return {edge for edge in found if 'style="invis"' not in edge[2]}


def test_a_transition_goes_by_way_of_its_label() -> None:
    assert ("First", "First to Pick", 'arrowhead="none"') in _edges(DOT)
    assert ("First to Pick", "Pick", "") in _edges(DOT)
    assert re.search(r'"First to Pick" .*after 50 ms<br', SHOWN)
    assert re.search(r'"Second to Inner" .*every 10 ms<br', SHOWN)
    assert re.search(r'"Inner to Work_End" .*when stale\(probe\)<br', SHOWN)
    assert re.search(r'"Pick to Second" .*\[level &lt;= 3\] / set: level, to: 4<br', SHOWN)


def test_a_transition_without_label_is_one_edge() -> None:
    assert ("Split", "L1", "") in _edges(DOT)


def test_edges_of_composite_states_are_clipped_at_their_border() -> None:
    assert ("Idle to Work", "header Work", 'lhead="cluster Work"') in _edges(DOT)
    assert ("foot Both", "Both to Failed", 'arrowhead="none", ltail="cluster Both"') in _edges(DOT)


def test_a_transition_that_leads_back_is_turned_round_for_graphviz() -> None:
    assert ("Idle", "Meet to Idle", 'dir="back", arrowtail="vee"') in _edges(DOT)
    assert ("Meet to Idle", "Meet", 'arrowhead="none"') in _edges(DOT)


@pytest.mark.parametrize("name", ["Work to First", "Deepest to Work", "Work to Work"])
def test_between_a_composite_and_what_is_inside_the_label_stands_outside(name: str) -> None:
    work = DOT[DOT.index('subgraph "cluster Work"') : DOT.index('subgraph "cluster Both"')]
    assert f'"{name}" [' in DOT
    assert f'"{name}" [' not in work


def test_a_local_transition_stays_inside() -> None:
    work = DOT[DOT.index('subgraph "cluster Work"') : DOT.index('subgraph "cluster Both"')]
    assert '"Work to Second inside" [' in work
    assert ("header Work", "Work to Second inside", 'arrowhead="none"') in _edges(DOT)


def test_transitions_between_the_same_states_share_an_arrow() -> None:
    component = every_construct()
    life = component.region("Life")
    chart = picture(component, life)
    twice = Picture(chart.title, "", chart.area, (*chart.arrows, chart.arrows[0]))
    label = next(x for x in chart_dot(twice).splitlines() if '"Idle to Work" [' in x)
    assert label.count("Go [event &lt; 9]") == 2


def test_long_labels_break_where_a_reader_would() -> None:
    label = Label("Ordered", "order.kind = Home and fresh(feedback)", ("set: homed, to: true",))
    assert wrapped(label) == (
        "Ordered",
        "[order.kind = Home",
        "   and fresh(feedback)] /",
        "   set: homed, to: true",
    )


def test_a_way_out_and_in_again_without_label_bends_at_a_point() -> None:
    chart = _picture()
    bare = Picture(chart.title, "", chart.area, (Arrow("Work", "First", Label()),))
    dot = chart_dot(bare)
    assert '"Work to First" [shape="point"' in dot
    assert ("First", "Work to First", 'dir="back", arrowtail="vee"') in _edges(dot)


# --- What Graphviz makes of it ---------------------------------------------------


Box = tuple[float, float, float, float]


def _laid_out(dot: str) -> tuple[dict[str, Box], list[tuple[Box, set[str]]]]:
    """The boxes of the nodes, and of each cluster with the names of its nodes."""
    graph = json.loads(toolchain.filtered("dot", ["-Tjson"], dot))
    nodes: dict[str, Box] = {}
    names: dict[int, str] = {}
    clusters = []
    for item in graph["objects"]:
        names[item["_gvid"]] = item["name"]
        if "pos" in item:
            x, y = map(float, item["pos"].split(","))
            w, h = (float(item[key]) * 36 for key in ("width", "height"))
            nodes[item["name"]] = (x - w, y - h, x + w, y + h)
    for item in graph["objects"]:
        if "bb" in item:
            x0, y0, x1, y1 = map(float, item["bb"].split(","))
            inside = {names[number] for number in item.get("nodes", ())}
            clusters.append(((x0, y0, x1, y1), inside))
    return nodes, clusters


def _overlap(one: Box, other: Box) -> bool:
    room = 0.5
    return (
        one[0] + room < other[2]
        and other[0] + room < one[2]
        and one[1] + room < other[3]
        and other[1] + room < one[3]
    )


DRAWN = pytest.mark.parametrize("dot", (DOT, structure_dot(plant())), ids=("chart", "structure"))


@DRAWN
def test_nothing_lies_on_anything_else(dot: str) -> None:
    nodes, clusters = _laid_out(dot)
    assert len(nodes) > 5 and clusters
    for (one, first), (other, second) in combinations(nodes.items(), 2):
        assert not _overlap(first, second), (one, other)
    for border, inside in clusters:
        strangers = [n for n, box in nodes.items() if n not in inside and _overlap(box, border)]
        assert strangers == []


def test_random_charts_can_be_drawn(tmp_path: Path) -> None:
    model = tmp_path / "model.yaml"
    model.write_text(model_of(range(1, 5)))
    system = load(model).system
    assert system is not None
    drawn = [text for name, text in drawings.texts(system).items() if name.startswith("Chart_")]
    assert len(drawn) >= 4
    for dot in drawn:
        done = subprocess.run(["dot", "-Tsvg"], input=dot, capture_output=True, encoding="utf-8")
        assert (done.returncode, done.stderr) == (0, "")


def _number(text: str) -> float:
    return float(text.removesuffix("pt"))


@DRAWN
def test_the_svg_is_well_formed_and_holds_all_its_text(dot: str) -> None:
    root = ElementTree.fromstring(drawings.svg(dot))
    space = "{http://www.w3.org/2000/svg}"
    width, height = _number(root.attrib["width"]), _number(root.attrib["height"])
    move = root.find(f"{space}g")
    assert move is not None
    shift = re.search(r"translate\(([\d.]+) ([\d.]+)\)", move.attrib["transform"])
    assert shift is not None
    texts = root.findall(f".//{space}text")
    assert len(texts) > 5
    for text in texts:
        x = _number(text.attrib["x"]) + float(shift[1])
        y = _number(text.attrib["y"]) + float(shift[2])
        wide = len("".join(text.itertext()).rstrip()) * _number(text.attrib["font-size"]) * 0.45
        half = {"start": 0.0, "middle": 0.5, "end": 1.0}[text.attrib["text-anchor"]]
        assert x - half * wide >= 0 and x + (1 - half) * wide <= width
        assert 0 < y <= height


def test_the_svg_says_whose_picture_it_is_and_no_more() -> None:
    svg = drawings.svg(DOT)
    assert drawings.svg(DOT) == svg
    assert "<!--" not in svg and "graphviz" not in svg.lower()
    assert "<desc>ravenchart draw, DOT sha256 " in svg


def test_without_graphviz_the_text_formats_still_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    draw.write(drawings.texts(plant(), "plantuml"), tmp_path)
    draw.write(drawings.texts(plant(), "mermaid"), tmp_path)
    with pytest.raises(ToolMissing, match="Debian package graphviz"):
        draw.write(drawings.texts(plant()), tmp_path / "svg")
    assert not (tmp_path / "svg").exists()
    assert sorted(p.name for p in tmp_path.iterdir()) == [
        "Pump.Mode.mmd",
        "Pump.Mode.puml",
        "structure.mmd",
        "structure.puml",
    ]


# --- PlantUML and Mermaid --------------------------------------------------------


def test_plantuml_has_every_construct() -> None:
    text = plantuml(_picture())
    for line in (
        "  state Work_End <<end>>",
        "  state Recent <<history>>",
        "  state All_Of_It <<history*>>",
        "state Pick <<choice>>",
        "state Split <<fork>>",
        "state Gather <<join>>",
        "Work : Note / set: level, to: 2",
        "  [*] --> First : / set: level, to: 7",
        "  --",
        "Pick --> Split : [else]",
        "Work --> Second : local: Inside",
    ):
        assert line in text.splitlines()
    assert text.count("{") - text.count("[{") == text.count("}") - text.count("}]")


def test_plantuml_says_what_it_cannot_draw() -> None:
    remarks = [line for line in plantuml(_picture()).splitlines() if line.startswith("'")]
    assert [word in " ".join(remarks) for word in ("junction", "terminate", "local")] == [True] * 3


def test_mermaid_has_each_transition_in_the_area_around_it() -> None:
    lines = mermaid(_picture()).splitlines()
    for line in (
        "    Recent --> Second",
        "    Inner --> [*] : when stale(probe)",
        "  Pick --> Second : [level #lt;= 3] / set#58; level, to#58; 4",
        "  state Pick <<choice>>",
        "  state Split <<fork>>",
        '    state "H*" as All_Of_It',
        "    --",
        "  note right of Work",
    ):
        assert line in lines


def test_mermaid_says_what_it_cannot_draw() -> None:
    remarks = " ".join(x for x in mermaid(_picture()).splitlines() if x.startswith("  %%"))
    for word in ("history", "terminate", "junction", "compartments", "local"):
        assert word in remarks


def test_structure_has_interfaces_devices_and_what_each_is_bound_to() -> None:
    system = load(ROOT / "examples" / "surgical_robot" / "model.yaml").system
    assert system is not None
    dot = structure_dot(system)
    for line in (
        '"supervisor_1" -> "servo_1" [tailport="requires Arm:e", headport="provides Motion:w"',
        '"servo_1" -> "device Boards" [tailport="requires Joints:e", style="dashed"]',
        '"servo_1" -> "device Wrist" [tailport="requires Joints:e", style="dashed"]',
        '"device Boards" -> "device Left" [dir="back", arrowtail="odiamond"',
        "<b>Wrist</b> : Force_Sensor</td></tr><tr><td>Get_Force<",
    ):
        assert line in dot
    assert "Camera" not in dot  # nothing is bound to it
    text = structure_text.plantuml(system)
    assert "servo_1 ..> device_Boards : Joints\n" in text
    assert "supervisor_1 ..> servo_1 : Arm\n" in text


def test_structure_has_instances_ports_wires_messages_and_tables() -> None:
    dot = structure_dot(plant())
    assert '<td port="level" bgcolor="#e6ebf0">level</td>' in dot
    assert '"sensor" -> "pump" [tailport="level:e", headport="level:w"];' in dot
    assert "raw_level<br/>0x100, 5 ms" in dot and "valve_position<br/>0x00000101, 10 ms" in dot
    assert ("sensor", "message raw_level") in {edge[:2] for edge in _edges(dot)}
    assert dot.index("pump.Mode") < dot.index("pump.drive")
    assert 'subgraph "cluster processor control"' in dot and 'subgraph "cluster node cpu"' in dot
    assert "bus <b>field</b>" in dot and "500 kbit/s" in dot


@pytest.mark.parametrize("form", drawings.FORMATS)
def test_drawings_are_the_same_each_time_and_name_no_path(form: str) -> None:
    first, second = drawings.texts(plant(), form), drawings.texts(plant(), form)
    assert first == second
    assert all("plant.yaml" not in text and str(ROOT) not in text for text in first.values())
