# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""One word for one thing: a class has a name of its own in the package."""

from __future__ import annotations

import ast
from collections import defaultdict

from ravenchart.paths import ROOT

FOLDERS = ("gen", "analysis", "behaviour", "hw_can", "ravenchart")
INDEPENDENT = "ravenchart/independent/"
"""It shares nothing with what it checks, so it has records of its own for the same things."""
SAME = {
    "Bus": "of the model, and what the theory needs of it",
    "Task": "of the model, and what the theory needs of it",
}
"""Names of two classes, and why they are of one thing."""


def classes() -> dict[str, list[str]]:
    """Each public class of a module, and the modules that define one of that name."""
    found: defaultdict[str, list[str]] = defaultdict(list)
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*.py")):
            file = path.relative_to(ROOT).as_posix()
            if not file.startswith(INDEPENDENT):
                for one in ast.parse(path.read_text(encoding="utf-8")).body:
                    if isinstance(one, ast.ClassDef) and not one.name.startswith("_"):
                        found[one.name].append(file)
    return found


def test_no_class_has_the_name_of_another() -> None:
    found = classes()
    assert found["System"] == ["gen/model/system.py"]
    assert {name for name, files in found.items() if len(files) > 1} == set(SAME)
