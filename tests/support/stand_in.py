# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A controller in Python that stands in for the generated one in tests of the bench.

It serves slcan on a free TCP port, moves each axis that the bus database knows,
writes the trace, and ends on SIGTERM. Its control is rough; its files are exact.
Arguments: the DBC, the trace map, then any of ``exit=<n>``, ``cut`` (no END line), ``other``
(the digest of another model),
``miss``, ``lose``, ``late=<ns>``, ``deaf`` (ignores SIGTERM), ``mute`` (prints nothing), ``warn``,
``fifo`` (takes a real-time priority).
"""

from __future__ import annotations

import json
import os
import signal
import socket
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import can
import cantools
from cantools.database import Database

PERIOD = 0.010
ACCELERATION = 800_000.0
SEEK, LEAVE, TRAVEL = -40_000.0, 10_000.0, 200_000.0
STALE = 0.5
FAULTS = ("Limit", "Drive")


class Joint:
    """One axis: its state, and the speed it asks for."""

    def __init__(self, axis: str) -> None:
        self.axis, self.state = axis, "Idle"
        self.feedback: dict[str, Any] | None = None
        self.heard = -1.0
        self.zero: int | None = None
        self.goal = self.position = self.speed = 0.0

    def order(self, kind: str, target: int) -> None:
        if kind == "Home" and self.state == "Idle":
            self.state, self.speed = "Seeking", 0.0
        elif kind == "Move" and self.state == "Idle" and self.zero is not None:
            self.state, self.goal, self.speed = "Cruising", float(target), 0.0

    def step(self, now: float) -> float:
        """The speed set point in um/s."""
        feedback = self.feedback
        if feedback is None:
            return 0.0
        if now - self.heard > STALE and self.state not in FAULTS:
            self.state = "Drive"
        limit = str(feedback["limit"])
        if self.state in FAULTS:
            return 0.0
        if self.state == "Seeking":
            if limit == "Low_End":
                self.state = "Backing_Off"
            return SEEK
        if self.state == "Backing_Off":
            if limit == "Clear":
                self.state, self.zero = "Idle", int(feedback["count"])
                self.goal = self.position = 0.0
            return LEAVE
        if self.zero is None:
            return 0.0
        if self.state == "Cruising" and limit != "Clear":
            self.state = "Limit"
            return 0.0
        return self._follow(int(feedback["count"]) - self.zero)

    def _follow(self, measured: float) -> float:
        rest = self.goal - self.position
        brake = (2 * ACCELERATION * abs(rest)) ** 0.5
        wanted = max(-TRAVEL, min(TRAVEL, brake if rest > 0 else -brake))
        change = ACCELERATION * PERIOD
        self.speed += max(-change, min(change, wanted - self.speed))
        if abs(rest) <= max(200.0, abs(self.speed) * PERIOD):
            self.position, self.speed = self.goal, 0.0
        self.position += self.speed * PERIOD
        if self.state == "Cruising" and rest == 0 and abs(self.goal - measured) < 200:
            self.state = "Idle"
        return max(-400_000.0, min(400_000.0, self.speed + 10 * (self.position - measured)))


class Controller:
    """All axes, the coordinator, the bus and the trace."""

    def __init__(self, dbc: Path, trace_map: Path, options: list[str]) -> None:
        self.options = options
        codec = cantools.database.load_file(dbc)
        assert isinstance(codec, Database)
        self.codec = codec
        names = [m.name for m in self.codec.messages]
        axes = [n.removesuffix("_set_point") for n in names if n.endswith("_set_point")]
        self.joints = [Joint(axis) for axis in axes]
        known = json.loads(trace_map.read_text())
        elements = known["elements"]
        self.leaves = {e["id"]: e["leaves"] for e in elements if e["kind"] == "region"}
        self.mission = "Waiting"
        self.states: dict[int, str] = {}
        self.trace_file = Path(os.environ["RAVENCHART_TRACE"])
        digest = "f" * 64 if "other" in options else known["digest"]
        self.trace = [f"M {digest}\n"]
        self.stop = False
        self.start = time.monotonic()
        self.releases = 0
        self.link: socket.socket | None = None
        self.buffer = b""

    def run(self) -> int:
        deaf = "deaf" in self.options
        signal.signal(signal.SIGTERM, signal.SIG_IGN if deaf else self._ask)
        server = socket.create_server(("127.0.0.1", int(os.environ["RAVENCHART_CAN_PORT"])))
        server.setblocking(False)
        if "fifo" in self.options:
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))
        if "warn" in self.options:
            print("no real-time priorities", file=sys.stderr, flush=True)
        if "mute" not in self.options:
            print(f"can: slcan on 127.0.0.1:{server.getsockname()[1]}", flush=True)
        while not self.stop:
            self.releases += 1
            time.sleep(max(0.0, self.start + self.releases * PERIOD - time.monotonic()))
            if self.link is None:
                self._accept(server)
            self._cycle()
        self.mission = "Shut_Down"
        self._note_states()
        self._finish()
        codes = [int(o[5:]) for o in self.options if o.startswith("exit=")]
        return codes[0] if codes else 0

    def _ask(self, number: int, frame: object) -> None:
        self.stop = True

    def _accept(self, server: socket.socket) -> None:
        try:
            self.link, _ = server.accept()
            self.link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self.link.setblocking(False)
        except BlockingIOError:
            pass

    def _cycle(self) -> None:
        now = time.monotonic()
        for name, values in self._messages():
            self._take(name, values, now)
        for joint in self.joints:
            speed = round(joint.step(now))
            mode = "Disabled" if joint.state in FAULTS else "Enabled"
            self._send(f"{joint.axis}_set_point", {"mode": mode, "speed": speed})
        self._coordinate()
        self._note_states()
        if self.releases % 2 == 0:
            self._send("robot_status", self._status())

    def _take(self, name: str, values: dict[str, Any], now: float) -> None:
        if name == "robot_command":
            self._record("ARRIVED", 4, 0)
            kind = str(values["kind"])
            wanted = {"Home": ("Waiting", "Homing"), "Move": ("Ready", "Under_Way")}.get(kind)
            if wanted and self.mission in (wanted[0], "Ready"):
                self.mission = wanted[1]
                for joint in self.joints:
                    joint.order(kind, int(values[joint.axis]))
        for index, joint in enumerate(self.joints):
            if name == f"{joint.axis}_feedback":
                joint.feedback, joint.heard = values, now
                self._record("ARRIVED", 11 + 2 * index, 0)

    def _coordinate(self) -> None:
        if self.mission in ("Failed", "Shut_Down"):
            return
        if any(j.state in FAULTS for j in self.joints):
            self.mission = "Failed"
        elif self.mission in ("Homing", "Under_Way") and all(
            j.state == "Idle" and j.zero is not None for j in self.joints
        ):
            self.mission = "Ready"

    def _status(self) -> dict[str, Any]:
        moving = {"Under_Way": "Moving", "Departing": "Moving"}
        condition = moving.get(self.mission, self.mission)
        places = {j.axis: round(j.position) for j in self.joints[:2]}
        return {"condition": condition, **places}

    def _messages(self) -> Iterator[tuple[str, dict[str, Any]]]:
        try:
            while self.link is not None and (data := self.link.recv(4096)):
                self.buffer += data
        except (BlockingIOError, ConnectionError):
            pass
        *lines, self.buffer = self.buffer.split(b"\r")
        for line in lines:
            if line.startswith(b"t"):
                name = self.codec.get_message_by_frame_id(int(line[1:4], 16)).name
                values: Any = self.codec.decode_message(name, bytes.fromhex(line[5:].decode()))
                yield name, values

    def _send(self, name: str, values: dict[str, Any]) -> None:
        message = self.codec.get_message_by_name(name)
        frame = can.Message(arbitration_id=message.frame_id, data=message.encode(values))
        line = f"t{frame.arbitration_id:03X}{frame.dlc}{frame.data.hex()}\r".encode()
        try:
            if self.link is not None:
                self.link.send(line)
        except (BlockingIOError, ConnectionError):
            pass

    def _note_states(self) -> None:
        current = {3: self.mission}
        current |= {10 + 2 * i: j.state for i, j in enumerate(self.joints)}
        for number, state in current.items():
            if self.states.get(number) != state:
                self.states[number] = state
                self._record("STATE", number, self.leaves[number].index(state))

    def _record(self, kind: str, element: int, value: int) -> None:
        time_ns = round((time.monotonic() - self.start) * 1e9)
        self.trace.append(f"T {time_ns} {kind} {element} {value}\n")

    def _finish(self) -> None:
        late = [o[5:] for o in self.options if o.startswith("late=")]
        worst = late[0] if late else "400000"
        self.trace += [
            f"P 1 {self.releases} {int('miss' in self.options)} {worst}\n",
            f"A 2 90000\nH STALE_INPUT 0\nL trace {7 * ('lose' in self.options)}\n",
        ]
        if "cut" not in self.options:
            self.trace.append("END\n")
        self.trace_file.write_text("".join(self.trace))


if __name__ == "__main__":
    sys.exit(Controller(Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3:]).run())
