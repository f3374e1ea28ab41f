# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Offsets of models: whose they are, where they show, and what the certificate says of them."""

from __future__ import annotations

import io
import json
import random
import re
from dataclasses import replace
from pathlib import Path

import pytest
from rich.console import Console

from ravenchart.analysis.core.offsets import OffsetSearch
from ravenchart.analysis.findings import claims as analysis_claims
from ravenchart.analysis.findings.claims import by_offsets, claims_of, uncertified
from ravenchart.analysis.findings.deadlines import findings
from ravenchart.analysis.present.figures import figures
from ravenchart.analysis.present.report import render_report
from ravenchart.analysis.present.table import show
from ravenchart.analysis.system.critical import schedule
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.building import checking, generation
from ravenchart.failures import Refused
from ravenchart.gen.derive import instants
from ravenchart.gen.emit.ada.text import print_unit
from ravenchart.gen.emit.certificate import offsets as certificate_offsets
from ravenchart.gen.emit.certificate.package import emit_certificate
from ravenchart.gen.emit.nodes.deployment import emit_deployment
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.claims import Claims
from ravenchart.gen.model.system import System, Task
from tests.support.certificates import (
    certificate,
    changed,
    compiled,
    numbers,
    random_system,
)
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


@pytest.mark.slow
def test_it_is_said_which_responses_come_of_offsets() -> None:
    apart, together = analysed(LOOPS), analysed(LOOPS, TOGETHER)
    said = "By their offsets: R of seldom. All others hold for any offsets."
    assert said in render_report(apart)
    kept = "Here offsets make no response shorter: every R holds for any offsets."
    assert kept in render_report(together)
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


def test_a_deadline_that_only_offsets_keep_is_certified_by_them(tmp_path: Path) -> None:
    """1137 us from the only instant that matters: its own release, a tick late."""
    tight = analysed(LOOPS, TIGHT)
    assert list(findings(tight)) == list(uncertified(tight)) == []
    claims = claims_of(tight)
    assert claims.of("seldom").since == (bound(tight, "seldom") - 100_000,)
    assert claims.of("seldom").response == bound(analysed(LOOPS, TOGETHER), "seldom")
    text = certificate(tight)
    assert compiled(text, tmp_path) == ""
    written = "".join(map(print_unit, emit_deployment(tight.system, "")))
    assert re.findall(r"Offset +=> (.*?)[,)]", written) == [
        "Timing_Certificate.Often_O",
        "Timing_Certificate.Seldom_O",
    ]
    for name in ("Seldom_W_At_1", "Seldom_Reach"):
        assert re.search("seldom (can|claims)", compiled(changed(text, name, -1), tmp_path))
    for name, late in (("Often_O", 5_000_000), ("Seldom_O", -5_000_000), ("Cpu_Tick_C", 100_000)):
        assert re.search("seldom (can|claims)", compiled(changed(text, name, late), tmp_path))
    none = {**claims.items, "seldom": replace(claims.of("seldom"), since=(Ns(1),))}
    hostile = emit_certificate(tight.system, replace(claims, items=none), "")
    assert "seldom claims a wrong response time" in compiled(print_unit(hostile), tmp_path)


def test_a_certificate_with_an_instant_left_out_does_not_compile(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nor one of other offsets that make such an instant: often, late, at the release of seldom."""
    tight = analysed(LOOPS, TIGHT)
    text = certificate(tight)
    for name, by in (
        ("Often_O", 4_900_000),
        ("Seldom_At_1", -20_000_000),
        ("Seldom_At_1", -1),
        ("Seldom_Cycle", 20_000_000),
        ("Seldom_Cycle", -10_000_000),
    ):
        assert "seldom can be late from an instant that is not listed" in compiled(
            changed(text, name, by), tmp_path
        )
    assert compiled(changed(text, "Often_O", 3_000_000), tmp_path) == ""
    monkeypatch.setattr(certificate_offsets, "instants", lambda *_: ())
    assert "seldom can miss its deadline" in compiled(certificate(tight), tmp_path)


def test_what_the_certificate_cannot_show_is_not_generated(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    tight = analysed(LOOPS, TIGHT)
    monkeypatch.setattr(analysis_claims, "MOST_INSTANTS", 0)
    (gap,) = uncertified(tight)
    assert gap.code == "RV-0804"
    assert "seldom misses its deadline: R = " in gap.message
    assert gap.message.endswith("; the certificate cannot show offsets here yet")
    model = tmp_path / "model.yaml"
    model.write_text(LOOPS.replace(*TIGHT))
    with pytest.raises(Refused, match=r"seldom misses its deadline.*RV-0804"):
        generation.write_program(checking.check(model))
    assert list(uncertified(analysed(LOOPS, TOGETHER))) == []


def phased_system(seed: int) -> System:
    """A random system with offsets, and deadlines as short as these allow."""
    draw = random.Random(seed)
    plain = random_system(seed)
    processors = tuple(
        replace(one, offset=Ns(draw.randrange(0, one.period, 100_000)))
        if one.released_by is None
        else one
        for one in plain.processors
    )
    offsets = {one.name: one.offset for one in processors}
    tasks = tuple(
        replace(task, offset=offsets.get(task.element, task.offset)) for task in plain.tasks
    )
    whole = replace(plain, processors=processors, tasks=tasks)
    found = analyse(whole)
    least = {r.task.name: r.bound for r in found.responses if r.alignment is not None}
    short = tuple(
        replace(task, deadline=Ns(min(task.period, least.get(task.element) or task.deadline)))
        if task.element in offsets
        else task
        for task in whole.tasks
    )
    return replace(whole, tasks=short)


def shorter(whole: System, names: list[str]) -> System:
    """These deadlines a nanosecond shorter: no instant is left out that then is too late."""
    tasks = (
        replace(task, deadline=Ns(task.deadline - 1)) if task.element in names else task
        for task in whole.tasks
    )
    return replace(whole, tasks=tuple(tasks))


def test_analysis_and_certificate_find_the_same_instants(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each by itself: in order, with the time from an instant to the next arrival of the task."""
    told: list[tuple[str, int, list[tuple[int, int]], int]] = []
    followed = OffsetSearch.followed

    def noted(self: OffsetSearch, reach: int) -> list[tuple[int, int]]:
        found = followed(self, reach)
        told.append((self.plain.task.name, reach, found, self.interference.cycle))
        return found

    monkeypatch.setattr(OffsetSearch, "followed", noted)
    compared = 0
    for seed in range(40):
        system = phased_system(seed)
        told.clear()
        by_offsets(analyse(system))
        for name, reach, found, cycle in told:
            (task,) = (one for one in system.tasks if one.element == name)
            listed = instants.instants(system, task, reach) or ()
            due = [task.offset + one.release * task.period for one in listed]
            assert found == [
                (one.time % cycle, at - one.time) for one, at in zip(listed, due, strict=True)
            ]
            compared += len(found)
    assert compared > 50


@pytest.mark.slow
def test_certificates_of_random_systems_hold_by_their_offsets(tmp_path: Path) -> None:
    """What they claim is exact: a nanosecond less of a window, or to the deadline, is refused."""
    shown = fewer = 0
    for seed in range(300):
        found = analyse(phased_system(seed))
        gaps = list(uncertified(found))
        if not found.schedulable or gaps:
            continue
        claims = claims_of(found)
        since = [name for name, claim in claims.items.items() if claim.since]
        if not since:
            continue
        text = certificate(found)
        assert compiled(text, tmp_path) == "", seed
        windows = numbers(text, r"_W_At_\d+")
        assert windows, seed
        one = windows[seed % len(windows)]
        assert "claims a wrong response time" in compiled(changed(text, one, -1), tmp_path)
        assert not set(since) & set(by_offsets(analyse(shorter(found.system, since))))
        fewer += _less_one_is_refused(found, claims, tmp_path)
        shown += 1
        if shown == 12:
            break
    assert shown == 12
    assert fewer


def _less_one_is_refused(found: Analysis, claims: Claims, folder: Path) -> bool:
    """Of a processor with several instants, each in turn left out; whether there is one."""
    name, claim = max(claims.items.items(), key=lambda item: len(item[1].since))
    count = len(claim.since)
    for left in range(count) if count > 1 else ():
        kept = [place for place in range(count) if place != left]
        items = {name: replace(claim, since=tuple(claim.since[place] for place in kept))}

        def some(system: System, task: Task, reach: int) -> tuple[instants.Instant, ...]:
            whole = instants.instants(system, task, reach) or ()
            return tuple(whole[p] for p in kept) if task.element == name else whole  # noqa: B023

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(certificate_offsets, "instants", some)
            less = emit_certificate(
                found.system, replace(claims, items={**claims.items, **items}), ""
            )
        assert "from an instant that is not listed" in compiled(print_unit(less), folder)
    return count > 1
