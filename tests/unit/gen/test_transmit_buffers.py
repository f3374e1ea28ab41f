# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The transmit buffers of a controller: first in, first out, or by priority as the bus declares."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.analysis.findings.claims import claims_of
from ravenchart.analysis.system.timing import analyse
from ravenchart.building import checking, programs, targets
from ravenchart.failures import Refused
from ravenchart.gen.diagnostics import render
from ravenchart.gen.emit.program import generate
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


@pytest.fixture
def by_priority(tmp_path: Path) -> Path:
    """A model whose bus has transmit buffers by priority; each node sends three messages."""
    model = tmp_path / "model.yaml"
    model.write_text(MODEL.read_text().replace(*PRIORITY))
    return model


@pytest.mark.parametrize("driver", ["slcan", "socketcan", "xilinx"])
def test_a_driver_without_buffers_by_priority_is_refused(driver: str, by_priority: Path) -> None:
    checked = checking.check(by_priority)
    with pytest.raises(Refused, match=f"the driver {driver} sends frames in the order") as refused:
        programs.check_driver(checked, driver)
    assert "take one of loopback, bus, ctucanfd, or write `buffers: fifo`" in str(refused.value)
    programs.check_driver(checked, "bus")
    assert programs.default_driver(checked) == "bus"


def test_the_hint_names_the_drivers_of_the_target(by_priority: Path) -> None:
    with pytest.raises(Refused, match="hint: take one of loopback, or write"):
        programs.check_driver(checking.check(by_priority), "xilinx", targets.target("zynqmp"))


def test_a_driver_needs_a_buffer_for_each_message_of_a_node(
    by_priority: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    checked = checking.check(by_priority)
    programs.check_driver(checked, "ctucanfd")
    monkeypatch.setitem(programs.BY_PRIORITY, "ctucanfd", 2)
    with pytest.raises(Refused) as refused:
        programs.check_driver(checked, "ctucanfd")
    assert str(refused.value) == (
        "ravenchart: error: panel sends 3 messages on link, which has `buffers: priority`, but "
        "the driver ctucanfd has 2 transmit buffers\n"
        "  hint: take another driver, send at most 2 messages, or write `buffers: fifo`"
    )
    monkeypatch.setitem(programs.BY_PRIORITY, "ctucanfd", 3)
    programs.check_driver(checked, "ctucanfd")


def test_the_main_program_sets_the_order_first() -> None:
    order = "Ravenchart.Can.Transmit_Orders.Set_By_Priority (1);\n   Ravenchart.Hosts.Start;"
    for replacements, wanted in (((PRIORITY,), True), ((), False)):
        files = generate(system_of(*replacements), claims_of(analyse(system_of(*replacements))))
        mains = [text for name, text in files.items() if str(name).endswith("_main.adb")]
        assert len(mains) == 2
        assert all((order in text) == wanted for text in mains)
        assert wanted == any("Transmit_Orders" in text for text in files.values())
