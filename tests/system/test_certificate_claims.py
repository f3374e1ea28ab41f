"""Claims that the analysis never makes: the certificate refuses them all the same."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from analysis.claims import claims_of
from analysis.timing import Analysis, analyse
from gen.claims import Claim, Claims
from gen.emit.ada_text import print_unit
from gen.emit.certificate import emit_certificate
from gen.model import Message, System
from gen.terms import Ns
from tests.support.certificates import compiled
from tests.support.systems import bus, message, system, task

FRAME = 270_000
"""Eight bytes at 500 kbit/s, in ns."""


def claimed(found: Analysis | System, claims: Claims) -> str:
    """The certificate that makes these claims."""
    one = found.system if isinstance(found, Analysis) else found
    return print_unit(emit_certificate(one, claims, ""))


def received(name: str, identifier: int, period: int, deadline: int) -> Message:
    return replace(message(name, identifier, period=period), deadline=Ns(deadline))


def of_messages(*messages: Message) -> System:
    return system([task("t", 1, 100_000, 10_000_000)], (), [bus()], messages)


def test_a_busy_period_of_no_time_hides_no_instance(tmp_path: Path) -> None:
    """Davis et al. 2007: the second instance of the third message is the one that is late."""
    rest = (FRAME * 7 // 2, FRAME * 13 // 4)
    one = of_messages(
        received("a", 1, FRAME * 5 // 2, FRAME * 5 // 2),
        received("b", 2, FRAME * 7 // 2, FRAME * 7 // 2),
        received("c", 3, *rest),
    )
    claims = claims_of(analyse(one))
    short = Claim(Ns(3 * FRAME), (Ns(2 * FRAME),), Ns(0))
    said = compiled(claimed(one, replace(claims, items={**claims.items, "bus.c": short})), tmp_path)
    assert "bus.c can keep others waiting for longer than claimed" in said


def test_negative_times_hold_no_demand(tmp_path: Path) -> None:
    """Two messages of 60 % each: Ada's quotients of negative numbers would let them pass."""
    one = of_messages(received("a", 1, 450_000, 900_000), received("b", 2, 450_000, 900_000))
    found = Claim(Ns(2 * FRAME), (Ns(FRAME),), Ns(-(10**9)))
    claims = Claims({"t": Claim(Ns(100_000), (Ns(100_000),)), "bus.a": found, "bus.b": found})
    assert "bus.b can keep others waiting" in compiled(claimed(one, claims), tmp_path)


def test_tasks_of_one_priority_cannot_claim_less_than_no_time(tmp_path: Path) -> None:
    """Three of 60 % each: to each of them the others are more than all of the time."""
    one = system([task(name, 1, 600, 1_000) for name in ("a", "b", "c")])
    none = Claim(Ns(-(10**6)), (Ns(-(10**6)),))
    said = compiled(claimed(one, Claims(dict.fromkeys(("a", "b", "c"), none))), tmp_path)
    assert "a can take longer than its claimed response time" in said
