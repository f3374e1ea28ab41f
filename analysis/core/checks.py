# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Checks that refuse meaningless parameters by name."""

from __future__ import annotations


def positive(owner: str, **fields: int) -> None:
    """Refuse fields of ``owner`` that are not integers above zero, with a ValueError."""
    for field, value in fields.items():
        if type(value) is not int or value <= 0:
            raise ValueError(f"{field} of {owner} must be an integer above 0, not {value!r}")


def natural(owner: str, **fields: int) -> None:
    """Refuse fields of ``owner`` that are not integers from zero up, with a ValueError."""
    for field, value in fields.items():
        if type(value) is not int or value < 0:
            raise ValueError(f"{field} of {owner} must be an integer from 0 up, not {value!r}")


def at_most(owner: str, field: str, value: int, limit: int) -> None:
    """Refuse a best case of ``owner`` that is longer than its worst, with a ValueError."""
    if value > limit:
        raise ValueError(f"{field} of {owner} is {value}, above its worst case of {limit}")


def distinct(kind: str, names: list[str]) -> None:
    """Refuse a name that two of ``kind`` have, with a ValueError."""
    if len(set(names)) == len(names):
        return
    seen: set[str] = set()
    for name in names:
        if name in seen:
            raise ValueError(f"two {kind} have the name {name}")
        seen.add(name)
