# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A model checked: its rules, its behaviour, its timing; nothing is written."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from ravenchart.analysis.findings.deadlines import findings
from ravenchart.analysis.system.identifiers import order_of
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.behaviour.limits import EFFORT, Behaviour
from ravenchart.failures import Refused
from ravenchart.gen.derive.identifiers import with_order
from ravenchart.gen.diagnostics import Diagnostic, Sources, render_all
from ravenchart.gen.files import deployments
from ravenchart.gen.files.load import Reader, read_file
from ravenchart.gen.model.places import USUAL, generated_beside, library_beside
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import Loaded, load
from ravenchart.gen.rules.folding import folded

from . import check_cache
from .garbage import without_collector


def is_usual(path: Path) -> bool:
    """Has the main file of a model its usual name?"""
    return path.name.lower() in USUAL


def generated_folder(path: Path) -> str:
    """The folder, beside the main file at ``path``, in which its program is written."""
    main, chosen = deployments.parted(path)
    own = generated_beside(main)
    return own if chosen is None else f"{own}/{deployments.folder_of(chosen)}"


@dataclass(frozen=True, slots=True)
class Checked:
    """A valid, schedulable model, with the warnings that remain."""

    path: Path
    system: System
    analysis: Analysis
    warnings: str
    sources: Sources
    diagnostics: tuple[Diagnostic, ...]
    """The diagnostics that ``warnings`` shows."""
    read: Mapping[str, str]
    """SHA-256 of each file of the model, by its path."""

    @property
    def folder(self) -> Path:
        """The folder of the model file: generated/ and user/ are beside it."""
        return self.path.parent

    @property
    def generated(self) -> Path:
        """Where its program is written: no two main files of a folder have the same place."""
        return self.folder / generated_folder(self.path)

    @property
    def libraries(self) -> tuple[Checked, ...]:
        """The libraries that it uses, each behind those that it uses itself."""
        return tuple(
            replace(self, path=self.folder / library_beside(self.system, one), system=one)
            for one in self.system.libraries
        )

    @property
    def stem(self) -> str:
        """The system's name as its files carry it."""
        return self.system.name.lower()


@without_collector()
def check(
    path: Path,
    *,
    deadlines: bool = True,
    effort: int = EFFORT,
    finish: bool = False,
    read: Reader = read_file,
    library: bool = False,
) -> Checked:
    """Load, check and analyse a model; Refused with every diagnostic when it is wrong.

    ``effort`` limits the situations and questions of the rules of behaviour. Their earlier
    result for the same content is used again; with ``finish``, only if it is finished. ``read``
    reads the files. Without ``library`` a library is refused: it has no instances.
    """
    digests: dict[str, str] = {}

    def noted(file: Path, limit: int) -> bytes:
        content = read(file, limit)
        digests[str(file)] = hashlib.sha256(content).hexdigest()
        return content

    loaded = load(path, noted)
    system = loaded.system
    if system is None:
        raise Refused(_rendered(loaded, loaded.diagnostics), loaded.diagnostics)
    if system.is_library and not library:
        raise Refused(
            f"{path}: error: {system.name} is a library, which has no instances\n"
            "  hint: give the model of a system that includes it"
        )
    system, unordered = with_good_identifiers(system)
    analysis = analyse(system)
    late = (unordered or folded(findings(analysis), system.instances)) if deadlines else ()
    behaviour = _behaviour(loaded.sources, system, effort, finish)
    system = _with_contracts(loaded.sources, system, behaviour, effort)
    everything = (*loaded.diagnostics, *behaviour.found, *late)
    if any(d.is_error for d in everything):
        raise Refused(_rendered(loaded, everything), everything)
    warnings = _rendered(loaded, everything)
    return Checked(path, system, analysis, warnings, loaded.sources, everything, digests)


def _with_contracts(sources: Sources, system: System, behaviour: Behaviour, effort: int) -> System:
    """The system with the invariants for its code; those of a library are the same everywhere."""
    own = {c.name for c in system.own_components}
    safe = [one for one in behaviour.safe if one.component in own]
    libraries: list[System] = []
    for one in system.libraries:
        files = {file for part in (*one.libraries, one) for file in part.files}
        read = {name: lines for name, lines in sources.items() if name in files}
        kept = _behaviour(read, one, effort, finish=False).safe
        theirs = {c.name for c in one.own_components}
        below = tuple(lib for lib in libraries if lib.name in {x.name for x in one.libraries})
        safe += [region for region in kept if region.component in theirs]
        libraries.append(replace(one, safe_regions=kept, libraries=below))
    return replace(system, safe_regions=tuple(safe), libraries=tuple(libraries))


def _behaviour(sources: Sources, system: System, effort: int, finish: bool) -> Behaviour:
    """The result of the rules of behaviour, from now or from an earlier check of this content."""
    key = check_cache.key(sources)
    found = check_cache.load(key, effort, finished=finish)
    if found is None:
        from ravenchart.behaviour import rules  # imports a solver

        found = rules.behaviour(system, effort)
        check_cache.store(key, effort, found)
    return found


def with_good_identifiers(system: System) -> tuple[System, tuple[Diagnostic, ...]]:
    """The system with the identifiers that the analysis finds for buses that ask for it.

    A bus without a good order keeps that by deadline, and there is a diagnostic of it.
    """
    failed: list[Diagnostic] = []
    for bus in system.buses:
        found = order_of(bus, system) if bus.audsley else ()
        if isinstance(found, Diagnostic):
            failed.append(found)
        else:
            system = with_order(system, found)
    return system, tuple(failed)


def _rendered(loaded: Loaded, diagnostics: tuple[Diagnostic, ...]) -> str:
    return render_all(diagnostics, loaded.sources)
