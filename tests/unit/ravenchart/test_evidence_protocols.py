# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""That a client follows a protocol is a claim of the evidence, apart from those of its chart."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.evidence import facts
from ravenchart.evidence.claims import claims
from tests.support.protocol_model import door

CALLED = (
    "body: [{set: seen, to: Get_Opening}]",
    "body: [{set: seen, to: Get_Opening}, {call: Disable}]",
)


@pytest.mark.parametrize(
    ("changes", "verdict", "reason"),
    [
        ((), "met", None),
        ((CALLED,), "not met", "Sequence and note both call, and their order is not fixed"),
    ],
)
def test_a_protocol_is_a_claim_of_its_own(
    tmp_path: Path, changes: tuple[tuple[str, str], ...], verdict: str, reason: str | None
) -> None:
    (tmp_path / "model.yaml").write_text(door(*changes), encoding="utf-8")
    found = {one.id: one for one in claims(facts.gather(tmp_path / "model.yaml", None, [], None))}
    claim = found["protocol-Door.drive_1.Motion"]
    assert claim.verdict.value == verdict
    assert claim.elements == ("door_1",)
    assert (reason is None) == (claim.reasons == ())
    assert reason is None or reason in claim.reasons[0]
    assert found["behaviour-rules"].verdict.value == "met"
