# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""CAN FD in models: laid out, checked, analysed and generated."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.analysis.present.report import render_report
from ravenchart.analysis.system.timing import analyse
from ravenchart.building import checking, generation
from ravenchart.gen.draw.structure import structure_dot
from ravenchart.gen.emit.program import generate
from ravenchart.gen.model.system import System
from tests.support.pump import PUMP, loaded

FIELDS = [f"part_{letter}" for letter in "abcdefghijklmnopqrst"]
"""Twenty fields of 16 bits: 40 bytes, so a frame of 48."""

TYPES = ", ".join(f"{name}: Word" for name in FIELDS)
VALUES = ", ".join(f"{name}: 0" for name in FIELDS)
WIDE = (
    PUMP.replace(
        "Report: {fields: {mode: Mode, level: Level}}",
        f"Word: {{range: [0, 65535]}}\n  Report: {{fields: {{{TYPES}}}}}",
    )
    .replace("with: {mode: wanted, level: level}", f"with: {{{VALUES}}}")
    .replace("from: north.valve", "from: north.valve, format: fd")
)
FAST = WIDE.replace("bit_rate: 500 kbit/s,", "bit_rate: 500 kbit/s, data_rate: 2 Mbit/s,")


def system_of_text(text: str) -> System:
    found = loaded(text)
    assert found.system is not None, found.diagnostics
    return found.system


@pytest.mark.parametrize(
    ("text", "bits"),
    [
        # 17 + 4 stuff bits + 13 at 2 us, and 5 + 384 + 97 + 32 at 0.5 us
        (FAST, 34 * 2_000 + 518 * 500),
        (WIDE, 552 * 2_000),
    ],
)
def test_a_frame_takes_what_its_bits_take_at_their_rates(text: str, bits: int) -> None:
    system = system_of_text(text)
    message = next(m for m in system.messages if m.fd)
    assert (message.length, message.signals[-1].start) == (48, 19 * 16)
    found = analyse(system)
    frames = {frame.name: frame for some in found.network.frames.values() for frame in some}
    assert frames[message.element].transmission_time == bits


def test_a_frame_of_up_to_eight_bytes_may_be_fd_too() -> None:
    text = PUMP.replace("from: north.valve", "from: north.valve, format: fd")
    message = next(m for m in system_of_text(text).messages if m.fd)
    assert message.length == 2


def files_of(text: str, tmp_path: Path) -> dict[str, str]:
    model = tmp_path / "model.yaml"
    model.write_text(text, encoding="utf-8")
    checked = checking.check(model)
    return generate(checked.system, generation.claims(checked))


@pytest.mark.parametrize(("text", "rate"), [(FAST, "Switched"), (WIDE, "Constant")])
def test_a_frame_is_sent_at_the_data_rate_where_there_is_one(
    text: str, rate: str, tmp_path: Path
) -> None:
    body = files_of(text, tmp_path)["pump_house-can_bus.adb"]
    assert f"Rate => Ravenchart.Can.Fd_Frames.{rate}_Rate" in body
    assert "Words => Codecs.Type_Report.Pack (Item)" in body


def test_the_report_and_the_picture_say_what_is_can_fd_and_how_fast() -> None:
    system = system_of_text(FAST)
    page = render_report(analyse(system))
    assert "500 kbit/s, 2000 kbit/s for the data of CAN FD frames" in page
    assert '<td class="n">48 FD</td>' in page and '<td class="n">2 FD</td>' not in page
    drawn = structure_dot(system)
    assert "500 kbit/s, data 2 Mbit/s" in drawn and "20 ms, FD" in drawn


FOREIGN = PUMP.replace(
    "  level_in:", "  far: {bus: can_bus, id: 9, bytes: 48, format: fd, period: 1 s}\n  level_in:"
)


@pytest.mark.parametrize(
    ("text", "setting"),
    [
        (PUMP, "Data_Rate => 0, Takes_Fd => False"),
        (FAST, "Data_Rate => Timing_Certificate.Can_Bus_Data_Rate, Takes_Fd => True"),
        (WIDE, "Data_Rate => 0, Takes_Fd => True"),
        #  a classic controller would destroy the frames that others exchange
        (FOREIGN, "Data_Rate => 0, Takes_Fd => True"),
    ],
)
def test_the_controller_takes_fd_where_such_frames_are_on_its_bus(
    text: str, setting: str, tmp_path: Path
) -> None:
    spec = files_of(text, tmp_path)["pump_house-can_bus.ads"]
    rate = "Bit_Rate => Timing_Certificate.Can_Bus_Bit_Rate"
    automatic = f"({rate}, {setting}, Recovery => Ravenchart.Can.Automatic)"
    assert f"Setting => {automatic}" in " ".join(spec.split())


@pytest.mark.parametrize("rate", ["5 kbit/s", "20 Mbit/s", "fast"])
def test_a_data_rate_has_a_range(rate: str) -> None:
    found = loaded(FAST.replace("2 Mbit/s", rate))
    assert [d.code for d in found.diagnostics] == ["RV-0207"]
