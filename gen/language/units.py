# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Units of measure as models write them: `mm/s`, or `0.1 degC` where one count is so much."""

from __future__ import annotations

import re
from decimal import Decimal

_COUNT = re.compile(r"(\d+(?:\.\d+)?)(?: +(\S.*))?")


def count_of(unit: str | None) -> tuple[Decimal, str | None]:
    """The amount that one count stands for, exactly, and its unit."""
    found = None if unit is None else _COUNT.fullmatch(unit)
    if found is None or Decimal(found[1]) == 0:
        return Decimal(1), unit
    return Decimal(found[1]), found[2]
