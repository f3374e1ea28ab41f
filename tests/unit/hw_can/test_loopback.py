# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The loopback test, over interfaces that work, that cannot do everything, and that fail."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from xml.etree import ElementTree

import can
import pytest

from ravenchart import terminal
from ravenchart.command_line import main
from ravenchart.commands import loopback_files
from ravenchart.commands.loopback import verdict_line
from ravenchart.hw_can.bench.bus_records import NO_DATA, BusRecord, Flag, RecordKind
from ravenchart.hw_can.bench.peer import BenchError
from ravenchart.hw_can.conformance.cases import CASES
from ravenchart.hw_can.conformance.ends import Ends, Setup, open_ends
from ravenchart.hw_can.conformance.suite import (
    CaseResult,
    CaseVerdict,
    SuiteResult,
    histogram,
    run,
)
from tests.support.bus_server import BusServer
from tests.support.slcan_relay import SlcanRelay

pytestmark = pytest.mark.clock


def on(server: BusServer) -> Ends:
    """Both ends on the stand-in, with little patience."""
    setup = Setup("ravenchart", server.channel, "ravenchart", server.channel, fd=True)
    return open_ends(setup, patience=0.3)


def verdicts(result: SuiteResult) -> dict[str, CaseVerdict]:
    return {case.name: case.verdict for case in result.cases}


def named(verdict: CaseVerdict, result: SuiteResult) -> set[str]:
    return {case.name for case in result.cases if case.verdict is verdict}


def test_virtual_passes_and_says_what_it_cannot(capsys: pytest.CaptureFixture[str]) -> None:
    status = main(["loopback", "--interface", "virtual", "--channel", "loopback"])
    printed = " ".join(capsys.readouterr().out.split())
    assert status == 0, printed
    assert "PASS: 16 passed, 0 failed, 4 skipped" in printed
    assert "skipped 0.000 the bus was opened without --fd" in printed
    assert "python-can's virtual tells no state" in printed


def test_the_case_that_runs_is_told_while_it_runs(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(terminal, "SILENCE", 0.01)
    monkeypatch.setattr(terminal, "SHORTEST", 0.01)
    terminal.LINES.set()
    try:
        main(["loopback", "--interface", "virtual", "--channel", "told"])
    finally:
        terminal.LINES.clear()
    lines = capsys.readouterr().err.splitlines()
    told = {line.removeprefix("loopback: ").rpartition(" (")[0] for line in lines}
    assert len(told & {case.name for case in CASES}) > 1


def test_one_object_with_echo_is_both_ends(capsys: pytest.CaptureFixture[str]) -> None:
    status = main(["loopback", "--interface", "virtual", "--channel", "echo", "--fd", "--echo"])
    printed = " ".join(capsys.readouterr().out.split())
    assert status == 0, printed
    assert "one bus object has no other way" in printed


@pytest.fixture
def relay() -> Iterator[SlcanRelay]:
    one = SlcanRelay()
    yield one
    one.close()


@pytest.mark.slow
def test_slcan_passes_and_says_what_it_cannot(relay: SlcanRelay) -> None:
    ends = open_ends(Setup("slcan", relay.channel, "slcan", relay.channel, fd=True))
    relay.wait_for(clients=2)
    try:
        result = run(ends)
    finally:
        ends.close()
    assert result.passed, result.cases
    assert named(CaseVerdict.SKIPPED, result) == {
        "FD frames, error state indicated", "error frame", "echo", "error state",
    }  # fmt: skip


@pytest.mark.slow
def test_slcan_that_is_cut_fails_in_words(relay: SlcanRelay) -> None:
    ends = open_ends(Setup("slcan", relay.channel, "slcan", relay.channel), patience=0.3)
    relay.wait_for(clients=2)
    try:
        result = run(ends, lambda name: relay.cut() if name == "burst" else None)
    finally:
        ends.close()
    found = verdicts(result)
    assert found["every byte value"] is CaseVerdict.PASSED
    assert found["burst"] is CaseVerdict.FAILED
    assert found["throughput"] is CaseVerdict.SKIPPED
    assert not result.passed


def test_a_cable_cut_in_the_middle_fails_and_skips_the_rest(server: BusServer) -> None:
    ends = on(server)
    result = run(ends, lambda name: server.cut() if name == "burst" else None)
    ends.close()
    burst = next(case for case in result.cases if case.name == "burst")
    assert burst.verdict is CaseVerdict.FAILED
    assert burst.detail == "the bus server closed the connection"
    after = result.cases[result.cases.index(burst) + 1 :]
    assert {case.verdict for case in after} == {CaseVerdict.SKIPPED}
    assert {case.detail for case in after} == {"the bus was lost before"}
    assert not result.passed


def lost(record: BusRecord) -> BusRecord | None:
    return None if record.identifier % 16 == 3 else record


def changed(record: BusRecord) -> BusRecord:
    plain = record.kind is RecordKind.FRAME and not Flag.REMOTE & record.flags and record.length > 1
    return replace(record, data=b"\xee" + record.data[1:]) if plain else record


def without_brs(record: BusRecord) -> BusRecord:
    return replace(record, flags=record.flags & ~Flag.BRS)


def remote_as_data(record: BusRecord) -> BusRecord:
    return replace(record, flags=record.flags & ~Flag.REMOTE, data=NO_DATA)


@pytest.mark.parametrize(
    ("harm", "failing"),
    [
        (lost, {"standard data frames", "burst", "order", "timestamps"}),
        (changed, {"standard data frames", "every byte value", "burst", "the other way"}),
        (without_brs, {"FD frames, bit rate switched"}),
        (remote_as_data, {"standard remote frames", "extended remote frames"}),
    ],
)
def test_a_bus_that_harms_frames_fails(
    server: BusServer, harm: Callable[[BusRecord], BusRecord | None], failing: set[str]
) -> None:
    server.harm = harm
    ends = on(server)
    result = run(ends, cases=[case for case in CASES if case.name in failing | {"error state"}])
    ends.close()
    assert named(CaseVerdict.PASSED, result) == {"error state"}
    assert named(CaseVerdict.FAILED, result) == failing


def test_one_late_frame_in_two_hundred_fails(server: BusServer) -> None:
    def hold_up(record: BusRecord) -> BusRecord:
        if record.data[0] == 77:
            time.sleep(0.3)
        return record

    server.harm = hold_up
    ends = on(server)
    ends.patience = 2.0
    result = run(ends, cases=[case for case in CASES if case.name == "latency"])
    ends.close()
    assert result.cases[0].verdict is CaseVerdict.FAILED
    assert result.cases[0].detail.startswith("1 of 200 frames took longer than 200 ms, the longest")
    assert result.cases[0].detail.endswith("the first of them frame 78")


def test_a_node_that_nobody_acknowledges_is_told_at_once(server: BusServer) -> None:
    server.harm = lambda record: None
    server.confirms = False
    setup = Setup("ravenchart", server.channel, "ravenchart", server.channel, echo=True)
    ends = open_ends(setup, patience=0.3)
    server.inject(BusRecord(RecordKind.STATE, code=1, transmit_errors=128))
    began = time.monotonic()
    result = run(ends)
    ends.close()
    assert time.monotonic() - began < 5
    first, *others = result.cases
    assert first.verdict is CaseVerdict.FAILED
    assert first.detail == (
        "0 of 9 frames arrived; no other node acknowledges a frame: connect one, or check the cable"
    )
    assert {case.detail for case in others} == {"the bus was lost before"}


def test_frames_that_change_places_fail(server: BusServer) -> None:
    def swap(record: BusRecord) -> BusRecord:
        """The 1st and the 65th of the burst have one identifier; each comes as the other."""
        other = {0: 64, 64: 0}.get(record.data[0]) if record.length else None
        return record if other is None else replace(record, data=bytes([other]).ljust(64, b"\0"))

    server.harm = swap
    ends = on(server)
    result = run(ends, cases=[case for case in CASES if case.name == "order"])
    ends.close()
    assert result.cases[0].detail == "frames of 100 changed places: [64, 0, 128, 192]"


def test_error_frames_and_states_are_seen(server: BusServer) -> None:
    server_error = BusRecord(RecordKind.ERROR_FRAME, Flag.EXTENDED, 8, identifier=8)
    passive = BusRecord(RecordKind.STATE, code=1, transmit_errors=128)
    ends = on(server)

    def disturb(name: str) -> None:
        if name == "error state":
            server.inject(server_error)
            server.inject(passive)

    result = run(
        ends, disturb, [c for c in CASES if c.name in ("error state", "error frames seen")]
    )
    ends.close()
    assert [case.verdict for case in result.cases] == [CaseVerdict.FAILED, CaseVerdict.FAILED]
    assert result.cases[0].detail == "state PASSIVE, PASSIVE on a sound bus"
    assert result.cases[1].detail.startswith("2 error frames came, the first 00000008 E [8]")


def test_nothing_passed_is_not_a_pass() -> None:
    setup = Setup("virtual", "x", "virtual", "x")
    case = CaseResult("burst", CaseVerdict.SKIPPED, "not today", 0.0)
    result = SuiteResult(setup, (case,), (), None)
    assert not result.passed
    assert verdict_line(result) == "FAIL: 0 passed, 0 failed, 1 skipped"
    assert '<skipped message="not today"' in loopback_files.junit(result)


def test_a_failure_is_told_in_each_form() -> None:
    setup = Setup("virtual", 'a<b>&"c', "virtual", "x")
    cases = (CaseResult("burst", CaseVerdict.FAILED, "sent <1> & lost", 0.5),)
    result = SuiteResult(setup, cases, (1_500, 1_700, 9_000), 10.0)
    suite = ElementTree.fromstring(loopback_files.junit(result).encode())
    failure = suite.find(".//failure")
    assert failure is not None and failure.get("message") == "sent <1> & lost"
    page = loopback_files.html(result)
    assert "sent &lt;1&gt; &amp; lost" in page and "a<b>" not in page
    assert histogram(result.latencies) == ((2, 2), (4, 0), (8, 0), (16, 1))


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--interface", "nowhere", "--channel", "x"], "python-can has no interface 'nowhere'"),
        (["--interface", "ravenchart", "--channel", "x"], "'x' is no HOST:PORT"),
        (["--interface", "ravenchart", "--channel", "127.0.0.1:1"], "no bus server at 127.0.0.1:1"),
        (["--interface", "slcan", "--channel", "/dev/nothing"], "cannot be opened"),
        (["--interface", "pcan", "--channel", "x"], "cannot be opened"),
        (
            ["--interface", "virtual", "--channel", "x", "--echo", "--receive-channel", "y"],
            "--echo cannot be combined with",
        ),
        (
            ["--interface", "virtual", "--channel", "x", "--receive-interface", "nowhere"],
            "python-can has no interface 'nowhere'",
        ),
    ],
)
def test_a_bus_that_is_not_there_is_said_in_a_line(
    arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["loopback", *arguments]) == 2
    said = capsys.readouterr().err
    assert said.startswith("ravenchart: error: ") and words in said
    assert "Traceback" not in said and len(said.splitlines()) == 1


def test_no_permission_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object, **__: object) -> can.BusABC:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(can, "Bus", refuse)
    with pytest.raises(BenchError, match="no permission for virtual 'x'"):
        open_ends(Setup("virtual", "x", "virtual", "x"))


@pytest.mark.parametrize("rate", ["0", "-1", "fast", "2000000", "²"])
def test_a_bit_rate_out_of_range_is_refused(rate: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["loopback", "--interface", "virtual", "--channel", "x", "--bitrate", rate])
    assert ended.value.code == 2
    assert "is not 1 .. 1000000 bit/s" in capsys.readouterr().err
