# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Charts in motion: what was done is an event file, and every act can be taken back."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Literal

import pytest

from ravenchart.behaviour.cases.stimulation import choices
from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.behaviour.interpreter.region import Stuck
from ravenchart.behaviour.interpreter.stimuli import Raised
from ravenchart.building import checking
from ravenchart.commands.simulate import simulated_by_interpreter
from ravenchart.gen.derive.distribution import as_one
from ravenchart.gen.language.terms import Ns, Value
from ravenchart.gen.model.system import System
from ravenchart.paths import ROOT
from ravenchart.workbench.play import session as play_session
from ravenchart.workbench.play.requests import (
    AdvanceWish,
    Given,
    PlayRequest,
    PutWish,
    RaiseWish,
    WaitWish,
)
from ravenchart.workbench.play.session import Play
from ravenchart.workbench.play.view import arrows, play_view
from ravenchart.workbench.publishing import RefusedRequestError
from ravenchart.workbench.requests import Rewind
from tests.support.interpreted import chart_system, stimuli_of

KINDS: tuple[Literal["execution", "firing", "time_out"], ...] = (
    "execution", "execution", "firing", "time_out",
)  # fmt: skip

EXAMPLES = ("pump", "crossing", "qhsmtst", "cartesian_robot", "three_components", "two_nodes")


def play_of(name: str) -> Play:
    """A play of an example."""
    model = ROOT / "examples" / name / "model.yaml"
    return Play(model, checking.check(model, deadlines=False).system)


def small(chart: str) -> Play:
    """A play of one chart, ``unit.Main``, executed every 10 ms."""
    return Play(Path("model.yaml"), chart_system(chart))


def go(play: Play, kind: str = "execution", chart: str = "unit.Main") -> None:
    """Let time go on."""
    play.do(AdvanceWish.model_validate({"kind": kind, "chart": chart, "number": 0}))


def give(play: Play, event: str, value: Given | None = None) -> None:
    """Raise an event of ``unit``."""
    play.do(RaiseWish(kind="raise", instance="unit", event=event, value=value, number=0))


def back(play: Play, kind: str = "undo") -> None:
    """Undo or redo."""
    play.do(Rewind.model_validate({"kind": kind, "number": 0}))


def given(value: Value) -> Given:
    """A value as the page sends it."""
    return dict(value) if isinstance(value, tuple) else value


def wishes(
    system: System, chance: random.Random, charts: list[str], count: int
) -> list[PlayRequest]:
    """What somebody may do, at random."""
    stimuli = choices(system)
    found: list[PlayRequest] = []
    for _ in range(count):
        if stimuli and chance.random() < 0.5:
            entry = chance.choice(stimuli).drawn(Ns(0), chance)
            value = None if entry.value is None else given(entry.value)
            instance, what = entry.receiver
            if isinstance(entry, Raised):
                found.append(
                    RaiseWish(kind="raise", instance=instance, event=what, value=value, number=0)
                )
            else:
                assert value is not None
                found.append(
                    PutWish(kind="put", instance=instance, port=what, value=value, number=0)
                )
        elif chance.random() < 0.15:
            found.append(Rewind(kind=chance.choice(("undo", "redo")), number=0))
        elif chance.random() < 0.3:
            found.append(WaitWish(kind="wait", duration=f"{chance.randint(1, 700)} ms", number=0))
        else:
            kind = chance.choice(KINDS)
            found.append(AdvanceWish(kind=kind, chart=chance.choice(charts), number=0))
    return found


@pytest.mark.slow
@pytest.mark.parametrize("name", EXAMPLES)
def test_the_event_file_gives_the_same_trace(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(play_session, "MOST_RELEASES", 300)
    play = play_of(name)
    chance = random.Random(7)
    for wish in wishes(play.system, chance, list(play.charts), 60):
        try:
            play.do(wish)
        except RefusedRequestError as problem:  # no time-out runs, or the next release is later
            assert isinstance(wish, AdvanceWish | WaitWish), problem
        text = play.event_file()
        if text is not None and chance.random() < 0.3:
            stimuli = stimuli_of(text, play.system)
            assert simulated_by_interpreter(play.system, stimuli) == list(play.records())
    assert len(list(play.records())) > 5


def test_undo_takes_back_all_that_an_act_did_and_redo_does_it_again() -> None:
    play = play_of("pump")
    seen = [{**play_view(play), "redo": None, "number": 0}]
    for wish in wishes(play.system, random.Random(3), list(play.charts), 25):
        if not isinstance(wish, Rewind):
            try:
                play.do(wish)
            except RefusedRequestError:
                continue
            seen.append({**play_view(play), "redo": None, "number": 0})
    assert len(seen) > 10
    for before in reversed(seen[:-1]):
        back(play)
        assert {**play_view(play), "redo": None, "number": 0} == before
    back(play)
    assert play.undo_label is None
    for after in seen[1:]:
        back(play, "redo")
        assert {**play_view(play), "redo": None, "number": 0} == after
    assert play.redo_label is None


def test_an_act_after_undo_forgets_what_was_taken_back() -> None:
    play = small(SWITCH)
    go(play)
    go(play)
    back(play)
    give(play, "Go")
    assert play.redo_label is None and play.undo_label == "raise unit.Go"


SWITCH = """
initial: Off
states: {Off: {}, Lit: {}}
transitions:
  on: {from: Off, to: Lit, on: Go}
  off: {from: Lit, to: Off, after: 30 ms}
"""


def chart_of(play: Play) -> dict[str, object]:
    """The only chart, as the page gets it."""
    (found,) = play_view(play)["charts"]
    assert isinstance(found, dict)
    return found


def test_what_the_page_gets_of_an_event_and_a_time_out() -> None:
    play = small(SWITCH)
    assert play_view(play)["now"] is None and chart_of(play)["last"] is None
    go(play)
    give(play, "Go")
    shown = play_view(play)
    assert (shown["now"], shown["next"], shown["waiting"]) == ("0.000 s", "0.010 s", 1)
    assert chart_of(play)["queue"] == ["Go"]
    assert play.event_file() == (
        "# Interpreted: recorded in the page of `simulate --open`.\n- {until: 0}\n"
    )
    go(play)
    found = chart_of(play)
    assert found["active"] == ["Lit"]
    assert found["timers"] == [{"transition": "off", "left": "30 ms"}]
    last = found["last"]
    assert isinstance(last, dict)
    assert last["taken"] == ["on"]
    assert last["steps"][0]["occurrence"] == "the event Go"
    assert [one["reason"] for one in last["steps"][0]["verdicts"]] == ["fired"]
    go(play)
    last = chart_of(play)["last"]
    assert isinstance(last, dict)
    assert [one["reason"] for one in last["steps"][0]["verdicts"]] == [
        "not yet due: 20 ms left (2 executions)"
    ]
    go(play, "time_out")
    assert play_view(play)["trace"][-1] == "0.040 unit.Main: Lit.exit, off.effect, Off.entry"
    with pytest.raises(RefusedRequestError, match="no time-out runs in the active states"):
        go(play, "time_out")
    assert play.event_file() == (
        "# Interpreted: recorded in the page of `simulate --open`.\n"
        "- {at: 10 ms, raise: unit.Go}\n- {until: 40 ms}\n"
    )


def test_a_guard_is_false_with_its_values() -> None:
    play = small("""
data: {x: 3}
initial: A
states: {A: {}, B: {}}
transitions:
  small: {from: A, to: B, on: Go, guard: x < 3}
  up: {from: A, on: Up, guard: x < 9, effect: [{set: x, to: "min(x + 1, 9)"}]}
""")
    go(play)
    give(play, "Go")
    go(play)
    last = chart_of(play)["last"]
    assert isinstance(last, dict)
    assert {one["transition"]: one["reason"] for one in last["steps"][0]["verdicts"]} == {
        "small": "its guard `x < 3` is false: x = 3", "up": "waits for the event Up",
    }  # fmt: skip


def test_time_that_does_not_reach_what_was_wished_says_where_it_stopped(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(play_session, "MOST_RELEASES", 5)
    play = small(SWITCH)
    go(play)
    go(play, "firing")
    assert play.now.remark == "unit.Main has not fired up to 50 ms: repeat to go on"
    play.do(WaitWish(kind="wait", duration="1 s", number=0))
    assert play.now.remark == "stopped at 100 ms: repeat to go on"


@pytest.mark.parametrize(("wish", "text"), [
    (RaiseWish(kind="raise", instance="unit", event="Nope", number=0), "unit has no event `Nope`"),
    (RaiseWish(kind="raise", instance="none", event="Go", number=0), "there is no instance `none`"),
    (RaiseWish(kind="raise", instance="unit", event="Go", value=1, number=0),
     "the event Go carries no value"),
    (PutWish(kind="put", instance="unit", port="x", value="a: b", number=0), "no input port `x`"),
    (AdvanceWish(kind="execution", chart="unit.None", number=0),
     "the model has no chart unit.None"),
    (WaitWish(kind="wait", duration="soon", number=0), "`soon` is not a duration up to one hour"),
    (WaitWish(kind="wait", duration="2 ns", number=0),
     "the next release is at 10 ms: wait longer"),
])  # fmt: skip
def test_what_cannot_be_done_is_refused_in_words(wish: PlayRequest, text: str) -> None:
    play = small(SWITCH)
    go(play)
    before = play_view(play)
    with pytest.raises(RefusedRequestError, match=text.replace("`", ".")):
        play.do(wish)
    assert play_view(play) == before


def test_a_value_out_of_range_is_refused_with_the_range() -> None:
    play = play_of("pump")
    wish = PutWish(kind="put", instance="bed", port="line", value="Wine", number=0)
    with pytest.raises(RefusedRequestError, match="is one of Clear"):
        play.do(wish)


def test_a_pseudostate_without_a_way_out_is_refused_and_nothing_has_happened() -> None:
    play = small("""
data: {x: 3}
initial: A
states: {A: {}, B: {}, C: {kind: choice}}
transitions:
  go: {from: A, to: C, on: Go}
  one: {from: C, to: B, guard: x > 5}
  two: {from: C, to: B, guard: x > 6}
  up: {from: A, on: Up, guard: x < 9, effect: [{set: x, to: "min(x + 1, 9)"}]}
""")
    go(play)
    give(play, "Go")
    before = play_view(play)
    with pytest.raises(RefusedRequestError, match="C has no way out"):
        go(play)
    assert play_view(play) == before


def test_an_event_file_is_gone_on_from() -> None:
    model = ROOT / "examples" / "pump" / "model.yaml"
    system = checking.check(model, deadlines=False).system
    text = (model.parent / "events.yaml").read_text(encoding="utf-8")
    stimuli = stimuli_of(text, system)
    play = Play(model, system, stimuli)
    assert list(play.records()) == simulated_by_interpreter(system, stimuli)
    assert play.undo_label == "the event file"
    go(play, chart="bed.Infusion")
    again = stimuli_of(play.event_file() or "", system)
    assert list(play.records()) == list(Machine(as_one(system)).run(again))


def test_only_the_last_acts_can_be_undone_and_the_trace_stays(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(play_session, "MOST_STATES", 3)
    play = small(SWITCH)
    for _ in range(4):
        give(play, "Go")
        go(play)
    trace = list(play.records())
    for _ in range(5):
        back(play)
    assert play.undo_label is None
    for _ in range(5):
        back(play, "redo")
    assert list(play.records()) == trace
    assert trace == simulated_by_interpreter(
        play.system, stimuli_of(play.event_file() or "", play.system)
    )


def test_a_transition_is_found_in_its_drawing() -> None:
    found = arrows(play_of("pump"), "Pump.Infusion")
    assert ("Self_Test to Programming", "") in found["ready"]
    assert arrows(play_of("pump"), "Pump.None") == {}


def test_a_chart_that_sticks_in_the_event_file_says_so() -> None:
    system = chart_system("""
data: {x: 3}
initial: A
states: {A: {}, B: {}, C: {kind: choice}}
transitions:
  go: {from: A, to: C, on: Go}
  one: {from: C, to: B, guard: x > 5}
  up: {from: A, on: Up, guard: x < 9, effect: [{set: x, to: "min(x + 1, 9)"}]}
""")
    with pytest.raises(Stuck):
        Play(
            Path("m.yaml"), system, stimuli_of("[{at: 0, raise: unit.Up}, {at: 10 ms, "
            "raise: unit.Go}, {until: 50 ms}]", system),
        )  # fmt: skip
