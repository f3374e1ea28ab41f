# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Claims that the analysis never makes: the certificate refuses them all the same."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from ravenchart.analysis.findings.claims import claims_of
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.building import checking
from ravenchart.gen.emit.ada.text import print_unit
from ravenchart.gen.emit.certificate.package import emit_certificate
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.claims import ChainClaim, Claims, ResponseClaim
from ravenchart.gen.model.system import System
from ravenchart.paths import ROOT
from tests.support.certificates import certificate, changed, compiled, numbers
from tests.support.systems import bus, message, system, task
from tests.support.timing_models import CHART, KEPT, QUEUE, SEVERAL, analysed

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
    short = ResponseClaim(Ns(3 * FRAME), (Ns(2 * FRAME),), Ns(0))
    said = compiled(claimed(one, replace(claims, items={**claims.items, "bus.c": short})), tmp_path)
    assert "bus.c claims a wrong busy period" in said


def test_negative_times_hold_no_demand(tmp_path: Path) -> None:
    """Two messages of 60 % each: Ada's quotients of negative numbers would let them pass."""
    one = of_messages(received("a", 1, 450_000, 900_000), received("b", 2, 450_000, 900_000))
    found = ResponseClaim(Ns(2 * FRAME), (Ns(FRAME),), Ns(-(10**9)))
    claims = Claims(
        {"t": ResponseClaim(Ns(100_000), (Ns(100_000),)), "bus.a": found, "bus.b": found}
    )
    assert "bus.b claims a wrong busy period" in compiled(claimed(one, claims), tmp_path)


def test_tasks_of_one_priority_cannot_claim_less_than_no_time(tmp_path: Path) -> None:
    """Three of 60 % each: to each of them the others are more than all of the time."""
    one = system([task(name, 1, 600, 1_000) for name in ("a", "b", "c")])
    none = ResponseClaim(Ns(-(10**6)), (Ns(-(10**6)),))
    said = compiled(claimed(one, Claims(dict.fromkeys(("a", "b", "c"), none))), tmp_path)
    assert "a claims a wrong response time" in said


# --- Chains: the model says what a claim is about ---------------------------------------


@pytest.fixture(scope="module")
def robot() -> Analysis:
    return checking.check(ROOT / "examples" / "cartesian_robot" / "model.yaml").analysis


def test_a_chain_that_is_not_claimed_is_refused(robot: Analysis, tmp_path: Path) -> None:
    claims = claims_of(robot)
    said = compiled(claimed(robot, replace(claims, chains={})), tmp_path, "Cartesian_Robot")
    for chain in robot.system.chains:
        assert f"chain {chain.name} claims a wrong reaction" in said
        assert f"chain {chain.name} claims a wrong age" in said
    short = ChainClaim(Ns(500_000), Ns(500_000))
    text = claimed(robot, replace(claims, chains={**claims.chains, "status": short}))
    said = compiled(text, tmp_path, "Cartesian_Robot")
    assert "chain status claims a wrong reaction" in said
    assert "x_loop" not in said


def test_rows_and_deliveries_of_chains_are_claimed_or_refused(
    robot: Analysis, tmp_path: Path
) -> None:
    text = claimed(robot, replace(claims_of(robot), rows={}, turns={}))
    said = compiled(text, tmp_path, "Cartesian_Robot")
    assert "joint_x.position_control claims a wrong response time" in said
    assert "reception claims a wrong busy period" in said


def test_waits_in_queues_are_exact(tmp_path: Path) -> None:
    found = analysed(QUEUE)
    text = certificate(found)
    assert compiled(text, tmp_path) == ""
    made = [n for end in ("_Reaction", "_Age", r"_Wait_\d+") for n in numbers(text, end)]
    assert len(made) == 3
    for one in made:
        assert "chain cmd claims a wrong" in compiled(changed(text, one, -1), tmp_path)


@pytest.mark.parametrize(
    ("model", "problem"),
    [
        (CHART, "chain stop can have any reaction: brk.Main"),
        (SEVERAL, "chain cmd can have any reaction: d.ports"),
        (QUEUE.replace("period: 100 ms", "period: 5 ms"), "chain cmd can fill a queue"),
        (KEPT, "chain cmd can have any age: d.look"),
    ],
)
def test_what_has_no_bound_cannot_be_claimed(model: str, problem: str, tmp_path: Path) -> None:
    found = analysed(model)
    claims = claims_of(found)
    long = ChainClaim(Ns(10**8), Ns(10**8), (Ns(10**8),))
    chains = {chain.name: long for chain in found.system.chains}
    assert problem in compiled(claimed(found, replace(claims, chains=chains)), tmp_path)


# --- End-to-end protection: how surely and how soon ---------------------------------------


@pytest.mark.slow
def test_residual_errors_and_detection_times_are_exact(tmp_path: Path) -> None:
    found = checking.check(ROOT / "tests" / "feature" / "protected" / "model.yaml").analysis
    text = certificate(found)
    assert compiled(text, tmp_path, found.system.name) == ""
    names = [*numbers(text, "_Residual"), *numbers(text, "_Stale")]
    assert len(names) == len(found.system.messages) + 1
    for name in names:
        what = "residual error" if name.endswith("_Residual") else "time until it is stale"
        for by in (-1, 1):
            said = compiled(changed(text, name, by), tmp_path, found.system.name)
            assert f"claims a wrong {what}" in said


def test_residual_errors_and_detection_times_that_are_not_claimed_are_refused(
    tmp_path: Path,
) -> None:
    found = checking.check(ROOT / "tests" / "feature" / "protected" / "model.yaml").analysis
    claims = replace(claims_of(found), residual={}, stale={})
    said = compiled(claimed(found, claims), tmp_path, found.system.name)
    assert said.count("claims a wrong residual error") == len(found.system.messages)
    assert said.count("claims a wrong time until it is stale") == 1
