# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The controllers of a model that run, found and watched."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path

from ravenchart.analysis.system.observed import TraceError, of_model, read_map
from ravenchart.building import programs
from ravenchart.building.checking import Checked
from ravenchart.failures import Refused, Unusable
from ravenchart.gen.language.terms import Ns

from .monitored import NodeMonitor, Overlooked, WatchedEvent, WatchedNode
from .snapshots import SnapshotFile, parsed_snapshot, snapshot_files

PERIOD = 0.1
"""Seconds between two looks, as between two snapshots."""

KEPT = 6
"""So many of the last transitions and faults are kept for those who look only now."""

FIRST = 10.0
"""So long a controller may take to write its first snapshot, in s."""

NodeFile = tuple[programs.Program, Path]
"""The program of a node, and the file of its snapshots."""


def found(checked: Checked, note: Callable[[str], None]) -> list[NodeFile]:
    """The files of the nodes that run; none where none does. ``note`` gets what is left out."""
    made = programs.programs_of(checked)
    homes = programs.homes_of(checked.path)
    files: list[NodeFile] = []
    for program in made:
        main = f"{checked.stem}_main"
        running = snapshot_files([home / program.folder for home in homes], main)
        if running:
            files.append((program, running[0]))
        if running[1:]:
            text = f"{len(running)} controllers run on {program.node}: the newest one is watched"
            note(f"note: {text}; --file names another")
    watched = {program.node for program, _ in files}
    for program in made:
        if files and program.node not in watched:
            note(f"warning: no controller of the node {program.node} runs")
    return files


def none_runs(checked: Checked) -> str:
    """What is said where nothing is found."""
    name = checked.system.name
    return f"no controller of {name} runs that `ravenchart run`, `shell` or `measure` has started"


def given(checked: Checked, words: Sequence[str]) -> list[NodeFile]:
    """The files in the form ``[NODE=]FILE``.

    Unusable where a node is missing or unknown, or has two files.
    """
    made = programs.programs_of(checked)
    by_name = {one.node.lower(): one for one in made}
    files: list[NodeFile] = []
    for word in words:
        node, equals, file = word.partition("=")
        if equals and node.lower() in by_name:
            files.append((by_name[node.lower()], Path(file)))
        elif len(made) == 1:
            files.append((made[0], Path(word)))
        else:
            known = ", ".join(f"{one.node}=FILE" for one in made)
            raise Unusable(f"--file {word} names no node: the model has {known}")
        name = files[-1][0].node
        if name in (program.node for program, _ in files[:-1]):
            raise Unusable(f"--file {word}: the node {name} has a file already")
    return files


class WatchedController:
    """The controller of a node: its file, and what was last seen there.

    Where another controller of the model writes the file later, it is watched from then on.
    """

    node: WatchedNode
    """There once `look` has found a snapshot."""

    def __init__(self, checked: Checked, program: programs.Program, path: Path) -> None:
        """Unusable where no controller writes that file, OSError where there is none."""
        names = program.generated / programs.TRACE_MAP
        with _readable():
            self._map = read_map(names.read_text("utf-8"), str(names))
        self._checked = checked
        self._came = time.monotonic()
        self.name = program.node
        self.last: deque[WatchedEvent] = deque(maxlen=KEPT)
        self.is_new = False
        self.made = float("-inf")
        """When the last snapshot was made, on the clock of `time.monotonic`, in s."""
        self.start: Ns | None = None
        self._begin(None)
        self._file = SnapshotFile(path)
        if self._file.owner() is None:
            self.close()
            raise Unusable(f"{path}: no controller writes this file now")

    def _begin(self, start: Ns | None) -> None:
        """Nothing was seen yet of the controller that started then."""
        self.start = start
        self._monitor = NodeMonitor(self._checked.analysis, self.name)
        self._sequence = 0
        self.last.clear()
        self.overlooked = Overlooked()

    def close(self) -> None:
        """Give the file back."""
        self._file.close()

    @property
    def age(self) -> float:
        """Since when there was no other snapshot, in s."""
        return time.monotonic() - self._came

    @property
    def has_ended(self) -> bool:
        """Whether the controller is gone."""
        return self._file.owner() is None

    def look(self) -> bool:
        """Look for another snapshot, once; whether there is any now.

        Refused where it is not of this model.
        """
        process = self._file.owner()  # first: what it wrote before its end is seen then
        if process is None:
            self._file.follow()
            process = self._file.owner()
        text = self._file.text()
        if text is None and not self._sequence:
            return False
        if text is None:  # torn for good: the writer was killed
            self.is_new = False
            self.node.process, self.node.events = process, []
            self.node.unlisted = self.node.missed = 0
            return True
        with _readable():
            snapshot = parsed_snapshot(text, self._map, str(self._file.path))
            if snapshot.seen.start != self.start:
                for digest in (self._checked.system.digest, self._map.digest):
                    of_model(snapshot.seen, digest, str(self._file.path))
                self._begin(snapshot.seen.start)
        self.is_new = snapshot.sequence != self._sequence
        if self.is_new:
            self._sequence, self._came = snapshot.sequence, time.monotonic()
            self.made = (snapshot.seen.start + (snapshot.seen.now or 0)) / 1e9
        self.node = self._monitor.shown(snapshot, process)
        self.overlooked.add(self.node, new=self.is_new)
        self.last.extend(self.node.events)
        return True


@contextmanager
def watching(checked: Checked, files: Sequence[NodeFile]) -> Iterator[list[WatchedController]]:
    """The controllers, each with a first snapshot, for the time of a block.

    Unusable as `WatchedController`, Refused where a snapshot does not come or is of another model.
    """
    with ExitStack() as stack:
        watched: list[WatchedController] = []
        for program, path in files:
            watched.append(WatchedController(checked, program, path))
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


@contextmanager
def _readable() -> Iterator[None]:
    """Refused where what is read in the block cannot be read."""
    try:
        yield
    except TraceError as fault:
        raise Refused(str(fault)) from None
