# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A model from its files to a valid `System`: load, resolve, rules, derive.

Each stage is a folder of `gen`. Names that clash only in the emitted program are looked for where
a program is wanted (`emit.clashes`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from ravenchart.gen.derive.completion import completed
from ravenchart.gen.diagnostics import Diagnostic, Sources, in_order
from ravenchart.gen.files.arrays import uses_of_arrays, with_stars
from ravenchart.gen.files.libraries import LibraryFiles
from ravenchart.gen.files.load import Content, Reader, read_file, read_model
from ravenchart.gen.files.schema import ModelFile
from ravenchart.gen.language.names import Findings, NameUse, Unknown
from ravenchart.gen.model.system import System
from ravenchart.gen.resolve.libraries import check_library
from ravenchart.gen.resolve.system import resolve
from ravenchart.gen.rules.buses import names_in_databases
from ravenchart.gen.rules.cores import shared_across_cores
from ravenchart.gen.rules.folding import folded, folded_elements
from ravenchart.gen.rules.libraries import libraries_are_apart
from ravenchart.gen.rules.logical import visible_at_instants
from ravenchart.gen.rules.sections import sections_are_part_of_tasks
from ravenchart.gen.rules.system import violations


@dataclass(frozen=True, slots=True)
class Loaded:
    """A model: the system when there is no error, the diagnostics, and the lines read."""

    system: System | None
    diagnostics: tuple[Diagnostic, ...]
    sources: Sources
    uses: tuple[NameUse, ...] = ()
    """The names that were looked up, and where each is declared."""
    unknown: tuple[Unknown, ...] = ()
    """The names that are not declared."""


def load(path: Path, read: Reader = read_file) -> Loaded:
    """The model whose main file is at ``path``, with every error and warning in it."""
    content = read_model(path, read)
    findings = Findings(list(content.found))
    system = _read(content, findings)
    findings.items[:] = folded_elements(findings.items, content.arrays)
    if system is not None:
        system = replace(system, deployment=content.deployment)
    diagnostics = in_order(findings.items, content.sources)
    names = (
        tuple(uses_of_arrays(findings.uses, content.arrays)),
        tuple(with_stars(findings.unknown, content.arrays)),
    )
    return Loaded(system, diagnostics, content.sources, *names)


def _read(content: Content, findings: Findings) -> System | None:
    """The system, or the library, that was read.

    A library is valid by itself, so its errors come before those of what uses it.
    """
    libraries: dict[str, System] = {}
    main = content.forms[0].origin.file if content.forms else ""
    for one in content.libraries:
        is_model = one.main == main
        own = findings if is_model else Findings()
        check_library([form for form in one.forms if form.origin.file in one.files], own)
        made = _valid(one.forms, content.whole, one.digest, own)
        if not is_model:
            findings.items += _of_library(own.items, one)
        if made is None:
            return None
        below = (libraries[used] for used in one.uses)
        used = tuple(dict.fromkeys(part for lib in below for part in (*lib.libraries, lib)))
        libraries[one.main] = replace(made, files=one.files, libraries=used)
    if main not in libraries:
        system = _valid(content.forms, content.whole, content.digest, findings)
        made = None if system is None else replace(system, libraries=tuple(libraries.values()))
    else:
        made = libraries[main]
    files = {file for one in content.libraries for file in one.files if one.main != main}
    findings.items[:] = [d for d in findings.items if d.is_error or d.origin.file not in files]
    findings.items += () if made is None else libraries_are_apart(made)
    return None if _has_error(findings) else made


def _of_library(found: Iterable[Diagnostic], library: LibraryFiles) -> Iterator[Diagnostic]:
    """The errors of a library as a system that uses it reports them."""
    main = library.forms[0]
    seen = f"the library {main.library} sees its own files and the libraries that it includes"
    for item in found:
        if item.is_error:
            is_unknown = item.code.startswith("RV-03")
            more = ((main.at_key("library"), seen),) if is_unknown else ()
            yield replace(item, notes=(*item.notes, *more))


def _valid(
    forms: tuple[ModelFile, ...], whole: bool, digest: str, findings: Findings
) -> System | None:
    """The complete system; None where there are errors, which are with the ``findings``."""
    if not forms:
        return None
    resolved = resolve(forms, whole, digest, findings)
    findings.items.extend(violations(resolved))
    findings.items[:] = folded(findings.items, resolved.system.instances)
    if _has_error(findings):
        return None
    system = completed(resolved.system)
    findings.items.extend(names_in_databases(system))
    findings.items.extend(shared_across_cores(system))
    findings.items.extend(visible_at_instants(system))
    findings.items.extend(sections_are_part_of_tasks(system))
    return None if _has_error(findings) else system


def _has_error(findings: Findings) -> bool:
    return any(item.is_error for item in findings.items)
