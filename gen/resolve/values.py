# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Types and constants of a model, resolved."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Set

from ravenchart.gen.files.located import TextPlace
from ravenchart.gen.files.schema import FieldsType, ParameterForm, RangeType, ValuesType
from ravenchart.gen.files.schema_base import Element
from ravenchart.gen.files.schema_devices import DeviceParameterForm
from ravenchart.gen.language.names import (
    CHILDREN,
    HIDING,
    PREDEFINED_TYPES,
    Findings,
    NameScope,
    NameUse,
    meant,
)
from ravenchart.gen.language.terms import (
    BOOLEAN,
    EnumerationType,
    Field,
    IntegerType,
    RecordType,
    Scalar,
    ScalarType,
    Type,
    Value,
)
from ravenchart.gen.origins import Origin

from .vocabulary import literal_use, range_of

FIRST, LAST = -(2**62), 2**62 - 1
"""Bounds of every integer type."""

TypeForms = Iterable[tuple[str, Origin, RangeType | ValuesType | FieldsType]]


def types_of(
    forms: TypeForms, dropped: Iterable[str], system: str, findings: Findings
) -> NameScope[Type]:
    """The model's types and ``Boolean``."""
    scope: NameScope[Type] = NameScope("type")
    scope.declare("Boolean", None, BOOLEAN)
    for name in dropped:
        scope.declare(name, None, None)
    records: list[tuple[str, Origin, FieldsType]] = []
    for name, origin, form in forms:
        clash = name.lower() in PREDEFINED_TYPES or name.lower() in CHILDREN
        if clash or name.lower() == system.lower():
            taken = "the system" if name.lower() == system.lower() else "a unit or type of Ada"
            if name.lower() in CHILDREN:
                taken = CHILDREN[name.lower()]
            message = f"a type cannot be named `{name}`, like {taken}"
            findings.error("RV-0304", origin, message, hint="choose another name")
        if isinstance(form, FieldsType):
            records.append((name, origin, form))
            scope.declare(name, origin, None, findings)
        else:
            scope.declare(name, origin, _scalar(name, origin, form, findings), findings)
    record_names = {name.lower() for name, _, _ in records}
    for name, origin, form in records:
        record = _record(name, origin, form, record_names, scope, findings)
        if scope.items[name.lower()][1] is origin:
            scope.items[name.lower()] = (name, origin, record)
    return scope


def _scalar(
    name: str, origin: Origin, form: RangeType | ValuesType, findings: Findings
) -> ScalarType | None:
    if isinstance(form, ValuesType):
        return _enumeration(name, origin, form, findings)
    first, last = form.range
    if first < FIRST or last > LAST:
        message = f"`range` must lie within -2^62 .. 2^62 - 1, not {first} .. {last}"
        findings.error("RV-0204", form.at("range"), message)
        return None
    if first > last:
        message = f"the range {first} .. {last} is empty"
        findings.error("RV-0310", form.at("range"), message, hint=f"`range: [{last}, {first}]`?")
        return None
    return IntegerType(name, origin, first, last, form.unit)


def _enumeration(
    name: str, origin: Origin, form: ValuesType, findings: Findings
) -> EnumerationType | None:
    before = findings.count()
    literals: NameScope[str] = NameScope("literal")
    for index, literal in enumerate(form.values):
        at = form.item_at("values", index)
        if literal.lower() in ("true", "false"):
            message = f"a literal cannot be named `{literal}`, like one of Boolean"
            findings.error("RV-0304", at, message, hint="use the type Boolean, or another name")
        elif literal.lower() in HIDING:
            message = f"a literal cannot be named `{literal}`, like a unit or type of Ada"
            findings.error("RV-0304", at, message, hint="choose another name")
        literals.declare(literal, at, literal, findings)
    if findings.count() > before or form.damaged:
        return None
    return EnumerationType(name, origin, tuple(form.values))


def _record(
    name: str,
    origin: Origin,
    form: FieldsType,
    records: Set[str],
    scope: NameScope[Type],
    findings: Findings,
) -> RecordType | None:
    sound = not form.damaged
    names: NameScope[str] = NameScope("field")
    fields: list[Field] = []
    for item, type_name in form.fields.items():
        at = form.entry_at("fields", item)
        sound = names.declare(item, at, item, findings) and sound
        type_at = form.place("fields", item).origin
        is_record = type_name.lower() in records
        type_ = None if is_record else scope.look_up(type_name, type_at, findings)
        if is_record:
            message = f"the field `{item}` is of the record type {type_name}; fields are scalars"
            findings.error("RV-0311", type_at, message, hint="write its fields out here")
            sound = False
        elif type_ is None or isinstance(type_, RecordType):
            sound = False
        else:
            fields.append(Field(item, at, type_))
    return RecordType(name, origin, tuple(fields)) if sound else None


def constant(
    value: int | bool | str, place: TextPlace, what: str, type_: ScalarType, findings: Findings
) -> Scalar | None:
    """A constant of a scalar type; reported when it is none."""
    if isinstance(type_, IntegerType):
        if isinstance(value, bool) or not isinstance(value, int):
            shown = str(value).lower() if isinstance(value, bool) else value
            message = f"`{what}` must be a number, not `{shown}`"
            findings.error("RV-0312", place.origin, message)
            return None
        if not type_.first <= value <= type_.last:
            shown = range_of((type_.first, type_.last), type_.unit)
            message = f"`{what}` must be of type {type_.name}, {shown}, not {value}"
            findings.error("RV-0312", place.origin, message)
            return None
        return value
    for literal in type_.literals:
        if literal.lower() == str(value).lower():
            findings.uses.append(literal_use(literal, type_, place.origin))
            return literal
    message = f"`{what}` must be of type {type_.name}, which has no literal `{value}`"
    hint = meant(str(value), type_.literals)
    findings.error("RV-0312", place.origin, message, hint=hint)
    return None


def parameter(
    name: str,
    form: ParameterForm | DeviceParameterForm,
    types: NameScope[Type],
    findings: Findings,
) -> tuple[ScalarType, Scalar | None] | None:
    """Type and default of a parameter; None when one of them is wrong."""
    type_ = types.look_up(form.type, form.at("type"), findings)
    if isinstance(type_, RecordType):
        message = f"the parameter {name} is of the record type {type_.name}"
        findings.error("RV-0311", form.at("type"), message, hint="use one parameter a field")
        return None
    if type_ is None or form.default is None:
        return None if type_ is None else (type_, None)
    default = constant(form.default, form.place("default"), name, type_, findings)
    return None if default is None else (type_, default)


def initial_value(
    form: Element,
    given: int | bool | str | Mapping[str, int | bool | str],
    name: str,
    type_: Type,
    findings: Findings,
) -> Value | None:
    """A data item's initial value, complete."""
    if not isinstance(type_, RecordType):
        if isinstance(given, Mapping):
            message = f"`{name}` is of the scalar type {type_.name}: give one value"
            findings.error("RV-0313", form.at("initial"), message)
            return None
        return constant(given, form.place("initial"), name, type_, findings)
    if not isinstance(given, Mapping):
        fields = ", ".join(f"{one.name}: ..." for one in type_.fields[:4])
        message = f"`{name}` is of the record type {type_.name}: give a value for each field"
        hint = f"`initial: {{{fields}}}`"
        findings.error("RV-0313", form.at("initial"), message, hint=hint)
        return None
    entries = {key.lower(): key for key in given}
    lost = {key.lower() for key in form.dropped("initial")}
    values: list[tuple[str, Scalar]] = []
    for one in type_.fields:
        entry = entries.pop(one.name.lower(), None)
        if entry is not None:
            at = form.entry_at("initial", entry)
            findings.uses.append(NameUse(one.name, at, "field", one.origin))
            place = form.place("initial", entry)
            value = constant(given[entry], place, f"{name}.{one.name}", one.type, findings)
            if value is not None:
                values.append((one.name, value))
        elif one.name.lower() not in lost:
            message = f"`initial` gives no value for the field `{one.name}` of {type_.name}"
            findings.error("RV-0313", form.at_key("initial"), message)
    for extra in entries.values():
        near = meant(extra, (one.name for one in type_.fields))
        message = f"{type_.name}, the type of `{name}`, has no field `{extra}`"
        findings.error("RV-0313", form.entry_at("initial", extra), message, hint=near)
    return tuple(values) if len(values) == len(type_.fields) else None
