# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The work that the check of a model may take, counted so that it is the same each time.

The solver's own count is not used: the work of one question depends there on the
questions that the process asked before.
"""

from __future__ import annotations

from dataclasses import dataclass

import z3


class Exhausted(Exception):  # noqa: N818
    """The check has used up its work."""


class TooManyQuestions(Exception):  # noqa: N818
    """One region would take more questions than it may."""


@dataclass
class Budget:
    """The work that the whole check may take, and the situations and questions so far."""

    effort: int
    situations: int = 0
    questions: int = 0

    def count(self) -> None:
        """One situation more; `Exhausted` when no work is left for it."""
        self._check()
        self.situations += 1

    def ask(self, solver: z3.Solver) -> z3.CheckSatResult:
        """The answer of a solver; `Exhausted` when no work is left for the question."""
        self._check()
        self.questions += 1
        return solver.check()

    def spent(self) -> int:
        """The work until now."""
        return self.situations + self.questions

    def _check(self) -> None:
        if self.spent() > self.effort:
            raise Exhausted
