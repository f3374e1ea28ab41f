# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Names in the generated Ada: one place decides how a model element is called."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache

from ravenchart.gen.language.names import path_name
from ravenchart.gen.language.terms import (
    BOOLEAN,
    EnumerationType,
    IntegerType,
    RecordType,
    Scalar,
    Type,
    Value,
    default,
)
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.instances import Instance
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import Processor, Slot, System
from ravenchart.gen.origins import Origin

from .expressions import (
    Attribute,
    Expr,
    OperatorChain,
    call,
    number,
    plain,
    record,
    signed,
)
from .named import DottedName, ref
from .statements import Comment


@lru_cache(maxsize=65_536)
def ada_case(name: str) -> str:
    """``joint_x`` as ``Joint_X``, and so ``joint.x``; capitals already there stay."""
    return "_".join(word[:1].upper() + word[1:] for word in path_name(name).split("_"))


_IN_LETTERS = {
    "/": "_Per_", "%": "Percent", "^": "_", "\N{MICRO SIGN}": "u", "\N{GREEK SMALL LETTER MU}": "u",
    "\N{DEGREE SIGN}": "deg", "\N{SUPERSCRIPT TWO}": "2", "\N{SUPERSCRIPT THREE}": "3",
    "\N{GREEK CAPITAL LETTER OMEGA}": "Ohm", "\N{OHM SIGN}": "Ohm",
}  # fmt: skip


def _in_letters(unit: str) -> str:
    """A unit as a part of an Ada name."""
    words = "".join(_IN_LETTERS.get(c, c) for c in unit)
    safe = "".join(c if c.isascii() and c.isalnum() else "_" for c in words)
    return ada_case("_".join(part for part in safe.split("_") if part) or "Count")


@lru_cache(maxsize=64)
def _unit_names(units: tuple[str, ...]) -> dict[str, str]:
    """A name for each unit; where case or signs alone tell two apart, the later one is numbered."""
    names: dict[str, str] = {}
    taken: set[str] = set()
    plain = {unit: f"Unit_{_in_letters(unit)}" for unit in units}
    later: list[str] = []
    for unit, name in plain.items():
        if name.lower() in taken:
            later.append(unit)
        else:
            taken.add(name.lower())
            names[unit] = name
    for unit in later:
        numbered = (f"{plain[unit]}_{n}" for n in range(2, len(units) + len(taken) + 2))
        names[unit] = next(name for name in numbered if name.lower() not in taken)
        taken.add(names[unit].lower())
    return names


RUNTIME = ref("Ravenchart")
"""The root of the runtime's units."""
NUMBER = ref(RUNTIME, "Number")
"""The integers that count nothing."""
TRUTH = ref("Boolean")


def unit_type(system: System, unit: str | None) -> DottedName:
    """The Ada type that integers counted in ``unit`` belong to."""
    if unit is None:
        return NUMBER
    return ref(ada_case(system.name), _unit_names(system.units)[unit])


def counted_in(system: System, of_type: IntegerType) -> DottedName:
    """The Ada type that declares what a type counts in: its unit's, in the library of the type."""
    return declared_unit(system.library_of(of_type) or system, of_type.unit)


def declared_unit(system: System, unit: str | None) -> DottedName:
    """The type that the name `unit_type` stands for: the first library that has it declares it."""
    library = library_of_unit(system, unit)
    return unit_type(system, unit) if library is None else declared_unit(library, unit)


def library_of_unit(system: System, unit: str | None) -> System | None:
    """The library from which a system has the type of a unit; None where that is its own."""
    return next((one for one in system.libraries if unit in one.units), None)


def type_name(system: System, of_type: Type) -> DottedName:
    """The expanded name of a model type, visible from every generated unit."""
    if of_type == BOOLEAN:
        return TRUTH
    return ref(ada_case(system.name), ada_case(of_type.name))


def literal(system: System, of_type: EnumerationType, value: str) -> DottedName:
    """The expanded name of a literal of a model type."""
    own = ada_case(value)
    return ref(own) if of_type == BOOLEAN else ref(ada_case(system.name), own)


def default_name(system: System, of_type: RecordType) -> DottedName:
    """The constant that stands for a value nobody has given yet."""
    return ref(ada_case(system.name), f"Default_{ada_case(of_type.name)}")


def counted(given: int, unit: str | None) -> Expr:
    """An integer of a unit; the sign of plain numbers is not directly visible everywhere."""
    if unit is None and given < 0:
        return call(Attribute(NUMBER, "Val"), signed(given))
    return number(given)


def scalar(system: System, of_type: IntegerType | EnumerationType, value: Scalar) -> Expr:
    """A scalar value as Ada text."""
    if isinstance(of_type, IntegerType):
        return counted(int(value), of_type.unit)
    if of_type == BOOLEAN:
        return ref(str(value).capitalize())
    return literal(system, of_type, str(value))


def value(system: System, of_type: Type, given: Value) -> Expr:
    """A value of any model type as Ada text."""
    if not isinstance(of_type, RecordType):
        assert not isinstance(given, tuple)
        return scalar(system, of_type, given)
    assert isinstance(given, tuple)
    return record({ada_case(f): scalar(system, of_type.field(f).type, item) for f, item in given})


def default_value(system: System, of_type: Type) -> Expr:
    """The default as an expression; a record's is its constant."""
    if isinstance(of_type, RecordType):
        return default_name(system, of_type)
    return value(system, of_type, default(of_type))


_BELOW_COMPONENTS = """
active active_at_first beginning box chart choice choose chosen conditions configuration deferrals
domain domain_of done_states due element_id elements enabled ending event event_lists everything
executed fire fired firing firings follows health_counts i in_source initial_entry inputs ins
is_deferral is_deferred is_freed is_segment is_selection item memory name name_of nanoseconds
next_segment none nothing now number occurrence offer outbox passing past poll region released
remembered reports selected selection self start_of_region status step target tick time_outs
timers_after to_occurrence top_transition transition variables visit was
"""
BELOW_COMPONENTS = frozenset(_BELOW_COMPONENTS.split())
"""Names in lower case that units below components and instances declare: they would hide one."""


def component_name(component: Component) -> str:
    """A component type as units that see its package name it."""
    own = ada_case(component.name)
    return f"{own}_Type" if component.name.lower() in BELOW_COMPONENTS else own


def component_package(system: System, component: Component) -> DottedName:
    """Package of a component type."""
    return ref(ada_case(system.name), component_name(component))


def states_package(region: Region) -> str:
    """Nested package that holds a region's leaf states."""
    return f"{ada_case(region.name)}_States"


def region_package(system: System, component: Component, region: Region) -> DottedName:
    """Child package with the logic of a region."""
    return ref(component_package(system, component), ada_case(region.name))


def instance_package(system: System, instance: Instance) -> DottedName:
    """Package of a component instance."""
    return ref(ada_case(system.name), ada_case(instance.name))


def processor_package(system: System, processor: Processor) -> DottedName:
    """Package of a processor."""
    return ref(ada_case(system.name), ada_case(processor.name))


def row_name(slot: Slot) -> str:
    """Literal of a row in its processor's table."""
    return f"{ada_case(slot.owner)}_{ada_case(slot.name)}"


def constant_name(element: str) -> str:
    """An element id as one Ada name."""
    return ada_case(element)


LONGEST = 60
"""Of a word in a comment, which no line can break; a longer one loses its beginning."""


def where(name: str, origins: Iterable[Origin], model: Origin) -> Comment:
    """An element by its name in the model, and where it stands, as seen from ``model``."""
    places = dict.fromkeys(_ended(origin.beside(model)) for origin in origins)
    return Comment(f"[{_ended(name)}] {', '.join(places)}")


def _ended(word: str) -> str:
    return word if len(word) <= LONGEST else f"...{word[3 - LONGEST :]}"


def priority(level: int) -> Expr:
    """A priority of the model as one of the target, counted from the default."""
    if level == 0:
        return LOWEST
    return OperatorChain("+", (ref("System.Default_Priority"), plain(level)))


LOWEST = Attribute("System.Priority", "First")
"""The priority that nothing is below."""


def root_package(system: System) -> str:
    """The root of the generated units."""
    return ada_case(system.name)
