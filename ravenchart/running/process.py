# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The controller as a process: started on one core, watched, asked to end."""

from __future__ import annotations

import os
import queue
import re
import subprocess
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from ravenchart.failures import Unusable
from ravenchart.tools import children

from . import held_files, snapshots

ERROR = "error: "
"""How a controller begins a line about a failure of its own."""

START_LIMIT = 10.0
"""How long a controller may take to open its bus, in s."""

STOP_MARGIN = 3.0
"""How long it may take to end beyond its own grace, in s."""

_PORT = re.compile(r"can: slcan on 127\.0\.0\.1:(\d{1,5})")
_JOINED = re.compile(r"can: joined the bus at 127\.0\.0\.1:(\d{1,5})")
_REAL_TIME = (os.SCHED_FIFO, os.SCHED_RR)


class StartError(Exception):
    """The controller did not come up."""


@dataclass(frozen=True, slots=True)
class Ended:
    """How the process ended. ``exit_code`` is negative for a signal.

    ``real_time``: while it ran, at least one of its threads had a real-time policy.
    ``stolen``: time in ns that a hypervisor took of its core meanwhile at the most, 0 where
    there is none that ever took any.
    """

    exit_code: int
    killed: bool
    real_time: bool
    warnings: tuple[str, ...]
    stolen: int = 0

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why it stopped itself, in its own words; nothing where it was asked to."""
        own = (line for line in self.warnings if line.startswith(ERROR))
        return tuple(line.removeprefix(ERROR) for line in own) if self.exit_code else ()


def _stolen_ticks(core: int) -> int:
    """Ticks of the kernel that a hypervisor has taken of a core so far: `steal` of proc(5)."""
    with suppress(OSError, ValueError, IndexError):
        for line in Path("/proc/stat").read_text(encoding="ascii").splitlines():
            if line.startswith(f"cpu{core} "):
                return int(line.split()[8])
    return 0


def stolen_time(before: int, after: int) -> int:
    """Time in ns that was stolen at the most between two counts of whole ticks.

    A count is up to a tick behind, so it may have been a tick more than their difference. A count
    of 0 means that no time was ever stolen.
    """
    ticks = after - before + 1 if after else 0
    return ticks * (10**9 // os.sysconf("SC_CLK_TCK"))


class ControllerProcess:
    """A running controller; its output is read all the time, so it never blocks on it."""

    def __init__(
        self, executable: Path, trace: Path, core: int | range, **environment: str | None
    ) -> None:
        """Start ``executable`` on ``core``, writing its trace to ``trace``. StartError.

        A controller with tasks on several cores starts on the first of a range of them; it puts
        each task on its own.

        ``environment`` has further variables, such as the address of the bus server; one that is
        None is not set. While the process runs, a monitor finds the file of its snapshots beside
        the executable, and a link to its trace. Where RAVENCHART_MONITOR is None there are no
        snapshots.
        """
        self._cores = core if isinstance(core, range) else range(core, core + 1)
        told = {"RAVENCHART_CAN_PORT": "0", "RAVENCHART_TRACE": str(trace), **environment}
        given = snapshots.VARIABLE in told
        self.snapshots = None if given else held_files.new_file(executable, snapshots.MARK)
        """The file that a monitor finds, where this one has made it."""
        if self.snapshots is not None:
            told[snapshots.VARIABLE] = str(self.snapshots)
            held_files.link_trace(self.snapshots, trace)
        whole = {**os.environ, **told}
        try:
            self._process = children.popen(
                [executable.absolute()],
                core=self._cores[0],
                env={name: value for name, value in whole.items() if value is not None},
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
            )
        except OSError as fault:
            self._unlink_snapshots()
            raise StartError(f"{executable} cannot be started: {fault.strerror}") from None
        self._lines: queue.SimpleQueue[str | None] = queue.SimpleQueue()
        self._warnings: list[str] = []
        self._real_time = False
        self._stolen = self._stolen_ticks()
        self._asked: float | None = None
        assert self._process.stdout is not None
        assert self._process.stderr is not None
        self._readers = [
            threading.Thread(target=self._read_output, args=(self._process.stdout,), daemon=True),
            threading.Thread(target=self._read_errors, args=(self._process.stderr,), daemon=True),
        ]
        for reader in self._readers:
            reader.start()

    def wait_for_port(self) -> int:
        """The TCP port of its bus, once it says so; StartError when it does not."""
        return self._wait_for(_PORT)

    def wait_until_joined(self, buses: int = 1) -> None:
        """Until it reports that it is a node of so many buses; StartError when it does not."""
        for _ in range(buses):
            self._wait_for(_JOINED)

    def _wait_for(self, said: re.Pattern[str]) -> int:
        deadline = time.monotonic() + START_LIMIT
        while (rest := deadline - time.monotonic()) > 0:
            try:
                line = self._lines.get(timeout=rest)
            except queue.Empty:
                break
            if line is None:
                with suppress(subprocess.TimeoutExpired):
                    self._process.wait(timeout=1.0)
                    self._readers[-1].join(timeout=1.0)
                raise StartError(self._early_end())
            match = said.fullmatch(line.strip())
            if match:
                return int(match[1])
        raise StartError(f"the controller did not open its bus within {START_LIMIT:g} s")

    def note_policies(self) -> None:
        """Remember whether any thread has a real-time policy now."""
        tasks = Path(f"/proc/{self._process.pid}/task")
        with suppress(OSError):
            for thread in tasks.iterdir():
                with suppress(OSError):
                    self._real_time |= os.sched_getscheduler(int(thread.name)) in _REAL_TIME

    def runs_for(self, seconds: float) -> bool:
        """Let it run for that long; whether it still does."""
        try:
            self._process.wait(timeout=seconds)
        except subprocess.TimeoutExpired:
            return True
        return False

    def ask_to_end(self, grace: float) -> bool:
        """Ask it to end, once; whether it has, or took longer than ``grace`` and STOP_MARGIN."""
        if self._process.poll() is not None:
            return True
        if self._asked is None:
            self.note_policies()
            self._process.terminate()
            self._asked = time.monotonic()
        return time.monotonic() > self._asked + grace + STOP_MARGIN

    def stop(self, grace: float) -> Ended:
        """Ask it to end, and kill it when it does not in time."""
        killed = False
        self.ask_to_end(grace)
        rest = (self._asked or 0.0) + grace + STOP_MARGIN - time.monotonic()
        try:
            self._process.wait(timeout=max(0.0, rest))
        except subprocess.TimeoutExpired:
            killed = True
            self._process.kill()
            self._process.wait()
        self._unlink_snapshots()
        for reader in self._readers:
            reader.join(timeout=1.0)
        stolen = stolen_time(self._stolen, self._stolen_ticks())
        warnings = tuple(self._warnings)
        return Ended(self._process.returncode, killed, self._real_time, warnings, stolen)

    def _stolen_ticks(self) -> int:
        """The ticks that a hypervisor took of its cores together."""
        return sum(_stolen_ticks(core) for core in self._cores)

    def _unlink_snapshots(self) -> None:
        if self.snapshots is not None:
            self.snapshots.unlink(missing_ok=True)
            held_files.trace_beside(self.snapshots).unlink(missing_ok=True)

    def _early_end(self) -> str:
        """The reason why the output ended before the port was known."""
        code = self._process.poll()
        said = f": {self._warnings[-1]}" if self._warnings else ""
        if code is None:
            return f"the controller closed its output before it opened its bus{said}"
        return f"the controller ended with exit code {code} before it opened its bus{said}"

    def _read_output(self, stream: IO[bytes]) -> None:
        for line in stream:
            self._lines.put(line.decode(errors="replace"))
        self._lines.put(None)

    def _read_errors(self, stream: IO[bytes]) -> None:
        for line in stream:
            text = line.decode(errors="replace").rstrip()
            if text:
                self._warnings.append(text)


@contextmanager
def separate_cores(count: int = 1) -> Iterator[range]:
    """The cores of a controller, ``count`` of them; this thread keeps off them, if it can.

    Unusable where the machine has fewer: the tasks of a controller with several cores are on the
    machine's first ones.

    It also takes the lowest real-time priority, where it may: else other load of
    the host would look like a bench that falls silent. Processes and threads
    started meanwhile inherit the core and not the priority.
    """
    affinity, policy = os.sched_getaffinity(0), os.sched_getscheduler(0)
    parameter = os.sched_getparam(0)
    core = min(affinity) if count == 1 else 0
    own = range(core, core + count)
    if not affinity.issuperset(own):
        given = ", ".join(map(str, sorted(affinity)))
        raise Unusable(
            f"the controller has tasks on {count} cores: it needs the processors 0 to "
            f"{count - 1} of this machine, and has {given}"
        )
    others = sorted(affinity.difference(own))
    if others:
        os.sched_setaffinity(0, others)
    with suppress(PermissionError):
        lowest = os.sched_param(os.sched_get_priority_min(os.SCHED_FIFO))
        os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, lowest)
    try:
        yield own
    finally:
        os.sched_setaffinity(0, affinity)
        with suppress(PermissionError):
            os.sched_setscheduler(0, policy, parameter)
