# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Traces, and files in the trace event format of Chrome, which Perfetto opens."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ravenchart.analysis.system.observed import read_map
from ravenchart.paths import ROOT

Json = dict[str, Any]

PUMP = ROOT / "examples" / "pump"


def lines_of(folder: Path, *told: str, end: bool = True) -> str:
    """A trace: lines as the controller writes them, but elements and values by their names."""
    trace_map = read_map((folder / "trace.json").read_text(encoding="utf-8"))
    found = ["E 1000000", f"M {trace_map.digest}"]
    for line in told:
        words = line.split()
        if words[0] == "T":
            kinds = {"Activity": "row", "State": "region", "Transition": "region",
                     "Raised": "event", "Arrived": "port"}  # fmt: skip
            element = trace_map.named(words[3], kinds[words[2]])
            values = {"State": element.leaves, "Transition": element.transitions}.get(words[2], ())
            value = values.index(words[4]) if values else words[4]
            line = f"T {words[1]} {words[2]} {element.number} {value}"
        elif words[0] == "V":
            element = trace_map.named(words[2], "value")
            value = element.literals.index(words[3]) if element.literals else words[3]
            line = f"V {words[1]} {element.number} {value}"
        elif words[0] in "PA":
            element = trace_map.named(words[1], "processor" if words[0] == "P" else "row")
            line = " ".join((words[0], str(element.number), *words[2:]))
        found.append(line)
    return "".join(f"{line}\n" for line in (*found, *(["END"] if end else [])))


RUN = (
    "T 100 Activity bed.Infusion 0",
    "T 1500 State bed.Infusion Self_Test",
    "T 1600 State bed.Infusion.Motor Turning",
    "T 1700 State bed.Infusion.Sensor Listening",
    "T 20001600 State bed.Infusion.Motor Motor_Good",
    "T 30000000 Transition bed.Infusion ready",
    "T 30000100 State bed.Infusion Programming",
    "T 40000000 Arrived bed.line 1",
    "T 40000250 Raised bed.Stop 0",
    "N 100000000",
    "P hurried 2 1 7000 5000", "A bed.Infusion 6500", "H Overrun 1", "L trace 3", "L ward.sent 9",
    "L ward.lost_in 2",
)  # fmt: skip


def run_of_the_pump(folder: Path) -> Path:
    """The trace of a run of the pump; its most urgent processor is in the P line."""
    names = json.loads((PUMP / "generated" / "trace.json").read_text(encoding="utf-8"))
    periodic = [one["element"] for one in names["elements"] if one["kind"] == "processor"][1]
    told = [line.replace("hurried", periodic) for line in RUN]
    path = folder / "trace.txt"
    path.write_text(lines_of(PUMP / "generated", *told), encoding="ascii")
    return path


def events_of(out: Path) -> tuple[Json, list[Json], dict[tuple[int, int], str]]:
    """The JSON object, its events, and its tracks by process and thread."""
    whole = json.loads(out.read_text(encoding="utf-8"))
    events = whole["traceEvents"]
    tracks = {
        (one["pid"], one["tid"]): one["args"]["name"]
        for one in events
        if one["name"] == "thread_name"
    }
    return whole, events, tracks


def well_formed(whole: Json) -> None:
    """As the trace event format asks for, clause by clause."""
    assert set(whole) == {"displayTimeUnit", "otherData", "traceEvents"}
    assert whole["displayTimeUnit"] in ("ms", "ns")
    last = 0.0
    for one in whole["traceEvents"]:
        assert isinstance(one["pid"], int), one
        if one["ph"] != "C":  # a counter belongs to its process
            assert isinstance(one["tid"], int), one
            assert one["pid"] != one["tid"], "that thread would be called the main one"
        match one["ph"]:
            case "M":
                known = {"process_name": "name", "thread_name": "name",
                         "thread_sort_index": "sort_index"}  # fmt: skip
                assert list(one["args"]) == [known[one["name"]]]
                assert set(one) == {"name", "ph", "pid", "tid", "args"}
            case "X":
                assert one["dur"] >= 0 and one["cat"] in ("state", "value") and one["name"]
            case "i":
                assert one["s"] == "t" and one["cat"] and one["name"]
            case "C":
                assert one["cat"] == "value" and one["name"]
                assert [type(value) in (int, float) for value in one["args"].values()] == [True]
            case other:
                raise AssertionError(f"no such phase: {other}")
        if one["ph"] != "M":
            assert one["ts"] >= last, "events are in order of time"
            last = one["ts"]
    slices: dict[tuple[int, int], float] = {}
    for one in whole["traceEvents"]:
        if one["ph"] == "X":
            place = one["pid"], one["tid"]
            assert one["ts"] >= slices.get(place, 0.0) - 1e-6, "slices of a track overlap"
            slices[place] = one["ts"] + one["dur"]
