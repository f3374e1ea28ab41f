# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Random frames through generated codecs: nothing is raised, and nothing is accepted wrongly.

A few thousand for each message; a million with `make test-long`.
"""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from ravenchart.building import checking, generation
from ravenchart.gen.emit.program import generate
from ravenchart.paths import ROOT
from tests.support.codec_fuzzer import CHECKED, UNCHECKED, fuzzed

FRAMES = 1_000_000 if "RAVENCHART_LONG_TESTS" in os.environ else 5_000

MODELS = [
    ROOT / "tests" / "feature" / "signals" / "model.yaml",
    ROOT / "tests" / "feature" / "pages" / "model.yaml",
    ROOT / "tests" / "feature" / "flexible" / "model.yaml",
    ROOT / "examples" / "cartesian_robot" / "model.yaml",
]


@pytest.mark.slow
@pytest.mark.parametrize("model", MODELS, ids=lambda p: p.parent.name)
def test_what_is_accepted_packs_into_the_same_bits(model: Path, tmp_path: Path) -> None:
    checked = checking.check(model)
    for name, text in generate(checked.system, generation.claims(checked)).items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    tallies = fuzzed(checked.system, tmp_path, tmp_path / "checked", FRAMES, CHECKED)
    assert [tally.message for tally in tallies] == [m.name for m in checked.system.messages]
    for tally in tallies:
        assert 0 < tally.accepted < FRAMES, tally.message
    assert fuzzed(checked.system, tmp_path, tmp_path / "unchecked", FRAMES, UNCHECKED) == tallies
