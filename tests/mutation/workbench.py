# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A copy of a program that can be broken: compiled, proved and run again, then restored."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from threading import Lock

import yaml

from ravenchart.building import checking, generation, programs
from ravenchart.failures import Refused, ToolFailed
from ravenchart.gen.emit.ada.declarations import GenericInstance, Unit
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.walking import names_in
from ravenchart.gen.emit.buses.layout_tables import LAYOUTS
from ravenchart.gen.emit.program import generate, units_of_program, user_units
from ravenchart.paths import ROOT
from ravenchart.proof import ages
from ravenchart.tools.toolchain import ToolMissing, have

from .mutants import Files, Mutant, text_of
from .nodes import bodies, body_of, whole
from .observing import Observer, Simulated

LONGEST = 1200
"""Seconds after which a tool is given up: the mutant counts as not caught by it."""
PATIENCE = 3
"""Seconds that a prover has for a check of a mutant, and for one of the unbroken program
before: with the ten of `make prove`, what a mutant falsifies would cost them all, each time."""


_RULES = Lock()
"""The solver behind the model rules knows one thread at a time."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """Who caught a mutant, in which words; nobody: it survived."""

    by: str | None
    words: str = ""


class Workbench:
    """One program in a folder of its own, without the switches that only look at style.

    A warning or a long line that a break leaves behind would be no merit of the
    checks: neither is an error here.
    """

    def __init__(
        self, model: Path, folder: Path, observer: type[Observer] = Simulated, node: str = ""
    ) -> None:
        """Of a model with several nodes, the program of ``node`` is broken."""
        checked = checking.check(model)
        self.folder = folder
        self.driver = programs.default_driver(checked)
        claims = generation.claims(checked)
        home = f"{node}/" if node else ""
        texts = {
            name.removeprefix(home): text
            for name, text in generate(checked.system, claims).items()
            if name.startswith(home)
        }
        self.units = {
            name.removeprefix(home): unit
            for name, unit in units_of_program(checked.system, claims).items()
            if name.startswith(home)
        }
        self.model = checked.path
        self.files: Files = {**self.units, **_model_files(checked.path)}
        self.source = folder / "model" / "generated"
        self._copy(checked, texts)
        self.project = f"{checked.stem}.gpr"
        self.main = f"{checked.stem}_main"
        self.observer = observer(checked, folder)

    def _copy(self, checked: checking.Checked, files: Mapping[str, str]) -> None:
        for name in ("spark_runtime", "hw_can"):
            shutil.copytree(ROOT / name, self.folder / name, dirs_exist_ok=True)
        for name in ("ravenchart.gpr", "switches.gpr"):
            shutil.copy(ROOT / name, self.folder)
        self.source.mkdir(parents=True, exist_ok=True)
        if user_units(checked.system):
            user = self.source.parent / "user"
            shutil.copytree(checked.folder / "user", user, dirs_exist_ok=True)
        for name, text in files.items():
            (self.source / name).write_text(_plain(text) if name.endswith(".gpr") else text)

    # --- the unbroken program

    def prepare(self) -> None:
        """Compile and run the unbroken program; ToolFailed when it is not clean."""
        self._compile()
        self.observer.prepare(self.executable)

    @property
    def executable(self) -> Path:
        """The built program."""
        return self.folder / "build" / "checks" / self.main

    # --- a broken one

    def try_mutant(self, mutant: Mutant) -> Verdict:
        """Break, ask the compiler, gnatprove and the tests in turn, restore."""
        if mutant.part == "model":
            return self._judged_model(mutant.file, mutant.applied(self.files[mutant.file]))
        with self._broken(mutant) as broken:
            refused = self._refused(mutant, broken)
            seen = "" if refused.by else self.observer.differs(mutant, self.executable)
            return Verdict("tests", seen) if seen else refused

    def refusal(self, mutant: Mutant) -> Verdict:
        """Break, ask the compiler and gnatprove alone, restore."""
        with self._broken(mutant) as broken:
            return self._refused(mutant, broken)

    @contextmanager
    def _broken(self, mutant: Mutant) -> Iterator[str]:
        sound = self.files[mutant.file]
        broken = mutant.applied(sound)
        path = self.source / mutant.file
        path.write_text(broken)
        try:
            yield broken
        finally:
            path.write_text(text_of(sound))

    def run_broken(self, mutant: Mutant) -> str:
        """How the program differs with a break that the compiler lets pass; "" if it does not."""
        with self._broken(mutant):
            self._compile()
            return self.observer.differs(mutant, self.executable)

    def _refused(self, mutant: Mutant, broken: str) -> Verdict:
        try:
            self._compile()
        except ToolFailed as failed:
            return Verdict("compiler", _first(str(failed)))
        try:
            for name in self._focus(mutant):
                place = self._place(name, mutant, broken)
                self.prove([_body(mutant.file)], place, patience=PATIENCE)
            if not self._is_modular(mutant):
                self.prove(self.units_of(mutant), patience=PATIENCE)
        except ToolFailed as failed:
            return Verdict("gnatprove", _first(str(failed)))
        return Verdict(None)

    def _judged_model(self, file: str, broken: str) -> Verdict:
        folder = self.folder / "broken"
        folder.mkdir(exist_ok=True)
        for name, text in _model_files(self.model).items():
            (folder / name).write_text(broken if name == file else text)
        try:
            with _RULES:
                checked = checking.check(folder / self.model.name)
        except Refused as refused:
            return Verdict("model rules", _first_error(str(refused)))
        seen = self.observer.model_differs(checked.system)
        return Verdict("tests", seen) if seen else Verdict(None)

    def _is_modular(self, mutant: Mutant) -> bool:
        """Is all that the mutant can falsify in the subprograms of its focus? Each has a
        contract, and callers know no more."""
        unit = self.units[mutant.file]
        in_body = unit.is_body and unit.name.last != "Codecs"
        return mutant.part == "code" and in_body and body_of(unit, mutant.place) is not None

    def _focus(self, mutant: Mutant) -> list[str]:
        """The subprograms that are asked first."""
        unit = self.units.get(_body(mutant.file))
        if unit is None:
            return []
        if mutant.part == "code":
            #  some have no contract: gnatprove sees their work where they are called
            names = [mutant.place]
            if mutant.place.startswith(("Enter_", "Exit_", "Leave_")):
                names = _firing(unit)
            return [n for n in names if body_of(unit, n) is not None]
        return _firing(unit)

    def _place(self, name: str, mutant: Mutant, broken: str) -> str:
        """Where a subprogram is declared, as gnatprove wants it."""
        body = _body(mutant.file)
        spec = body.removesuffix("b") + "s"
        for file in (spec, body):
            text = broken if file == mutant.file else text_of(self.files.get(file, ""))
            match = re.search(rf"^ *(?:procedure|function) {name}\b", text, re.M)
            if match is not None:
                return f"{file}:{text.count(chr(10), 0, match.start()) + 1}"
        raise ValueError(name)

    def units_of(self, mutant: Mutant) -> list[str]:
        """What is proved again: the unit; for ceilings the tasks and the main."""
        if mutant.part == "model":
            return []
        if mutant.kind == "ceiling":
            tasks = [_body(n) for n, unit in sorted(self.units.items()) if _has_processor(unit)]
            return [*tasks, f"{self.main}.adb"]
        if mutant.kind == "frame" and not self._in_body(mutant):
            return [n for n, unit in sorted(self.units.items()) if _carries(unit)]
        body = _body(mutant.file)
        return [body if body in self.units else mutant.file]

    def _in_body(self, mutant: Mutant) -> bool:
        unit = self.units[mutant.file]
        return unit.is_body and body_of(unit, mutant.place) is not None

    # --- tools

    def _compile(self) -> None:
        self._run(["gprbuild", "-p", "-q", "-j1", "-P", self.project])

    def prove(
        self,
        units: Sequence[str],
        only: str | None = None,
        *,
        jobs: int = 1,
        patience: int | None = None,
    ) -> None:
        """Prove units, or one subprogram of one; ToolFailed with what is left.

        With the switches of the project, as `make prove`, or another time for each prover.
        What earlier runs left unproved would count again: their results go first.
        """
        for old in self.folder.rglob("*.spark"):
            old.unlink()
        command = ["gnatprove", "-P", self.project, "-q", "--output=oneline"]
        command += ages.switches()
        command += [f"-j{jobs}", "-u", *units]
        if only is not None:
            command.append(f"--limit-subp={only}")
        if patience is not None:
            command.append(f"--timeout={patience}")
        self._run(command)

    def _run(self, command: list[str]) -> None:
        if not have(command[0]):
            raise ToolMissing(command[0])
        variables = {"MODE": "checks", "CAN_DRIVER": self.driver}
        variables["RAVENCHART_BUILD"] = str(self.folder / "build")
        environment = {**os.environ, "GPR_PROJECT_PATH": str(self.folder)}
        if command[0] != "gprbuild":
            environment.pop("GPR_CONFIG", None)  # as `toolchain.run`
        done = subprocess.run(
            [*command, *(f"-X{n}={v}" for n, v in variables.items())],
            cwd=self.source,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            timeout=LONGEST,
            check=False,
        )
        if done.returncode != 0:
            raise ToolFailed(done.stdout)


def _has_processor(unit: Unit) -> bool:
    return any(one.node.generic in _PROCESSORS for one in whole(unit).within(GenericInstance))


_PROCESSORS = ref("Ravenchart.Periodic_Processors"), ref("Ravenchart.Sporadic_Processors")


def _carries(unit: Unit) -> bool:
    """Does it send frames, or receive them?"""
    return unit.is_body and ref(LAYOUTS, "Is_Framed") in names_in(unit.item)


def _firing(unit: Unit) -> list[str]:
    """Fire, and the procedures for parts of it where there are many transitions."""
    return [one.name for one in bodies(unit) if one.fires]


def _model_files(model: Path) -> dict[str, str]:
    """The model's file and those that it includes."""
    text = model.read_text(encoding="utf-8")
    others = yaml.safe_load(text).get("include", ())
    return {
        model.name: text,
        **{name: (model.parent / name).read_text(encoding="utf-8") for name in others},
    }


def _first_error(words: str) -> str:
    """The first error of the model rules, without its place."""
    found = re.search(r"error: .*", words)
    return found.group(0) if found else "refused"


def _plain(project: str) -> str:
    """The project without warnings as errors and without rules of layout."""
    switches = "Ravenchart.Program_Switches"
    return project.replace(switches, '("-gnat2012", "-gnatws") & Ravenchart.Mode_Switches')


def _body(file: str) -> str:
    return file.removesuffix("s") + "b" if file.endswith(".ads") else file


def _first(words: str) -> str:
    """The first line that tells an error, without its place."""
    for line in words.splitlines():
        match = re.match(r"(\S+\.ad[bs]):\d+:\d+: (.*)", line)
        if match and "warning:" not in line and "info:" not in line:
            return f"{match.group(1)}: {match.group(2)}"
    return words.strip().splitlines()[-1] if words.strip() else "no words"
