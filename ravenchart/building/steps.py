"""What each command does, from model to files; `__main__` only parses and prints."""

from __future__ import annotations

import gc
import hashlib
import os
import re
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from ravenchart.analysis.findings.claims import Unclaimed, claims_of, uncertified
from ravenchart.analysis.findings.deadlines import findings
from ravenchart.analysis.system.identifiers import order_of
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.behaviour import rules
from ravenchart.gen.derive.completion import programs
from ravenchart.gen.derive.identifiers import with_order
from ravenchart.gen.diagnostics import Diagnostic, Sources, in_order, render, render_all
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.clashes import clashes
from ravenchart.gen.emit.program import (
    folder_of,
    generate,
    simulated_drivers,
    source_folders,
    user_units,
)
from ravenchart.gen.model.claims import Claims
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import Loaded, load
from ravenchart.gen.rules.unready import unready
from ravenchart.paths import ROOT, work
from ravenchart.proof.proving import Task

from . import check_cache, toolchain

MANIFEST = "generated.list"
"""SHA-256 and name of each file of the last generation, as `sha256sum` prints them.

Only these files are ever deleted, and an edit of one of them is noticed.
"""
EDITED = ".edited"
"""Ending of the copy that is kept of an edited file."""


DRIVER_FOLDERS = {
    "loopback": ("loopback",),
    "slcan": ("drivers/slcan", "drivers/tcp"),
    "bus": ("drivers/bus", "drivers/tcp"),
    "socketcan": ("drivers/socketcan",),
    "ctucanfd": ("drivers/ctucanfd",),
}
"""The folders of hw_can/ that ravenchart.gpr adds for each driver."""
RUNTIME_FOLDERS = (
    "spark_runtime/src",
    "spark_runtime/native",
    "hw_can/hal",
    "hw_can/protocol",
    "hw_can/simulator",
)
"""The source folders of ravenchart.gpr that every driver has."""


def runtime_folders(driver: str) -> tuple[Path, ...]:
    """Where the sources, projects and configuration pragmas of the runtime and the HAL are."""
    chosen = (f"hw_can/{folder}" for folder in DRIVER_FOLDERS[driver])
    return tuple(ROOT / f for f in (".", "spark_runtime", *RUNTIME_FOLDERS, *chosen))


class Refused(Exception):  # noqa: N818
    """The model has errors; the text is the rendered diagnostics."""


def _is_usual(path: Path) -> bool:
    """Has the main file of a model its usual name?"""
    return path.name.lower() == "model.yaml"


def generated_folder(path: Path) -> str:
    """The folder, beside the main file at ``path``, in which its program is written."""
    return "generated" if _is_usual(path) else f"generated-{path.name.removesuffix('.yaml')}"


@dataclass(frozen=True, slots=True)
class Checked:
    """A valid, schedulable model, with the warnings that remain."""

    path: Path
    system: System
    analysis: Analysis
    warnings: str
    sources: Sources

    @property
    def folder(self) -> Path:
        """The folder of the model file: generated/ and user/ are beside it."""
        return self.path.parent

    @property
    def generated(self) -> Path:
        """Where its program is written: no two main files of a folder have the same place."""
        return self.folder / generated_folder(self.path)

    @property
    def stem(self) -> str:
        """The system's name as its files carry it."""
        return ada_case(self.system.name).lower()


@contextmanager
def _without_collector() -> Iterator[None]:
    """No search for garbage in circles: a large model is searched again whenever it has grown."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


@_without_collector()
def check(
    path: Path,
    *,
    deadlines: bool = True,
    patience: float = rules.SECONDS,
    finish: bool = False,
) -> Checked:
    """Load, check and analyse a model; Refused with every diagnostic when it is wrong.

    ``patience`` is how many seconds the rules of behaviour may take. What they found in the
    same content before is taken again; with ``finish``, unless it was not finished.
    """
    loaded = load(path)
    system = loaded.system
    if system is None:
        raise Refused(_rendered(loaded, loaded.diagnostics))
    system, unordered = identified(system)
    analysis = analyse(system)
    late = (unordered or findings(analysis)) if deadlines else ()
    everything = (*loaded.diagnostics, *_behaviour(loaded, system, patience, finish), *late)
    if any(d.is_error for d in everything):
        raise Refused(_rendered(loaded, everything))
    return Checked(path, system, analysis, _rendered(loaded, everything), loaded.sources)


def _behaviour(
    loaded: Loaded, system: System, patience: float, finish: bool
) -> tuple[Diagnostic, ...]:
    """What the rules of behaviour find, or have found before in the same content."""
    key = check_cache.key(loaded.sources)
    found = check_cache.load(key, patience, finished=finish)
    if found is None:
        found = rules.findings(system, patience)
        check_cache.store(key, patience, found)
    return found


def identified(system: System) -> tuple[System, tuple[Diagnostic, ...]]:
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


def without_clashes(checked: Checked) -> None:
    """Refused where names would clash in the generated program."""
    found = in_order(clashes(checked.system), checked.sources)
    if found:
        raise Refused(render_all(found, checked.sources))


def _rendered(loaded: Loaded, diagnostics: tuple[Diagnostic, ...]) -> str:
    return render_all(diagnostics, loaded.sources)


def claims(checked: Checked) -> Claims:
    """What the program's certificate claims, in ns. Refused when something cannot be shown."""
    gaps = [render(diagnostic, {}) for diagnostic in uncertified(checked.analysis)]
    if gaps:
        raise Refused("\n".join(gaps))
    try:
        return claims_of(checked.analysis)
    except Unclaimed as problem:
        raise Refused(f"{checked.path}: error: {problem}: leave some of its time unused") from None


@dataclass(frozen=True, slots=True)
class Written:
    """What a generation did.

    ``files`` were generated, the manifest not counted; of these ``changed`` have other bytes
    than before. ``edited`` had been changed by hand: their copies lie beside them.
    ``missing`` are the bodies still to write.
    """

    folder: Path
    files: int
    changed: int
    edited: tuple[str, ...]
    missing: tuple[Path, ...]


@_without_collector()
def write_program(checked: Checked) -> Written:
    """Write generated/ beside the model; user/ is never touched.

    Files are replaced only when their bytes differ, so that builds stay
    incremental; files of the last generation that are no longer made go. `Refused` for
    what can be analysed only.
    """
    gaps = [render(diagnostic, {}) for diagnostic in unready(checked.system)]
    if gaps:
        raise Refused("\n".join(gaps))
    without_clashes(checked)
    folder = checked.generated
    folder.mkdir(parents=True, exist_ok=True)
    files = generate(checked.system, claims(checked))
    old = _manifest(folder)
    edited = tuple(n for n, digest in old.items() if _edited(folder / n, digest, files.get(n)))
    for name in edited:
        (folder / name).replace(folder / f"{name}{EDITED}")
    changed = 0
    for name, text in files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        changed += replace_file(folder / name, text)
    digests = {name: _digest(text.encode("utf-8")) for name, text in sorted(files.items())}
    listed = "".join(f"{digest}  {name}\n" for name, digest in digests.items())
    replace_file(folder / MANIFEST, listed)
    for gone in {name for name in old if name not in files}:
        (folder / gone).unlink(missing_ok=True)
        if (folder / gone).parent != folder:
            with suppress(OSError):  # it is not empty, or was never there
                (folder / gone).parent.rmdir()
    write_first_versions(checked)
    units = (checked.folder / name for name in user_units(checked.system))
    missing = tuple(unit for unit in units if not unit.is_file())
    return Written(folder, len(files), changed, edited, missing)


def _manifest(folder: Path) -> dict[str, str]:
    """Name to SHA-256 of each file of the last generation; "" where the list has no digest."""
    if not (folder / MANIFEST).is_file():
        return {}
    lines = (folder / MANIFEST).read_text(encoding="utf-8").splitlines()
    pairs = (line.rpartition("  ")[::2] for line in lines)
    return {name: digest for digest, name in pairs if _is_inside(name)}


def _edited(path: Path, digest: str, text: str | None) -> bool:
    """Whether the file is neither what was generated last time nor ``text``, the new one.

    A generation that was cut short leaves files that are new already.
    """
    if not digest or not path.is_file():
        return False
    found = path.read_bytes()
    return _digest(found) != digest and (text is None or found != text.encode("utf-8"))


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def write_first_versions(checked: Checked) -> None:
    """Make the folders of what the user writes, and simulated devices that are not there yet."""
    for place in source_folders(checked.system):
        (checked.folder / place).mkdir(parents=True, exist_ok=True)
    for name, text in simulated_drivers(checked.system).items():
        if not (checked.folder / name).exists():
            replace_file(checked.folder / name, text)


def _is_inside(name: str) -> bool:
    """Whether a generated file can have that name: one of generated/, or of a node's folder."""
    parts = Path(name).parts
    return len(parts) in (1, 2) and ".." not in parts and not Path(name).is_absolute()


def replace_file(path: Path, text: str) -> bool:
    """Put ``text`` at ``path`` in one step; False when it stands there already.

    The compiler takes a source whose time is the same to the second for the one that it
    compiled. So the file gets the second before this one, or the one after that of the
    file it replaces: what is written later, by the user too, always has another.
    """
    data = text.encode("utf-8")
    stamp = int(time.time()) - 1
    if path.is_file():
        if path.read_bytes() == data:
            return False
        stamp = max(stamp, int(path.stat().st_mtime) + 1)
    beside = path.with_name(f".{path.name}.{os.getpid()}")
    beside.write_bytes(data)
    os.utime(beside, (stamp, stamp))
    beside.replace(path)
    return True


@dataclass(frozen=True, slots=True)
class Program:
    """What runs on one node: where its sources are, its objects, itself and its proof.

    ``folder`` is below generated/ and below the place of the objects: "" of the only node.
    """

    checked: Checked
    node: str
    folder: str

    @property
    def generated(self) -> Path:
        """Its generated sources and its trace map."""
        return self.checked.generated / self.folder

    @property
    def project(self) -> Path:
        """Its GNAT project."""
        return self.generated / f"{self.checked.stem}.gpr"

    def home(self, driver: str) -> Path:
        """Where its objects and the program itself go."""
        return build_home(self.checked, driver) / self.folder

    def scenario(self, mode: str, driver: str) -> dict[str, str]:
        """The scenario variables of a build: mode, CAN driver, and where objects go."""
        return {"MODE": mode, "CAN_DRIVER": driver, "RAVENCHART_BUILD": str(self.home(driver))}

    def build(self, mode: str = "checks", driver: str | None = None) -> Path:
        """Compile it; the path of the executable. ToolFailed with the compiler's words.

        Refused where ``driver`` cannot do what the model wants.
        """
        chosen = driver or default_driver(self.checked)
        check_driver(self.checked, chosen)
        variables = self.scenario(mode, chosen)
        options = ["-p", "-q", "-j0", "-P", self.project.name]
        warnings = toolchain.run("gprbuild", options, self.project.parent, variables)
        if warnings.strip():
            print(warnings.rstrip(), file=sys.stderr)
        return self.home(chosen) / f"{self.checked.stem}_main"

    def proved_units(self) -> tuple[str, ...]:
        """The files that are proved, where bodies of components of other programs lie beside them.

        Empty where there are none of these: then all are. A build takes only what it needs.
        """
        folders = (self.generated, *self._user_folders())
        files = {p.name: p for home in folders for p in home.glob("*.ad[sb]")}
        bodies = {name for name in files if name.endswith(".adb")}
        specs = {name for name in files.keys() - bodies if f"{name[:-1]}b" not in bodies}
        others = {
            name
            for name in bodies
            if f"{name[:-1]}s" not in files
            and re.search(r"^package body", files[name].read_text(encoding="utf-8"), re.M)
        }
        return tuple(sorted((bodies | specs) - others)) if others else ()

    def proof(self, driver: str, *, warnings: str = "continue", whole: bool = False) -> Task:
        """The run of gnatprove on it, with the runtime and the HAL again if ``whole``."""
        own = self.home(driver) / "checks" / "gnatprove"
        runtime = work() / "obj" / f"checks-{driver}" / "gnatprove"
        return Task(
            self.project,
            self.scenario("checks", driver),
            (own, runtime) if whole else (own,),
            (self.generated, *self._user_folders(), *runtime_folders(driver)),
            warnings=warnings,
            whole=whole,
            units=self.proved_units(),
        )

    def _user_folders(self) -> tuple[Path, ...]:
        part = next(p for p in programs(self.checked.system) if p.nodes[0].name == self.node)
        return tuple(self.checked.folder / place for place in source_folders(part))


def programs_of(checked: Checked) -> tuple[Program, ...]:
    """The program of each node that runs something."""
    return tuple(
        Program(checked, part.nodes[0].name, folder_of(part, checked.system).rstrip("/"))
        for part in programs(checked.system)
    )


def build_home(checked: Checked, driver: str) -> Path:
    """What is built of a model, below build/ of the place of work, apart for each driver."""
    place = checked.folder if _is_usual(checked.path) else checked.path
    known = hashlib.sha256(str(place.resolve()).encode()).hexdigest()[:8]
    return work() / "build" / f"{checked.stem}-{known}-{driver}"


def default_driver(checked: Checked) -> str:
    """For one node with a bus slcan: python-can talks to it. For several what joins a bus.

    So does one whose transmit buffers are by priority: an slcan adapter has none.
    """
    if len(checked.system.nodes) > 1 or _by_priority(checked):
        return "bus"
    return "slcan" if checked.system.buses else "loopback"


BY_PRIORITY = ("loopback", "bus")
"""Drivers behind which a controller can offer the most urgent of its frames."""


def _by_priority(checked: Checked) -> str | None:
    """A bus whose controllers have transmit buffers by priority, if there is one."""
    return next((bus.name for bus in checked.system.buses if bus.by_priority), None)


def check_driver(checked: Checked, driver: str) -> None:
    """Refused where the driver cannot do what the model wants."""
    bus = _by_priority(checked)
    if bus is not None and driver not in BY_PRIORITY:
        raise Refused(
            f"ravenchart: error: the driver {driver} sends frames in the order in which they come, "
            f"and {bus} has `buffers: priority`\n  hint: take one of "
            f"{', '.join(BY_PRIORITY)}, or write `buffers: fifo`"
        )
