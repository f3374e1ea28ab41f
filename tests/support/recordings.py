# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Traces of runs as controllers write them, and what their monitors had shown meanwhile."""

from __future__ import annotations

import random
from collections.abc import Sequence
from pathlib import Path

from ravenchart.analysis.system.observed import TraceMap
from ravenchart.analysis.system.timing import Analysis
from ravenchart.running.monitored import NodeMonitor, WatchedNode
from ravenchart.running.snapshots import KINDS, RECENT, parsed_snapshot
from tests.support.snapshot_files import snapshot

LISTED = ("Transition", "Fault")


def random_trace(trace_map: TraceMap, seed: int, length: int = 300) -> list[str]:
    """The lines of a run, without its head: records of all kinds, and a report now and then."""
    chance = random.Random(seed)
    lines, now, losses, releases = report(trace_map, 0, 0, 0), 0, 0, 0
    elements = {kind: trace_map.of_kind(kind) for kind in
                ("region", "port", "event", "row", "value", "processor")}  # fmt: skip
    for _ in range(length):
        now += chance.choice((0, 0, 1, 5000, 700_000))  # several records of one instant, too
        what = chance.randrange(9)
        if what < 2:
            region = chance.choice(elements["region"])
            lines.append(f"T {now} State {region.number} {chance.randrange(len(region.leaves))}")
        elif what < 4:
            region = chance.choice([one for one in elements["region"] if one.transitions])
            number = chance.randrange(len(region.transitions))
            lines.append(f"T {now} Transition {region.number} {number}")
        elif what == 4:
            port = chance.choice(elements["port"]).number
            kind = chance.choice(("Arrived", "Handled", "Sent", "Fault"))
            lines.append(f"T {now} {kind} {port} {chance.randrange(3)}")
        elif what == 5:
            lines.append(f"T {now} Activity {chance.choice(elements['row']).number} 0")
        elif what == 6 and elements["value"]:
            value = chance.choice(elements["value"])
            most = len(value.literals) or 100
            lines.append(f"V {now} {value.number} {chance.randrange(most)}")
        elif what == 7:
            lines.append(f"T {now} Raised {chance.choice(elements['event']).number} 0")
        elif what == 8:
            releases, losses = releases + chance.randrange(5), losses + chance.randrange(2)
            lines += report(trace_map, now, releases, losses)
    return [*lines, *report(trace_map, now + 1, releases, losses), "END"]


def report(trace_map: TraceMap, now: int, releases: int, losses: int) -> list[str]:
    """The counts of a controller at one time."""
    return [
        f"N {now}",
        *(f"P {one.number} {releases} 0 {1000 + releases} {900 + releases}" for one in
          trace_map.of_kind("processor")),
        *(f"Q {one.number} {releases % 3} {2 + losses}" for one in trace_map.of_kind("region")),
        "H Deadline_Miss 0", "H Overrun 0", "H Queue_Overflow 1", f"L trace {losses}",
    ]  # fmt: skip


def write(path: Path, trace_map: TraceMap, lines: Sequence[str], digest: str = "") -> Path:
    """A trace file with these lines."""
    head = ["E 1000", f"M {digest or trace_map.digest}"]
    path.write_text("".join(f"{line}\n" for line in (*head, *lines)), encoding="ascii")
    return path


def monitored(
    analysis: Analysis, trace_map: TraceMap, lines: Sequence[str], at: int
) -> WatchedNode:
    """What a monitor shows when the controller has written these lines up to an instant.

    It is made as Ravenchart.Hosts.Snapshots makes it: line by line, with one count and the last
    record of each kind and element, the last transitions and faults, and the last report.
    """
    counts: dict[tuple[int, int], tuple[int, str, str, str]] = {}
    recent: list[str] = []
    reported: list[str] = []
    reports = 0
    for line in lines:
        first, *words = line.split()
        if first in "TVN" and int(words[0]) > at:
            break
        if first == "T" or first == "V":
            time, kind, element, value = words if first == "T" else (words[0], "VALUE", *words[1:])
            key = int(element), KINDS.index(kind.lower())
            counts[key] = counts.get(key, (0,))[0] + 1, time, value, kind
            if kind in LISTED:
                recent = [*recent, line][-RECENT:]
        elif first == "N":
            reported, reports = [line], reports + 1
        else:
            reported.append(line)
    tallies = [
        f"C {kind} {element} {count} {time} {value}"
        for (element, _), (count, time, value, kind) in sorted(counts.items())
    ]
    text = snapshot(reports, *recent, *reported, *tallies, digest=trace_map.digest)
    node = NodeMonitor(analysis, "board").shown(parsed_snapshot(text, trace_map, "file"), 0)
    node.now = at
    return node
