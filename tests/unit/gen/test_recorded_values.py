# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Recorded values: which code records them, and what is made of the trace."""

from __future__ import annotations

import csv
import re
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from ravenchart.analysis.findings.claims import claims_of
from ravenchart.analysis.system.observed import TraceError, TraceMap, merged, read_map, read_trace
from ravenchart.analysis.system.timing import analyse
from ravenchart.command_line import main
from ravenchart.gen.emit.clashes import clashes
from ravenchart.gen.emit.program import generate
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import Loaded
from ravenchart.paths import ROOT
from ravenchart.running import expected as expectations
from ravenchart.running import value_plots
from ravenchart.running.judge import failures
from ravenchart.running.process import Ended
from ravenchart.running.traces.timeline import Slice, Timeline, Track
from ravenchart.running.traces.values import Quantity, spans
from tests.support.pump import loaded
from tests.support.recorded import MODEL, asammdf, read_back
from tests.support.trace_events import events_of, well_formed

PRINTED = pytest.CaptureFixture[str]
TEXT = MODEL.read_text(encoding="utf-8")
WITHOUT = re.sub(r"^record:\n(  - .*\n)*", "", TEXT, flags=re.M)


def system_of(text: str) -> System:
    """The system of a model without errors."""
    result = loaded(text)
    assert result.system is not None, result.diagnostics
    return result.system


def files_of(text: str) -> dict[str, str]:
    """The program of a model."""
    system = system_of(text)
    return generate(system, claims_of(analyse(system)))


@pytest.fixture(scope="module")
def files() -> dict[str, str]:
    """The program that records."""
    return files_of(TEXT)


@pytest.fixture(scope="module")
def trace_map(files: dict[str, str]) -> TraceMap:
    """Its map."""
    return read_map(files["trace.json"])


def test_without_record_no_unit_and_no_line_is_for_values(files: dict[str, str]) -> None:
    plain = files_of(WITHOUT)
    assert set(files) - set(plain) == {"recorded_feature-recording.ads"}
    text = "".join(one for name, one in plain.items() if name.endswith((".ads", ".adb")))
    assert not re.search(r"Recording|Value_Lines|Recorded_Values|_Value :", text.replace(
        "Reading_Value :", "").replace("Warmth_Value :", ""))  # fmt: skip
    same = [n for n, one in plain.items() if one == files[n] and not n.endswith(".json")]
    assert "recorded_feature-source-flows.adb" in same, "activities do not know of it"
    assert "recorded_feature-sink-counting.adb" in same, "nor do charts"


def test_each_value_has_one_call_where_it_is_set_sent_or_taken(files: dict[str, str]) -> None:
    def calls(name: str) -> list[str]:
        return re.findall(r"Recording\.Values\.Note\s+\([^;]*?Recording\.(\w+)\);", files[name])

    assert calls("recorded_feature-giver.adb") == [
        "Giver_Reading_Height", "Giver_Reading_Hue", "Giver_Reading_Warm",
        "Giver_Height", "Giver_Hue", "Giver_Far",
    ]  # fmt: skip
    assert calls("recorded_feature-taker.adb") == [
        "Taker_Reading_Height", "Taker_Heat", "Taker_Count", "Taker_Warm",
    ]  # fmt: skip


def test_names_that_always_fit_still_do_and_fields_that_do_not_are_refused() -> None:
    long = {"giver": "a" * 24, "taker": "b" * 24, "reading": "c" * 24, "count": "d" * 24,
            "height": "e" * 24}  # fmt: skip
    text = TEXT
    for name, longer in long.items():
        text = re.sub(rf"\b{name}\b", longer, text)
    items_alone = re.sub(r"  - \w+\.c{24}.*\n", "", text)
    assert list(clashes(system_of(items_alone))) == []
    told = [one.message for one in clashes(system_of(text))]
    field = f"{'a' * 24}.{'c' * 24}.{'e' * 24}"
    assert f"the recorded value `{field}` makes a line of " in told[0]
    assert all("the recorded value `" in one for one in told)


def test_a_name_of_its_package_is_refused_to_others() -> None:
    (found,) = clashes(system_of(TEXT.replace("giver", "recording")))
    assert found.message.startswith("the instance `recording` clashes with another `Recording`")
    assert list(clashes(system_of(WITHOUT.replace("giver", "recording")))) == []


def test_numbers_of_other_elements_stay_and_the_map_says_what_values_mean(
    trace_map: TraceMap,
) -> None:
    before = read_map(files_of(WITHOUT)["trace.json"])
    assert all(trace_map.elements[n] == one for n, one in before.elements.items())
    values = trace_map.of_kind("value")
    assert min(one.number for one in values) == max(before.elements) + 1
    assert {one.name: (one.literals, one.unit) for one in values} == {
        "giver.height": ((), "mm"),
        "giver.hue": (("Red", "Green", "Blue"), None),
        "giver.far": ((), None),
        "giver.reading.height": ((), "mm"),
        "giver.reading.hue": (("Red", "Green", "Blue"), None),
        "giver.reading.warm": (("False", "True"), None),
        "taker.reading.height": ((), "mm"),
        "taker.heat": ((), "0.1 degC"),
        "taker.count": ((), "mm"),
        "taker.warm": (("False", "True"), None),
    }


def test_the_buffer_is_an_object_of_all_processors_as_the_trace_is() -> None:
    system, plain = system_of(TEXT), system_of(WITHOUT)
    assert system.object("recording").users == system.object("trace").users
    assert system.object("recording").ceiling == system.object("trace").ceiling
    assert [one for one in system.objects if one.element != "recording"] == list(plain.objects)


def test_a_node_without_recorded_items_has_no_buffer() -> None:
    folder = ROOT / "examples" / "two_nodes"
    others = {one.stem: one.read_text(encoding="utf-8") for one in folder.glob("*.yaml")}
    text = others.pop("model")
    system = loaded(text, **others).system
    assert system is not None
    node = system.nodes[0]
    instance = next(one for one in system.instances if one.node == node.name)
    port = next(p for p in instance.component.ports if not p.is_command)
    made = loaded(f"{text}\nrecord: [{instance.name}.{port.name}]\n", **others)
    assert made.system is not None, made.diagnostics
    files = generate(made.system, claims_of(analyse(made.system)))
    homes = [name for name in files if name.endswith("-recording.ads")]
    assert [Path(name).parts[0] for name in homes] == [node.name]


def test_a_port_of_a_composite_stands_for_those_that_it_leads_to() -> None:
    path = ROOT / "tests" / "bad_models" / "recorded_wrongly" / "model.yaml"
    text = re.sub(r"^record:\n(  - .*\n)*", "record: [station_1.report.full]\n", path.read_text(),
                  flags=re.M)  # fmt: skip
    system = system_of(text)
    assert [one.element for one in system.recorded_values] == ["station_1.sensor.report.full"]


def test_names_in_record_are_uses() -> None:
    made: Loaded = loaded(TEXT)
    line = next(n for n, one in enumerate(TEXT.splitlines(), 1) if "taken: one field" in one)
    assert [use.name for use in made.uses if use.origin.line == line] == [
        "taker", "reading", "height",
    ]  # fmt: skip


# --- The trace, read again


def lines_of(trace_map: TraceMap, *told: str) -> list[str]:
    """Lines of a trace, with V lines that name elements."""
    found = ["E 1000", f"M {trace_map.digest}"]
    for line in told:
        words = line.split()
        if words[0] == "V":
            words[2] = str(trace_map.named(words[2], "value").number)
        found.append(" ".join(words))
    return found


TOLD = (
    "V 100 giver.height -993", "V 200 giver.hue 1", "V 300 taker.heat -397",
    "V 400 giver.far -4611686018427387904", "V 20000100 giver.height -986",
    "V 20000200 giver.hue 1", "V 40000100 giver.hue 2", "L trace 0", "L values 3", "END",
)  # fmt: skip


def test_values_are_read_with_their_losses(trace_map: TraceMap) -> None:
    seen = read_trace(lines_of(trace_map, *TOLD), trace_map)
    assert (seen.values_lost, seen.trace_lost, seen.end) == (3, 0, 40000100)
    assert [(one.time, one.element.name, one.text) for one in seen.values][:2] == [
        (100, "giver.height", "-993"), (200, "giver.hue", "Green"),
    ]  # fmt: skip
    assert seen.records == []
    both = merged({"left": seen, "right": seen})
    assert both.values_lost == 6 and len(both.values) == 2 * len(seen.values)


@pytest.mark.parametrize(("line", "problem"), [
    ("V 100 giver.hue 3", "giver.hue has no value number 3"),
    ("V 100 giver.hue", "not a trace line"),
    ("V 100 giver.hue x", "'x' is not a number"),
    ("T 100 Value 1 1", "unknown kind 'Value'"),
])  # fmt: skip
def test_what_is_no_value_is_refused(line: str, problem: str, trace_map: TraceMap) -> None:
    with pytest.raises(TraceError, match=problem):
        read_trace(lines_of(trace_map, line), trace_map)


def test_a_row_is_no_value(trace_map: TraceMap) -> None:
    row = trace_map.of_kind("row")[0]
    with pytest.raises(TraceError, match="is a row, not a value"):
        read_trace([f"V 1 {row.number} 1"], trace_map)


def test_lost_values_fail_a_run_and_are_no_loss_of_the_bus(trace_map: TraceMap) -> None:
    seen = read_trace(lines_of(trace_map, *TOLD), trace_map)
    ended = Ended(exit_code=0, killed=False, real_time=False, warnings=())
    assert "3 recorded values were lost" in list(failures(ended, None, seen, (), ()))
    assert expectations.counted(seen, (), (), ended) == {}


@pytest.fixture
def trace(trace_map: TraceMap, tmp_path: Path) -> tuple[Path, Path]:
    """A model with its program's map, and a trace of it."""
    model = tmp_path / "model.yaml"
    model.write_text(TEXT, encoding="utf-8")
    assert main(["generate", str(model)]) == 0
    own = read_map((tmp_path / "generated" / "trace.json").read_text(encoding="utf-8"))
    path = tmp_path / "trace.txt"
    path.write_text("\n".join(lines_of(own, *TOLD)) + "\n")
    return model, path


def test_csv_has_values_in_their_units(
    trace: tuple[Path, Path], tmp_path: Path, capsys: PRINTED
) -> None:
    out = tmp_path / "out.csv"
    assert main(["trace", *map(str, trace), "--out", str(out)]) == 0
    printed = capsys.readouterr()
    assert "warning: 3 recorded values lost: the values have gaps" in printed.err
    assert "lost: values, 3 times" in printed.out
    with out.open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["kind"] == "value"]
    assert [(row["time_ns"], row["element"], row["detail"], row["unit"]) for row in rows] == [
        ("100", "giver.height", "-993", "mm"),
        ("200", "giver.hue", "Green", ""),
        ("300", "taker.heat", "-39.7", "degC"),
        ("400", "giver.far", "-4611686018427387904", ""),
        ("20000100", "giver.height", "-986", "mm"),
        ("20000200", "giver.hue", "Green", ""),
        ("40000100", "giver.hue", "Blue", ""),
    ]


def test_perfetto_has_counters_of_numbers_and_slices_of_literals(
    trace: tuple[Path, Path], tmp_path: Path
) -> None:
    out = tmp_path / "out.json"
    assert main(["trace", *map(str, trace), "--out", str(out)]) == 0
    whole, events, named = events_of(out)
    well_formed(whole)
    counters = [(e["name"], e["ts"], e["args"]["value"]) for e in events if e["ph"] == "C"]
    assert counters == [
        ("giver.height in mm", 0.1, -993),
        ("taker.heat in degC", 0.3, -39.7),
        ("giver.far", 0.4, -(2**62)),
        ("giver.height in mm", 20000.1, -986),
    ]
    slices = [
        (named[e["pid"], e["tid"]], e["name"], e["ts"], e["dur"], "args" in e)
        for e in events
        if e["ph"] == "X" and e["cat"] == "value"
    ]
    assert slices == [
        ("giver.hue", "Green", 0.2, 39999.9, False),
        ("giver.hue", "Blue", 40000.1, 0, True),
    ]
    assert {e["pid"] for e in events if e["ph"] == "C"} == {1}


def test_mdf_has_the_numbers_with_units_literals_and_states(
    trace: tuple[Path, Path], tmp_path: Path
) -> None:
    reader = asammdf()
    model, path = trace
    own = read_map((model.parent / "generated" / "trace.json").read_text(encoding="utf-8"))
    chart = own.named("taker.Counting", "region").number
    states = (f"T 50 State {chart} 0", f"T 10000050 State {chart} 1")
    path.write_text("\n".join(lines_of(own, *states, *TOLD)) + "\n")
    out = tmp_path / "out.mf4"
    assert main(["trace", str(model), str(path), "--out", str(out)]) == 0
    assert read_back(out, "giver.height") == [(100, -993), (20000100, -986)]
    assert read_back(out, "giver.far") == [(400, -(2**62))]
    assert read_back(out, "taker.heat") == [(300, -397)]
    with reader.MDF(out) as mdf:
        heat, hue, counting = (mdf.get(n) for n in ("taker.heat", "giver.hue", "taker.Counting"))
        assert (heat.unit, mdf.get("giver.height").unit) == ("degC", "mm")
        assert list(heat.samples) == pytest.approx([-39.7])
        assert list(hue.samples) == [b"Green", b"Green", b"Blue"]
        assert list(counting.samples) == [b"Waiting", b"Counted"]
        assert [round(at * 1e9) for at in counting.timestamps] == [50, 10000050]
        assert len(mdf.get("taker.count").samples) == 0
        assert "lost values" in mdf.header.comment
        assert str(mdf.groups[0].channel_group.acq_name) == "board"


def test_mdf_without_asammdf_or_values_is_refused_with_what_to_do(
    trace: tuple[Path, Path], tmp_path: Path, capsys: PRINTED, monkeypatch: pytest.MonkeyPatch
) -> None:
    model, path = trace
    out = tmp_path / "out.mf4"
    with monkeypatch.context() as patch:
        patch.setitem(sys.modules, "asammdf", None)
        assert main(["trace", str(model), str(path), "--out", str(out)]) == 2
    said = capsys.readouterr().err
    assert 'asammdf, which is not installed: python -m pip install "asammdf>=8.8"' in said
    model.write_text(WITHOUT, encoding="utf-8")
    assert main(["generate", str(model)]) == 0
    own = read_map((model.parent / "generated" / "trace.json").read_text(encoding="utf-8"))
    path.write_text("\n".join(lines_of(own, "END")) + "\n")
    assert main(["trace", str(model), str(path), "--out", str(out)]) == 2
    assert "the model records no values: name ports" in capsys.readouterr().err
    assert not out.exists()


def test_the_report_draws_what_was_recorded(trace_map: TraceMap) -> None:
    seen = read_trace(lines_of(trace_map, *TOLD), trace_map)
    ((caption, drawing),) = value_plots.pictures(seen)
    assert caption == "Recorded values over time, in the time of the controller."
    for text in ("giver.height in mm", "taker.heat in degC", "giver.hue", "Green", "Blue"):
        assert f">{text}</text>" in drawing, text
    assert "taker.warm" not in drawing, "nothing was recorded of it"
    assert list(value_plots.pictures(read_trace(lines_of(trace_map, "END"), trace_map))) == []
    assert list(value_plots.pictures(None)) == []


def test_of_very_many_values_the_extremes_are_drawn() -> None:
    points = [(Ns(n * 1000), n % 7) for n in range(100_000)]
    points[51_234] = (points[51_234][0], 99)
    points[77_777] = (points[77_777][0], -99)
    found = list(value_plots.thinned(points))
    assert len(found) <= 4 * value_plots.MOST_INTERVALS and found == sorted(set(found))
    assert {points[0], points[-1], points[51_234], points[77_777]} <= set(found) <= set(points)
    assert list(value_plots.thinned(points[:2000])) == points[:2000]


def test_states_inside_others_are_values_with_gaps() -> None:
    timeline = Timeline("System")
    track, other = Track("board", "bed.Infusion.Motor"), Track("board", "bed.Infusion_2")
    timeline.tracks += [track, other]
    timeline.slices += [
        Slice(track, "On", Ns(10), Ns(20)), Slice(track, "Off", Ns(20), Ns(30)),
        Slice(other, "On", Ns(0), Ns(9)), Slice(track, "On", Ns(50), Ns(60), open=True),
    ]  # fmt: skip
    region = SimpleNamespace(element="bed.Infusion", item=_region())
    timeline.take_states(SimpleNamespace(recorded=(region,)))  # type: ignore[arg-type]
    (series,) = timeline.states
    texts = [(at, series.quantity.text(number)) for at, number in series.points]
    assert texts == [(10, "On"), (20, "Off"), (30, "-"), (50, "On")]


def _region() -> Region:
    (item,) = [one.item for one in system_of(TEXT).recorded if isinstance(one.item, Region)]
    return item


@pytest.mark.parametrize(("unit", "number", "text", "value"), [
    ("0.1 degC", 205, "20.5", 20.5),
    ("0.1 degC", -200, "-20.0", -20),
    ("5 ms", 3, "15", 15),
    (None, 2**62 - 1, "4611686018427387903", 2**62 - 1),
    ("%", 50, "50", 50),
])  # fmt: skip
def test_a_number_is_in_its_unit(unit: str | None, number: int, text: str, value: float) -> None:
    quantity = Quantity.of((), unit)
    assert (quantity.text(number), quantity.value(number)) == (text, value)


def test_a_value_holds_until_another_one_is_recorded() -> None:
    points = ((10, 1), (20, 1), (30, 2), (40, 1))
    found = list(spans(points, 50))  # type: ignore[arg-type]
    assert found == [(1, 10, 30, False), (2, 30, 40, False), (1, 40, 50, True)]
    assert list(spans((), 50)) == []  # type: ignore[arg-type]
