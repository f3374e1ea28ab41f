# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Measured execution times and bounds of static tools, beside what a model claims."""

from __future__ import annotations

import argparse
import io
from pathlib import Path

import pytest
import yaml
from rich.console import Console

from ravenchart.analysis.plain.bounds import Bound, function_of, read_bounds
from ravenchart.analysis.system.observed import Observation, read_map, read_trace
from ravenchart.building import checking
from ravenchart.command_line import main
from ravenchart.commands import bounds, measure
from ravenchart.failures import OK, WRONG
from ravenchart.gen.language.quantities import parsed_duration
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.system import System
from ravenchart.paths import ROOT
from ravenchart.running import measured, summary
from ravenchart.running.measured import Measurement

EXAMPLES = sorted(path.parent for path in (ROOT / "examples").glob("*/model.yaml"))
PUMP = ROOT / "examples" / "pump"
ROW = "bed.Infusion"
GOOD = """\
row,wcet_us
bed.ports,99.9
BED.infusion,0.3

function,cycles,clock_hz
infusion_system__bed__run_turn,1000001,100000000
"""


@pytest.fixture(scope="module")
def system() -> System:
    return checking.check(PUMP / "model.yaml").system


def given(system: System, text: str) -> dict[str, Bound]:
    found = read_bounds(text, "b.csv", system)
    assert isinstance(found, dict), [str(one) for one in found]
    return found


def problems(system: System, text: str) -> list[str]:
    found = read_bounds(text, "b.csv", system)
    assert isinstance(found, tuple)
    return [str(one) for one in found]


def observation(times: dict[str, int], transitions: int = 0) -> Observation:
    text = (PUMP / "generated" / "trace.json").read_text(encoding="utf-8")
    names = read_map(text)
    region = names.named(ROW, "region")
    lines = [f"T 5 TRANSITION {region.number} {n}" for n in (0, 0, 1)[:transitions]]
    lines += [f"A {names.named(name, 'row').number} {time}" for name, time in times.items()]
    return read_trace([*lines, "END"], names)


def measurement(
    system: System, times: dict[str, int], bound: dict[str, Bound] | None = None, margin: int = 20
) -> Measurement:
    seen = observation(times, 3)
    return measured.measured(system, seen, "moon", "its clock", "a run", margin, bound or {})


# --- Measurements -------------------------------------------------------------------


def test_a_proposal_is_the_longest_time_and_the_margin_rounded_up(system: System) -> None:
    found = measurement(system, {ROW: 10_001, "bed.ports": 7}, margin=25)
    rows = {one.row: one for one in found.rows}
    assert (rows[ROW].measured, rows[ROW].proposed) == (10_001, 12_502)
    assert rows["bed.ports"].proposed == 9
    assert rows["bed.turn"].measured is None and rows["bed.turn"].proposed is None
    assert {one.region: (one.taken, one.transitions > 2) for one in found.coverage}[ROW] == (
        2,
        True,
    )


def test_a_row_that_took_no_time_was_not_executed(system: System) -> None:
    rows = {one.row: one for one in measurement(system, {ROW: 0}).rows}
    assert rows[ROW].measured is None


def test_what_no_run_measures_is_named(system: System) -> None:
    robot = checking.check(ROOT / "examples" / "cartesian_robot" / "model.yaml").system
    text = (ROOT / "examples/cartesian_robot/generated/trace.json").read_text(encoding="utf-8")
    seen = read_trace(["END"], read_map(text))
    found = measured.measured(robot, seen, "t", "c", "r", 0, {})
    assert found.not_measured == [
        "controller.probe.wcet",
        "controller.supervision.wcet",
        "robot_bus.driver_wcet",
    ]


def test_the_yaml_has_times_for_the_model_and_the_warning(system: System) -> None:
    text = measured.text(measurement(system, {ROW: 10_001}), system)
    assert text.startswith(f"# Execution times {measured.WARNING}.\n")
    content = yaml.safe_load(text)
    assert content["wcet"] == {"Pump.Infusion": "12.1 us"}
    assert parsed_duration(content["wcet"]["Pump.Infusion"]) == 12_100
    assert content["rows"] == {ROW: {"measured": "10.1 us", "model": "300 us"}}
    assert content["margin"] == "20 %"
    assert "bed.ports" in content["not_executed"]
    assert content["transitions_taken"][ROW].startswith("2 of ")


def test_of_several_instances_the_longest_counts() -> None:
    robot = checking.check(ROOT / "examples" / "cartesian_robot" / "model.yaml").system
    found = measured.measured(robot, observation({}), "t", "c", "r", 0, {})
    for one in found.rows:
        if one.row.endswith(".supervise"):
            one.proposed = {"x": 5, "y": 9, "z": 7}[one.row[6]]
    assert measured.proposed(found, robot) == {"Joint.supervise": 9}


def test_the_table_says_what_it_is(system: System) -> None:
    out = io.StringIO()
    console = Console(file=out, width=80, highlight=False)
    summary.print_measurement(console, measurement(system, {ROW: 300_001}))
    text = " ".join(out.getvalue().split())
    assert f"{ROW} 300.001 361 300 100.0004 % ABOVE" in text
    assert "Measured in one run, and no bounds" in text
    assert "Times are its clock." in text
    assert "Not executed: ward.receive, bed.ports" in text
    assert "2 of " in text
    assert "bound us" not in text
    assert all(len(line) <= 80 for line in out.getvalue().splitlines())


def test_a_time_above_its_wcet_is_an_error_where_the_wcet_is(system: System) -> None:
    found = measurement(system, {ROW: 300_001})
    (text,) = bounds.findings(found.rows, {}, system)
    place = measured.origin_of(system, ROW)
    assert text.splitlines() == [
        f"{place}: error: {ROW} was measured to take 300.001 us, above its `wcet` of 300 us",
        f"{place}: hint: write `wcet: 360.1 us` or more",
    ]
    assert list(bounds.findings(measurement(system, {ROW: 300_000}).rows, {}, system)) == []


def test_a_bound_that_a_measurement_refutes_is_an_error(system: System) -> None:
    bound = given(system, f"row,wcet_us\n{ROW},10\n")
    found = measurement(system, {ROW: 10_001}, bound)
    (text,) = bounds.findings(found.rows, bound, system)
    assert text.startswith(
        f"b.csv:2: error: {ROW} was measured to take 10.001 us, above its bound of 10 us\n"
    )
    equal = measurement(system, {ROW: 10_000}, bound)
    assert not any(one.words for one in equal.rows)


@pytest.mark.parametrize(("text", "percent"), [("20%", 20), ("5 %", 5), ("0", 0), ("1000%", 1000)])
def test_margins_are_percentages(text: str, percent: int) -> None:
    assert measure._margin(text) == percent


@pytest.mark.parametrize("text", ["-1%", "1001%", "2.5%", "%", "20 percent", "٢%"])
def test_other_margins_are_refused(text: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError, match="is no percentage such as 20%"):
        measure._margin(text)


# --- Bounds of a static tool ----------------------------------------------------------


def test_bounds_are_read_by_row_and_by_function(system: System) -> None:
    assert given(system, GOOD) == {
        "bed.ports": Bound("bed.ports", Ns(99_900), "b.csv:2"),
        ROW: Bound(ROW, Ns(300), "b.csv:3"),
        "bed.turn": Bound("bed.turn", Ns(10_000_010), "b.csv:6"),
    }


def test_a_function_of_several_programs_does_not_name_a_row() -> None:
    two = checking.check(ROOT / "examples" / "two_nodes" / "model.yaml").system
    (found,) = problems(two, "function,wcet_us\ntwo_nodes__link__receiver__run_receive,1\n")
    assert found.endswith("runs link.receive_panel and link.receive_drive: use the column `row`")


@pytest.mark.parametrize("home", EXAMPLES, ids=lambda home: home.name)
def test_functions_are_those_of_the_generated_program(home: Path) -> None:
    model = checking.check(home / "model.yaml").system
    specs = {
        path.stem.replace("-", "__"): path.read_text(encoding="utf-8").lower()
        for path in (home / "generated").rglob("*.ads")
    }
    slots = [slot for processor in model.processors for slot in processor.slots]
    assert slots
    for slot in slots:
        package, procedure = function_of(slot, model).rsplit("__", 1)
        assert f"procedure {procedure}" in specs[package], slot.element


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("row,wcet_us\nbed.port,1\n", "b.csv:2: error: there is no row bed.port"),
        ("function,wcet_us\nx,1\n", "b.csv:2: error: there is no function x"),
        (
            "row,wcet_us\nbed.ports,1\n\nfunction,wcet_us\ninfusion_system__bed__run_ports,2\n",
            "b.csv:5: error: bed.ports has a bound already, at b.csv:2",
        ),
        (
            "row,cycles\nbed.ports,5\n",
            "b.csv:2: error: bed.ports needs `wcet_us`, or `cycles` and `clock_hz`",
        ),
        (
            "row,wcet_us,cycles,clock_hz\nbed.ports,1,5,5\n",
            "b.csv:2: error: bed.ports needs `wcet_us`, or `cycles` and `clock_hz`",
        ),
        (
            "row,wcet\nbed.ports,1\n",
            "b.csv:2: error: column wcet of row must say its unit: wcet_ns, _us, _ms or _s",
        ),
        ("row,wcet_us\nbed.ports,0\n", "b.csv:2: error: wcet_us of row bed.ports must be"),
        ("row,wcet_us\nbed.ports,x\n", "b.csv:2: error: wcet_us of row bed.ports must be"),
        ("row,cycles,clock_hz\nbed.ports,1,0\n", "b.csv:2: error: clock_hz of row"),
        ("task,wcet_us\nx,1\n", "b.csv:2: error: task is none of row, function"),
        ("", "b.csv: error: the file has no bound"),
    ],
)
def test_what_is_wrong_with_a_file_is_located(system: System, text: str, message: str) -> None:
    (found,) = problems(system, text)
    assert found.startswith(message)


def test_bounds_within_the_wcets_pass(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "b.csv"
    file.write_text(f"row,wcet_us\n{ROW},300\n", encoding="utf-8")
    assert main(["analyse", str(PUMP / "model.yaml"), "--bounds", str(file)]) == OK
    found = capsys.readouterr()
    assert f"{ROW}: bound 300 us, within its WCET of 300 us\n" in found.out
    assert "bed.ports: no bound is given for its WCET of 100 us\n" in found.out
    assert "error" not in found.err


def test_a_bound_above_its_wcet_is_an_error_with_both_places(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "b.csv"
    file.write_text(f"row,wcet_us\n{ROW},300.01\n", encoding="utf-8")
    assert main(["analyse", str(PUMP / "model.yaml"), "--bounds", str(file)]) == WRONG
    found = capsys.readouterr()
    assert f"{ROW}: bound 300.01 us, ABOVE its WCET of 300 us\n" in found.out
    first, note, hint = found.err.splitlines()[-3:]
    assert first == f"{file}:2: error: the bound of {ROW}, 300.01 us, is above its `wcet` of 300 us"
    assert note.endswith(f": note: the `wcet` of {ROW} is here")
    assert hint.endswith(": hint: write `wcet: 300.1 us` or more")
    line = int(note.split(":")[1])
    text = (PUMP / "model.yaml").read_text(encoding="utf-8").splitlines()
    assert text[line - 1].strip() == "Infusion:"


def test_a_wrong_file_of_bounds_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "b.csv"
    file.write_text("row,wcet_us\nnone,1\n", encoding="utf-8")
    assert main(["analyse", str(PUMP / "model.yaml"), "--bounds", str(file)]) == WRONG
    found = capsys.readouterr()
    assert f"{file}:2: error: there is no row none" in found.err
    assert found.out == ""
    plain = str(ROOT / "tests" / "plain" / "two_nodes.csv")
    assert main(["analyse", plain, "--bounds", str(file)]) == WRONG
    assert "--bounds is for a model" in capsys.readouterr().err
