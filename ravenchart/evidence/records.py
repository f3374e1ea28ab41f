# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Proof records, each compared with the sources that are here now."""

from __future__ import annotations

import hashlib
import os
import re
import tomllib
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ravenchart.building.programs import Program
from ravenchart.building.variants import DRIVER_FOLDERS
from ravenchart.gen.emit.commands.registers import HARDWARE
from ravenchart.gen.emit.program import source_folders
from ravenchart.paths import ROOT
from ravenchart.proof.ages import AGES
from ravenchart.proof.proving import TERMINATION
from ravenchart.tools.kept import file_digest

RECORDS = ROOT / "proofs" / "records"
"""Of the examples and of the runtime: a folder for each age of gnatprove."""
ADA = (".ads", ".adb")
DRIVER = "ravenchart-can-controllers-driver.adb"
"""The body of a CAN driver, which a program with a bus instantiates."""
UNKNOWN_TOOL = "gnatprove, version not recorded"


@dataclass(frozen=True, slots=True)
class RecordedEntity:
    """A subprogram or package of a record."""

    name: str
    checks: int
    provers: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class BelievedRecord:
    """A proof record, and why it cannot be believed of the sources that are here."""

    name: str
    tool: str
    checks: int
    proved: int
    outside: tuple[str, ...]
    sources: tuple[tuple[str, str], ...]
    """(name, SHA-256) as recorded; names are relative."""
    entities: tuple[RecordedEntity, ...]
    problems: tuple[str, ...]
    digest: str
    """SHA-256 over all that is recorded."""

    def of_unit(self, unit: str) -> tuple[RecordedEntity, ...]:
        """The records of an Ada unit and of all entities inside it."""
        head = unit.lower()
        names = ((e, e.name.lower()) for e in self.entities)
        return tuple(e for e, name in names if name == head or name.startswith(f"{head}."))


def shown(path: Path, folder: Path) -> str:
    """The name of a file: from the checkout or package, else from the folder of the model."""
    whole = Path(os.path.abspath(path))
    for base in (ROOT, Path(os.path.abspath(folder))):
        if whole.is_relative_to(base):
            return whole.relative_to(base).as_posix()
    return Path(os.path.relpath(whole, os.path.abspath(folder))).as_posix()


def read(path: Path, name: str, folder: Path, shows: str = "") -> BelievedRecord:
    """A record; of one that cannot be read, says too little or ``shows`` less, the problems say so.

    Records of all checks of a program show "".
    """
    try:
        found = tomllib.loads(path.read_text(encoding="utf-8"))
        checks, proved = _count(found, "checks"), _count(found, "proved")
        justified, assumed = _count(found, "justified"), _count(found, "assumed")
        outside = tuple(map(str, found["outside"]))
        sources = {str(key): str(value) for key, value in found["sources"].items()}
        entities = tuple(
            RecordedEntity(str(key), _count(value, "checks"), tuple(map(str, value["provers"])))
            for key, value in found["entities"].items()
        )
        tool = str(found.get("tool") or UNKNOWN_TOOL)
        if found.get("shows", "") != shows:
            raise ValueError("shows")
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        problem = f"the record {name} cannot be read as a proof record"
        return BelievedRecord(name, UNKNOWN_TOOL, 0, 0, (), (), (), (problem,), "")
    named = [(shown(ROOT / key, folder), key, digest) for key, digest in sources.items()]
    problems = (*_numbers(checks, proved, justified, assumed, entities), *_stale(named))
    pairs = tuple((key, digest) for key, _, digest in named)
    text = repr((checks, proved, justified, assumed, outside, pairs, entities, tool))
    digest = hashlib.sha256(text.encode("utf-8")).hexdigest()
    return BelievedRecord(
        name, tool, checks, proved, outside, pairs, entities, tuple(problems), digest
    )


def _count(table: Mapping[str, object], key: str) -> int:
    number = table[key]
    if not isinstance(number, int) or isinstance(number, bool) or number < 0:
        raise ValueError(key)
    return number


def _numbers(
    checks: int, proved: int, justified: int, assumed: int, entities: Sequence[RecordedEntity]
) -> Iterator[str]:
    if not checks:
        yield "the record has no check"
    if proved != checks:
        yield f"{checks - proved} of {checks} checks are not proved"
    if justified:
        yield f"{justified} checks are justified by hand, not proved"
    if assumed:
        yield f"{assumed} statements are assumed (`pragma Assume`)"
    counted = sum(entity.checks for entity in entities)
    if counted > checks:
        yield f"the record lists {counted} checks of subprograms, more than its sum {checks}"


def _stale(named: Iterable[tuple[str, str, str]]) -> Iterator[str]:
    for name, key, wanted in named:
        path = ROOT / key
        if not path.is_file():
            yield f"the proved source {name} is not there"
        elif file_digest(path) != wanted:
            yield f"{name} differs from the source that was proved"


def judged(record: BelievedRecord, problems: Iterable[str]) -> BelievedRecord:
    """The record with more problems."""
    return BelievedRecord(
        record.name, record.tool, record.checks, record.proved, record.outside, record.sources,
        record.entities, (*record.problems, *problems), record.digest,
    )  # fmt: skip


def missing(program: Program, record: BelievedRecord, driver: str) -> Iterator[str]:
    """Sources of a program that the record does not have, with its CAN driver."""
    recorded = {name for name, _ in record.sources}
    body = f"hw_can/{DRIVER_FOLDERS[driver][0]}/{DRIVER}"
    if program.part.messages and body not in recorded:
        yield f"the driver {driver} is not in the proof record"
    for path in own_sources(program):
        name = shown(path, program.checked.folder)
        if name not in recorded:
            yield f"{name} is not in the proof record"


def own_sources(program: Program) -> tuple[Path, ...]:
    """The generated Ada sources of a program, and the user's bodies whose specs are generated."""
    places = (program.generated, program.generated / HARDWARE)
    made = sorted(p for place in places for p in place.glob("*") if p.suffix in ADA)
    specs = {path.stem for path in made if path.suffix == ".ads"}
    users = (program.checked.folder / place for place in source_folders(program.part))
    bodies = sorted(p for place in users for p in place.glob("*.adb") if p.stem in specs)
    return (*made, *bodies)


def of_termination(path: Path) -> Path:
    """The record of termination that lies beside the record of a program."""
    return path.with_name(f"{path.stem}-{TERMINATION}{path.suffix}")


def belongs(path: Path, program: Program) -> bool:
    """Whether a record is that of a program: it was made of its project file."""
    try:
        record = tomllib.loads(path.read_text(encoding="utf-8"))
        found = record["sources"]
    except (OSError, ValueError, KeyError):
        return False
    if "shows" in record:
        return False
    wanted = os.path.abspath(program.project)
    return any(os.path.abspath(ROOT / str(name)) == wanted for name in found)


def of_example(program: Program) -> Path | None:
    """The record of a program of an example in the checkout, where there is one."""
    folder = Path(os.path.abspath(program.checked.folder))
    if program.checked.system.is_library:
        is_one = folder.parent.parent == ROOT / "examples"
        return of_target(f"{folder.parent.name}-{program.checked.stem}") if is_one else None
    if folder.parent != ROOT / "examples" or program.checked.path.name != "model.yaml":
        return None
    name = f"{folder.name}-{program.folder}" if program.folder else folder.name
    return of_target(name)


def of_target(name: str) -> Path | None:
    """The record of a target of ``make prove``, of the youngest gnatprove that has one."""
    paths = (RECORDS / age.name / f"{name}.toml" for age in AGES)
    return next((path for path in paths if path.is_file()), None)


def uncovered(outside: Collection[str], names: Collection[str]) -> tuple[str, ...]:
    """The entities outside SPARK that no name of a list with reasons covers."""
    listed = [re.escape(name.lower()) for name in names]
    covers = re.compile(rf"({'|'.join(listed)})(\..*)?") if listed else None
    return tuple(o for o in outside if covers is None or not covers.fullmatch(o.lower()))
