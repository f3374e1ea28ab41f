# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The model that records values, and what each element is worth, execution by execution."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from ravenchart.paths import ROOT

FOLDER = ROOT / "tests" / "feature" / "recorded"
MODEL = FOLDER / "model.yaml"

Values = dict[str, list[str]]
"""By element, as the formats show them."""


def expected(executions: int) -> Values:
    """What `give` and the port region record in so many executions, written down by hand."""
    heights = [str(min(-1000 + 7 * k, 1000)) for k in range(1, executions + 1)]
    hues = ["Green", *["Blue"] * (executions - 1)][:executions]
    warm = [str(int(height) > -990) for height in heights]
    far = [str(-(2**62) if int(height) < 0 else 2**62 - 1) for height in heights]
    heat = [f"{(-400 + 3 * k) / 10:.1f}" for k in range(1, executions + 1)]
    return {
        "giver.height": heights,
        "giver.hue": hues,
        "giver.far": far,
        "giver.reading.height": heights,
        "giver.reading.hue": hues,
        "giver.reading.warm": warm,
        "taker.reading.height": heights,
        "taker.heat": heat,
    }


def counted(executions: int) -> list[str]:
    """What `Counting` records as `count` in so many executions: up to 4, every second time.

    The first one enters `Waiting`. The third finds an event in `Counted`, which it ignores.
    """
    return ["0", "1", *(str(min(k // 2, 4)) for k in range(2, executions))]


def grouped(rows: Sequence[tuple[str, str]]) -> Values:
    """Pairs of an element and a value, by element."""
    made: Values = {}
    for element, value in rows:
        made.setdefault(element, []).append(value)
    return made


def asammdf() -> Any:
    """The package; without it the test is skipped, and says how to get it.

    `scripts/setup.sh tests` installs it in a folder of its own: python-can would import it, and
    pandas, in each process.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "path", [*sys.path, str(ROOT / ".venv" / "mdf")])
        return pytest.importorskip("asammdf", reason="`scripts/setup.sh tests` installs asammdf")


def read_back(path: Path, element: str) -> list[tuple[int, int]]:
    """The times in ns, and the numbers that a file of MDF has of an element, by asammdf."""
    with asammdf().MDF(path) as mdf:
        signal = mdf.get(element, raw=True)
        times = [round(float(at) * 1e9) for at in signal.timestamps]
        return list(zip(times, map(int, signal.samples), strict=True))
