# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The report of a program has the fill of each queue of events, and of no other queue."""

from __future__ import annotations

import re

import pytest

from ravenchart.building import checking
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.paths import ROOT

EXAMPLES = ("pump", "qhsmtst", "surgical_robot", "three_components")
CALL = re.compile(r"(\w+)\.Read_(\w+)_Fill \(Queue_Fill\);\s+Ravenchart\.Hosts\.Put_Queue")


@pytest.mark.parametrize("example", EXAMPLES)
def test_each_region_that_takes_events_is_reported_once(example: str) -> None:
    system = checking.check(ROOT / "examples" / example / "model.yaml", deadlines=False).system
    (report,) = (ROOT / "examples" / example / "generated").glob("*-reports.adb")
    wanted = [
        (ada_case(instance.name), ada_case(region.name))
        for instance in system.instances
        for region in instance.component.regions
        if region.events()
    ]
    assert CALL.findall(report.read_text(encoding="utf-8")) == wanted
