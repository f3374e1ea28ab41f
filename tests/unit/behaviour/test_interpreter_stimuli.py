# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Files of events: what is wrong with one is told at its line, and traces have one form."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from ravenchart.behaviour.interpreter.stimuli import Raised, read_stimuli
from ravenchart.behaviour.interpreter.traces import StepRecord, seconds
from ravenchart.command_line import main
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.system import System
from tests.support.interpreted import component_system

PART = """
ports:
  level: {in: Small}
  order: {in: Pair, kind: queued, depth: 2}
  hue: {in: Hue}
  armed: {in: Boolean}
port_region: {period: 10 ms, wcet: 1 us}
events: {Go: {}, Dial: {type: Small}}
regions:
  Main:
    period: 10 ms
    wcet: 1 us
    queue: 4
    initial: A
    states: {A: {}, B: {}}
    transitions:
      go: {from: A, to: B, on: Go}
      dial: {from: B, to: A, on: Dial, guard: event > 3}
"""
BUS = """
buses:
  can: {bit_rate: 500 kbit/s, driver_wcet: 1 us, receive_depth: 4, transmit_depth: 4}
messages:
  level_in: {bus: can, id: 0x100, to: unit.level, period: 10 ms}
  order_in: {bus: can, id: 0x101, to: unit.order, period: 10 ms}
  hue_in: {bus: can, id: 0x102, to: unit.hue, period: 10 ms}
  armed_in: {bus: can, id: 0x103, to: unit.armed, period: 10 ms}
processors:
  reception: {node: board, released_by: can, period: 10 ms, stack: 8 KiB,
              activities: [can.receive]}
  runner: {node: board, stack: 8 KiB, activities: [unit.ports, unit.Main]}
"""


@pytest.fixture(scope="module")
def system() -> System:
    return component_system(PART, more=BUS)


def test_every_form_of_entry_and_value_is_read(system: System) -> None:
    text = """
- {at: 0, raise: unit.Go}
- {at: 50 ms, raise: UNIT.dial, with: 7}
- {at: 50 ms, put: unit.level, value: 0x9}
- {at: 0.05 s, put: unit.order, value: {right: 2, left: 1}}
- {at: 60 ms, put: unit.hue, value: green}
- {at: 61 ms, put: unit.armed, value: true}
- {until: 2 s}
"""
    stimuli, found = read_stimuli(text, "events.yaml", system)
    assert found == () and stimuli is not None
    assert stimuli.entries[1] == Raised(Ns(50_000_000), "unit", "Dial", 7)
    values = [one.value for one in stimuli.entries]
    assert values == [None, 7, 9, (("left", 1), ("right", 2)), "Green", "True"]
    assert stimuli.until == 2 * 10**9


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ("{at: 5, raise: unit.Go}", "1:8: `at` takes a time [RV-1003]"),
        ("{at: 0 bits, raise: unit.Go}", "1:8: `at` takes a time [RV-1003]"),
        ("{at: 1 ms}", "1:3: the key `raise` is missing [RV-1002]"),
        ("{raise: unit.Go}", "1:3: the key `at` is missing [RV-1002]"),
        ("{at: 1 ms, put: unit.level}", "1:3: the key `value` is missing [RV-1002]"),
        (
            "{at: 1 ms, raise: unit.Go, put: unit.level}",
            "1:30: `put` has no place here [RV-1002]",
        ),
        ("{at: 1 ms, raise: Go}", "1:21: `raise` takes `instance.name` [RV-1002]"),
        ("{at: 1 ms, raise: [unit.Go]}", "1:21: `raise` takes `instance.name` [RV-1002]"),
        ("Go", "1:3: this is no mapping [RV-1002]"),
        ("{at: 1 ms, raise: unti.Go}", "1:21: there is no instance `unti` [RV-1004]"),
        ("{at: 1 ms, raise: unit.Gone}", "1:21: unit has no event `Gone` [RV-1004]"),
        ("{at: 1 ms, put: unit.Go, value: 1}", "1:19: unit has no input port `Go` [RV-1004]"),
        (
            "{at: 1 ms, raise: unit.Go, with: 1}",
            "1:30: the event Go carries no value [RV-1005]",
        ),
        (
            "{at: 1 ms, raise: unit.Dial}",
            "1:21: the event Dial carries a value of type Small [RV-1005]",
        ),
        (
            "{at: 1 ms, raise: unit.Dial, with: 10}",
            "1:38: a value of type Small is 0 .. 9 [RV-1005]",
        ),
        (
            "{at: 1 ms, raise: unit.Dial, with: true}",
            "1:38: a value of type Small is 0 .. 9 [RV-1005]",
        ),
        (
            "{at: 1 ms, put: unit.hue, value: Blue}",
            "1:36: a value of type Hue is one of Red, Green [RV-1005]",
        ),
        (
            "{at: 1 ms, put: unit.armed, value: 1}",
            "1:38: a value of type Boolean is one of False, True [RV-1005]",
        ),
        ("{at: 1 ms, put: unit.order, value: 1}", "1:38: Pair is a record [RV-1005]"),
        (
            "{at: 1 ms, put: unit.order, value: {left: 1}}",
            "1:38: the field `right` of Pair is missing [RV-1005]",
        ),
        (
            "{at: 1 ms, put: unit.order, value: {left: 1, right: 1, top: 1}}",
            "1:58: Pair has no field `top` [RV-1005]",
        ),
        ("{until: 1 ms, at: 2 ms}", "1:4: `until` has no place here [RV-1002]"),
        ("{at: 1 ms, at: 2 ms, raise: unit.Go}", "1:14: the key `at` is given twice [RV-0109]"),
    ],
)
def test_wrong_entry_is_told_at_its_place(system: System, entry: str, message: str) -> None:
    stimuli, found = read_stimuli(f"- {entry}\n- {{until: 1 s}}\n", "e.yaml", system)
    assert stimuli is None
    told = f"{found[0].origin}: {found[0].message} [{found[0].code}]"
    assert told == f"e.yaml:{message}"


@pytest.mark.parametrize(
    ("entry", "key", "meant"),
    [
        ("{untill: 1 ms}", "untill", "until"),
        ("{att: 1 ms, raise: unit.Go}", "att", "at"),
        ("{at: 1 ms, rais: unit.Go}", "rais", "raise"),
        ("{at: 1 ms, putt: unit.level, value: 3}", "putt", "put"),
        ("{at: 1 ms, put: unit.level, valeu: 3}", "valeu", "value"),
    ],
)
def test_a_misspelt_key_is_one_error_with_the_key_that_was_meant(
    system: System, entry: str, key: str, meant: str
) -> None:
    """The key that is missing because of it is not an error of its own."""
    _, found = read_stimuli(f"- {entry}\n", "e.yaml", system)
    assert found[0].message == f"`{key}` has no place here"
    assert found[0].hint == f"did you mean `{meant}`?"
    assert len(found) == 1


def test_a_misspelt_literal_has_a_hint(system: System) -> None:
    text = "- {at: 1 ms, put: unit.hue, value: Gren}\n- {until: 1 s}\n"
    (found,) = read_stimuli(text, "e.yaml", system)[1]
    assert found.hint == "did you mean `Green`?"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "e.yaml:1:1: an events file is a list of `- {...}` lines [RV-1001]"),
        ("until: 1 s", "e.yaml:1:1: an events file is a list of `- {...}` lines [RV-1001]"),
        ("[]", "e.yaml:1:1: the list does not end with `until` [RV-1006]"),
        (
            "- {at: 1 ms, raise: unit.Go}",
            "e.yaml:1:3: the list does not end with `until` [RV-1006]",
        ),
        (
            "- {at: 2 ms, raise: unit.Go}\n- {until: 1 ms}",
            "e.yaml:2:11: 1 ms is before 2 ms of the entry above [RV-1003]",
        ),
        (
            "- {until: 1 ms}\n- {at: 2 ms, raise: unit.Go}",
            "e.yaml:2:3: nothing comes after `until` [RV-1006]",
        ),
        ("- {until: *x}", "e.yaml:1:11: anchors and aliases are not allowed [RV-0108]"),
        ("[" * 100, "e.yaml:1:65: mappings and lists are nested more than 64 deep [RV-0107]"),
    ],
)
def test_wrong_file_is_told(system: System, text: str, message: str) -> None:
    stimuli, found = read_stimuli(text, "e.yaml", system)
    assert stimuli is None
    assert f"{found[0].origin}: {found[0].message} [{found[0].code}]" == message


@pytest.mark.parametrize(
    ("time", "text"),
    [(0, "0.000"), (20_000_000, "0.020"), (1_000_250_000, "1.000250"), (7, "0.000000007")],
)
def test_times_are_exact(time: int, text: str) -> None:
    assert seconds(Ns(time)) == text


def test_a_step_is_one_line_of_text_or_json() -> None:
    record = StepRecord(
        Ns(20_000_000), "motor", "Motion", ("Idle.exit", "T3.effect", "Moving.entry")
    )
    assert record.text() == "0.020 motor.Motion: Idle.exit, T3.effect, Moving.entry"
    assert json.loads(record.json()) == {
        "at_ns": 20_000_000,
        "instance": "motor",
        "region": "Motion",
        "behaviours": ["Idle.exit", "T3.effect", "Moving.entry"],
    }


# --- The command -----------------------------------------------------------------------

MODEL = """\
system: Commanded
components:
  Part:
    events: [Go]
    regions:
      Main:
        {period: 10 ms, wcet: 1 us, queue: 4, initial: A, states: {A: {}, B: {}},
         transitions: {go: {from: A, to: B, on: Go}}}
nodes:
  board: {context_switch: 1 us, critical_section: 1 us}
instances:
  unit: {component: Part, node: board}
processors:
  runner: {node: board, stack: 8 KiB, activities: [unit.Main]}
"""


def simulated(folder: Path, events: str | bytes, *options: str) -> int:
    """The status of `ravenchart simulate` on the commanded part."""
    (folder / "model.yaml").write_text(MODEL, encoding="utf-8")
    raw = events.encode() if isinstance(events, str) else events
    (folder / "events.yaml").write_bytes(raw)
    model, stimuli = str(folder / "model.yaml"), str(folder / "events.yaml")
    return main(["simulate", model, "--events", stimuli, *options])


EVENTS = "- {at: 5 ms, raise: unit.Go}\n- {until: 20 ms}\n"


def test_command_prints_the_steps(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert simulated(tmp_path, EVENTS, "--interpreter") == 0
    assert capsys.readouterr().out == (
        "0.000 unit.Main: A.entry\n0.010 unit.Main: A.exit, go.effect, B.entry\n"
    )
    assert simulated(tmp_path, EVENTS, "--interpreter", "--json") == 0
    lines = capsys.readouterr().out.splitlines()
    assert [json.loads(line)["at_ns"] for line in lines] == [0, 10_000_000]


@pytest.mark.parametrize("events", [b"\xff", "- {at: 5 ms}", "", "- \tx", "- {until: 1 s"])
def test_command_refuses_a_wrong_file_without_a_traceback(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], events: str | bytes
) -> None:
    assert simulated(tmp_path, events, "--interpreter") == 1
    told = capsys.readouterr()
    assert "events.yaml:1:" in told.err and "RV-" in told.err and not told.out


def test_command_refuses_a_missing_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    simulated(tmp_path, EVENTS, "--interpreter")
    model = str(tmp_path / "model.yaml")
    assert main(["simulate", model, "--events", str(tmp_path), "--interpreter"]) == 1
    assert main(["simulate", model, "--events", str(tmp_path / "no"), "--interpreter"]) == 1
    assert "no such file" in capsys.readouterr().err
