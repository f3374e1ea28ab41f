# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A running controller as an object, at the other end of any bus: for notebooks, tests and scripts.

    from ravenchart.running.remote import connect

    with connect("model.yaml", interface="socketcan", channel="can0") as robot:
        robot.send("Move", x=300_000)
        await robot.state("robot_status.condition", "Ready", timeout=2)
        robot.status["robot_status"]

All that is known of the controller is what its frames say and, of one that runs on this machine,
the states of its charts. Names and values are those of the model; numbers count what the CAN
database counts.
"""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from contextlib import ExitStack, nullcontext
from dataclasses import dataclass, field
from pathlib import Path
from queue import Empty, SimpleQueue
from types import TracebackType
from typing import Literal, TypeVar

from ravenchart import rounded
from ravenchart.building import checking
from ravenchart.gen.model.system import System
from ravenchart.hw_can.bench.drives import Bench, Station, press
from ravenchart.hw_can.bench.forms import DriveForm
from ravenchart.hw_can.bench.interfaces import BusEnd
from ravenchart.hw_can.bench.peer import BenchError, FrameValues, MalformedFrameError, Peer, Value
from ravenchart.hw_can.bench.replay import from_outside, log_for

from . import bus_log, monitoring, scenarios
from .attaching import attached, interfaces_of, vocabulary_at
from .chart_names import NamedChart
from .chart_states import ChartWatch, SeenChart, in_words
from .process import separate_cores
from .snapshots import VARIABLE
from .vocabulary import BusVocabulary, WordError, hint_of
from .watched import WatchedController

PATIENCE = 10.0
"""The longest wait for an answer unless another is given, in s."""

LOOKS = 0.02
"""Seconds between two looks for the state of a chart; a controller reports each 0.1 s."""

Outcome = TypeVar("Outcome")


class NoAnswerError(TimeoutError):
    """A field did not get its value in time."""


@dataclass(frozen=True, slots=True)
class Sent:
    """A message that was sent, with all of its fields."""

    message: str
    values: Mapping[str, Value]


@dataclass(slots=True)
class _Waiting:
    """Who waits for a value, and since when."""

    message: str
    name: str
    value: Value
    began: float
    came: Future[float] = field(default_factory=Future)

    def look(self, message: str, values: Mapping[str, Value]) -> bool:
        """Whether this frame has it; then the one who waits goes on."""
        found = message == self.message and values.get(self.name) == self.value
        if found and self.came.set_running_or_notify_cancel():
            self.came.set_result(time.monotonic() - self.began)
        return found or self.came.done()


@dataclass(frozen=True, slots=True)
class _WaitingChart:
    """Who waits for a state of a chart, and since when."""

    chart: NamedChart
    state: Value
    leaves: frozenset[str]
    began: float
    end: float

    def look(self, seen: Mapping[str, SeenChart], sent_at: float) -> bool:
        """Whether the chart is there, after the last message; NoAnswerError where it is not."""
        now = time.monotonic()
        last = seen.get(self.chart.name)
        if last is not None and last.at > sent_at and last.state in self.leaves:
            return True
        unanswered = f"{self.chart.name} was not {self.state} within {self.end - self.began:g} s"
        if last is None:
            why = f"the snapshots of {self.chart.node} have no such chart"
            raise NoAnswerError(f"{unanswered}: {why}\n  hint: give the node the key `trace`")
        if last.ended or now > self.end:
            raise NoAnswerError(f"{unanswered}: {_last(last)}")
        return False


def _last(seen: SeenChart) -> str:
    lost = f"; {seen.lost} trace records were lost" if seen.lost else ""
    if seen.ended:
        return f"the controller has ended; last {in_words(seen)}{lost}"
    age = rounded.up(rounded.of_seconds(time.monotonic() - seen.at))
    return f"last {in_words(seen)}, seen {age} ago{lost}"


class RemoteSystem:
    """The controllers of a model, as their bus shows them, and their snapshots.

    Any thread may call. A thread of its own, the bench, receives and sends; it simulates the
    drives too, where there are any.
    """

    def __init__(
        self,
        vocabulary: BusVocabulary,
        peer: Peer,
        drives: Mapping[str, DriveForm] | None = None,
        resources: ExitStack | None = None,
        watched: Sequence[WatchedController] = (),
    ) -> None:
        """Be on the bus of ``peer`` until `close`, which closes the ``resources`` too.

        The states of charts are those of the ``watched`` controllers.
        """
        self.vocabulary = vocabulary
        self.malformed = 0
        """Frames with the identifier of a message, and other data."""
        self._resources = resources or ExitStack()
        self._resources.callback(peer.close)
        self._charts = ChartWatch(watched)
        self._resources.callback(self._charts.close)
        self._bench = Bench(peer, drives or {}, tracks=False)
        self._bench.on_message = self._take
        self._lock = threading.Lock()
        self._last: dict[str, tuple[float, FrameValues]] = {}
        self._sent: dict[str, dict[str, Value]] = {}
        self._sent_at = 0.0
        self._waiting: list[_Waiting] = []
        self._calls: SimpleQueue[Callable[[], None]] = SimpleQueue()
        self._fault: BenchError | None = None
        self._closing = False
        self._thread = threading.Thread(target=self._run, name="bench", daemon=True)
        self._thread.start()

    def __enter__(self) -> RemoteSystem:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        fault: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    @property
    def system(self) -> System:
        """The model."""
        return self.vocabulary.system

    @property
    def status(self) -> dict[str, FrameValues]:
        """The last values of every message that came, by the names of messages and fields."""
        with self._lock:
            return {name: dict(values) for name, (_, values) in sorted(self._last.items())}

    @property
    def charts(self) -> dict[str, SeenChart]:
        """The states of the charts that snapshots show, by `instance.Region`."""
        return self._charts.look()

    @property
    def skipped(self) -> int:
        """Cycles of 5 ms that the host held the bench up: simulated drives sent nothing in them."""
        return self._bench.skipped

    def age(self, message: str) -> float:
        """Time since the last frame of a message in s; infinite before the first one."""
        with self._lock:
            at = self._last[message][0] if message in self._last else float("-inf")
        return time.monotonic() - at

    def send(self, name: str, /, **fields: Value) -> Sent:
        """Send a message, by its own name or by a command: a literal of one of its fields.

        A field that is not given has the value that was sent last. Raises WordError for a name
        or value that the bus does not have, BenchError where the frame cannot be sent.
        """
        message, values = self.vocabulary.order(name, fields)
        if not self.vocabulary.messages[message].is_multiplexed():
            values = self._sent.get(message, {}) | values
        missing = self.vocabulary.missing(message, values)
        if missing:
            signals = self.vocabulary.fields(message)
            told = (
                f"{one} is {self.vocabulary.range_of(message, signals[one])}" for one in missing
            )
            wanted = ", ".join(f"`{one}`" for one in missing)
            raise WordError(f"`{name}` needs {wanted}", "; ".join(told))

        def sending() -> Sent:
            self._bench.peer.send(message, values)
            self._sent[message] = values
            self._sent_at = time.monotonic()
            return Sent(message, values)

        return self._called(sending)

    def wait_for(self, name: str, value: Value, timeout: float = PATIENCE) -> float:
        """Wait until a field has a value, or a chart is in a state; how long it took, in s.

        The field is `message.field`, or its name alone where one message of the controller has
        it; the chart is `instance.Region`, or the region alone where one instance has it. A frame
        or snapshot counts that came after the last message sent here, so no answer is missed.
        Raises WordError for a name or value that there is not, NoAnswerError after ``timeout`` s,
        BenchError where the bus is gone.
        """
        chart = self._awaited_chart(name, value, timeout)
        if chart is not None:
            while not self._is_there(chart):
                time.sleep(LOOKS)
            return time.monotonic() - chart.began
        waiting = self._awaited(name, value)
        try:
            return waiting.came.result(timeout)
        except TimeoutError:
            raise self._unanswered(waiting, timeout) from None
        finally:
            waiting.came.cancel()

    async def state(self, name: str, value: Value, timeout: float = PATIENCE) -> float:
        """The same as `wait_for`, for a coroutine: others go on meanwhile."""
        chart = self._awaited_chart(name, value, timeout)
        if chart is not None:
            while not self._is_there(chart):
                await asyncio.sleep(LOOKS)
            return time.monotonic() - chart.began
        waiting = self._awaited(name, value)
        try:
            return await asyncio.wait_for(asyncio.wrap_future(waiting.came), timeout)
        except TimeoutError:
            raise self._unanswered(waiting, timeout) from None

    def replay(self, log: str | Path) -> int:
        """Send the frames of a log that come from outside, at their times; how many there are.

        Returns when the last one is sent. Raises BenchError for a file that is no log.
        """
        drives = frozenset(one.form.feedback for one in self._bench.stations.values())
        codec = self.vocabulary.codec
        frames = from_outside(log_for(Path(log), codec), codec, drives)

        def planned() -> None:
            now = self._bench.now
            self._bench.replayed.extend((now + at, frame) for at, frame in frames)

        self._called(planned)
        try:
            while self._called(lambda: len(self._bench.replayed)):
                time.sleep(0.01)
        except KeyboardInterrupt:
            self._called(self._bench.replayed.clear)
            raise
        return len(frames)

    @property
    def drives(self) -> tuple[str, ...]:
        """The simulated drives."""
        return tuple(self._bench.stations)

    def pull(self, drive: str, switch: Literal["low", "high"]) -> None:
        """Press a limit switch of a simulated drive."""
        station = self._station(drive)
        if switch not in ("low", "high"):
            raise WordError(f"there is no limit switch `{switch}`", "one of low, high")
        self._called(lambda: press(station, switch))

    def release(self, drive: str) -> None:
        """Let go of the limit switches of a simulated drive."""
        station = self._station(drive)
        self._called(lambda: press(station, "none"))

    def close(self) -> None:
        """Leave the bus; a second call does nothing."""
        self._closing = True
        self._thread.join()
        self._resources.close()

    def _station(self, drive: str) -> Station:
        known = self._bench.stations
        if drive not in known:
            hint = (
                hint_of(drive, known) or "simulate some: `--drives FILE`, or `drives` of `connect`"
            )
            raise WordError(f"there is no simulated drive `{drive}`", hint)
        return known[drive]

    # --- in the thread of the one who calls

    def _called(self, call: Callable[[], Outcome]) -> Outcome:
        """Have the bench do it; what it returns or raises."""
        future: Future[Outcome] = Future()

        def do() -> None:
            try:
                future.set_result(call())
            except Exception as fault:
                future.set_exception(fault)

        self._calls.put(do)
        while True:
            try:
                return future.result(0.2)
            except TimeoutError:
                self._check_alive()

    def _check_alive(self) -> None:
        if self._fault is not None:
            raise BenchError(str(self._fault))
        if not self._thread.is_alive():
            raise BenchError("the bus was left")

    def _awaited_chart(self, name: str, value: Value, timeout: float) -> _WaitingChart | None:
        """None where no chart is meant; WordError where its states cannot be seen."""
        chart = self.vocabulary.chart(name)
        if chart is None:
            return None
        leaves = self.vocabulary.leaves(chart, value)
        if chart.node not in self._charts.nodes:
            sent = ", ".join(self.vocabulary.sent_by(chart))
            field_hint = f"wait for a field: {chart.instance} sends {sent}"
            raise WordError(
                f"the states of the chart `{chart.name}` are not seen: no snapshots of the node "
                f"{chart.node} are read",
                f"on this machine, start its controller with {VARIABLE}=FILE, and give `--file "
                f"FILE` (`files` of `connect`); elsewhere, "
                + (field_hint if sent else "have a message carry the state"),
            )
        began = time.monotonic()
        return _WaitingChart(chart, value, leaves, began, began + timeout)

    def _is_there(self, waiting: _WaitingChart) -> bool:
        self._check_alive()
        return waiting.look(self._charts.look(), self._sent_at)

    def _awaited(self, name: str, value: Value) -> _Waiting:
        message, signal = self.vocabulary.signal(name, or_chart=True)
        if isinstance(value, bool) and signal.choices is not None:
            value = str(value)
        misfit = self.vocabulary.misfit(message, signal, value, by_name=True)
        if misfit is not None:
            raise WordError(misfit)
        waiting = _Waiting(message, signal.name, value, time.monotonic())
        with self._lock:
            self._check_alive()
            at, values = self._last.get(message, (0.0, {}))
            if not (at > self._sent_at and waiting.look(message, values)):
                self._waiting.append(waiting)
        return waiting

    def _unanswered(self, waiting: _Waiting, timeout: float) -> NoAnswerError:
        name = f"{waiting.message}.{waiting.name}"
        told = f"{name} was not {waiting.value} within {timeout:g} s"
        with self._lock:
            if waiting.message in self._last:
                at, values = self._last[waiting.message]
                age = rounded.up(rounded.of_seconds(time.monotonic() - at))
                return NoAnswerError(f"{told}: last {values[waiting.name]}, {age} ago")
            heard = ", ".join(sorted(self._last)) or "none"
        system = self.vocabulary.system
        bus = system.bus(next(m.bus for m in system.frames if m.name == waiting.message))
        hint = f"is the controller on {bus.name}, at {bus.bit_rate} bit/s? "
        hint += f"Messages received: {heard}"
        return NoAnswerError(f"{told}: no {waiting.message} came\n  hint: {hint}")

    # --- in the thread of the bench

    def _run(self) -> None:
        with separate_cores() if self.drives else nullcontext():  # drives keep a period
            self._go_on()
        with self._lock:
            for waiting in self._waiting:
                if waiting.came.set_running_or_notify_cancel():
                    waiting.came.set_exception(self._fault or BenchError("the bus was left"))
            self._waiting.clear()

    def _go_on(self) -> None:
        """Carry out what callers ask for, receive and send, until the end."""
        while not self._closing:
            try:
                while True:
                    self._calls.get_nowait()()
            except Empty:
                pass
            try:
                self._bench.tick()
            except MalformedFrameError:
                self.malformed += 1
            except BenchError as fault:
                self._fault = fault
                return

    def _take(self, name: str, values: FrameValues) -> None:
        with self._lock:
            self._last[name] = (time.monotonic(), values)
            self._waiting = [one for one in self._waiting if not one.look(name, values)]


def connect(
    model: str | Path,
    *,
    interface: str,
    channel: str | Sequence[str],
    drives: str | Path | None = None,
    log: str | Path | None = None,
    files: Sequence[str | Path] = (),
) -> RemoteSystem:
    """The controllers of a model that run on a bus: any interface of python-can, and its channel.

    Of a model with several buses the channels are given as `BUS=CHANNEL`, one for each bus that is
    spoken on.
    ``drives`` is a scenario whose drives are simulated. ``log`` gets the frames, in the format
    that its suffix names. ``files`` are those that RAVENCHART_MONITOR names to controllers on this
    machine, as `NODE=FILE` where there are several nodes: they show the states of charts. Raises
    Refused for a model or scenario with errors, Unusable where there is no such bus or controller.
    """
    checked = checking.check(Path(model))
    forms = {} if drives is None else scenarios.checked(Path(drives), checked.system).drives
    channels = [channel] if isinstance(channel, str) else channel
    ends = interfaces_of(checked.system, interface, channels)
    record = None if log is None else Path(log)
    return connected(checked, ends, forms, record, [str(file) for file in files])


def connected(
    checked: checking.Checked,
    ends: Mapping[str, BusEnd],
    drives: Mapping[str, DriveForm],
    log: Path | None = None,
    files: Sequence[str] = (),
) -> RemoteSystem:
    """The same of a model that was read, at interfaces."""
    with ExitStack() as stack:
        vocabulary = vocabulary_at(checked.system, ends)
        named = monitoring.given(checked, files)
        watched = stack.enter_context(monitoring.watching(checked, named))
        record = stack.enter_context(bus_log.all_recorded(log, [*ends]))
        peer = attached(ends, vocabulary, record)
        return RemoteSystem(vocabulary, peer, drives, stack.pop_all(), watched)
