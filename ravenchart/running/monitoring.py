# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The controllers of a model that run, found and watched."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path

from ravenchart.building import programs
from ravenchart.building.checking import Checked
from ravenchart.failures import Refused, Unusable

from . import bus_ring, held_files, snapshots
from .watched import WatchedController, WatchedProcess
from .watched_boards import WatchedBoard, line_of

PERIOD = 0.1
"""Seconds between two looks, as between two snapshots."""

FIRST = 10.0
"""So long a controller may take to write its first snapshot, in s."""

NodeFile = tuple[programs.Program, str]
"""The program of a node, and the file of its snapshots or the serial line of its board."""


def found(checked: Checked, note: Callable[[str], None]) -> list[NodeFile]:
    """The files of the nodes that run; none where none does. ``note`` gets what is left out."""
    made = programs.programs_of(checked)
    files: list[NodeFile] = []
    for program in made:
        running = _held(checked, [program], snapshots.MARK)
        if running:
            files.append((program, str(running[0])))
        if running[1:]:
            text = f"{len(running)} controllers run on {program.node}: the newest one is watched"
            note(f"note: {text}; --file names another")
    watched = {program.node for program, _ in files}
    for program in made:
        if files and program.node not in watched:
            note(f"warning: no controller of the node {program.node} runs")
    return files


def buses_of_run(checked: Checked) -> dict[str, Path]:
    """The ring of each bus on which `run` or `shell` lets controllers run now; the newest ones."""
    made, buses = programs.programs_of(checked), checked.system.buses
    found: dict[str, Path] = {}
    for bus in buses:
        mark = bus_ring.mark_of(bus.name if len(buses) > 1 else "")
        rings = _held(checked, made, mark)
        if rings:
            found[bus.name] = rings[0]
    return found


def _held(checked: Checked, made: Sequence[programs.Program], mark: str) -> list[Path]:
    """The files with a mark beside programs of the model, as `held_files.held_files`."""
    homes = programs.homes_of(checked.path)
    folders = [home / one.folder for one in made for home in homes]
    return held_files.held_files(folders, f"{checked.stem}_main", mark)


def none_runs(checked: Checked) -> str:
    """The message where no controller is found."""
    name = checked.system.name
    return f"no controller of {name} runs that `ravenchart run`, `shell` or `measure` has started"


def given(checked: Checked, words: Sequence[str]) -> list[NodeFile]:
    """The files and serial lines, in the form ``[NODE=]FILE``.

    Unusable where a node is missing or unknown, or has two files.
    """
    made = programs.programs_of(checked)
    by_name = {one.node.lower(): one for one in made}
    files: list[NodeFile] = []
    for word in words:
        node, equals, file = word.partition("=")
        if equals and node.lower() in by_name:
            files.append((by_name[node.lower()], file))
        elif len(made) == 1:
            files.append((made[0], word))
        else:
            known = ", ".join(f"{one.node}=FILE" for one in made)
            raise Unusable(f"--file {word} names no node: the model has {known}")
        name = files[-1][0].node
        if name in (program.node for program, _ in files[:-1]):
            raise Unusable(f"--file {word}: the node {name} has a file already")
    return files


@contextmanager
def watching(checked: Checked, files: Sequence[NodeFile]) -> Iterator[list[WatchedController]]:
    """The controllers, for the time of a block: each with a snapshot, or a board's serial line.

    Unusable as `WatchedProcess` and `WatchedBoard`. Refused where a snapshot does not come or is of
    another model.
    """
    with ExitStack() as stack:
        watched: list[WatchedController] = []
        for program, file in files:
            line = line_of(file)
            if line is None:
                watched.append(WatchedProcess(checked, program, Path(file)))
            else:
                watched.append(WatchedBoard(checked, program, line))
            stack.callback(watched[-1].close)
        _wait_for_all(watched)
        yield watched


def _wait_for_all(watched: Sequence[WatchedController]) -> None:
    limit = time.monotonic() + FIRST
    for one in watched:
        while not one.look():
            if one.has_ended:
                raise Refused(f"ravenchart: error: the controller of {one.name} ended at once")
            if time.monotonic() > limit:
                raise Refused(
                    f"ravenchart: error: the controller of {one.name} has written no snapshot in "
                    f"{FIRST:g} s: its main program, which has the lowest priority, does not run"
                )
            time.sleep(PERIOD / 4)
