# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart analyse --compare`: what changed since another version of the system."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ravenchart.analysis.findings.differences import Differences, Figures, differences, figures_of
from ravenchart.failures import Refused

from . import plain

CORRUPT = (KeyError, TypeError, ValueError, AttributeError, ZeroDivisionError)
"""Exceptions of reading the figures of an answer that was edited."""


def compared(earlier: Path, now: Figures) -> Differences:
    """The changes since ``earlier``: a model, a plain file, or an answer of `--json`."""
    try:
        return differences(str(earlier), _figures(earlier), now)
    except CORRUPT as fault:
        text = f"its figures are not those that `analyse --json` prints: {fault}"
        raise Refused(f"{earlier}: error: {text}") from None


def _figures(path: Path) -> Figures:
    """The figures of an earlier version; Refused with what is wrong with its file."""
    if path.suffix.lower() not in plain.ENDINGS:
        from ravenchart.analysis.present.figures import figures
        from ravenchart.building import checking

        return figures(checking.check(path, deadlines=False).analysis)
    if path.suffix.lower() == ".json":
        kept = figures_of(_json(path))
        if kept is not None:
            return kept
    return plain.figures(plain.analysed(path))


def _json(path: Path) -> Any:
    """The value in a JSON file; None for another file, which is then read as a plain file."""
    try:
        return json.loads(path.read_bytes())
    except (ValueError, RecursionError):
        return None
