# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What several of the unit tests begin with."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import can
import pytest

from ravenchart.analysis.present import report
from ravenchart.evidence import records
from tests.support import evidence
from tests.support.bus_server import BusServer
from tests.support.far_end import FarEnd, obedient, robot


@pytest.fixture(scope="module")
def base(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small model with all that evidence is made of."""
    home = tmp_path_factory.mktemp("evidence") / "base"
    evidence.write(home)
    return home


@pytest.fixture
def server() -> Iterator[BusServer]:
    """A stand-in for the bus server."""
    one = BusServer()
    yield one
    one.close()


@pytest.fixture
def far(request: pytest.FixtureRequest) -> Iterator[FarEnd]:
    """The controller's end of a bus of this test alone."""
    one = FarEnd(can.Bus(request.node.name, "virtual"), robot(), obedient)
    yield one
    one.close()


@pytest.fixture
def home(base: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy that a test may spoil; the timing report, which takes a second, is left out."""
    place = evidence.copy(base, tmp_path / "valve")
    monkeypatch.setattr(records, "RECORDS", place / "records")
    monkeypatch.setattr(report, "render_report", lambda _: "")
    return place
