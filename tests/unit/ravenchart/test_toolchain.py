# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""How the tools of GNAT are run."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.failures import ToolFailed
from ravenchart.tools import toolchain

LEAVES = "#!/bin/sh\necho left > $TMPDIR/left\necho $TMPDIR\nexit {status}\n"


@pytest.mark.parametrize("status", [0, 1])
def test_what_a_tool_leaves_among_the_temporary_files_is_deleted(
    status: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    tool = tmp_path / "leaver"
    tool.write_text(LEAVES.format(status=status), encoding="utf-8")
    tool.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    try:
        said = toolchain.run("leaver", [], tmp_path, {})
    except ToolFailed as problem:
        said = str(problem)
    scratch = Path(said.strip().splitlines()[-1])
    assert scratch.is_absolute() and scratch != tmp_path and not scratch.exists()
