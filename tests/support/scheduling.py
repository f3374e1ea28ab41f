"""In which order the workers of pytest-xdist get the tests, and which test runs alone.

A test marked ``live`` waits until no other live test runs: one worker gets those, while the
others get what is not live, as long as there is any.

A test marked ``alone`` judges times of the host's clock or has a bench, and one that needs
gnatprove has provers with limits of time: they run after the others, while no other test runs.
The rest is given to the workers in short runs of one module, so that what a module sets up once is
rarely set up twice.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest
from xdist.scheduler.load import LoadScheduling
from xdist.workermanage import WorkerController

RUN = 12
"""Tests of a module that a worker gets at once, at the most."""


def say(tests: Sequence[pytest.Item], path: Path) -> None:
    """In a worker: write the names of the tests that run alone or are live, for the scheduler."""
    alone = [f"alone {test.nodeid}" for test in tests if _runs_alone(test)]
    live = [f"live {test.nodeid}" for test in tests if test.get_closest_marker("live") is not None]
    path.write_text("".join(f"{line}\n" for line in (*alone, *live)), encoding="utf-8")


def _runs_alone(test: pytest.Item) -> bool:
    """Is it marked so, or does it need gnatprove, whose provers have limits of time?"""
    needs = (str(one.kwargs.get("reason", "")) for one in test.iter_markers("skipif"))
    return test.get_closest_marker("alone") is not None or any("gnatprove" in n for n in needs)


class AloneLast(LoadScheduling):
    """Gives out runs of tests; those that run alone go to the last worker when no other works.

    A worker runs a test only when it knows the next one or that there is none.
    """

    def __init__(self, config: pytest.Config, said: Path) -> None:
        """The workers have written to the file ``said`` which tests run alone."""
        super().__init__(config)
        self._said = said
        self._alone: frozenset[str] = frozenset()
        self._live: frozenset[str] = frozenset()

    def schedule(self) -> None:
        """Start, or go on after a worker was replaced."""
        if self.collection is None:
            if not self._check_nodes_have_same_collection():
                return
            self.collection = next(iter(self.node2collection.values()))
            said = [line.partition(" ") for line in self._said.read_text("utf-8").splitlines()]
            self._alone = frozenset(name for kind, _, name in said if kind == "alone")
            self._live = frozenset(name for kind, _, name in said if kind == "live") - self._alone
            self.pending[:] = sorted(range(len(self.collection)), key=self._is_alone)
        self._check_all()

    def mark_test_complete(
        self, node: WorkerController, item_index: int, duration: float = 0
    ) -> None:
        """A test has ended: its worker, or the one that waits for all others, goes on."""
        self.node2pending[node].remove(item_index)
        self._check_all()

    def check_schedule(self, node: WorkerController, duration: float = 0) -> None:
        """Give a worker that has no test but the one that waits for its successor the next ones."""
        own = self.node2pending[node]
        others = [other for other in self.nodes if other is not node]
        while self._shared() and len(own) < 2 and not node.shutting_down:
            self._put_live_first(
                not any(self._is_live(t) for other in others for t in self.node2pending[other])
            )
            self._send_tests(node, self._length_of_run())
        if len(own) > 1 or node.shutting_down:
            return
        if not all(other.shutting_down for other in others):
            node.shutdown()
        elif not any(self.node2pending[other] for other in others):
            self._send_tests(node, len(self.pending))
            node.shutdown()
        elif own and not self._is_alone(own[0]) and len(self.pending) > 1:
            self._send_tests(node, 1)

    def _check_all(self) -> None:
        for node in self.nodes:
            self.check_schedule(node)

    def _shared(self) -> bool:
        """Is there a test left that runs beside others?"""
        return bool(self.pending) and not self._is_alone(self.pending[0])

    def _length_of_run(self) -> int:
        assert self.collection is not None
        names = [self.collection[test] for test in self.pending[:RUN]]
        runs = [(n.partition("::")[0], n in self._live) for n in names if n not in self._alone]
        return next((at for at, one in enumerate(runs) if one != runs[0]), len(runs))

    def _put_live_first(self, first: bool) -> None:
        """Of the tests that run beside others, those that are live come first, or last."""
        self.pending.sort(key=lambda t: (self._is_alone(t), self._is_live(t) is not first))

    def _is_live(self, test: int) -> bool:
        assert self.collection is not None
        return self.collection[test] in self._live

    def _is_alone(self, test: int) -> bool:
        assert self.collection is not None
        return self.collection[test] in self._alone
