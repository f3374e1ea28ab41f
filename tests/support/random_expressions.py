# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Random expressions over the names of a component, most of them sound."""

from __future__ import annotations

import random
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class Words:
    """What expressions of a component may name."""

    numbers: tuple[str, ...]
    conditions: tuple[str, ...]
    values: tuple[tuple[str, tuple[str, ...]], ...]
    """Names of enumeration types, each with its literals."""
    ports: tuple[str, ...]
    states: tuple[str, ...]
    """``Region.State``."""

    @staticmethod
    def of(model: Any, component: Any) -> Words:
        """Those of a component of a model, as YAML gives both."""
        types = {name: one for name, one in model.get("types", {}).items() if isinstance(one, dict)}
        found: dict[str, Any] = {}
        ports = {}
        for name, port in component.get("ports", {}).items():
            if isinstance(port, dict) and "in" in port:
                ports[name] = found[name] = port["in"]
        for section in ("data", "parameters"):
            for name, item in component.get(section, {}).items():
                found[name] = item.get("type") if isinstance(item, dict) else None
        for name, of_type in list(found.items()):
            for field, kind in types.get(of_type, {}).get("fields", {}).items():
                found[f"{name}.{field}"] = kind
        numbers = tuple(n for n, t in found.items() if "range" in types.get(t, {}))
        values = tuple(
            (n, tuple(types[t]["values"])) for n, t in found.items() if "values" in types.get(t, {})
        )
        states = tuple(
            f"{region}.{state}"
            for region, one in component.get("regions", {}).items()
            if isinstance(one, dict)
            for state in one.get("states", {})
        )
        conditions = tuple(n for n, t in found.items() if t == "Boolean")
        return Words(numbers, conditions, values, tuple(ports), states)


def number_term(words: Words, chance: random.Random, depth: int) -> str:
    """A number."""
    if depth == 0 or chance.random() < 0.25:
        if words.numbers and chance.random() < 0.7:
            return chance.choice(words.numbers)
        return str(chance.choice((0, 1, 2, 3, 5, 10, 100, 2_000)))

    def part() -> str:
        return number_term(words, chance, depth - 1)

    match chance.randrange(9):
        case 0:
            return f"abs({part()})"
        case 1:
            return f"-({part()})"
        case 2:
            return f"{chance.choice(('min', 'max'))}({part()}, {part()})"
        case 3:
            return f"clamp({part()}, {part()}, {part()})"
        case 4:
            return f"({part()} * {chance.choice((0, 1, 2, 10))})"
        case 5:
            return f"({part()} / {chance.choice((1, 2, 10))})"
        case 6:
            return f"(if {condition(words, chance, depth - 1)} then {part()} else {part()})"
        case _:
            return f"({part()} {chance.choice('+-')} {part()})"


def condition(words: Words, chance: random.Random, depth: int) -> str:
    """A condition."""

    def part() -> str:
        return condition(words, chance, depth - 1)

    choice = chance.randrange(12) if depth else chance.randrange(5, 12)
    match choice:
        case 0 | 1:
            return f"({part()} {chance.choice(('and', 'or'))} {part()})"
        case 2:
            return f"not ({part()})"
        case 3:
            return f"(if {part()} then {part()} else {part()})"
        case 4 if words.conditions:
            return f"({chance.choice(words.conditions)} {chance.choice(('=', '/='))} {part()})"
        case 5 if words.ports:
            test = chance.choice(("fresh", "stale", "never_received"))
            return f"{test}({chance.choice(words.ports)})"
        case 6 if words.states:
            return f"in({chance.choice(words.states)})"
        case 7 if words.values:
            name, literals = chance.choice(words.values)
            same = [other for other, others in words.values if others == literals]
            return f"{name} {chance.choice(('=', '/='))} {chance.choice((*literals, *same))}"
        case 8 if words.conditions:
            return chance.choice((*words.conditions, "true", "false"))
    operator = chance.choice(("=", "/=", "<", "<=", ">", ">="))
    below = max(0, depth - 1)
    return f"{number_term(words, chance, below)} {operator} {number_term(words, chance, below)}"
