# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Bus load, the dependency graph, chains and the picture."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from xml.etree import ElementTree as Xml

import pytest

from ravenchart.analysis.present.picture import LEGIBLE, draw
from ravenchart.analysis.system.graph import Ways, component_view, dependencies
from ravenchart.analysis.system.network import frame_length
from ravenchart.analysis.system.timing import analyse
from ravenchart.gen.derive.ways import routed
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.system import Chain, System
from tests.support.plant_model import plant
from tests.support.systems import HERE, bus, message, stops_of, system


@pytest.mark.parametrize(
    ("length", "extended", "bits"),
    [(0, False, 55), (1, False, 65), (8, False, 135), (0, True, 80), (8, True, 160)],
)
def test_frames_are_taken_at_their_longest(length: int, extended: bool, bits: int) -> None:
    assert frame_length(message("a", length=length, extended=extended), bus()).nominal == bits


def test_the_load_of_a_bus_is_the_sum_of_its_messages() -> None:
    messages = [message("a", period=5_000_000), message("b", 2, length=0, period=10_000_000)]
    found = analyse(system([], (), [bus()], messages))
    assert [frame.transmission_time for frame in found.network.frames["bus"]] == [270_000, 110_000]
    assert found.bus_load(bus()) == Fraction(27, 500) + Fraction(11, 1000)


def test_frame_times_round_up() -> None:
    found = analyse(system([], (), [bus(bit_rate=300_000)], [message("a", length=0)]))
    assert found.network.frames["bus"][0].transmission_time == 183_334


def test_the_graph_holds_every_kind_of_edge_in_its_direction() -> None:
    graph = dependencies(plant())
    edges = {(str(a), str(b)): graph.edges[a, b]["kind"] for a, b in graph.edges}
    expected = {
        ("raw_level", "sensor.raw"): "carries",
        ("sensor.raw", "sensor.ports"): "handles",
        ("sensor.raw", "sensor.filter"): "reads",
        ("sensor.filter", "sensor.filtered"): "writes",
        ("sensor.filtered", "sensor.publish"): "reads",
        ("sensor.publish", "sensor.level"): "sends",
        ("sensor.level", "pump.level"): "carries",
        ("pump.Mode", "pump.drive"): "reads",
        ("pump.valve", "valve_position"): "carries",
        ("processor control", "pump.drive"): "runs",
        ("processor reception", "field.receive"): "runs",
        ("instance pump", "component Pump"): "is",
    }
    assert expected.items() <= edges.items()
    assert all("kind" in data for _, data in graph.nodes(data=True))


def test_parameters_are_no_nodes() -> None:
    assert "sensor.gain" not in map(str, dependencies(plant()))


def test_a_chain_leads_from_the_message_received_to_the_message_sent() -> None:
    assert Ways.of(plant()).between_messages() == (
        stops_of(
            "raw_level",
            "sensor.raw",
            "sensor.filter",
            "sensor.filtered",
            "sensor.publish",
            "sensor.level",
            "pump.level",
            "pump.drive",
            "pump.valve",
            "valve_position",
        ),
    )


def test_a_way_goes_through_the_places_named_or_says_where_it_is_broken() -> None:
    chains = (stops_of("raw_level", "pump.drive"), stops_of("pump.drive", "raw_level"))
    one = replace(plant(), chains=tuple(Chain("c", HERE, path, Ns(1), None) for path in chains))
    whole, broken = routed(one).chains
    assert (whole.way[0], whole.way[-1]) == stops_of("raw_level", "pump.drive")
    assert whole.gap is None
    assert broken.gap is not None and broken.way == ()
    assert (broken.gap.before, broken.gap.after) == ("pump.drive", "raw_level")


def boxes_of(svg: str) -> list[tuple[float, float]]:
    root = Xml.fromstring(svg)
    found = root.iter("{http://www.w3.org/2000/svg}rect")
    return [(float(r.attrib["x"]), float(r.attrib["y"])) for r in found]


def test_the_picture_holds_every_box_and_none_on_another() -> None:
    view = component_view(plant())
    svg = draw(view)
    assert svg is not None
    places = boxes_of(svg)
    assert len(places) == len(view) == 4
    apart = [
        abs(a[0] - b[0]) > 150 or abs(a[1] - b[1]) > 34
        for i, a in enumerate(places)
        for b in places[:i]
    ]
    assert all(apart)


def test_a_picture_with_circles_is_laid_out_too() -> None:
    one: System = plant()
    view = component_view(one)
    view.add_edge("pump", "sensor", ports=("back",))
    view.add_edge("pump", "pump", ports=("own",))
    assert draw(view) is not None


def test_an_empty_or_crowded_picture_is_left_out() -> None:
    assert draw(component_view(system([]))) is None
    crowd = [message(f"m{n}", n, target="a.b") for n in range(LEGIBLE + 1)]
    assert draw(component_view(system([], (), [bus()], crowd))) is None
