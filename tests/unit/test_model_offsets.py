"""Offsets of models: whose they are, where they show, and what the certificate says of them."""

from __future__ import annotations

import io
import json
from pathlib import Path

import pytest
from rich.console import Console

from analysis.claims import claims_of, uncertified
from analysis.critical import schedule
from analysis.figures import figures
from analysis.findings import findings
from analysis.report import render
from analysis.table import show
from analysis.timing import Analysis
from ravenchart import steps
from tests.support.certificates import certificate, compiled
from tests.support.timing_models import HEAD, analysed

LOOPS = (
    HEAD.replace(
        "5 us, critical_section", "0 us, tick: {period: 100 us, wcet: 1 us}, critical_section"
    )
    + """\
processors:
  reception: {node: cpu, released_by: can0, period: 1 ms, stack: 32 KiB, activities: [can0.receive]}
  often: {node: cpu, stack: 32 KiB, priority: 2, activities: [f.ports, f.act]}
  seldom: {node: cpu, stack: 32 KiB, priority: 1, offset: 5 ms, activities: [s.act]}
components:
  Fast:
    ports: {i: {in: Word}}
    port_region: {period: 10 ms, wcet: 100 us}
    data: {n: {type: Word, initial: 0}}
    activities:
      act: {period: 10 ms, wcet: 2 ms, body: [{set: n, to: i}]}
  Slow:
    data: {n: {type: Word, initial: 0}}
    activities:
      act: {period: 20 ms, wcet: 1 ms, body: [{set: n, to: 1}]}
instances: {f: {component: Fast, node: cpu}, s: {component: Slow, node: cpu}}
messages: {m: {bus: can0, id: 0x110, to: f.i, period: 10 ms}}
"""
)

TOGETHER = (", offset: 5 ms", "")

TIGHT = ("priority: 1, offset", "priority: 1, deadline: 3 ms, offset")
"""Time enough only where often does not run before seldom."""


def bound(found: Analysis, task: str) -> int:
    known = found.response(task).bound
    assert known is not None
    return known


def test_only_periodic_processors_have_offsets() -> None:
    found = analysed(LOOPS)
    known = {task.name: task.offset for task in found.network.tasks if task.offset is not None}
    assert known == {"often": 0, "seldom": 5_000_000}


def test_a_processor_between_the_releases_of_another_does_not_wait_for_it() -> None:
    """2.1 ms less, and what interrupts them: both are late by up to a tick, and never meet."""
    apart, together = analysed(LOOPS), analysed(LOOPS, TOGETHER)
    assert 2_100_000 < bound(together, "seldom") - bound(apart, "seldom") < 2_500_000
    assert bound(together, "often") == bound(apart, "often")
    assert together.response("seldom").alignment is None
    assert apart.response("seldom").alignment is not None
    assert bound(apart.for_all_offsets, "seldom") == bound(together, "seldom")
    assert together.for_all_offsets is together


def test_it_is_said_which_responses_come_of_offsets() -> None:
    apart, together = analysed(LOOPS), analysed(LOOPS, TOGETHER)
    said = "By their offsets: R of seldom. All others hold for any offsets."
    assert said in render(apart)
    assert "Here it makes none shorter: every R holds for any offsets." in render(together)
    for found in (apart, together):
        out = io.StringIO()
        show(found, Console(file=out, width=100))
        assert (said in out.getvalue()) == (found is apart)
    tasks = json.loads(json.dumps(figures(apart)))["tasks"]
    assert [t["task"] for t in tasks if t["by_offsets"]] == ["seldom"]


def test_the_picture_of_a_critical_instant_is_as_long_as_its_window() -> None:
    for response in analysed(LOOPS).responses:
        slices = schedule(response)
        assert slices[-1].end == sum(s.end - s.start for s in slices) == response.window


def test_the_certificate_claims_responses_for_any_offsets(tmp_path: Path) -> None:
    apart, together = analysed(LOOPS), analysed(LOOPS, TOGETHER)
    assert list(uncertified(apart)) == []
    assert claims_of(apart).of("seldom").response == bound(together, "seldom")
    assert compiled(certificate(apart), tmp_path) == ""


def test_a_deadline_that_only_offsets_keep_is_met_and_not_generated(
    tmp_path: Path,
) -> None:
    tight = analysed(LOOPS, TIGHT)
    assert list(findings(tight)) == []
    (gap,) = uncertified(tight)
    assert gap.code == "RV-0804"
    assert "seldom needs over 3 ms: it may take" in gap.message
    assert gap.message.endswith("us but for offsets, which no certificate counts yet")
    model = tmp_path / "model.yaml"
    model.write_text(LOOPS.replace(*TIGHT))
    with pytest.raises(steps.Refused, match=r"seldom needs over 3 ms.*RV-0804"):
        steps.write_program(steps.check(model))
    assert list(uncertified(analysed(LOOPS, TOGETHER))) == []
