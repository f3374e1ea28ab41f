# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Recorded values and states as MDF 4 (ASAM), which asammdf writes: an optional package.

A channel is an element, in a group of its own: each has its own times, in s. It holds the numbers
of the program, with the conversion of its unit or its literals.
"""

from __future__ import annotations

import io
import json
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from ravenchart.failures import Unusable

from .values import Series

if TYPE_CHECKING:
    from asammdf import Signal

VERSION = "4.10"
INSTALL = 'python -m pip install "asammdf>=8.8"'


def written(series: list[Series], about: dict[str, str]) -> bytes:
    """The file; ``about`` says what the trace is, and what was lost."""
    try:
        from asammdf import MDF
    except ImportError:
        message = f"a file .mf4 is written by asammdf, which is not installed: {INSTALL}"
        raise Unusable(message) from None
    out = io.BytesIO()
    with MDF(version=VERSION) as mdf:
        mdf.header.start_time = datetime.fromtimestamp(0, UTC)
        mdf.header.comment = json.dumps(about)
        for one in series:
            mdf.append([_signal(one)], acq_name=one.process, comment=one.name)
        mdf.save(out)
    return out.getvalue()


def _signal(series: Series) -> Signal:
    import numpy as np
    from asammdf import Signal

    quantity = series.quantity
    conversion: dict[str, Any] | None = None
    if quantity.literals:
        conversion = {"default": b"?"}
        for position, literal in enumerate(quantity.literals):
            conversion |= {f"val_{position}": position, f"text_{position}": literal.encode()}
    elif quantity.count != 1:
        conversion = {"a": float(quantity.count), "b": 0.0}
    return Signal(
        samples=np.array([number for _, number in series.points], dtype=np.int64),
        timestamps=np.array([at / 1e9 for at, _ in series.points], dtype=np.float64),
        name=series.name,
        unit=quantity.unit,
        conversion=conversion,
    )
