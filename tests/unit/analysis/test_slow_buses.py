# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A bus that is too slow is one error, which names the bit rate that is enough."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from ravenchart.analysis.findings.deadlines import findings
from ravenchart.analysis.system.timing import analyse
from ravenchart.editing.evaluation import over
from ravenchart.gen.diagnostics import Diagnostic
from ravenchart.gen.pipeline import load
from ravenchart.paths import ROOT

ROBOT = ROOT / "examples" / "cartesian_robot" / "model.yaml"
TEXT = ROBOT.read_text(encoding="utf-8")
RATE = "500 kbit/s"


def late(text: str, model: Path = ROBOT) -> tuple[Diagnostic, ...]:
    """The errors of time of a model with that main file."""
    system = load(model, over({str(model): text.encode()})).system
    assert system is not None
    return tuple(one for one in findings(analyse(system)) if one.is_error)


@pytest.mark.parametrize(("rate", "count"), [("125", 6), ("200", 5), ("250", 6)])
def test_the_bit_rate_of_the_hint_is_the_lowest_standard_one_that_is_enough(
    rate: str, count: int
) -> None:
    (one,) = late(TEXT.replace(RATE, f"{rate} kbit/s"))
    assert one.code == "RV-0910"
    assert one.message == f"robot_bus is too slow: at {rate} kbit/s {count} limits are exceeded"
    assert TEXT.splitlines()[one.origin.line - 1].strip().startswith("robot_bus:")
    assert one.notes[-1][1] == f"`ravenchart analyse` shows the other {count - 3}"
    assert one.hint is not None
    hinted = re.match(r"`bit_rate: (.*)` is the lowest", one.hint)
    assert hinted is not None and hinted[1] == RATE
    assert late(TEXT.replace(RATE, hinted[1])) == ()
    assert len(late(TEXT.replace(RATE, "250 kbit/s"))) == 1  # the standard rate below it


def test_an_error_that_no_bit_rate_removes_is_reported_beside_the_bus() -> None:
    shorter = "to: joint_z.feedback, period: 5 ms, "
    text = TEXT.replace(RATE, "125 kbit/s").replace(shorter, f"{shorter}deadline: 50 us, ")
    bus, other = late(text)
    assert bus.message == "robot_bus is too slow: at 125 kbit/s 5 limits are exceeded"
    assert other.message.startswith("message z_feedback misses its deadline: ")


def test_two_errors_are_both_reported() -> None:
    text = TEXT
    for port in ("joint_y.feedback", "joint_z.feedback"):
        at = f"to: {port}, period: 5 ms, "
        assert text.count(at) == 1
        text = text.replace(at, f"{at}deadline: 800 us, ")
    assert [one.code for one in late(text)] == ["RV-0901", "RV-0901"]


def test_an_overloaded_bus_has_its_own_error_with_the_rate() -> None:
    (one,) = late(TEXT.replace(RATE, "50 kbit/s"))
    assert one.code == "RV-0903"
    assert one.hint is not None and "`bit_rate: 500 kbit/s` is the lowest" in one.hint


DEVICE = ROOT / "examples" / "canopen_device" / "model.yaml"


@pytest.mark.parametrize(("rate", "count"), [("10", 18), ("20", 18), ("50", 16)])
def test_errors_beside_an_overload_that_its_rate_removes_are_left_out(
    rate: str, count: int
) -> None:
    text = DEVICE.read_text(encoding="utf-8")
    (one,) = late(text.replace(RATE, f"{rate} kbit/s"), DEVICE)
    assert one.code == "RV-0903"
    assert one.hint is not None and "`bit_rate: 500 kbit/s` is the lowest" in one.hint
    assert one.notes[-1][1] == (
        f"{count} errors that depend on this are left out: check again when this is corrected"
    )
    assert late(text, DEVICE) == ()


def test_errors_beside_an_overload_are_reported_where_no_rate_removes_all() -> None:
    text, nmt = DEVICE.read_text(encoding="utf-8"), "to: device.nmt_in, period: 10 ms,"
    assert text.count(nmt) == 1
    text = text.replace(nmt, f"{nmt} deadline: 50 us,")
    found = late(text.replace(RATE, "20 kbit/s"), DEVICE)
    assert [one.code for one in found] == ["RV-0901", "RV-0901", "RV-0903"]
    first = next(one for one in found if one.message.startswith("message nmt "))
    assert first.hint == "let its sender finish earlier, or set `deadline:`"  # id: 0x000
