# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart clean`: what was built is deleted; models, sources and results stay."""

from __future__ import annotations

import argparse
import shutil
from pathlib import Path

from ravenchart.failures import OK
from ravenchart.paths import cache, work

from .results import CleanResult


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    sub.add_argument(
        "model",
        type=Path,
        nargs="?",
        metavar="MODEL",
        help="delete only the build results of this model",
    )
    sub.add_argument(
        "--results", action="store_true",
        help="also delete the kept results of checks and proofs, of all models",
    )  # fmt: skip


def execute(options: argparse.Namespace) -> int:
    """Delete it; the exit status."""
    if options.model is None:
        folders = [work() / "build", work() / "obj"]
    else:
        from ravenchart.building.programs import homes_of

        folders = homes_of(options.model)
    if options.results:
        folders += [cache() / kind for kind in ("checks", "generations", "proofs", "verdicts")]
    freed = sum(_size(folder) for folder in folders)
    there = [folder for folder in folders if folder.exists()]
    for folder in there:
        shutil.rmtree(folder)
    options.answer.result = CleanResult([str(folder) for folder in there], freed)
    print(f"{freed / 1e6:.0f} MB freed")
    return OK


def _size(folder: Path) -> int:
    files = (path for path in folder.rglob("*") if path.is_file() and not path.is_symlink())
    return sum(path.stat().st_size for path in files)
