# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Files in the trace event format of Chrome, which Perfetto opens: read, and held against it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

Json = dict[str, Any]


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
