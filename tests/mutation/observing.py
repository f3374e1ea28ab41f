# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What tests see of a broken program: its steps in virtual time, or a run as it is."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import time
from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from random import Random

from ravenchart.analysis.system.observed import Observation, TraceError, read_map, read_trace
from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.behaviour.interpreter.region import Stuck
from ravenchart.behaviour.interpreter.stimuli import Arrived, Raised, Stimuli
from ravenchart.behaviour.interpreter.traces import StepRecord
from ravenchart.building import checking, generation, programs
from ravenchart.commands import simulate
from ravenchart.failures import ToolFailed
from ravenchart.gen.emit.program import units_of_simulation
from ravenchart.gen.language.terms import (
    IntegerType,
    Ns,
    RecordType,
    Scalar,
    ScalarType,
    Type,
    Value,
)
from ravenchart.gen.model.component import Event, Port
from ravenchart.gen.model.instances import End
from ravenchart.gen.model.system import System
from ravenchart.paths import ROOT
from ravenchart.running.controllers import controller
from ravenchart.running.runs import run_controller, run_nodes

from .catalogue import mutants_of
from .mutants import Mutant, text_of

SEEDS = range(4)
"""The first run gets no stimuli, the others random ones."""
VIRTUAL = Ns(4 * 10**9)
SECONDS = 1.5

Process = subprocess.Popen[bytes]


class Observer:
    """Runs the unbroken program once, then says how a broken one differs."""

    def __init__(self, checked: checking.Checked, folder: Path) -> None:
        self.checked = checked
        self.folder = folder

    def prepare(self, executable: Path) -> None:
        """Run the unbroken program."""

    def differs(self, mutant: Mutant, executable: Path) -> str:
        """How the broken program differs; empty when it does not."""
        raise NotImplementedError

    def model_differs(self, system: System) -> str:
        """How a broken model differs; empty when it does not."""
        raise NotImplementedError


def random_stimuli(system: System, seed: int) -> Stimuli:
    """Events and arrivals at random instants, the same for a seed; none for seed 0."""
    rng = Random(seed)
    entries: list[Raised | Arrived] = []
    for at in range(0, VIRTUAL, 10**7):
        for instance in system.instances:
            if seed == 0 or rng.random() > 0.25:
                continue
            sources: list[Event | Port] = [*instance.component.events]
            sources += instance.component.inputs()
            if not sources:
                continue
            chosen = rng.choice(sources)
            value = _value(chosen.type, rng)
            if not isinstance(chosen, Port):
                entries.append(Raised(Ns(at), instance.name, chosen.name, value))
            elif value is not None:
                entries.append(Arrived(Ns(at), End(instance.name, chosen.name), value))
    return Stimuli(tuple(entries), VIRTUAL)


def _value(of_type: Type | None, rng: Random) -> Value | None:
    if of_type is None:
        return None
    if isinstance(of_type, RecordType):
        return tuple((f.name, _scalar(f.type, rng)) for f in of_type.fields)
    return _scalar(of_type, rng)


def _scalar(of_type: ScalarType, rng: Random) -> Scalar:
    if isinstance(of_type, IntegerType):
        near = min(of_type.last, of_type.first + 20)
        return rng.choice((rng.randint(of_type.first, of_type.last), near))
    return rng.choice(of_type.literals)


class Simulated(Observer):
    """Regions by the program in virtual time against the interpreter, the rest by a real run."""

    def __init__(self, checked: checking.Checked, folder: Path) -> None:
        super().__init__(checked, folder)
        self.system = checked.system
        self.stimuli = [random_stimuli(self.system, seed) for seed in SEEDS]
        self.expected = [_records(Machine(self.system).run(s)) for s in self.stimuli]
        self.files = units_of_simulation(self.system)
        self.mutants = {m.key: m for m in mutants_of(self.files)}
        self.home = folder / "simulation"
        self.real = Real(checked, folder)

    def prepare(self, executable: Path) -> None:
        """Both ways; ToolFailed when interpreter and program already differ."""
        self.real.prepare(executable)
        self.program = simulate.build_simulation(self.system, self.checked.folder, self.home)
        if difference := self._difference():
            raise ToolFailed(f"the unbroken program differs: {difference}")

    def differs(self, mutant: Mutant, executable: Path) -> str:
        """The first step that differs."""
        twin = self.mutants.get(mutant.key)
        if twin is None:
            return self.real.differs(mutant, executable)
        path = self.home / "source" / mutant.file
        path.write_text(twin.applied(self.files[mutant.file]))
        try:
            self._build()
            return self._difference()
        except ToolFailed as failed:
            return str(failed).strip().splitlines()[-1]
        finally:
            path.write_text(text_of(self.files[mutant.file]))

    def _build(self) -> None:
        project = f"{self.program.name}.gpr"
        command = ["gprbuild", "-p", "-q", "-P", project]
        if (self.checked.folder / "user").is_dir():
            command.append(f"-XRAVENCHART_USER={self.checked.folder / 'user'}")
        done = subprocess.run(
            command,
            cwd=self.home / "source",
            env={**os.environ, "GPR_PROJECT_PATH": str(ROOT)},
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode != 0:
            raise ToolFailed(done.stderr or done.stdout)

    def model_differs(self, system: System) -> str:
        """The first step of the interpreter that differs."""
        try:
            return self._compared(lambda stimuli: Machine(system).run(stimuli))
        except Stuck as stuck:
            return str(stuck)

    def _difference(self) -> str:
        return self._compared(lambda s: simulate.run_simulation(self.system, self.program, s))

    def _compared(self, run: Callable[[Stimuli], Iterable[StepRecord]]) -> str:
        for stimuli, expected in zip(self.stimuli, self.expected, strict=True):
            found = _records(run(stimuli))
            for one, other in zip(found, expected, strict=False):
                if one != other:
                    return f"{one}, not {other}"
            if len(found) != len(expected):
                return f"{len(found)} steps, not {len(expected)}"
        return ""


def _records(found: Iterable[StepRecord]) -> list[str]:
    return [one.text() for one in found]


def ran(executable: Path, folder: Path, meanwhile: Callable[[Process], None]) -> Observation:
    """What a program has traced when it is ended after ``meanwhile``; TraceError if it fails."""
    trace = folder / "trace.txt"
    trace.unlink(missing_ok=True)
    process = subprocess.Popen(
        [executable],
        env={"RAVENCHART_TRACE": str(trace)},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    meanwhile(process)
    process.send_signal(signal.SIGTERM)
    try:
        status = process.wait(5)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
        raise TraceError("it does not end") from None
    if status != 0:
        raise TraceError(f"it ends with status {status}")
    names = read_map((folder / "model" / "generated" / "trace.json").read_text(encoding="utf-8"))
    return read_trace(trace.read_text(encoding="ascii").splitlines(), names)


class Real(Observer):
    """The program itself for a moment: its transitions in order, and how often rows run."""

    expected: Observation

    def prepare(self, executable: Path) -> None:
        """What the unbroken program does."""
        self.expected = self._observed(executable)

    def _observed(self, executable: Path) -> Observation:
        return ran(executable, self.folder, lambda process: time.sleep(SECONDS))

    def differs(self, mutant: Mutant, executable: Path) -> str:
        """Another transition, another rate, or an end with an error."""
        try:
            seen = self._observed(executable)
        except (TraceError, OSError) as problem:
            return str(problem)
        if not seen.complete:
            return "the run was cut off"
        for region in seen.map.of_kind("region"):
            found, wanted = (
                [r.text for r in o.of("transition", region.name)] for o in (seen, self.expected)
            )
            for one, other in zip(found, wanted, strict=False):
                if one != other:
                    return f"{region.name}: {one}, not {other}"
            if not _near(len(found), len(wanted)):
                return f"{region.name}: {len(found)} transitions, not {len(wanted)}"
        return _other_rate(_rates(seen), _rates(self.expected))


def _rates(seen: Observation) -> Mapping[str, int]:
    return Counter(r.element.name for r in seen.records if r.kind == "activity")


def _other_rate(found: Mapping[str, int], wanted: Mapping[str, int]) -> str:
    for row, count in sorted(wanted.items()):
        if not _near(found.get(row, 0), count):
            return f"{row} ran {found.get(row, 0)} times, not {count}"
    return ""


def _near(found: int, wanted: int) -> bool:
    return abs(found - wanted) <= max(2, 0.3 * wanted)


class Played(Observer):
    """A scenario on the program's bus."""

    def differs(self, mutant: Mutant, executable: Path) -> str:
        """What failed."""
        return self._failures(executable)

    def prepare(self, executable: Path) -> None:
        """ToolFailed when the unbroken program fails its scenario."""
        if failures := self._failures(executable):
            raise ToolFailed(f"the unbroken program fails its scenario: {failures}")

    def _failures(self, executable: Path) -> str:
        generated = self.folder / "model" / "generated"
        outcome = run_controller(
            executable,
            generated / "trace.json",
            next(generated.glob("*.dbc")),
            self.checked.folder / "scenario.yaml",
            None,
            self.folder / "run",
            analysis=self.checked.analysis,
        )
        return "; ".join(outcome.failures)


class PlayedTogether(Observer):
    """A scenario on the bus of several nodes, of which the program of one is broken."""

    def differs(self, mutant: Mutant, executable: Path) -> str:
        """What failed."""
        return self._failures(executable)

    def prepare(self, executable: Path) -> None:
        """Build the programs of the other nodes; ToolFailed when the scenario fails."""
        home = self.folder / "unbroken"
        home.mkdir()
        for source in self.checked.folder.glob("*.yaml"):
            shutil.copy(source, home)
        unbroken = checking.check(home / self.checked.path.name)
        generation.write_program(unbroken)
        self.generated = unbroken.generated
        self.controllers = [controller(made) for made in programs.programs_of(unbroken)]
        #  a host that is busy for a moment can lose a frame of a sound program, too
        failures = ""
        for _ in range(3):
            failures = self._failures(executable)
            if not failures:
                break
        if failures:
            raise ToolFailed(f"the unbroken program fails its scenario: {failures}")

    def _failures(self, executable: Path) -> str:
        broken = self.folder / "model" / "generated" / "trace.json"
        names = broken.read_text(encoding="utf-8")
        controllers = [
            replace(one, executable=executable)
            if one.trace_json.read_text(encoding="utf-8") == names
            else one
            for one in self.controllers
        ]
        outcome = run_nodes(
            controllers,
            self.checked.analysis,
            self.generated,
            self.checked.folder / "scenario.yaml",
            0.0,
            self.folder / "run",
        )
        return "; ".join(outcome.failures)
