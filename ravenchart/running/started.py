# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The controllers of a model, started on this machine to be spoken to."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path

from ravenchart.analysis.system.timing import Analysis
from ravenchart.hw_can.bench.peer import Peer

from . import bus_log, server
from .process import ControllerProcess, Ended, separate_cores
from .runs import Controller, bus_words, joining, joins_a_server
from .vocabulary import BusVocabulary


@contextmanager
def started(
    controllers: Sequence[Controller],
    analysis: Analysis,
    vocabulary: BusVocabulary,
    folder: Path,
    log: Path | None = None,
) -> Iterator[tuple[Peer, list[Ended]]]:
    """A peer on the bus of the controllers, which run for the time of a block.

    How they ended is in the list afterwards. Their traces go to the folder, as those of a run.
    Raises StartError and BenchError, ToolMissing and ToolFailed where the bus cannot be built.
    """
    folder.mkdir(parents=True, exist_ok=True)
    names = [f"trace-{one.node}" if len(controllers) > 1 else "trace" for one in controllers]
    traces = [(folder / f"{name}.txt").absolute() for name in names]
    for trace in traces:
        trace.unlink(missing_ok=True)
    grace = analysis.system.shutdown.grace / 1e9
    cores = sorted(os.sched_getaffinity(0))
    processes: list[ControllerProcess] = []
    ended: list[Ended] = []
    with ExitStack() as stack:
        core = stack.enter_context(separate_cores())
        if joins_a_server(analysis.system, len(controllers)):
            words = bus_words(analysis, controllers, None)
            _, channel = stack.enter_context(server.running("port=0", *words, log=log))
            stack.callback(_stop, processes, ended, grace)
            for process in joining(controllers, traces, channel, cores):
                processes.append(process)
                process.wait_until_joined()
            peer = Peer.join(channel, vocabulary.codec)
        else:
            record = stack.enter_context(bus_log.recorded(log, vocabulary.bus.name))
            stack.callback(_stop, processes, ended, grace)
            processes.append(ControllerProcess(controllers[0].executable, traces[0], core))
            peer = Peer.connect(processes[0].wait_for_port(), vocabulary.codec, record)
        stack.callback(peer.close)
        yield peer, ended


def _stop(processes: Sequence[ControllerProcess], ended: list[Ended], grace: float) -> None:
    ended += [process.stop(grace) for process in processes]
