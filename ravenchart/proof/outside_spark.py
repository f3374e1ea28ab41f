# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The units and subprograms that may be outside SPARK, each with the reason: a TOML file.

gnatprove makes no checks of them, so all checks may be proved although nothing is shown of them.
So each of them is named here, or the proof fails::

    "Demo.Sensor.Activities.Read" = "reads a register; covered by test T-12"

A name covers all declarations inside it.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from ravenchart.failures import Failure
from ravenchart.gen.derive.crossing import has_slots
from ravenchart.gen.model.system import System

from .spark_results import Outside

FILE = "outside_spark.toml"
"""Its name, beside a model."""

OF_SLOTS = {
    "Ravenchart.Crossing_Boards.Slots": "ASM-023",
    "Ravenchart.Crossing_Queues.Slots": "ASM-023",
    "Ravenchart.Shared_Slots": "ASM-023",
}
"""Parts of the runtime in programs whose mailboxes have slots, with the entry of assumptions.md."""
OF_INTERRUPTS = {"Ravenchart.Interrupt_Sources": "ASM-024"}
"""Those in programs that take interrupts."""


class WrongList(Failure):
    """The file is no list of names with reasons; the text says where and why."""


def reasons_for_model(folder: Path, *, slots: bool, interrupts: bool) -> dict[str, str]:
    """Name to reason for a model in ``folder``.

    ``slots``: its programs have mailboxes of slots; ``interrupts``: they take interrupts.
    """
    path = folder / FILE
    own = _reasons(path, _table(path)) if path.is_file() else {}
    return {**(OF_SLOTS if slots else {}), **(OF_INTERRUPTS if interrupts else {}), **own}


def reasons_of(system: System, folder: Path) -> dict[str, str]:
    """Name to reason for the programs of a system, whose model is in ``folder``."""
    interrupts = any(node.interrupts for node in system.nodes)
    return reasons_for_model(folder, slots=has_slots(system), interrupts=interrupts)


def reasons_for_target(path: Path, target: str) -> dict[str, str]:
    """Name to reason for one target of ``make prove``: a table of the file."""
    table = _table(path).get(target, {})
    if not isinstance(table, dict):
        raise WrongList(f"{path}: error: expected a table [{target}]")
    return _reasons(path, table)


def _table(path: Path) -> dict[str, object]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as problem:
        raise WrongList(f"{path}: error: {problem}") from None


def _reasons(path: Path, table: Mapping[str, object]) -> dict[str, str]:
    reasons = {}
    for name, reason in table.items():
        if not isinstance(reason, str) or not reason.strip():
            raise WrongList(f'{path}: error: {name} has no reason: write "{name}" = "why"')
        reasons[name] = reason
    return reasons


def _covers(name: str, found: Outside) -> bool:
    return f"{found.name.lower()}.".startswith(f"{name.lower()}.")


def refused(found: Sequence[Outside], reasons: Mapping[str, str]) -> tuple[Outside, ...]:
    """The entities outside SPARK that are not in the list."""
    return tuple(o for o in found if not any(_covers(name, o) for name in reasons))


def own_names(names: Iterable[str]) -> tuple[str, ...]:
    """The names that the list beside a model gives; not those of the runtime."""
    return tuple(name for name in names if name not in {**OF_SLOTS, **OF_INTERRUPTS})


def listed(found: Sequence[Outside], reasons: Mapping[str, str]) -> tuple[Outside, ...]:
    """The entities outside SPARK that the list beside a model names."""
    own = own_names(reasons)
    return tuple(o for o in found if any(_covers(name, o) for name in own))


def idle(found: Sequence[Outside], reasons: Mapping[str, str]) -> tuple[str, ...]:
    """Names of the list that cover nothing; those of the runtime need not."""
    return tuple(name for name in own_names(reasons) if not any(_covers(name, o) for o in found))


def agree(found: Sequence[Outside], reasons: Mapping[str, str]) -> bool:
    """Whether the list names what is outside SPARK, and nothing else."""
    return not refused(found, reasons) and not idle(found, reasons)


def lines(found: Sequence[Outside], reasons: Mapping[str, str]) -> list[str]:
    """Each name of the list with its reason, then what is refused, then what covers nothing."""
    used = [name for name in reasons if any(_covers(name, o) for o in found)]
    return [
        *(f"outside SPARK: {name} ({reasons[name]})" for name in used),
        *(
            f"error: {o.name} ({o.location}) is outside SPARK: no check of its body is made\n"
            f"  hint: write `with SPARK_Mode`, or name it with a reason in {FILE}"
            for o in refused(found, reasons)
        ),
        *(
            f"error: {name} stands in {FILE}, but nothing of that name is outside SPARK\n"
            "  hint: delete the line"
            for name in idle(found, reasons)
        ),
    ]
