# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Raw bits of IEEE 754 and floating-point numbers of Ada: the same as `struct` has them."""

from __future__ import annotations

import math
import os
import random
import re
import struct
import subprocess
from pathlib import Path

import pytest

from ravenchart.command_line import main
from ravenchart.databases.database import Periods, imported
from ravenchart.paths import ROOT
from ravenchart.tools import toolchain
from tests.support.ada_programs import built

COUNT = 4_000
"""Random raw bits of each width, and as many numbers."""

FORMS = {32: (">f", 23, 8), 64: (">d", 52, 11)}
"""By width: the form of `struct`, bits of the fraction, bits of the exponent."""


def patterns(width: int) -> list[int]:
    """Raw bits: the ends of each class of numbers with both signs, and many at random."""
    form, low, high = FORMS[width]
    exponents = (0, 1, 2, (1 << high - 1) - 1, (1 << high) - 2, (1 << high) - 1)
    fractions = (0, 1, 2, 1 << low - 1, (1 << low) - 2, (1 << low) - 1)
    found = [
        (sign << low + high) + (exponent << low) + fraction
        for sign in (0, 1)
        for exponent in exponents
        for fraction in fractions
    ]
    chance = random.Random(width)
    found += [chance.getrandbits(width) for _ in range(COUNT)]
    for _ in range(COUNT):
        number = chance.choice((chance.uniform(-1e3, 1e3), float(chance.randint(-(2**24), 2**24))))
        found.append(int.from_bytes(struct.pack(form, number)))
    return found


def expected(raw: int, width: int) -> tuple[list[str], float | None]:
    """Status, class and fields by `struct`, and the value where there is one."""
    form, low, high = FORMS[width]
    (value,) = struct.unpack(form, raw.to_bytes(width // 8))
    exponent, fraction = raw >> low & (1 << high) - 1, raw & (1 << low) - 1
    if math.isnan(value):
        status = kind = "NOT_A_NUMBER"
    elif math.isinf(value):
        status = kind = "INFINITE"
    else:
        smallest = math.ldexp(1.0, 2 - (1 << high - 1))
        kind = "ZERO" if value == 0 else "SUBNORMAL" if abs(value) < smallest else "NORMAL"
        status = "FINITE"
    sign = "-" if raw >> width - 1 else "+"
    fields = [status, kind, sign, str(exponent), str(fraction)]
    return fields, value if status == "FINITE" else None


@pytest.mark.parametrize("mode", ["checks", "release"])
@pytest.mark.parametrize("width", [32, 64])
def test_raw_bits_are_the_numbers_that_struct_has(mode: str, width: int) -> None:
    program = built(mode, "loopback", "float_lines") / "float_lines"
    given = patterns(width)
    rows = (str(raw) if width == 32 else f"{raw >> 32} {raw & 0xFFFFFFFF}" for raw in given)
    done = subprocess.run(
        [program], input="\n".join(rows) + "\n", capture_output=True, text=True, timeout=60
    )
    lines = done.stdout.splitlines()
    assert (done.returncode, done.stderr, len(lines)) == (0, "", len(given))
    for raw, line in zip(given, lines, strict=True):
        wanted, value = expected(raw, width)
        fields, rest = line.split()[:5], [int(one) for one in line.split()[5:]]
        assert fields == wanted, hex(raw)
        if value is None:
            assert rest == []
            continue
        mantissa, scale, *back = rest
        assert math.ldexp(mantissa, scale) == value, hex(raw)
        again = back[0] if width == 32 else (back[0] << 32) + back[1]
        assert again == (raw if value else 0), hex(raw)


DATABASE = """VERSION ""
BU_: ecu board
BO_ 256 weather: 12 ecu
 SG_ wind : 0|32@1- (1,0) [0|0] "m/s" board
 SG_ pressure : 32|64@1- (1,0) [0|0] "Pa" board
SIG_VALTYPE_ 256 wind : 1;
SIG_VALTYPE_ 256 pressure : 2;
"""

ACTIVITY = """
    port_region: {period: 100 ms, wcet: 100 us}
    data: {speed: {type: Speed, initial: 0}}
    activities:
      measure: {period: 100 ms, wcet: 100 us, reads: [weather], writes: [speed], body: user}
messages:
"""

REST = """
nodes: {node: {context_switch: 1 us, critical_section: 1 us}}
instances: {board: {component: Board_Ports, node: node}}
buses:
  bus: {bit_rate: 500 kbit/s, driver_wcet: 10 us, receive_depth: 8, transmit_depth: 8}
processors:
  work: {node: node, stack: 16 KiB, activities: [board.ports, board.measure]}
  reception: {node: node, released_by: bus, period: 1 ms, stack: 16 KiB, activities: [bus.receive]}
shutdown: {raises: [], grace: 0 ms}
"""


def written(folder: Path) -> Path:
    """The model and the body of the page."""
    (folder / "line.dbc").write_text(DATABASE)
    found = imported(folder / "line.dbc", "board", Periods("100 ms"), parts=True)
    assert found.problems == []
    assert "weather.pressure_Low   is part of the raw bits of a floating-point" in found.text
    text = found.text.replace("types:", "types:\n  Speed: {range: [0, 1000], unit: 0.1 m/s}")
    model = folder / "model.yaml"
    model.write_text("system: Station\n" + text.replace("\nmessages:\n", ACTIVITY) + REST)
    page = (ROOT / "docs" / "databases.md").read_text(encoding="utf-8")
    (body,) = re.findall(r"```ada\n(.*?)```", page, re.S)
    (folder / "user").mkdir()
    (folder / "user" / "station-board_ports-activities.adb").write_text(body)
    return model


@pytest.mark.slow
def test_the_body_of_the_page_builds(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("RAVENCHART_WARNINGS", "errors")
    assert main(["build", str(written(tmp_path))]) == 0


@pytest.mark.skipif("RAVENCHART_LONG_TESTS" not in os.environ, reason="long: make test-long")
@pytest.mark.skipif(not toolchain.have("gnatprove"), reason="gnatprove is not on PATH")
def test_the_body_of_the_page_is_proved(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["prove", str(written(tmp_path))]) == 0
    done = capsys.readouterr().out
    assert re.search(r"checks (\d+), proved \1, justified 0, assumed 0, outside SPARK 0", done)
