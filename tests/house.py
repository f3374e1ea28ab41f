# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What `make check` and `make prove` do over the whole checkout.

check: generated/ is what the models give, and every Ada unit compiles without
a warning, with contracts executed and without. prove: gnatprove on the runtime
and the HAL with each driver, on the bus server, on the compiled part of the analysis, on
the examples and on the models of the tests, and the records of it.
"""

from __future__ import annotations

import os
import shutil
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from ravenchart.behaviour.limits import TO_THE_END
from ravenchart.building import checking, generation, programs, variants
from ravenchart.failures import Refused, ToolFailed
from ravenchart.gen.files.load import deployments_of
from ravenchart.paths import ROOT
from ravenchart.proof import ages, outside_spark, proving
from ravenchart.tools import toolchain
from ravenchart.tools.toolchain import ToolMissing
from tests.support import compiler
from tests.support.proof_records import stale_sources

RECORDS = ROOT / "proofs" / "records"
"""A folder for each age of gnatprove."""
OUTSIDE = ROOT / "proofs" / "outside_spark.toml"
"""What may be outside SPARK in each target of ``make prove``, with the entry of the ledger."""

EXAMPLES = (
    "autopilot",
    "canopen_device",
    "cartesian_robot",
    "crossing",
    "fatigue_rig",
    "j1939_node",
    "pump",
    "qhsmtst",
    "seam_tracker",
    "surgical_robot",
    "three_components",
    "two_buses",
    "two_nodes",
)
MODELS = {
    f"{kind}-{path.parent.name}": path.parent
    for kind in ("feature", "nodes", "deployments")
    for path in sorted((ROOT / "tests" / kind).glob("*/model.yaml"))
}
"""The models of the tests: all of them are proved. Their programs are not kept: see `made`."""
DRIVERS = tuple(variants.DRIVER_FOLDERS)
PROVED_WITH = {"bus": ("protocol",)}
"""Folders of hw_can/ that only this driver uses, though every project has them."""
UNITS_PROVED_WITH = {"ctucanfd": ("ravenchart-can-transmit_orders.adb",)}
"""Units of the same kind."""
GENERIC_BODIES = {
    "ravenchart-can-connections.adb",
    "ravenchart-can-controllers-driver.adb",
    "ravenchart-can-ctu_cores.adb",
    "ravenchart-can-xcan_cores.adb",
}
"""Generics and a subunit of one: proved with the instance below, or with one that it brings."""
INSTANCES = ("instance_bus.ads", "instance_program.adb")
"""An instance, and the program with its tasks and those of the processors."""
BUS = "bus"
KERNEL = "analysis-kernel"
FLOATS = "runtime-floats"
"""A part of the runtime that no controller needs: bodies of users call it."""
VALUES = "runtime-values"
"""The part of the runtime that controllers need which record values."""
RECORDING = ("instance_values.ads", "ravenchart-hosts-value_lines.adb")
"""Its units."""
LOGICAL = "runtime-logical"
"""The part of the runtime that controllers need which have logical execution times."""
LOGICAL_UNITS = ("instance_logical.ads", "ravenchart-logical_times.ads")
GATHERED = "runtime-gathered"
"""The part of the runtime that controllers need whose commands go to arrays of tasks."""

EVENTS = "runtime-events"
"""The part of the runtime that controllers need of which events release processors."""
EVENT_UNITS = ("instance_releasing_events.ads",)
INTERRUPTS = "runtime-interrupts"
"""The part of the runtime that controllers need which take interrupts."""
INTERRUPT_UNITS = ("instance_interrupts.ads",)


class UnknownTargetError(ValueError):
    """A name that no target and no group of targets has; the message lists those that there are."""


@dataclass(frozen=True, slots=True)
class Target:
    """One thing to prove: the name of its record, the run, and the folder of its model."""

    name: str
    task: proving.ProofTask
    folder: Path | None = None

    def reasons(self) -> dict[str, str]:
        """Why something of it may be outside SPARK."""
        own = {}
        if self.folder is not None:
            own = outside_spark.reasons_for_model(self.folder, slots=True, interrupts=True)
        return {**outside_spark.reasons_for_target(OUTSIDE, self.name), **own}


def targets(names: Sequence[str] = ()) -> Iterator[Target]:
    """Runtime with each driver, bus server, analysis, examples, models of tests.

    Only those named, if some are; a name is that of a target, an example, a model or a group:
    ``runtime`` (all that no model has made), ``examples``, ``models``. Raises `UnknownTargetError`.
    """
    runtime: dict[str, Callable[[], Target]] = {
        **{f"runtime-{driver}": partial(_runtime, driver) for driver in DRIVERS},
        FLOATS: _floats,
        VALUES: partial(_instances, VALUES, *RECORDING),
        LOGICAL: partial(_instances, LOGICAL, *LOGICAL_UNITS),
        EVENTS: partial(_instances, EVENTS, *EVENT_UNITS),
        INTERRUPTS: partial(_instances, INTERRUPTS, *INTERRUPT_UNITS),
        GATHERED: partial(_instances, GATHERED, "instance_gatherings.ads"),
        BUS: _bus,
        KERNEL: _kernel,
    }
    known = ("runtime", *runtime, "examples", *EXAMPLES, "models", *MODELS)
    if unknown := sorted(set(names) - set(known)):
        raise UnknownTargetError(_unknown(unknown, known))

    def wanted(group: str, name: str) -> bool:
        return not names or group in names or name in names

    for name, target in runtime.items():
        if wanted("runtime", name):
            yield target()
    for example in EXAMPLES:
        if wanted("examples", example):
            yield from _programs(example, ROOT / "examples" / example)
    for model in MODELS:
        if wanted("models", model):
            yield from _programs(model, _copied(model), warnings="continue")


def _unknown(names: Sequence[str], known: Sequence[str]) -> str:
    return f"no target is called {', '.join(names)}; there are {', '.join(known)}"


def made(name: str) -> Path:
    """A model of the tests with its program, as a copy below build/ that is made anew.

    The folder is the same for each checkout, so a record can name what is in it.
    """
    folder = _copied(name)
    _written(folder)
    return folder


def _copied(name: str) -> Path:
    folder = ROOT / "build" / "proved" / name
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(MODELS[name], folder)
    return folder


def _written(folder: Path) -> list[checking.Checked]:
    """The model in a folder, checked in each deployment, and its programs written."""
    paths = deployments_of(folder / "model.yaml")
    found = [checking.check(path, effort=TO_THE_END) for path in paths]
    for checked in found:
        generation.write_program(checked)
    return found


def record_names(name: str, folder: Path) -> tuple[str, ...]:
    """The records of the model in the folder: two, or two for each deployment and node.

    The second of a program shows termination. There is none where bodies are outside SPARK, or
    of a library, where nothing runs.
    """
    generated = folder / "generated"
    homes = sorted(project.parent.relative_to(generated) for project in generated.rglob("*.gpr"))
    own = tuple("-".join((name, *home.parts)) for home in homes)
    parts = {p.parent for p in folder.glob("*/generated/*-*.ads") if p.parent.parent.name != "user"}
    libraries = sorted(project.stem for home in parts for project in home.glob("*.gpr"))
    ends = () if (folder / outside_spark.FILE).is_file() else (f"-{proving.TERMINATION}",)
    both = (f"{one}{end}" for one in own for end in ("", *ends))
    return (*both, *(f"{name}-{library}" for library in libraries))


def _floats() -> Target:
    obj = ROOT / "obj"
    project = ROOT / "ravenchart.gpr"
    task = proving.ProofTask(
        project,
        {"MODE": "checks", "CAN_DRIVER": DRIVERS[0]},
        (obj / f"checks-{DRIVERS[0]}" / "gnatprove",),
        (ROOT, ROOT / "spark_runtime", ROOT / "spark_runtime" / "src"),
        warnings="error",
        units=("ravenchart-ieee_floats.adb",),
    )
    return Target(FLOATS, task)


def _instances(name: str, *units: str) -> Target:
    """A part of the runtime that some controllers need: these units and what they instantiate."""
    obj = ROOT / "obj"
    project = ROOT / "proofs" / "proofs.gpr"
    driver = DRIVERS[0]
    results = (f"proofs-checks-{driver}", f"checks-{driver}")
    task = proving.ProofTask(
        project,
        {"MODE": "checks", "CAN_DRIVER": driver},
        tuple(obj / folder / "gnatprove" for folder in results),
        (project.parent, project.parent / "instances", *programs.runtime_folders(driver)),
        warnings="error",
        whole=True,
        units=units,
    )
    return Target(name, task)


def _bus() -> Target:
    folder, obj = ROOT / "hw_can" / "server", ROOT / "obj"
    task = proving.ProofTask(
        folder / "can_bus.gpr",
        {"MODE": "checks", "CAN_DRIVER": DRIVERS[0]},
        (obj / "bus-checks" / "gnatprove", obj / f"checks-{DRIVERS[0]}" / "gnatprove"),
        (folder, *programs.runtime_folders(DRIVERS[0])),
        warnings="error",
        whole=True,
    )
    return Target(BUS, task)


def _kernel() -> Target:
    folder = ROOT / "analysis" / "kernel"
    results = (ROOT / "obj" / "kernel" / "objects" / "gnatprove",)
    sources = (ROOT, ROOT / "spark_runtime", folder, *(p for p in folder.rglob("*") if p.is_dir()))
    task = proving.ProofTask(
        folder / "kernel.gpr", {}, results, sources, warnings="error", whole=True
    )
    return Target(KERNEL, task)


def _runtime(driver: str) -> Target:
    """All of it with the first driver; with another only what differs."""
    obj = ROOT / "obj"
    project = ROOT / "proofs" / "proofs.gpr"
    folders = (*PROVED_WITH.get(driver, ()), *variants.DRIVER_FOLDERS[driver])
    own = tuple(ROOT / "hw_can" / folder for folder in folders)
    sources = {path.name for folder in own for path in folder.glob("*.ad[sb]")}
    bodies = {name for name in sources if name.endswith(".adb")}
    specs = {name for name in sources - bodies if f"{name[:-1]}b" not in bodies}
    task = proving.ProofTask(
        project,
        {"MODE": "checks", "CAN_DRIVER": driver},
        (obj / f"proofs-checks-{driver}" / "gnatprove", obj / f"checks-{driver}" / "gnatprove"),
        (project.parent, project.parent / "instances", *programs.runtime_folders(driver)),
        warnings="error",
        whole=True,
        units=()
        if driver == DRIVERS[0]
        else (
            *sorted((bodies | specs) - GENERIC_BODIES),
            *UNITS_PROVED_WITH.get(driver, ()),
            *INSTANCES,
        ),
    )
    return Target(f"runtime-{driver}", task)


def _programs(name: str, folder: Path, *, warnings: str = "error") -> Iterator[Target]:
    found = _written(folder)
    for library in {one.path: one for checked in found for one in checked.libraries}.values():
        driver = programs.default_driver(library)
        for program in programs.programs_of(library):
            if library.system.own_components:  # types alone need no proof
                yield Target(f"{name}-{library.stem}", program.proof(driver, warnings=warnings))
    for checked in found:
        driver = programs.default_driver(checked)
        for program in programs.programs_of(checked):
            parts = (name, checked.system.deployment, program.folder)
            target = "-".join(part for part in parts if part)
            yield Target(target, program.proof(driver, warnings=warnings), folder)
            ending = program.termination(driver)
            if ending is not None and not (folder / outside_spark.FILE).is_file():
                yield Target(f"{target}-{proving.TERMINATION}", ending)


def prove(names: Sequence[str]) -> bool:
    """Prove everything, or what is named, and write the records; True when nothing is left.

    With the environment variable FRESH results of earlier proofs are not used. Once the minutes
    of the variable PROOF_MINUTES are over, only what was proved before from the same content is
    taken; what is left is named, and fails where its record is not that of its sources.
    """
    folder = RECORDS / ages.age_of(ages.version()).name
    folder.mkdir(parents=True, exist_ok=True)
    end = time.monotonic() + 60 * float(os.environ.get("PROOF_MINUTES", "inf"))
    clean = True
    for target in targets(names):
        if time.monotonic() > end and not proving.is_kept(target.task):
            clean = _left(folder / f"{target.name}.toml") and clean
            continue
        print(f"proving {target.name} ...", flush=True)
        try:
            proof = proving.prove(target.task, fresh=bool(os.environ.get("FRESH")))
        except proving.NotProved as left:
            print(f"{left}\n{target.name}: {left.proof.summary()}", flush=True)
            clean = False
            continue
        reasons = target.reasons()
        print(f"{target.name}: {proof.summary()}", flush=True)
        for line in outside_spark.lines(proof.results.outside, reasons):
            print(f"  {line}", flush=True)
        (folder / f"{target.name}.toml").write_text(proving.record_text(proof), encoding="utf-8")
        clean = clean and proof.clean and outside_spark.agree(proof.results.outside, reasons)
    return clean


def _left(record: Path) -> bool:
    """Say that there was no time for a target; whether its record is that of its sources."""
    stale = stale_sources(record) if record.is_file() else (record.name,)
    record_is = f"differs: {stale[0]}" if stale else "is that of its sources"
    print(f"{record.stem}: not proved here, the time was over; its record {record_is}", flush=True)
    return not stale


def check(_names: Sequence[str]) -> bool:
    """Generated files up to date, and every build free of warnings."""
    compiler.use()  # `make test` builds the same programs
    fresh = True
    for example in EXAMPLES:
        checked = checking.check(ROOT / "examples" / example / "model.yaml", effort=TO_THE_END)
        if checked.warnings:
            print(checked.warnings, file=sys.stderr)
            fresh = False
        written = generation.write_program(checked)
        if written.changed:
            print(f"{written.folder}: {written.changed} files were not what the model gives")
            fresh = False
        for mode in ("checks", "release"):
            for made in programs.programs_of(checked):
                made.build(mode)
            print(f"{example}: builds without a warning ({mode})", flush=True)
    others = (ROOT / "hw_can" / "server" / "can_bus.gpr", ROOT / "tests" / "ada" / "tests.gpr")
    for mode in ("checks", "release"):
        for project in others:
            options = ["-p", "-q", "-j0", "-P", project.name]
            variables = {"MODE": mode, "CAN_DRIVER": DRIVERS[0]}
            toolchain.run("gprbuild", options, project.parent, variables)
        for driver in DRIVERS[1:]:
            options = ["-p", "-q", "-j0", "-P", "tests.gpr", "can_echo.adb"]
            variables = {"MODE": mode, "CAN_DRIVER": driver}
            toolchain.run("gprbuild", options, ROOT / "tests" / "ada", variables)
        print(f"runtime, HAL, bus and tests: build without a warning ({mode})", flush=True)
    return fresh


def main() -> int:
    """``check``, or ``prove`` and the names of what to prove; the exit status."""
    works: dict[str, Callable[[Sequence[str]], bool]] = {"check": check, "prove": prove}
    work = works[sys.argv[1]]
    try:
        return 0 if work(sys.argv[2:]) else 1
    except (Refused, ToolFailed, UnknownTargetError, outside_spark.WrongList) as failed:
        print(str(failed).rstrip(), file=sys.stderr)
        return 1
    except ToolMissing as missing:
        print(f"ravenchart: error: {missing}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    raise SystemExit(main())
