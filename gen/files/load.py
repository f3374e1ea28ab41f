# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A model's files to checked forms, and what is wrong in them.

The only module that reads files, through the function it is given.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path, PurePath

from ravenchart.gen.diagnostics import Diagnostic, Sources, error
from ravenchart.gen.origins import Origin

from . import deployments
from .arrays import InstanceArray
from .expansion import written_out
from .forms import check
from .libraries import LibraryFiles, LibraryReading
from .located import grow, lines_of
from .schema import ModelFile

LARGEST = 4 * 2**20
"""Bytes of a file at most."""
MOST_FILES = 100
"""Files of a model at most."""

Reader = Callable[[Path, int], bytes]
"""Reads a file, at most so many bytes; raises OSError."""


@dataclass(frozen=True, slots=True)
class Content:
    """The forms of a model's files, main file first; none when that one could not be read.

    ``written`` are they as they were read, ``forms`` without arrays. ``whole`` tells that every
    file could be read; ``digest`` is SHA-256 of all bytes read.
    ``deployment`` is that which was chosen, in lower case.
    """

    forms: tuple[ModelFile, ...]
    whole: bool
    digest: str
    found: tuple[Diagnostic, ...]
    sources: Sources
    deployment: str | None = None
    written: tuple[ModelFile, ...] = ()
    arrays: tuple[InstanceArray, ...] = ()
    libraries: tuple[LibraryFiles, ...] = ()
    """Each behind those that it uses; the last one is the model itself where that is a library."""


def read_file(path: Path, limit: int) -> bytes:
    """The first ``limit`` bytes of a regular file."""
    if path.exists() and not path.is_file():
        raise IsADirectoryError("not a regular file")
    with path.open("rb") as file:
        return file.read(limit)


@dataclass(slots=True)
class _Reading:
    """The files read so far."""

    read: Reader
    chosen: str | None = None
    """The deployment whose file is read as well."""
    forms: list[ModelFile] = field(default_factory=list)
    found: list[Diagnostic] = field(default_factory=list)
    sources: dict[str, tuple[str, ...]] = field(default_factory=dict)
    digest: hashlib._Hash = field(default_factory=hashlib.sha256)
    seen: set[str] = field(default_factory=set)
    libraries: LibraryReading = field(default_factory=LibraryReading)
    whole: bool = True
    """Every file could be read."""

    def take(
        self,
        path: Path,
        origin: Origin | None,
        chain: tuple[tuple[str, str], ...],
        includer: str | None = None,
    ) -> None:
        """Read one file and what it includes; ``chain`` leads to it: (identity, as given).

        ``includer`` is the library of the file that includes it.
        """
        shown = str(path)
        identity = os.path.normpath(os.path.abspath(path))
        at = origin or Origin(shown, 1, 1)
        names = [name for name, _ in chain]
        if identity in names:
            self.whole = False
            circle = [given for _, given in chain[names.index(identity) :]]
            message = f"{shown} includes itself"
            if len(circle) > 1:
                message += f", through {', '.join(circle[1:])}"
            self.found.append(error("RV-0112", at, message, hint="remove this `include`"))
            return
        if identity in self.seen:
            self.libraries.used(identity, includer)
            wrong = self.libraries.misplaced(identity, includer, at)
            self.found += [] if wrong is None else [wrong]
            return
        self.seen.add(identity)
        content = self._content(path, shown, at)
        text = None if content is None else self._text(content, shown, at)
        tree = None
        if text is not None:
            self.sources[shown] = lines_of(text)
            tree, found = grow(text, shown)
            self.found.extend(found)
        if tree is None:
            self.whole = False
            return
        form, found = check(tree)
        self.found.extend(found)
        if form is None:
            self.whole = False
            return
        self.forms.append(form)
        owner = self.libraries.owner(identity, form, includer)
        self.libraries.add(identity, shown, content or b"", owner)
        self.libraries.used(identity, includer)
        self.whole = self.whole and not form.list_damaged("include") and not form.lost("include")
        here = (*chain, (identity, shown))
        files = [(name, form.item_at("include", n)) for n, name in enumerate(form.include or ())]
        if not chain and (form.has("deployments") or self.chosen is not None):
            file = deployments.chosen_file(form, path, self.chosen, self.found)
            files += [] if file is None else [file]
            self.whole = self.whole and file is not None
        for name, included in files:
            if len(self.seen) >= MOST_FILES:
                self.whole = False
                message = f"a model has at most {MOST_FILES} files"
                self.found.append(error("RV-0102", included, message))
                return
            self.take(Path(PurePath(path).parent / name), included, here, owner)
        self.libraries.ended(identity)

    def _content(self, path: Path, shown: str, at: Origin) -> bytes | None:
        """The bytes of a file, or a reported reason why there are none."""
        try:
            content = self.read(path, LARGEST + 1)
        except (OSError, ValueError) as problem:  # ValueError: a NUL in the name
            reason = getattr(problem, "strerror", None) or str(problem)
            message = f"cannot read {shown}: {reason[:1].lower()}{reason[1:]}"
            self.found.append(error("RV-0101", at, message))
            return None
        self.digest.update(content)
        if len(content) > LARGEST:
            hint = "split it, and `include` the parts"
            message = f"{shown} is larger than {LARGEST // 2**20} MiB"
            self.found.append(error("RV-0102", at, message, hint=hint))
            return None
        return content

    def _text(self, content: bytes, shown: str, at: Origin) -> str | None:
        """The text of a file, or a reported reason why it is none."""
        try:
            return content.decode("utf-8").removeprefix("\ufeff")
        except UnicodeDecodeError as problem:
            before = content[: problem.start].decode("utf-8")
            lines = lines_of(before)
            self.sources[shown] = lines_of(content.decode("utf-8", "replace"))
            where = Origin(shown, len(lines), len(lines[-1]) + 1)
            message = f"the byte {content[problem.start]:#04x} is not UTF-8 text"
            hint = "save the file as UTF-8"
            self.found.append(error("RV-0103", where, message, hint=hint))
            return None


def deployments_of(path: Path, read: Reader = read_file) -> tuple[Path, ...]:
    """The path of each deployment of the model at a path; that path itself where it has none."""
    main, chosen = deployments.parted(path)
    forms = read_model(main, read).forms if chosen is None else ()
    names = [name for form in forms[:1] for name in form.deployments or {}]
    return tuple(deployments.at(main, name) for name in names) or (path,)


def read_model(path: Path, read: Reader = read_file) -> Content:
    """The forms of a model whose main file is at ``path``, with what is wrong in form.

    The path may name a deployment of it.
    """
    main, chosen = deployments.parted(path)
    reading = _Reading(read, chosen)
    reading.take(main, None, ())
    main_is_read = bool(reading.forms) and reading.forms[0].origin.file == str(main)
    forms = tuple(reading.forms) if main_is_read else ()
    plain = written_out(forms, whole=reading.whole)
    return Content(
        plain.forms,
        reading.whole,
        reading.digest.hexdigest(),
        (*reading.found, *plain.found),
        reading.sources,
        None if chosen is None else deployments.folder_of(chosen),
        forms,
        plain.arrays,
        reading.libraries.libraries(plain.forms),
    )
