# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A soak: the robot in virtual time under random faults, one after another.

Each episode brings the robot from wherever the last one left it to Ready, and then one fault. The
safe state is reached within its bound, of the right joints and once; what is no fault for the
robot, such as a few lost frames, brings nobody into it. In virtual time no task can be killed:
tests/system/test_liveness.py does that to the running program.
"""

from __future__ import annotations

import os
import random
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import pytest

from ravenchart.behaviour.interpreter.stimuli import Arrived, Stimuli
from ravenchart.behaviour.interpreter.traces import StepRecord
from ravenchart.building import checking
from ravenchart.commands.simulate import build_simulation, run_simulation
from ravenchart.gen.language.terms import Ns, Value
from ravenchart.gen.model.instances import End
from ravenchart.paths import ROOT
from tests.support.faults import shows

pytestmark = [pytest.mark.alone, pytest.mark.slow]

SEED = 2026
EPISODE = 2_500
"""Milliseconds from one fault's beginning to the next one's, and so all times here."""
EPISODES = 720 if "RAVENCHART_LONG_TESTS" in os.environ else 120
"""30 minutes of virtual time with `make test-long`, else 5."""
JOINTS = ("joint_x", "joint_y", "joint_z")
MS = 1_000_000

MAX_AGE, PORTS, MONITORING, MOTION, MISSION = 50, 10, 10, 20, 20
"""Of the model: when feedback is stale, and the periods of what handles it."""
STALE = MAX_AGE + PORTS + MOTION
REPORTED = PORTS + MONITORING + MOTION
STRAYED = 400
"""Until a drive that stands still is 20 mm behind: 224 ms at 800 mm/s2, and what comes before."""
STOPPED = 3 * MISSION
"""From the first joint's fault to the mission's: report, its arrival, the step."""


@dataclass(frozen=True, slots=True)
class Fault:
    """What happens to the feedback of some joints, and what must follow."""

    kind: str
    at: int
    joints: tuple[str, ...] = ()
    """Whose feedback it concerns."""
    within: int = 0
    """Ms from its beginning to the safe state; 0: nobody must enter it."""
    lost: frozenset[tuple[str, int]] = frozenset()
    """Single frames that are lost: joint and time."""

    def ends(self) -> int:
        """When all is well again."""
        return self.at + 300


def chosen(start: int, chance: random.Random) -> Fault:
    """One of all kinds, at some time in the episode that begins then."""
    at = start + chance.randrange(1_000, 1_400)
    kind = chance.choice(("silent", "cut", "faulted", "limit", "still", "corrupted", "flood"))
    one = (chance.choice(JOINTS),)
    match kind:
        case "silent":
            return Fault(kind, at, one, STALE)
        case "cut":
            return Fault(kind, at, JOINTS, STALE)
        case "faulted":
            return Fault(kind, at, one, REPORTED)
        case "limit":  # while it homes
            return Fault(kind, start + chance.randrange(300, 390), one, REPORTED)
        case "still":
            return Fault(kind, at, JOINTS, STRAYED)
        case "corrupted":
            return Fault(kind, at, lost=frozenset(_gaps(at, chance)))
    return Fault(kind, at)


def _gaps(at: int, chance: random.Random) -> Iterator[tuple[str, int]]:
    """Frames of each joint: at most eight in a row are lost, which is younger than stale."""
    for joint in JOINTS:
        time = at
        while time < at + 300:
            run = chance.randrange(1, 9)
            yield from ((joint, t) for t in range(time, time + 5 * run))
            time += 5 * (run + chance.randrange(1, 4))


def feedback(joint: str, time: int, start: int, fault: Fault) -> Value | None:
    """What a drive reports then; None for nothing."""
    limit, condition = "Low_End" if 400 <= time - start < 600 else "Clear", "Ready"
    if (joint, time) in fault.lost:
        return None
    if joint in fault.joints and fault.at <= time < fault.ends():
        match fault.kind:
            case "silent" | "cut":
                return None
            case "faulted":
                condition = "Faulted"
            case "limit":
                limit = "High_End"
    return (("count", 0), ("speed", 0), ("limit", limit), ("condition", condition))


def commands(start: int, fault: Fault) -> Iterator[tuple[int, str, int]]:
    """Time, kind and target of what the operator says."""
    yield start, "Reset", 0
    yield start + 200, "Home", 0
    if fault.kind == "still":
        yield fault.at, "Move", 100_000
    if fault.kind == "flood":
        yield from ((fault.at, "Move", 0) for _ in range(20))


def entries(start: int, fault: Fault) -> list[Arrived]:
    """All that arrives in an episode, in order of time."""
    found: list[Arrived] = []
    for time, kind, target in commands(start, fault):
        order = (("kind", kind), ("x", target), ("y", target), ("z", target))
        found.append(Arrived(Ns(time * MS), End("coordinator", "command"), order))
    for time in range(start + 1, start + EPISODE, 5):
        for joint in JOINTS:
            value = feedback(joint, time, start, fault)
            if value is not None:
                found.append(Arrived(Ns(time * MS), End(joint, "feedback"), value))
    return sorted(found, key=lambda entry: entry.at)


def entered(records: list[StepRecord], element: str, state: str) -> list[int]:
    """When a region entered a state, in ms."""
    return [
        record.at // MS
        for record in records
        if f"{record.instance}.{record.region}" == element and f"{state}.entry" in record.behaviours
    ]


def problem(records: list[StepRecord], start: int, fault: Fault) -> str:
    """What is wrong with an episode; "" where the right joints are safe in time, and once."""
    faults = {joint: entered(records, f"{joint}.Motion", "Fault") for joint in JOINTS}
    stops = entered(records, "coordinator.Mission", "Stopped")
    if not all(entered(records, f"{joint}.Motion", "Homing") for joint in JOINTS):
        return "a joint did not home again"
    if fault.within == 0:
        return f"a fault without cause: {faults}, {stops}" if stops or any(faults.values()) else ""
    hit = {joint: times for joint, times in faults.items() if times}
    all_hit = set(hit) == set(fault.joints) or (fault.kind == "still" and hit)
    if not all_hit or any(len(times) > 1 for times in hit.values()):
        return f"not once each: {faults}"
    late = {j: t for j, t in hit.items() if not fault.at < t[0] <= fault.at + fault.within}
    if late:
        return f"not within {fault.within} ms: {late}"
    first = min(times[0] for times in hit.values())
    if len(stops) != 1 or not first < stops[0] <= first + STOPPED:
        return f"the mission stops at {stops}, the first joint at {first}"
    return ""


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Callable[[Stimuli], list[StepRecord]]:
    """The robot's program in virtual time."""
    checked = checking.check(ROOT / "examples" / "cartesian_robot" / "model.yaml")
    home = tmp_path_factory.mktemp("soak")
    program = build_simulation(checked.system, checked.folder, home)
    return lambda stimuli: run_simulation(checked.system, program, stimuli)


@shows(
    "random faults one after another: a drive or all of them silent, a drive that reports a fault, "
    "stands still or meets a limit, frames lost, queues filled",
    found_by="stale input, guards of the charts",
    reaction="each joint concerned and the mission are in their safe states, once, and home again "
    "when they are reset; no other joint is in its safe state",
    within="80 ms from silence, 40 ms from a report, 60 ms more for the mission, in virtual time",
)
def test_every_fault_of_a_soak_leads_to_the_safe_state(
    run: Callable[[Stimuli], list[StepRecord]],
) -> None:
    chance = random.Random(SEED)
    starts = range(0, EPISODES * EPISODE, EPISODE)
    faults = {start: chosen(start, chance) for start in starts}
    assert len({fault.kind for fault in faults.values()}) == 7
    arriving = tuple(entry for start in starts for entry in entries(start, faults[start]))
    episodes: dict[int, list[StepRecord]] = {start: [] for start in starts}
    for record in run(Stimuli(arriving, Ns(EPISODES * EPISODE * MS - 1))):
        episodes[record.at // (EPISODE * MS) * EPISODE].append(record)
    for start, fault in faults.items():
        found = problem(episodes[start], start, fault)
        assert found == "", f"seed {SEED}: {fault} of {start} ms"


def test_a_soak_sees_what_is_wrong() -> None:
    """The judge itself: a late, a missing and a needless safe state, and a second one."""
    silent = Fault("silent", 1_000, ("joint_x",), STALE)
    homing = [StepRecord(Ns(250 * MS), joint, "Motion", ("Homing.entry",)) for joint in JOINTS]

    def record(at: int, instance: str, region: str, state: str) -> StepRecord:
        return StepRecord(Ns(at * MS), instance, region, (f"{state}.entry",))

    safe = record(1_070, "joint_x", "Motion", "Fault")
    stop = record(1_100, "coordinator", "Mission", "Stopped")
    assert problem([*homing, safe, stop], 0, silent) == ""
    late = record(1_090, "joint_x", "Motion", "Fault")
    assert problem([*homing, late, stop], 0, silent).startswith("not within 80 ms")
    assert problem([*homing, stop], 0, silent).startswith("not once each")
    assert problem([*homing, safe, safe, stop], 0, silent).startswith("not once each")
    assert problem([*homing, safe], 0, silent).startswith("the mission stops at []")
    assert problem([*homing, safe], 0, Fault("flood", 1_000)).startswith("a fault without cause")
    assert problem([safe, stop], 0, silent) == "a joint did not home again"
