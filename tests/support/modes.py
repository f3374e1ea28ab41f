# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""How a test that compiles is parametrized: with contracts executed, and without."""

from __future__ import annotations

import pytest

MODES = ("checks", pytest.param("release", marks=pytest.mark.slow))
"""Both builds; `make test` has the one that executes contracts."""
