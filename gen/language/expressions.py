"""Expressions as text to terms with places: the grammar, and nothing of types.

    height = if homed then position.low + 1 else 0      (an example)

Operators, loosest first: ``if then else``, ``or``, ``and``, ``not``, the
comparisons ``= /= < <= > >=``, ``+ -``, ``* /``, unary ``-``. Functions:
abs(x), min(x, y), max(x, y), clamp(x, low, high), fresh(port), stale(port),
never_received(port), in(Region.State).
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache

from lark import Lark, Token, Transformer, UnexpectedInput, v_args
from lark.exceptions import UnexpectedCharacters, UnexpectedEOF, UnexpectedToken

LONGEST_TEXT = 2_000
"""Characters of an expression at most."""
DEEPEST_TERM = 60
"""Operators and functions inside each other at most."""

GRAMMAR = r"""
?start: choice

?choice: "if" choice "then" choice "else" choice -> choose
       | disjunction
?disjunction: conjunction
            | disjunction OR conjunction -> binary
?conjunction: negation
            | conjunction AND negation -> binary
?negation: comparison
         | NOT negation -> unary
?comparison: sum
           | sum COMPARE sum -> binary
?sum: term
    | sum SIGN term -> binary
?term: signed
     | term FACTOR signed -> binary
?signed: atom
       | SIGN signed -> unary
?atom: NUMBER -> number
     | NAME -> name
     | NAME "." NAME -> member
     | NAME "(" [choice ("," choice)*] ")" -> call
     | "in" "(" NAME "." NAME ")" -> inside
     | "(" choice ")"

OR: "or"
AND: "and"
NOT: "not"
COMPARE: "/=" | "<=" | ">=" | "=" | "<" | ">"
SIGN: "+" | "-"
FACTOR: "*" | "/"
NUMBER: /0x[0-9A-Fa-f]+(_[0-9A-Fa-f]+)*|[0-9]+(_[0-9]+)*/
NAME: /[A-Za-z][A-Za-z0-9_]*/
%ignore /[ \n]+/
"""


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


def _at(token: Token) -> int:
    return token.start_pos or 0


@v_args(inline=True)
class ExpressionBuilder(Transformer[Token, Term]):
    """Builds terms while the parser reduces, so that nothing recurses."""

    def number(self, digits: Token) -> Term:
        """A number."""
        return _term("number", _at(digits), str(digits))

    def name(self, name: Token) -> Term:
        """A name."""
        return _term("name", _at(name), str(name))

    def member(self, name: Token, member: Token) -> Term:
        """A name and a field."""
        return _term("member", _at(name), str(name), member=str(member))

    def call(self, name: Token, *arguments: Term | None) -> Term:
        """A function applied."""
        given = [argument for argument in arguments if argument is not None]
        return _term("call", _at(name), str(name), *given)

    def inside(self, region: Token, state: Token) -> Term:
        """A test of a region's state."""
        return _term("inside", _at(region), str(region), member=str(state))

    def unary(self, operator: Token, operand: Term) -> Term:
        """``not``, or a sign."""
        return _term("operator", _at(operator), str(operator), operand)

    def binary(self, left: Term, operator: Token, right: Term) -> Term:
        """An operator between two operands."""
        return _term("operator", _at(operator), str(operator), left, right)

    def choose(self, condition: Term, then: Term, otherwise: Term) -> Term:
        """One value or another."""
        return _term("operator", condition.at, "if", condition, then, otherwise)


PARSER = Lark(
    GRAMMAR,
    parser="lalr",
    transformer=ExpressionBuilder(),
    maybe_placeholders=False,
    propagate_positions=True,
)

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
"""What other languages write, and what this one does."""


@lru_cache(maxsize=4096)
def parse(text: str) -> Term | Malformed:
    """The term that a text stands for, or why there is none."""
    if len(text) > LONGEST_TEXT:
        message = f"an expression has at most {LONGEST_TEXT} characters"
        return Malformed("RV-0402", 0, message, "split it")
    try:
        term = PARSER.parse(text)
    except TooDeepError:
        message = f"an expression nests at most {DEEPEST_TERM} operators deep"
        return Malformed("RV-0402", 0, message, "split it")
    except UnexpectedInput as problem:
        return _malformed(text, problem)
    assert isinstance(term, Term)
    return term


def _malformed(text: str, problem: UnexpectedInput) -> Malformed:
    """The parser's complaint in our words."""
    ended = isinstance(problem, UnexpectedEOF) or (
        isinstance(problem, UnexpectedToken) and problem.token.type == "$END"
    )
    if ended or problem.pos_in_stream is None or problem.pos_in_stream < 0:
        at = len(text.rstrip())
        return Malformed("RV-0401", max(0, at - 1), "the expression ends too early")
    at = problem.pos_in_stream
    rest = text[max(0, at - 1) :]
    hint = next((words for sign, words in FOREIGN.items() if rest.startswith(sign)), None)
    hint = hint or next((w for sign, w in FOREIGN.items() if text[at:].startswith(sign)), None)
    if isinstance(problem, UnexpectedCharacters):
        return Malformed("RV-0401", at, f"`{text[at]}` has no place in an expression", hint)
    found = re.match(r"\w+|\W", text[at:])
    word = found[0] if found else text[at : at + 1]
    if hint is None and word in ("=", "/=", "<", ">"):
        hint = "comparisons cannot be chained: join them by `and`"
    return Malformed("RV-0401", at, f"`{word}` has no place here in the expression", hint)
