# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Contracts of activities as `Pre` and `Post`, and what is known of the data that they require."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace

from ravenchart.gen.derive.kept import kept_of
from ravenchart.gen.emit.ada.declarations import (
    Aspect,
    Decl,
    Package,
    Param,
    Subprogram,
    SubtypeDeclaration,
    UseType,
)
from ravenchart.gen.emit.ada.expressions import Expr, IfExpr, both, call
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import ada_case, component_name, type_name
from ravenchart.gen.emit.ada.statements import Comment
from ravenchart.gen.emit.language.terms import (
    Scope,
    compared_states,
    emit_expression,
    operators_in,
)
from ravenchart.gen.language.terms import Expression, Name, Reading, leaves
from ravenchart.gen.model.component import Activity, Component, Data
from ravenchart.gen.model.system import System

KEPT = "Kept"
"""The nested package with what is known of data."""
SentFlag = Callable[[str], str | None]
"""The parameter that tells whether an execution sends on a port; None: each does."""


def contract(
    system: System, component: Component, activity: Activity, flag: SentFlag
) -> Iterator[Aspect]:
    """`Pre` and `Post` of an activity."""
    scope = replace(
        _scope(system, component, ada_case), sent=lambda port: (port, flag(port) or port)
    )
    required = [emit_expression(scope, clause.condition) for clause in activity.requires]
    ensured = [_ensured(scope, clause.condition, flag) for clause in activity.ensures]
    if required:
        yield Aspect("Pre", both(*required))
    if ensured:
        yield Aspect("Post", both(*ensured))


def needed_before(activity: Activity) -> set[str]:
    """The data items whose values before an execution the contract names."""
    required = [(c.condition, Reading.DATA) for c in activity.requires]
    ensured = [(c.condition, Reading.OLD) for c in activity.ensures]
    return {
        leaf.name
        for condition, kind in (*required, *ensured)
        for leaf in leaves(condition)
        if isinstance(leaf, Name) and leaf.kind is kind
    }


def used_types(component: Component, activities: Iterable[Activity]) -> tuple[DottedName, ...]:
    """The types whose operators the contracts of activities use."""
    said = [c.condition for a in activities for c in (*a.requires, *a.ensures)]
    found = {name for expression in said for name in operators_in(expression)}
    return tuple(sorted(found | compared_states(component, said)))


def stored_type(system: System, component: Component, data: Data) -> DottedName:
    """The type in which an instance keeps a data item."""
    if kept_of(system, component, data):
        return ref(component_name(component), KEPT, ada_case(data.name))
    return type_name(system, data.type)


def kept_types(system: System, component: Component) -> Iterator[Decl]:
    """A subtype for each data item of which more is known than its type."""
    found = [(data, kept_of(system, component, data)) for data in component.data]
    said = [condition for _, conditions in found for condition in conditions]
    if not said:
        return
    operators = sorted({name for one in said for name in operators_in(one)})
    items: list[Decl] = [UseType(name) for name in operators]
    scope = _scope(system, component, lambda _: "Item")
    for data, conditions in found:
        if conditions:
            name, of_type = ada_case(data.name), type_name(system, data.type)
            known = both(*(emit_expression(scope, one) for one in conditions))
            params = (Param("Item", "in", of_type),)
            predicate = Aspect("Predicate", call(f"{name}_Is_Kept", ref(name)))
            items.append(Comment(f"[{component.name}.{data.name}]"))
            items.append(Subprogram(f"{name}_Is_Kept", params, "Boolean", expression=known))
            items.append(SubtypeDeclaration(name, of_type, aspects=(predicate,)))
    yield Comment("Conditions that hold of data whenever they are read; each writer proves them.")
    yield Package(KEPT, tuple(items))


def _ensured(scope: Scope, condition: Expression, flag: SentFlag) -> Expr:
    """A condition on values that are sent holds in the executions that send them."""
    said = emit_expression(scope, condition)
    ports = [
        leaf.name
        for leaf in leaves(condition)
        if isinstance(leaf, Name) and leaf.kind is Reading.OUTPUT
    ]
    flags = [name for port in dict.fromkeys(ports) if (name := flag(port)) is not None]
    if not flags:
        return said
    return IfExpr(((both(*map(ref, flags)), said),), None)


def _scope(system: System, component: Component, variable: Callable[[str], str]) -> Scope:
    return Scope(
        system,
        component,
        variable=variable,
        target=variable,
        sent=lambda port: (port, port),
        raised=lambda _, __: (),
    )
