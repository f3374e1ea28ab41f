# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Terms to typed expressions: names resolved, bounds computed, units checked."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from ravenchart.gen.files.located import TextPlace
from ravenchart.gen.language import folding, intervals
from ravenchart.gen.language.expressions import Malformed, Term, parse
from ravenchart.gen.language.names import Findings, NameUse, Unknown, meant, nearest
from ravenchart.gen.language.narrowing import COMPARISONS, Known, narrowed
from ravenchart.gen.language.terms import (
    BOOLEAN,
    EnumerationType,
    Expression,
    InState,
    IntegerType,
    Literal,
    Name,
    Operation,
    PortTest,
    RecordType,
    ScalarType,
    Type,
)
from ravenchart.gen.origins import Origin

from .vocabulary import EVENT, CheckedExpression, Vocabulary, literal_use, range_text, yielded

FUNCTIONS: Mapping[str, int] = {
    "abs": 1,
    "min": 2,
    "max": 2,
    "clamp": 3,
    "fresh": 1,
    "stale": 1,
    "never_received": 1,
}
"""Functions with the number of their arguments."""
OLD = "old"
"""The function that gives a data item before the execution."""
SENT = "sent"
"""The function that says whether the execution sends on a port, or calls a command."""
PORT_TESTS = ("fresh", "stale", "never_received")


@dataclass(slots=True)
class Checker:
    """Checks the expressions of one text, at one place."""

    vocabulary: Vocabulary
    findings: Findings
    place: TextPlace
    known: Known = field(init=False)
    """The bounds of names by the conditions around a term."""

    def __post_init__(self) -> None:
        """Begin with the bounds around the text."""
        self.known = self.vocabulary.known

    def at(self, term: Term) -> Origin:
        """Where a term stands in the model file."""
        origin = self.place.origin
        return replace(origin, column=origin.column + term.at) if self.place.exact else origin

    def refuse(self, code: str, term: Term, message: str, hint: str | None = None) -> None:
        """Report an error at a term."""
        self.findings.error(code, self.at(term), message, hint=hint)

    def check(
        self, term: Term, expected: EnumerationType | None = None
    ) -> CheckedExpression | None:
        """The typed expression; None when an error was reported."""
        match term.kind:
            case "number":
                value = int(term.word.replace("_", ""), 16 if "x" in term.word else 10)
                if value > intervals.WORD:
                    self.refuse("RV-0408", term, "a number is at most 2^63 - 1")
                    return None
                return CheckedExpression(Literal(value, None), None, (value, value), None, True)
            case "name" | "member":
                return self.name(term, expected)
            case "inside":
                return self.inside(term)
            case "call":
                return self.call(term)
            case _:
                return self.operator(term, expected)

    # --- Names ---

    def is_free(self, term: Term) -> bool:
        """Whether a term can only be a literal whose type its surroundings tell."""
        if term.kind == "name":
            free = not self.vocabulary.readable.knows(term.word)
            return free and term.word.lower() not in ("true", "false")
        return term.word == "if" and all(self.is_free(t) for t in term.operands[1:])

    def name(self, term: Term, expected: EnumerationType | None) -> CheckedExpression | None:
        """A name: data, a parameter, an input port, a field of one, or a literal."""
        readable = self.vocabulary.readable
        if not readable.knows(term.word):
            return self.literal(term, expected)
        found = readable.find(term.word)
        if found is None:
            self.findings.lose()
            return None
        kind, name, type_ = found
        if term.kind == "name" and type_ is not expected and _is_literal_of(term.word, expected):
            return self.literal(term, expected)
        readable.used(term.word, self.at(term), self.findings)
        if term.kind == "name":
            return self.reading(Name(kind, name, None, type_), type_)
        if not isinstance(type_, RecordType):
            self.refuse("RV-0403", term, f"`{name}` is a scalar and has no field `{term.member}`")
            return None
        for item in type_.fields:
            if item.name.lower() == term.member.lower():
                self.findings.uses.append(NameUse(item.name, self.at(term), "field", item.origin))
                return self.reading(Name(kind, name, item.name, item.type), item.type)
        hint = meant(term.member, (item.name for item in type_.fields))
        message = f"`{name}` is of type {type_.name}, which has no field `{term.member}`"
        self.refuse("RV-0403", term, message, hint)
        return None

    def reading(self, name: Name, type_: Type) -> CheckedExpression:
        """The type or bounds that reading a name yields."""
        if isinstance(type_, IntegerType):
            bounds = self.known.get((name.kind, name.name, name.field), (type_.first, type_.last))
            return CheckedExpression(name, None, bounds, type_.unit)
        return CheckedExpression(name, type_)

    def literal(self, term: Term, expected: EnumerationType | None) -> CheckedExpression | None:
        """A name that is not one of the component's: an enumeration literal, then."""
        if term.kind == "name" and term.word.lower() in ("true", "false"):
            return CheckedExpression(Literal(term.word.capitalize(), BOOLEAN), BOOLEAN)
        known = self.vocabulary.readable.names()
        fitting = () if expected is None else expected.literals
        if term.word.lower() not in map(str.lower, fitting):
            kind = "name or literal"
            self.findings.unknown.append(Unknown(term.word, kind, (*fitting, *known)))
        if term.word.lower() == EVENT and not _is_literal_of(term.word, expected):
            message = f"`{EVENT}` has no value: {self.vocabulary.no_event}"
            told = "guard and effect of an `on` can read it, where the event has a type"
            self.refuse("RV-0403", term, message, told)
        elif term.kind == "member":
            message = f"`{term.word}` is no data item, parameter or input port of the component"
            self.refuse("RV-0403", term, message, meant(term.word, known))
        elif expected is None and term.word.lower() in self.vocabulary.literals:
            message = f"the type of the literal `{term.word}` cannot be determined here"
            self.refuse("RV-0410", term, message, "compare it with a name of its type")
        elif expected is None or expected is BOOLEAN:
            message = f"`{term.word}` is no data item, parameter or input port of the component"
            self.refuse("RV-0403", term, message, meant(term.word, known))
        else:
            for literal in expected.literals:
                if literal.lower() == term.word.lower():
                    self.findings.uses.append(literal_use(literal, expected, self.at(term)))
                    return CheckedExpression(Literal(literal, expected), expected)
            everything = (*expected.literals, *known)
            near = nearest(term.word, everything) is not None
            hint = meant(term.word, everything if near else expected.literals)
            message = f"`{term.word}` is no literal of {expected.name}"
            self.refuse("RV-0410", term, message, hint)
        return None

    def inside(self, term: Term) -> CheckedExpression | None:
        """``in(Region.State)``."""
        states = self.vocabulary.regions.look_up(term.word, self.at(term), self.findings)
        if states is None:
            return None
        state = states.look_up(term.member, self.at(term), self.findings)
        if state is None or not self._is_askable(term):
            return None
        region = self.vocabulary.regions.items[term.word.lower()][0]
        return CheckedExpression(InState(region, state), BOOLEAN)

    def _is_askable(self, term: Term) -> bool:
        """Whether a state may be asked for here; those of the own region in guards alone."""
        words, state = self.vocabulary, term.member.lower()
        own = words.own_region is not None and words.own_region.lower() == term.word.lower()
        if not own or (words.may_ask is not None and words.may_ask(state)):
            return True
        message, hint = (
            "a region cannot ask for its own state",
            "write the transition `from` that state",
        )
        if words.may_ask is not None:
            message = f"where the transition starts, it is known whether {term.member} is active"
        elif state in words.concurrent:
            message = "only a guard before choices can ask for a state of its own region"
            hint = f"set a data item in `entry` and `exit` of {term.member}, and read that"
        self.refuse("RV-0416", term, message, hint)
        return False

    # --- Functions and operators ---

    def call(self, term: Term) -> CheckedExpression | None:
        """A function applied."""
        function = term.word.lower()
        if function == OLD:
            return self.old(term)
        if function == SENT:
            return self.sent(term)
        if function not in FUNCTIONS:
            message = f"there is no function `{term.word}`"
            self.refuse("RV-0409", term, message, meant(function, (*FUNCTIONS, "in")))
            return None
        if len(term.operands) != FUNCTIONS[function]:
            wanted, given = FUNCTIONS[function], len(term.operands)
            noun = "argument" if wanted == 1 else "arguments"
            self.refuse("RV-0409", term, f"`{function}` takes {wanted} {noun}, not {given}")
            return None
        if function in PORT_TESTS:
            port = term.operands[0]
            if port.kind != "name":
                self.refuse("RV-0404", port, f"`{function}` takes the name of an input port")
                return None
            found = self.vocabulary.inputs.look_up(port.word, self.at(port), self.findings)
            return None if found is None else CheckedExpression(PortTest(found, function), BOOLEAN)
        return self.arithmetic(function, term, self.numbers(term, term.operands))

    def old(self, term: Term) -> CheckedExpression | None:
        """``old(item)``, which only a checker of `ensures` knows."""
        message = f"`{OLD}` has a meaning only in `ensures`"
        self.refuse("RV-0419", term, message, "name the data item itself")
        return None

    def sent(self, term: Term) -> CheckedExpression | None:
        """``sent(port)``, which only a checker of `ensures` knows."""
        message = f"`{SENT}` has a meaning only in `ensures`"
        self.refuse("RV-0421", term, message, "set a data item where you send, and read that")
        return None

    def operator(self, term: Term, expected: EnumerationType | None) -> CheckedExpression | None:
        """An operator applied."""
        if term.word == "if":
            return self.choose(term, expected)
        if term.word in ("and", "or", "not"):
            return self.logic(term)
        if term.word in COMPARISONS:
            return self.comparison(term)
        if len(term.operands) == 1:
            return self.sign(term)
        return self.arithmetic(term.word, term, self.numbers(term, term.operands))

    def sign(self, term: Term) -> CheckedExpression | None:
        """A sign before an operand."""
        operands = self.numbers(term, term.operands)
        if operands is None or term.word == "+":
            return None if operands is None else operands[0]
        inner = operands[0].expression
        if isinstance(inner, Literal) and isinstance(inner.value, int):
            value = -inner.value
            return CheckedExpression(Literal(value, None), None, (value, value), None, True)
        return self.arithmetic("neg", term, operands)

    def numbers(self, term: Term, operands: tuple[Term, ...]) -> list[CheckedExpression] | None:
        """The operands, all integers."""
        checked = [self.check(operand) for operand in operands]
        sound = [item for item in checked if item is not None]
        if len(sound) < len(checked):
            return None
        wrong = False
        for operand, item in zip(operands, sound, strict=True):
            if item.type is not None:
                message = f"`{term.word}` takes numbers, but this is {yielded(item)}"
                self.refuse("RV-0404", operand, message)
                wrong = True
        return None if wrong else sound

    def arithmetic(
        self, operator: str, term: Term, operands: list[CheckedExpression] | None
    ) -> CheckedExpression | None:
        """An operation on integers, its unit and its bounds."""
        if operands is None:
            return None
        bare = all(item.bare for item in operands)
        if operator in ("*", "/"):
            left, right = operands
            if right.unit is not None and (operator == "/" or left.unit is not None):
                message = (
                    f"the divisor counts {right.unit}; it must have no unit"
                    if operator == "/"
                    else f"both factors have a unit, {left.unit} and {right.unit}"
                )
                one = "divide by" if operator == "/" else "multiply by"
                self.refuse("RV-0405", term, message, f"{one} a plain number")
                return None
            unit = left.unit or right.unit
        elif not self.same_unit(term, operator, operands):
            return None
        else:
            unit = next((item.unit for item in operands if not item.bare), None)
        if operator == "/" and operands[1].bounds[0] <= 0 <= operands[1].bounds[1]:
            shown = range_text(operands[1].bounds)
            hint = "exclude 0 by `max(..., 1)`, or by `if` around the division"
            self.refuse("RV-0406", term, f"the divisor may be 0: it is {shown}", hint)
            return None
        bounds = intervals.apply(operator, tuple(item.bounds for item in operands))
        if max(abs(bounds[0]), abs(bounds[1])) > intervals.WORD:
            message = f"the result of `{operator}` may need more than 64 bits"
            self.refuse("RV-0408", term, message, "limit the operands by min, max or clamp")
            return None
        terms = tuple(item.expression for item in operands)
        made = folding.arithmetic(Operation(operator, terms, None, unit, *bounds))
        return CheckedExpression(made, None, bounds, unit, bare)

    def same_unit(self, term: Term, operator: str, operands: list[CheckedExpression]) -> bool:
        """Whether all operands count the same, or are bare numbers; reported when not."""
        units = list(dict.fromkeys(item.unit for item in operands if not item.bare))
        if len(units) <= 1:
            return True
        words = " and ".join(unit or "no unit" for unit in units)
        self.refuse("RV-0405", term, f"`{operator}` takes operands of one unit, not {words}")
        return False

    def logic(self, term: Term) -> CheckedExpression | None:
        """``and``, ``or`` or ``not``; the right operand knows what the left one says."""
        left = self.boolean(term.operands[0], f"`{term.word}`")
        if len(term.operands) == 1:
            if left is None:
                return None
            return CheckedExpression(folding.negated(left.expression), BOOLEAN)
        before = self.known
        if left is not None:
            self.known = narrowed(self.known, left.expression, term.word == "and")
        right = self.boolean(term.operands[1], f"`{term.word}`")
        self.known = before
        if left is None or right is None:
            return None
        return CheckedExpression(
            folding.joined(term.word, left.expression, right.expression), BOOLEAN
        )

    def boolean(self, term: Term, taker: str) -> CheckedExpression | None:
        """A condition."""
        checked = self.check(term, BOOLEAN)
        if checked is not None and checked.type is not BOOLEAN:
            message = f"{taker} takes a condition, but this is {yielded(checked)}"
            self.refuse("RV-0404", term, message)
            return None
        return checked

    def pair(
        self, left: Term, right: Term
    ) -> tuple[CheckedExpression | None, CheckedExpression | None]:
        """Two operands of one type: the one that has a type tells that of a literal."""
        first, second = (right, left) if self.is_free(left) else (left, right)
        one = self.check(first)
        told = one.type if one is not None and isinstance(one.type, EnumerationType) else None
        if one is None and self.is_free(second):
            return None, None
        two = self.check(second, told)
        return (two, one) if first is right else (one, two)

    def comparison(self, term: Term) -> CheckedExpression | None:
        """``=``, ``/=`` on numbers and enumerations, the others on numbers."""
        left, right = self.pair(term.operands[0], term.operands[1])
        if left is None or right is None:
            return None
        wrong = left.type is not right.type or isinstance(left.type, RecordType)
        if wrong:
            message = f"`{term.word}` cannot compare {yielded(left)} with {yielded(right)}"
            hint = "compare their fields" if isinstance(left.type, RecordType) else None
            self.refuse("RV-0404", term, message, hint)
            return None
        if left.type is not None and term.word not in ("=", "/="):
            message = f"`{term.word}` compares numbers, not values of type {left.type.name}"
            self.refuse("RV-0404", term, message, "enumerations have `=` and `/=`")
            return None
        if left.type is None and not self.same_unit(term, term.word, [left, right]):
            return None
        decided = folding.decided(term.word, left.expression, right.expression)
        if decided is not None:
            outcome = "true" if decided.holds else "false"
            message = f"this comparison is always {outcome}: {decided.reason}"
            hint = f"compare something that changes, or write `{outcome}`"
            self.refuse("RV-0417", term, message, hint)
            return None
        compared = folding.compared(term.word, left.expression, right.expression)
        return CheckedExpression(compared, BOOLEAN)

    def choose(self, term: Term, expected: EnumerationType | None) -> CheckedExpression | None:
        """``if condition then a else b``; each branch knows what the condition says."""
        condition = self.boolean(term.operands[0], "`if`")
        before = self.known
        if condition is not None:
            self.known = narrowed(before, condition.expression, True)
        checked = self.check(term.operands[1], expected)
        if condition is not None:
            self.known = narrowed(before, condition.expression, False)
        told = expected
        if checked is not None and isinstance(checked.type, EnumerationType):
            told = checked.type
        other = self.check(term.operands[2], told)
        self.known = before
        if condition is None or checked is None or other is None:
            return None
        if checked.type is not other.type or isinstance(checked.type, RecordType):
            message = f"`if` cannot yield {yielded(checked)} or {yielded(other)}"
            self.refuse("RV-0404", term, message)
            return None
        terms = (condition.expression, checked.expression, other.expression)
        if checked.type is not None:
            return CheckedExpression(
                folding.chosen(Operation("if", terms, checked.type)), checked.type
            )
        if not self.same_unit(term, "if", [checked, other]):
            return None
        bounds = intervals.apply("if", (checked.bounds, other.bounds))
        unit = other.unit if checked.bare else checked.unit
        operation = Operation("if", terms, None, unit, *bounds)
        chosen = folding.chosen(operation)
        return CheckedExpression(chosen, None, bounds, unit, checked.bare and other.bare)


def _is_literal_of(word: str, type_: EnumerationType | None) -> bool:
    """Whether a word is a literal of the type that its place asks for."""
    return type_ is not None and word.lower() in (one.lower() for one in type_.literals)


# --- Entry points ----------------------------------------------------------------


def read_expression(
    text: int | bool | str,
    place: TextPlace,
    vocabulary: Vocabulary,
    findings: Findings,
    expected: EnumerationType | None = None,
    checks: Callable[[Vocabulary, Findings, TextPlace], Checker] = Checker,
) -> CheckedExpression | None:
    """The typed expression that a value in a model stands for; None after an error."""
    if isinstance(text, bool):
        return CheckedExpression(Literal(str(text), BOOLEAN), BOOLEAN)
    term = parse(str(text))
    checker = checks(vocabulary, findings, place)
    if isinstance(term, Malformed):
        where = checker.at(Term("name", term.at, ""))
        findings.error(term.code, where, term.message, hint=term.hint)
        return None
    return checker.check(term, expected)


def condition(
    text: int | bool | str,
    place: TextPlace,
    vocabulary: Vocabulary,
    findings: Findings,
    taker: str,
    checks: Callable[[Vocabulary, Findings, TextPlace], Checker] = Checker,
) -> Expression | None:
    """A Boolean expression for ``taker``, such as ``guard``."""
    checked = read_expression(text, place, vocabulary, findings, BOOLEAN, checks)
    if checked is None:
        return None
    if checked.type is not BOOLEAN:
        message = f"`{taker}` takes a condition, but this is {yielded(checked)}"
        findings.error("RV-0404", place.origin, message)
        return None
    return checked.expression


def fitting(
    text: int | bool | str,
    place: TextPlace,
    target: str,
    type_: ScalarType,
    vocabulary: Vocabulary,
    findings: Findings,
) -> Expression | None:
    """An expression that is of the target's type and provably within its range."""
    expected = type_ if isinstance(type_, EnumerationType) else None
    checked = read_expression(text, place, vocabulary, findings, expected)
    if checked is None:
        return None
    if isinstance(type_, EnumerationType) or checked.type is not None:
        if checked.type is type_:
            return checked.expression
        message = f"`{target}` is of type {type_.name}, but this is {yielded(checked)}"
        findings.error("RV-0404", place.origin, message)
        return None
    if not checked.bare and checked.unit != type_.unit:
        units = type_.unit or "no unit", checked.unit or "no unit"
        message = f"`{target}` counts {units[0]}, but this counts {units[1]}"
        findings.error("RV-0405", place.origin, message)
        return None
    low, high = checked.bounds
    if type_.first <= low and high <= type_.last:
        return checked.expression
    wanted = range_text((type_.first, type_.last), type_.unit)
    given = range_text(checked.bounds)
    shown = str(text) if len(str(text)) <= 60 and "\n" not in str(text) else "..."
    if low == high:
        message, hint = f"`{target}` takes {wanted}, but this is {low}", None
    else:
        message = f"`{target}` takes {wanted}, but this may be {given}"
        limited = f"clamp({shown}, {type_.first}, {type_.last})"
        if type_.first <= low:
            limited = f"min({shown}, {type_.last})"
        elif high <= type_.last:
            limited = f"max({shown}, {type_.first})"
        hint = f"limit it, for example by `{limited}`"
    findings.error("RV-0407", place.origin, message, hint=hint)
    return None
