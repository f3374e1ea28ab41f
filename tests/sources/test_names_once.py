# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""One word for one thing: a class has a name of its own in the package, and so has a function.

A function has one where a module imports it by that name. A function that is only called by its
module, as `kept.load`, has the name of the module too.
"""

from __future__ import annotations

import ast
from collections import defaultdict
from functools import cache
from pathlib import Path

from ravenchart.paths import ROOT

FOLDERS = ("gen", "analysis", "behaviour", "hw_can", "ravenchart")
INDEPENDENT = "ravenchart/independent/"
"""It shares nothing with what it checks, so it has records of its own for the same things."""
SAME = {
    "Bus": "of the model, and what the theory needs of it",
    "Task": "of the model, and what the theory needs of it",
}
"""Names of two classes, and why they are of one thing."""
PROTOCOL = {"main": "a module that is run has it; of the command line, it is called by another"}
"""Names of functions that several modules must have."""


@cache
def modules() -> tuple[tuple[str, ast.Module], ...]:
    """Each file of the package with its tree, but for those of the independent checker."""
    found = []
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*.py")):
            file = path.relative_to(ROOT).as_posix()
            if not file.startswith(INDEPENDENT) and path.resolve() == path:
                found.append((file, ast.parse(path.read_text(encoding="utf-8"))))
    return tuple(found)


def defined(kind: type[ast.stmt]) -> dict[str, list[str]]:
    """Each public class or function of a module, and the modules that define one of that name."""
    found: defaultdict[str, list[str]] = defaultdict(list)
    for file, tree in modules():
        for one in tree.body:
            if isinstance(one, kind) and not one.name.startswith("_"):  # type: ignore[attr-defined]
                found[one.name].append(file)  # type: ignore[attr-defined]
    return found


def imported() -> set[tuple[str, str]]:
    """What is imported by its name: the file that defines it, and the name."""
    found = set()
    for file, tree in modules():
        folder = Path("ravenchart") / Path(file).parent.relative_to(
            "ravenchart" if file.startswith("ravenchart/") else "."
        )
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom):
                home = folder.parents[node.level - 2] if node.level > 1 else folder
                home = home if node.level else Path()
                home = home.joinpath(*(node.module or "").split("."))
                found |= {(file_of(home), one.name) for one in node.names}
    return found


def file_of(module: Path) -> str:
    """The file of a module of the package, as seen from the root."""
    inside = Path(*module.parts[1:]) if module.parts[:1] == ("ravenchart",) else module
    home = inside if inside.parts[:1] and inside.parts[0] in FOLDERS else module
    return (home / "__init__.py" if (ROOT / home).is_dir() else home.with_suffix(".py")).as_posix()


def test_no_class_has_the_name_of_another() -> None:
    found = defined(ast.ClassDef)
    assert found["System"] == ["gen/model/system.py"]
    assert {name for name, files in found.items() if len(files) > 1} == set(SAME)


def test_no_function_that_is_imported_by_its_name_shares_the_name() -> None:
    by_name = imported()
    assert ("gen/pipeline.py", "load") in by_name
    assert ("gen/resolve/typed.py", "read_expression") in by_name
    found = {
        name: [file for file in files if (file, name) in by_name]
        for name, files in defined(ast.FunctionDef).items()
    }
    twice = {name for name, files in found.items() if len(files) > 1}
    assert twice == set(PROTOCOL)
