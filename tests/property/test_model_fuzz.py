# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Models bent at random: `generate` refuses them, or their program compiles without a warning.

50 models; 2,000 with `make test-long`. Each seed makes the same model again:
``python -m tests.support.model_fuzzer SEED`` prints it and what is wrong with it.
"""

from __future__ import annotations

import os

import pytest

from tests.support.model_fuzzer import outcomes

pytestmark = pytest.mark.slow

SEEDS = range(2_000) if "RAVENCHART_LONG_TESTS" in os.environ else range(50)


def test_what_check_accepts_compiles_without_a_warning() -> None:
    found = outcomes(SEEDS)
    wrong = [f"seed {outcome.seed}: {outcome.text}" for outcome in found if outcome.kind == "wrong"]
    assert not wrong, "\n".join(wrong)
    kinds = [outcome.kind for outcome in found]
    print(f"seeds {SEEDS.start} to {SEEDS.stop - 1}: {kinds.count('compiled')} compiled")
    assert kinds.count("compiled") > len(kinds) // 10
