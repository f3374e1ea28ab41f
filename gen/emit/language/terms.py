# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Expressions and flows of the model as Ada expressions and statements."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from ravenchart.gen.emit.ada.expressions import (
    FALSE,
    TRUE,
    Aggregate,
    Arg,
    Attribute,
    Expr,
    IfExpr,
    OperatorChain,
    Prefix,
    call,
    old,
    select,
)
from ravenchart.gen.emit.ada.named import DottedName, Named, ref
from ravenchart.gen.emit.ada.naming import (
    NUMBER,
    ada_case,
    counted,
    counted_in,
    declared_unit,
    type_name,
    unit_type,
)
from ravenchart.gen.emit.ada.statements import Assign, IfStatement, Stmt, do
from ravenchart.gen.language import terms as m
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.system import System

from .configurations import Configurations
from .events import field_of

_CHAINS = {"and": "and then", "or": "or else"}
_FUNCTIONS = {"min": "Min", "max": "Max"}
FRESHNESS = ref("Ravenchart.Freshness")
"""Whether the value of a port is recent enough."""


@dataclass(frozen=True, slots=True)
class Scope:
    """How names read at one point of the generated program.

    ``variable`` gives a data item, parameter or port view, ``target`` a data
    item to be set, ``sent`` the slot of an output port, ``raised`` the
    statement that raises an event.
    """

    system: System
    component: Component
    variable: Callable[[str], Named]
    target: Callable[[str], Named]
    sent: Callable[[str], tuple[Named, Named]]
    raised: Callable[[str, Expr | None], tuple[Stmt, ...]]


def unit_of(expression: m.Expression) -> str | None:
    """The unit of an integer expression; None for a bare number."""
    match expression:
        case m.Operation():
            return expression.unit
        case m.Name(_, _, field, of_type):
            scalar = _scalar_in(of_type, field)
            return scalar.unit if isinstance(scalar, m.IntegerType) else None
        case _:
            return None


def names_read(expression: m.Expression) -> set[str]:
    """The data, parameters, ports and regions that an expression reads."""
    found: set[str] = set()
    for leaf in m.leaves(expression):
        match leaf:
            case m.Name(kind, name) if kind is not m.Reading.EVENT:
                found.add(name)
            case m.PortTest(name) | m.InState(name):
                found.add(name)
    return found


def states_in(expression: m.Expression) -> set[tuple[str, str]]:
    """The (region, state) pairs that an expression asks for."""
    tests = (leaf for leaf in m.leaves(expression) if isinstance(leaf, m.InState))
    return {(test.region, test.state) for test in tests}


def compared_states(component: Component, expressions: Iterable[m.Expression]) -> set[DottedName]:
    """The types of states that expressions compare, seen from the component's package."""
    asked = {pair for e in expressions for pair in states_in(e)}
    return {
        ref(chart.states, kind)
        for name, state in asked
        for chart in (Configurations(component.region(name)),)
        for kind in chart.compared_types(state)
    }


def operators_in(expression: m.Expression) -> set[DottedName]:
    """The runtime's types whose operators an expression uses."""
    match expression:
        case m.PortTest():
            return {FRESHNESS}
        case m.Operation(operator, operands):
            found = {name for operand in operands for name in operators_in(operand)}
            plain = any(_is_plain(o) for o in operands)
            if operator in ("*", "/") and expression.unit is not None:
                plain = False  # plain factors are converted
            if operator not in ("min", "max", "clamp", "if") and plain:
                found.add(NUMBER)
            return found
        case _:
            return set()


def _is_plain(operand: m.Expression) -> bool:
    """An integer that counts nothing, and is more than a literal."""
    match operand:
        case m.Operation(operator, operands, None, None):
            #  a choice between literals is of no type of its own
            return operator in ("min", "max", "clamp") or any(map(_is_plain, operands))
        case m.Name(_, _, field, of_type):
            scalar = _scalar_in(of_type, field)
            return isinstance(scalar, m.IntegerType) and scalar.unit is None
        case _:
            return False


def expressions_in(flow: m.Flow) -> Iterator[m.Expression]:
    """Every expression that stands in a flow."""
    for action in flow:
        match action:
            case m.Set():
                yield action.value
            case m.Raise(_, _, values):
                yield from (value for _, value in values)
            case m.Send():
                yield from (value for _, value in action.values)
            case m.If():
                yield action.condition
                yield from expressions_in(action.then)
                yield from expressions_in(action.otherwise)


def effective(flow: m.Flow) -> m.Flow:
    """A flow of an activity without what has no effect: values set anew before they are read."""
    kept: list[m.Action] = []
    raised: set[str] = set()
    for index, action in enumerate(flow):
        match action:
            case m.Raise(_, event) if event in raised:
                continue
            case m.Raise(_, event):
                raised.add(event)
            case m.Set(_, data, None) if _set_anew(data, flow[index + 1 :]):
                continue
            case m.If(origin, condition, then, otherwise):
                action = m.If(origin, condition, effective(then), effective(otherwise))
        kept.append(action)
    return tuple(kept)


def _set_anew(data: str, rest: m.Flow) -> bool:
    for action in rest:
        if data in flow_names((action,)):
            return False
        match action:
            case m.Set(_, again, field) if again == data:
                return field is None
    return False


def flow_operators(flow: m.Flow) -> set[DottedName]:
    """The runtime's types whose operators a flow uses."""
    return {name for expression in expressions_in(flow) for name in operators_in(expression)}


def flow_names(flow: m.Flow) -> set[str]:
    """The data, parameters, ports and regions that a flow reads."""
    return {name for expression in expressions_in(flow) for name in names_read(expression)}


def reads_first(flow: m.Flow, data: str) -> bool:
    """Whether a flow may read a data item before it has set it."""
    for action in flow:
        if isinstance(action, m.If):
            own = data in names_read(action.condition)
            if own or reads_first(action.then, data) or reads_first(action.otherwise, data):
                return True
        elif data in flow_names((action,)):
            return True
        if data in m.always((action,)):
            return False
    return False


def certain_sends(flow: m.Flow) -> set[str]:
    """The ports that a flow sends on whatever way it takes."""
    ports: set[str] = set()
    for action in flow:
        match action:
            case m.Send(_, port, _):
                ports.add(port)
            case m.If(_, _, then, otherwise):
                ports |= certain_sends(then) & certain_sends(otherwise)
    return ports


def emit_expression(scope: Scope, expression: m.Expression, unit: str | None = None) -> Expr:
    """One model expression as Ada; ``unit`` is the unit that bare numbers have there."""
    match expression:
        case m.Literal(value, of_type):
            return _literal(scope, value, of_type, unit)
        case m.Name(m.Reading.OLD, name, field):
            before = old(ref(scope.variable(name)))
            whole = before if field is None else select(before, ada_case(field))
            return _counted_here(scope, expression, whole)
        case m.Name(m.Reading.SENT, name):
            return ref(scope.sent(name)[1])
        case m.Name():
            return _counted_here(scope, expression, _name(scope, expression))
        case m.PortTest(port, state):
            view = scope.variable(port)
            return OperatorChain("=", (ref(view, "State"), ref("Ravenchart", ada_case(state))))
        case m.InState(region, state):
            return _in_state(scope, region, state)
        case m.Operation():
            return _operation(scope, expression, unit)


def _literal(scope: Scope, value: m.Scalar, of_type: m.ScalarType | None, unit: str | None) -> Expr:
    if isinstance(value, int) and not isinstance(value, bool):
        return counted(value, unit)
    if of_type is None or of_type == m.BOOLEAN:
        return TRUE if str(value).lower() == "true" else FALSE
    return ref(ada_case(scope.system.name), ada_case(str(value)))


def _name(scope: Scope, name: m.Name) -> DottedName:
    fields = [] if name.field is None else [ada_case(name.field)]
    if name.kind is m.Reading.EVENT:
        of_type = m.named(scope.component.events, name.name).type
        assert of_type is not None
        return ref("Item", field_of(of_type), *fields)
    value = ["Value"] if name.kind is m.Reading.PORT else []
    return ref(scope.variable(name.name), *value, *fields)


def _counted_here(scope: Scope, name: m.Name, value: Expr) -> Expr:
    """A value as the system counts it: a library may have another Ada type for the same unit."""
    scalar = _scalar_in(name.type, name.field)
    if not isinstance(scalar, m.IntegerType) or not _is_foreign(scope.system, scalar):
        return value
    return call(unit_type(scope.system, scalar.unit), value)


def _fitting(scope: Scope, target: m.Type, field: str | None, value: m.Expression) -> Expr:
    """An expression for a target, or a field of one, in the target's own Ada type."""
    scalar = _scalar_in(target, field)
    made = emit_expression(scope, value, _unit_in(target, field))
    if not isinstance(scalar, m.IntegerType) or not _is_foreign(scope.system, scalar):
        return made
    return call(type_name(scope.system, scalar), made)


def _is_foreign(system: System, of_type: m.IntegerType) -> bool:
    """Whether the values of a library's type are of another Ada type than the system's."""
    return counted_in(system, of_type) != declared_unit(system, of_type.unit)


def _scalar_in(of_type: m.Type, field: str | None) -> m.Type:
    """The type of a value, or of a field of it."""
    return of_type.field(field).type if isinstance(of_type, m.RecordType) and field else of_type


def _in_state(scope: Scope, region_name: str, state: str) -> Expr:
    chart = Configurations(scope.component.region(region_name))
    return chart.in_state(scope.variable(region_name), state)


def _operation(scope: Scope, operation: m.Operation, place: str | None) -> Expr:
    operator = operation.operator
    #  bare numbers take the unit of their neighbours, or of the place
    unit = next((u for o in operation.operands if (u := unit_of(o)) is not None), None)
    if unit is None and operation.type is None:
        unit = place
    operands = tuple(emit_expression(scope, o, unit) for o in operation.operands)
    if operator == "not":
        return Prefix("not", operands[0])
    if operator == "neg":
        return Prefix("-", operands[0])
    if operator == "abs":
        return Prefix("abs", operands[0])
    if operator == "if":
        return IfExpr(((operands[0], operands[1]),), operands[2])
    if operator in _FUNCTIONS or operator == "clamp":
        return _bounded(scope, operation, operands, unit)
    if operator in ("*", "/"):
        return OperatorChain(operator, tuple(_scaled(scope, unit, o) for o in operation.operands))
    return OperatorChain(_CHAINS.get(operator, operator), operands)


def _bounded(
    scope: Scope, operation: m.Operation, operands: tuple[Expr, ...], unit: str | None
) -> Expr:
    base = unit_type(scope.system, unit)
    if operation.operator == "clamp":
        item, low, high = operands
        return call(Attribute(base, "Min"), call(Attribute(base, "Max"), item, low), high)
    return call(Attribute(base, _FUNCTIONS[operation.operator]), *operands)


def _scaled(scope: Scope, unit: str | None, operand: m.Expression) -> Expr:
    """A factor in the unit type of the product, for Ada multiplies only within a type."""
    if isinstance(operand, m.Literal) or unit_of(operand) == unit:
        return emit_expression(scope, operand, unit)
    return call(unit_type(scope.system, unit), emit_expression(scope, operand))


def emit_flow(scope: Scope, flow: m.Flow) -> tuple[Stmt, ...]:
    """The actions of a flow, in order."""
    return tuple(statement for action in flow for statement in _action(scope, action))


def _action(scope: Scope, action: m.Action) -> tuple[Stmt, ...]:
    match action:
        case m.Set(_, data, field, value):
            target = ref(scope.target(data), *([ada_case(field)] if field else []))
            item = next(d.type for d in scope.component.data if d.name == data)
            return (Assign(target, _fitting(scope, item, field, value)),)
        case m.Send(_, port, values):
            slot, flag = scope.sent(port)
            if scope.component.port(port).is_void:
                return (Assign(ref(flag), TRUE),)
            given = _given(scope, scope.component.port(port).type, values)
            return (Assign(ref(slot), given), Assign(ref(flag), TRUE))
        case m.Raise(_, event, values):
            of_type = m.named(scope.component.events, event).type if values else None
            return scope.raised(event, _given(scope, of_type, values) if of_type else None)
        case m.If(_, condition, then, otherwise):
            branch = (emit_expression(scope, condition), emit_flow(scope, then))
            return (IfStatement((branch,), emit_flow(scope, otherwise)),)


def _unit_in(of_type: m.Type, field: str | None) -> str | None:
    """The unit of a target."""
    scalar = _scalar_in(of_type, field)
    return scalar.unit if isinstance(scalar, m.IntegerType) else None


def _given(
    scope: Scope, of_type: m.Type, values: tuple[tuple[str | None, m.Expression], ...]
) -> Expr:
    """The value that a send or raise gives."""
    if not isinstance(of_type, m.RecordType):
        return _fitting(scope, of_type, None, values[0][1])
    return Aggregate(
        tuple(Arg(ada_case(f or ""), _fitting(scope, of_type, f, v)) for f, v in values),
        type_name(scope.system, of_type),
    )


def raise_in_list(list_package: str, target: Named, event: Expr) -> Stmt:
    """Append ``event`` to the list of events raised in this step."""
    return do(ref(list_package, "Append"), ref(target), event)


def asks_event(expression: m.Expression) -> bool:
    """Does it ask for the value of the event?"""
    match expression:
        case m.Name(kind):
            return kind is m.Reading.EVENT
        case m.Operation(_, operands):
            return any(asks_event(o) for o in operands)
        case _:
            return False
