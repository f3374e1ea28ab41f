# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The outside programs: gprbuild, gnatprove and dot, found, run, their words passed on."""

from __future__ import annotations

import fcntl
import os
import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext
from pathlib import Path
from tempfile import TemporaryDirectory

from ravenchart.failures import ToolFailed, Unusable
from ravenchart.paths import ROOT, work

from . import children

GET_GNATPROVE = 'alr get gnatprove && PATH="$(ls -d "$PWD"/gnatprove_*/bin):$PATH"'
"""The command that installs gnatprove for the shell that it is given to."""

INSTALL_HINT = {
    "gprbuild": "install the Debian packages gnat and gprbuild (`make setup` does)",
    "dot": "install the Debian package graphviz (`make setup` does)",
    "gnatprove": f"install gnatprove with Alire: `{GET_GNATPROVE}`",
}


class ToolMissing(Unusable):
    """An outside program is not installed; the text says how to get it."""

    def __init__(self, tool: str) -> None:
        super().__init__(f"{tool} is not on PATH; {INSTALL_HINT[tool]}")
        self.tool = tool


def have(tool: str) -> bool:
    """Is the program on PATH?"""
    return shutil.which(tool) is not None


def run(
    tool: str,
    arguments: Sequence[str],
    where: Path,
    scenario: Mapping[str, str],
    taken: Callable[[str], bool] = lambda _: False,
) -> str:
    """Run a tool with scenario variables set; its output, or ToolMissing or ToolFailed.

    The result and the text of ToolFailed have no line of the output that ``taken`` takes. The
    temporary files of the tool are deleted.
    """
    if not have(tool):
        raise ToolMissing(tool)
    paths = [str(ROOT), *filter(None, [os.environ.get("GPR_PROJECT_PATH")])]
    given = {"RAVENCHART_OBJECTS": str(work() / "obj"), **scenario}
    variables = [f"-X{name}={value}" for name, value in given.items()]
    environment = {**os.environ, "GPR_PROJECT_PATH": os.pathsep.join(paths)}
    if tool != "gprbuild":
        environment.pop("GPR_CONFIG", None)  # a configuration for compilers; gnatprove has its own
    alone = _alone(tool, given) if "-P" in arguments else nullcontext()
    with alone, TemporaryDirectory(prefix="ravenchart-") as scratch:
        environment["TMPDIR"] = scratch
        done = children.run_watched(
            [tool, *arguments, *variables], taken, cwd=where, env=environment, errors="replace"
        )
    if done.returncode != 0:
        raise ToolFailed(done.stdout)
    return done.stdout


@contextmanager
def _alone(tool: str, scenario: Mapping[str, str]) -> Iterator[None]:
    """Wait until no other call of the tool writes the objects of the runtime in this scenario.

    All programs of one mode and driver share them, so two builds at once would write the same
    files.
    """
    objects = Path(scenario["RAVENCHART_OBJECTS"])
    chosen = (scenario.get("MODE", "checks"), scenario.get("CAN_DRIVER", "loopback"), tool)
    objects.mkdir(parents=True, exist_ok=True)
    with open(objects / f"{'-'.join(chosen)}.lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def filtered(tool: str, arguments: Sequence[str], text: str) -> str:
    """The output of a tool for a text; ToolMissing, or ToolFailed with its error output."""
    if not have(tool):
        raise ToolMissing(tool)
    done = children.run([tool, *arguments], text, encoding="utf-8")
    if done.returncode != 0:
        raise ToolFailed(done.stderr)
    return done.stdout
