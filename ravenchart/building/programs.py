# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The program of each node: where it is built, how it is compiled and proved, with which driver."""

from __future__ import annotations

import hashlib
import re
import shutil
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from ravenchart.analysis.system.observed import read_map
from ravenchart.failures import Refused
from ravenchart.gen.derive.completion import programs
from ravenchart.gen.emit.commands.lifecycle import RUNTIME_FOLDER, has_lifecycle
from ravenchart.gen.emit.commands.registers import HARDWARE, types_with_registers
from ravenchart.gen.emit.nodes.termination import ending_claims, termination_files
from ravenchart.gen.emit.program import (
    folder_of,
    source_folders,
)
from ravenchart.gen.model.system import System
from ravenchart.gen.rules.nodes import BUFFERS, sent_by
from ravenchart.paths import ROOT, work
from ravenchart.proof import ages
from ravenchart.proof.proving import TERMINATION, ProofTask
from ravenchart.stacks.report import Memory

from . import images, stacks, targets
from .checking import Checked, is_usual
from .compilation import Compilation
from .variants import DRIVER_FOLDERS, NATIVE

TRACE_MAP = "trace.json"
"""Beside the generated sources: what the numbers of a trace mean."""
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


def to_standard_error(text: str) -> None:
    """Print what outside programs warn of."""
    print(text, file=sys.stderr)


@dataclass(frozen=True, slots=True)
class Program:
    """The program of one node: where its sources, objects, executable and proof are.

    ``folder`` is below generated/ and below the folder of the objects: "" of the only node.
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

    def home(self, driver: str, target: str = NATIVE) -> Path:
        """Where its objects and the program itself go."""
        return build_home(self.checked, driver, target) / self.folder

    def scenario(self, mode: str, driver: str, target: str = NATIVE) -> dict[str, str]:
        """The scenario variables of a build: mode, CAN driver, and where objects go."""
        home = self.home(driver, target)
        return {"MODE": mode, "CAN_DRIVER": driver, "RAVENCHART_BUILD": str(home)}

    def build(
        self,
        mode: str = "checks",
        driver: str | None = None,
        registers: str = "simulated",
        warn: Callable[[str], None] = to_standard_error,
        board: targets.Board | None = None,
        stacks_needed: bool = True,
        tell: Callable[[str], None] = lambda _: None,
    ) -> Path:
        """Compile it; the path of the executable. ToolFailed with the compiler's words, or
        where the memory of the target has no room for it. Refused where a stack is too small;
        without ``stacks_needed`` stacks are not examined.

        ``warn`` gets the compiler's warnings, and ``tell`` the progress of the build. Without a
        ``board`` it is for this machine.

        Refused where ``driver`` cannot do what the model wants, and with ``registers`` of the
        hardware where a device has no address.
        """
        target = board.target if board else targets.target(NATIVE)
        targets.check_interrupts(target, self.part)
        compilation = self.compilation(mode, driver, registers, board)
        made = compilation.image

        def compiled(*more: str) -> None:
            said = compilation.run(*more, tell=tell)
            if said.strip():
                warn(said.rstrip())

        compiled()
        if target.facts.memory:
            images.check(made, target)
        if stacks_needed:
            tell("bounding the stacks")
            if stacks.without_graph(stacks.objects_of(made)):
                compiled("-f")  # objects of another build, which asked for no call graphs
                stacks.must_have_graphs(stacks.objects_of(made))
            self._examine(made, mode, target, board)
        return made

    def compile(
        self,
        mode: str = "checks",
        warn: Callable[[str], None] = to_standard_error,
        tell: Callable[[str], None] = lambda _: None,
    ) -> Path:
        """Compile a library, which has no main program; the folder of its objects."""
        driver = default_driver(self.checked)
        options = ("-p", "-q", "-j0", "-P", self.project.name)
        home = self.home(driver) / self.checked.stem / mode
        scenario = self.scenario(mode, driver)
        said = Compilation(options, self.project.parent, scenario, home).run(tell=tell)
        if said.strip():
            warn(said.rstrip())
        return home

    def compilation(
        self,
        mode: str = "checks",
        driver: str | None = None,
        registers: str = "simulated",
        board: targets.Board | None = None,
    ) -> Compilation:
        """How `build` calls gprbuild. Refused as there."""
        target = board.target if board else targets.target(NATIVE)
        where = board.place if board else NATIVE
        chosen = driver or default_driver(self.checked, target)
        check_driver(self.checked, chosen, target)
        if registers == HARDWARE:
            self._check_addresses()
        variables = {
            **self.scenario(mode, chosen, where),
            "RAVENCHART_REGISTERS": registers,
        }
        options = ["-p", "-q", "-j0", "-P", self.project.name]
        if board:
            variables |= board.scenario()
            options = [*board.options(), *options]
        report = f"-Wl,--defsym={stacks.PUT_ALL}={stacks.put_all(self.part)}"
        options += ["-cargs:Ada", stacks.CALL_GRAPHS, "-largs", report, "-gargs"]
        image = self.home(chosen, where) / mode / f"{self.checked.stem}_main"
        return Compilation(tuple(options), self.project.parent, variables, image)

    def last_build(self) -> Memory | None:
        """The stacks and the memory of its last build from these sources, if there is one."""
        names = self.generated / TRACE_MAP
        if not names.is_file():
            return None
        if read_map(names.read_text("utf-8"), str(names)).digest != self.checked.system.digest:
            return None  # the model has been changed since it was generated
        file = stacks.record_of(Path(f"{self.checked.stem}_main")).name
        homes = [home / self.folder for home in homes_of(self.checked.path)]
        found = [path for home in homes for path in home.glob(f"*/{file}")]
        newest = sorted(found, key=lambda path: path.stat().st_mtime_ns, reverse=True)
        own = self.digests()
        records = (stacks.read_record(path) for path in newest)
        return next((one for one in records if one.sources == own), None)

    def digests(self) -> dict[str, str]:
        """SHA-256 of each of its Ada sources, by the name from the folder of the model."""
        folders = (self.generated, *self._user_folders(), *self._of_libraries())
        return stacks.digests(folders, self.checked.folder)

    def _examine(
        self, made: Path, mode: str, target: targets.Target, board: targets.Board | None
    ) -> None:
        """Refused where a stack is too small or has no bound."""
        if stacks.is_known(made, target):
            return
        stacks.keep(
            made,
            stacks.examine(
                stacks.BuiltProgram(
                    self.part,
                    made,
                    stacks.objects_of(made),
                    target,
                    mode,
                    f"{board.compiler}-" if board else "",
                    self.checked.sources,
                    self.digests(),
                    self.checked.folder,
                )
            ),
        )

    def _check_addresses(self) -> None:
        """Refused where a device with registers has no address."""
        for device in self.part.devices:
            if device.type is not None and device.type.registers and device.address is None:
                raise Refused(
                    f"{device.origin}: error: the device {device.name} has no address, so its "
                    f"registers are simulated\n{device.origin}: hint: give it `address: ...`, or "
                    "build without `--registers hardware`"
                )

    def proved_units(self) -> tuple[str, ...]:
        """The files that are proved, where others lie beside them: bodies of components of other
        programs, or what reports that a device has failed.

        Empty where there are none of these: then all are. A build takes only what it needs.
        """
        folders = (self.generated, self.generated / HARDWARE, *self._user_folders())
        files = {p.name: p for home in folders for p in home.glob("*.ad[sb]")}
        bodies = {name for name in files if name.endswith(".adb")}
        specs = {name for name in files.keys() - bodies if f"{name[:-1]}b" not in bodies}
        others = {
            name
            for name in bodies
            if f"{name[:-1]}s" not in files
            and re.search(r"^package body", files[name].read_text(encoding="utf-8"), re.M)
        }
        chosen = others or has_lifecycle(self.part)
        return tuple(sorted((bodies | specs) - others)) if chosen else ()

    @property
    def part(self) -> System:
        """The part of the system that the program is made of; a library is one part."""
        if self.checked.system.is_library:
            return self.checked.system
        return next(p for p in programs(self.checked.system) if p.nodes[0].name == self.node)

    def proof(self, driver: str, *, warnings: str = "continue", whole: bool = False) -> ProofTask:
        """The run of gnatprove on it, with the runtime and the HAL again if ``whole``."""
        apart = self.checked.stem if self.checked.system.is_library else ""
        own = self.home(driver) / apart / "checks" / "gnatprove"
        runtime = work() / "obj" / f"checks-{driver}" / "gnatprove"
        read = (self.generated, *self._user_folders(), *self._of_libraries())
        read = (*read, *runtime_folders(driver))
        scenario = self.scenario("checks", driver)
        if has_lifecycle(self.part):
            read = (*read, ROOT / RUNTIME_FOLDER)
        if types_with_registers(self.part):
            read = (*read, self.generated / HARDWARE)
            scenario["RAVENCHART_REGISTERS"] = HARDWARE
        return ProofTask(
            self.project,
            scenario,
            (own, runtime) if whole else (own,),
            read,
            warnings=warnings,
            whole=whole,
            units=self.proved_units(),
        )

    def termination(self, driver: str) -> ProofTask | None:
        """The run of gnatprove on the claims that each execution ends; None where nothing runs.

        Writes the claims, in the words of the gnatprove on PATH.
        """
        if not ending_claims(self.part):
            return None
        main = self.proof(driver)
        home = self.home(driver) / TERMINATION
        declared = ages.age_of(ages.version()).termination
        files = termination_files(self.part, ROOT, self.project, declared)
        shutil.rmtree(home, ignore_errors=True)
        for name, text in files.items():
            (home / name).parent.mkdir(parents=True, exist_ok=True)
            (home / name).write_text(text, encoding="utf-8")
        places = (home, home / "runtime")
        #  gnatprove fails as well where results of the extended projects have open checks
        libraries = (self.home(driver) / one.stem for one in self.checked.libraries)
        emptied = (*main.results, *(one / "checks" / "gnatprove" for one in libraries))
        return ProofTask(
            home / f"{TERMINATION}.gpr",
            main.scenario,
            (*(place / "objects" / "gnatprove" for place in places), *emptied),
            (*places, *main.sources),
            warnings=main.warnings,
            units=tuple(name for name in files if name.endswith(".adb")),
            shows=TERMINATION,
            made=home,
        )

    def _user_folders(self) -> tuple[Path, ...]:
        return tuple(self.checked.folder / place for place in source_folders(self.part))

    def _of_libraries(self) -> tuple[Path, ...]:
        """The folders of the libraries that it uses."""
        found = (Program(one, "", "") for one in self.checked.libraries)
        return tuple(f for one in found for f in (one.generated, *one._user_folders()))


def programs_of(checked: Checked) -> tuple[Program, ...]:
    """The program of each node that runs something; of a library all that it has."""
    if checked.system.is_library:
        return (Program(checked, "", ""),)
    return tuple(
        Program(checked, part.nodes[0].name, folder_of(part, checked.system).rstrip("/"))
        for part in programs(checked.system)
    )


def build_home(checked: Checked, driver: str, target: str = NATIVE) -> Path:
    """The folder of a model's builds for a driver and target, below build/ of `work`."""
    place = driver if target == NATIVE else f"{driver}-{target}"
    return work() / "build" / f"{checked.stem}-{_mark(checked.path)}-{place}"


def homes_of(model: Path) -> list[Path]:
    """All that is built of the model whose main file is at that path, with any driver."""
    return sorted((work() / "build").glob(f"*-{_mark(model)}-*"))


def _mark(model: Path) -> str:
    """A digest of the location of the main file: it distinguishes models of one name."""
    place = model.parent if is_usual(model) else model
    return hashlib.sha256(str(place.resolve()).encode()).hexdigest()[:8]


def default_driver(checked: Checked, target: targets.Target | None = None) -> str:
    """For one node with a bus slcan: python-can talks to it. For several of either what joins one.

    So does one whose transmit buffers are by priority: an slcan adapter has none. On another
    target it is the first of that target's drivers.
    """
    if target is not None and target.name != NATIVE:
        return target.facts.drivers[0]
    if max(len(checked.system.nodes), len(checked.system.buses)) > 1 or _by_priority(checked):
        return "bus"
    return "slcan" if checked.system.buses else "loopback"


NO_FD = ("xilinx",)
"""Drivers of controllers that have no CAN FD."""
ONE_BUS = ("ctucanfd", "xilinx")
"""Drivers that have the controller of one bus of a node."""
BY_PRIORITY = {"loopback": BUFFERS, "bus": BUFFERS, "ctucanfd": 4}
"""Drivers with transmit buffers by priority, and the number of these."""


def _by_priority(checked: Checked) -> str | None:
    """A bus whose controllers have transmit buffers by priority, if there is one."""
    return next((bus.name for bus in checked.system.buses if bus.by_priority), None)


def check_driver(checked: Checked, driver: str, target: targets.Target | None = None) -> None:
    """Refused where the driver is not one of the target's, or cannot do what the model wants."""
    if target is not None and driver not in target.facts.drivers:
        known = ", ".join(target.facts.drivers)
        raise Refused(
            f"ravenchart: error: the target {target.name} has no driver {driver}\n"
            f"  hint: take one of {known}"
        )
    flexible = next((one.name for one in checked.system.buses if one.takes_fd), None)
    if flexible is not None and driver in NO_FD:
        raise Refused(
            f"ravenchart: error: the controllers of the driver {driver} have no CAN FD, and there "
            f"are CAN FD frames on {flexible}"
        )
    for node in checked.system.nodes if driver in ONE_BUS else ():
        buses = [
            bus.name for bus in checked.system.buses if checked.system.joins(bus.name, node.name)
        ]
        if len(buses) > 1:
            raise Refused(
                f"ravenchart: error: the driver {driver} has the controller of one bus, and "
                f"{node.name} is on {' and '.join(buses)}"
            )
    _check_buffers(checked, driver, target)


def _check_buffers(checked: Checked, driver: str, target: targets.Target | None) -> None:
    """Refused where a bus is by priority, and the driver has no buffer for each message."""
    system = checked.system
    for bus in (one for one in system.buses if one.by_priority):
        if driver not in BY_PRIORITY:
            known = [one for one in BY_PRIORITY if target is None or one in target.facts.drivers]
            raise Refused(
                f"ravenchart: error: the driver {driver} sends frames in the order in which they "
                f"come, and {bus.name} has `buffers: priority`\n  hint: take one of "
                f"{', '.join(known)}, or write `buffers: fifo`"
            )
        room = BY_PRIORITY[driver]
        for node in system.nodes:
            sent = len(sent_by(system, node.name, bus))
            if sent > room:
                raise Refused(
                    f"ravenchart: error: {node.name} sends {sent} messages on {bus.name}, which "
                    f"has `buffers: priority`, but the driver {driver} has {room} transmit "
                    f"buffers\n  hint: take another driver, send at most {room} messages, or write "
                    "`buffers: fifo`"
                )
