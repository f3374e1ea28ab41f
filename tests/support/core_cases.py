# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The reference cases as the records of `analysis.core`, times scaled to integers."""

from __future__ import annotations

import json
from decimal import Decimal
from pathlib import Path
from typing import Any

from ravenchart.analysis.core.blocking import Section
from ravenchart.analysis.core.bus import Bus, Errors, Frame
from ravenchart.analysis.core.frames import classic_bits
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.core.platform import Platform
from ravenchart.analysis.core.tasks import Task

REFERENCE = Path(__file__).parents[1] / "reference"

NS_PER_MS = 10**6


def cases(file: str, *models: str) -> list[Any]:
    """The cases of a file that are of one of the models."""
    text = (REFERENCE / file).read_text(encoding="utf-8")
    found = json.loads(text, parse_float=Decimal)["cases"]
    return [case for case in found if case["model"] in models]


def tasks_of(case: Any) -> list[Task]:
    """The tasks; priorities are 0 where the case gives none, and so are offsets in one with any."""
    known = 0 if any("offset" in t for t in case["tasks"]) else None
    return [
        Task(
            t["name"],
            t.get("prio", 0),
            t["T"],
            t["D"],
            t["C"],
            t.get("J", 0),
            offset=t.get("offset", known),
        )
        for t in case["tasks"]
    ]


def sections_of(case: Any) -> list[Section]:
    return [Section(name, t["name"], n) for t in case["tasks"] for name, n in t.get("cs", [])]


def ns(milliseconds: Any) -> int:
    """Exactly, in ns."""
    value = Decimal(str(milliseconds)) * NS_PER_MS
    assert value == int(value)
    return int(value)


def bus_of(case: Any) -> Bus:
    errors = case.get("errors")
    model = Errors(ns(errors["T"]), errors["n"], errors["bits"]) if errors else None
    return Bus(bit_time=NS_PER_MS // case["bit_rate_kbit"], errors=model)


def frames_of(case: Any) -> list[Frame]:
    """The frames; a higher priority is a lower rank, and the order given where there is none."""
    rate = case["bit_rate_kbit"] * 1000
    return [
        Frame(
            m["name"],
            100 - m["prio"] if "prio" in m else n,
            ns(m["T"]),
            ns(m["D"]),
            classic_bits(m["s"], extended=m["ext"]).time(rate),
            ns(m["J"]),
        )
        for n, m in enumerate(case["messages"])
    ]


def network_of(case: Any) -> Network:
    """The chains of a holistic case: each step is released by the one before."""
    tasks: list[Task] = []
    frames: dict[str, tuple[Frame, ...]] = {}
    released: dict[str, str] = {}
    for chain in case["transactions"]:
        before = None
        for step in chain["steps"]:
            resource = case["resources"][step["on"]]
            jitter = chain["J"] if before is None else 0
            name, cost, best = step["name"], step["C"], step["Cb"]
            times = (chain["T"], chain["D"], cost, jitter)
            if resource["kind"] == "fp":
                tasks.append(Task(name, step["prio"], *times, core=step["on"], best=best))
            else:
                frame = Frame(name, 100 - step["prio"], *times, best=best)
                frames[step["on"]] = (*frames.get(step["on"], ()), frame)
            if before is not None:
                released[name] = before
            before = name
    buses = {n: Bus(r["tau"]) for n, r in case["resources"].items() if r["kind"] == "fpnp"}
    return Network(tuple(tasks), frames, buses, released)


def two_nodes() -> Network:
    """The system of two_nodes.mast, in microseconds."""
    return Network(
        tasks=(
            Task("sense", 20, 10_000, 10_000, 900, 50, "obc", timed=True),
            Task("housekeeping", 10, 100_000, 100_000, 3_000, core="obc", sporadic=True),
            Task("wheel", 30, 10_000, 10_000, 700, core="act"),
        ),
        frames={
            "can": (
                Frame("frame_cmd", 1, 10_000, 10_000, 270),
                Frame("frame_hk", 2, 100_000, 100_000, 270),
            )
        },
        buses={"can": Bus(bit_time=2)},
        released_by={
            "frame_cmd": "sense",
            "wheel": "frame_cmd",
            "frame_hk": "housekeeping",
        },
        sections=(Section("state", "sense", 40), Section("state", "housekeeping", 120)),
        platforms={
            "obc": Platform(context_switch=5, tick_period=1_000, tick_wcet=10),
            "act": Platform(context_switch=5),
        },
    )
