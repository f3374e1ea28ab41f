# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The longest responses of the robot with the tab Live open in a browser, and without."""

from __future__ import annotations

import tempfile
from pathlib import Path

from tests.support.browser import CHROMIUM
from tests.support.viewed_runs import WorkingRobot, side_by_side

SECONDS = 30.0
"""Of each run."""


def main() -> None:
    """Both, side by side."""
    print("the robot at work, with live view and without (longest responses in us):")
    if CHROMIUM is None:
        print("  Chromium is missing: `scripts/setup.sh browser` installs it")
        return
    with tempfile.TemporaryDirectory(prefix="ravenchart-viewed-") as folder:
        robot = WorkingRobot(Path(folder))
        viewed, other = (robot.works(SECONDS, view=view) for view in (True, False))
    for line in side_by_side(viewed, other):
        print(f"  {line}")
