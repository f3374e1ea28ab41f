# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The program that measures commands fits what is generated, and each way of a call is measured."""

from __future__ import annotations

import pytest

from tests.bench import commands


@pytest.mark.slow
def test_a_plain_a_direct_and_a_queued_command_are_measured() -> None:
    plain, direct, queued = commands.nanoseconds()
    assert 0 < plain < queued
    assert 0 < direct < queued
