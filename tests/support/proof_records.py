# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Records of proofs, against the sources that are here."""

from __future__ import annotations

import tomllib
from pathlib import Path

from ravenchart.paths import ROOT
from ravenchart.tools.kept import file_digest


def stale_sources(record: Path) -> tuple[str, ...]:
    """The sources that differ from what the record says was proved."""
    found = tomllib.loads(record.read_text(encoding="utf-8"))
    stale = []
    for name, wanted in found["sources"].items():
        path = ROOT / name
        if not path.is_file() or file_digest(path) != wanted:
            stale.append(name)
    return tuple(stale)
