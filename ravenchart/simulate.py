"""`ravenchart simulate`: a model in virtual time, by its program or by the interpreter.

The program is to be the generated one without tasks and buses: a main that holds
the processors' tables, reads numbered stimuli from standard input, calls the rows
in the order of `behaviour.machine` and prints the lines of `Record.text`. Until it
is generated, only the interpreter runs.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from behaviour.interpreter import Stuck
from behaviour.machine import Machine
from behaviour.stimuli import Stimuli, read
from behaviour.traces import Record
from gen.diagnostics import Diagnostic, error, render
from gen.load import LARGEST, read_file
from gen.model import System
from gen.terms import Origin
from gen.tree import lines_of

from .steps import Checked, Refused


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
    stimuli, found = read(text, str(path), system)
    if stimuli is None:
        raise _refused(found, path, text)
    return stimuli


def _unreadable(path: Path, reason: str) -> Diagnostic:
    message = f"cannot read {path}: {reason[:1].lower()}{reason[1:]}"
    return error("RV-1001", Origin(str(path), 1, 1), message)


def _refused(found: Iterable[Diagnostic], path: Path, text: str) -> Refused:
    sources = {str(path): lines_of(text)} if text else {}
    return Refused("\n".join(render(one, sources) for one in found))


def simulated_by_interpreter(system: System, stimuli: Stimuli) -> list[Record]:
    """What the interpreter executes; Refused when the chart gets stuck."""
    try:
        return list(Machine(system).run(stimuli))
    except Stuck as stuck:
        hint = "give it a segment with the guard `else`"
        raise Refused(render(error("RV-1007", stuck.origin, str(stuck), hint=hint), {})) from stuck


def simulated_by_program(checked: Checked, stimuli: Stimuli) -> list[Record]:
    """What the generated program executes."""
    raise Refused(
        f"{checked.path}: error: the generated program cannot take {len(stimuli.entries)} stimuli "
        "in virtual time yet; use --interpreter"
    )


def simulated(checked: Checked, events: Path, *, interpreter: bool, as_json: bool) -> str:
    """The trace of a model under the stimuli of a file, one step a line."""
    stimuli = stimuli_of(checked.system, events)
    if interpreter:
        records = simulated_by_interpreter(checked.system, stimuli)
    else:
        records = simulated_by_program(checked, stimuli)
    return "".join(f"{one.json() if as_json else one.text()}\n" for one in records)
