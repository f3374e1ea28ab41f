# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Reports of plain files and models: pictures, contents, and what changed between versions."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import pytest

from ravenchart.analysis.core.can_response import FrameResponse
from ravenchart.analysis.findings.differences import Wording, differences
from ravenchart.analysis.plain.build import PlainSystem, load_plain
from ravenchart.analysis.plain.results import PlainResult, analyse_plain, everything
from ravenchart.analysis.present.page import both, left
from ravenchart.analysis.present.plots import figure_svg, histogram, hop_pieces
from ravenchart.analysis.system.critical import frame_schedule
from ravenchart.analysis.units import milliseconds
from ravenchart.command_line import main
from ravenchart.paths import ROOT

TWO_NODES = ROOT / "tests" / "plain" / "two_nodes.csv"
TEXT = TWO_NODES.read_text(encoding="utf-8")

BUS = """bus,bit_rate,error_period_us,error_burst
can,500000,20000,2

message,bus,identifier,bytes,period_us,jitter_us,queue
a,can,1,8,1000,300,
b,can,2,4,1500,,q
c,can,3,8,2500,100,q
d,can,4,8,2000,,
e,can,5,8,10000,,
"""


def result(text: str) -> PlainResult:
    found = load_plain(text, "a.csv")
    assert isinstance(found, PlainSystem)
    return analyse_plain(found)


def test_the_critical_instant_of_a_frame_takes_exactly_its_window() -> None:
    drawn = 0
    for one in (*result(BUS).found.responses.values(), *result(TEXT).found.responses.values()):
        if isinstance(one, FrameResponse) and one.bound is not None:
            slices = frame_schedule(one)
            assert slices[-1].end == one.window + one.frame.transmission_time
            assert (slices[-1].name, slices[-1].kind) == (one.frame.name, "own")
            assert all(a.end == b.start for a, b in pairwise(slices))
            assert slices[-1].end - one.lead == one.bound
            drawn += 1
    assert drawn == 7


def test_the_hops_of_a_chain_add_up_to_its_reaction() -> None:
    (found,) = result(TEXT).latencies
    name, start, wait, response = hop_pieces(found)[-1]
    assert (name, start + wait + response) == ("wheel", found.reaction)


def test_a_histogram_is_a_picture_with_the_bound() -> None:
    lines = [("bound", 9_000_000), ("limit", 12_000_000)]
    far = [("bound", 9_000_000), ("limit", 100_000_000)]
    text = figure_svg(histogram((4_000_000, 5_000_000, 5_000_000), lines, "reaction"))
    assert text.startswith("<svg") and ">bound<" in text and ">limit<" in text
    assert ">limit<" not in figure_svg(histogram((4_000_000,), far, "reaction"))


def test_the_histogram_of_what_a_plain_file_was_observed_to_take(tmp_path: Path) -> None:
    """A name in several rows has one; of a single time there is nothing to count."""
    seen, page = tmp_path / "seen.csv", tmp_path / "page.html"
    seen.write_text("task,observed_us\nsense,300\nsense,450\nsense,450\nwheel,600\n")
    words = ["analyse", str(TWO_NODES), "--observed", str(seen), "--html", str(page)]
    assert main(words) == 0
    text = page.read_text(encoding="utf-8")
    captions = re.findall(r"<figcaption>(\w+): how often each execution time", text)
    assert captions == ["sense"]
    assert ">WCET<" in text and ">execution in us<" in text


def test_milliseconds_stand_beside_microseconds_from_1_ms_on() -> None:
    assert [milliseconds(n) for n in (1_000_000, 14_560_000, 9_800_301, -2_500_000)] == [
        "1",
        "14.56",
        "9.8004",
        "-2.5",
    ]
    assert "ms" not in both(999_999)
    assert (">12.4<" in both(12_345), ">12.3<" in left(12_345)) == (True, True)
    assert '<data value="-2501">-2.6</data>' in left(-2_501)
    assert '<data value="1500000">1500</data> <small class="ms">1.5 ms</small>' in both(1_500_000)


@pytest.fixture
def changed(tmp_path: Path) -> Callable[[str, str], Path]:
    def write(old: str, new: str) -> Path:
        assert old in TEXT
        path = tmp_path / "now.csv"
        path.write_text(TEXT.replace(old, new), encoding="utf-8")
        return path

    return write


def test_the_report_of_a_plain_file_has_its_sections_and_contents(
    tmp_path: Path, changed: Callable[[str, str], Path]
) -> None:
    page = tmp_path / "new" / "report.html"
    now = changed("10000,900,50", "10000,1900,50")
    assert main(["analyse", str(now), "--html", str(page), "--compare", str(TWO_NODES)]) == 0
    text = page.read_text(encoding="utf-8")
    for section in ("Response times", "Critical instants", "From end to end", "Compared with"):
        assert f">{section}" in text.split("</nav>")[0]
    assert text.count('<h2 id="section-') == text.count('<li><a href="#section-') == 5
    assert "frame_cmd: the schedule behind its bound" in text
    assert "The hops of control" in text and ">worse<" in text
    assert "src=" not in text and "<script>" in text


def test_a_longer_execution_is_worse_and_a_shorter_one_better() -> None:
    before = everything(result(TEXT))
    longer = everything(result(TEXT.replace("10000,900,50", "10000,1900,50")))
    there, back = differences("old", before, longer), differences("old", longer, before)
    worse = [row.element for row in there.rows if row.word is Wording.WORSE]
    better = [row.element for row in back.rows if row.word is Wording.BETTER]
    assert worse == better
    assert {"task sense", "message frame_cmd", "chain control", "obc"} <= set(worse)
    assert "task sense: R 2.1 ms -> 3.11 ms (+48.1 %), worse" in list(there.lines())
    assert "task sense: C 0.9 ms -> 1.9 ms (+111 %), changed" in list(there.lines())
    assert there.verdict.startswith("every deadline and limit is still met; ")
    assert not differences("old", before, before).rows


def test_what_has_no_bound_any_more_is_worse_and_elements_come_and_go() -> None:
    before = everything(result(TEXT))
    late = everything(result(TEXT.replace("100000,100000,3000", "4000,4000,3900")))
    found = differences("old", before, late)
    assert found.verdict.startswith("a deadline or limit is no longer met; ")
    assert "task housekeeping: verdict met -> not met, worse" in list(found.lines())
    renamed = everything(result(TEXT.replace("wheel", "engine")))
    lines = list(differences("old", before, renamed).lines())
    assert "task wheel: removed" in lines and "task engine: added" in lines


def test_an_answer_that_was_kept_is_compared_and_a_broken_one_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main(["analyse", str(TWO_NODES), "--json"])
    kept = tmp_path / "kept.json"
    kept.write_text(capsys.readouterr().out, encoding="utf-8")
    assert main(["analyse", str(TWO_NODES), "--compare", str(kept)]) == 0
    assert f"compared with {kept}: nothing changed." in capsys.readouterr().out
    assert main(["analyse", str(TWO_NODES), "--json", "--compare", str(kept)]) == 0
    assert json.loads(capsys.readouterr().out)["compared"]["changed"] == []
    answer = json.loads(kept.read_text(encoding="utf-8"))
    kept.write_text(json.dumps(answer | {"load": {"obc": "much"}}), encoding="utf-8")
    assert main(["analyse", str(TWO_NODES), "--compare", str(kept)]) != 0
    assert "its figures are not those that `analyse --json` prints" in capsys.readouterr().err


def test_an_overload_is_named_with_its_load(
    changed: Callable[[str, str], Path], capsys: pytest.CaptureFixture[str]
) -> None:
    now = changed("10000,900,50", "10000,10900,50")
    assert main(["analyse", str(now)]) == 1
    out = capsys.readouterr().out
    assert out.splitlines()[0] == "obc is overloaded: what runs on it needs 112 % of its time"
    named = "without a bound because of that: sense, housekeeping, wheel, frame_cmd, frame_hk"
    assert " ".join(out.split()).find(named) > 0
