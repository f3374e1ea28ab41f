# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The automated build, with stand-ins for the commands that it calls."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

from ravenchart.paths import ROOT


@pytest.mark.parametrize("chromium", [0, 2])
def test_chromium_is_installed_before_all_tests_and_they_run_without_it(
    chromium: int, tmp_path: Path
) -> None:
    script = tmp_path / ".ci" / "run"
    script.parent.mkdir()
    script.write_bytes((ROOT / ".ci" / "run").read_bytes())
    for name, status in (("make", 0), ("scripts/setup.sh", chromium), ("gnatprove", 0)):
        stand_in = tmp_path / name
        stand_in.parent.mkdir(exist_ok=True)
        stand_in.write_text(f'#!/bin/sh\necho "{name} $*" >> "{tmp_path}/calls"\nexit {status}\n')
        stand_in.chmod(0o755)
    path = f"{tmp_path}:{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", script], env={**os.environ, "PATH": path}, capture_output=True, text=True,
        check=True,
    )  # fmt: skip
    assert (tmp_path / "calls").read_text().splitlines() == [
        "make check",
        "make prove ONLY=runtime examples",
        "scripts/setup.sh browser",
        "make test-all",
    ]
    assert ("goes on without Chromium" in done.stdout) is (chromium != 0)
