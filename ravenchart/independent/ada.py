# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""As much of Ada as the generated declarations need: tokens, named numbers, case expressions."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from .findings import UnusableError

TOKEN = re.compile(
    r'"(?:[^"]|"")*"|\d[\d_]*#[0-9A-Fa-f_]+#|\d[\d_]*|[A-Za-z]\w*(?:\.[A-Za-z]\w*)*'
    r"|:=|=>|/=|<=|>=|\.\.|\*\*|<>|\S"
)


@dataclass(frozen=True, slots=True)
class Token:
    """A word of the text; expanded names are one word."""

    text: str
    line: int

    @property
    def low(self) -> str:
        """For comparison: case does not count."""
        return self.text.lower()


@lru_cache(maxsize=64)
def tokens(text: str) -> tuple[Token, ...]:
    """The words of a unit without its comments."""
    found: list[Token] = []
    for number, line in enumerate(text.split("\n"), 1):
        for match in TOKEN.finditer(line):
            if match[0] == "-" and line.startswith("--", match.start()):
                break
            found.append(Token(match[0], number))
    return tuple(found)


def read(path: Path) -> Sequence[Token]:
    """The words of a file."""
    try:
        found = tokens(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as problem:
        raise UnusableError(f"cannot read {path}: {problem}") from problem
    if len(found) < 3 or (found[-3].low, found[-1].text) != ("end", ";"):
        raise UnusableError(f"{path} is not a whole package")
    return found


def words(text: str) -> tuple[str, ...]:
    """An expression in lower case, word by word."""
    return tuple(token.low for token in tokens(text))


def split(items: Sequence[Token], at: str) -> Iterator[list[Token]]:
    """The parts between separators that stand outside all parentheses."""
    part: list[Token] = []
    depth = 0
    for token in items:
        depth += {"(": 1, ")": -1}.get(token.text, 0)
        if depth == 0 and token.low == at:
            yield part
            part = []
        else:
            part.append(token)
    yield part


def closing(items: Sequence[Token], start: int) -> int:
    """The place of the parenthesis that closes the one at ``start``."""
    depth = 0
    for place in range(start, len(items)):
        depth += {"(": 1, ")": -1}.get(items[place].text, 0)
        if depth == 0:
            return place
    raise UnusableError(f"line {items[start].line}: a parenthesis is not closed")


# --- Numbers -------------------------------------------------------------------------


WINDOWS = 2**60
"""Of the runtime's Response_Times: times from 0 on that are below are a Window."""
LAST = 2**62 - 1
"""The last Time there: a sum or product that exceeds it is this."""
PARAMETERS = {"w": ("window", WINDOWS), "stuffed": ("positive", 2**31)}
"""The parameters of functions, with their types and what they are below."""


def demand(window: int, late: int, period: int, wcet: int, more: int = 0) -> int:
    """Demand of the runtime's Response_Times: ceiling ((W + J) / T) * C, and what comes besides."""
    if not (0 <= window < WINDOWS and 0 <= late < WINDOWS and 0 <= wcet < WINDOWS):
        raise ValueError("a Window out of range")
    if not (0 < period < WINDOWS and 0 <= more <= LAST):
        raise ValueError("a Separation or Time out of range")
    return min(LAST, -(-(window + late) // period) * wcet + more)


@dataclass(frozen=True, slots=True)
class Function:
    """A static function: its name and that of its parameter, its body, and all that it counts."""

    name: str
    parameter: str
    body: tuple[Token, ...]
    names: frozenset[str]
    before: tuple[Function, ...]
    """Those that it calls, and those that they call, as they are declared."""


class Evaluation:
    """The value of a static expression over named numbers, and the names it asks for."""

    def __init__(
        self,
        items: Sequence[Token],
        known: Mapping[str, int],
        functions: Mapping[str, Function] | None = None,
        values: Mapping[tuple[str, int], int] | None = None,
    ) -> None:
        self.items = list(items)
        self.known = known
        self.functions = functions or {}
        self.values = values or {}
        self.names: set[str] = set()
        self.place = 0
        self.value = self._relation()
        if self.place < len(self.items):
            raise ValueError(f"`{self.items[self.place].text}` is not expected here")

    def _next(self) -> str:
        return self.items[self.place].low if self.place < len(self.items) else ""

    def _taken(self, *texts: str) -> str:
        found = self._next()
        if found not in texts:
            return ""
        self.place += 1
        return found

    def _relation(self) -> int:
        value = self._comparison()
        while operator := self._taken("and", "or"):
            self._taken("then" if operator == "and" else "else")
            other = self._comparison()
            both, either = bool(value) and bool(other), bool(value) or bool(other)
            value = int(both if operator == "and" else either)
        return value

    def _comparison(self) -> int:
        left = self._sum()
        operator = self._taken(">", "<", ">=", "<=", "/=", "=")
        if not operator:
            return left
        right = self._sum()
        return int(
            (operator in (">", ">=", "/=") and left > right)
            or (operator in ("<", "<=", "/=") and left < right)
            or (operator in ("=", "<=", ">=") and left == right)
        )

    def _sum(self) -> int:
        value = -self._product() if self._taken("-") else self._product()
        while operator := self._taken("+", "-"):
            other = self._product()
            value += other if operator == "+" else -other
        return value

    def _product(self) -> int:
        value = self._power()
        while operator := self._taken("*", "/"):
            other = self._power()
            if operator == "*":
                value *= other
            elif other == 0:
                raise ValueError("a division by zero")
            else:  # Ada rounds towards zero
                sign = -1 if (value < 0) != (other < 0) else 1
                value = sign * (abs(value) // abs(other))
        return value

    def _power(self) -> int:
        value = self._primary()
        if self._taken("**"):
            exponent = self._primary()
            if not 0 <= exponent <= 100_000:
                raise ValueError("an exponent out of range")
            return int(value**exponent)
        return value

    def _primary(self) -> int:
        word = self._next()
        self.place += 1
        if word == "(":
            value = self._relation()
            if not self._taken(")"):
                raise ValueError("`)` is missing")
            return value
        if "#" in word and word[:1].isdigit():
            base, digits, _ = word.split("#")
            return int(digits.replace("_", ""), int(base))
        if word[:1].isdigit():
            return int(word.replace("_", ""))
        if word == "system.default_priority":
            return 0
        if word in ("time", "demand") or word in self.functions:
            return self._called(word)
        if word in self.known:
            self.names.add(word)
            return self.known[word]
        raise ValueError(f"`{word}` is not declared before")

    def _called(self, word: str) -> int:
        """A call of one of the certificate's functions, or of those that it finds defined."""
        if word == "time":
            word = self._taken("max", "min") if self._taken("'") else "time"
        values = self._arguments()
        if word == "time" and len(values) == 1:
            return values[0]
        if word in ("max", "min") and len(values) == 2:
            return max(values) if word == "max" else min(values)
        if word == "demand" and len(values) in (4, 5):
            return demand(*values)
        if word not in self.functions or len(values) != 1:
            raise ValueError(f"`{word}` has {len(values)} parameters")
        self.names |= self.functions[word].names
        return self._within(self.functions[word], values[0])

    def _arguments(self) -> list[int]:
        if not self._taken("("):
            raise ValueError("`(` is missing")
        values = [self._relation()]
        while self._taken(","):
            values.append(self._relation())
        if not self._taken(")"):
            raise ValueError("`)` is missing")
        return values

    def _within(self, function: Function, given: int) -> int:
        """The value for an argument; in the order of declaration, so that no call is deep."""
        if given not in range(PARAMETERS[function.parameter][1]):
            raise ValueError(f"{given} is out of the range of `{function.parameter}`")
        values = dict(self.values)
        for one in (*function.before, function):
            if (one.name, given) not in values:
                known = {**self.known, one.parameter: given}
                found = Evaluation(one.body, known, self.functions, values)
                values[one.name, given] = found.value
        self.values = values
        return values[function.name, given]


@dataclass(frozen=True, slots=True)
class Number:
    """A named number."""

    name: str
    line: int
    value: int
    names: frozenset[str]


@dataclass(slots=True)
class Certificate:
    """A package of named numbers, and of conditions that must not hold (or must)."""

    path: Path
    numbers: dict[str, Number]
    functions: dict[str, Function]
    digest: tuple[str, int]
    problems: list[tuple[int, str]]
    """Conditions that are violated, and text that is none of a certificate."""
    conditions: int


def certificate(path: Path, package: str) -> Certificate:
    """The certificate in a file."""
    items = read(path)
    found = Certificate(path, {}, {}, ("", 1), [], 0)
    known: dict[str, int] = {}
    start = next((n for n, t in enumerate(items) if t.low == "is"), len(items) - 1)
    heading = [token.low for token in items[: start + 1]]
    if package.lower() not in heading:
        found.problems.append((1, f"this is not the package {package}"))
    for part in split(items[start + 1 :], ";"):
        if not part or part[0].low == "end":
            continue
        try:
            _take(found, part, known)
        except (ValueError, KeyError, IndexError) as problem:
            found.problems.append((part[0].line, f"cannot be evaluated: {problem}"))
    return found


def _take(found: Certificate, part: list[Token], known: dict[str, int]) -> None:
    """One declaration or pragma."""
    low = [token.low for token in part]
    line = part[0].line
    if low[1:4] == [":", "constant", "string"]:
        text = "".join(t.text.strip('"') for t in part[5:] if t.text.startswith('"'))
        found.digest = text, part[5].line if len(part) > 5 else line
    elif low[1:4] == [":", "constant", ":="]:
        evaluated = Evaluation(part[4:], known, found.functions)
        if low[0] in known:
            found.problems.append((line, f"{part[0].text} is declared twice"))
        known[low[0]] = evaluated.value
        names = frozenset(evaluated.names)
        found.numbers[low[0]] = Number(part[0].text, line, evaluated.value, names)
    elif low[0] == "pragma" and low[1] in ("compile_time_error", "assert"):
        condition, *message = split(part[3:-1], ",")
        held = bool(Evaluation(condition, known, found.functions).value)
        found.conditions += 1
        if held != (low[1] == "assert"):
            words_ = "".join(t.text.strip('"') for p in message for t in p if t.text[0] == '"')
            found.problems.append((line, words_ or "a condition that must hold does not"))
    elif low[0] == "function":
        _function(found, part, known)
    elif low[:3] != ["pragma", "warnings", "("] and low != USED:
        found.problems.append((line, f"`{part[0].text}` begins nothing that a certificate has"))


def _function(found: Certificate, part: list[Token], known: dict[str, int]) -> None:
    """One function: of a window, or of the bits of a frame."""
    low = [token.low for token in part]
    name, parameter, body = low[1], low[3], tuple(part[11:-3])
    type_, _ = PARAMETERS.get(parameter, ("", 0))
    heading = ["(", parameter, ":", type_, ")", "return", "time", "is", "("]
    if low[2:11] != heading or low[-3:] != [")", "with", "static"]:
        raise ValueError("this is no static function of a certificate")
    if name in found.functions or name in known or name in ("demand", "time", *PARAMETERS):
        raise ValueError(f"{part[1].text} is declared twice")
    used = {token.low for token in body}
    names = {word for word in used if word in known}
    calls = [function for word, function in found.functions.items() if word in used]
    whole = {one.name for called in calls for one in (*called.before, called)}
    before = tuple(one for word, one in found.functions.items() if word in whole)
    names |= {word for called in calls for word in called.names}
    made = Function(name, parameter, body, frozenset(names), before)
    Evaluation(body, {**known, parameter: 1}, found.functions, {(one.name, 1): 0 for one in before})
    found.functions[name] = made


USED = ["use", "ravenchart.response_times"]

# --- Charts --------------------------------------------------------------------------


def enumeration(items: Sequence[Token], name: str) -> list[Token]:
    """The literals of ``type NAME is (...)``; none where it is not declared."""
    for place, token in enumerate(items):
        if token.low == "type" and [t.low for t in items[place + 1 : place + 4]] == [
            name.lower(),
            "is",
            "(",
        ]:
            end = closing(items, place + 3)
            return [part[0] for part in split(items[place + 4 : end], ",") if part]
    return []


def cases(items: Sequence[Token], function: str) -> dict[str, tuple[Token, list[Token]]]:
    """The alternatives of ``function NAME (...) return ... is (... case X is when ...)``, by
    choice."""
    return alternatives(items, function)[1]


def alternatives(
    items: Sequence[Token], function: str
) -> tuple[list[Token], dict[str, tuple[Token, list[Token]]]]:
    """The tokens before the case of an expression function, and its alternatives by choice."""
    given = _given(items, function)
    at = _place(given, "(", "case")
    if at is None:
        return [], {}
    found: dict[str, tuple[Token, list[Token]]] = {}
    for part in split(given[at + 4 : closing(given, at)], ","):
        if len(part) > 3 and part[0].low == "when":
            arrow = next(n for n, t in enumerate(part) if t.text == "=>")
            for choice in split(part[1:arrow], "|"):
                again = " again" if choice[0].low in found else ""
                found[f"{choice[0].low}{again}"] = choice[0], part[arrow + 1 :]
    return given[:at], found


def elements(
    items: Sequence[Token], function: str
) -> tuple[list[Token], dict[str, tuple[Token, list[Token]]]]:
    """The tokens before the array of an expression function, and its elements by position."""
    given = _given(items, function)
    at = _place(given, "(", "1", "=>")
    if at is None:
        return [], {}
    parts = split(given[at + 1 : closing(given, at)], ",")
    return given[1:at], {part[0].text: (part[0], part[2:]) for part in parts}


def _given(items: Sequence[Token], function: str) -> list[Token]:
    """The expression of an expression function, with parentheses; empty where none is declared."""
    for place, token in enumerate(items):
        if token.low == "function" and items[place + 1].low == function.lower():
            at = place + 2
            if items[at].text == "(":
                at = closing(items, at)
            while items[at].low != "is":
                at += 1
            return list(items[at + 1 : closing(items, at + 1) + 1])
    return []


def _place(items: Sequence[Token], *words_: str) -> int | None:
    """Where these words stand first."""
    size = len(words_)
    places = range(len(items) - size)
    return next((n for n in places if tuple(t.low for t in items[n : n + size]) == words_), None)
