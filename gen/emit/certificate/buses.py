"""The messages of a bus in the timing certificate, and the reception's queue.

A frame waits for the longest one that goes behind it and has begun, for what goes
before it, and for errors; a bit later than it could begin, arbitration is over. All
instances of the busy period count. Frames that a node sends share a first-in
first-out queue, unless its buffers are by priority; of a queue the driver may hand over
one by one: any frame may go before each of them, and to others it is as late as it may
have waited.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Set
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

from ravenchart.gen.derive.identifiers import leading
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.syntax import Chain, Comment, Decl, Expr, Ref, number
from ravenchart.gen.model.claims import Claim, Claims
from ravenchart.gen.model.system import Bus, Message, Reception, System

from .frames import explained, length_terms, rate_terms, span
from .terms import (
    ONE,
    SLOW,
    arrivals,
    assured,
    before,
    bounded,
    ceiling,
    least,
    name_of,
    named,
    plus,
    refuse,
    stated,
    times,
    within,
)

ERROR_BITS = 31
"""Bits lost to one error besides the frame that is sent again: Tindell and Burns 1994."""


def arbitration(message: Message) -> tuple[int, bool, int]:
    """Of two frames the one with the lesser key wins."""
    return leading(message), message.extended, message.identifier


def _of(system: System, bus: Bus) -> list[Message]:
    """The messages of a bus, most urgent first."""
    return sorted((m for m in system.frames if m.bus == bus.name), key=arbitration)


def bus_terms(system: System, bus: Bus) -> list[Decl]:
    """What is known of a bus and its messages."""
    own = ada_case(bus.name)
    words = f"[{bus.name}] bits in a second, and one bit in nanoseconds, rounded up. Of a message, "
    items: list[Decl] = [Comment(words + explained(bus)), *rate_terms(bus)]
    if bus.errors is not None:
        hit = f"[{bus.name}] errors: so many at once, one more every T, bits lost to each"
        items += [
            Comment(hit),
            stated(f"{own}_Error_Burst", bus.errors.burst),
            stated(f"{own}_Error_T", bus.errors.period),
            stated(f"{own}_Error_Bits", ERROR_BITS),
        ]
    messages = _of(system, bus)
    for message in messages:
        items += _terms(message, bus)
    for first, second in pairwise(messages):
        problem = f"must win the arbitration against {second.element}"
        items.append(refuse(plus(_rank(first), ONE), _rank(second), first.element, problem))
    return items


def _rank(message: Message) -> Expr:
    """A number for each identifier: of two frames the one with the lesser wins."""
    identifier = Ref(f"{name_of(message.element)}_Id")
    if message.extended:
        return plus(times(number(2), identifier), ONE)
    return times(Ref("2**19"), identifier)


def _terms(message: Message, bus: Bus) -> list[Decl]:
    """What is known of a message."""
    own = name_of(message.element)
    width = 29 if message.extended else 11
    sender = "somebody outside" if message.source is None else str(message.source)
    words = (
        f"[{message.element}] {width}-bit identifier Id, Length bytes"
        f"{' of CAN FD' if message.fd else ''} from {sender}"
    )
    mode = message.transmission
    if mode is not None:
        words += f", sent {mode.words}, T apart at least"
    items: list[Decl] = [
        Comment(words),
        named(f"{own}_Id", Ref(f"16#{message.identifier:X}#")),
        stated(f"{own}_Length", message.length),
        stated(f"{own}_T", message.period),
        stated(f"{own}_D", message.limit),
        *length_terms(message, bus),
    ]
    if message.source is None:
        items.append(stated(f"{own}_J", 0))
    else:
        items.append(named(f"{own}_J", Ref(f"{name_of(message.sending)}_R")))
    if mode is not None and mode.longest is not None:
        items += [
            Comment(f"[{message.element}] the longest time from one frame to the next"),
            stated(f"{own}_Renewal", mode.longest),
        ]
    return [*items, arrivals(own)]


# --- Claims --------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Level:
    """What goes before a message, itself included, and what can go behind."""

    bus: Bus
    message: Message
    before: list[Message]
    behind: list[Message]
    queue: Callable[[Message], str]

    @property
    def blocking(self) -> Expr:
        """The longest frame that may have begun."""
        longest = max(self.behind, key=self._span, default=None)
        return number(0) if longest is None else Ref(f"{name_of(longest.element)}_C")

    @property
    def longest(self) -> str:
        """The longest frame that an error may spoil."""
        return name_of(max(self.before, key=self._span).element)

    def _span(self, message: Message) -> Fraction:
        return span(message, self.bus)

    def lost(self, window: Expr) -> list[Expr]:
        """The time lost to errors within a window."""
        if self.bus.errors is None:
            return []
        line = ada_case(self.bus.name)
        count = plus(Ref(f"{line}_Error_Burst - 1"), ceiling(window, Ref(f"{line}_Error_T")))
        bits = times(Ref(f"{line}_Error_Bits"), Ref(f"{line}_Bit"))
        return [times(count, plus(bits, Ref(f"{self.longest}_C")))]

    def instances(self, other: Message, window: Expr, claims: Claims) -> Expr:
        """How often another message goes before this one within a window.

        A frame of a queue is late by what it may have waited, as a rule R - C, for all
        but those in the same queue.
        """
        own = name_of(other.element)
        if other.source is None or self.queue(other) == self.queue(self.message):
            return within(own, window)
        if other.element in claims.waits:
            return within(own, plus(window, Ref(f"{own}_Wait")))
        return ceiling(
            plus(window, Chain("-", (Ref(f"{own}_R"), Ref(f"{own}_C")))), Ref(f"{own}_T")
        )


def bus_claims(system: System, bus: Bus, claims: Claims, handed: Set[str]) -> list[Decl]:
    """The instances of each message, and what they show of its response; then those handed over."""
    order = _of(system, bus)
    items = _waits(system, bus, order, claims)
    for number_, message in enumerate(order, 1):
        reach = len(order) if system.queue(message) else number_
        level = _Level(bus, message, order[:reach], order[reach:], system.queue)
        items += _of_message(level, claims)
    for message in order:
        for one in system.receptions(message):
            if one.element in handed:
                items += _turns(system, one, claims.turns.get(one.element, Claim()))
    return items


def _waits(system: System, bus: Bus, order: list[Message], claims: Claims) -> list[Decl]:
    """What waits no longer than the bus is ever busy, whatever the order."""
    if bus.name not in claims.busiest:
        return []
    line = ada_case(bus.name)
    busiest = Ref(f"{line}_Busiest")
    works = [
        times(within(name_of(m.element), busiest), Ref(f"{name_of(m.element)}_C")) for m in order
    ]
    lost = _Level(bus, order[0], order, [], system.queue).lost(busiest)
    problem = "can be busy longer than claimed"
    items: list[Decl] = [
        Comment(f"[{bus.name}] how long it is ever busy, and who waits no longer in a queue"),
        stated(f"{line}_Busiest", claims.busiest[bus.name]),
        named(f"{line}_Busiest_Needs", plus(*works, *lost)),
        refuse(ONE, busiest, bus.name, problem),
        *least(busiest, [Ref(f"{line}_Busiest_Needs")], bus.name, problem),
    ]
    for message in order:
        if message.element in claims.waits:
            own = name_of(message.element)
            problem = "can wait longer than claimed"
            longest = Chain("-", (busiest, Ref(f"{own}_C")))
            items.append(stated(f"{own}_Wait", claims.waits[message.element]))
            items += least(Ref(f"{own}_Wait"), [longest], message.element, problem)
    return items


def _of_message(level: _Level, claims: Claims) -> list[Decl]:
    """The claim about one message."""
    message, claim = level.message, claims.of(level.message.element)
    own, line = name_of(message.element), ada_case(level.bus.name)

    def rivals(window: Expr, others: list[Message]) -> list[Expr]:
        return [
            times(level.instances(m, window, claims), Ref(f"{name_of(m.element)}_C"))
            for m in others
        ]

    def waiting(instance: int, window: Expr) -> Expr:
        others = [m for m in level.before if m is not message]
        earlier = [times(number(instance), Ref(f"{own}_C"))] if instance else []
        until = plus(window, Ref(f"{line}_Bit"))
        hit = level.lost(plus(window, Ref(f"{own}_C")))
        return plus(level.blocking, *earlier, *rivals(until, others), *hit)

    def busy(window: Expr) -> Expr:
        return plus(level.blocking, *rivals(window, level.before), *level.lost(window))

    words = f"[{message.element}] what can delay it: frames that go before it"
    if level.behind:
        words += ", and one of those that go behind it, the longest of which counts once"
    items: list[Decl] = [Comment(words)]
    items += _instances(own, message.element, claim, waiting, busy)
    responses = []
    for instance in range(len(claim.windows)):
        tail = _tail(claim, instance)
        response = plus(Ref(f"{own}_J"), Ref(f"{own}_W{tail}"), Ref(f"{own}_C"))
        responses.append(plus(response, *before(own, instance)))
    items += least(Ref(f"{own}_R"), responses, message.element, SLOW)
    items.append(refuse(Ref(f"{own}_R"), Ref(f"{own}_D"), message.element, "can miss its deadline"))
    items.append(assured(Ref(f"{own}_R"), Ref(f"{own}_D")))
    return items


def _tail(claim: Claim, instance: int) -> str:
    return "" if len(claim.windows) == 1 else f"_{instance + 1}"


def _instances(
    own: str,
    label: str,
    claim: Claim,
    waiting: Callable[[int, Expr], Expr],
    busy: Callable[[Expr], Expr],
    prefix: str = "",
) -> list[Decl]:
    """The windows of all instances, and the busy period in which there are no more."""
    items: list[Decl] = [stated(f"{own}_{prefix}Busy", claim.busy)]
    window: Expr = Ref(f"{own}_{prefix}Busy")
    items.append(named(f"{own}_{prefix}Busy_Needs", busy(window)))
    problem = "can keep others waiting for longer than claimed"
    items.append(refuse(ONE, window, label, problem))  # no time at all is a solution too
    items += least(window, [Ref(f"{own}_{prefix}Busy_Needs")], label, problem)
    late = Ref(f"{own}_J") if not prefix else Ref(f"{own}_{prefix}J")
    most = times(number(len(claim.windows)), Ref(f"{own}_T"))
    problem = "can come again before it is sent"
    items.append(refuse(plus(window, late), most, label, problem))
    for instance, length in enumerate(claim.windows):
        tail = _tail(claim, instance)
        at: Expr = Ref(f"{own}_{prefix}W{tail}")
        needs = f"{own}_{prefix}Needs{tail}"
        items.append(stated(f"{own}_{prefix}W{tail}", length))
        items.append(named(needs, waiting(instance, at)))
        items += bounded(Ref(needs), at, label)
    return items


def _turns(system: System, one: Reception, claim: Claim) -> list[Decl]:
    """When the reception, which keeps its least separation, has handed a message over."""
    here = one.message.bus, one.node
    processor = next(p for p in system.processors if (p.released_by, p.node) == here)
    separation, response = (Ref(f"{name_of(processor.name)}_{letter}") for letter in "TR")
    received = system.received(*here)
    own = name_of(one.element)

    def served(window: Expr, among: Iterable[Reception]) -> list[Expr]:
        return [
            times(
                ceiling(
                    plus(window, Ref(f"{name_of(r.driver)}_R")),
                    Ref(f"{name_of(r.message.element)}_T"),
                ),
                separation,
            )
            for r in among
        ]

    def waiting(instance: int, window: Expr) -> Expr:
        earlier = [times(number(instance), separation)] if instance else []
        others = [r for r in received if r != one]
        return plus(*earlier, *served(plus(window, number(1)), others))

    label = one.element
    words = f"[{label}] its turn in the queue of {processor.name}, and when it is handed over"
    items: list[Decl] = [Comment(words)]
    if one.several:
        items.append(named(f"{own}_T", Ref(f"{name_of(one.message.element)}_T")))
    items += [
        named(f"{own}_Turn_J", Ref(f"{name_of(one.driver)}_R")),
        *_instances(own, label, claim, waiting, lambda w: plus(*served(w, received)), "Turn_"),
        stated(f"{own}_Turn", claim.response),
    ]
    turns = []
    for instance in range(len(claim.windows)):
        late = plus(Ref(f"{own}_Turn_J"), Ref(f"{own}_Turn_W{_tail(claim, instance)}"))
        turns.append(plus(late, *before(own, instance)))
    items += least(Ref(f"{own}_Turn"), turns, label, SLOW)
    items.append(named(f"{own}_Handed", plus(Ref(f"{own}_Turn"), times(number(2), response))))
    return items
