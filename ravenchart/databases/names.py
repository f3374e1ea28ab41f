# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Names of a CAN database as names of a model: the same where that is one, else the nearest."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence, Set

from ravenchart.gen.language.names import CHILDREN, HIDING, LONG_NAME, PREDEFINED_TYPES, RESERVED

HIDDEN = PREDEFINED_TYPES | HIDING | frozenset(CHILDREN)
"""Names that types and their values cannot have, in lower case."""


class Names:
    """The names of one scope of a model, each given once; case does not count."""

    def __init__(self, names: Iterable[str] = ()) -> None:
        """``names`` are all of the scope: those that can stay as they are go first."""
        self._taken: set[str] = set()
        self._found: dict[str, str] = {}
        known = list(names)
        for name in sorted(known, key=lambda one: _plain(one) != one):
            self._found[name] = self.new(name)

    def of(self, name: str) -> str:
        """The name in the model of one of the scope's names."""
        return self._found[name]

    def new(self, name: str, besides: Set[str] = frozenset()) -> str:
        """A name like this one that nothing in the scope has, nor ``besides`` in lower case."""
        plain = _plain(name)
        found, number = plain, 1
        while found.lower() in self._taken | besides | RESERVED:
            number += 1
            end = f"_{number}"
            found = plain[: LONG_NAME - len(end)].rstrip("_") + end
        self._taken.add(found.lower())
        return found

    @staticmethod
    def of_each(names: Sequence[str]) -> list[str]:
        """Each of the names of a scope in the model, in their order, also where two are alike."""
        scope, given, found = Names(dict.fromkeys(names)), set[str](), list[str]()
        for name in names:
            found.append(scope.new(name) if name in given else scope.of(name))
            given.add(name)
        return found

    @property
    def taken(self) -> Set[str]:
        """All that are given, in lower case."""
        return self._taken

    def avoid(self, names: Iterable[str]) -> None:
        """Nothing that is named from now on has one of these names."""
        self._taken |= {name.lower() for name in names}


def _plain(name: str) -> str:
    """The name itself, or without what no name has; as long as always fits into a line of Ada."""
    letters = re.sub(r"[^A-Za-z0-9]+", "_", name).strip("_")
    if not letters[:1].isalpha():
        letters = f"N_{letters}".rstrip("_")
    return letters[:LONG_NAME].rstrip("_")
