# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""One running controller as it is watched, and what was last seen of it."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ravenchart.analysis.system.observed import Releases, TraceError, of_model, read_map
from ravenchart.building import programs
from ravenchart.building.checking import Checked
from ravenchart.failures import Refused, Unusable
from ravenchart.gen.language.terms import NO_TIME, Ns

from .live_responses import LiveRows, ProcessResponses
from .monitored import NodeMonitor, Overlooked, WatchedEvent, WatchedNode
from .snapshots import Snapshot, SnapshotFile, parsed_snapshot

KEPT = 6
"""So many of the last transitions and faults are kept for those who look only now."""


class WatchedController(ABC):
    """The controller of a node. Where it starts again it is another one from then on."""

    node: WatchedNode
    """There once `look` was True."""

    def __init__(self, checked: Checked, program: programs.Program) -> None:
        """Refused where the names of its elements cannot be read."""
        names = program.generated / programs.TRACE_MAP
        with readable():
            self.map = read_map(names.read_text("utf-8"), str(names))
        self.checked = checked
        self.came = time.monotonic()
        """When there was something new last, on the clock of `time.monotonic`, in s."""
        self.name = program.node
        self.last: deque[WatchedEvent] = deque(maxlen=KEPT)
        self.is_new = False
        self.made = float("-inf")
        """When what is shown was so, on the same clock."""
        self.begin(None)

    def begin(self, start: Ns | None, listed: int | None = None) -> None:
        """Nothing was seen yet of the controller that started then; ``listed`` as `NodeMonitor`."""
        self.start = start
        self._monitor = NodeMonitor(self.checked.analysis, self.name, listed)
        self.sequence = 0
        self.last.clear()
        self.overlooked = Overlooked()

    @property
    def age(self) -> float:
        """Since when there was nothing new, in s."""
        return time.monotonic() - self.came

    @property
    @abstractmethod
    def has_ended(self) -> bool:
        """Whether the controller is gone."""

    @property
    @abstractmethod
    def end_in_words(self) -> str:
        """The text for a controller that is gone without its report."""

    @abstractmethod
    def look(self) -> bool:
        """Look at it once; whether there is something to show now.

        Refused where it is not of this model.
        """

    @abstractmethod
    def responses(self) -> LiveRows:
        """The responses of its activities, as far as they are known at the last look."""

    def add_responses(self) -> None:
        """Let the node have them."""
        found = self.responses()
        self.node.responses, self.node.responses_note = found.rows, found.note

    @abstractmethod
    def close(self) -> None:
        """Watch it no longer."""

    def show(self, snapshot: Snapshot, process: int | None) -> None:
        """Show a snapshot from now on."""
        self.node = self._monitor.shown(snapshot, process)
        self.overlooked.add(self.node, new=self.is_new)
        self.last.extend(self.node.events)


class WatchedProcess(WatchedController):
    """A controller on this machine, by the file of its snapshots.

    Where another controller of the model writes the file later, it is watched from then on.
    """

    def __init__(self, checked: Checked, program: programs.Program, path: Path) -> None:
        """Unusable where no controller writes that file, OSError where there is none."""
        super().__init__(checked, program)
        self._file = SnapshotFile(path)
        self._responses = ProcessResponses(checked.analysis, self.map, path)
        if self._file.owner() is None:
            self.close()
            raise Unusable(f"{path}: no controller writes this file now")

    def close(self) -> None:
        """Give the file back."""
        self._file.close()
        self._responses.close()

    def responses(self) -> LiveRows:
        """From its trace, where that is beside the file of its snapshots; else from these."""
        counts = (
            (one.name, Releases(
                one.completed, one.misses, Ns(one.worst_response), Ns(self.node.now),
                None if one.last_response is None else Ns(one.last_response),
            ))
            for one in self.node.processors
        )  # fmt: skip
        return self._responses.look(self.start or NO_TIME, counts)

    @property
    def has_ended(self) -> bool:
        return self._file.owner() is None

    @property
    def end_in_words(self) -> str:
        return f"the controller of {self.name} has ended without its report"

    def look(self) -> bool:
        """Look for another snapshot, once."""
        process = self._file.owner()  # first: what it wrote before its end is seen then
        if process is None:
            self._file.follow()
            process = self._file.owner()
        text = self._file.text()
        if text is None and not self.sequence:
            return False
        if text is None:  # torn for good: the writer was killed
            self.is_new = False
            self.node.process, self.node.events = process, []
            self.node.unlisted = self.node.missed = 0
            return True
        with readable():
            snapshot = parsed_snapshot(text, self.map, str(self._file.path))
            if snapshot.seen.start != self.start:
                for digest in (self.checked.system.digest, self.map.digest):
                    of_model(snapshot.seen, digest, str(self._file.path))
                self.begin(snapshot.seen.start)
        self.is_new = snapshot.sequence != self.sequence
        if self.is_new:
            self.sequence, self.came = snapshot.sequence, time.monotonic()
            self.made = (snapshot.seen.start + (snapshot.seen.now or 0)) / 1e9
        self.show(snapshot, process)
        return True


@contextmanager
def readable() -> Iterator[None]:
    """Refused where what is read in the block cannot be read."""
    try:
        yield
    except TraceError as fault:
        raise Refused(str(fault)) from None
