"""Listings of the docs by the names that stand before them."""

from __future__ import annotations

import re

from ravenchart.paths import ROOT


def listing(page: str, name: str) -> str:
    """The listing of ``page`` below the words `name`: at the end of a line."""
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    found = re.search(rf"`{re.escape(name)}`:\n\n```\w*\n(.*?)^```$", text, re.M | re.S)
    assert found is not None, name
    return found[1]
