"""The outside programs: gprbuild, gnatprove and dot, found, run, their words passed on."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

from ravenchart.paths import ROOT, work

from . import children

INSTALL_HINT = {
    "gprbuild": "install the Debian packages gnat and gprbuild (`make setup` does)",
    "dot": "install the Debian package graphviz (`make setup` does)",
    "gnatprove": "install gnatprove with Alire: `alr get gnatprove`, and put its bin on PATH",
}


class ToolMissing(Exception):  # noqa: N818
    """An outside program is not installed; the text says how to get it."""

    def __init__(self, tool: str) -> None:
        super().__init__(f"{tool} is not on PATH; {INSTALL_HINT[tool]}")
        self.tool = tool


class ToolFailed(Exception):  # noqa: N818
    """An outside program ended with an error; the text is what it printed."""


def have(tool: str) -> bool:
    """Is the program on PATH?"""
    return shutil.which(tool) is not None


def run(tool: str, arguments: Sequence[str], where: Path, scenario: Mapping[str, str]) -> str:
    """Run a tool with scenario variables set; its output, or ToolMissing or ToolFailed."""
    if not have(tool):
        raise ToolMissing(tool)
    paths = [str(ROOT), *filter(None, [os.environ.get("GPR_PROJECT_PATH")])]
    given = {"RAVENCHART_OBJECTS": str(work() / "obj"), **scenario}
    variables = [f"-X{name}={value}" for name, value in given.items()]
    done = children.run(
        [tool, *arguments, *variables],
        cwd=where,
        env={**os.environ, "GPR_PROJECT_PATH": os.pathsep.join(paths)},
        stderr=subprocess.STDOUT,
        errors="replace",
    )
    if done.returncode != 0:
        raise ToolFailed(done.stdout)
    return done.stdout


def filtered(tool: str, arguments: Sequence[str], text: str) -> str:
    """What a tool makes of a text; ToolMissing, or ToolFailed with what it printed."""
    if not have(tool):
        raise ToolMissing(tool)
    done = children.run([tool, *arguments], text, encoding="utf-8")
    if done.returncode != 0:
        raise ToolFailed(done.stderr)
    return done.stdout
