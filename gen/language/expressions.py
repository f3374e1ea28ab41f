# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Expressions as text to terms with places: the grammar, and nothing of types.

    height = if homed then position.low + 1 else 0      (an example)

Operators, loosest first: ``if then else``, ``or``, ``and``, ``not``, the
comparisons ``= /= < <= > >=``, ``+ -``, ``* /``, unary ``-``. Functions:
abs(x), min(x, y), max(x, y), clamp(x, low, high), fresh(port), stale(port),
never_received(port), in(Region.State).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache

LONGEST_TEXT = 2_000
"""Characters of an expression at most."""
DEEPEST_TERM = 60
"""Operators and functions inside each other at most."""

OPENING, ELSE, NOT, COMPARISON, UNARY = 0, 1, 4, 5, 8
"""Levels: what is of a higher one binds tighter. Nothing binds across an opening."""
BINARY = {"or": 2, "and": 3, "+": 6, "-": 6, "*": 7, "/": 7} | dict.fromkeys(
    ("=", "/=", "<", "<=", ">", ">="), COMPARISON
)

TOKEN = re.compile(
    r"(?P<number>0x[0-9A-Fa-f]+(?:_[0-9A-Fa-f]+)*|[0-9]+(?:_[0-9]+)*)"
    r"|(?P<word>[A-Za-z][A-Za-z0-9_]*)"
    r"|(?P<sign>/=|<=|>=|[-+*/=<>().,])"
    r"|(?P<space>[ \n]+)"
    r"|(?P<foreign>.)",
    re.DOTALL,
)


@dataclass(frozen=True, slots=True)
class Term:
    """One operator, function, name or number, and where it stands in the text.

    ``kind`` is ``number``, ``name``, ``member``, ``call``, ``inside`` or
    ``operator``; ``word`` the number's digits, the name, or the operator.
    """

    kind: str
    at: int
    word: str
    member: str = ""
    operands: tuple[Term, ...] = ()
    depth: int = 0


@dataclass(frozen=True, slots=True)
class Malformed:
    """Why a text is no expression, and where."""

    code: str
    at: int
    message: str
    hint: str | None = None


class TooDeepError(Exception):
    """Ends the parsing of an expression; never leaves this module."""


def _term(kind: str, at: int, word: str, *operands: Term, member: str = "") -> Term:
    depth = 1 + max((operand.depth for operand in operands), default=0)
    if depth > DEEPEST_TERM:
        raise TooDeepError
    return Term(kind, at, word, member, operands, depth)


@dataclass(frozen=True, slots=True)
class Token:
    """A number, word or sign; ``kind`` is ``end`` of the one behind the last."""

    kind: str
    text: str
    at: int


class MisplacedError(Exception):
    """Ends the parsing of an expression at a token; never leaves this module."""

    def __init__(self, token: Token) -> None:
        """Because of ``token``."""
        super().__init__(token.text)
        self.token = token


@dataclass(slots=True)
class Waiting:
    """An operator, function, ``if`` or parenthesis whose last operand is still to come."""

    level: int
    kind: str
    at: int
    word: str
    operands: list[Term] = field(default_factory=list)


class Parser:
    """Reads one text. Operators that wait for operands are in a list, so that nothing recurses."""

    def __init__(self, text: str) -> None:
        """Before the first token."""
        self._tokens = _tokens(text)
        self._token = next(self._tokens)
        self._waiting: list[Waiting] = []

    def term(self) -> Term:
        """The whole text."""
        while True:
            found = self._after(self._atom())
            if found is not None:
                return found

    def _take(self, *texts: str, word: bool = False) -> Token | None:
        """The next token where it is one of these, or a word; else it stays the next."""
        token = self._token
        if token.text not in texts and not (word and token.kind == "word"):
            return None
        if token.kind != "end":
            self._token = next(self._tokens)
        return token

    def _must(self, *texts: str, word: bool = False) -> Token:
        found = self._take(*texts, word=word)
        if found is None:
            raise MisplacedError(self._token)
        return found

    @property
    def _level(self) -> int:
        """Of the innermost that waits."""
        return self._waiting[-1].level if self._waiting else OPENING

    def _wait(self, level: int, kind: str, token: Token, *operands: Term) -> None:
        self._waiting.append(Waiting(level, kind, token.at, token.text, list(operands)))

    # --- where an operand is due

    def _atom(self) -> Term:
        """The next number, name, test or function without operands; what is before it waits."""
        while True:
            if found := self._take("("):
                self._wait(OPENING, "(", found)
            elif found := self._take("+", "-"):
                self._wait(UNARY, "operator", found)
            elif self._level <= NOT and (found := self._take("not")):
                self._wait(NOT, "operator", found)
            elif self._level <= ELSE and (found := self._take("if")):
                self._wait(OPENING, "if", found)
            elif found := self._take("in"):
                return self._inside(found)
            elif self._token.kind == "number":
                found = self._must(self._token.text)
                return _term("number", found.at, found.text)
            elif self._token.text in ("not", "if"):
                raise MisplacedError(self._token)
            elif named := self._named(self._must(word=True)):
                return named

    def _inside(self, test: Token) -> Term:
        """A test of a region's state, behind its first word."""
        self._must("(")
        region = self._must(word=True)
        self._must(".")
        state = self._must(word=True)
        self._must(")")
        return _term("inside", region.at, region.text, member=state.text)

    def _named(self, name: Token) -> Term | None:
        """The term that a name begins; None where operands of a function are due."""
        if self._take("."):
            member = self._must(word=True)
            return _term("member", name.at, name.text, member=member.text)
        if self._take("("):
            if self._take(")"):
                return _term("call", name.at, name.text)
            self._wait(OPENING, "call", name)
            return None
        return _term("name", name.at, name.text)

    # --- behind an operand

    def _after(self, operand: Term) -> Term | None:
        """The whole text's term at its end; None where another operand is due."""
        while True:
            if found := self._take(*BINARY):
                level = BINARY[found.text]
                operand = self._bound(operand, level)
                if level == self._level == COMPARISON:  # they cannot be chained
                    raise MisplacedError(found)
                self._wait(level, "operator", found, operand)
                return None
            operand = self._bound(operand, ELSE)
            if not self._waiting:
                self._must("")
                return operand
            last = self._waiting[-1]
            if last.kind == "if":
                self._choose(last, operand)
                return None
            if last.kind == "call" and self._take(","):
                last.operands.append(operand)
                return None
            self._must(")")
            self._waiting.pop()
            if last.kind == "call":
                operand = _term("call", last.at, last.word, *last.operands, operand)

    def _bound(self, operand: Term, level: int) -> Term:
        """All that binds as tight or tighter takes the operand; a comparison no other one."""
        while self._level > level or self._level == level != COMPARISON:
            last = self._waiting.pop()
            operand = _term(last.kind, last.at, last.word, *last.operands, operand)
        return operand

    def _choose(self, last: Waiting, operand: Term) -> None:
        """A condition ends at `then`, and what follows that at `else`."""
        self._must("else" if last.operands else "then")
        last.operands.append(operand)
        if len(last.operands) == 2:
            last.level, last.kind, last.at = ELSE, "operator", last.operands[0].at


def _tokens(text: str) -> Iterator[Token]:
    """The tokens of a text, and one at its end."""
    for found in TOKEN.finditer(text):
        kind = found.lastgroup or ""
        if kind != "space":
            yield Token(kind, found[0], found.start())
    yield Token("end", "", len(text))


FOREIGN = {
    "==": "equality is `=`",
    "!=": "inequality is `/=`",
    "<>": "inequality is `/=`",
    "&&": "write `and`",
    "||": "write `or`",
    "!": "write `not`",
    ":=": "a value is given by `set:` and `to:`",
    "%": "there is no remainder operator",
    "?": "write `if a then b else c`",
    "**": "there is no power operator",
}
"""Spellings of other languages, each with that of this one."""


@lru_cache(maxsize=4096)
def parse(text: str) -> Term | Malformed:
    """The term that a text stands for, or why there is none."""
    if len(text) > LONGEST_TEXT:
        message = f"an expression has at most {LONGEST_TEXT} characters"
        return Malformed("RV-0402", 0, message, "split it")
    try:
        return Parser(text).term()
    except TooDeepError:
        message = f"an expression nests at most {DEEPEST_TERM} operators deep"
        return Malformed("RV-0402", 0, message, "split it")
    except MisplacedError as problem:
        return _malformed(text, problem.token)


def _malformed(text: str, token: Token) -> Malformed:
    """Why an expression ends at a token that has no place there."""
    if token.kind == "end":
        at = len(text.rstrip())
        return Malformed("RV-0401", max(0, at - 1), "the expression ends too early")
    at = token.at
    rest = text[max(0, at - 1) :]
    hint = next((words for sign, words in FOREIGN.items() if rest.startswith(sign)), None)
    hint = hint or next((w for sign, w in FOREIGN.items() if text[at:].startswith(sign)), None)
    if token.kind == "foreign":
        return Malformed("RV-0401", at, f"`{token.text}` has no place in an expression", hint)
    found = re.match(r"\w+|\W", text[at:])
    word = found[0] if found else token.text
    if hint is None and word.lower() in ("mod", "rem"):
        hint = FOREIGN["%"]
    if hint is None and word in ("=", "/=", "<", ">"):
        hint = "comparisons cannot be chained: join them by `and`"
    return Malformed("RV-0401", at, f"`{word}` has no place here in the expression", hint)
