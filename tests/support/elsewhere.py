# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Machines as parameters of tests: what is not there is skipped, with the reason."""

from __future__ import annotations

import pytest

from tests.hardware.machines import Machine


def needed(machine: Machine) -> Machine:
    """The machine; the test is skipped when programs for it cannot be built or run."""
    reasons = tuple(machine.missing())
    if reasons:
        pytest.skip("; ".join(reasons))
    return machine
