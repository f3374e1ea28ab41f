# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The chart fragments of docs/semantics.md do what the page says."""

from __future__ import annotations

import re
import textwrap
from itertools import groupby

import pytest

from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.behaviour.interpreter.stimuli import read
from ravenchart.paths import ROOT
from tests.support.pump import loaded

PAGE = (ROOT / "docs" / "semantics.md").read_text()
FRAGMENTS: list[tuple[str, str]] = re.findall(
    r"```yaml\n(initial:.*?)```\n\n```text\n(.*?)```", PAGE, re.S
)

MODEL = """\
system: Fragment
types: {{Number: {{range: [0, 9]}}}}
components:
  Unit:
    events: [{events}]
    data: {{x: {{type: Number, initial: 0}}}}
    regions:
      Chart:
        period: 10 ms
        wcet: 1 ms
        queue: 4
{deferred}{region}
nodes: {{board: {{context_switch: 1 us, critical_section: 1 us}}}}
instances: {{one: {{component: Unit, node: board}}}}
processors: {{runner: {{node: board, stack: 16 KiB, activities: [one.Chart]}}}}
"""
APART = 100
"""Milliseconds from one event to the next: time for all that it brings about."""


def _done(chart: str, events: list[str]) -> list[str]:
    """What the chart does: one line for each step, as the page writes it."""
    text = MODEL.format(
        events=", ".join(dict.fromkeys(events)),
        deferred="        deferred: 2\n" if "defer:" in chart else "",
        region=textwrap.indent(chart, " " * 8),
    )
    result = loaded(text)
    assert result.system is not None, [str(one) for one in result.diagnostics]
    entries = [f"- {{at: {APART * n} ms, raise: one.{e}}}" for n, e in enumerate(events, 1)]
    entries.append(f"- {{until: {APART * (len(events) + 1) - 1} ms}}")
    stimuli, found = read("\n".join(entries), "events.yaml", result.system)
    assert stimuli is not None, [str(one) for one in found]
    steps: dict[int, list[str]] = {}
    for index, records in groupby(
        Machine(result.system).run(stimuli), lambda one: one.at // (APART * 1_000_000)
    ):
        steps[index] = [", ".join(record.behaviours) for record in records]
    lines = []
    for index, event in enumerate(["start", *events]):
        labels = [event, *["then"] * 99]
        lines += [
            f"{label}: {step}".rstrip()
            for label, step in zip(labels, steps.get(index, [""]), strict=False)
        ]
    return lines


def test_the_page_has_fragments() -> None:
    assert len(FRAGMENTS) == PAGE.count("```yaml\ninitial:")


@pytest.mark.parametrize(("chart", "expected"), FRAGMENTS)
def test_the_fragment_does_what_the_page_says(chart: str, expected: str) -> None:
    lines = expected.splitlines()
    labels = [line.split(":")[0] for line in lines]
    assert _done(chart, [one for one in labels if one not in ("start", "then")]) == lines
