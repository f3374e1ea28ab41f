# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""How many random cases are drawn: few in `make test`, which is run at each change."""

from __future__ import annotations

import os
from collections.abc import Sequence

import pytest

ALL = "RAVENCHART_ALL_TESTS"
"""Set in the environment, nothing is left out for its time; so it is where files are named."""


def drawn(some: int, whole: int) -> int:
    """``some`` in `make test`, ``whole`` in `make test-all`."""
    return whole if ALL in os.environ else some


def seeds(some: int, whole: int) -> Sequence[object]:
    """So many seeds; those from ``some`` on are slow tests, and `make test` says so."""
    slow = (pytest.param(seed, marks=pytest.mark.slow) for seed in range(some, whole))
    return (*range(some), *slow)
