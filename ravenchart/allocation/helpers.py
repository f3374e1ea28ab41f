# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Tables ranked on many machines: the workers of a Dask scheduler.

The search asks for the ranks of many tables at once, in an order that it gives. Workers send ranks
alone, so what they are and how many there are changes the time that it takes, never the answer.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from importlib import metadata
from typing import Any

from ravenchart.analysis.core.allocation import Table
from ravenchart.failures import Unusable
from ravenchart.paths import version

from .proposals import RankOf
from .search import Rank, Ranked

PATIENCE = 10
"""Seconds for the scheduler to answer, and for a first worker to be there."""

AHEAD = 4
"""Tables asked for ahead, for each thread of a worker: the first that is better ends them."""

Helpers = Callable[[RankOf], Ranked]


def helped(address: str | None) -> AbstractContextManager[Helpers | None]:
    """The workers at ``address``; none where there is no address: this process ranks."""
    return nullcontext() if address is None else scheduled(address)


@contextmanager
def scheduled(address: str) -> Iterator[Helpers]:
    """The workers of the scheduler at ``address``, such as ``tcp://host:8786``.

    Unusable where Dask is not installed, no scheduler answers, a worker has another version of
    Ravenchart, or the connection is lost.
    """
    try:
        from distributed import CancelledError, Client, KilledWorker
    except ImportError:
        told = "`--scheduler` needs Dask: python -m pip install distributed"
        raise Unusable(told) from None
    try:
        client = Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError) as fault:
        raise Unusable(f"no Dask scheduler answers at {address}: {fault}") from None
    try:
        _check_workers(client, address)
        yield lambda rank_of: _ranked(client, rank_of)
    except (OSError, CancelledError, KilledWorker) as fault:
        raise Unusable(f"the Dask scheduler at {address} was lost: {fault}") from None
    finally:
        client.close(timeout=1)


def _check_workers(client: Any, address: str) -> None:
    """Unusable unless there are workers, and each has this version."""
    try:
        client.wait_for_workers(1, timeout=PATIENCE)
    except TimeoutError:
        raise Unusable(f"the Dask scheduler at {address} has no worker") from None
    wanted = version()
    for worker, found in client.run(metadata.version, "ravenchart", on_error="return").items():
        if found != wanted:
            has = f"Ravenchart {found}" if isinstance(found, str) else "no Ravenchart"
            raise Unusable(f"the Dask worker {worker} has {has}; it needs {wanted}")


def _ranked(client: Any, rank_of: RankOf) -> Ranked:
    sent = client.scatter(rank_of, broadcast=True)

    def ranks(many: Sequence[list[Table]]) -> Iterator[Rank]:
        size = AHEAD * max(1, sum(client.nthreads().values()))
        for first in range(0, len(many), size):
            some = many[first : first + size]
            asked = client.map(_call, [sent] * len(some), some, pure=False)
            try:
                for one in asked:
                    yield one.result()
            finally:
                client.cancel(asked)

    return ranks


def _call(rank_of: RankOf, tables: list[Table]) -> Rank:
    return rank_of(tables)
