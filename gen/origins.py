# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Where an element stands in a model's files."""

from __future__ import annotations

import os
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, order=True)
class Origin:
    """Where an element stands in the model: file as given, 1-based line and column."""

    file: str
    line: int
    column: int

    def __str__(self) -> str:
        """``file:line:column``, as editors read it."""
        return f"{self.file}:{self.line}:{self.column}"

    def beside(self, model: Origin) -> str:
        """``file:line``, the file as seen from the folder of ``model``."""
        folder = os.path.dirname(model.file) or "."
        return f"{os.path.relpath(self.file, folder)}:{self.line}"
