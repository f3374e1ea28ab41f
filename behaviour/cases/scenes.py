# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Scenes in an execution: values and events with which a region can make a step that is wanted.

`possible` finds the scene of each step that shows something new. A scene fits
where its states are active. Values that must equal the component's own data are taken from there.
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from ravenchart.behaviour.interpreter.machine import InstanceRun, Machine
from ravenchart.behaviour.interpreter.stimuli import Arrived, Raised
from ravenchart.gen.language.terms import Ns, Value

from .goals import GoalCoverage
from .possible import Scene
from .stimulation import Choice, PartialValue

COMPARED = 6
"""Scenes that are compared; the one played least is played."""
KNOWN = 4
"""The count of a scene that shows nothing new is multiplied by this number."""


@dataclass(frozen=True, slots=True)
class PlayedScene:
    """A scene with its values drawn: first they come, then the events."""

    values: tuple[Raised | Arrived, ...]
    events: tuple[Raised | Arrived, ...]
    receivers: frozenset[tuple[str, str]]
    """The ports that have these values, or at which nothing comes; instance and port."""
    time: int
    """In ns: ports and region are executed once in it."""


class ScenePlayer:
    """Draws scenes that fit, and counts how often each came."""

    def __init__(
        self,
        scenes: Mapping[str, Sequence[Scene]],
        choices: Iterable[Choice],
        chance: random.Random,
    ) -> None:
        """``scenes`` are those of each instance; ``choices`` is what may come from outside."""
        self._scenes, self._chance = scenes, chance
        self._named = {(one.instance, one.name): one for one in choices}
        self._tried: Counter[tuple[str, Scene]] = Counter()

    def played(self, machine: Machine, now: Ns, known: GoalCoverage) -> PlayedScene | None:
        """One that fits, most often one that was tried seldom; None where there is none."""
        fitting = [
            (name, scene)
            for name, scenes in self._scenes.items()
            for scene in scenes
            if {*scene.active} == {*machine.instances[name].regions[scene.region].configuration()}
        ]
        if not fitting:
            return None
        some = [self._chance.choice(fitting) for _ in range(COMPARED)]

        def tries(one: tuple[str, Scene]) -> int:
            return self._tried[one] * (KNOWN if known.has(one[1].shows) else 1)

        name, scene = min(some, key=tries)
        self._tried[name, scene] += 1
        run = machine.instances[name]
        causes = [one for at, one in fitting if at == name and scene.event in one.raises]
        return self._drawn(name, run, scene, self._needed(name, run, scene, causes), now)

    def _needed(
        self, name: str, run: InstanceRun, scene: Scene, causes: Sequence[Scene]
    ) -> dict[str, PartialValue | None]:
        """The values of a scene; where its event comes from inside, with those of a cause."""
        needed = dict(scene.values)
        if scene.event is not None and (name, scene.event) not in self._named:
            del needed[scene.event]
            needed |= dict(self._chance.choice(causes).values) if causes else {}
        for (what, part), (item, field) in scene.equal.items():
            value = run.data[item]
            assert not isinstance(value, tuple) or field is not None
            scalar = dict(value)[field or ""] if isinstance(value, tuple) else value
            needed[what] = {**(needed.get(what) or {}), part: scalar}
        return needed

    def _drawn(
        self,
        name: str,
        run: InstanceRun,
        scene: Scene,
        needed: Mapping[str, PartialValue | None],
        now: Ns,
    ) -> PlayedScene:
        present = sorted(_numbers((*run.data.values(), *(p.value for p in run.ports.values()))))
        values: list[Raised | Arrived] = []
        events: list[Raised | Arrived] = []
        for what, known in needed.items():
            one = self._named.get((name, what))
            if one is not None and known is not None:
                drawn = one.drawn(now, self._chance, known, present)
                (values if one.is_port else events).append(drawn)
        time = run.component.region(scene.region).timing.period
        time = max((time, *(one.period for one in run.component.handlers().values())))
        receivers = frozenset((name, what) for what in needed)
        return PlayedScene(tuple(values), tuple(events), receivers, time)


def _numbers(values: Iterable[Value]) -> set[int]:
    """The numbers in some values."""
    found: set[int] = set()
    for value in values:
        parts = [one for _, one in value] if isinstance(value, tuple) else [value]
        found.update(one for one in parts if isinstance(one, int))
    return found
