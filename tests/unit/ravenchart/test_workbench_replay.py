# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A recorded run on the page of the workbench, without a browser."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import can
import pytest

from ravenchart.analysis.system.observed import TraceMap, read_map
from ravenchart.command_line import main
from ravenchart.failures import Refused, Unusable
from ravenchart.workbench.publishing import RefusedRequestError
from ravenchart.workbench.replay import ReplayView
from ravenchart.workbench.requests import PageRequest, ReplayRequest, read
from tests.support import recorded
from tests.support.recordings import report, write
from tests.support.snapshot_files import PUMP, number, trace_map
from tests.support.workbench import Running, command, environment, running

SECOND = 1_000_000_000
PRINTED = pytest.CaptureFixture[str]
REGION = number("bed.Infusion", "region")
MOTOR = number("bed.Infusion.Motor", "region")
RUN = [
    *report(trace_map(), 0, 0, 0),
    f"T 1000 State {REGION} {trace_map().elements[REGION].leaves.index('Self_Test')}",
    f"T 1000 State {MOTOR} {trace_map().elements[MOTOR].leaves.index('Turning')}",
    f"T {SECOND} Transition {REGION} {trace_map().elements[REGION].transitions.index('ready')}",
    f"T {SECOND} State {REGION} {trace_map().elements[REGION].leaves.index('Programming')}",
    *report(trace_map(), 2 * SECOND, 40, 3),
    "END",
]


def wish(kind: str, **more: int | float | str) -> ReplayRequest:
    """A message of a page."""
    found: PageRequest = read(json.dumps({"kind": kind, "number": 0} | more).encode())
    assert isinstance(found, ReplayRequest)
    return found


@pytest.fixture
def trace(tmp_path: Path) -> Path:
    return write(tmp_path / "trace.txt", trace_map(), RUN)


def test_the_page_gets_the_states_that_are_active_and_the_transition_taken_last(
    trace: Path,
) -> None:
    view = ReplayView(PUMP, [trace])
    view.do(wish("seek", at=5000))
    (before,) = view.look(trace_map().digest)["nodes"]
    chart = next(one for one in before["drawn"] if one["name"] == "bed.Infusion")
    assert chart["drawing"] == "Pump.Infusion" and set(chart["active"]) == {"Self_Test", "Turning"}
    assert chart["last"] == {"taken": []}
    view.do(wish("next", what="event"))
    found = view.look(trace_map().digest)
    (node,) = found["nodes"]
    chart = next(one for one in node["drawn"] if one["name"] == "bed.Infusion")
    assert (chart["active"], chart["last"]) == (["Programming"], {"taken": ["ready"]})
    assert [one["what"] for one in node["records"]] == ["ready", "Programming"]
    assert (found["text"], found["replay"]["at"], node["now"]) == ("", SECOND, SECOND)
    assert (node["counted"], node["processors"][0]["completed"]) == (0, 0)


def test_no_later_record_is_refused_and_the_instant_stays(trace: Path) -> None:
    view = ReplayView(PUMP, [trace])
    view.do(wish("next", what="event"))
    with pytest.raises(RefusedRequestError, match="the trace has no later transition or fault"):
        view.do(wish("next", what="event"))
    assert view.look(None)["replay"]["at"] == SECOND


def test_what_was_lost_and_the_digest_of_a_changed_model_are_said(trace: Path) -> None:
    found = ReplayView(PUMP, [trace]).look("0" * 64)
    assert "bounds are those of the model that was recorded" in found["text"]
    (gap,) = found["replay"]["gaps"]
    assert (gap["node"], gap["after"], gap["until"], gap["count"]) == ("board", 0, 2 * SECOND, 3)
    assert found["replay"]["cut"] == []


def test_two_nodes_are_shown_on_one_clock(tmp_path: Path) -> None:
    model = PUMP.parent.parent / "two_nodes" / "model.yaml"
    files = []
    for late, map_of in enumerate(sorted((model.parent / "generated").rglob("trace.json"))):
        names: TraceMap = read_map(map_of.read_text(encoding="utf-8"))
        row = names.of_kind("row")[0].number
        files.append(tmp_path / f"trace-{map_of.parent.name}.txt")
        lines = [f"E {1000 + late * 5000}", f"M {names.digest}", f"T 1000 Activity {row} 0", "END"]
        files[-1].write_text("\n".join(lines), encoding="ascii")
    view = ReplayView(model, files)
    view.do(wish("next", what="record"))
    first, second = view.look(None)["nodes"]
    assert (first["now"], first["starts"], second["starts"]) == (1000, None, 5000)
    view.do(wish("next", what="record"))
    first, second = view.look(None)["nodes"]
    assert (first["now"], second["now"], second["starts"]) == (6000, 1000, None)
    with pytest.raises(Unusable, match="does not name its node"):
        ReplayView(model, [write(tmp_path / "trace.txt", trace_map(), RUN)])


@pytest.mark.slow
def test_recorded_values_have_their_points_until_the_instant(tmp_path: Path) -> None:
    model = Path(shutil.copytree(recorded.FOLDER, tmp_path / "recorded")) / "model.yaml"
    assert main(["generate", str(model)]) == 0
    names = read_map((model.parent / "generated" / "trace.json").read_text(encoding="utf-8"))
    heat, hue = (names.named(name, "value").number for name in ("taker.heat", "giver.hue"))
    lines = [f"V {n * SECOND} {heat} {n - 400}" for n in range(1, 50)]
    trace = write(tmp_path / "trace.txt", names, [f"V 5 {hue} 2", *lines, "END"])
    view = ReplayView(model, [trace])
    view.do(wish("seek", at=40 * SECOND + 1))
    (node,) = view.look(names.digest)["nodes"]
    points = node["plots"]["taker.heat"]["points"]
    assert points[0] == (10 * SECOND, -39.0) and points[-1] == (40 * SECOND, -36.0)
    assert node["plots"]["giver.hue"]["points"] == [(5, 2)]
    assert node["plots"]["giver.hue"]["literals"][2] == "Blue"
    assert {one["name"]: one["value"] for one in node["values"]}["taker.heat"] == "-36.0"


@pytest.mark.parametrize(("lines", "digest", "problem"), [
    (RUN, "0" * 64, "was generated from another model"),
    ([*RUN[:3], "T 5 Nothing 1 0"], "", "unknown kind 'Nothing'"),
])  # fmt: skip
def test_a_trace_that_does_not_fit_is_refused_before_a_page_is_served(
    lines: list[str], digest: str, problem: str, tmp_path: Path
) -> None:
    path = write(tmp_path / "trace.txt", trace_map(), lines, digest)
    before = path.read_bytes()
    with pytest.raises(Refused, match=problem):
        ReplayView(PUMP, [path])
    assert path.read_bytes() == before


# --- Simulations


def simulated(model: Path, events: Path, out: Path, capsys: PRINTED, *more: str) -> Path:
    """What `simulate` prints, in a file."""
    words = ["simulate", str(model), "--events", str(events), "--interpreter", *more]
    assert main(words) == 0
    out.write_text(capsys.readouterr().out)
    return out


@pytest.mark.slow
@pytest.mark.parametrize("more", [(), ("--json",)], ids=["text", "json"])
def test_a_simulation_is_replayed_without_the_program(
    more: tuple[str, ...], tmp_path: Path, capsys: PRINTED
) -> None:
    model = Path(shutil.copy(PUMP, tmp_path))
    events = PUMP.parent / "events.yaml"
    view = ReplayView(model, [simulated(model, events, tmp_path / "out.txt", capsys, *more)])

    def at(seconds: float) -> dict[str, str | None]:
        view.do(wish("seek", at=round(seconds * SECOND)))
        (node,) = view.look(trace_map().digest)["nodes"]
        return {one["name"]: one["state"] for one in node["charts"]}

    sensor, motor = "bed.Infusion.Sensor", "bed.Infusion.Motor"
    tested = {"bed.Infusion": "Self_Test", "bed.Keys": "Listening"}
    assert at(0.3) == {**tested, sensor: "Listening", motor: "Turning"}
    assert at(0.6) == {**tested, sensor: "Sensor_Good", motor: "Turning"}
    assert at(15.06)["bed.Infusion"] == "All_Given"
    assert at(2) == {**tested, "bed.Infusion": "Filling", sensor: None, motor: None}
    view.do(wish("next", what="event"))
    found = view.look(trace_map().digest)
    (node,) = found["nodes"]
    chart = next(one for one in node["drawn"] if one["name"] == "bed.Infusion")
    assert set(chart["active"]) == {"Infusing", "Running", "Giving", "Loading"}
    assert chart["last"] == {"taken": ["filled_up"]}
    assert (node["node"], found["replay"]["at"]) == ("Infusion_System", 2_550_000_000)
    assert found["text"] == "" and found["replay"]["simulated"] and not found["replay"]["cut"]
    assert (node["processors"], node["queues"], node["counted"]) == ([], [], None)
    assert "a simulation has none" in "; ".join(node["not_seen"])
    assert "longest" not in "; ".join(node["not_seen"])


def test_what_a_simulation_records_is_drawn(tmp_path: Path, capsys: PRINTED) -> None:
    events = tmp_path / "events.yaml"
    events.write_text("- {until: 3 s}\n")
    trace = simulated(recorded.MODEL, events, tmp_path / "out.txt", capsys)
    lines = [one for one in trace.read_text().splitlines() if " giver.hue = " in one]
    assert lines
    view = ReplayView(recorded.MODEL, [trace])
    view.do(wish("seek", at=3 * SECOND))
    (node,) = view.look(None)["nodes"]
    values = {one["name"]: (one["value"], one["count"]) for one in node["values"]}
    assert values["giver.hue"] == (lines[-1].rpartition(" ")[2], len(lines))
    assert len(node["plots"]["giver.hue"]["points"]) == len(lines)


@pytest.mark.parametrize(("line", "problem"), [
    ("0.000 bed.Nothing: Self_Test.entry", "no chart bed.Nothing"),
    ("0.000 bed.Infusion: Nothing.entry", "has no behaviour Nothing.entry"),
    ("0.000 bed.Infusion: nothing.effect", "has no behaviour nothing.effect"),
    ("0.000 bed.Infusion: Alarm.exit", "Alarm is left, but was not active"),
    ("0.000 bed.Infusion: Self_Test.entry\nT 5 State 1 0", "out.txt:2: error: not a line of"),
])  # fmt: skip
def test_a_simulation_of_another_model_is_refused(line: str, problem: str, tmp_path: Path) -> None:
    path = tmp_path / "out.txt"
    path.write_text(f"{line}\n")
    with pytest.raises(Refused, match=problem):
        ReplayView(PUMP, [path])


def test_a_simulation_stands_alone(trace: Path, tmp_path: Path) -> None:
    path = tmp_path / "out.txt"
    path.write_text("0.000 bed.Infusion: Self_Test.entry\n")
    with pytest.raises(Unusable, match="a simulation has one trace for all nodes"):
        ReplayView(PUMP, [trace, path])


@pytest.mark.parametrize("suffix", [".blf", ".asc", ".log"])
def test_a_log_of_a_bus_has_no_states_to_replay(suffix: str, tmp_path: Path) -> None:
    log = tmp_path / f"bus{suffix}"
    with can.Logger(log) as logger:
        logger(can.Message(arbitration_id=0x111, is_extended_id=False, timestamp=1.0))
    with pytest.raises(Unusable, match=r"bus\.... is a log of a bus: it has frames and no states"):
        ReplayView(PUMP, [log])


@pytest.mark.parametrize("suffix", [".csv", ".json"])
def test_what_a_trace_was_written_as_is_told_from_it(
    suffix: str, trace: Path, tmp_path: Path, capsys: PRINTED
) -> None:
    out = tmp_path / f"run{suffix}"
    assert main(["trace", str(PUMP), str(trace), "--out", str(out)]) == 0
    with pytest.raises(Unusable, match="name the trace that it was made from"):
        ReplayView(PUMP, [out])
    assert main(["trace", str(PUMP), str(out), "--out", str(out)]) == 2
    assert "name the trace that it was made from" in capsys.readouterr().err


@pytest.mark.slow
def test_a_model_without_its_program_has_no_names_and_the_command_in_the_message_writes_them(
    trace: Path, tmp_path: Path
) -> None:
    model = Path(shutil.copy(PUMP, tmp_path))
    with pytest.raises(Unusable, match=f"missing: .*; `ravenchart generate {model}` writes them"):
        ReplayView(model, [trace])
    assert main(["generate", str(model)]) == 0
    assert ReplayView(model, [trace]).look(None)["nodes"]


# --- The server


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    folder = tmp_path_factory.mktemp("replay")
    trace = write(folder / "trace.txt", trace_map(), RUN)
    with running(PUMP, "--replay", str(trace)) as found:
        yield found


def test_time_goes_on_and_rests_as_pages_ask(bench: Running) -> None:
    assert bench.state()["replay"] is True
    assert bench.act(kind="speed", speed=0.5).status == 200
    assert bench.act(kind="play").status == 200
    first = bench.request("live").json["replay"]
    assert first["playing"] and first["speed"] == 0.5
    while bench.request("live").json["replay"]["at"] == first["at"]:
        pass
    assert bench.act(kind="pause").status == 200
    rest = bench.request("live").json["replay"]
    assert not rest["playing"] and bench.request("live").json["replay"]["at"] == rest["at"]


@pytest.mark.parametrize("message", [
    {"kind": "seek"}, {"kind": "seek", "at": -1}, {"kind": "seek", "at": "1"},
    {"kind": "seek", "at": 1.5}, {"kind": "speed", "speed": 0}, {"kind": "speed", "speed": 1e9},
    {"kind": "next", "what": "row"}, {"kind": "play", "file": "/etc/passwd"},
])  # fmt: skip
def test_a_malformed_message_moves_nothing(bench: Running, message: dict[str, object]) -> None:
    before = bench.request("live").json["replay"]["at"]
    assert bench.act(**message).status == 400
    assert bench.request("live").json["replay"]["at"] == before


def test_nothing_is_moved_without_the_token(bench: Running) -> None:
    message = json.dumps({"kind": "seek", "at": 7, "number": bench.state()["number"]}).encode()
    assert bench.request("act", message, token="wrong").status == 403
    assert bench.request("act", message, {"origin": "https://evil.example"}).status == 403
    assert bench.request("live").json["replay"]["at"] != 7


def test_a_trace_of_another_model_ends_the_command_with_its_reason(tmp_path: Path) -> None:
    path = write(tmp_path / "trace.txt", trace_map(), RUN, "0" * 64)
    words = command(str(PUMP), "--no-open", "--replay", str(path))
    done = subprocess.run(words, env=environment(), capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert re.search(r"trace\.txt: error: .* generated from another model", done.stderr)
    assert "http://" not in done.stdout
