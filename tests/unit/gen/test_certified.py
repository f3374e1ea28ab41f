# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What the timing certificate states, and where the code takes it from there."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import pytest

from ravenchart.analysis.findings.claims import claims_of
from ravenchart.analysis.system.timing import analyse
from ravenchart.building import checking
from ravenchart.gen.emit.program import generate
from ravenchart.gen.model.system import System
from ravenchart.paths import ROOT
from tests.support.certificates import certificate, changed, compiled
from tests.support.systems import bus, message, system, task
from tests.support.two_nodes import system_of

FACTS = {
    "control.ads": {
        "Task_Priority => Timing_Certificate.Control_Priority",
        "Period => Timing_Certificate.Control_T",
        "Deadline => Timing_Certificate.Control_D",
        "Divisor => Timing_Certificate.Servo_Tell_Divisor",
        "Phase => Timing_Certificate.Servo_Tell_Phase",
        "Processor.Given_Priority /= Timing_Certificate.Control_Priority",
        "Processor.Given_Offset /= 0",
    },
    "reception_drive.ads": {
        "Minimum_Separation => Timing_Certificate.Reception_Drive_T",
        "Processor.Given_Separation /= Timing_Certificate.Reception_Drive_T",
    },
    "host_probe.ads": {
        "Period => Timing_Certificate.Drive_Probe_T",
        "Probe_Priority => Timing_Certificate.Drive_Probe_Priority",
    },
    "link.ads": {
        "Id in Timing_Certificate.Link_Supervisor_Order_Id",
        "Bit_Rate => Timing_Certificate.Link_Bit_Rate",
        "Driver_Priority => Timing_Certificate.Link_Driver_Priority",
        "Controller.Given_Setting.Bit_Rate = Timing_Certificate.Link_Bit_Rate",
    },
    "link.adb": {
        "Id => Timing_Certificate.Link_Servo_Report_Id",
        "Length => Timing_Certificate.Link_Servo_Report_Length",
    },
    "link-receiver.adb": {
        "Id (Frame) = Timing_Certificate.Link_Supervisor_Order_Id",
        "Timing_Certificate.Link_Supervisor_Order_Length)",
        "Executed := Executed + Elements.Link_Receive_Drive_Row",
    },
    "servo.ads": {
        "with Pre => Executed = 0, Post => Executed = Elements.Servo_Tell_Row",
    },
    "control.adb": {
        "Servo.Run_Tell (Executed)",
        "pragma Assert (Executed = Elements.Control_Processor + 1 + "
        "Ravenchart.Element_Id (Row'Pos (Item)))",
    },
}  # fmt: skip


@cache
def model() -> System:
    return system_of()


@cache
def files() -> dict[str, str]:
    made = generate(model(), claims_of(analyse(model())))
    return {name: " ".join(text.split()) for name, text in made.items()}


@pytest.mark.parametrize("unit", FACTS)
def test_the_code_takes_its_facts_from_the_certificate(unit: str) -> None:
    text = files()[f"drive/two_nodes-{unit}"]
    for fact in FACTS[unit]:
        assert fact in text, fact


def test_the_program_says_which_model_it_is_of() -> None:
    for node in ("drive", "panel"):
        text = files()[f"{node}/two_nodes-timing_certificate.ads"]
        assert f'Model_Digest : constant String := "{model().digest}"' in text
        put = "Ravenchart.Hosts.Put_Model (Two_Nodes.Timing_Certificate.Model_Digest);"
        assert put in files()[f"{node}/two_nodes_main.adb"]


def test_no_number_of_the_analysis_stands_in_the_code() -> None:
    """Priorities of tasks, identifiers and rates: beside the certificate the layout table alone
    has numbers, of identifiers, and the code is proved to agree with both."""
    for name, text in files().items():
        if name.endswith((".ads", ".adb")) and not re.search("timing_certificate|codecs", name):
            assert not re.search(
                r"\b(Task_Priority|Driver_Priority|Probe_Priority|Id|Bit_Rate|Divisor|Period)"
                r" => (System\.|\d)",
                text,
            ), name


# --- The certificate checks its own facts -------------------------------------------------


@cache
def sample() -> str:
    tasks = [task("low", 1, 100_000, 10_000_000), task("high", 2, 100_000, 10_000_000)]
    tasks.append(task("peer", 2, 100_000, 10_000_000))
    messages = (message("a", 1), message("b", 0x20 << 18, extended=True), message("c", 0x21))
    return certificate(analyse(system(tasks, (), [bus()], messages)))


def test_facts_that_hold_compile(tmp_path: Path) -> None:
    assert compiled(sample(), tmp_path) == ""


@pytest.mark.parametrize(
    ("number", "to", "words"),
    [
        (
            "Low_Priority",
            "System.Default_Priority + 2",
            "cpu must keep the order of its priorities",
        ),
        (
            "Peer_Priority",
            "System.Default_Priority + 3",
            "cpu must keep the order of its priorities",
        ),
        ("Bus_A_Id", "16#21#", "bus must keep the order of its identifiers"),
        ("Bus_B_Id", "16#880000#", "bus must keep the order of its identifiers"),
        ("Low_B", "5_000", "low claims a wrong response time"),
        ("High_B", "-1", "high claims a wrong response time"),
        ("Bus_Bit_Rate", "1_000_000", "claims a wrong busy period"),
    ],
)
def test_facts_that_the_sums_contradict_are_refused(
    number: str, to: str, words: str, tmp_path: Path
) -> None:
    text, count = re.subn(
        rf"^(   {number} : constant :=)\s+[^;]*;", rf"\1 {to};", sample(), flags=re.M
    )
    assert count == 1, number
    assert words in compiled(text, tmp_path)


def test_the_longest_call_of_a_device_blocks(tmp_path: Path) -> None:
    """It is longer than the sections of the runtime, and the sum has it."""
    model_file = ROOT / "tests" / "feature" / "devices" / "model.yaml"
    text = certificate(checking.check(model_file).analysis)
    assert "Fast_B : constant := Board_1_Section;" in text
    assert "Slow_B : constant := Board_Critical_Section;" in text
    assert compiled(text, tmp_path, "Devices_Feature") == ""
    shorter = changed(text, "Board_1_Section", -1)
    assert "fast claims a wrong response time" in compiled(shorter, tmp_path, "Devices_Feature")


@pytest.mark.parametrize("by", [-1, 1])
def test_a_claim_is_exact_both_ways(by: int, tmp_path: Path) -> None:
    for number, element in (("Low_R", "low"), ("Bus_A_R", "bus.a"), ("Bus_C_R", "bus.c")):
        problem = f"{element} claims a wrong response time"
        assert problem in compiled(changed(sample(), number, by), tmp_path), number


def test_a_certificate_grows_with_its_messages_and_not_with_their_square() -> None:
    def lines(count: int) -> int:
        messages = [message(f"m{n}", n, period=count * 2_000_000) for n in range(count)]
        one = system([task("t", 1, 100_000, 10_000_000)], (), [bus()], messages)
        return certificate(analyse(one)).count("\n")

    few, more, most = (lines(count) for count in (10, 20, 40))
    assert most - more <= 2.1 * (more - few)
