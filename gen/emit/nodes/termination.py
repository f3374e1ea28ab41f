# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The claims that every execution ends: a unit beside a program, written to be proved.

It calls each row of each processor, and whatever else a processor calls, in a procedure of its
own that is declared to terminate (SPARK Reference Manual, 6.1). So gnatprove must show that each
loop and each recursion below has an end. No program contains the unit, for the ages of gnatprove
declare termination in ways that exclude each other.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

from ravenchart.gen.emit.ada.declarations import (
    SPARK,
    Aspect,
    Decl,
    Package,
    Param,
    Subprogram,
    Unit,
    UseType,
)
from ravenchart.gen.emit.ada.expressions import equal, number
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import (
    ada_case,
    processor_package,
    root_package,
    row_name,
)
from ravenchart.gen.emit.ada.statements import Pragma, Stmt, do
from ravenchart.gen.emit.ada.text import print_unit
from ravenchart.gen.emit.tables.executions import ELEMENT_ID, EXECUTED
from ravenchart.gen.model.system import Processor, System
from ravenchart.gen.origins import Origin

from .deployment import row_call, row_unit
from .project import TERMINATING_RUNTIME, termination_projects

UNIT = "Termination"
_HEADER = (
    "Written by `ravenchart prove` of the model of {system}: claims that every execution ends. No "
    "part of the program."
)
SLOTS = "ravenchart-shared_slots.ads"
"""The unit of the runtime below rows whose body is outside SPARK: it is assumed to return."""
_PROCEDURE = re.compile(r"(   procedure (\w+) \([^)]*\)\n   with )(Global => \([^)]*\));")


class TerminationForm(Enum):
    """How a subprogram is declared to terminate."""

    ANNOTATION = "Terminating"
    """An annotation: gnatprove of GNAT 12."""
    ASPECT = "Always_Terminates"
    """The aspect: gnatprove of GNAT 13 and later."""


@dataclass(frozen=True, slots=True)
class EndingClaim:
    """A claim that one execution ends."""

    entity: str
    """The procedure of the claim: ``Plant.Termination.Of_Control.Tank_Level``."""
    element: str
    """The row or processor of the model."""
    origin: Origin


def unit_name(system: System) -> DottedName:
    """The package of the claims."""
    return ref(root_package(system), UNIT)


def ending_claims(part: System) -> tuple[EndingClaim, ...]:
    """The claims about a program, in the order of its processors; a library has none."""
    return tuple(claim for one in part.processors for claim, _ in _claims(part, one))


def declared_to_end(slots: str, form: TerminationForm) -> str:
    """The spec `SLOTS` with its two procedures declared to terminate (ASM-023)."""
    if form is TerminationForm.ASPECT:
        return _PROCEDURE.sub(rf"\1{form.value}, \3;", slots)
    claim = f"   pragma Annotate (GNATprove, {form.value}, \\2);"
    return _PROCEDURE.sub(rf"\1\3;\n{claim}", slots)


def termination_files(
    part: System, root: Path, project: Path, form: TerminationForm
) -> dict[str, str]:
    """File name to text: the unit of the claims, and the projects to prove it with.

    ``root`` is the folder of the runtime, and ``project`` the project of the program. Both are
    extended, so that a spec of the runtime can be another one here.
    """
    header, name = _HEADER.format(system=part.name), unit_name(part)
    specs: list[Decl] = [UseType(ELEMENT_ID)]
    bodies: list[Decl] = []
    for processor in part.processors:
        found = [sub for _, sub in _claims(part, processor)]
        home = ref(_home(processor))
        specs.append(Package(home, tuple(_specs(found, form))))
        bodies.append(Package(home, tuple(map(_body, found)), is_body=True))
    withs = {processor_package(part, one) for one in part.processors} | {ref("Ravenchart")}
    rows = {row_unit(part, slot) for one in part.processors for slot in one.slots}
    spec = Package(name, tuple(specs), (SPARK,))
    body = Package(name, tuple(bodies), (SPARK,), is_body=True)
    units = Unit(header, tuple(sorted(withs)), spec), Unit(header, tuple(sorted(rows)), body)
    files = {unit.file_name: print_unit(unit) for unit in units}
    slots = (root / "spark_runtime" / "src" / SLOTS).read_text(encoding="utf-8")
    own, of_runtime = termination_projects(part, UNIT, root, project)
    return {
        **files,
        f"{UNIT.lower()}.gpr": own,
        f"runtime/{TERMINATING_RUNTIME.lower()}.gpr": of_runtime,
        f"runtime/{SLOTS}": declared_to_end(slots, form),
    }


def _home(processor: Processor) -> str:
    """The package of the claims about a processor."""
    return f"Of_{ada_case(processor.name)}"


def _claims(part: System, processor: Processor) -> Iterator[tuple[EndingClaim, Subprogram]]:
    """Each claim about a processor with its procedure. Rows have names with an underscore."""
    package = processor_package(part, processor)
    before = (Aspect("Pre", equal(ref("Executed"), number(0))),)
    item = Param("Item", "in", ref(package, "Row"))
    used = Param("Used", "in", "Ravenchart.Nanoseconds")

    def claimed(
        name: str, element: str, origin: Origin, params: tuple[Param, ...], call: Stmt
    ) -> tuple[EndingClaim, Subprogram]:
        entity = ref(unit_name(part), _home(processor), name).text
        aspects = before if params == (EXECUTED,) else ()
        claim = EndingClaim(entity, element, origin)
        return claim, Subprogram(name, params, aspects=aspects, body=(call,))

    for slot in processor.slots:
        yield claimed(row_name(slot), slot.element, slot.origin, (EXECUTED,), row_call(slot))
    name, at = processor.name, processor.origin
    yield claimed("Table", name, at, (item,), do(ref(package, "Execute"), ref("Item")))
    yield claimed("Miss", name, at, (), do(ref(package, "On_Deadline_Miss")))
    if processor.on_overrun:
        call = do(ref(package, "On_Executed"), ref("Item"), ref("Used"))
        yield claimed("Overrun", name, at, (item, used), call)


def _specs(found: list[Subprogram], form: TerminationForm) -> Iterator[Decl]:
    for sub in found:
        more = (Aspect(form.value),) if form is TerminationForm.ASPECT else ()
        yield Subprogram(sub.name, sub.params, aspects=(*more, *sub.aspects))
        if form is TerminationForm.ANNOTATION:
            yield Pragma("Annotate", (ref("GNATprove"), ref(form.value), ref(sub.name)))


def _body(sub: Subprogram) -> Subprogram:
    return Subprogram(sub.name, sub.params, body=sub.body)
