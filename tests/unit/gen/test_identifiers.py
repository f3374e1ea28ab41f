# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Identifiers that the model does not give, beside those that it gives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import accumulate, permutations
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ravenchart.analysis.core import can
from ravenchart.analysis.core.assignment import audsley_frames
from ravenchart.analysis.core.bus import Bus, Frame
from ravenchart.analysis.system.identifiers import IdentifierPlaces
from ravenchart.analysis.system.timing import Verdict, analyse
from ravenchart.building.checking import check, with_good_identifiers
from ravenchart.failures import Refused
from ravenchart.gen.diagnostics import Diagnostic
from ravenchart.gen.model.system import System
from tests.support.pump import changed, codes, loaded, system_of


def identifiers(*replacements: tuple[str, str]) -> dict[str, int]:
    return {m.name: m.identifier for m in system_of(*replacements).frames}


def test_the_shorter_deadline_has_the_lower_identifier() -> None:
    without = (("id: 0x100, ", ""), ("id: 0x101, ", ""))
    assert identifiers(*without) == {"level_in": 1, "valve_out": 2}
    urgent = ("id: 0x101, from: north.valve", "from: north.valve, deadline: 5 ms")
    assert identifiers(("id: 0x100, ", ""), urgent) == {"level_in": 2, "valve_out": 1}


def test_given_identifiers_are_kept_and_stepped_over() -> None:
    assert identifiers(("id: 0x100, ", ""), ("id: 0x101, ", "id: 1, ")) == {
        "level_in": 2,
        "valve_out": 1,
    }


def test_extended_identifiers_keep_the_order_among_standard_ones() -> None:
    found = identifiers(("id: 0x100, ", "extended: true, "), ("id: 0x101, ", ""))
    assert found == {"level_in": 1 << 18, "valve_out": 2}


@pytest.mark.parametrize(("key", "code"), [("", "RV-0202"), ("id: -1, ", "RV-0204")])
def test_what_others_send_must_be_given(key: str, code: str) -> None:
    line = f"  other: {{bus: can_bus, {key}bytes: 1, period: 5 ms}}\n  valve_out"
    assert codes(("  valve_out", line)) == [code]


# --- By Audsley's assignment -----------------------------------------------------------

PORT = "      level: {in: Level, max_age: 100 ms, on_stale: Lost}\n"
PORTS = "".join(PORT.replace("level", name, 1) for name in ("a", "b", "c"))
TELL = (
    "\n    activities:\n      tell:\n        period: 20 ms\n        wcet: 30 us\n        body:\n"
    "          - {send: valve, with: {mode: wanted, level: level}}\n"
)
SLOW = "bit_rate: 125 kbit/s, identifiers: audsley"


def received(name: str, size: int, period: str, given: str = "", deadline: str = "") -> str:
    return (
        f"  {name}: {{bus: can_bus, {given}to: north.{name}, bytes: {size}, period: {period}"
        f"{deadline}}}\n"
    )


def model(*messages: str, bus: str = SLOW) -> str:
    """Three messages that others send here, as the reference case `can-opa-small` has them."""
    old = "  level_in: {bus: can_bus, id: 0x100, to: north.level, period: 10 ms}\n"
    out = "  valve_out: {bus: can_bus, id: 0x101, from: north.valve}\n"
    return changed(
        (PORT, PORTS),
        ("      valve: {out: Report}\n", ""),
        ("  Report: {fields: {mode: Mode, level: Level}}\n", ""),
        ("level < limit", "a < limit"),
        ("level >= limit", "b + c >= limit"),
        (TELL, ""),
        (", north.tell", ""),
        (old + out, "".join(messages)),
        ("bit_rate: 500 kbit/s", bus),
        ("context_switch: 5 us", "context_switch: 0 us"),
    )


def assigned(*messages: str, bus: str = SLOW) -> tuple[System, tuple[Diagnostic, ...]]:
    system = loaded(model(*messages, bus=bus)).system
    assert system is not None
    return with_good_identifiers(system)


A = received("a", 7, "2 ms")
B = received("b", 2, "4 ms", deadline=", deadline: 3800 us")
C = received("c", 7, "3 ms")


def order(system: System) -> str:
    return " ".join(m.name for m in sorted(system.frames, key=lambda m: m.identifier))


def frames_met(system: System) -> bool:
    """All of these deadlines are met on the bus, as the analysis of the whole has it."""
    found = analyse(system)
    return all(found.verdict(m.element) is Verdict.MET for m in system.frames)


def test_an_order_is_found_where_that_by_deadline_fails() -> None:
    by_deadline, found = assigned(A, B, C, bus="bit_rate: 125 kbit/s")
    assert (order(by_deadline), found, frames_met(by_deadline)) == ("a c b", (), False)
    system, found = assigned(A, B, C)
    assert (order(system), found, frames_met(system)) == ("a b c", (), True)
    assert [m.identifier for m in system.messages] == [1, 2, 3]


def test_without_need_it_is_that_by_deadline_and_then_of_the_model() -> None:
    fast = "bit_rate: 500 kbit/s, identifiers: audsley"
    equal = received("c", 7, "2 ms")
    assert order(assigned(A, B, C, bus=fast)[0]) == "a c b"
    assert order(assigned(B, A, equal, bus=fast)[0]) == "a c b"
    assert order(assigned(equal, B, A, bus=fast)[0]) == "c a b"
    slow = received("c", 7, "30 ms", "id: 0x10, ")
    assert [m.identifier for m in assigned(A, B, slow, bus=fast)[0].messages] == [1, 2, 0x10]


@pytest.mark.parametrize(
    ("a", "c", "expected"),
    [
        ("", "id: 0x10, ", {"a": 1, "b": 2, "c": 0x10}),
        ("", "id: 3, ", {"a": 1, "b": 2, "c": 3}),
        ("id: 0, ", "", {"a": 0, "b": 1, "c": 2}),
        ("id: 0x20, ", "id: 0x22, ", {"a": 0x20, "b": 0x21, "c": 0x22}),
        ("id: 0x7FD, ", "", {"a": 0x7FD, "b": 0x7FE, "c": 0x7FF}),
    ],
)
def test_the_others_go_around_given_identifiers(a: str, c: str, expected: dict[str, int]) -> None:
    system, found = assigned(received("a", 7, "2 ms", a), B, received("c", 7, "3 ms", c))
    assert (found, {m.name: m.identifier for m in system.messages}) == ((), expected)
    assert frames_met(system)


def test_nothing_goes_between_neighbours() -> None:
    """There b would meet its deadline, but behind both of them c goes before it twice."""
    a = received("a", 2, "2 ms", "id: 0x20, ")
    b = received("b", 2, "4 ms", deadline=", deadline: 700 us")
    c = received("c", 7, "380 us", "id: 0x21, ", ", deadline: 2 ms")
    system, found = assigned(a, b, c, bus="bit_rate: 500 kbit/s, identifiers: audsley")
    assert found == ()
    assert [m.identifier for m in system.messages] == [0x20, 1, 0x21]


def test_where_there_is_no_room_above_a_given_identifier_there_is_no_order() -> None:
    system, (found,) = assigned(A, B, received("c", 7, "3 ms", "id: 2, "))
    assert found.code == "RV-0908"
    assert found.hint is not None and "leave out the `id` of c" in found.hint
    assert {m.name: m.identifier for m in system.messages} == {"a": 1, "b": 3, "c": 2}


def test_what_cannot_be_ordered_says_why() -> None:
    tight = received("b", 2, "4 ms", deadline=", deadline: 2 ms")
    system, (found,) = assigned(A, tight, C)
    assert order(system) == "a b c", "as by deadline"
    assert (found.code, found.origin.line) == ("RV-0908", 46)
    assert found.message == (
        "no order of identifiers found that meets all deadlines of can_bus: b cannot have the "
        "lowest place that is left: there it has R = 3.6 ms > D = 2 ms"
    )
    assert [text for _, text in found.notes] == [
        "1 message would go before b, 1 after it",
        "c may block b for 1 ms",
        "a has R = 2.6 ms > D = 2 ms",
    ]
    assert found.hint == "lengthen a `deadline:` or period of these, or raise the bit rate"


def test_a_model_without_an_order_is_refused_for_that_alone(tmp_path: Path) -> None:
    path = tmp_path / "model.yaml"
    tight = received("b", 2, "4 ms", deadline=", deadline: 2 ms")
    path.write_text(model(A, tight, C))
    with pytest.raises(Refused) as refused:
        check(path)
    assert "[RV-0908]" in str(refused.value)
    assert "RV-0901" not in str(refused.value)
    assert not check(path, deadlines=False).analysis.schedulable


def test_what_leaves_in_the_order_sent_is_helped_by_no_identifier() -> None:
    urgent = ("id: 0x101, from: north.valve", "from: north.valve, deadline: 200 us")
    audsley = ("bit_rate: 500 kbit/s", "bit_rate: 500 kbit/s, identifiers: audsley")
    _, (found,) = with_good_identifiers(system_of(("id: 0x100, ", ""), urgent, audsley))
    assert "valve_out cannot have" in found.message
    assert [text for _, text in found.notes] == [
        "no identifier helps valve_out: its node sends in order, behind all others"
    ]


@settings(max_examples=150, deadline=None)
@given(st.data())
def test_an_order_beside_given_identifiers_is_found_exactly_when_there_is_one(
    data: st.DataObject,
) -> None:
    """Where between given identifiers there is room for all others, or for none."""
    steps = data.draw(st.lists(st.sampled_from([1, 16]), min_size=1, max_size=2))
    given_ranks = [place << 20 for place in accumulate(steps)]
    frames = [
        Frame(
            name,
            given_ranks[n] if n < len(given_ranks) else 0x7FF << 20 | n,
            data.draw(st.integers(10, 20)),
            data.draw(st.integers(5, 24)),
            data.draw(st.integers(1, 5)),
        )
        for n, name in enumerate("abcd")
    ]
    fixed = "abcd"[: len(given_ranks)]
    bus = Bus(1)

    def possible(names: Sequence[str]) -> bool:
        """The given ones are in order, and none goes between two that are neighbours."""
        if [name for name in names if name in fixed] != list(fixed):
            return False
        before = 0
        for step, name in zip(steps, fixed, strict=True):
            place = names.index(name)
            if step == 1 and place > before:
                return False
            before = place + 1
        return True

    def good(order: Sequence[str]) -> bool:
        named = {frame.name: frame for frame in frames}
        ranked = [replace(named[name], rank=n) for n, name in enumerate(order)]
        return all(r.met for r in can.analyse(ranked, bus))

    places = IdentifierPlaces(tuple("abcd"), frozenset(fixed))
    found = audsley_frames(frames, bus, places.candidates)
    some = any(possible(order) and good(order) for order in permutations("abcd"))
    assert found.complete == some
    assert not some or (possible(found.names) and good(found.names))
