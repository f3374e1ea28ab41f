"""What of `make hw-test` runs without a guest: its list of steps, its verdict, its cases."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import can
import pytest

from ravenchart.hw_can.conformance.ends import Ends, Setup, open_ends
from ravenchart.hw_can.conformance.suite import CaseVerdict, SuiteResult, run
from ravenchart.tools import toolchain
from tests.hardware import __main__ as hw_test
from tests.hardware.__main__ import Step, Total, load_order, missing, script, steps, total
from tests.hardware.driver_cases import Driver, cases
from tests.hardware.fact import facts, junit
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
    for step, line in zip(chosen, lines, strict=True):
        assert line.endswith(f"--junit {step.name}.xml > {step.name}.txt 2>&1")
    assert "'/a b/tests-checks-socketcan/bin/can_echo' vcan0" in lines[1]
    assert "tests.hardware.remote '/a b/crossing' vcan0" in lines[2]
    assert "'/a b/tests-checks-socketcan/bin/can_echo' can0 --near can1 --emulated" in lines[3]
    assert "'/a b/tests-checks-ctucanfd/bin/can_echo' /sys/bus/pci/devices" in lines[4]
    for line in lines[5:]:
        assert "env RAVENCHART_CTUCANFD=/sys/bus/pci/devices/0000:00:11.0/resource1 " in line


def _suite(*outcomes: str) -> str:
    inside = "".join(f"<testcase>{outcome}</testcase>" for outcome in outcomes)
    return f"<testsuites><testsuite>{inside}</testsuite></testsuites>"


PASSED, FAILED, SKIPPED = "<system-out>exact</system-out>", "<failure/>", "<skipped/>"


@pytest.mark.parametrize(
    ("first", "second", "expected", "good"),
    [
        (_suite(PASSED, PASSED), _suite(SKIPPED), Total(2, 0, 1, ()), True),
        (_suite(PASSED), _suite(FAILED, PASSED), Total(2, 1, 0, ()), False),
        (_suite(SKIPPED), _suite(SKIPPED), Total(0, 0, 2, ()), False),
        (_suite(PASSED), None, Total(1, 0, 0, ("b",)), False),
        (_suite(PASSED), _suite("<error/>"), Total(1, 1, 0, ()), False),
        (_suite(PASSED), "<testsuites>", Total(1, 0, 0, ("b",)), False),
    ],
)
def test_what_the_guest_has_written_is_counted(
    first: str, second: str | None, expected: Total, good: bool, tmp_path: Path
) -> None:
    (tmp_path / "a.xml").write_text(first)
    if second is not None:
        (tmp_path / "b.xml").write_text(second)
    found = total((Step("a", ()), Step("b", ())), tmp_path)
    assert (found, found.good) == (expected, good)


@pytest.mark.parametrize(
    ("output", "status", "expected"),
    [
        ("ok one\nok two\n", 0, [("one", True), ("two", True)]),
        ("ok one\nnot ok two\n", 1, [("one", True), ("two", False)]),
        ("ok one\n", 1, [("one", True), ("it ends well, not with status 1", False)]),
        ("raised CONSTRAINT_ERROR\n", 1, [("it says a fact", False)]),
        ("", 0, [("it says a fact", False)]),
    ],
)
def test_the_facts_of_a_program_become_cases(
    output: str, status: int, expected: list[tuple[str, bool]], tmp_path: Path
) -> None:
    found = facts(output, status)
    assert [(fact.text, fact.holds) for fact in found] == expected
    (tmp_path / "a.xml").write_text(junit("program", found))
    held = sum(holds for _, holds in expected)
    assert total((Step("a", ()),), tmp_path) == Total(held, len(expected) - held, 0, ())


def test_what_is_missing_is_said_and_nothing_is_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("shutil.which", lambda name: None)
    monkeypatch.setattr(hw_test, "KERNEL", tmp_path)
    monkeypatch.setattr(hw_test, "HOME", tmp_path / "hw-test")
    assert toolchain.have("ip") is False
    assert len(tuple(missing(tmp_path, "aarch64"))) == 5
    assert hw_test.main() == 2
    said = capsys.readouterr().err
    assert "hw-test: skipped: qemu-system-x86_64 is not on PATH" in said
    assert f"there is no kernel in {tmp_path}" in said
    assert "hw-test: skipped: s390x, big-endian: qemu-s390x-static is not on PATH" in said
    assert "hw-test: skipped: Arm, 32 bits: arm-linux-gnueabihf-gnatmake is not" in said
    assert said.endswith("hw-test: nothing was run\n")


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
