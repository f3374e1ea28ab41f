# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The documentation as a site: it builds without a warning, and needs no network to be read."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from ravenchart.paths import ROOT

pytestmark = pytest.mark.slow

LOADED = re.compile(r"<(?:script|link|img)\b[^>]*?(?:src|href)=\"(?:https?:)?//[^\"]*\"")
"""What a browser would fetch from elsewhere."""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("site")
    options = ["-q", "-W", "--keep-going", "-j2", "-b", "html", "-c", "docs/site"]
    places = ["-d", f"{place}/trees", ".", f"{place}/html"]
    done = subprocess.run(
        [sys.executable, "-P", "-m", "sphinx", *options, *places],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=1_800,
    )
    assert (done.returncode, done.stderr) == (0, ""), done.stderr
    return place / "html"


def test_every_page_is_there_and_in_its_kind(site: Path) -> None:
    start = (site / "docs" / "index.html").read_text()
    for kind in ("Tutorial", "How to", "Reference", "Explanation"):
        assert f">{kind}<" in start
    for page in (ROOT / "docs").glob("*.md"):
        assert (site / "docs" / f"{page.stem}.html").is_file(), page
        assert page.stem == "index" or f'href="{page.stem}.html"' in start, page


def test_nothing_is_fetched_from_elsewhere(site: Path) -> None:
    pages = list(site.rglob("*.html"))
    assert len(pages) > 100
    assert [page for page in pages if LOADED.search(page.read_text())] == []


def test_packages_of_both_languages_can_be_searched_for(site: Path) -> None:
    index = (site / "searchindex.js").read_text()
    specs = [*(ROOT / "spark_runtime" / "src").glob("*.ads"), *(ROOT / "hw_can/hal").glob("*.ads")]
    for spec in specs:
        assert spec.stem in index, spec
    assert "ravenchart.gen.pipeline" in index
    page = (site / "build/api/spark_runtime-src/ravenchart-blackboards.html").read_text()
    assert "readers get a copy of one whole value" in page
