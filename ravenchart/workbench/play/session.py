# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A system that people execute step by step: what they did, and every situation it came to.

A stimulus is offered at once, at the time of the next release, where `simulate` takes it too. So
the stimuli up to the last release that was executed are an event file with the same trace.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from ravenchart.behaviour.interpreter.branching import branched
from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.behaviour.interpreter.observed import ObservedRegion, ObservedStep
from ravenchart.behaviour.interpreter.region import Stuck, TimeOut
from ravenchart.behaviour.interpreter.stimuli import (
    Stimuli,
    Stimulus,
    read_stimuli,
    written_stimuli,
)
from ravenchart.behaviour.interpreter.traces import StepRecord
from ravenchart.gen.derive.distribution import as_one
from ravenchart.gen.diagnostics import Diagnostic
from ravenchart.gen.language.quantities import LONGEST, parsed_duration, shown
from ravenchart.gen.language.terms import NO_TIME, Ns
from ravenchart.gen.model.system import Slot, System, Work

from ..publishing import RefusedRequestError
from ..requests import Rewind
from .requests import AdvanceWish, PlayRequest, PutWish, RaiseWish, WaitWish

MOST_STATES = 1_000
"""Acts that can be undone."""

MOST_RELEASES = 5_000
"""That one act executes: seconds of a large model."""

Chart = tuple[str, str]
"""Instance and top-level region."""


@dataclass(frozen=True, slots=True)
class Executed:
    """The last execution of a chart."""

    at: Ns
    steps: tuple[ObservedStep, ...]


@dataclass(frozen=True, slots=True)
class PlayedSituation:
    """The system after an act. Its machine is branched before it goes on."""

    machine: Machine
    at: Ns | None
    """The last release that was executed; None before the first."""
    entries: tuple[Stimulus, ...] = ()
    executed: tuple[tuple[Chart, Executed], ...] = ()
    label: str = ""
    records: tuple[StepRecord, ...] = ()
    """The steps of this act alone."""
    remark: str = ""


class Play:
    """A model in virtual time; one thread at a time may call it."""

    def __init__(
        self, path: Path, system: System, stimuli: Stimuli | None = None, warning: str = ""
    ) -> None:
        """Before the epoch, or behind ``stimuli``; `Stuck` where a chart has no way on there.

        ``warning`` says what the interpreter leaves out.
        """
        self.warning = warning
        self.path = path
        self.system = system
        self.number = 0
        """Of the situation that is shown: counts every act, and every undo."""
        whole = as_one(system)
        self._charts: dict[str, Chart] = {
            f"{one.name}.{region.name}": (one.name, region.name)
            for one in whole.instances
            for region in one.component.regions
        }
        self._states = [PlayedSituation(Machine(whole, ObservedRegion), None)]
        self._at = 0
        if stimuli is not None:
            self._play(stimuli)

    # --- What there is

    @property
    def now(self) -> PlayedSituation:
        """The situation that is shown."""
        return self._states[self._at]

    @property
    def charts(self) -> dict[str, Chart]:
        """The charts by their names, ``instance.Region``."""
        return self._charts

    @property
    def undo_label(self) -> str | None:
        """The act that `undo` takes back; None where there is none."""
        return self.now.label if self._at else None

    @property
    def redo_label(self) -> str | None:
        """The act that `redo` does again."""
        return self._states[self._at + 1].label if self._at + 1 < len(self._states) else None

    @property
    def next_release(self) -> Ns:
        """When the next release is due."""
        return self._following(self.now)[0]

    def records(self) -> Iterator[StepRecord]:
        """The trace so far."""
        for state in self._states[: self._at + 1]:
            yield from state.records

    def stimuli(self) -> Stimuli | None:
        """The stimuli up to the last release that was executed; None before the first."""
        at = self.now.at
        if at is None:
            return None
        return Stimuli(tuple(one for one in self.now.entries if one.at <= at), at)

    def waiting(self) -> int:
        """How many stimuli wait for the next release: they are in no event file yet."""
        at = -1 if self.now.at is None else self.now.at
        return sum(one.at > at for one in self.now.entries)

    def event_file(self) -> str | None:
        """The event file of what was done; None before the first release."""
        found = self.stimuli()
        if found is None:
            return None
        return written_stimuli(
            found, [f"{self.system.name}: recorded in the page of `simulate --open`."]
        )

    # --- Acts

    def do(self, wish: PlayRequest) -> None:
        """Do what a message asks for; `RefusedRequestError` where it cannot be done."""
        try:
            match wish:
                case RaiseWish() | PutWish():
                    self._offer(wish)
                case AdvanceWish():
                    self._advance(wish)
                case WaitWish(duration=text):
                    self._wait(text)
                case Rewind(kind=kind):
                    self._step(-1 if kind == "undo" else 1)
        except Stuck as stuck:
            raise RefusedRequestError(f"{stuck.origin}: {stuck}") from stuck

    def _step(self, by: int) -> None:
        if 0 <= self._at + by < len(self._states):
            self._at += by
            self.number += 1

    def _offer(self, wish: RaiseWish | PutWish) -> None:
        """Offer an event or a value for the next release."""
        at = self.next_release
        if isinstance(wish, RaiseWish):
            place = f"{wish.instance}.{wish.event}"
            item: dict[str, object] = {"at": shown(at), "raise": place}
            item |= {} if wish.value is None else {"with": wish.value}
        else:
            place = f"{wish.instance}.{wish.port}"
            item = {"at": shown(at), "put": place, "value": wish.value}
        text = json.dumps([item, {"until": shown(at)}], ensure_ascii=False)
        found, wrong = read_stimuli(text, "page", self.system)
        if found is None:
            raise RefusedRequestError("; ".join(_words(one) for one in wrong))
        machine = branched(self.now.machine)
        list(machine.execute(at, (), found.entries))
        self._take(
            replace(
                self.now,
                machine=machine,
                entries=(*self.now.entries, *found.entries),
                label=f"{wish.kind} {place}",
                records=(),
                remark="",
            )
        )

    def _advance(self, wish: AdvanceWish) -> None:
        """Execute releases until a chart has done what is wished."""
        chart = self._charts.get(wish.chart)
        if chart is None:
            raise RefusedRequestError(f"the model has no chart {wish.chart}")
        region = self.now.machine.instances[chart[0]].regions[chart[1]]
        if wish.kind == "time_out" and not region.timers:
            raise RefusedRequestError(f"no time-out runs in the active states of {wish.chart}")
        words = {"execution": "one execution", "firing": "until it fires", "time_out": "time-out"}
        run = _Executing(self.now)
        for _ in range(MOST_RELEASES):
            steps = self._release(run).get(chart)
            if steps is not None and _is_reached(wish.kind, steps):
                break
        else:
            what = "has not fired" if wish.kind == "firing" else "had no time-out"
            what = "was not executed" if wish.kind == "execution" else what
            run.remark = f"{wish.chart} {what} up to {shown(run.at or NO_TIME)}: repeat to go on"
        self._take(run.situation(f"{wish.chart}: {words[wish.kind]}"))

    def _wait(self, text: str) -> None:
        """Execute all releases of a duration."""
        length = parsed_duration(text.strip())
        if length is None or not 0 < length <= LONGEST:
            raise RefusedRequestError(
                f"`{text}` is not a duration up to one hour: write a number and ns, us, ms or s, "
                "such as `20 ms`"
            )
        run = _Executing(self.now)
        end = Ns((run.at or NO_TIME) + length)
        for _ in range(MOST_RELEASES):
            if self._following(run)[0] > end:
                break
            self._release(run)
        else:
            run.remark = f"stopped at {shown(run.at or NO_TIME)}: repeat to go on"
        if run.at == self.now.at:
            due = shown(self.next_release)
            raise RefusedRequestError(f"the next release is at {due}: wait longer")
        self._take(run.situation(f"wait {text.strip()}"))

    def _play(self, stimuli: Stimuli) -> None:
        """Execute all that is in an event file, as one act."""
        run = _Executing(self.now)
        coming = list(stimuli.entries)
        while self._following(run)[0] <= stimuli.until:
            now = self._following(run)[0]
            due = [one for one in coming if one.at <= now]
            coming = coming[len(due) :]
            run.entries += due
            self._release(run, due)
        self._take(run.situation("the event file"))

    # --- Executing

    def _following(self, state: PlayedSituation | _Executing) -> tuple[Ns, list[Slot]]:
        found = state.machine.following(-1 if state.at is None else state.at)
        assert found is not None, "a chart is in the table of a periodic processor"
        return found

    def _release(
        self, run: _Executing, due: list[Stimulus] | None = None
    ) -> dict[Chart, tuple[ObservedStep, ...]]:
        """Execute the next release; the steps of each chart in it."""
        now, slots = self._following(run)
        run.records += run.machine.execute(now, slots, due or ())
        run.at = now
        found: dict[Chart, tuple[ObservedStep, ...]] = {}
        for slot in slots:
            if slot.work is Work.REGION:
                region = run.machine.instances[slot.owner].regions[slot.name]
                assert isinstance(region, ObservedRegion)
                found[slot.owner, slot.name] = region.steps
        run.executed |= {chart: Executed(now, steps) for chart, steps in found.items()}
        return found

    def _take(self, state: PlayedSituation) -> None:
        """Go on to a new situation; what was taken back is forgotten."""
        self._states[self._at + 1 :] = [state]
        if len(self._states) > MOST_STATES + 1:
            first, second = self._states[:2]
            self._states[:2] = [replace(second, records=(*first.records, *second.records))]
        self._at = len(self._states) - 1
        self.number += 1


class _Executing:
    """A situation that is gone on from."""

    def __init__(self, start: PlayedSituation) -> None:
        self.machine = branched(start.machine)
        self.at = start.at
        self.entries = list(start.entries)
        self.executed = dict(start.executed)
        self.records: list[StepRecord] = []
        self.remark = ""

    def situation(self, label: str) -> PlayedSituation:
        """The situation that the execution has reached."""
        return PlayedSituation(
            self.machine,
            self.at,
            tuple(self.entries),
            tuple(self.executed.items()),
            label,
            tuple(self.records),
            self.remark,
        )


def _is_reached(kind: str, steps: tuple[ObservedStep, ...]) -> bool:
    if kind == "firing":
        return any(one.behaviours for one in steps)
    if kind == "time_out":
        return any(isinstance(one.occurrence, TimeOut) for one in steps)
    return True


def _words(found: Diagnostic) -> str:
    return f"{found.message}: {found.hint}" if found.hint else found.message
