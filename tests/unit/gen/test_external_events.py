# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Events from outside: `check` and `simulate` agree on which they are."""

from __future__ import annotations

import pytest

from ravenchart.commands.simulate import unexpected
from tests.support.behaviour_models import model, region, said
from tests.support.interpreted import stimuli_of

TAKER = region("Taker", "{A: {}, B: {}}", "hit: {from: A, to: B, on: Hit}")
CLOCK = region("Clock", "{A: {}}", "beat: {from: A, every: 1 s, guard: armed, %s}")
RAISES = CLOCK % "effect: [{raise: Hit}]"
FILE = "- {at: 1 ms, raise: one.Hit}\n- {until: 10 ms}\n"


@pytest.mark.parametrize(("form", "agreed"), [("{}", False), ("{external: true}", True)])
def test_event_that_the_component_raises_comes_from_outside_where_the_model_says_so(
    form: str, agreed: bool
) -> None:
    system = model(TAKER, RAISES, events=f"{{Go: {{}}, Stop: {{}}, Hit: {form}}}")
    found = said(system)
    assert any("B of Taker is never entered" in one for one in found) != agreed
    warned = [one.code for one in unexpected(system, stimuli_of(FILE, system))]
    assert warned == ([] if agreed else ["RV-1010"])
