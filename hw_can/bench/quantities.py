# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Quantities of a scenario, with their units (``430 mm``, ``1 mm/s``, ``8 s``), in m, m/s and s.

Values of fields have no unit: they count in the unit of the CAN database.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Annotated

from pydantic import BeforeValidator, Field, WithJsonSchema

PERIOD = 0.005
"""The bench's period in s: between two feedback frames of a drive."""

_QUANTITY = re.compile(r"(-?\d+(?:\.\d+)?) ?([a-z/]+)")
_LENGTHS = {"um": 1e-6, "mm": 1e-3, "m": 1.0}
_SPEEDS = {"um/s": 1e-6, "mm/s": 1e-3, "m/s": 1.0}
_TIMES = {"us": 1e-6, "ms": 1e-3, "s": 1.0}


def time_of(text: str) -> float:
    """A time in s; ValueError has the required form."""
    found = _quantity(text, _TIMES)
    if found < 0:
        raise ValueError("at least 0 s")
    return found


def _quantity(value: object, units: Mapping[str, float]) -> float:
    """A number with one of ``units``, in the unit whose factor is 1."""
    match = _QUANTITY.fullmatch(value) if isinstance(value, str) else None
    if match is None or match[2] not in units:
        known = [*units]
        raise ValueError(f"a number and one of {', '.join(known)}, such as `5 {known[1]}`")
    return float(match[1]) * units[match[2]]


def _written(units: Mapping[str, float]) -> WithJsonSchema:
    """The form of a quantity, for the JSON Schema."""
    return WithJsonSchema({"type": "string", "pattern": rf"^-?\d+(\.\d+)? ?({'|'.join(units)})$"})


Length = Annotated[
    float, BeforeValidator(lambda value: _quantity(value, _LENGTHS)), _written(_LENGTHS)
]
Speed = Annotated[
    float, BeforeValidator(lambda value: _quantity(value, _SPEEDS)), _written(_SPEEDS)
]
Time = Annotated[
    float, BeforeValidator(lambda value: _quantity(value, _TIMES)), Field(ge=0), _written(_TIMES)
]

_FRACTION = re.compile(r"-?\d+\.\d+")


def _number(value: object) -> object:
    """Numbers with a fraction, which are texts for the reader of YAML."""
    return float(value) if isinstance(value, str) and _FRACTION.fullmatch(value) else value


Scalar = Annotated[bool | int | float | str, BeforeValidator(_number)]
"""A value of a field: a number, or a name."""
