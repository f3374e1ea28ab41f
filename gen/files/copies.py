# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Changed copies of the trees of files; all locations are kept.

A damaged value damages all around it, as in the trees themselves.
"""

from __future__ import annotations

from collections.abc import Mapping

from .located import Map, Seq, TextPlace


class TreeCopy:
    """A mapping that is changed: the same object as long as nothing differs."""

    def __init__(self, given: Map) -> None:
        """Nothing is changed yet."""
        self.given, self.tree = given, given

    def _own(self) -> Map:
        """The copy."""
        if self.tree is self.given:
            given, made = self.given, Map(self.given.origin)
            made.update(given)
            made.keys_at, made.values_at = dict(given.keys_at), dict(given.values_at)
            made.dropped, made.damaged = dict(given.dropped), given.damaged
            self.tree = made
        return self.tree

    def put(self, key: str, value: object, place: TextPlace | None = None) -> None:
        """Another value for a key."""
        if value is self.tree[key]:
            return
        made = self._own()
        made[key] = value
        made.damaged = made.damaged or _is_damaged(value)
        if place is not None:
            made.values_at[key] = place

    def split(self, key: str, entries: Mapping[str, object]) -> None:
        """These entries in place of one, where that one stands."""
        before, made = self.tree, Map(self.given.origin)
        made.dropped, made.damaged = dict(before.dropped), before.damaged
        for old in before:
            for name, value in (entries if old == key else {old: before[old]}).items():
                made[name] = value
                made.keys_at[name], made.values_at[name] = (
                    before.keys_at[old],
                    before.values_at[old],
                )
                made.damaged = made.damaged or _is_damaged(value)
        self.tree = made

    def drop(self, key: str) -> None:
        """A key less."""
        if key in self.tree:
            del self._own()[key]

    def lose(self, key: str) -> None:
        """A key less, since it was wrong."""
        self.drop(key)
        made = self._own()
        made.dropped[key] = None
        made.damaged = True


class ListCopy:
    """A list that is changed, by the numbers that its items have before."""

    def __init__(self, given: Seq) -> None:
        """Nothing is changed yet."""
        self.given = given
        self.made: dict[int, list[object]] = {}
        self.damaged = given.damaged

    def put(self, number: int, items: list[object]) -> None:
        """Several items in place of one."""
        self.made[number] = items
        self.damaged = self.damaged or any(map(_is_damaged, items))

    def lose(self, number: int) -> None:
        """An item less, since it was wrong."""
        self.made[number] = []
        self.damaged = True

    def sequence(self) -> Seq:
        """The list; the same object where nothing differs."""
        if not self.made:
            return self.given
        made = Seq(self.given.origin)
        made.damaged = self.damaged
        for number, item in enumerate(self.given):
            items = self.made.get(number, [item])
            made += items
            made.items_at += [self.given.items_at[number]] * len(items)
        return made


def _is_damaged(value: object) -> bool:
    return isinstance(value, Map | Seq) and value.damaged
