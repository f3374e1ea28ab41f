# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The files of libraries: a file with `library`, and what it includes.

A file belongs to the library whose main file includes it, directly or by another file. A library
that includes a second one uses it; the files of the second one stay its own.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.origins import Origin

from .schema import ModelFile


@dataclass(frozen=True, slots=True)
class LibraryFiles:
    """A library: its forms, main file first, then those of the libraries that it uses.

    ``main`` is the path of its main file, ``files`` the paths of all that belong to it alone, and
    ``uses`` the main files of the libraries that it includes. ``digest`` is SHA-256 of its files.
    """

    main: str
    files: tuple[str, ...]
    uses: tuple[str, ...]
    digest: str
    forms: tuple[ModelFile, ...]


@dataclass(slots=True)
class _Library:
    """A library while it is read."""

    files: list[str] = field(default_factory=list)
    uses: dict[str, None] = field(default_factory=dict)
    digest: hashlib._Hash = field(default_factory=hashlib.sha256)


@dataclass(slots=True)
class LibraryReading:
    """Which library each file belongs to, while files are read.

    Files are named by their identity: the absolute path.
    """

    owners: dict[str, str | None] = field(default_factory=dict)
    """The main file of the library that a file belongs to; None: the model itself."""
    shown: dict[str, str] = field(default_factory=dict)
    found: dict[str, _Library] = field(default_factory=dict)
    """The libraries by their main files, a library behind those that it uses."""

    def owner(self, identity: str, form: ModelFile, includer: str | None) -> str | None:
        """The library of a file, given that of the file which includes it."""
        return identity if form.library is not None or form.lost("library") else includer

    def add(self, identity: str, shown: str, content: bytes, owner: str | None) -> None:
        """A file that was read; that of a library's main file comes first."""
        self.owners[identity], self.shown[identity] = owner, shown
        if owner is not None:
            own = self.found.setdefault(owner, _Library())
            own.files.append(shown)
            own.digest.update(content)

    def used(self, identity: str, includer: str | None) -> None:
        """A library that another one, or the model, includes."""
        if includer is not None and includer != identity and identity in self.found:
            self.found[includer].uses[identity] = None

    def ended(self, identity: str) -> None:
        """All that a main file includes has been read: it stands behind that from now on."""
        if identity in self.found:
            self.found[identity] = self.found.pop(identity)

    def misplaced(self, identity: str, includer: str | None, at: Origin) -> Diagnostic | None:
        """An error where a part of a library is included by what is not part of it."""
        owner = self.owners.get(identity)
        if identity not in self.owners or owner in (identity, includer):
            return None
        named = self.shown[identity]
        if owner is None:
            message = f"{named} is included by the model itself and by a library"
            hint = "a file belongs to one of them: let the model include the library alone"
        else:
            message = f"{named} is part of the library in {self.shown[owner]}"
            hint = f"include {self.shown[owner]}: a library is included whole"
        return error("RV-0803", at, message, hint=hint)

    def libraries(self, forms: Sequence[ModelFile]) -> tuple[LibraryFiles, ...]:
        """All libraries with their forms, each behind those that it uses."""
        by_file = {form.origin.file: form for form in forms}

        def of(owners: Iterable[str]) -> tuple[ModelFile, ...]:
            names = (name for one in owners for name in self.found[one].files)
            return tuple(by_file[name] for name in names if name in by_file)

        return tuple(
            LibraryFiles(
                self.shown[main],
                tuple(one.files),
                tuple(self.shown[used] for used in one.uses),
                one.digest.hexdigest(),
                of((main, *self._below(main))),
            )
            for main, one in self.found.items()
        )

    def _below(self, main: str) -> list[str]:
        """The libraries that one uses, directly or by another."""
        found: dict[str, None] = {}
        waiting = list(self.found[main].uses)
        while waiting:
            one = waiting.pop(0)
            if one not in found:
                found[one] = None
                waiting += self.found[one].uses
        return list(found)
