# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The parameters of written Ada: in a list with one on each line the colons are below one another.

Generated Ada has that from its emitter.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from tests.support.processes import ROOT

FIRST = re.compile(r"^\s*\([A-Z]\w*(, [A-Z]\w*)*\s* : ")
NEXT = re.compile(r"^\s*[A-Z]\w*(, [A-Z]\w*)*\s* : ")
"""A line with a parameter of its own, of a list that goes on."""


def strange(text: str) -> Iterator[str]:
    """The first line of each list whose colons are not below one another."""
    lines = text.splitlines()
    for number, line in enumerate(lines):
        if FIRST.match(line):
            among = [line]
            for one in lines[number + 1 :]:
                if not among[-1].rstrip().endswith(";") or not NEXT.match(one):
                    break
                among.append(one)
            if len({one.index(" : ") for one in among}) > 1:
                yield line


def test_colons_stand_below_one_another() -> None:
    found = {
        path.relative_to(ROOT).as_posix(): lists
        for folder in ("analysis", "examples", "hw_can", "proofs", "spark_runtime", "tests")
        for path in (ROOT / folder).rglob("*.ad[bs]")
        if "generated" not in path.parts
        if (lists := list(strange(path.read_text("utf-8"))))
    }
    assert not found


@pytest.mark.parametrize(("text", "count"), [
    ("procedure P\n  (A : Natural;\n   B : Natural);", 0),
    ("procedure P\n  (A     : Natural;\n   Other : Natural);", 0),
    ("procedure P\n  (A : Natural;\n   Other : Natural);", 1),
    ("procedure P (A : Natural; Other : Natural);\nB  : Natural;", 0),
])  # fmt: skip
def test_a_list_that_is_not_aligned_is_found(text: str, count: int) -> None:
    assert len(list(strange(text))) == count
