# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The records that rows note at most, beside those that the generated Ada can note."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.analysis.system.records import of_slot
from ravenchart.gen.derive.completion import programs
from ravenchart.gen.pipeline import load
from ravenchart.paths import ROOT
from tests.support.noted import Noted

MODELS = [
    path
    for folder in ("examples", "tests/feature", "tests/nodes")
    for path in sorted((ROOT / folder).glob("*/model.yaml"))
]


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.parent.name)
def test_no_row_notes_more_than_is_counted(path: Path) -> None:
    """The count is safe, and at most twice as high as the most that the statements can note."""
    system = load(path).system
    assert system is not None
    for part in programs(system):
        noted, rows = Noted.of(part), {slot.element for slot in part.slots}
        for slot in (slot for slot in system.slots if slot.element in rows):
            counted, seen = of_slot(system, slot), noted.of_slot(slot)
            assert seen.trace <= counted.trace <= 2 * seen.trace, slot.element
            assert seen.values <= counted.values <= 2 * seen.values, slot.element
