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


class Evaluation:
    """The value of a static expression over named numbers, and the names it asks for."""

    def __init__(self, items: Sequence[Token], known: Mapping[str, int]) -> None:
        self.items = list(items)
        self.known = known
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
        while self._taken("and"):
            self._taken("then")
            other = self._comparison()
            value = int(bool(value) and bool(other))
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
        if word in self.known:
            self.names.add(word)
            return self.known[word]
        raise ValueError(f"`{word}` is not declared before")


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
    digest: tuple[str, int]
    problems: list[tuple[int, str]]
    """Conditions that are violated, and text that is none of a certificate."""
    conditions: int


def certificate(path: Path, package: str) -> Certificate:
    """The certificate in a file."""
    items = read(path)
    found = Certificate(path, {}, ("", 1), [], 0)
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
        evaluated = Evaluation(part[4:], known)
        if low[0] in known:
            found.problems.append((line, f"{part[0].text} is declared twice"))
        known[low[0]] = evaluated.value
        names = frozenset(evaluated.names)
        found.numbers[low[0]] = Number(part[0].text, line, evaluated.value, names)
    elif low[0] == "pragma" and low[1] in ("compile_time_error", "assert"):
        condition, *message = split(part[3:-1], ",")
        held = bool(Evaluation(condition, known).value)
        found.conditions += 1
        if held != (low[1] == "assert"):
            words_ = "".join(t.text.strip('"') for p in message for t in p if t.text[0] == '"')
            found.problems.append((line, words_ or "a condition that must hold does not"))
    elif low[:3] != ["pragma", "warnings", "("]:
        found.problems.append((line, f"`{part[0].text}` begins nothing that a certificate has"))


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
    """The alternatives of ``function NAME (...) return ... is (case X is when ...)``, by choice."""
    for place, token in enumerate(items):
        if token.low != "function" or items[place + 1].low != function.lower():
            continue
        at = place + 2
        if items[at].text == "(":
            at = closing(items, at)
        while items[at].low != "is":
            at += 1
        last = closing(items, at + 1)
        while at < last and [t.low for t in items[at + 1 : at + 3]] != ["(", "case"]:
            at += 1
        if at == last:
            return {}
        body = items[at + 5 : closing(items, at + 1)]
        found: dict[str, tuple[Token, list[Token]]] = {}
        for part in split(body, ","):
            if len(part) > 3 and part[0].low == "when":
                arrow = next(n for n, t in enumerate(part) if t.text == "=>")
                for choice in split(part[1:arrow], "|"):
                    again = " again" if choice[0].low in found else ""
                    found[f"{choice[0].low}{again}"] = choice[0], part[arrow + 1 :]
        return found
    return {}
