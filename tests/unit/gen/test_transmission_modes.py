# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Messages sent on change, on event, or both periodically and on change: what is bounded."""

from __future__ import annotations

import re
from pathlib import Path

import cantools
import pytest

from ravenchart.analysis.findings.claims import claims_of
from ravenchart.analysis.findings.deadlines import findings
from ravenchart.analysis.present.figures import figures
from ravenchart.analysis.present.report import render_report
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.gen.emit.buses.dbc import emit_dbc
from ravenchart.gen.emit.program import generate
from ravenchart.gen.pipeline import load
from tests.support.certificates import certificate, compiled
from tests.support.links import LINK

MS = 1_000_000

CHANGE = "{mode: on_change, minimum_delay: 50 ms}"
EVENT = "{mode: on_event, minimum_delay: 50 ms}"
MIXED = "{mode: mixed, minimum_delay: 50 ms, period: 200 ms}"


def _analysed(folder: Path, mode: str = "", *edits: tuple[str, str]) -> Analysis:
    text = LINK.replace("from: s.o,", f"from: s.o, send: {mode}," if mode else "from: s.o,")
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    path = folder / "model.yaml"
    path.write_text(text)
    loaded = load(path)
    assert loaded.system is not None, loaded.diagnostics
    return analyse(loaded.system)


def _times(analysis: Analysis) -> tuple[int | None, int | None]:
    (_, found), = analysis.limited  # fmt: skip
    return found.reaction, found.age


def test_the_minimum_delay_is_the_period_of_the_frame(tmp_path: Path) -> None:
    for mode in (CHANGE, EVENT, MIXED):
        analysis = _analysed(tmp_path, mode)
        items = analysis.network.items()
        assert items["can0.link"].period == 50 * MS
        assert items["can0.driver_rx.link"].period == 50 * MS
    assert _analysed(tmp_path, "{mode: on_event}").network.items()["can0.link"].period == 10 * MS


def test_a_value_waits_for_the_minimum_delay(tmp_path: Path) -> None:
    plain, _ = _times(_analysed(tmp_path))
    assert plain is not None
    for mode in (CHANGE, EVENT, MIXED):
        reaction, _ = _times(_analysed(tmp_path, mode))
        assert reaction == plain + 40 * MS


def test_only_a_period_bounds_the_age(tmp_path: Path) -> None:
    _, plain = _times(_analysed(tmp_path))
    assert plain is not None
    assert _times(_analysed(tmp_path, CHANGE))[1] is None
    assert _times(_analysed(tmp_path, EVENT))[1] is None
    #  what the reader samples is replaced every 200 ms instead of every 10 ms
    assert _times(_analysed(tmp_path, MIXED))[1] == plain + 190 * MS


def test_the_age_of_what_is_sent_on_change_is_refused(tmp_path: Path) -> None:
    (one,) = findings(_analysed(tmp_path, CHANGE))
    assert one.message == "the age of cmd has no bound; its limit is 900 ms"
    assert [note for _, note in one.notes] == ["link is sent on change only"]
    assert findings(_analysed(tmp_path, CHANGE, (", age: 900 ms", ""))) == ()


SOME = ("body: [{send: o, with: cmd}]", "body: [{if: cmd > 5, then: [{send: o, with: cmd}]}]")
BEHIND = ("path: [cmd, s.one, link, d.act, valve]", "path: [link, d.act, valve]")


def test_a_message_that_only_some_jobs_send_begins_no_chain_with_an_age(tmp_path: Path) -> None:
    whole, age = _times(_analysed(tmp_path, "", BEHIND))
    assert age is not None
    found = _analysed(tmp_path, "", SOME, BEHIND)
    assert _times(found) == (whole, None)
    (one,) = findings(found)
    why = "s.one gives s.o a new value in some of its jobs only"
    assert [note for _, note in one.notes] == [why]
    assert "chain cmd can have any age" in compiled(certificate(found), tmp_path)
    repeated = _times(_analysed(tmp_path, MIXED, SOME, BEHIND))
    assert repeated == _times(_analysed(tmp_path, MIXED, BEHIND))


@pytest.mark.parametrize("mode", ["", CHANGE, EVENT, MIXED])
def test_the_certificate_has_the_same_sums(mode: str, tmp_path: Path) -> None:
    edits = [(", age: 900 ms", "")] if mode in (CHANGE, EVENT) else []
    found = _analysed(tmp_path, mode, *edits)
    assert findings(found) == ()
    text = certificate(found)
    assert compiled(text, tmp_path) == ""
    assert ("Can0_Link_Renewal" in text) == (mode == MIXED)
    if mode in (CHANGE, EVENT):
        refused = certificate(_analysed(tmp_path, mode))
        (tmp_path / "age").mkdir()
        assert "chain cmd can have any age" in compiled(refused, tmp_path / "age")


def test_the_mode_periodic_changes_nothing(tmp_path: Path) -> None:
    made = [
        {
            name: re.sub(r"[0-9a-f]{64}", "", text)
            for name, text in generate(analysis.system, claims_of(analysis)).items()
            if not name.endswith("trace.json")
        }
        for analysis in (_analysed(tmp_path, mode) for mode in ("", "{mode: periodic}"))
    ]
    assert made[0] == made[1]


@pytest.mark.parametrize(("mode", "cycle"), [("", 10), (CHANGE, None), (MIXED, 200)])
def test_the_database_has_the_longest_time_as_cycle_time(
    mode: str, cycle: int | None, tmp_path: Path
) -> None:
    system = _analysed(tmp_path, mode).system
    database = cantools.database.load_string(emit_dbc(system, system.buses[0]), "dbc")
    assert isinstance(database, cantools.database.Database)
    assert database.get_message_by_name("link").cycle_time == cycle


@pytest.mark.slow
def test_report_and_figures_name_the_mode(tmp_path: Path) -> None:
    analysis = _analysed(tmp_path, MIXED)
    assert figures(analysis)["transmission"] == [
        {
            "message": "link",
            "mode": "mixed",
            "minimum_delay": 50 * MS,
            "longest": 200 * MS,
        }
    ]
    assert "periodically and on change" in render_report(analysis)
