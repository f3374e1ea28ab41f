# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What examples/pump/requirements.csv asks of the pump, one test for each requirement.

`--tests` gives the results to the evidence of the example: each test names its requirement.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

from ravenchart.behaviour.interpreter import stimuli
from ravenchart.commands import simulate
from ravenchart.evidence import lists
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import load
from ravenchart.paths import ROOT

FOLDER = ROOT / "examples" / "pump"
CLEAR = ("500 ms: line = Clear", "2500 ms: line = Clear")
ORDERED = ("200 ms: 400 Portion_Key", "300 ms: 1000 Volume_Key")
STARTED = "1500 ms: 0 Start_Key"
WORKING = (*ORDERED, *CLEAR, STARTED)
"""The pump gives 400 ul a beat, double at first, from 2550 ms on."""


@cache
def _pump() -> System:
    system = load(FOLDER / "model.yaml").system
    assert system is not None
    return system


def _line(event: str) -> str:
    """One entry of an event file: ``time: line = value`` or ``time: amount key``."""
    time, _, what = event.partition(": ")
    if what.startswith("line = "):
        return f"- {{at: {time}, put: bed.line, value: {what.removeprefix('line = ')}}}"
    amount, key = what.split()
    return f"- {{at: {time}, put: bed.panel, value: {{key: {key}, amount: {amount}}}}}"


def _milliseconds(event: str) -> float:
    number, unit = event.partition(": ")[0].split()
    return float(number) * {"ms": 1, "s": 1000}[unit]


def _played(until: str, *events: str) -> list[str]:
    """What the region does, a line for each step, with its time in seconds."""
    lines = [_line(event) for event in sorted(events, key=_milliseconds)]
    text = "\n".join([*lines, f"- {{until: {until}}}"])
    given, found = stimuli.read(text, "events.yaml", _pump())
    assert given is not None, [str(one) for one in found]
    records = simulate.simulated_by_interpreter(_pump(), given)
    return [one.text() for one in records if one.text().split()[1] == "bed.Infusion:"]


def _does(steps: list[str], behaviour: str) -> list[float]:
    """When it is done, in seconds."""
    return [
        float(step.split()[0]) for step in steps if behaviour in step.split(": ")[1].split(", ")
    ]


Names = Callable[[str], None]


@pytest.fixture
def names(record_property: Callable[[str, object], None]) -> Names:
    """A test says which requirement it is for."""
    return lambda requirement: record_property("req", requirement)


def test_no_infusion_starts_before_both_tests_have_ended(names: Names) -> None:
    names("R-1")
    early = _played("3 s", "200 ms: 400 Portion_Key", "300 ms: 1000 Volume_Key", STARTED)
    assert _does(early, "turned.effect") and not _does(early, "heard.effect")
    assert not _does(early, "ready.effect") and not _does(early, "start.effect")
    assert _does(_played("3 s", *WORKING), "start.effect") == [1.5]


def test_the_ordered_volume_ends_the_infusion(names: Names) -> None:
    names("R-2")
    steps = _played("5400 ms", *WORKING)
    assert len(_does(steps, "beat.effect")) == 2  # 800 ul, and 200 of the next 400
    assert len(_does(steps, "enough.effect")) == 1


def test_an_alarm_leaves_the_states_in_which_the_motor_runs(names: Names) -> None:
    names("R-3")
    steps = _played("5 s", *WORKING, "3 s: line = Air")
    (alarm,) = _does(steps, "Alarm.entry")
    assert _does(steps, "Infusing.exit") == [alarm]
    assert not [time for time in _does(steps, "beat.effect") if time > alarm]


def test_a_silenced_alarm_sounds_again_after_half_a_minute(names: Names) -> None:
    names("R-4")
    steps = _played("40 s", *WORKING, "3 s: line = Air", "4 s: 0 Silence_Key")
    assert _does(steps, "Silent.entry") == [4.0]
    assert _does(steps, "Sounding.entry") == [3.0, 34.0]


@pytest.mark.parametrize("line", ["Air", "Blocked"])
def test_air_and_a_blocked_line_lead_to_an_alarm(names: Names, line: str) -> None:
    names("R-5")
    assert _does(_played("4 s", *WORKING, f"3 s: line = {line}"), "trouble.effect") == [3.0]
    assert not _does(_played("4 s", *WORKING, "3 s: line = Clear"), "trouble.effect")


def test_a_silent_sensor_leads_to_an_alarm(names: Names) -> None:
    names("R-6")
    (lost,) = _does(_played("7 s", *WORKING), "lost.effect")
    assert 5.5 < lost <= 5.6  # 3 s after the last value, within two periods
    assert not _does(_played("7 s", *WORKING, "5 s: line = Clear"), "lost.effect")


def test_an_infusion_goes_on_where_it_was_when_the_line_is_clear(names: Names) -> None:
    names("R-7")
    stopped = (*WORKING, "3 s: line = Air")
    early = _played("5 s", *stopped, "3500 ms: 0 Resume_Key")
    assert _does(early, "not_yet.effect") == [3.5] and not _does(early, "go_on.effect")
    steps = _played("6 s", *stopped, "4500 ms: line = Clear", "5 s: 0 Resume_Key")
    (resumed,) = _does(steps, "go_on.effect")
    assert resumed in _does(steps, "Loading.entry")  # the state that the alarm had left


def test_what_is_ordered_in_an_alarm_is_given_after_it(names: Names) -> None:
    names("R-8")
    more = ("300 ms: 9000 Volume_Key", "200 ms: 400 Portion_Key", *CLEAR, STARTED)
    alarm = ("5 s: line = Air", "5500 ms: 500 Portion_Key", "6 s: line = Clear")
    steps = _played("7 s", *more, *alarm, "6500 ms: 0 Resume_Key")
    (changed,) = _does(steps, "change.effect")
    assert 6.5 < changed <= 6.6


def test_the_vein_is_kept_open_at_the_end(names: Names) -> None:
    names("R-9")
    steps = _played("5400 ms", *WORKING)
    (finished,) = _does(steps, "finished.effect")
    assert _does(steps, "Trickling.entry") == [finished]
    assert finished > _does(steps, "enough.effect")[0]


def test_each_requirement_has_a_test() -> None:
    text = Path(__file__).read_text()
    listed = lists.read(FOLDER / "requirements.csv")
    assert len(listed) == 9
    assert [one.id for one in listed if f'names("{one.id}")' not in text] == []
