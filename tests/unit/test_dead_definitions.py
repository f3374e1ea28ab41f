"""Every function, class and method of the package is used by something of the package."""

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
    "capture_signals": "uvicorn calls it",
    "error_counters": "what users of python-can read",
    "kinetic_energy": "a law of physics that the plant has to keep: its tests read it",
    "row_names": "what the test of growth counts",
    "of_frame": "the worst case that tests build for the simulation",
    "of_task": "the worst case that tests build for the simulation",
    "chance_scenario": "random releases, which tests build for the simulation",
    "audsley_tasks": "theory beside the one for frames, compared with references",
    "with_priorities": "theory beside the one for frames, compared with references",
    "with_ranks": "theory beside the one for frames, compared with references",
    "Echo": "a peer of tests on a bus",
    "stale_sources": "the tests of the proof records are built on it",
}
"""Names that stand once in the package, and who uses them."""


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


def test_nothing_is_defined_and_not_used() -> None:
    texts = {path: path.read_text(encoding="utf-8") for path in _files()}
    words = Counter(word for text in texts.values() for word in re.findall(r"\w+", text))
    defined = {
        name for path, text in texts.items() if path.suffix == ".py" for name in _defined(text)
    }
    assert "evaluate" in defined and words["evaluate"] > 1
    lonely = {name for name in defined if words[name] == 1}
    assert lonely == set(CALLED_BY_OTHERS)
