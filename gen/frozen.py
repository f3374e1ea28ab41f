# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Records that are made by the million."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar, dataclass_transform

T = TypeVar("T")


@dataclass_transform(frozen_default=True)
def frozen(cls: type[T]) -> type[T]:
    """A frozen dataclass with slots, by the type checker's word alone.

    One that guards itself at run time too takes twice as long to make.
    """
    return dataclass(slots=True, unsafe_hash=True)(cls)


@dataclass_transform()
def built(cls: type[T]) -> type[T]:
    """The same for a record with a constructor of its own: that alone sets its fields."""
    return dataclass(slots=True, unsafe_hash=True)(cls)
