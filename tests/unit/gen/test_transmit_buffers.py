# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The transmit buffers of a controller: first in, first out, or by priority as the bus declares."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.analysis.system.timing import analyse
from ravenchart.building import checking, programs
from ravenchart.failures import Refused
from ravenchart.gen.diagnostics import render
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import Loaded, load
from ravenchart.paths import ROOT
from tests.support.pump import PUMP
from tests.support.pump import loaded as pump

MODEL = ROOT / "tests" / "nodes" / "commands" / "model.yaml"
LINK = "receive_depth: 8, transmit_depth: 8}"
PRIORITY = (LINK, LINK.replace("}", ", buffers: priority}"))


def loaded(*replacements: tuple[str, str]) -> Loaded:
    """A model whose nodes send several messages, with text of it replaced."""
    text = MODEL.read_text()
    for old, new in replacements:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return load(MODEL, lambda path, most: text.encode())


def system_of(*replacements: tuple[str, str]) -> System:
    """Its system, which must be there."""
    found = loaded(*replacements)
    assert found.system is not None, said(found)
    return found.system


def said(found: Loaded) -> str:
    """Its errors, as they are printed."""
    return "\n".join(render(one, found.sources) for one in found.diagnostics)


def responses(system: System) -> list[tuple[int, int]]:
    """Cost and bound of each message, most urgent first."""
    found = analyse(system)
    frames = found.frames(system.buses[0])
    assert all(one.bound is not None for one in frames)
    return [(one.frame.transmission_time, one.bound or 0) for one in frames]


def test_by_priority_the_most_urgent_frame_waits_for_one_other_at_most() -> None:
    system = system_of(PRIORITY)
    found = responses(system)
    queued = responses(system_of())
    frames = analyse(system).frames(system.buses[0])
    assert len(found) > 4
    first = frames[0]
    longest = max(cost for cost, _ in found[1:])
    assert found[0][1] == first.frame.jitter + longest + found[0][0]
    assert all(mine <= theirs for (_, mine), (_, theirs) in zip(found, queued, strict=True))
    assert found[0][1] < queued[0][1]


def test_a_buffer_for_each_message_is_needed() -> None:
    few = (LINK, LINK.replace("depth: 8}", "depth: 1, buffers: priority}"))
    text = said(loaded(few))
    assert "transmit buffers by priority [RV-0617]" in text
    assert "panel sends" in text
    many = (LINK, LINK.replace("depth: 8}", "depth: 9, buffers: priority}"))
    assert "link has 9 transmit buffers by priority; a controller has at most 8" in said(
        loaded(many)
    )


def test_a_message_must_be_gone_before_it_comes_again() -> None:
    slow = PUMP.replace("from: north.valve", "from: north.valve, deadline: 1 s")
    assert pump(slow).system is not None
    text = said(pump(slow.replace("transmit_depth: 8", "transmit_depth: 8, buffers: priority")))
    assert "valve_out may take longer than its period, so two of it may wait" in text
    assert "give it a deadline of 20 ms or less" in text


@pytest.mark.parametrize("driver", ["slcan", "socketcan", "ctucanfd"])
def test_a_driver_without_buffers_by_priority_is_refused(driver: str, tmp_path: Path) -> None:
    model = tmp_path / "model.yaml"
    model.write_text(MODEL.read_text().replace(*PRIORITY))
    checked = checking.check(model)
    with pytest.raises(Refused, match=f"the driver {driver} sends frames in the order"):
        programs.check_driver(checked, driver)
    programs.check_driver(checked, "bus")
    assert programs.default_driver(checked) == "bus"
