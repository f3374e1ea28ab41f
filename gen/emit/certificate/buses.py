# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The messages of a bus in the timing certificate, and the reception's queue.

A frame waits for the longest one that goes behind it and has begun, for those that go before it,
and for errors. Arbitration is over a bit later than the frame could begin. All instances of a busy
period count. Frames that a node sends share a first-in first-out queue, unless its buffers are by
priority. The driver may hand the frames of a queue over one by one. So any frame may go before
each of them, and to others a frame is as late as it may have waited.
"""

from __future__ import annotations

from collections.abc import Callable, Set
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

from ravenchart.gen.derive.identifiers import leading
from ravenchart.gen.emit.ada.declarations import Decl
from ravenchart.gen.emit.ada.expressions import Expr, OperatorChain, Power, bits, number
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.statements import Comment
from ravenchart.gen.model.buses import Bus, Message
from ravenchart.gen.model.claims import Claims, ResponseClaim
from ravenchart.gen.model.nodes import Node
from ravenchart.gen.model.system import System

from .frames import explained, length_terms, rate_terms, span
from .interference import Interferer, Ladder, W, demand_within
from .terms import (
    IN_WINDOWS,
    LATE,
    ONE,
    RESPONSE,
    assured,
    exact,
    less_periods,
    name_of,
    named_number,
    none_of,
    plus,
    refuse,
    stated,
    times,
)

ERROR_BITS = 31
"""Bits lost to one error besides the frame that is sent again: Tindell and Burns 1994."""


BUSY = "busy period"


def arbitration(message: Message) -> tuple[int, bool, int]:
    """Of two frames the one with the lesser key wins."""
    return leading(message), message.extended, message.identifier


def _of(system: System, bus: Bus) -> list[Message]:
    """The messages of a bus, most urgent first."""
    return sorted((m for m in system.frames if m.bus == bus.name), key=arbitration)


def bus_terms(system: System, bus: Bus) -> list[Decl]:
    """The numbers of a bus and its messages."""
    own = ada_case(bus.name)
    words = (
        f"[{bus.name}] Bit_Rate: bits in a second. Bit: one bit in nanoseconds, rounded up. A "
        "message waits for the longest frame of lower priority, which has begun, and for the "
        f"frames of higher priority.\nOf a message, {explained(bus)}"
    )
    messages = _of(system, bus)
    items: list[Decl] = [Comment(words), *rate_terms(bus, messages)]
    if bus.errors is not None:
        hit = (
            f"[{bus.name}] Error_Burst: errors at once. Error_T: the distance of further errors. "
            "Error_Bits: bits lost to each error."
        )
        items += [
            Comment(hit),
            stated(f"{own}_Error_Burst", bus.errors.burst),
            stated(f"{own}_Error_T", bus.errors.period),
            stated(f"{own}_Error_Bits", ERROR_BITS),
        ]
    for message in messages:
        items += _terms(message, bus)
    return items


def _order(messages: list[Message], bus: Bus) -> list[Decl]:
    """Arbitration has the order that the sums suppose."""
    alike = len({message.extended for message in messages}) == 1
    ranks = [ref(f"{name_of(m.element)}_Id") if alike else _rank(m) for m in messages]
    wrong = [OperatorChain(">=", pair) for pair in pairwise(ranks)]
    return none_of(wrong, bus.name, "must keep the order of its identifiers")


def _rank(message: Message) -> Expr:
    """A number for each identifier: of two frames the one with the lesser wins."""
    identifier = ref(f"{name_of(message.element)}_Id")
    if message.extended:
        return plus(times(number(2), identifier), ONE)
    return times(Power(2, 19), identifier)


def _terms(message: Message, bus: Bus) -> list[Decl]:
    """The numbers of a message."""
    own = name_of(message.element)
    width = 29 if message.extended else 11
    sender = "outside" if message.source is None else str(message.source)
    words = (
        f"[{message.element}] {width}-bit Id, Length bytes"
        f"{' of CAN FD' if message.fd else ''} from {sender}"
    )
    mode = message.transmission
    if mode is not None:
        words += f", sent {mode.words}, T apart at least"
    items: list[Decl] = [
        Comment(words),
        named_number(f"{own}_Id", bits(message.identifier)),
        stated(f"{own}_Length", message.length),
        stated(f"{own}_T", message.period),
        stated(f"{own}_D", message.limit),
        *length_terms(message, bus),
    ]
    if message.source is None:
        items.append(stated(f"{own}_J", 0))
    else:
        items.append(named_number(f"{own}_J", ref(f"{name_of(message.sending)}_R")))
    if mode is not None and mode.longest is not None:
        items += [
            Comment(f"[{message.element}] the longest time from one frame to the next"),
            stated(f"{own}_Renewal", mode.longest),
        ]
    return items


# --- Claims --------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Level:
    """The messages that go before a message, itself included, and those that can go behind."""

    bus: Bus
    message: Message
    before: list[Message]
    behind: list[Message]
    ladder: Ladder

    @property
    def blocking(self) -> Expr:
        """The longest frame that may have begun."""
        longest = max(self.behind, key=self._span, default=None)
        return number(0) if longest is None else ref(f"{name_of(longest.element)}_C")

    def _span(self, message: Message) -> Fraction:
        return span(message, self.bus)

    def lost(self, window: Expr) -> list[Expr]:
        """The time lost to errors within a window, each of which may spoil the longest frame."""
        if self.bus.errors is None:
            return []
        line = ada_case(self.bus.name)
        longest = name_of(max(self.before, key=self._span).element)
        bits = times(ref(f"{line}_Error_Bits"), ref(f"{line}_Bit"))
        hit = plus(bits, ref(f"{longest}_C"))
        burst = OperatorChain("-", (ref(f"{line}_Error_Burst"), ONE))
        return [times(burst, hit), demand_within(window, number(0), ref(f"{line}_Error_T"), hit)]


def _ladders(system: System, bus: Bus, order: list[Message], claims: Claims) -> dict[str, Ladder]:
    """The messages of a bus as those see them that wait in each queue, or in none ("").

    Frames of one queue delay each other, whatever their identifiers. To others a frame of a
    queue is late by the time that it may have waited there, as a rule R - C.
    """
    found: dict[str, Ladder] = {}
    queues = {system.queue(m): m for m in order}
    for queue, sent in sorted(queues.items()):
        names = "Up", "Rest"
        if len(queues) > 1 and queue:
            node = ada_case(system.sender(sent))
            names = f"Up_{node}", f"Rest_{node}"
        steps = []
        inside = {m.element for m in order if queue and system.queue(m) == queue}
        for place, other in enumerate(sorted(order, key=lambda m: m.element in inside)):
            own = name_of(other.element)
            late: Expr = ref(f"{own}_J")
            if other.source is not None and system.queue(other) != queue:
                late = OperatorChain("-", (ref(f"{own}_R"), ref(f"{own}_C")))
                if other.element in claims.waits:
                    late = plus(ref(f"{own}_Wait"), ref(f"{own}_J"))
            level = len(order) if other.element in inside else place
            steps.append(Interferer(own, (_sent(own, late),), level))
        found[queue] = Ladder(tuple(steps), *names)
    return found


def _sent(own: str, late: Expr) -> Expr:
    return demand_within(W, late, ref(f"{own}_T"), ref(f"{own}_C"))


def bus_claims(system: System, bus: Bus, claims: Claims, handed: Set[str]) -> list[Decl]:
    """The instances of each message, with its response that they show; then those handed over."""
    order = _of(system, bus)
    items = _waits(system, bus, order, claims)
    ladders = _ladders(system, bus, order, claims)
    for ladder in ladders.values():
        items += ladder.functions()
    items += _order(order, bus)
    for number_, message in enumerate(order, 1):
        queue = system.queue(message)
        reach = len(order) if queue else number_
        items += _of_message(
            _Level(bus, message, order[:reach], order[reach:], ladders[queue]), claims
        )
    for node in system.nodes:
        items += _turns(system, bus, node, claims, handed)
    return items


def _waits(system: System, bus: Bus, order: list[Message], claims: Claims) -> list[Decl]:
    """The messages that wait no longer than the bus is ever busy, whatever the order."""
    if bus.name not in claims.busiest:
        return []
    line = ada_case(bus.name)
    busiest = ref(f"{line}_Busiest")
    own = [name_of(message.element) for message in order]
    steps = (Interferer(one, (_sent(one, ref(f"{one}_J")),), n) for n, one in enumerate(own))
    ladder = Ladder(tuple(steps), "Queued")
    lost = _Level(bus, order[0], order, [], ladder).lost(busiest)
    items: list[Decl] = [
        Comment(
            f"[{bus.name}] the longest busy period, and the messages that wait no longer in a queue"
        ),
        *ladder.functions(),
        stated(f"{line}_Busiest", claims.busiest[bus.name]),
        named_number(f"{line}_Busiest_Needs", plus(*ladder.whole(own[-1], busiest), *lost)),
        exact(busiest, [ref(f"{line}_Busiest_Needs")], bus.name, BUSY, least=1),
    ]
    for message in order:
        if message.element in claims.waits:
            wait = f"{name_of(message.element)}_Wait"
            longest = OperatorChain("-", (busiest, ref(f"{name_of(message.element)}_C")))
            items.append(stated(wait, claims.waits[message.element]))
            items.append(exact(ref(wait), [longest], message.element, "wait in a queue"))
    return items


def _of_message(level: _Level, claims: Claims) -> list[Decl]:
    """The claim about one message."""
    message, claim = level.message, claims.of(level.message.element)
    own, line = name_of(message.element), ada_case(level.bus.name)

    def waiting(instance: int, window: Expr) -> Expr:
        earlier = [times(number(instance), ref(f"{own}_C"))] if instance else []
        until = plus(window, ref(f"{line}_Bit"))
        hit = level.lost(plus(window, ref(f"{own}_C")))
        return plus(level.blocking, *earlier, *level.ladder.others(own, until), *hit)

    busy = ref(f"{own}_Busy")
    demand = plus(level.blocking, *level.ladder.whole(own, busy), *level.lost(busy))
    jitter, response = ref(f"{own}_J"), ref(f"{own}_R")
    items: list[Decl] = [Comment(f"[{message.element}] {IN_WINDOWS}")]
    items += _busy(own, message.element, claim, demand)
    sent = ref(f"{own}_C")
    last = OperatorChain("-", (response, jitter, sent)) if len(claim.windows) == 1 else None
    items += _windows(own, message.element, claim, waiting, (busy, jitter), last=last)
    if last is None:
        ends = [
            less_periods(plus(jitter, ref(f"{own}_W{_tail(claim, n)}"), sent), own, n)
            for n in range(len(claim.windows))
        ]
        items.append(exact(response, ends, message.element, RESPONSE))
    items.append(refuse(response, ref(f"{own}_D"), message.element, LATE))
    items.append(assured((response, ref(f"{own}_D"))))
    return items


def _tail(claim: ResponseClaim, instance: int) -> str:
    return "" if len(claim.windows) == 1 else f"_{instance + 1}"


def _busy(own: str, label: str, claim: ResponseClaim, demand: Expr) -> list[Decl]:
    """A busy period: no time at all would hold no demand as well."""
    busy, needs = ref(f"{own}_Busy"), ref(f"{own}_Busy_Needs")
    return [
        stated(busy, claim.busy),
        named_number(needs, demand),
        exact(busy, [needs], label, BUSY, least=1),
    ]


def _windows(
    own: str,
    label: str,
    claim: ResponseClaim,
    waiting: Callable[[int, Expr], Expr],
    span_of: tuple[Expr, Expr],
    prefix: str = "",
    last: Expr | None = None,
) -> list[Decl]:
    """The windows of all instances in a busy period, the first as late as can be: no more come.

    ``last`` is the only window where there is one.
    """
    most = times(number(len(claim.windows)), ref(f"{own}_T"))
    items: list[Decl] = [refuse(plus(*span_of), most, label, "can come again before it is sent")]
    for instance, length in enumerate(claim.windows):
        tail = _tail(claim, instance)
        window, needs = ref(f"{own}_{prefix}W{tail}"), ref(f"{own}_{prefix}Needs{tail}")
        items += [
            named_number(window, number(length) if last is None else last),
            named_number(needs, waiting(instance, window)),
            exact(window, [needs], label, RESPONSE),
        ]
    return items


def _turns(system: System, bus: Bus, node: Node, claims: Claims, handed: Set[str]) -> list[Decl]:
    """When the reception, which keeps its least separation, has handed each message over."""
    received = system.received(bus.name, node.name)
    wanted = [one for one in received if one.element in handed]
    if not wanted:
        return []
    here = bus.name, node.name
    processor = next(p for p in system.processors if (p.released_by, p.node) == here)
    separation, reply = (ref(f"{name_of(processor.name)}_{letter}") for letter in "TR")
    steps = []
    for one in received:
        late, period = (ref(f"{name_of(one.driver)}_R"), ref(f"{name_of(one.message.element)}_T"))
        steps.append(
            Interferer(name_of(one.element), (demand_within(W, late, period, separation),), 0)
        )
    ladder = Ladder(tuple(steps), "Turn_Up", "Turn_Rest")
    line = name_of(processor.name)
    busy = ref(f"{line}_Busy")
    first = claims.turns.get(wanted[0].element, ResponseClaim())
    whole = plus(*ladder.whole(steps[0].name, busy))
    items: list[Decl] = [
        Comment(f"[{processor.name}] the longest busy period of the reception"),
        *ladder.functions(),
        *_busy(line, processor.name, first, whole),
    ]
    for one in wanted:
        own, label = name_of(one.element), one.element
        claim = claims.turns.get(label, ResponseClaim())
        jitter, turn = ref(f"{own}_Turn_J"), ref(f"{own}_Turn")

        def waiting(instance: int, window: Expr, own: str = own) -> Expr:
            earlier = [times(number(instance), separation)] if instance else []
            return plus(*earlier, *ladder.others(own, plus(window, ONE)))

        words = (
            f"[{label}] Turn: the time until its turn in {processor.name} ends. Handed: the time "
            "until it is handed over."
        )
        items.append(Comment(words))
        if one.several:
            items.append(named_number(f"{own}_T", ref(f"{name_of(one.message.element)}_T")))
        items.append(named_number(jitter, ref(f"{name_of(one.driver)}_R")))
        items += _windows(own, label, claim, waiting, (busy, jitter), "Turn_")
        ends = [
            less_periods(plus(jitter, ref(f"{own}_Turn_W{_tail(claim, n)}")), own, n)
            for n in range(len(claim.windows))
        ]
        items += [
            stated(turn, claim.response),
            exact(turn, ends, label, RESPONSE),
            named_number(f"{own}_Handed", plus(turn, times(number(2), reply))),
        ]
    return items
