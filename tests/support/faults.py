# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The fault matrix: which test shows that a fault is found, and what follows.

A test says so with `shows`; the page docs/faults.md is made of what the tests say::

    python -P -m tests.support.faults
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "faults.md"
HEAD = """\
# Faults, reactions and tests

For assessors. Each row is a fault that a test injects, with its detection, the reaction of the
controller or the tool, and the time limit of the test. `make docs` writes this page from the tests,
and `make test` fails where the two differ.

| fault | found by | reaction | within | test |
| --- | --- | --- | --- | --- |
"""

Test = TypeVar("Test", bound=Callable[..., None])


@dataclass(frozen=True, slots=True)
class Row:
    """One row of the matrix: what a test says of itself."""

    fault: str
    found_by: str
    reaction: str
    within: str
    test: str


def shows(fault: str, *, found_by: str, reaction: str, within: str = "") -> Callable[[Test], Test]:
    """This test brings the fault about, and fails unless it is found and answered so.

    ``within`` is the time that the test allows; "" where it measures none. All are literals,
    for they are read from the source.
    """
    return lambda test: test


def rows() -> tuple[Row, ...]:
    """What the tests say, by file and in their order."""
    paths = sorted((ROOT / "tests").rglob("test_*.py"))
    return tuple(row for path in paths for row in _rows_of(path))


def _rows_of(path: Path) -> Iterator[Row]:
    text = path.read_text(encoding="utf-8")
    if "shows(" not in text:
        return
    for node in ast.parse(text).body:
        if isinstance(node, ast.FunctionDef):
            for mark in node.decorator_list:
                if isinstance(mark, ast.Call) and ast.unparse(mark.func) == "shows":
                    told = {str(one.arg): str(ast.literal_eval(one.value)) for one in mark.keywords}
                    fault = str(ast.literal_eval(mark.args[0]))
                    place = f"{path.relative_to(ROOT)}::{node.name}"
                    within = told.get("within", "")
                    yield Row(fault, told["found_by"], told["reaction"], within, place)


def page() -> str:
    """The text of docs/faults.md."""
    lines = []
    for row in rows():
        file, _, name = row.test.partition("::")
        shown = name.removeprefix("test_").replace("_", " ")
        cells = (row.fault, row.found_by, row.reaction, row.within, f"[{shown}](../{file})")
        lines.append(f"| {' | '.join(cells)} |")
    return HEAD + "\n".join(lines) + "\n"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
