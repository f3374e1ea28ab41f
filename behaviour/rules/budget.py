"""How much work the check of a model may take: counted, so that it is the same on every machine."""

from __future__ import annotations

from dataclasses import dataclass, field

import z3

PER_SITUATION = 200
"""Units for each situation, beside those of the solver: what is done outside of it."""


class Exhausted(Exception):  # noqa: N818
    """The check has taken the work that it may take."""


@dataclass
class Budget:
    """How much work the whole check may take, in units of z3, and how far it has got."""

    effort: int
    situations: int = 0
    _solver: z3.Solver = field(default_factory=z3.Solver)
    _before: int = field(init=False)

    def __post_init__(self) -> None:
        self._before = self._counted()

    def count(self) -> None:
        """One situation more; `Exhausted` when no work is left for it."""
        self.check()
        self.situations += 1

    def check(self) -> None:
        """`Exhausted` when no work is left."""
        if self.spent() > self.effort:
            raise Exhausted

    def spent(self) -> int:
        """The units until now."""
        return self._counted() - self._before + PER_SITUATION * self.situations

    def _counted(self) -> int:
        """What all questions in this process have taken, as z3 counts it."""
        self._solver.check()
        counted: int = self._solver.statistics().get_key_value("rlimit count")
        return counted
