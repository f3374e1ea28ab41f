# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The compiler of the tests: gcc for Ada, with a store of what was compiled before.

Many tests build copies of one model with a small change. tests/compiler/compile.adb stands for
gcc in every build that starts from here and copies a unit whose text, and all that it depends
on, was compiled before. `ravenchart build` of a user does not know it.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import time
from pathlib import Path

from ravenchart.paths import ROOT, work

SOURCES = ROOT / "tests" / "compiler"
HOME = work() / "build" / "compiler"
"""The program, what it knows of gcc, and its store."""
KEPT = 7 * 24 * 3600.0
"""Seconds after which a result that nobody asked for leaves the store."""


def use() -> None:
    """Make gprbuild call it, in this process and its children; nothing without gprbuild."""
    if shutil.which("gprbuild") is None:
        return
    configuration = HOME / "compiler.cgpr"
    if not _knows_gcc():
        _configure(configuration)
    os.environ["GPR_CONFIG"] = str(configuration)
    _forget(HOME / "store")


def options() -> tuple[str, ...]:
    """Those by which gnatmake calls it."""
    return (f"--GCC={HOME / 'compile'}",) if "GPR_CONFIG" in os.environ else ()


def _configure(configuration: Path) -> None:
    """Compile it, and write the configuration by which gprbuild finds it."""
    HOME.mkdir(parents=True, exist_ok=True)
    run = subprocess.run
    run(["gprconfig", "--batch", "--config=ada", "-o", configuration], check=True)
    text = configuration.read_text()
    driver = re.compile(r'(package Compiler is.*?for Driver\s+\("Ada"\) use ")([^"]+)', re.S)
    found = driver.search(text)
    assert found is not None
    gcc = found.group(2)
    text = driver.sub(lambda m: m.group(1) + str(HOME / "compile"), text, count=1)
    text = text.replace('Compiler\'Driver ("Ada")', f'"{gcc}"')
    configuration.unlink()
    home = f"-XRAVENCHART_COMPILER={HOME}"
    run(["gprbuild", "-p", "-q", "-P", "compiler.gpr", home], cwd=SOURCES, check=True)
    configuration.write_text(text)
    library = _said(gcc, "-print-file-name=adainclude")
    (HOME / "compiler").write_text(f"{gcc}\n{library}\n{_said(gcc, '--version')}\n{_sources()}\n")


def _knows_gcc() -> bool:
    """Is all there, for the gcc and the sources that are there now?"""
    known = HOME / "compiler"
    if not known.exists():
        return False
    gcc, _, *version, sources = known.read_text().splitlines()
    return (
        Path(gcc).exists()
        and "\n".join(version) == _said(gcc, "--version")
        and sources == _sources()
    )


def _said(*words: str) -> str:
    return subprocess.run(words, stdout=subprocess.PIPE, text=True, check=True).stdout.strip()


def _sources() -> str:
    """When the sources of the program changed."""
    return str(max(path.stat().st_mtime_ns for path in SOURCES.iterdir()))


def _forget(store: Path) -> None:
    """Remove results that were not used for a while."""
    oldest = time.time() - KEPT
    for read in store.glob("*/*.read"):
        if read.stat().st_mtime < oldest:
            for path in read.parent.glob(f"{read.stem}.*"):
                path.unlink(missing_ok=True)
