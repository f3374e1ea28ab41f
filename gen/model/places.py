# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Where generated programs are, and the libraries of a system."""

from __future__ import annotations

import posixpath
from pathlib import PurePath, PurePosixPath

from .system import System

USUAL = ("model.yaml", "library.yaml")
"""The usual names of main files."""


def generated_beside(main: PurePath) -> str:
    """The folder of a program, beside the main file of its model."""
    is_usual = main.name.lower() in USUAL
    return "generated" if is_usual else f"generated-{main.name.removesuffix('.yaml')}"


def library_beside(system: System, library: System) -> PurePosixPath:
    """The main file of a library, from the folder of the system's own."""
    here = posixpath.dirname(system.origin.file) or "."
    return PurePosixPath(posixpath.relpath(library.files[0], here))
