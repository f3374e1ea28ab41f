# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A list made item by item, by all processors of the machine together."""

from __future__ import annotations

import signal
from collections.abc import Callable
from typing import TypeVar

MANY = 500
"""So many regions are worth the other processors of the machine."""

T = TypeVar("T")
U = TypeVar("U")

_shared: list[Callable[[int], object]] = []
"""The function that a forked process has from its parent: the model is not sent."""


def made_by_all(
    make: Callable[[int], T], count: int, meanwhile: Callable[[], U], *, worthwhile: bool = True
) -> tuple[list[T], U]:
    """``[make(0), ... make(count - 1)]``, and the result of ``meanwhile`` in this process.

    The results of ``make`` are sent between processes. Without `fork`, or where that is not
    ``worthwhile``, one process makes all.
    """
    if not worthwhile:
        return [make(number) for number in range(count)], meanwhile()
    import multiprocessing
    from concurrent.futures import ProcessPoolExecutor

    if "fork" not in multiprocessing.get_all_start_methods():
        return [make(number) for number in range(count)], meanwhile()
    _shared[:] = [make]
    try:
        context = multiprocessing.get_context("fork")
        with ProcessPoolExecutor(mp_context=context, initializer=_leave_signals) as pool:
            made = pool.map(_make, range(count), chunksize=count // 20 + 1)
            besides = meanwhile()
            return list(made), besides  # type: ignore[arg-type]
    finally:
        _shared.clear()


def _leave_signals() -> None:
    """Ctrl-C goes to every process of a terminal: the parent takes it, and ends the others."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)


def _make(number: int) -> object:
    return _shared[0](number)
