# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart doctor`: what is installed, what is missing, and the command that mends it."""

from __future__ import annotations

import argparse
import os
import platform
import shutil
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass

from ravenchart.failures import OK, UNUSABLE
from ravenchart.paths import PACKAGE, ROOT, cache, version, work
from ravenchart.tools.toolchain import GET_GNATPROVE

from .results import DoctorResult, Tool


@dataclass(frozen=True, slots=True)
class NeededTool:
    """A program that Ravenchart calls; ``needed`` for a program to be built at all."""

    name: str
    purpose: str
    mend: str
    needed: bool = False


TOOLS = (
    NeededTool("gcc", "compiles Ada", "sudo apt-get install gnat", needed=True),
    NeededTool("gprbuild", "builds programs", "sudo apt-get install gprbuild", needed=True),
    NeededTool("gnatprove", "`prove`", GET_GNATPROVE),
    NeededTool("gcov", "`tests --coverage`", "sudo apt-get install gcc"),
    NeededTool("dot", "`draw`", "sudo apt-get install graphviz"),
)


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """The command has no arguments."""


def execute(options: argparse.Namespace) -> int:
    """Print it; the exit status: 2 where no program can be built."""
    rows = list(_rows())
    options.answer.result = DoctorResult([Tool(what, state, said) for state, what, said in rows])
    width = max(len(what) for _, what, _ in rows)
    for state, what, said in rows:
        print(f"{state:<8} {what:<{width}}  {said}")
    lacking = [tool for tool in TOOLS if tool.needed and not shutil.which(tool.name)]
    return UNUSABLE if lacking else OK


def _rows() -> Iterator[tuple[str, str, str]]:
    """State, name and text of each row."""
    place = "an installation" if ROOT == PACKAGE else "a checkout"
    yield "ok", "ravenchart", f"{version()}, {place}: {ROOT}"
    yield "ok", "python", f"{platform.python_version()}"
    for tool in TOOLS:
        path = shutil.which(tool.name)
        if path is None:
            state = "missing" if tool.needed else "absent"
            yield state, tool.name, f"{tool.purpose}: {tool.mend}"
        elif tool.name == "gcc" and not _compiles_ada():
            yield "missing", tool.name, f"{path} compiles no Ada: {tool.mend}"
        else:
            yield "ok", tool.name, f"{_version_of(tool.name)}, {path}"
    for name, folder in (("builds", work()), ("results", cache())):
        there = folder
        while not there.exists():
            there = there.parent
        good = os.access(there, os.W_OK)
        mend = "" if good else ": cannot be written; set XDG_CACHE_HOME to a folder that can"
        yield ("ok" if good else "missing"), name, f"{folder}{mend}"
    good = _may_have_priorities()
    mend = "sudo setcap cap_sys_nice+ep PROGRAM, or run as root: else timing is not judged"
    yield ("ok" if good else "absent"), "priorities", "real-time" if good else mend


def _compiles_ada() -> bool:
    done = subprocess.run(
        ["gcc", "-print-prog-name=gnat1"], capture_output=True, text=True, check=False
    )
    return os.path.isabs(done.stdout.strip())


def _version_of(tool: str) -> str:
    option = "-V" if tool == "dot" else "--version"
    done = subprocess.run([tool, option], capture_output=True, text=True, check=False)
    lines = (done.stdout or done.stderr).splitlines()
    return lines[0].strip() if lines else "of an unknown version"


def _may_have_priorities() -> bool:
    """Whether a process of this user may ask for SCHED_FIFO."""
    child = os.fork()
    if child == 0:
        try:
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))
        except OSError:
            os._exit(1)
        os._exit(0)
    return os.waitpid(child, 0)[1] == 0
