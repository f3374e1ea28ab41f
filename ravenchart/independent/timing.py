# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The certificate against the model: its facts, its terms, and its claimed bounds.

Tasks: Joseph and Pandya 1986, Audsley et al. 1993, with several jobs in a busy period
(Lehoczky 1990) and release jitter (Tindell, Burns, Wellings 1994). Frames: Davis, Burns, Bril,
Lukkien 2007, with FIFO queues as in Davis and Navet 2012. Lateness follows the claimed
response of what releases; every window is solved anew from 0 on, so a claimed bound must be the
least fixed point of what follows from the model.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path

from .ada import Certificate, certificate
from .deployment import Deployment
from .findings import Report, UnusableError
from .messages import Message
from .tasks import Task, ada

MOST_STEPS = 100_000
ERROR_BITS = 31

LEFT = (
    (r"chain_.*", "chains from end to end"),
    (r".*_done", "rows on the way of a chain"),
    (r".*_(at|w_at|needs_at|since)_\d+|.*_(cycle|reach)", "instants of offsets"),
    (r".*_depth", "depths of mailboxes with logical execution times"),
    (r".*_(stale|stale_needs|max_age|looks)", "staleness of protected ports"),
    (r".*_(data_bits|few|residual|residual_needs|residual_per_hour)", "residual errors"),
)
"""Numbers that are not derived again; the conditions over them are evaluated all the same."""


class Timing:
    """One certificate and the deployment that it must be about."""

    def __init__(self, deployment: Deployment, path: Path, report: Report) -> None:
        self.deployment, self.report = deployment, report
        system = ada(deployment.model.name)
        self.certificate: Certificate = certificate(path, f"{system}.Timing_Certificate")
        self.known: set[str] = set()

    def check(self) -> None:
        """Compare everything."""
        found, report = self.certificate, self.report
        said, line = found.digest
        own = self.deployment.model.digest
        report.agree("digest", found.path, line, said == own, f"the digest is not {own}")
        for at, text in found.problems:
            report.agree("checks", found.path, at, False, text)
        report.counts["checks"] += found.conditions
        for name in self.deployment.nodes:
            self._platform(name)
        for task in self.deployment.tasks:
            self._facts(task)
        for name in self.deployment.buses:
            used = any(m.bus == name for m in self.deployment.messages)
            if used or len(self.deployment.nodes) > 1:  # one node has the buses that it uses
                self._bus(name)
        for message in self.deployment.messages:
            self._message(message)
        for task in self.deployment.tasks:
            self._responses(task)
        for name in self.deployment.buses:
            self._arbitration(name)
            for node in self.deployment.nodes:
                self._receptions(name, node)
        for message in self.deployment.messages:
            self._transfer(message)
        self._strangers()

    # --- comparing

    def value(self, name: str, otherwise: int = 0) -> int:
        """A number as the certificate has it; those asked for are checked elsewhere."""
        found = self.certificate.numbers.get(name.lower())
        return otherwise if found is None else found.value

    def has(self, name: str) -> bool:
        """Is there such a number?"""
        return name.lower() in self.certificate.numbers

    def same(self, kind: str, name: str, wanted: int, why: str) -> bool:
        """Compare a number with that which follows from the model."""
        self.known.add(name.lower())
        found = self.certificate.numbers.get(name.lower())
        path = self.certificate.path
        if found is None:
            return self.report.agree(kind, path, 1, False, f"{name} is missing: {why} is {wanted}")
        text = f"{found.name} is {found.value}; {why} is {wanted}"
        return self.report.agree(kind, path, found.line, found.value == wanted, text)

    def terms(self, kind: str, name: str, wanted: Iterable[str]) -> None:
        """Each of these numbers must be a term of another one."""
        found = self.certificate.numbers.get(name.lower())
        if found is None:
            return
        for term in wanted:
            text = f"{found.name} does not count {term}"
            holds = term.lower() in found.names
            self.report.agree(kind, self.certificate.path, found.line, holds, text)

    # --- facts

    def _platform(self, name: str) -> None:
        node, own = self.deployment.nodes.map(name), ada(name)
        wanted = {key: node.time(key) for key in ("context_switch", "critical_section")}
        if node.time("release", 0):
            wanted["release"] = node.time("release")
        if node.map("tick"):
            wanted["Tick_T"] = node.map("tick").time("period")
            wanted["Tick_C"] = node.map("tick").time("wcet")
        for key, time in wanted.items():
            self.same("platform", f"{own}_{ada(key)}", time, f"`{key}` of {name}")
        for device in self.deployment.equipment.devices:
            if self.has(f"{ada(device)}_Section"):
                longest = self.deployment.equipment.section(device, wanted["critical_section"])
                self.same("platform", f"{ada(device)}_Section", longest, f"the longest of {device}")
        if node.map("supervision"):
            margin = node.map("supervision").time("margin")
            self.same("platform", f"{own}_Margin", margin, f"the margin of {name}")
            watcher = ada(f"{name}.supervisor")
            for task in self.deployment.processors:
                if task.node == name:
                    late, found = task.deadline + margin, f"{ada(task.element)}_S"
                    self.same("tasks", f"{ada(task.element)}_L", late, "deadline and margin")
                    late += self.value(f"{watcher}_T") + self.value(f"{watcher}_R")
                    self.same("tasks", found, late, "that, a period and a response of the watch")

    def switch(self, node: str) -> int:
        """The time of a context switch."""
        return self.deployment.nodes.map(node).time("context_switch")

    def tick(self, node: str) -> tuple[int, int]:
        """Period and time of the timer's interrupt; (0, 0) without."""
        form = self.deployment.nodes.map(node).map("tick")
        return (form.time("period"), form.time("wcet")) if form else (0, 0)

    def _has_logical_chains(self) -> bool:
        """Whether a chain gives its senders a logical execution time."""
        chains = self.deployment.model.section("chains").maps()
        return any(form.text("logical_execution_time") for _, form in chains)

    def _facts(self, task: Task) -> None:
        own, why = ada(task.element), f"of {task.element} by the model"
        level = own if task.after is None else f"{ada(task.element.partition('.')[0])}_Driver"
        self.same("tasks", f"{level}_Priority", task.priority, f"the priority {why}")
        self.same("tasks", f"{own}_T", task.period, f"the period {why}")
        self.same("tasks", f"{own}_D", task.deadline, f"the deadline {why}")
        periodic = bool(task.rows) and not task.sporadic
        if periodic and any(t.offset for t in self.deployment.tasks if t.node == task.node):
            self.same("tasks", f"{own}_O", task.offset, f"the offset {why}")
        lasting = task.lasting
        if not lasting and self.has(f"{own}_Let") and self._has_logical_chains():
            self.report.skip("which processors send on chains with logical execution times")
            lasting = task.period
        if lasting:
            self.same("tasks", f"{own}_Let", lasting, f"the logical execution time {why}")
        jitter = self.jitter(task)
        self.same("tasks", f"{own}_J", jitter, f"the lateness of {task.element}")
        if not task.rows:
            self.same("rows", f"{own}_Wcet", task.wcet, f"the WCET {why}")
        for row in task.rows:
            name, what = ada(row.element), f"of {row.element} by the model"
            self.same("rows", f"{name}_Wcet", row.wcet, f"the WCET {what}")
            if not task.sporadic:
                timed = own if all(one.divisor == 1 for one in task.rows) else name
                self.same("rows", f"{timed}_Divisor", row.divisor, f"the divisor {what}")
                if row.is_open:
                    row.phase = self.value(f"{name}_Phase")
                    late, least = row.phase < row.divisor, min(row.phase, row.divisor - 1)
                    self.same("rows", f"{timed}_Phase", least, f"the phase {what}")
                    self.report.agree("rows", self.certificate.path, 1, late, f"{name} never runs")
                else:
                    self.same("rows", f"{timed}_Phase", row.phase, f"the phase {what}")
        for divisor, wcet in self.wcets(task).items():
            letter = "C" if divisor == 1 else f"C_{divisor}"
            self.same("sums", f"{own}_{letter}", wcet, f"the sum of WCETs {why}")
            rows = [row.element for row in task.rows if row.divisor == divisor]
            rows = rows if task.rows else [task.element]
            self.terms("sums", f"{own}_{letter}", [f"{ada(row)}_Wcet" for row in rows])
        blocking = self.deployment.blocking(task)
        self.same("sums", f"{own}_B", blocking, f"the longest blocking of {task.element}")

    def jitter(self, task: Task) -> int:
        """From the event that leads to a task until its release, at most."""
        if task.after is not None:
            return self.value(f"{ada(task.after)}_R")
        if task.port is not None and not task.rows:
            return 0  # an interrupt waits for no timer
        return self.tick(task.node)[0]

    def wcets(self, task: Task) -> dict[int, int]:
        """Its work with context switches."""
        works = dict(task.works)
        works[1] += self.switches(task)
        return works

    def longest(self, task: Task) -> int:
        """The work of its longest job, with context switches."""
        return task.longest + self.switches(task)

    def switches(self, task: Task) -> int:
        """The context switches of a job."""
        return (4 if task.sporadic else 2) * self.switch(task.node)

    def _bus(self, name: str) -> None:
        form, own = self.deployment.buses.map(name), ada(name)
        self.same("buses", f"{own}_Bit_Rate", form.time("bit_rate"), f"the bit rate of {name}")
        self.same("buses", f"{own}_Bit", self.bit(name), f"a bit of {name} in ns")
        if form.text("data_rate"):
            rate = form.time("data_rate")
            self.same("buses", f"{own}_Data_Rate", rate, f"the data rate of {name}")
        errors = form.map("errors")
        if errors:
            self.same("buses", f"{own}_Error_T", errors.time("period"), "the period of errors")
            self.same("buses", f"{own}_Error_Burst", errors.number("burst", 1), "their burst")
            self.same("buses", f"{own}_Error_Bits", ERROR_BITS, "the bits lost to an error")

    def bit(self, bus: str) -> int:
        """One bit in ns, rounded up."""
        return -(-(10**9) // self.deployment.buses.map(bus).time("bit_rate"))

    def time(self, message: Message) -> int:
        """The longest transmission of a message."""
        form = self.deployment.buses.map(message.bus)
        rate = form.time("bit_rate")
        return message.frame.time(rate, form.time("data_rate", rate))

    def _message(self, message: Message) -> None:
        own, why = ada(message.element), f"of {message.element} by the model"
        if message.identifier is None:  # found by Audsley's search: the order is checked by use
            message.identifier = self.value(f"{own}_Id")
            self.known.add(f"{own}_Id".lower())
            self.report.skip("identifiers found by `identifiers: audsley`")
        else:
            self.same("messages", f"{own}_Id", message.identifier, f"the identifier {why}")
        self.same("messages", f"{own}_T", message.period, f"the period {why}")
        self.same("messages", f"{own}_D", message.deadline, f"the deadline {why}")
        if message.renewal:
            self.same("messages", f"{own}_Renewal", message.renewal, f"the renewal {why}")
        late = self.late(message)
        self.same("messages", f"{own}_J", late, f"the lateness of {message.element}")
        for part, bits in message.frame.parts().items():
            self.same("messages", f"{own}_{part}", bits, f"`{part}` {why}")
        self.same("messages", f"{own}_C", self.time(message), f"the transmission time {why}")

    def late(self, message: Message) -> int:
        """From its event until a frame is queued, at most."""
        if message.source is None:
            return 0
        return self.value(f"{ada(message.sending)}_R")

    # --- responses of tasks

    def _responses(self, task: Task) -> None:
        own = ada(task.element)
        jitter, claimed = self.jitter(task), self.value(f"{own}_R")
        windows: list[int] = []
        while not windows or jitter + windows[-1] > len(windows) * task.period:
            job = len(windows) + 1
            start = windows[-1] if windows else 0
            windows.append(self.solved(partial(self.demand, task, job), start))
        late = max(jitter + w - n * task.period for n, w in enumerate(windows))
        self.same("responses", f"{own}_R", late, f"the response time of {task.element}")
        inside = [t for t in self.deployment.tasks if t.place == task.place and t is not task]
        above = [
            f"{ada(t.element)}_{'C' if n == 1 else f'C_{n}'}"
            for t in inside
            if t.priority >= task.priority
            for n in self.wcets(t)
        ]
        phased = any(row.phase for row in task.rows)
        if phased:
            wanted = self.longest(task)
            self.same("sums", f"{own}_Longest", wanted, f"the longest job of {task.element}")
        mine = [f"{own}_{'C' if n == 1 else f'C_{n}'}" for n in self.wcets(task)]
        for job, window in enumerate(windows, 1):
            counted = [f"{own}_Longest"] if phased and job == 1 else mine
            tail = "" if len(windows) == 1 else f"_{job}"
            self.same("responses", f"{own}_W{tail}", window, f"the window of job {job}")
            self.same("responses", f"{own}_Needs{tail}", window, f"the demand of job {job}")
            self.terms("responses", f"{own}_Needs{tail}", [*counted, f"{own}_B", *above])
        if self.has(f"{own}_Reach"):
            self.report.skip("deadlines that are kept by offsets alone")
        else:
            line = self.line(f"{own}_R")
            text = (
                f"{task.element} can miss its deadline: R = {claimed} ns > D = {task.deadline} ns"
            )
            path = self.certificate.path
            self.report.agree("responses", path, line, claimed <= task.deadline, text)

    def line(self, name: str) -> int:
        """The line of a number."""
        found = self.certificate.numbers.get(name.lower())
        return 1 if found is None else found.line

    def solved(self, demand: Callable[[int], int], start: int) -> int:
        """The least window that holds its demand."""
        window = start
        for _ in range(MOST_STEPS):
            needed = demand(window)
            if needed == window:
                return window
            window = needed
        raise UnusableError("a window grows without end: what delays a task or frame is too much")

    def demand(self, task: Task, jobs: int, window: int) -> int:
        """The work of so many jobs and of all that delays them within a window."""
        own = self.longest(task) if jobs == 1 else _work(self.wcets(task), jobs)
        total = own + self.deployment.blocking(task)
        release = self.deployment.nodes.map(task.node).time("release", 0)
        for other in self.deployment.tasks:
            if other.place != task.place:
                continue
            count = -(-(window + self.jitter(other)) // other.period)
            if other is not task and other.priority >= task.priority:
                total += _work(self.wcets(other), count)
            total += count * release * (2 if other.sporadic else 1)
        period, wcet = self.tick(task.node)
        return total + (-(-window // period) * wcet if period else 0)

    # --- responses of messages

    def _arbitration(self, bus: str) -> None:
        order = sorted((m for m in self.deployment.messages if m.bus == bus), key=lambda m: m.rank)
        own = ada(bus)
        if self.has(f"{own}_Busiest"):
            longest = self.solved(lambda w: self.traffic(order, None, w), self.time(order[0]))
            self.same("arbitration", f"{own}_Busiest", longest, f"the longest work of {bus}")
            self.same("arbitration", f"{own}_Busiest_Needs", longest, "the demand within it")
        for place, message in enumerate(order, 1):
            if self.has(f"{ada(message.element)}_Wait"):
                wait = self.value(f"{own}_Busiest") - self.time(message)
                name = f"{ada(message.element)}_Wait"
                self.same("arbitration", name, wait, "its wait in a queue")
            reach = len(order) if self.queue(message) else place
            self._frame(message, order[:reach], order[reach:])

    def queue(self, message: Message) -> str:
        """The first-in first-out queue it waits in; "" for none."""
        form = self.deployment.buses.map(message.bus)
        return "" if message.node is None or form.text("buffers") == "priority" else message.node

    def count(self, other: Message, message: Message | None, window: int) -> int:
        """How often a frame goes before a message within a window."""
        late = self.late(other)
        if message is not None and other.node is not None:
            own = ada(other.element)
            if self.queue(other) == self.queue(message):
                pass
            elif self.has(f"{own}_Wait"):
                late += self.value(f"{own}_Wait")
            else:
                late = self.value(f"{own}_R") - self.time(other)
        return -(-(window + late) // other.period)

    def traffic(self, frames: list[Message], message: Message | None, window: int) -> int:
        """The time of these frames within a window, and what errors take."""
        lost = self.lost(frames, window)
        return lost + sum(self.count(m, message, window) * self.time(m) for m in frames)

    def lost(self, frames: list[Message], window: int) -> int:
        """The time lost to errors, each of which may spoil the longest of these frames."""
        bus = frames[0].bus
        errors = self.deployment.buses.map(bus).map("errors")
        if not errors:
            return 0
        hits = errors.number("burst", 1) - 1 + -(-window // errors.time("period"))
        return hits * (ERROR_BITS * self.bit(bus) + max(map(self.time, frames)))

    def _frame(self, message: Message, before: list[Message], behind: list[Message]) -> None:
        own, length, late = ada(message.element), self.time(message), self.late(message)
        blocking = max(map(self.time, behind), default=0)
        bit, claimed = self.bit(message.bus), self.value(f"{own}_R")
        others = [m for m in before if m is not message]
        busy = self.solved(lambda w: blocking + self.traffic(before, message, w), length)
        why = f"the busy period of {message.element}"
        self.same("arbitration", f"{own}_Busy", busy, why)
        self.same("arbitration", f"{own}_Busy_Needs", busy, "the demand within it")
        self.terms("arbitration", f"{own}_Busy_Needs", [f"{ada(m.element)}_C" for m in before])
        count = -(-(busy + late) // message.period)

        def waiting(instance: int, window: int) -> int:
            delay = blocking + instance * length + self.lost(before, window + length)
            for other in others:
                delay += self.count(other, message, window + bit) * self.time(other)
            return delay

        windows: list[int] = []
        for instance in range(count):
            start = windows[-1] if windows else 0
            windows.append(self.solved(partial(waiting, instance), start))
            tail = "" if count == 1 else f"_{instance + 1}"
            why = f"the wait of instance {instance + 1} of {message.element}"
            self.same("arbitration", f"{own}_W{tail}", windows[-1], why)
            self.same("arbitration", f"{own}_Needs{tail}", windows[-1], "the demand within it")
            needed = [f"{ada(m.element)}_C" for m in others]
            self.terms("arbitration", f"{own}_Needs{tail}", needed)
        response = max(late + w + length - n * message.period for n, w in enumerate(windows))
        self.same("arbitration", f"{own}_R", response, f"the response time of {message.element}")
        text = (
            f"{message.element} can miss its deadline: R = {claimed} ns > D = {message.deadline} ns"
        )
        path, line = self.certificate.path, self.line(f"{own}_R")
        self.report.agree("arbitration", path, line, claimed <= message.deadline, text)

    # --- receptions, and values in several frames

    def _receptions(self, bus: str, node: str) -> None:
        """When the reception of a node, first in first out, has handed over what arrives.

        Each frame takes one separation of the reception, and then its response twice.
        """
        heard = self.deployment.heard(bus, node)
        here = (t for t in self.deployment.processors if (t.bus, t.node) == (bus, node))
        reception = next(here, None)
        if reception is None:
            return

        def served(among: list[tuple[Message, str]], window: int) -> int:
            late = [(m.period, self.value(f"{ada(driver)}_R")) for m, driver in among]
            return sum(-(-(window + r) // period) * reception.period for period, r in late)

        def waiting(among: list[tuple[Message, str]], number: int, window: int) -> int:
            return number * reception.period + served(among, window + 1)

        for message, driver in heard:
            several = len(self.deployment.receivers(message)) > 1
            own = ada(f"{message.element}.{node}" if several else message.element)
            if not self.has(f"{own}_Turn") and not message.transfer and not message.controls:
                continue
            if several:
                self.same("receptions", f"{own}_T", message.period, f"the period of {own}")
            late = self.value(f"{ada(driver)}_R")
            self.same("receptions", f"{own}_Turn_J", late, f"the response of {driver}")
            line, busy = ada(reception.element), self.solved(partial(served, heard), 1)
            self.same("receptions", f"{line}_Busy", busy, f"the busy period of {line}")
            self.same("receptions", f"{line}_Busy_Needs", busy, "the demand within it")
            others = [one for one in heard if one[0] is not message]
            count = -(-(busy + late) // message.period)
            turn, window = 0, 0
            for number in range(count):
                window = self.solved(partial(waiting, others, number), window)
                tail = "" if count == 1 else f"_{number + 1}"
                why = f"the wait of frame {number + 1} of {own}"
                self.same("receptions", f"{own}_Turn_W{tail}", window, why)
                self.same("receptions", f"{own}_Turn_Needs{tail}", window, "the demand within it")
                turn = max(turn, late + window - number * message.period)
            self.same("receptions", f"{own}_Turn", turn, f"the longest wait of {own}")
            handed = turn + 2 * self.value(f"{ada(reception.element)}_R")
            self.same("receptions", f"{own}_Handed", handed, f"turn and two responses of {own}")

    def _transfer(self, message: Message) -> None:
        """The time of a value in several frames, with the round trips of its flow control."""
        transfer, flow = message.transfer, message.flow
        if transfer is None or flow is None:
            return
        own = ada(message.element)
        segment = self.value(f"{own}_Handed")
        heard = segment + flow.period + self.value(f"{ada(flow.element)}_Handed")
        trip = max(message.period, -(-heard // transfer.row) * transfer.row)
        last = transfer.rounds * trip
        last += (transfer.further - transfer.rounds) * message.period
        wanted = {
            "Row": (transfer.row, "the period of the row that sends"),
            "Round_Trip": (trip, "the longest round trip of flow control"),
            "Transfer": (last + segment, "the longest transfer"),
            "Renewal": (last + message.period, "the longest time from one value to the next"),
            "Timeout": (transfer.timeout, "the time-out"),
        }
        for part, (time, why) in wanted.items():
            self.same("transfers", f"{own}_{part}", time, f"{why} of {message.element}")
        text = f"{message.element} can be given up: its round trip and delivery take "
        text += f"{trip + segment} > {transfer.timeout}"
        line, path = self.line(f"{own}_Timeout"), self.certificate.path
        self.report.agree("transfers", path, line, trip + segment <= transfer.timeout, text)

    # --- the rest

    def _strangers(self) -> None:
        """No number but those that follow from the model, and those not derived again."""
        _, way = LEFT[1]
        kept: dict[str, str] = {}
        for row in (row for task in self.deployment.processors for row in task.rows):
            kept |= {f"{ada(row.element)}_{part}".lower(): way for part in ("W", "Needs")}
        for name, found in self.certificate.numbers.items():
            if name in self.known:
                self.report.counts["names"] += 1
                continue
            left = kept.get(name) or next((w for p, w in LEFT if re.fullmatch(p, name)), None)
            text = f"{found.name} is a number that nothing in the model leads to"
            self.report.agree("names", self.certificate.path, found.line, left is not None, text)
            if left is not None:
                self.report.skip(left)


def _work(wcets: dict[int, int], jobs: int) -> int:
    """The time of so many consecutive jobs, the first of which executes all rows."""
    return sum(-(-jobs // divisor) * wcet for divisor, wcet in wcets.items())
