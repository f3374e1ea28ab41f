# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Where Ravenchart's own files are, and where it may write: the one module that knows.

In a checkout the folders of Ada sources are at its top, and in this package there are
links to them; an installed package holds the folders themselves. So both look the same
from here, and project files find each other by the same relative paths.
"""

from __future__ import annotations

import os
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent
"""The import package."""

ROOT = (PACKAGE / "ravenchart.gpr").resolve().parent
"""Where ravenchart.gpr, the runtime and the CAN layers are: a checkout, or the package."""


def cache() -> Path:
    """Where results are kept between calls: below ``$XDG_CACHE_HOME``, else ~/.cache."""
    home = os.environ.get("XDG_CACHE_HOME", "")
    base = Path(home) if Path(home).is_absolute() else Path.home() / ".cache"
    return base / "ravenchart"


def work() -> Path:
    """Where objects and programs are built: a checkout that can be written, else the cache.

    Below the cache each installation has a folder of its own.
    """
    if ROOT != PACKAGE and os.access(ROOT, os.W_OK):
        return ROOT
    import hashlib  # only here: the start of every command imports this module

    return cache() / f"work-{hashlib.sha256(str(ROOT).encode()).hexdigest()[:8]}"


def version() -> str:
    """The version of this installation, as pyproject.toml has it."""
    from importlib import metadata

    return metadata.version("ravenchart")
