# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Arrays of instances: those that a model declares, and the names for a reference with a star.

An instance `wheel` with `count: 4` is the four instances `wheel_1` to `wheel_4`, and `wheel_*` in
a reference stands for all of them, in this order. A star behind the last name of a reference
stands for the numbers from 1 on that the component has. So `speed_*` of a component with the
ports `speed_1` and `speed_2` stands for these two.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace

from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.language.names import NameUse, Unknown, meant
from ravenchart.gen.origins import Origin

from .located import Map

ALL = "_*"
"""Ends the name of an array where a reference means all its elements."""

_NUMBERED = re.compile(r"(\w+)_([1-9][0-9]*)")
"""A name that could be that of an element."""


def elements_of(name: str, count: int) -> tuple[str, ...]:
    """The names of the elements of an array, in order."""
    return tuple(f"{name}_{number}" for number in range(1, count + 1))


@dataclass(frozen=True, slots=True)
class InstanceArray:
    """An array of instances: its name, the number of its elements, and where it is declared."""

    name: str
    count: int
    origin: Origin

    @property
    def elements(self) -> tuple[str, ...]:
        """The names of the instances, in order."""
        return elements_of(self.name, self.count)


@dataclass(slots=True)
class InstanceLevel:
    """The instances with which references of a model, or of a composite component, begin.

    All names are in lower case here.
    """

    trees: Sequence[Map]
    """Those of the files, or that of the component."""
    name: str | None
    """That of the component."""
    open: bool = False
    """Some instances were lost without their names."""
    arrays: dict[str, InstanceArray] = field(default_factory=dict)
    kinds: dict[str, str] = field(default_factory=dict)
    """The components of instances, elements of arrays among them."""
    declared: dict[str, Origin] = field(default_factory=dict)
    """Where the instances that are no arrays are declared."""
    lost: set[str] = field(default_factory=set)
    """Instances that were wrong in form; they may have been arrays."""

    def __post_init__(self) -> None:
        """Find the instances."""
        for tree in self.trees:
            given = tree.get("instances")
            self.open = self.open or "instances" in tree.dropped
            if isinstance(given, Map):
                self.lost |= {name.lower() for name in given.dropped}
                for name, form in given.items():
                    if isinstance(form, Map):
                        self._take(name, form, given.keys_at[name])

    def _take(self, name: str, form: Map, origin: Origin) -> None:
        own, kind, count = name.lower(), str(form.get("component", "")).lower(), form.get("count")
        if isinstance(count, int):
            array = self.arrays.setdefault(own, InstanceArray(name, count, origin))
            for element in array.elements:
                self.kinds.setdefault(element.lower(), kind)
            return
        if "count" in form.dropped:
            self.lost.add(own)
            return
        self.declared.setdefault(own, origin)
        self.kinds[own] = kind

    def may_have_been(self, name: str) -> bool:
        """Whether a name may be that of an array that was wrong in form."""
        return self.open or name.lower() in self.lost

    def is_lost(self, name: str) -> bool:
        """Whether a name is that of an instance that was wrong in form, or may be of an element."""
        own, found = name.lower(), _NUMBERED.fullmatch(name.lower())
        return own not in self.kinds and (
            own in self.lost or (found is not None and found[1] in self.lost)
        )

    def numbered(self, name: str, sections: Iterable[str]) -> int:
        """How many names are ``name_1``, ``name_2`` and so on in these sections."""
        held = (tree.get(section) for tree in self.trees for section in sections)
        known = {own.lower() for given in held if isinstance(given, Map) for own in given}
        count = 0
        while f"{name}_{count + 1}".lower() in known:
            count += 1
        return count


@dataclass(frozen=True, slots=True)
class StarNames:
    """The names that a reference stands for; it ``fits`` any number where that is unknown."""

    names: tuple[str, ...]
    has_star: bool = False
    fits: bool = False

    def at(self, number: int) -> str:
        """The name for an element, counted from 0: a reference without star is for all."""
        return self.names[0 if self.fits or not self.has_star else number]


@dataclass(slots=True)
class ArrayNames:
    """The instances of a model and of its components, and the errors in references."""

    top: InstanceLevel
    components: dict[str, InstanceLevel]
    found: list[Diagnostic] = field(default_factory=list)

    @classmethod
    def of(cls, trees: Sequence[Map], *, whole: bool) -> ArrayNames:
        """Those of the files; an instance may be missing unless these are the ``whole`` model."""
        components: dict[str, InstanceLevel] = {}
        for tree in trees:
            section = tree.get("components")
            for name, form in section.items() if isinstance(section, Map) else ():
                if isinstance(form, Map):
                    components.setdefault(name.lower(), InstanceLevel([form], name))
        return cls(InstanceLevel(trees, None, not whole), components)

    @property
    def arrays(self) -> tuple[InstanceArray, ...]:
        """All arrays."""
        levels = (self.top, *self.components.values())
        return tuple(array for level in levels for array in level.arrays.values())

    def error(self, code: str, at: Origin, message: str, hint: str | None = None) -> None:
        """Add what is wrong."""
        self.found.append(error(code, at, message, hint=hint))

    def names(
        self, text: str, at: Origin, level: InstanceLevel, numbered: tuple[str, ...] = ()
    ) -> StarNames | None:
        """The names that a reference stands for; None where that cannot be known.

        The last name may have a star where ``numbered`` has the sections that hold its names.
        """
        *owners, last = text.split(".")
        heads: list[tuple[str, InstanceLevel | None]] = [("", level)]
        fits = False
        for segment in owners:
            inside: list[tuple[str, InstanceLevel | None]] = []
            for head, here in heads:
                names = self._elements(segment, text, at, here)
                if names is None:
                    return None
                fits = fits or names.fits
                inside += [(f"{head}{name}.", self._inside(here, name)) for name in names.names]
            heads = inside
        base = last.removesuffix(ALL)
        if "*" in base or (base != last and not numbered):
            self._malformed(text, at)
            return None
        if base == last:
            return StarNames(tuple(f"{head}{last}" for head, _ in heads), ALL in text, fits)
        made: list[str] = []
        for head, here in heads:
            count = 0 if here is None else here.numbered(base, numbered)
            fits = fits or count == 0
            made += [f"{head}{base}_{number}" for number in range(1, max(count, 1) + 1)]
        return StarNames(tuple(made), has_star=True, fits=fits)

    def size(self, ends: Iterable[tuple[str, Origin, StarNames | None]]) -> int | None:
        """How many elements the references of one entry stand for; None where that is unknown.

        Each is given with its text and place.
        """
        first: tuple[str, int] | None = None
        for text, at, names in ends:
            if names is None:
                return None
            if not names.has_star or names.fits:
                continue
            size = len(names.names)
            if first is not None and size != first[1]:
                message = f"`{first[0]}` has {first[1]} elements, but `{text}` has {size}"
                self.error("RV-0627", at, message, "join arrays of the same size")
                return None
            first = first or (text, size)
        return 1 if first is None else first[1]

    def _malformed(self, text: str, at: Origin) -> None:
        message = f"the star of `{text}` does not stand for the elements of an array"
        hint = "write `name_*.port` for all elements of the array `name`"
        self.error("RV-0306", at, message, hint)

    def _elements(
        self, segment: str, text: str, at: Origin, level: InstanceLevel | None
    ) -> StarNames | None:
        """The instances that a part of a reference stands for."""
        base = segment.removesuffix(ALL)
        if "*" in base:
            self._malformed(text, at)
            return None
        if level is None:  # what is around it is reported where names are looked up
            return StarNames((segment.replace("*", "1"),), base != segment, base != segment)
        array = level.arrays.get(base.lower())
        if base == segment:
            if array is not None and base.lower() not in level.kinds:
                message = f"{array.name} is an array of {array.count} instances"
                hint = f"write `{base}{ALL}` for all elements, or `{base}_1` for the first"
                self.error("RV-0305", at, message, hint)
                return None
            return None if level.is_lost(base) else StarNames((segment,))
        if array is not None:
            return StarNames(array.elements, has_star=True)
        if level.may_have_been(base):
            return None
        if base.lower() in level.kinds:
            message = f"{base} is one instance, not an array"
            self.error("RV-0305", at, message, f"write `{base}`, or give {base} the key `count`")
        else:
            where = "" if level.name is None else f" in {level.name}"
            known = [f"{one.name}{ALL}" for one in level.arrays.values()]
            hint = meant(segment, known) or f"declare the instance {base} with the key `count`"
            self.error("RV-0305", at, f"there is no array named `{base}`{where}", hint)
        return None

    def _inside(self, around: InstanceLevel | None, instance: str) -> InstanceLevel | None:
        """The instances with which references inside an instance begin."""
        kind = None if around is None else around.kinds.get(instance.lower())
        return None if kind is None else self.components.get(kind)


def uses_of_arrays(uses: Iterable[NameUse], arrays: Sequence[InstanceArray]) -> Iterator[NameUse]:
    """The names that were looked up, with the array in place of its elements."""
    known = {array.origin: array.name for array in arrays}
    for use in uses:
        name = known.get(use.declared) if use.declared is not None else None
        yield use if name is None else replace(use, name=name, of_array=True)


def with_stars(unknown: Iterable[Unknown], arrays: Sequence[InstanceArray]) -> Iterator[Unknown]:
    """Candidates in place of unknown names: before the elements of an array all of them."""
    firsts = {array.elements[0]: f"{array.name}{ALL}" for array in arrays}
    for one in unknown:
        known = (name for own in one.known for name in (firsts.get(own), own) if name is not None)
        yield replace(one, known=tuple(known)) if firsts else one
