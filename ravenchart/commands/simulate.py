# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart simulate`: a model in virtual time, by its program or by the interpreter.

The program is the generated one without tasks and buses. Its main holds the processors' tables,
reads numbered stimuli from standard input, and calls the rows in the order of
`behaviour.interpreter.machine`. It prints the lines of `StepRecord.text`; those of recorded
values have numbers in place of literals.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.behaviour.interpreter.region import Stuck
from ravenchart.behaviour.interpreter.stimuli import Raised, Stimuli, read_stimuli
from ravenchart.behaviour.interpreter.traces import (
    Played,
    StepRecord,
    ValueRecord,
    parsed_record,
    parsed_value,
)
from ravenchart.behaviour.rules.outside import external_events
from ravenchart.building.checking import Checked
from ravenchart.building.generation import replace_file, without_clashes, write_first_versions
from ravenchart.building.programs import build_home
from ravenchart.failures import OK, Refused, ToolFailed, Unusable
from ravenchart.gen.derive.alone import alone, hindrance
from ravenchart.gen.derive.distribution import as_one
from ravenchart.gen.diagnostics import Diagnostic, error, render, render_all, warning
from ravenchart.gen.emit.commands.lifecycle import RUNTIME_FOLDER, has_lifecycle
from ravenchart.gen.emit.nodes.simulation import numbers
from ravenchart.gen.emit.nodes.simulation import stimuli as stimuli_of_system
from ravenchart.gen.emit.program import simulation, simulation_folders, source_folders
from ravenchart.gen.files.load import LARGEST, read_file
from ravenchart.gen.files.located import lines_of
from ravenchart.gen.language.terms import IntegerType
from ravenchart.gen.model.places import library_beside
from ravenchart.gen.model.system import System
from ravenchart.gen.origins import Origin
from ravenchart.paths import ROOT
from ravenchart.terminal import progress, stages
from ravenchart.tools import children, steps, toolchain

from . import common

NOTHING: Mapping[str, str] = {}


def stimuli_of(system: System, path: Path) -> Stimuli:
    """The stimuli in a file; Refused with everything that is wrong with them."""
    try:
        content = read_file(path, LARGEST + 1)
        if len(content) > LARGEST:
            raise ValueError(f"it is larger than {LARGEST // 2**20} MiB")
        text = content.decode("utf-8").removeprefix("\ufeff")
    except UnicodeDecodeError as problem:
        raise _refused([_unreadable(path, "it is not UTF-8 text")], path, "") from problem
    except (OSError, ValueError) as problem:
        reason = getattr(problem, "strerror", None) or str(problem)
        raise _refused([_unreadable(path, reason)], path, "") from problem
    stimuli, found = read_stimuli(text, str(path), system)
    if stimuli is None:
        raise _refused(found, path, text)
    return stimuli


def _unreadable(path: Path, reason: str) -> Diagnostic:
    message = f"cannot read {path}: {reason[:1].lower()}{reason[1:]}"
    return error("RV-1001", Origin(str(path), 1, 1), message)


def _refused(found: Sequence[Diagnostic], path: Path, text: str) -> Refused:
    sources = {str(path): lines_of(text)} if text else {}
    return Refused(render_all(found, sources), found)


def simulated_by_interpreter(system: System, stimuli: Stimuli) -> list[StepRecord]:
    """The steps that the interpreter executes; Refused when the chart gets stuck."""
    return interpreted(system, stimuli).steps


def interpreted(system: System, stimuli: Stimuli) -> Played:
    """The steps and recorded values of the interpreter; Refused when the chart gets stuck."""
    machine = Machine(as_one(system))
    try:
        with progress("simulate"):
            return Played(list(machine.run(stimuli)), machine.values)
    except Stuck as stuck:
        raise refused_as(stuck) from stuck


def refused_as(stuck: Stuck) -> Refused:
    """The error about a pseudostate that has no way out."""
    hint = "give it a segment with the guard `else`"
    found = error("RV-1007", stuck.origin, str(stuck), hint=hint)
    return Refused(render(found, {}), [found])


def simulated_by_program(checked: Checked, stimuli: Stimuli, instance: str | None = None) -> Played:
    """The steps and recorded values of the generated program, of an ``instance`` alone if given."""
    return executed(checked.system, _built(checked, instance), stimuli)


def played_by_program(
    checked: Checked, instance: str | None = None
) -> Callable[[Stimuli], list[StepRecord]]:
    """The generated program, built: what it executes under stimuli.

    It is apart from others where ``checked`` is an ``instance`` alone.
    """
    return partial(run_simulation, checked.system, _built(checked, instance))


def _built(checked: Checked, instance: str | None) -> Path:
    without_clashes(checked)
    write_first_versions(checked)
    own = "" if instance is None else f"-{instance.lower().replace('.', '-')}"
    return build_simulation(checked.system, checked.folder, build_home(checked, f"simulation{own}"))


def only(checked: Checked, instance: str) -> Checked:
    """The model with one instance alone; Unusable where that is not possible."""
    try:
        found = checked.system.instance(instance)
    except KeyError:
        names = ", ".join(one.name for one in checked.system.instances)
        raise Unusable(f"there is no instance `{instance}`; there are: {names}") from None
    reason = hindrance(found.component)
    if reason is not None:
        raise Unusable(f"{found.name} cannot be executed alone: {reason}")
    return replace(checked, system=alone(checked.system, found.name))


def build_simulation(
    system: System,
    folder: Path,
    home: Path,
    switches: Sequence[str] = (),
    scenario: Mapping[str, str] = NOTHING,
) -> Path:
    """Write and compile the program in virtual time below ``home``; its path.

    The sources that are not generated are below the ``folder`` of the model. ``switches`` and
    ``scenario`` are more arguments of gprbuild, and more scenario variables.
    """
    source = home / "source"
    source.mkdir(parents=True, exist_ok=True)
    files = simulation(system)
    for old in source.iterdir():
        if old.name not in files:
            old.unlink()
    for name, text in files.items():
        replace_file(source / name, text)
    project = next(name for name in files if name.endswith(".gpr"))
    places = [str(place) for place in places_of_user(system, folder)]
    if has_lifecycle(system):
        places.append(str(ROOT / RUNTIME_FOLDER))
    given = {**scenario, "RAVENCHART_USER": ",".join(places)} if places else scenario
    with stages("compile the simulation") as tell:
        taken = steps.Announced(steps.COMPILING, tell).takes
        words = ["-p", "-q", "-j0", steps.OF_GPRBUILD, "-P", project, *switches]
        toolchain.run("gprbuild", words, source, given, taken)
    return home / project.removesuffix(".gpr")


def places_of_user(system: System, folder: Path) -> list[Path]:
    """Where the sources are that are not generated, below the ``folder`` of the model."""
    written = (*source_folders(system), *simulation_folders(system))
    own = [(folder / place).resolve() for place in written]
    libraries = [
        (folder / library_beside(system, one).parent / place).resolve()
        for one in system.libraries
        for place in source_folders(one)
    ]
    return [*own, *libraries]


def run_simulation(system: System, program: Path, stimuli: Stimuli) -> list[StepRecord]:
    """The steps that the compiled program executes under the stimuli."""
    return executed(system, program, stimuli).steps


def executed(system: System, program: Path, stimuli: Stimuli) -> Played:
    """The steps and recorded values of the compiled program under the stimuli."""
    known = {
        (instance.lower(), what.lower()): (number, of_type)
        for number, (instance, what, of_type) in enumerate(stimuli_of_system(system), 1)
    }
    lines = [str(stimuli.until)]
    for entry in stimuli.entries:
        owner, what = entry.receiver
        number, of_type = known[(owner.lower(), what.lower())]
        values = numbers(of_type, entry.value)
        lines.append(" ".join(map(str, (entry.at, number, *values))))
    text = "".join(f"{line}\n" for line in lines)
    with progress("simulate"):
        done = children.run([program], text)
    if done.returncode:
        raise ToolFailed(f"{program.name}: {done.stderr.strip()}")
    steps: list[StepRecord] = []
    recorded: list[ValueRecord] = []
    types = {one.element: one.type for one in system.recorded_values}
    for line in done.stdout.splitlines():
        if ": " in line:
            steps.append(parsed_record(line))
        else:
            found = parsed_value(line)
            number, of_type = int(found.value), types[found.element]
            value = number if isinstance(of_type, IntegerType) else of_type.literals[number]
            recorded.append(replace(found, value=value))
    return Played(steps, recorded)


def left_out(system: System) -> Diagnostic | None:
    """A warning of the activities that the interpreter does not execute: those of the user."""
    rows = [
        (f"{instance.name}.{activity.name}", activity.origin)
        for instance in system.instances
        for activity in instance.component.activities
        if activity.by_user
    ]
    if not rows:
        return None
    names = ", ".join(name for name, _ in rows)
    message = f"the interpreter leaves out what the user writes: {names}"
    hint = (
        "what these write, send and raise is missing from the trace; leave out `--interpreter`: "
        "the program in virtual time executes them"
    )
    return warning("RV-1009", rows[0][1], message, hint=hint)


def interpreted_alone(system: System, hint: str | None = None) -> None:
    """Refused where the interpreter cannot execute the model: it knows no drivers."""
    if system.bindings:
        message = "the interpreter knows no drivers: it executes no models with bindings"
        found = error("RV-1008", system.bindings[0].origin, message, hint=hint)
        raise Refused(render(found, {}), [found])


def unexpected(system: System, stimuli: Stimuli) -> list[Diagnostic]:
    """A warning for each event that comes from outside, which `check` does not reckon with."""
    components = {i.name: i.component for i in system.instances}
    raised = dict.fromkeys((e.instance, e.event) for e in stimuli.entries if isinstance(e, Raised))
    found: list[Diagnostic] = []
    for instance, name in raised:
        component = components[instance]
        if name not in {event for event, _ in external_events(component, system)}:
            origin = next(e.origin for e in component.events if e.name == name)
            message = f"only {component.name} raises {name}, and `check` relies on that"
            hint = f"write `{name}: {{external: true}}` where it may come from outside too"
            found.append(warning("RV-1010", origin, message, hint=hint))
    return found


def simulated(
    checked: Checked,
    events: Path,
    *,
    interpreter: bool,
    as_json: bool,
    instance: str | None = None,
) -> str:
    """The trace of a model under the stimuli of a file, one step a line."""
    if interpreter:
        hint = "leave out `--interpreter`: the program in virtual time has them"
        interpreted_alone(checked.system, hint)
    stimuli = stimuli_of(checked.system, events)
    for one in unexpected(checked.system, stimuli):
        print(render(one, {}), file=sys.stderr)
    if interpreter:
        played = interpreted(checked.system, stimuli)
    else:
        played = simulated_by_program(checked, stimuli, instance)
    return "".join(f"{one.json() if as_json else one.text()}\n" for one in played.lines())


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    common.add_model(sub)
    sub.add_argument(
        "--events",
        type=Path,
        metavar="FILE",
        help="the event file: stimuli with their times; only with --open it may be left out",
    )
    sub.add_argument(
        "--alone",
        metavar="INSTANCE",
        help="only this instance: nothing is connected, and what the user writes has stubs",
    )
    sub.add_argument(
        "--interpreter",
        action="store_true",
        help="execute the model by the interpreter, instead of the generated program",
    )
    sub.add_argument(
        "--open",
        action="store_const",
        const=True,
        dest="page",
        help="execute the charts step by step in a local web page, by the interpreter",
    )
    sub.add_argument(
        "--no-open",
        action="store_const",
        const=False,
        dest="page",
        help="the same, but print the address of the page and open no browser",
    )
    common.add_port(sub)
    sub.add_argument("--json", action="store_true", help="one JSON object for each step")


def execute(options: argparse.Namespace) -> int:
    """Run it in virtual time; the exit status."""
    if options.page is not None:
        return _played(options)
    if options.events is None:
        raise Unusable("`simulate` needs an event file by --events, or --open for a page")
    checked = _chosen(options)
    trace = simulated(
        checked,
        options.events,
        interpreter=options.interpreter,
        as_json=options.json,
        instance=options.alone,
    )
    missing = left_out(checked.system) if options.interpreter else None
    if missing is not None:
        print(render(missing, {}), file=sys.stderr)
    options.answer.lines = trace
    if not options.json:
        print(trace, end="")
    return OK


def _chosen(options: argparse.Namespace) -> Checked:
    """The model, or an instance of it alone."""
    checked = common.checked(options, deadlines=False)
    return checked if options.alone is None else only(checked, options.alone)


def _played(options: argparse.Namespace) -> int:
    """Execute it in a page, until that is stopped; the exit status."""
    from ravenchart.workbench.play.server import PlayHub, PlayPages
    from ravenchart.workbench.play.session import Play

    def made() -> PlayPages:
        system = _chosen(options).system
        hint = "simulate it without --open: the program in virtual time has them"
        interpreted_alone(system, hint)
        stimuli = None if options.events is None else stimuli_of(system, options.events)
        missing = left_out(system)
        text = "" if missing is None else f"{missing.message[:1].upper()}{missing.message[1:]}"
        try:
            play = Play(options.model, system, stimuli, text)
        except Stuck as stuck:
            raise refused_as(stuck) from stuck
        if not play.charts:
            raise Unusable(f"{options.model} has no charts: a page has nothing to show")
        return PlayPages(PlayHub(play))

    common.serve(
        options,
        made,
        browser=options.page,
        what="the charts are at",
        remark="Ctrl-C ends the page. The model is the one that was read at the start.",
    )
    return OK
