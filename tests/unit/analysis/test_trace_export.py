# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Traces in the formats of other tools: only what the trace holds, and its losses."""

from __future__ import annotations

import csv
import shutil
from pathlib import Path

import pytest

from ravenchart.analysis.system.observed import read_map
from ravenchart.command_line import main
from ravenchart.paths import ROOT
from tests.support.answers import answered
from tests.support.trace_events import PUMP, RUN, events_of, lines_of, run_of_the_pump, well_formed

NODES = ROOT / "examples" / "two_nodes"
PRINTED = pytest.CaptureFixture[str]


@pytest.fixture
def trace(tmp_path: Path) -> Path:
    """The trace of a run of the pump."""
    return run_of_the_pump(tmp_path)


def test_a_run_is_slices_of_states_and_marks(trace: Path, tmp_path: Path, capsys: PRINTED) -> None:
    out = tmp_path / "run.json"
    answer = answered(capsys, "trace", PUMP / "model.yaml", trace, "--out", out)
    assert answer["result"] == {
        "file": str(out), "records": 9, "slices": 5, "lost": {"trace": 3, "ward.lost_in": 2},
        "complete": True,
    }  # fmt: skip
    assert [one["message"] for one in answer["diagnostics"]][-1].startswith("3 trace records lost")
    whole, events, tracks = events_of(out)
    well_formed(whole)
    assert whole["otherData"] == {
        "system": "Infusion_System", "complete": "yes", "lost trace": "3", "lost ward.lost_in": "2",
    }  # fmt: skip
    slices = [
        (tracks[e["pid"], e["tid"]], e["name"], e["ts"], round(e["dur"], 3), "args" in e)
        for e in events
        if e["ph"] == "X"
    ]
    assert slices == [
        ("bed.Infusion", "Self_Test", 1.5, 29998.6, False),
        ("bed.Infusion.Motor", "Turning", 1.6, 20000, False),
        ("bed.Infusion.Sensor", "Listening", 1.7, 29998.4, False),
        ("bed.Infusion.Motor", "Motor_Good", 20001.6, 9998.5, False),
        ("bed.Infusion", "Programming", 30000.1, 10000.15, True),
    ]
    marks = {(e["cat"], e["name"]): e for e in events if e["ph"] == "i"}
    assert marks["transition", "ready"]["ts"] == 30000
    assert marks["arrived", "arrived bed.line"]["args"] == {"value": 1}
    assert (
        tracks[marks["raised", "raised bed.Stop"]["pid"], marks["raised", "raised bed.Stop"]["tid"]]
        == "bed"
    )
    assert marks["row", "bed.Infusion"]["ts"] == 0.1
    assert marks["counts", "counts"]["args"] == {
        "releases": 2, "misses": 1, "worst_response_us": 7.0, "last_response_us": 5.0,
    }  # fmt: skip
    assert marks["lost", "lost: trace"]["args"] == {"number": 3}
    assert [e["args"]["number"] for e in events if e.get("cat") == "release"] == [0, 1]


def test_the_rows_are_the_records_and_the_counts(
    trace: Path, tmp_path: Path, capsys: PRINTED
) -> None:
    out = tmp_path / "run.csv"
    assert main(["trace", str(PUMP / "model.yaml"), str(trace), "--out", str(out)]) == 0
    printed = capsys.readouterr()
    assert "lost: ward.lost_in, 2 times" in printed.out
    assert "warning: 3 trace records lost: the trace has gaps" in printed.err
    with out.open(encoding="utf-8", newline="") as file:
        head, *rows = list(csv.reader(file))
    assert head == ["time_ns", "node", "kind", "element", "detail", "unit"]
    timed = [row for row in rows if row[0]]
    assert timed[1][0] == "1500" and timed[1][2:] == ["state", "bed.Infusion", "Self_Test", ""]
    assert len(timed) == 9 and [int(row[0]) for row in timed] == sorted(int(r[0]) for r in timed)
    counts = {(row[2], row[3]): row[4] for row in rows if not row[0]}
    assert counts["lost", "trace"] == "3" and counts["faults", "Overrun"] == "1"
    assert counts["longest_execution_ns", "bed.Infusion"] == "6500"
    assert [n for (kind, _), n in counts.items() if kind == "last_response_ns"] == ["5000"]


def test_a_trace_that_was_cut_off_says_so(tmp_path: Path, capsys: PRINTED) -> None:
    path, out = tmp_path / "trace.txt", tmp_path / "run.json"
    path.write_text(lines_of(PUMP / "generated", *RUN[:4], end=False))
    assert main(["trace", str(PUMP / "model.yaml"), str(path), "--out", str(out)]) == 0
    assert "warning: the trace was cut off" in capsys.readouterr().err
    assert events_of(out)[0]["otherData"]["complete"].startswith("no: ")


def test_several_nodes_are_processes_on_one_clock(tmp_path: Path, capsys: PRINTED) -> None:
    files = []
    for late, map_of in enumerate(sorted((NODES / "generated").rglob("trace.json"))):
        node = map_of.parent.name
        trace_map = read_map(map_of.read_text(encoding="utf-8"))
        row = trace_map.of_kind("row")[0]
        path = tmp_path / f"trace-{node}.txt"
        path.write_text(
            f"E {1000 + late * 5000}\nM {trace_map.digest}\nT 1000 Activity {row.number} 0\nEND\n"
        )
        files.append(str(path))
    out = tmp_path / "run.json"
    assert main(["trace", str(NODES / "model.yaml"), *files, "--out", str(out)]) == 0
    whole, events, _ = events_of(out)
    well_formed(whole)
    assert [one["ts"] for one in events if one["ph"] == "i"] == [1, 6]
    assert len({one["pid"] for one in events}) == 2
    unnamed = tmp_path / "trace.txt"
    shutil.copy(files[0], unnamed)
    capsys.readouterr()
    assert main(["trace", str(NODES / "model.yaml"), str(unnamed), "--out", str(out)]) == 2
    assert "does not name its node" in capsys.readouterr().err


@pytest.mark.parametrize("form", ["text", "json"])
def test_a_simulation_has_a_track_for_each_place(
    form: str, tmp_path: Path, capsys: PRINTED
) -> None:
    model = str(PUMP / "model.yaml")
    words = ["simulate", model, "--interpreter", "--events", str(PUMP / "events.yaml")]
    assert main([*words, *(["--json"] if form == "json" else [])]) == 0
    printed = capsys.readouterr().out
    path, out = tmp_path / "simulated.txt", tmp_path / "simulated.json"
    path.write_text(printed)
    assert main(["trace", model, str(path), "--out", str(out)]) == 0
    whole, events, tracks = events_of(out)
    well_formed(whole)
    shown = {(tracks[one["pid"], one["tid"]], one["name"]) for one in events if one["ph"] == "X"}
    assert ("bed.Infusion in Self_Test.Motor", "Turning") in shown
    assert ("bed.Infusion in Running", "Filling") in shown and ("bed.Infusion", "Alarm") in shown
    assert printed.count(".entry") == len([one for one in events if one["ph"] == "X"])
    assert printed.count(".effect") == len([one for one in events if one["ph"] == "i"])
    assert list(tracks.values())[:3] == [
        "bed.Infusion", "bed.Infusion in Self_Test.Motor", "bed.Infusion in Self_Test.Sensor",
    ]  # fmt: skip
    rows = tmp_path / "simulated.csv"
    assert main(["trace", model, str(path), "--out", str(rows)]) == 0
    assert rows.read_text().splitlines()[1] == (
        "0,Infusion_System,behaviour,bed.Keys,Listening.entry,"
    )


@pytest.mark.parametrize(("text", "problem"), [
    ("0.000 bed.Infusion: Self_Test.entry\nnonsense\n", ":2: error: not a line of `ravenchart"),
    ("0.000 bed.Nothing: A.entry\n", ":1: error: the model has no chart bed.Nothing"),
    ("0.000 bed.Infusion: Nowhere.entry\n", "bed.Infusion has no behaviour Nowhere.entry"),
    ("0.000 bed.Infusion: Alarm.exit\n", ":1: error: Alarm is left, but was not active"),
    ("1.000 bed.Keys: pressed.effect\n0.000 bed.Keys: pressed.effect\n", ":2: error: the time is"),
    ('{"at_ns": "1"}\n', ":1: error: not a line of"),
    ("E 1\nM abc\nEND\n", "was generated from another model"),
    ("E 1\nT x\nEND\n", ":2: error: not a trace line"),
    ("", "the trace has no digest"),
])  # fmt: skip
def test_what_is_no_trace_of_the_model_is_refused_with_its_line(
    text: str, problem: str, tmp_path: Path, capsys: PRINTED
) -> None:
    path, out = tmp_path / "trace.txt", tmp_path / "out.json"
    path.write_text(text)
    assert main(["trace", str(PUMP / "model.yaml"), str(path), "--out", str(out)]) == 1
    assert problem in capsys.readouterr().err
    assert not out.exists()


def test_another_suffix_and_a_missing_file_are_refused(tmp_path: Path, capsys: PRINTED) -> None:
    model = str(PUMP / "model.yaml")
    with pytest.raises(SystemExit):
        main(["trace", model, "trace.txt", "--out", "out.txt"])
    assert "'out.txt' has no suffix of .csv, .json, .mf4" in capsys.readouterr().err
    assert main(["trace", model, str(tmp_path / "none"), "--out", str(tmp_path / "o.csv")]) == 2
