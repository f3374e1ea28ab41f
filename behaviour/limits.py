# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The work that the rules of behaviour may take, and their result.

This module is apart from the rules, which import a solver. A result that is kept needs none.
"""

from __future__ import annotations

from dataclasses import dataclass

from ravenchart.gen.diagnostics import Diagnostic
from ravenchart.gen.model.safety import SafeRegion

EFFORT = 10_000
"""The work of the check of a model: situations looked at, and questions asked of the solver.

About ten seconds of a common machine."""

TO_THE_END = 30 * EFFORT
"""The same where the check shall come to its end: for evidence, and before a proof."""

UNFINISHED = "RV-1110"
"""The code of a check that was not finished."""

ON_MODEL = "RV-1111"
"""The code of an invariant that is checked on the model alone."""

OF_PROTOCOLS = MISUSED, NOT_FOLLOWED = "RV-1112", "RV-1113"
"""The codes of a call that a protocol does not allow, and of one that is not excluded."""


@dataclass(frozen=True, slots=True)
class Behaviour:
    """The result of the rules of behaviour for a model."""

    found: tuple[Diagnostic, ...]
    safe: tuple[SafeRegion, ...] = ()
    """The invariants that the generated code is to keep by contract."""
