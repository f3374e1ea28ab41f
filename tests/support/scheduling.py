# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""In which order the workers of pytest-xdist get the tests, and which test runs alone.

A test marked ``live`` waits until no other live test runs: one worker gets those, while the
others get what is not live, as long as there is any.

A test that needs gnatprove has provers with limits of time: it runs after those, with as many
beside it as the machine has processors to spare. A test marked ``alone`` judges times of the host's
clock or has a bench: it runs at the end, while no other test runs.
The rest is given to the workers in short runs of one module, so that what a module sets up once is
rarely set up twice.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from enum import IntEnum
from pathlib import Path

import pytest
from xdist.scheduler.load import LoadScheduling
from xdist.workermanage import WorkerController

RUN = 12
"""Tests of a module that a worker gets at once, at the most."""


class Turn(IntEnum):
    """When a test runs: the turns follow each other."""

    SHARED = 0
    PROOF = 1
    ALONE = 2


def say(tests: Sequence[pytest.Item], path: Path) -> None:
    """In a worker: write the turns of the tests and which are live, for the scheduler."""
    turns = [f"{turn.name} {test.nodeid}" for test in tests if (turn := _turn_of(test))]
    live = [f"live {test.nodeid}" for test in tests if test.get_closest_marker("live") is not None]
    path.write_text("".join(f"{line}\n" for line in (*turns, *live)), encoding="utf-8")


def _turn_of(test: pytest.Item) -> Turn:
    if test.get_closest_marker("alone") is not None:
        return Turn.ALONE
    needs = (str(one.kwargs.get("reason", "")) for one in test.iter_markers("skipif"))
    return Turn.PROOF if any("gnatprove" in n for n in needs) else Turn.SHARED


class AloneLast(LoadScheduling):
    """Gives out runs of tests, then proofs, a worker a processor; the last worker gets the rest.

    A worker runs a test only when it knows the next one or that there is none.
    """

    def __init__(self, config: pytest.Config, said: Path) -> None:
        """The workers have written to the file ``said`` which tests run when."""
        super().__init__(config)
        self._said = said
        self._turns: dict[str, Turn] = {}
        self._live: frozenset[str] = frozenset()

    def schedule(self) -> None:
        """Start, or go on after a worker was replaced."""
        if self.collection is None:
            if not self._check_nodes_have_same_collection():
                return
            self.collection = next(iter(self.node2collection.values()))
            said = [line.partition(" ") for line in self._said.read_text("utf-8").splitlines()]
            self._turns = {name: Turn[kind] for kind, _, name in said if kind != "live"}
            self._live = frozenset(name for kind, _, name in said if kind == "live")
            self.pending[:] = sorted(range(len(self.collection)), key=self._turn)
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
        running = [other for other in others if not other.shutting_down]
        while self._next_turn() is Turn.SHARED and len(own) < 2 and not node.shutting_down:
            self._put_live_first(
                not any(self._is_live(t) for other in others for t in self.node2pending[other])
            )
            self._send_tests(node, self._length_of_run())
        if len(own) > 1 or node.shutting_down:
            return
        if len(running) >= len(os.sched_getaffinity(0)):
            node.shutdown()
            return
        while self._next_turn() is Turn.PROOF and len(own) < 2:
            self._send_tests(node, 1)
        if len(own) > 1:
            return
        if running:
            node.shutdown()
        elif not any(self.node2pending[other] for other in others):
            self._send_tests(node, len(self.pending))
            node.shutdown()
        elif own and self._turn(own[0]) is not Turn.ALONE and len(self.pending) > 1:
            self._send_tests(node, 1)

    def _check_all(self) -> None:
        for node in self.nodes:
            self.check_schedule(node)

    def _next_turn(self) -> Turn | None:
        """The turn of the next test; None when all are given out."""
        return self._turn(self.pending[0]) if self.pending else None

    def _length_of_run(self) -> int:
        assert self.collection is not None
        run = [t for t in self.pending[:RUN] if self._turn(t) is Turn.SHARED]
        kinds = [(self.collection[t].partition("::")[0], self._is_live(t)) for t in run]
        return next((at for at, one in enumerate(kinds) if one != kinds[0]), len(kinds))

    def _put_live_first(self, first: bool) -> None:
        """Of the tests that run beside others, those that are live come first, or last."""
        self.pending.sort(key=lambda t: (self._turn(t), self._is_live(t) is not first))

    def _is_live(self, test: int) -> bool:
        assert self.collection is not None
        return self.collection[test] in self._live

    def _turn(self, test: int) -> Turn:
        assert self.collection is not None
        return self._turns.get(self.collection[test], Turn.SHARED)
