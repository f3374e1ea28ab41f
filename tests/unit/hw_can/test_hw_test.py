# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What of `make hw-test` runs without a guest: its list of steps, its results, its cases."""

from __future__ import annotations

import json
import threading
import tomllib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path

import can
import pytest

from ravenchart.commands.loopback import answered
from ravenchart.hw_can.conformance.ends import Ends, Setup, open_ends
from ravenchart.hw_can.conformance.suite import CaseResult, CaseVerdict, SuiteResult, run
from ravenchart.paths import ROOT
from ravenchart.tools import toolchain
from tests.hardware.driver_cases import Driver, cases
from tests.hardware.guest import Guest, Step, facts, load_order, missing, script, steps
from tests.support.echo import Echo, Standing

DEPENDENCIES = """\
kernel/drivers/net/can/sja1000/kvaser_pci.ko: kernel/sja1000.ko kernel/can-dev.ko
kernel/sja1000.ko: kernel/can-dev.ko
kernel/can-dev.ko:
kernel/net/can/can-raw.ko.xz: kernel/net/can/can.ko
kernel/net/can/can.ko:
"""


def test_a_module_is_loaded_behind_what_it_needs() -> None:
    assert load_order(DEPENDENCIES, ("can_raw", "built_in", "kvaser_pci", "sja1000")) == (
        "kernel/net/can/can.ko",
        "kernel/net/can/can-raw.ko.xz",
        "kernel/can-dev.ko",
        "kernel/sja1000.ko",
        "kernel/drivers/net/can/sja1000/kvaser_pci.ko",
    )


def test_each_step_leaves_a_result_of_its_own() -> None:
    chosen = steps("python", Path("/a b"), Path("/a b/crossing"))
    lines = script(chosen).splitlines()
    assert [step.name for step in chosen] == [
        "loopback-vcan0",
        "driver-vcan0",
        "remote-vcan0",
        "driver-can0",
        "driver-ctucanfd",
        "registers-ctucanfd",
        "frames-ctucanfd",
    ]
    for step, line, status in zip(chosen, lines[::2], lines[1::2], strict=True):
        assert line.endswith(f" > {step.name}.out 2> {step.name}.err")
        assert status == f"echo $? > {step.name}.status"
    calls = lines[::2]
    assert "'/a b/tests-checks-socketcan/bin/can_echo' vcan0" in calls[1]
    assert "tests.hardware.remote '/a b/crossing' vcan0" in calls[2]
    assert "'/a b/tests-checks-socketcan/bin/can_echo' can0 --near can1 --emulated" in calls[3]
    assert "'/a b/tests-checks-ctucanfd/bin/can_echo' /sys/bus/pci/devices" in calls[4]
    for line in calls[5:]:
        assert "env RAVENCHART_CTUCANFD=/sys/bus/pci/devices/0000:00:11.0/resource1 " in line


@pytest.mark.parametrize(
    ("output", "status", "expected"),
    [
        ("ok one\nok two\n", 0, [("one", "passed"), ("two", "passed")]),
        ("ok one\nnot ok two\n", 1, [("one", "passed"), ("two", "failed")]),
        ("ok one\n", 1, [("one", "passed"), ("it ends with status 0", "failed")]),
        ("raised CONSTRAINT_ERROR\n", 1, [("it says a fact", "failed")]),
        ("", 0, [("it says a fact", "failed")]),
    ],
)
def test_the_facts_of_a_program_become_cases(
    output: str, status: int, expected: list[tuple[str, str]]
) -> None:
    assert [(case.name, case.verdict) for case in facts(output, status)] == expected


def left(home: Path, **files: str) -> Guest:
    """A guest that has left files of step `one`."""
    (home / "results").mkdir()
    for end, text in files.items():
        (home / "results" / f"one.{end}").write_text(text)
    return Guest(home, "the guest: given up")


def test_a_step_without_a_result_has_no_cases(tmp_path: Path) -> None:
    (tmp_path / "console.txt").write_text("Kernel panic\n")
    guest = left(tmp_path)
    assert guest.cases(Step("one", ())) == ()
    assert guest.said(Step("one", ())) == "the guest: given up\nKernel panic"


@pytest.mark.parametrize("said", ["error: there is no vcan0", '{"result": null}'])
def test_a_suite_that_could_not_begin_has_no_cases(said: str, tmp_path: Path) -> None:
    guest = left(tmp_path, out=said, status="2\n")
    assert guest.cases(Step("one", (), in_json=True)) == ()
    assert guest.said(Step("one", ())) == said


def test_the_cases_of_a_suite_are_read_with_their_reasons(tmp_path: Path) -> None:
    setup = Setup("virtual", "a", "virtual", "a")
    found = [
        CaseResult("order", CaseVerdict.PASSED, "exact", 0.1),
        CaseResult("burst", CaseVerdict.FAILED, "lost", 0.1),
        CaseResult("FD frames", CaseVerdict.SKIPPED, "classic", 0.1),
    ]
    result = answered(SuiteResult(setup, tuple(found), (), None))
    guest = left(tmp_path, out=json.dumps({"result": asdict(result)}), status="1\n")
    seen = [
        (one.name, one.verdict, one.detail) for one in guest.cases(Step("one", (), in_json=True))
    ]
    assert seen == [
        ("order", "passed", "exact"),
        ("burst", "failed", "lost"),
        ("FD frames", "skipped", "classic"),
    ]


def test_what_is_missing_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shutil.which", lambda name: None)
    assert toolchain.have("ip") is False
    reasons = tuple(missing(tmp_path, "aarch64"))
    assert len(reasons) == 5
    assert "qemu-system-x86_64 is not on PATH (Debian package qemu-system-x86)" in reasons
    assert reasons[-1].startswith(f"there is no kernel in {tmp_path}")


def test_each_folder_of_tests_has_a_command() -> None:
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    collected = set(settings["tool"]["pytest"]["ini_options"]["testpaths"])
    folders = {"/".join(p.relative_to(ROOT).parts[:2]) for p in ROOT.glob("tests/**/test_*.py")}
    others = {"tests/hardware", "tests/sources"}
    assert folders - collected == others
    assert collected <= folders
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    assert all(f" {folder}" in makefile for folder in others)


def test_the_program_is_read_by_its_lines(tmp_path: Path) -> None:
    program = tmp_path / "program"
    program.write_text(
        "#!/bin/sh\necho can: socketcan on $RAVENCHART_CAN_INTERFACE\n"
        "echo ERROR_PASSIVE sent= 1 received= 2 lost_out= 3 lost_in= 4 "
        "rejected= 5 tec= 128 rec= 7\nsleep 9\n"
    )
    program.chmod(0o755)
    echo = Echo(program, {"RAVENCHART_CAN_INTERFACE": "can7"})
    try:
        driver = Driver(program, "can7", echo)
        driver.announced(1)
        driver.reports("ERROR_PASSIVE", 128, 7)
        assert echo.now == Standing("ERROR_PASSIVE", 1, 2, 3, 4, 5, 128, 7)
    finally:
        echo.close()


Answer = Callable[[can.Message], can.Message]


def _right(answer: can.Message) -> can.Message:
    return answer


def _other_data(answer: can.Message) -> can.Message:
    answer.data = answer.data[::-1]
    return answer


def _no_remote(answer: can.Message) -> can.Message:
    answer.is_remote_frame = False
    return answer


@contextmanager
def _answering(answer: Answer, channel: str) -> Iterator[Ends]:
    """A bus in this process on which frames are answered as the program should, or wrongly."""
    ends = open_ends(Setup("virtual", channel, "virtual", channel), patience=0.3)
    ends.near, other = ends.far, ends.near
    ended = threading.Event()

    def serve() -> None:
        while not ended.is_set():
            one = other.recv(0.01)
            if one is not None:
                one.arbitration_id += 1
                other.send(answer(one))

    thread = threading.Thread(target=serve, daemon=True)
    thread.start()
    try:
        yield Ends(ends.setup, ends.near, ends.near, patience=0.3)
    finally:
        ended.set()
        thread.join()
        other.shutdown()
        ends.near.shutdown()


FRAMES = {
    "standard data frames",
    "extended data frames",
    "standard remote frames",
    "extended remote frames",
    "identifiers at their limits",
    "every byte value",
}


@pytest.mark.parametrize(
    ("answer", "failing"),
    [
        (_right, set()),
        (_other_data, {"standard data frames", "extended data frames", "every byte value"}),
        (_no_remote, {"standard remote frames", "extended remote frames"}),
    ],
)
def test_a_program_that_answers_wrongly_fails(
    answer: Answer, failing: set[str], tmp_path: Path
) -> None:
    program = tmp_path / "program"
    program.write_text("#!/bin/sh\nsleep 60\n")
    program.chmod(0o755)
    echo = Echo(program, {})
    driver = Driver(program, "virtual", echo)
    try:
        with _answering(answer, f"driver-{answer.__name__}") as ends:
            result = run(ends, cases=[c for c in cases(driver) if c.name in FRAMES])
    finally:
        echo.close()
    assert _named(CaseVerdict.FAILED, result) == failing
    assert _named(CaseVerdict.PASSED, result) == FRAMES - failing


def _named(verdict: CaseVerdict, result: SuiteResult) -> set[str]:
    return {case.name for case in result.cases if case.verdict is verdict}
