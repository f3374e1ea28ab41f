# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Responses of the robot with the tab Live open in a browser, without it, and without snapshots."""

from __future__ import annotations

import tempfile
from pathlib import Path

from tests.support import live
from tests.support.browser import CHROMIUM
from tests.support.viewed_parts import NoPartError, parts, told

SECONDS = 30.0
"""Of each part."""


def main() -> None:
    """All parts, side by side."""
    print(f"responses of the robot at work, in us; each part has {SECONDS:.0f} s:")
    if CHROMIUM is None:
        print("  Chromium is missing: `scripts/setup.sh browser` installs it")
        return
    with tempfile.TemporaryDirectory(prefix="ravenchart-viewed-") as folder, live.alone():
        try:
            lines = told(*parts(Path(folder), SECONDS))
        except NoPartError as problem:
            lines = iter([str(problem)])
    for line in lines:
        print(f"  {line}")


if __name__ == "__main__":
    main()
