# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Plants of scenarios: classes of users and Functional Mock-up Units, sound and not."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from ravenchart.building import checking
from ravenchart.failures import Refused
from ravenchart.hw_can.bench import fmi, plants
from ravenchart.hw_can.bench.forms import PlantForm
from ravenchart.hw_can.bench.peer import BenchError, FrameValues, Value
from ravenchart.hw_can.bench.plant_stations import PlantStation
from ravenchart.hw_can.bench.plants import PlantError
from ravenchart.hw_can.bench.scenario import ScenarioError, parse_scenario
from ravenchart.running import scenarios
from tests.support.fmus import oven_unit
from tests.support.listings import listing

PAGE = "plants.md"
BODY = """\
from ravenchart.hw_can.bench.plants import Plant
class One(Plant):
    inputs = ("push",)
    outputs = ("place", "name")
    def __init__(self, parameters):
        if parameters.get("size", 1) < 0:
            raise ValueError("size must not be negative")
        self.place = 0.0
    def take(self, name, value):
        self.place += 1 / (3 - value)
    def advance(self, until):
        self.until = until
    def value(self, name):
        return self.place if name == "place" else "Far"
class Half(Plant):
    def __init__(self, parameters):
        pass
class Other:
    pass
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "one.py").write_text(BODY)
    (tmp_path / "bad.py").write_text("x = 1\nraise OSError('no')\n")
    (tmp_path / "torn.py").write_text("x = 1\ndef f(:\n")
    return tmp_path


@pytest.mark.parametrize(
    ("reference", "told"),
    [
        ("none.py:One", "there is no file .*none.py"),
        ("one.py:Two", "one.py has no class `Two`"),
        ("one.py:Plant", "Plant does not define `__init__`"),
        ("one.py:Other", "Other is not derived from ravenchart.hw_can.bench.plants.Plant"),
        ("one.py:Half", "Half does not define `advance`"),
        ("bad.py:One", "bad.py:2: OSError: no"),
        ("torn.py:One", "torn.py:2: SyntaxError: "),
    ],
)
def test_a_class_that_is_no_plant_is_refused(folder: Path, reference: str, told: str) -> None:
    before = list(sys.path)
    with pytest.raises(PlantError, match=told):
        plants.loaded(reference, folder, {})
    assert sys.path == before


def test_a_wrong_parameter_has_the_line_of_the_users_file(folder: Path) -> None:
    with pytest.raises(PlantError, match=r"one.py:7: ValueError: size must not be negative"):
        plants.loaded("one.py:One", folder, {"size": -1})


class _Sent:
    """Stands in for a peer: keeps what is sent."""

    def __init__(self) -> None:
        self.sent: list[tuple[str, FrameValues]] = []

    def send(self, message: str, values: FrameValues) -> None:
        self.sent.append((message, values))


def station(folder: Path, **more: object) -> PlantStation:
    form = PlantForm.model_validate({"class": "one.py:One", **more})
    return PlantStation("one", form, plants.loaded("one.py:One", folder, {}))


def test_values_go_both_ways_at_the_period(folder: Path) -> None:
    outputs = {"report.place": "place", "report.name": "name", "other.place": "place"}
    one = station(folder, inputs={"push": "order.force"}, outputs=outputs, period="10 ms")
    peer = _Sent()
    one.take("order", {"force": 1})
    one.take("order", {"strength": 2})
    one.take("others", {"force": 2})
    for tick in range(1, 5):
        one.advance(tick * 0.005)
        one.send(peer, tick * 0.005, 0.005)  # type: ignore[arg-type]
        one.record(tick * 0.005)
    values = [("report", {"place": 0.5, "name": "Far"}), ("other", {"place": 0.5})]
    assert peer.sent == values * 2  # at 10 and 20 ms
    assert one.track.values == {"place": [0.5] * 4}
    one.silent = True
    one.send(peer, 0.03, 0.005)  # type: ignore[arg-type]
    assert len(peer.sent) == 4


def test_what_a_plant_raises_in_a_run_has_its_line(folder: Path) -> None:
    with pytest.raises(BenchError, match=r"one.py:10: ZeroDivisionError: division by zero"):
        station(folder).set("push", 3)


@pytest.mark.parametrize("version", [2, 3])
def test_a_unit_is_a_plant(tmp_path: Path, version: int) -> None:
    unit = fmi.loaded(oven_unit(tmp_path / "oven.fmu", version), {"loss": 0}, 0.01)
    assert unit.inputs == ("heater", "loss", "door")
    assert unit.outputs == ("temperature", "count")
    unit.advance(0.025)
    assert (unit.value("temperature"), unit.value("count")) == (20.0, 2)
    unit.take("heater", "Hot")
    unit.advance(0.03)
    assert unit.value("temperature") == pytest.approx(20 + 2000 * 0.01 / 20)
    unit.take("heater", "Cold")
    unit.take("loss", 10)
    unit.take("door", 1)
    unit.advance(0.04)
    assert unit.value("temperature") == pytest.approx(21 - 100 * 1 * 0.01 / 20)
    assert unit.value("count") == 4
    with pytest.raises(PlantError, match=r"heater cannot be `Warm`: it is a Enumeration"):
        unit.take("heater", "Warm")
    unit.close()


@pytest.mark.parametrize(
    ("parameters", "content", "told"),
    [
        ({"wide": 1}, None, "oven.fmu has no variable `wide`"),
        ({"loss": "much"}, None, "loss cannot be `much`: it is a Float64"),
        ({}, b"no archive", "oven.fmu.*: "),
    ],
)
def test_a_unit_that_cannot_be_had_is_refused(
    tmp_path: Path, parameters: dict[str, Value], content: bytes | None, told: str
) -> None:
    path = oven_unit(tmp_path / "oven.fmu", 3)
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(PlantError, match=told):
        fmi.loaded(path, parameters, 0.01)


def test_without_fmpy_a_unit_names_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "oven.fmu").write_bytes(b"")
    monkeypatch.setitem(sys.modules, "fmpy", None)
    with pytest.raises(PlantError, match="python -m pip install fmpy"):
        fmi.loaded(tmp_path / "oven.fmu", {}, 0.01)


SCENARIO = """\
scenario: S
plants:
  one:
    class: one.py:One
steps:
  - wait: 10 ms
"""


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("class: one.py:One", "class: one.py", "`class`"),
        ("    class: one.py:One", "    period: 10 ms", "exactly one of `class` and `fmu`"),
        ("One", "One\n    fmu: one.fmu", "exactly one of `class` and `fmu`"),
        ("One", "One\n    period: 7 ms", "7 ms is no multiple of 5 ms, the bench's period"),
        ("One", "One\n    period: 0 ms", "0 ms is no multiple of 5 ms"),
        ("wait: 10 ms", "{set: two.push, to: 1}", "there is no plant `two`"),
        ("wait: 10 ms", "{expect_output: two.place, is: 1}", "there is no plant `two`"),
        ("wait: 10 ms", "{expect_output: one.place}", "give `is`, or `at_least` or `at_most`"),
        ("wait: 10 ms", "stop_feedback: two", "there is no drive or plant `two`"),
        (
            "wait: 10 ms",
            "{expect_output: one.place, at_least: 3, at_most: 2}",
            "no value is at least 3 and at most 2",
        ),
    ],
)
def test_a_scenario_with_a_wrong_plant_is_refused(old: str, new: str, told: str) -> None:
    parse_scenario(SCENARIO)
    changed = SCENARIO.replace(old, new, 1)
    with pytest.raises(ScenarioError) as refused:
        parse_scenario(changed)
    assert told in str(refused.value)


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("oven.py:Oven", "oven.py:Stove", "the plant oven cannot be loaded: oven.py has no class"),
        ("capacity: 20", "capacity: 0", "ValueError: capacity must be above 0"),
        ("heater: heater.value", "fan: heater.value", "oven has no input `fan`"),
        (".value: temperature", ".value: heat", "oven has no output `heat`"),
        ("heater.value", "heater.watts", "heater has no field `watts`"),
        ("thermometer.value", "heater.value", "a node of the model sends heater"),
        ("set: oven.door", "set: oven.window", "oven has no input `window`"),
        ("output: oven.temperature", "output: oven.heat", "oven has no output `heat`"),
    ],
)
def test_names_are_held_against_model_and_plant(
    tmp_path: Path, old: str, new: str, told: str
) -> None:
    model, plant, scenario = (
        listing(PAGE, name) for name in ("model.yaml", "oven.py", "warm.yaml")
    )
    (tmp_path / "model.yaml").write_text(model)
    (tmp_path / "oven.py").write_text(plant)
    path = tmp_path / "warm.yaml"
    path.write_text(scenario)
    system = checking.check(tmp_path / "model.yaml").system
    assert system is not None
    scenarios.checked(path, system)
    assert old in scenario
    path.write_text(scenario.replace(old, new, 1))
    with pytest.raises(Refused) as refused:
        scenarios.checked(path, system)
    assert told in str(refused.value)
    assert "warm.yaml:" in str(refused.value)
