# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The controllers of a model, started on this machine to be spoken to."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from ravenchart.analysis.system.timing import Analysis
from ravenchart.hw_can.bench.peer import Peer
from ravenchart.hw_can.bench.several import joined_servers

from . import bus_log
from .controllers import Controller, bus_servers, joining, joins_a_server
from .process import ControllerProcess, Ended, separate_cores
from .vocabulary import BusVocabulary


@dataclass(frozen=True, slots=True)
class StartedControllers:
    """The controllers that were started, by what is seen of them."""

    peer: Peer
    """On their bus."""
    snapshots: list[str] = field(default_factory=list)
    """The files of their snapshots, `NODE=FILE`."""
    ended: list[Ended] = field(default_factory=list)
    """How they ended, afterwards."""


@contextmanager
def started(
    controllers: Sequence[Controller],
    analysis: Analysis,
    vocabulary: BusVocabulary,
    folder: Path,
    log: Path | None = None,
) -> Iterator[StartedControllers]:
    """The controllers, which run for the time of a block.

    Their traces go to the folder, as those of a run.
    Raises StartError and BenchError, ToolMissing and ToolFailed where the bus cannot be built.
    """
    folder.mkdir(parents=True, exist_ok=True)
    names = [f"trace-{one.node}" if len(controllers) > 1 else "trace" for one in controllers]
    traces = [(folder / f"{name}.txt").absolute() for name in names]
    for trace in traces:
        trace.unlink(missing_ok=True)
    grace = analysis.system.shutdown.grace / 1e9
    cores = sorted(os.sched_getaffinity(0))
    first = controllers[0].executable
    processes: list[ControllerProcess] = []
    ended: list[Ended] = []
    with ExitStack() as stack:
        own = stack.enter_context(separate_cores(analysis.system.most_cores))
        if joins_a_server(analysis.system, len(controllers)):
            channels = stack.enter_context(bus_servers(analysis.system, controllers, None, log))
            stack.callback(_stop, processes, ended, grace)
            for process, joined in joining(analysis.system, controllers, traces, channels, cores):
                processes.append(process)
                process.wait_until_joined(joined)
            peer = joined_servers(channels, vocabulary.codec)
        else:
            record = stack.enter_context(bus_log.recorded(log, vocabulary.buses[0].name, first))
            stack.callback(_stop, processes, ended, grace)
            processes.append(ControllerProcess(first, traces[0], own))
            peer = Peer.connect(processes[0].wait_for_port(), vocabulary.codec, record)
        stack.callback(peer.close)
        yield StartedControllers(
            peer,
            [
                f"{one.node}={process.snapshots}"
                for one, process in zip(controllers, processes, strict=True)
                if process.snapshots is not None
            ],
            ended,
        )


def _stop(processes: Sequence[ControllerProcess], ended: list[Ended], grace: float) -> None:
    ended += [process.stop(grace) for process in processes]
