# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""End-to-end protection against an independent implementation, and on a bus with faults."""

from __future__ import annotations

import os
import shutil
import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import get_args

import can
import e2e
import pytest

from ravenchart.analysis.system.observed import Observation
from ravenchart.building import checking, generation, programs
from ravenchart.hw_can.bench.bus_client import RavenchartBus
from ravenchart.hw_can.bench.peer import BenchError, Codec
from ravenchart.hw_can.bench.protection import Wrong
from ravenchart.paths import ROOT
from ravenchart.running.controllers import controller
from ravenchart.running.result import RunOutcome
from ravenchart.running.runs import run_controller
from tests.support.ada_programs import ran
from tests.support.on_bus import runner

pytestmark = pytest.mark.alone

P1_MODES = {
    "BOTH": e2e.p01.E2E_P01_DATAID_BOTH,
    "ALTERNATING": e2e.p01.E2E_P01_DATAID_ALT,
    "NIBBLE": e2e.p01.E2E_P01_DATAID_NIBBLE,
}
P11_MODES = {"BOTH": e2e.p11.E2E_P11_DATAID_BOTH, "NIBBLE": e2e.p11.E2E_P11_DATAID_NIBBLE}
IDS = bytes.fromhex("01d32a976c45b80fe1725dc439a68bf0")
"""As in test_protection.adb."""


def intact(profile: str, mode: str, data_id: int, data: bytes) -> bool:
    """Does the independent implementation accept the frame?"""
    kept, size = bytearray(data), len(data)
    if profile == "PROFILE_1":
        return e2e.p01.e2e_p01_check(kept, data_id, data_id_mode=P1_MODES[mode], length=size)
    if profile == "PROFILE_11":
        return e2e.p11.e2e_p11_check(kept, data_id, data_id_mode=P11_MODES[mode], length=size)
    if profile == "PROFILE_2":
        return e2e.p02.e2e_p02_check(kept, IDS, length=size)
    return e2e.p05.e2e_p05_check(kept, data_id, length=size)


def test_an_independent_implementation_accepts_every_protected_frame() -> None:
    done = ran("test_protection", "print", timeout=60)
    lines = [line.split() for line in done.stdout.splitlines()]
    assert len(lines) == 10 * 300
    for profile, mode, data_id, text in lines:
        data = bytes.fromhex(text)
        assert intact(profile, mode, int(data_id), data), text
        spoilt = data[:-1] + bytes([data[-1] ^ 1])
        assert not intact(profile, mode, int(data_id), spoilt), text


def test_of_many_faults_of_each_kind_none_is_used() -> None:
    times = "100000" if "RAVENCHART_LONG_TESTS" in os.environ else "1000"
    done = ran("test_protection", times)
    assert (done.returncode, "not ok" in done.stdout) == (0, False), done.stdout


@pytest.fixture
def gate(tmp_path: Path) -> Callable[[Callable[[RavenchartBus], None]], Observation]:
    """Runs the feature model on a bus with a bench that does something; what was seen."""
    return runner("protected", tmp_path)


GOOD, WRONG = 5, 900


def _first(level: int, counter: int, data_id: int = 0x123) -> bytes:
    """The data of `first_in`: the level from bit 12 on."""
    data = bytearray((level << 12).to_bytes(4, "little"))
    data[1] = (data[1] & 0xF0) | counter
    e2e.p01.e2e_p01_protect(data, data_id, length=4, increment_counter=False)
    return bytes(data)


@pytest.mark.slow
def test_faults_on_the_bus_are_noticed_and_nothing_wrong_is_used(
    gate: Callable[[Callable[[RavenchartBus], None]], Observation],
) -> None:
    answers: list[can.Message] = []

    def play(bench: RavenchartBus) -> None:
        def give(data: bytes) -> None:
            frame = can.Message(arbitration_id=0x100, is_extended_id=False, data=data)
            bench.send(frame, timeout=5)
            time.sleep(0.03)

        for counter in (0, 1, 2):
            give(_first(GOOD, counter))
        corrupted = bytearray(_first(GOOD, 3))
        corrupted[2] ^= 0x20
        give(bytes(corrupted))
        give(_first(WRONG, 3, data_id=0x777))  # masquerade
        give(_first(GOOD, 4))  # one was lost
        give(_first(WRONG, 4))  # repetition
        give(_first(WRONG, 13))  # insertion
        give(_first(WRONG, 5)[:3])  # too short
        give(bytes(4))  # not protected at all
        give(_first(GOOD, 14))
        while (frame := bench.recv(timeout=0.05)) is not None and len(answers) < 400:
            answers.append(frame)

    seen = gate(play)
    #  of the eleven frames the first is the initial one, and four are used
    assert len(list(seen.of("arrived", "first_in"))) == 4
    assert seen.faults["Protection_Error"] == 6
    assert [r.text for r in seen.of("transition", "gate.Trust")] == ["doubt", "leave"]
    assert [v.state for v in seen.visits("gate.Trust")] == ["Trusted", "Doubted", "Alone"]
    levels = {
        int.from_bytes(answer.data, "little") >> 12 & 0x3FF
        for answer in answers
        if answer.arbitration_id == 0x200
    }
    assert GOOD in levels
    assert WRONG not in levels


@pytest.mark.slow
def test_what_is_sent_is_accepted_by_the_independent_implementation(
    gate: Callable[[Callable[[RavenchartBus], None]], Observation],
) -> None:
    answers: list[can.Message] = []

    def play(bench: RavenchartBus) -> None:
        end = time.monotonic() + 1.0
        while time.monotonic() < end:
            frame = bench.recv(timeout=0.05)
            if frame is not None:
                answers.append(frame)

    gate(play)
    backwards = bytes([240, 139, 166, 57, 196, 93, 114, 225, 15, 184, 69, 108, 151, 42, 211, 1])
    counters: dict[int, list[int]] = {}
    for frame in answers:
        data, size = bytes(frame.data), len(frame.data)
        match frame.arbitration_id:
            case 0x200:
                assert intact("PROFILE_1", "ALTERNATING", 0x123, data)
            case 0x201:
                assert intact("PROFILE_11", "NIBBLE", 0x457, data)
            case 0x202:
                assert e2e.p02.e2e_p02_check(bytearray(data), backwards, length=size)
            case 0x203:
                assert size == 64
                assert intact("PROFILE_5", "", 0x4321, data)
            case 0x204:
                assert intact("PROFILE_5", "", 0x4322, data)
        at = 2 if frame.arbitration_id in (0x203, 0x204) else 1
        counter = data[at] if at == 2 else data[at] & 15
        counters.setdefault(frame.arbitration_id, []).append(counter)
    for identifier, size in ((0x200, 15), (0x201, 15), (0x202, 16), (0x203, 256), (0x204, 256)):
        found = counters[identifier]
        assert len(found) > 20
        assert all(b == (a + 1) % size for a, b in pairwise(found))


def test_the_header_is_in_the_database(tmp_path: Path) -> None:
    copy = tmp_path / "protected"
    shutil.copytree(ROOT / "tests" / "feature" / "protected", copy)
    generation.write_program(checking.check(copy / "model.yaml"))
    codec = Codec.from_file(copy / "generated" / "line.dbc")
    values = {"level", "mode", "ready"}
    assert set(codec.fields("first_in")) == {*values, "E2E_CRC", "E2E_Counter"}
    assert set(codec.fields("second_in")) == {*values, "E2E_CRC", "E2E_Counter", "E2E_Data_ID"}


def test_the_bench_protects_what_it_sends(tmp_path: Path) -> None:
    copy = tmp_path / "protected"
    shutil.copytree(ROOT / "tests" / "feature" / "protected", copy)
    generation.write_program(checking.check(copy / "model.yaml"))
    codec = Codec.from_file(copy / "generated" / "line.dbc")
    values: dict[str, int | str] = {"level": 700, "mode": "Stop", "ready": "True"}
    accepts: dict[str, Callable[[bytes], bool]] = {
        "first_in": lambda data: intact("PROFILE_1", "BOTH", 0x123, data),
        "second_in": lambda data: intact("PROFILE_1", "NIBBLE", 0x456, data),
        "third_in": lambda data: intact("PROFILE_2", "", 0, data),
        "fourth_in": lambda data: intact("PROFILE_5", "", 0x1234, data),
        "fifth_in": lambda data: intact("PROFILE_11", "BOTH", 0x2222, data),
        "first_out": lambda data: intact("PROFILE_1", "ALTERNATING", 0x123, data),
    }
    for name, accepted in accepts.items():
        for counter in range(300):
            frame = codec.encode(name, values)
            assert accepted(bytes(frame.data)), (name, counter)
            found = codec.decode(frame)
            assert found is not None
            assert found[1].items() >= values.items()


FACES = ("first", "second", "third", "fourth", "fifth")

Playing = Callable[[str], RunOutcome]


@pytest.fixture
def playing(tmp_path: Path) -> Playing:
    """A function that runs the feature model with the scenario of that text; all steps pass."""
    copy = tmp_path / "protected"
    shutil.copytree(ROOT / "tests" / "feature" / "protected", copy)
    checked = checking.check(copy / "model.yaml")
    generation.write_program(checked)
    (program,) = (controller(made) for made in programs.programs_of(checked))

    def play(text: str) -> RunOutcome:
        scenario = copy / "scenario.yaml"
        scenario.write_text(text)
        outcome = run_controller(
            program.executable,
            program.trace_json,
            copy / "generated" / "line.dbc",
            scenario,
            None,
            copy / "report",
        )
        assert [(step.text, step.outcome) for step in outcome.steps if not step.passed] == []
        return outcome

    return play


@pytest.mark.slow
def test_a_scenario_exchanges_protected_messages(playing: Playing) -> None:
    given = "{level: 700, mode: Stop, ready: true}"
    steps_of = (
        f"  - {{send: {face}_in, with: {given}}}\n" * 3
        + f"  - {{wait_for: {face}_out.level, is: 700, within: 2 s}}\n"
        for face in FACES
    )
    outcome = playing(f"scenario: Protected\nsteps:\n{''.join(steps_of)}")
    assert outcome.observation is not None
    assert outcome.observation.faults["Protection_Error"] == 0


@pytest.mark.slow
@pytest.mark.parametrize("wrong", get_args(Wrong))
def test_what_the_bench_sends_with_a_fault_is_never_used(
    wrong: Wrong, gate: Callable[[Callable[[RavenchartBus], None]], Observation], tmp_path: Path
) -> None:
    codec = Codec.from_file(tmp_path / "protected" / "generated" / "line.dbc")
    seen: dict[str, set[object]] = {f"{face}_out": set() for face in FACES}

    def play(bench: RavenchartBus) -> None:
        def give(level: int, fault: Wrong | None = None) -> None:
            for face in FACES:
                values: dict[str, int | str] = {"level": level, "mode": "Stop", "ready": "True"}
                frame = codec.faulty(f"{face}_in", values, fault)
                if frame is not None:
                    bench.send(frame, timeout=5)
            end = time.monotonic() + 0.03
            while (rest := end - time.monotonic()) > 0:
                answer = bench.recv(timeout=rest)
                found = None if answer is None else codec.decode(answer)
                if found is not None and found[0] in seen:
                    seen[found[0]].add(found[1]["level"])

        for _ in range(5):
            give(GOOD)
        give(WRONG, wrong)
        for _ in range(8):  # as many as the slowest of the five needs to be in sequence again
            give(GOOD + 1)

    trace = gate(play)
    for name, levels in seen.items():
        assert {GOOD, GOOD + 1} <= levels, name
        assert WRONG not in levels, name
    assert (trace.faults["Protection_Error"] >= len(FACES)) == (wrong != "loss")


@pytest.mark.slow
def test_a_scenario_sends_a_fault_by_its_name(playing: Playing) -> None:
    given = "with: {level: 700, mode: Stop, ready: true}"
    good = f"  - {{send: fifth_in, {given}}}\n"
    bad = f"  - {{send: fifth_in, {given}, wrong: masquerade}}\n"
    heard = "  - {wait_for: fifth_out.level, is: 700, within: 2 s}\n"
    expect = "expect:\n  - {fault: Protection_Error, times: 1, because: one is foreign}\n"
    outcome = playing(f"scenario: A fault\nsteps:\n{good * 3}{heard}{bad}{good}{heard}{expect}")
    assert any(step.text.endswith(", with masquerade") for step in outcome.steps)
    assert outcome.observation is not None
    assert outcome.observation.faults["Protection_Error"] == 1
    assert not any("Protection_Error" in failure for failure in outcome.failures)


def test_a_fault_of_a_message_without_protection_is_refused() -> None:
    codec = Codec.from_file(ROOT / "examples" / "two_nodes" / "generated" / "link.dbc")
    values: dict[str, int | str] = {name: 0 for name in codec.fields("servo_report")}
    with pytest.raises(BenchError, match="`wrong: loss`: it is not protected"):
        codec.check("servo_report", values, "loss")
