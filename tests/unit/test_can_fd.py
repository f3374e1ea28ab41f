"""CAN FD in models: laid out, checked and analysed; not generated yet."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from analysis.timing import analyse
from gen.model import System
from ravenchart.__main__ import OK, WRONG, main
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
    assert found.network.items()[message.element].cost == bits


def test_a_frame_of_up_to_eight_bytes_may_be_fd_too() -> None:
    text = PUMP.replace("from: north.valve", "from: north.valve, format: fd")
    message = next(m for m in system_of_text(text).messages if m.fd)
    assert message.length == 2


def test_an_fd_model_is_checked_and_analysed_and_not_generated(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = tmp_path / "model.yaml"
    model.write_text(FAST, encoding="utf-8")
    assert main(["check", str(model)]) == OK
    assert main(["analyse", str(model), "--html", str(tmp_path / "report.html")]) == OK
    assert "327" in (tmp_path / "report.html").read_text(encoding="utf-8")
    capsys.readouterr()
    for command in ("generate", "build", "run"):
        assert main([command, str(model)]) == WRONG
        told = capsys.readouterr().err
        assert re.search(r"valve_out is a CAN FD frame: CAN FD is analysed, not gen.*RV-0804", told)
    assert not (tmp_path / "generated").exists()


@pytest.mark.parametrize("rate", ["5 kbit/s", "20 Mbit/s", "fast"])
def test_a_data_rate_has_a_range(rate: str) -> None:
    found = loaded(FAST.replace("2 Mbit/s", rate))
    assert [d.code for d in found.diagnostics] == ["RV-0207"]
