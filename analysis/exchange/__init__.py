# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Systems in the formats of other analysis tools. No number is rounded: times are whole ns."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from ravenchart.analysis.core.chains import TimedChain
from ravenchart.analysis.core.holistic import Network

from . import cheddar, mast, pycpa
from .shapes import Unfit

Export = Callable[[Network, Sequence[TimedChain], str], str]
"""The text of a system with that title; `Unfit` where the format cannot express it."""

FORMATS: Mapping[str, Export] = {
    "mast": mast.export,
    "cheddar": cheddar.export,
    "pycpa": pycpa.export,
}

__all__ = ["FORMATS", "Export", "Unfit"]
