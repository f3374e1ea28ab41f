# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Invariants of the model as contracts of a region's code.

`Is_Safe` joins the conditions of `never` that are about this region, with the facts without
which a transition might break one. Each transition and segment keeps it, and so does each step.
Exits and entries have no contract: gnatprove inlines them, so the proof of `Fire` sees their work.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

from ravenchart.gen.emit.ada.declarations import (
    Aspect,
    Decl,
    Object,
    Param,
    Subprogram,
    SubtypeDeclaration,
)
from ravenchart.gen.emit.ada.expressions import (
    BOX,
    OTHERS,
    TRUE,
    Call,
    CaseExpr,
    Expr,
    IfExpr,
    Prefix,
    all_else,
    both,
    call,
    equal,
    old,
)
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.statements import Comment, Pragma
from ravenchart.gen.emit.ada.walking import names_in
from ravenchart.gen.emit.language.compound import Firing
from ravenchart.gen.emit.language.configurations import conjuncts
from ravenchart.gen.emit.language.terms import Scope, emit_expression, operators_in
from ravenchart.gen.language import terms as m
from ravenchart.gen.model.component import Invariant
from ravenchart.gen.model.safety import knows_guards
from ravenchart.gen.model.statechart import When

from .shape import ITEM, RegionShape

DATA = Param("Data", "in", "Variables")
_GHOST = Aspect("Ghost")
_INITIAL = "Initial_Data"
_KEPT = "Is_Kept"


class Safety:
    """The contracts of one region's code for its invariants; none where it has no invariant."""

    def __init__(self, shape: RegionShape) -> None:
        self.shape = shape
        self.region = shape.region
        self.safe = shape.safe
        self.has_data = bool(shape.region.writes)

    def __bool__(self) -> bool:
        return self.safe is not None

    # --- the declared form

    def declared(self) -> list[Decl]:
        """`Is_Safe` and all that it is made of; the region as an instance keeps it."""
        if self.safe is None:
            return []
        items: list[Decl] = []
        if self.has_data:
            items.append(Object(_INITIAL, "Variables", all_else(BOX), constant=True))
        for name, function in zip(self.safe.invariants, self._invariants, strict=True):
            told = (
                f"[{self.shape.component.name}.{name}] True when the condition of `never` is false."
            )
            items += [function, Comment(told)]
        if self._facts is not None:
            items += [self._facts, Comment(_FACTS)]
        items += [self._is_safe, Comment(_SAFE)]
        items += [
            self._is_kept,
            Comment(_BETWEEN),
        ]
        kept = Aspect("Predicate", call(_KEPT, ref(_SAFE_REGION)))
        items.append(SubtypeDeclaration(_SAFE_REGION, "Region", aspects=(kept,)))
        if self._guards is not None:
            items += [self._guards, Comment(_GUARDS)]
        return items

    def _configuration_and_data(self, said: Expr) -> tuple[Param, ...]:
        return used([self.shape.configuration_param, DATA], said)

    @cached_property
    def _invariants(self) -> tuple[Subprogram, ...]:
        assert self.safe is not None
        made = []
        for one in self._conditions():
            free = Prefix("not", emit_expression(self._scope, self._with_constants(one.condition)))
            name = f"Never_{ada_case(one.name)}"
            params = self._configuration_and_data(free)
            made.append(Subprogram(name, params, "Boolean", expression=free))
        return tuple(made)

    def _conditions(self) -> tuple[Invariant, ...]:
        assert self.safe is not None
        return tuple(m.named(self.shape.component.invariants, n) for n in self.safe.invariants)

    @cached_property
    def _facts(self) -> Subprogram | None:
        assert self.safe is not None
        by_vertex: dict[str, list[Expr]] = {}
        for fact in self.safe.facts:
            condition = fact.condition(self.shape.component)
            said = emit_expression(self._scope, condition)
            by_vertex.setdefault(fact.vertex, []).append(said)
        if not by_vertex:
            return None
        held = self.shape.configuration_name
        rows = [
            IfExpr(((self.shape.in_state(held, vertex), both(*conjuncts(said))),), None)
            for vertex, said in by_vertex.items()
        ]
        known = both(*rows)
        params = self._configuration_and_data(known)
        return Subprogram("Data_Are_Known", params, "Boolean", expression=known)

    @cached_property
    def _is_safe(self) -> Subprogram:
        parts = [_of(function) for function in self._invariants]
        parts += [] if self._facts is None else [_of(self._facts)]
        safe = both(*parts)
        return Subprogram("Is_Safe", self._configuration_and_data(safe), "Boolean", expression=safe)

    @cached_property
    def _is_kept(self) -> Subprogram:
        parts: list[Expr] = [_of(function, "Self") for function in self._invariants]
        started: list[tuple[Expr, Expr]] = []
        if self._facts is not None:
            started.append((ref("Self.Started"), _of(self._facts, "Self")))
        if self.has_data:
            first = equal(ref("Self.Data"), ref(_INITIAL))
            if started:
                parts.append(IfExpr(tuple(started), first))
            else:
                parts.append(IfExpr(((Prefix("not", ref("Self.Started")), first),), None))
        return Subprogram(
            _KEPT, (Param("Self", "in", "Region"),), "Boolean", expression=both(*parts)
        )

    @cached_property
    def _guards(self) -> Subprogram | None:
        rows = [(f.literal, said) for f in self.shape.firings if (said := self._guard(f))]
        if not rows:
            return None
        choice = CaseExpr(ref("T"), (*((name, both(*conjuncts(s))) for name, s in rows), _OTHERS))
        params = used([DATA, Param("Ins", "in", "Inputs"), ITEM], choice)
        return Subprogram(
            "Guards_Hold", (Param("T", "in", "Firing"), *params), "Boolean", expression=choice
        )

    def _guard(self, firing: Firing) -> list[Expr]:
        passes = self.region.pseudostate(firing.sources[0]) is not None
        alone = passes or knows_guards(self.region, firing.region) or self._is_alone(firing)
        if not alone:
            return []
        scope = self.shape.scope("Data")
        asked = [t.condition for t in firing.triggers if isinstance(t, When)]
        return [emit_expression(scope, guard) for guard in (*asked, *firing.guards)]

    def _is_alone(self, firing: Firing) -> bool:
        assert self.safe is not None
        return bool(firing.effects) and firing.effects[0].name in self.safe.alone

    def alone(self) -> tuple[Pragma, ...]:
        """That `alone` transitions are selected only where no region before theirs selects one."""
        if self.safe is None:
            return ()
        said: list[Expr] = []
        for firing in self.shape.firings:
            if self._is_alone(firing):
                regions = self.shape.busy_regions
                before = regions[: regions.index(firing.region)]
                none = [equal(ref("C", self.shape.label(r)), ref("None")) for r in before]
                own = ref("C", self.shape.label(firing.region))
                said.append(IfExpr(((equal(own, ref(firing.literal)), both(*none)),), None))
        return tuple(Pragma("Assert", (one,)) for one in said)

    @cached_property
    def _scope(self) -> Scope:
        """Conditions ask for the region's own states and data."""

        def variable(name: str) -> DottedName:
            if name.lower() == self.region.name.lower():
                return ref(self.shape.configuration_name)
            return ref("Data", ada_case(name))

        return replace(self.shape.scope("Data"), variable=variable)

    def _with_constants(self, expression: m.Expression) -> m.Expression:
        """A condition with the value of each data item that nothing writes."""
        match expression:
            case m.Name(m.Reading.DATA, name, field) if name not in self.region.writes:
                given = m.named(self.shape.component.data, name)
                of_type = given.type
                if isinstance(of_type, m.RecordType):
                    assert field is not None
                    of_type = of_type.field(field).type
                return m.Literal(given.initial_of(field), of_type)
            case m.Operation(operands=operands):
                return replace(
                    expression, operands=tuple(self._with_constants(o) for o in operands)
                )
            case _:
                return expression

    def operators(self) -> set[DottedName]:
        """The runtime's types whose operators the declared form uses."""
        if self.safe is None:
            return set()
        said = [self._with_constants(one.condition) for one in self._conditions()]
        said += [fact.condition(self.shape.component) for fact in self.safe.facts]
        return {name for expression in said for name in operators_in(expression)}

    # --- the contracts of transitions and steps

    def ready(self, chosen: str) -> tuple[list[Expr], list[Expr]]:
        """The preconditions of a transition: at the start of the region, and later."""
        if self.safe is None:
            return [], []
        first: list[Expr] = []
        if self.has_data:
            first.append(equal(ref("Self.Data"), ref(_INITIAL)))
        return first, [*self.holds(), *self.guarded(chosen)]

    def holds(self) -> list[Expr]:
        """That the region is safe, in the middle of a step too."""
        return [] if self.safe is None else [_of(self._is_safe, "Self")]

    def guarded(self, chosen: str) -> list[Expr]:
        """That the guard of a transition holds."""
        if self.safe is None or self._guards is None:
            return []
        names = [p.name for p in self._guards.params[1:]]
        args = (ref("Self.Data" if n == "Data" else n) for n in names)
        return [call("Guards_Hold", ref(chosen), *args)]

    def reads(self) -> set[str]:
        """The parameters of `Guards_Hold`, as `Fire` must have them."""
        if self.safe is None or self._guards is None:
            return set()
        return {p.name for p in self._guards.params}

    def kept(self) -> list[Expr]:
        """That a region is as instances keep it."""
        return [] if self.safe is None else [call(_KEPT, ref("Self"))]

    def unchanged(self) -> list[Expr]:
        """That data are as before: what no behaviour does to them."""
        if self.safe is None or not self.has_data:
            return []
        return [equal(ref("Self.Data"), old("Self.Data"))]


_SAFE_REGION = "Safe_Region"
_FACTS = (
    "Whether the data have the values known for the active leaf. Without this fact a transition "
    "might break an invariant."
)
_SAFE = "Whether the invariants of the region hold. Each transition and each segment keeps them."
_BETWEEN = (
    "Whether the region is as between two steps: the invariants hold, and before the start the "
    "data are initial."
)
_GUARDS = (
    "Whether the guard of T holds, as far as an invariant may need it. True for a transition "
    "without a guard, and for one before which the step may have taken another one."
)
_OTHERS = (OTHERS, TRUE)


def used(params: Sequence[Param], expression: Expr) -> tuple[Param, ...]:
    """The parameters that an expression names."""
    named = {name.first for name in names_in(expression)}
    return tuple(p for p in params if p.name in named)


def _of(function: Subprogram, *within: str) -> Call | DottedName:
    """A call with the parameters' own names, of the components of ``within`` if that is given."""
    if not function.params:
        return ref(function.name)
    return call(function.name, *(ref(*within, p.name) for p in function.params))
