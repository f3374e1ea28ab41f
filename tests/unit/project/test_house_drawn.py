# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The drawing of the house shows the imports as they are, and none goes up."""

from __future__ import annotations

import re

import pytest

from ravenchart.gen.draw.svg import mark
from ravenchart.paths import ROOT
from tests.support.rooms import PACKAGES, PICTURES, house


@pytest.mark.parametrize("name", PACKAGES)
def test_the_drawing_is_of_the_imports(name: str) -> None:
    text = (PICTURES / f"{name}.svg").read_text(encoding="utf-8")
    assert mark(house(name).dot()) in text, "run make docs"


@pytest.mark.parametrize("name", PACKAGES)
def test_no_arrow_goes_back_and_the_page_has_the_figures(name: str) -> None:
    found = house(name)
    assert found.back_arrows == []
    page = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    row = re.search(rf"^\| `{re.escape(name)}` \|.*\| (.+) \|$", page, re.M)
    assert row is not None
    told = f"{len(found.arrows)} rooms, {found.levels} levels, 0 back arrows"
    assert row[1] == told
