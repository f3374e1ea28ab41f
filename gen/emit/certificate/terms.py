"""Named numbers and the checks between them, as Ada constructs."""

from __future__ import annotations

from ravenchart.gen.emit.ada.naming import constant_name as name_of
from ravenchart.gen.emit.ada.syntax import Chain, Decl, Expr, Object, Pragma, Ref, chain, number

__all__ = [
    "LATE",
    "LOOSE",
    "ONE",
    "SLOW",
    "arrivals",
    "assured",
    "before",
    "bounded",
    "ceiling",
    "differs",
    "least",
    "name_of",
    "named",
    "plus",
    "refuse",
    "stated",
    "times",
    "within",
]

ONE = number(1)

LATE = "can miss its deadline"

SLOW = "can take longer than its claimed response time"

LOOSE = "claims more than its terms add up to"


def named(name: str, value: Expr) -> Decl:
    """``name : constant := value;``"""
    return Object(name, None, value, constant=True)


def stated(name: str, value: int) -> Decl:
    """A number as it is given."""
    return named(name, number(value))


def plus(*terms: Expr) -> Expr:
    """The sum; of one term, that."""
    flat: list[Expr] = []
    for term in terms:
        flat += term.operands if isinstance(term, Chain) and term.operator == "+" else (term,)
    return chain("+", flat, number(0))


def times(*factors: Expr) -> Expr:
    """The product."""
    return chain("*", [factor for factor in factors if factor != ONE], ONE)


def before(own: str, job: int) -> list[Expr]:
    """Less the periods that lie before a job, counted from 0."""
    return [times(number(-job), Ref(f"{own}_T"))] if job else []


def ceiling(dividend: Expr, divisor: Expr) -> Expr:
    """The quotient of numbers that are not negative, rounded up."""
    return Chain("/", (plus(dividend, Chain("-", (divisor, ONE))), divisor))


def arrivals(own: str) -> Decl:
    """What makes a division count the releases of an element; see `within`."""
    return named(f"{own}_A", plus(Ref(f"{own}_J"), Chain("-", (Ref(f"{own}_T"), ONE))))


def within(own: str, window: Expr) -> Expr:
    """Releases of an element in a window that begins with as many as its jitter allows."""
    return Chain("/", (plus(window, Ref(f"{own}_A")), Ref(f"{own}_T")))


def refuse(left: Expr, right: Expr, element: str, problem: str) -> Decl:
    """A build fails, with our words, when ``left`` exceeds ``right``."""
    return _refused(Chain(">", (left, right)), element, problem)


def differs(left: Expr, right: Expr, element: str, problem: str) -> Decl:
    """A build fails, with our words, when the two differ."""
    return _refused(Chain("/=", (left, right)), element, problem)


def _refused(condition: Expr, element: str, problem: str) -> Decl:
    words = Chain("&", (Ref(f'"{element} "'), Ref(f'"{problem}"')))
    return Pragma("Compile_Time_Error", (condition, words))


def bounded(needs: Expr, window: Expr, element: str) -> list[Decl]:
    """A window holds its demand and no more, and is none that ends before it begins.

    Ada rounds quotients towards zero: a negative window could hold the demand of what
    needs more than all of the time. The least window that holds its demand equals it: a
    longer one shows that a term is missing.
    """
    return [
        refuse(number(0), window, element, SLOW),
        refuse(needs, window, element, SLOW),
        refuse(window, needs, element, LOOSE),
    ]


def least(bound: Expr, terms: list[Expr], element: str, problem: str) -> list[Decl]:
    """A bound is the longest of the terms: not less than any, and not more than all."""
    above = chain("and then", [Chain(">", (bound, term)) for term in terms])
    return [
        *(refuse(term, bound, element, problem) for term in terms),
        _refused(above, element, LOOSE),
    ]


def assured(left: Expr, right: Expr) -> Decl:
    """The same for gnatprove."""
    return Pragma("Assert", (Chain("<=", (left, right)),))
