# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Names: the rules for them, the names that they would clash with, and the likely name meant."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Generic, Protocol, TypeVar

from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.origins import Origin

IDENTIFIER = r"^[A-Za-z](_?[A-Za-z0-9])*$"
LONGEST_NAME = 60
REQUIREMENT = r"^[A-Za-z0-9]([-_A-Za-z0-9.:/]*[A-Za-z0-9])?$"
"""The id of a requirement, as a list of requirements has it."""
LONGEST_REQUIREMENT = 64
VERSION = r"^[0-9]+(\.[0-9]+){1,2}([-+][-+.A-Za-z0-9]+)?$"
"""The version of a library."""
LONGEST_VERSION = 40
DATABASE_NAME = r"^[_A-Za-z][_A-Za-z0-9]*$"
"""The form of a message's or signal's name in a CAN database (DBC): an identifier of C."""
LONGEST_DATABASE_NAME = 128
LONG_NAME = 24
"""Names up to this length always fit the lines of the generated program."""

_RESERVED = """
abort abs abstract accept access aliased all and array at begin body case constant declare delay
delta digits do else elsif end entry exception exit for function generic goto if in interface is
limited loop mod new not null of or others out overriding package parallel pragma private
procedure protected raise range record rem renames requeue return reverse select separate some
subtype synchronized tagged task terminate then type until use when while with xor
"""
RESERVED = frozenset(_RESERVED.split())
"""The reserved words of Ada 2012 and 2022."""

_PREDEFINED_TYPES = """
boolean character wide_character wide_wide_character duration float long_float long_long_float
short_float integer long_integer long_long_integer long_long_long_integer short_integer
short_short_integer natural positive string wide_string wide_wide_string universal_integer
universal_real system ada standard interfaces gnat ascii ravenchart constraint_error
program_error storage_error tasking_error
"""
PREDEFINED_TYPES = frozenset(_PREDEFINED_TYPES.split())
"""Names that a type would hide from the generated program."""

_DATABASE_KEYWORDS = """
BA_ BA_DEF_ BA_DEF_DEF_ BA_DEF_DEF_REL_ BA_DEF_REL_ BA_DEF_SGTYPE_ BA_REL_ BA_SGTYPE_ BO_ BO_TX_BU_
BS_ BU_ BU_BO_REL_ BU_EV_REL_ BU_SG_REL_ CAT_ CAT_DEF_ CM_ ENVVAR_DATA_ EV_ EV_DATA_ FILTER NS_
NS_DESC_ SGTYPE_ SGTYPE_VAL_ SG_ SG_MUL_VAL_ SIGTYPE_VALTYPE_ SIG_GROUP_ SIG_TYPE_REF_ SIG_VALTYPE_
VAL_ VAL_TABLE_ VERSION Vector__XXX
"""
DATABASE_KEYWORDS = frozenset(_DATABASE_KEYWORDS.split())
"""Words that have a meaning in a DBC: no element in it has such a name."""

GNAT_PREFIXES = frozenset("agis")
"""Parents of GNAT's own units in names of files: `a-*` is a child of Ada, `g-*` one of GNAT."""

CHILDREN = {
    "timing_certificate": "the timing certificate",
    "messages": "the package of the CAN messages",
    "trace": "the trace",
    "hosts": "the package of the host's services",
    "main": "the main program",
    "device_lifecycle": "the package that starts and ends devices",
    "types": "the package of the model's types",
}
"""Child packages that every system has, by lower-case name."""

_HIDING = "ada system standard interfaces ravenchart boolean natural positive string true false"
HIDING = frozenset(_HIDING.split())
"""Names that the generated program uses everywhere: no name in it can hide them."""

T = TypeVar("T")


def problem_of(name: str) -> tuple[str, str] | None:
    """(code, message) when ``name`` cannot name anything; None when it can."""
    if len(name) > LONGEST_NAME:
        return "RV-0301", f"a name has at most {LONGEST_NAME} characters, this one has {len(name)}"
    if not re.fullmatch(IDENTIFIER, name):
        return "RV-0301", (
            f"`{name}` is not a name: letters, digits and single underscores, "
            "first a letter, last no underscore"
        )
    if name.lower() in RESERVED:
        return "RV-0302", f"`{name}` is a reserved word of Ada"
    return None


def path_name(path: str) -> str:
    """The path of an instance as one name: ``arm.shoulder`` as ``arm_shoulder``."""
    return path.replace(".", "_")


def database_problem_of(name: str) -> str | None:
    """Why ``name`` cannot name a message or signal of a CAN database (DBC); None when it can."""
    if len(name) > LONGEST_DATABASE_NAME:
        most = LONGEST_DATABASE_NAME
        return f"a name in databases has at most {most} characters, this one has {len(name)}"
    if not re.fullmatch(DATABASE_NAME, name):
        return (
            f"`{name}` is not a name in databases: letters, digits and underscores, first no digit"
        )
    return f"`{name}` is a keyword of DBC files" if name in DATABASE_KEYWORDS else None


def database_text_problem_of(text: str) -> str | None:
    """Why ``text`` cannot name a value in a CAN database (DBC); None when it can."""
    if not 0 < len(text) <= LONGEST_DATABASE_NAME:
        return f"the name of a value in databases has 1 to {LONGEST_DATABASE_NAME} characters"
    if not (text.isascii() and text.isprintable()) or '"' in text or "\\" in text:
        return 'the name of a value in databases is printable ASCII, without `"` and `\\`'
    return None


class InDatabases(Protocol):
    """An element that CAN databases may call by a name of its own."""

    @property
    def database_name(self) -> str | None:
        """The name that the model gives for databases, if it does."""

    @property
    def in_database(self) -> str:
        """The name in databases."""


Named = TypeVar("Named", bound=InDatabases)


def alike_in_databases(
    elements: Iterable[Named], taken: Iterable[str] = ()
) -> Iterator[tuple[Named, Named | None]]:
    """Each element whose `database_name` another one has; None for one of the names ``taken``."""
    known: dict[str, Named | None] = dict.fromkeys(taken)
    for one in sorted(elements, key=lambda one: one.database_name is not None):
        other = known.setdefault(one.in_database, one)
        if one.database_name is not None and other is not one:
            yield one, other


def nearest(name: str, known: Iterable[str]) -> str | None:
    """The known name of which an unknown one may be a slip; None where none is near."""
    lowered = {item.lower(): item for item in dict.fromkeys(known)}
    near = difflib.get_close_matches(name.lower(), lowered, n=1, cutoff=0.6)
    return lowered[near[0]] if near else None


def nearest_hint(name: str, known: Iterable[str]) -> str | None:
    """A hint for an unknown name: the nearest one; None where none is near."""
    near = nearest(name, known)
    return None if near is None else f"did you mean `{near}`?"


def meant(name: str, known: Iterable[str]) -> str | None:
    """A hint for an unknown name: the nearest one, or else the few that there are."""
    names = list(dict.fromkeys(known))
    if (hint := nearest_hint(name, names)) is not None:
        return hint
    return f"one of: {', '.join(names)}" if 0 < len(names) <= 12 else None


@dataclass(frozen=True, slots=True)
class NameUse:
    """A name that is used: what it names, and where that is declared.

    ``origin`` is where the text begins that holds it, as in ``instance.port``: of two uses there
    the earlier stands first. ``declared`` is None of what no file declares; with ``within`` it
    is where the type begins that lists the name. ``of_array``: behind the name stand an underscore
    and a number or a star.
    """

    name: str
    origin: Origin
    kind: str
    declared: Origin | None
    within: bool = False
    of_array: bool = False


@dataclass(frozen=True, slots=True)
class Unknown:
    """A name that is not declared, and the names that could stand there."""

    name: str
    kind: str
    known: tuple[str, ...]


@dataclass(slots=True)
class Findings:
    """The diagnostics of one model, as they are found, and the names that were looked up.

    ``losses`` counts what was left out without a word, since it refers to what
    was reported already.
    """

    items: list[Diagnostic] = field(default_factory=list)
    losses: int = 0
    uses: list[NameUse] = field(default_factory=list)
    unknown: list[Unknown] = field(default_factory=list)

    def error(
        self,
        code: str,
        origin: Origin,
        message: str,
        *,
        notes: Iterable[tuple[Origin, str]] = (),
        hint: str | None = None,
    ) -> None:
        """Add an error."""
        self.items.append(error(code, origin, message, notes=notes, hint=hint))

    def lose(self) -> None:
        """Something is left out."""
        self.losses += 1

    def count(self) -> int:
        """How much is wrong by now; while it stays the same, what was read is complete."""
        return len(self.items) + self.losses


@dataclass(slots=True)
class NameScope(Generic[T]):
    """The names of one kind that can be used in one place, without regard to case.

    A name may be declared without an item: its declaration was wrong and
    reported, and its uses are silent.
    """

    kind: str
    items: dict[str, tuple[str, Origin | None, T | None]] = field(default_factory=dict)
    open: bool = False
    """Some declarations were lost without their names: unknown names are silent."""

    def declare(
        self, name: str, origin: Origin | None, item: T | None, findings: Findings | None = None
    ) -> bool:
        """Add a name; a second one of that name is reported and not added."""
        known = self.items.get(name.lower())
        if known is not None:
            if findings is not None and origin is not None:
                notes = [] if known[1] is None else [(known[1], "the first is here")]
                message = f"a second {self.kind} is named `{name}`"
                if known[0] != name:
                    message += f", like `{known[0]}`: case does not count"
                findings.error("RV-0303", origin, message, notes=notes, hint="rename one of them")
            return False
        self.items[name.lower()] = (name, origin, item)
        return True

    def names(self) -> list[str]:
        """The names as declared."""
        return [name for name, _, _ in self.items.values()]

    def sound(self) -> tuple[T, ...]:
        """The sound items, in order of declaration."""
        return tuple(item for _, _, item in self.items.values() if item is not None)

    def has_lost(self) -> bool:
        """Whether some declaration was wrong."""
        return self.open or any(item is None for _, _, item in self.items.values())

    def find(self, name: str) -> T | None:
        """The item of that name, if there is one that is sound."""
        known = self.items.get(name.lower())
        return None if known is None else known[2]

    def knows(self, name: str) -> bool:
        """Whether the name is declared, soundly or not."""
        return self.open or name.lower() in self.items

    def used(self, name: str, origin: Origin, findings: Findings) -> None:
        """Note that the name is used there, for those who follow names."""
        known = self.items.get(name.lower())
        if known is None:
            findings.unknown.append(Unknown(name, self.kind, tuple(self.names())))
        else:
            findings.uses.append(NameUse(known[0], origin, self.kind, known[1]))

    def _meant(self, name: str) -> str | None:
        """A hint for an unknown name; where only built-in ones are known, to declare it."""
        near = meant(name, self.names())
        items = self.items.values()
        built_in = items and all(origin is None and item is not None for _, origin, item in items)
        if built_in and nearest(name, self.names()) is None:
            return f"declare it in `{self.kind}s:`"
        return near

    def look_up(self, name: str, origin: Origin, findings: Findings) -> T | None:
        """The item of that name; reported when the name is not declared."""
        self.used(name, origin, findings)
        if not self.knows(name):
            message = f"there is no {self.kind} named `{name}`"
            findings.error("RV-0305", origin, message, hint=self._meant(name))
        found = self.find(name)
        if found is None:
            findings.lose()
        return found
