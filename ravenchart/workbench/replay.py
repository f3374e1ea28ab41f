# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A recorded run, for the page: as the running controllers are shown, at the instant chosen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from threading import Lock
from typing import Any

from ravenchart.analysis.system.observed import TraceError
from ravenchart.building import checking
from ravenchart.failures import Refused
from ravenchart.gen.language.terms import Ns
from ravenchart.running.replaying import STEPS, ReplayedController, ReplayedRun
from ravenchart.running.traces.sources import recorded_nodes
from ravenchart.running.watched import KEPT

from .motion import WINDOW, plotted, shown_node
from .publishing import RefusedRequestError
from .requests import PlayOrPause, ReplayRequest, Seek, SetSpeed, StepTo

Json = dict[str, Any]

NAMES = {"event": "transition or fault", "value": "recorded value", "record": "record"}
"""The targets of a step, in words."""


class ReplayView:
    """The replay as pages see it; any thread may look or act."""

    def __init__(self, path: Path, traces: Sequence[Path]) -> None:
        """For the model at ``path``. Refused where a trace is not of it, or cannot be read."""
        self._checked = checking.check(path, deadlines=False)
        try:
            found = recorded_nodes(self._checked, traces)
        except TraceError as fault:
            raise Refused(str(fault)) from None
        self._replay = ReplayedRun(self._checked.analysis, found)
        controllers = self._replay.controllers
        self._whole: Json = {
            "files": [str(one) for one in traces],
            "end": self._replay.end,
            "steps": {what: sum(one.count(what) for one in controllers) for what in STEPS},
            "gaps": [{"node": one.name} | asdict(gap) for one in controllers for gap in one.gaps],
            "cut": [one.name for one in controllers if not one.is_whole],
            "said": [
                {"node": node, "text": text} for node, one in found.items() for text in one.said
            ],
            "simulated": any(one.simulated for one in found.values()),
        }  # the same at each instant
        self._lock = Lock()

    def do(self, wish: ReplayRequest) -> None:
        """Do what a page asks for; RefusedRequestError where no record is left to step to."""
        with self._lock:
            match wish:
                case PlayOrPause(kind="play"):
                    self._replay.play()
                case PlayOrPause():
                    self._replay.pause()
                case SetSpeed(speed=speed):
                    self._replay.set_speed(speed)
                case Seek(at=at):
                    self._replay.seek(at)
                case StepTo(kind=kind, what=what):
                    if not self._replay.step(what, back=kind == "previous"):
                        where = "earlier" if kind == "previous" else "later"
                        raise RefusedRequestError(f"the trace has no {where} {NAMES[what]}")

    def look(self, digest: str | None) -> Json:
        """The nodes at the instant that is shown; ``digest`` is that of the saved model."""
        with self._lock:
            at, playing, speed = self._replay.at, self._replay.playing, self._replay.speed
        text = ""
        if digest != self._checked.system.digest:
            text = "The saved model has changed: bounds are those of the model that was recorded."
        return {
            "text": text,
            "nodes": [self._node(one, at) for one in self._replay.controllers],
            "replay": self._whole | {"at": at, "playing": playing, "speed": speed},
        }

    def _node(self, controller: ReplayedController, at: Ns) -> Json:
        node = controller.node(at)
        values = {one.name for one in node.values}
        window = max(1, min(WINDOW, self._replay.end))
        lines = {
            one.element: controller.points(one.element, Ns(node.now - window), Ns(node.now))
            for one in plotted(self._checked.system)
            if one.element in values
        }
        node.responses = controller.responses(at)
        return shown_node(self._checked.system, node, node.events[-KEPT:], lines) | {
            "window": window,
            "starts": controller.late if at < controller.late else None,
            "counted": controller.counted(at),
            "records": [
                {"kind": kind, "element": element, "what": what}
                for kind, element, what in controller.records(at)
            ],
        }
