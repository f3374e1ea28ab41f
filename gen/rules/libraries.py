# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Names of libraries: each is a package of its own beside that of the system."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.language.names import path_name
from ravenchart.gen.language.terms import EnumerationType
from ravenchart.gen.model.system import System
from ravenchart.gen.origins import Origin


def libraries_are_apart(system: System) -> Iterator[Diagnostic]:
    """No library is named like the system, another library, or what their packages declare."""
    taken: dict[str, tuple[str, Origin]] = {}
    for what, name, origin in _names(system):
        taken.setdefault(name.lower(), (what, origin))
    for one in system.libraries:
        what, origin = taken.setdefault(one.name.lower(), ("", one.origin))
        if what:
            message = f"the library {one.name} is named like {what}"
            notes = [(origin, "the other is here")]
            hint = "both become packages of one program: rename one"
            yield error("RV-0304", one.origin, message, notes=notes, hint=hint)
        taken[one.name.lower()] = "another library", one.origin


def _names(system: System) -> Iterator[tuple[str, str, Origin]]:
    """Kind, name and place of each declaration in the root packages, and of each unit below."""
    yield ("the library" if system.is_library else "the system"), system.name, system.origin
    for type_ in system.types:
        yield "a type", type_.name, type_.origin
        if isinstance(type_, EnumerationType):
            yield from (("a literal", one, type_.origin) for one in type_.literals)
    yield from (("a component", one.name, one.origin) for one in system.components)
    yield from (("an instance", path_name(one.name), one.origin) for one in system.instances)
    yield from (("a processor", one.name, one.origin) for one in system.processors)
    yield from (("a bus", one.name, one.origin) for one in system.buses)
    yield from (("a device", one.name, one.origin) for one in system.devices)
