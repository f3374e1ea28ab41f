# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Every function, class, method and constant of the package is used by something of the package."""

from __future__ import annotations

import ast
import os
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from ravenchart.paths import PACKAGE

CALLED_BY_OTHERS = {
    "_recv_internal": "python-can calls it",
    "_fill_text": "argparse calls it",
    "capture_signals": "uvicorn calls it",
    "_remember": "pydantic calls it",
    "conjunct": "lark calls it",
    "handle": "socketserver calls it",
    "PRESENT": "an import that must come before a signal can",
    "error_counters": "what users of python-can read",
    "units_of_program": "tests/mutation breaks the nodes of units",
    "units_of_simulation": "tests/mutation breaks the nodes of units",
    "is_kept": "`make prove` asks it when its time is over",
}
"""Names that nothing of the package uses, and who uses them."""


def _files() -> Iterator[Path]:
    for folder, _, names in os.walk(PACKAGE, followlinks=True):
        yield from (Path(folder) / name for name in names if name.endswith((".py", ".html")))


def _defined(text: str) -> Iterator[str]:
    for one in ast.parse(text).body:
        if isinstance(one, ast.FunctionDef | ast.ClassDef):
            yield one.name
        if isinstance(one, ast.ClassDef):
            inside = (part for part in one.body if isinstance(part, ast.FunctionDef))
            yield from (part.name for part in inside if not part.name.startswith("__"))
        if isinstance(one, ast.Assign):
            names = (part for part in one.targets if isinstance(part, ast.Name))
            yield from (name.id for name in names if not name.id.startswith("__"))


def _used(text: str) -> Iterator[str]:
    """The names that code uses; comments and docstrings use none, a string may be a name."""
    tree = ast.parse(text)
    told = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        match node:
            case ast.Name(name, ast.Load()) | ast.Attribute(attr=name) | ast.alias(name):
                yield name
            case ast.keyword(str(name)):
                yield name
            case ast.Constant(str(name)) if name.isidentifier() and id(node) not in told:
                yield name


def lonely(texts: dict[Path, str]) -> set[str]:
    """What is defined in some of the texts, and used in none."""
    used: Counter[str] = Counter()
    defined: set[str] = set()
    for path, text in texts.items():
        if path.suffix == ".py":
            used.update(_used(text))
            defined.update(_defined(text))
        else:
            used.update(re.findall(r"\w+", text))
    return {name for name in defined if not used[name]}


def test_nothing_is_defined_and_not_used() -> None:
    texts = {path: path.read_text(encoding="utf-8") for path in _files()}
    assert lonely(texts) == set(CALLED_BY_OTHERS)


def test_what_only_a_docstring_names_is_not_used() -> None:
    text = 'def one(): ...\ndef other(): """Beside `one`."""\nMOST = 3  # of one\nother()\n'
    assert lonely({Path("a.py"): text}) == {"one", "MOST"}
