# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A search for tables that goes on while people work: what it looks at, and its best so far."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ravenchart.allocation.proposals import WantedTable
from ravenchart.editing.evaluation import Texts

from .changes import ChangeRefusedError
from .session import Session


@dataclass(slots=True)
class Search:
    """One search, in the files as they were when it began."""

    strategy: str
    texts: Texts
    running: bool = True
    best: dict[str, Any] | None = None
    """As `room.outcome` says it; None until there is one."""
    fault: str | None = None
    """Why the search ended before it was at its end."""

    def told(self, session: Session) -> dict[str, Any]:
        """The search for the page; ``old``: the model has changed since the search began."""
        return {
            "strategy": self.strategy,
            "running": self.running,
            "old": self.texts != session.now.texts,
            "best": self.best,
            "fault": self.fault,
        }

    def adopt(self, session: Session) -> None:
        """Make the best tables so far a change of the model."""
        if self.best is None:
            raise ChangeRefusedError("the search has found no tables yet")
        if self.texts != session.now.texts:
            raise ChangeRefusedError("the model has changed since the search: search again")
        tables = [_table(one) for one in self.best["tables"]]
        session.adopt(tables, self.best["bounds"], f"rows allocated by {self.strategy}")


def _table(told: dict[str, Any]) -> WantedTable:
    raises = {key: tuple(events) for key, events in told["raises"].items()}
    return WantedTable(**(told | {"rows": tuple(told["rows"]), "raises": raises}))
