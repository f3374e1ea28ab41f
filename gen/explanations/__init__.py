"""Why each code matters, with a wrong model and its correction.

The one source of `ravenchart explain` and docs/errors.md, beside the table of meanings in
`gen.diagnostics`. ``bases`` holds correct models. An entry of ``NN.yaml`` names one of them,
makes of it the corrected model (``also``) and of that the wrong one (``wrong``). Each edit is
a pair: text that stands once in the model, and its replacement. Tests apply all of them. An entry
without ``base`` has a reason alone.
"""

from __future__ import annotations

import difflib
import textwrap
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

import yaml

from ravenchart.gen.diagnostics import CODES, GROUPS

WIDTH = 80
"""Longest line of an explanation, in characters."""

AROUND = 2
"""Lines of the model that are shown before and after a changed one."""


@dataclass(frozen=True, slots=True)
class Explanation:
    """What a code means, why it matters, and two models: with the error and without.

    A code that is not about a model has none.
    """

    code: str
    why: str
    wrong: str | None
    corrected: str | None

    @property
    def meaning(self) -> str:
        """One sentence: what is wrong."""
        return CODES[self.code]

    def difference(self) -> tuple[str, ...]:
        """The correction: lines to remove (-) and to add (+), with some lines around them."""
        if self.wrong is None or self.corrected is None:
            return ()
        made = difflib.unified_diff(
            self.wrong.splitlines(), self.corrected.splitlines(), lineterm="", n=AROUND
        )
        lines = list(made)[2:]
        return tuple("  ..." if line.startswith("@@") else line.rstrip() for line in lines)


@cache
def explanations() -> dict[str, Explanation]:
    """Code to explanation, in the order of the codes; not every code has one."""
    entries: dict[str, Any] = {}
    for group in GROUPS:
        file = resources.files(__name__) / f"{group}.yaml"
        if file.is_file():
            entries |= yaml.safe_load(file.read_text(encoding="utf-8"))
    return {code: _explanation(code, entries[code]) for code in CODES if code in entries}


def _explanation(code: str, entry: dict[str, Any]) -> Explanation:
    why = " ".join(entry["why"].split())
    if "base" not in entry:
        return Explanation(code, why, None, None)
    corrected = edited(_base(entry["base"]), entry.get("also", ()))
    wrong = edited(corrected, entry["wrong"])
    return Explanation(code, why, wrong, corrected)


def edited(model: str, edits: Iterable[Sequence[str]]) -> str:
    """The model with each text replaced; ValueError unless a text stands in it once."""
    for old, new in edits:
        if model.count(old) != 1:
            raise ValueError(f"{old!r} stands {model.count(old)} times in the model")
        model = model.replace(old, new)
    return model


@cache
def _base(name: str) -> str:
    file = resources.files(__name__) / "bases" / f"{name}.yaml"
    return file.read_text(encoding="utf-8")


def text(code: str) -> str:
    """What `ravenchart explain` prints, at most 80 columns wide."""
    lines = [f"{code}  {GROUPS[code[3:5]]}", *textwrap.wrap(CODES[code], WIDTH)]
    found = explanations().get(code)
    if found is not None:
        lines += ["", *textwrap.wrap(found.why, WIDTH)]
        difference = found.difference()
        if difference:
            lines += ["", "Remove the lines with -, add the lines with +:", "", *difference]
    return "\n".join(lines) + "\n"


def page() -> str:
    """The page of all codes."""
    lines = [
        "# Errors and warnings",
        "",
        "For anybody who sees a code in a message. Each code has its meaning; most have the reason",
        "and a correction too. `ravenchart explain CODE` prints the same, and with `--wrong` or",
        "`--corrected` the whole model of the example.",
        "",
        "Written by `make docs` from the tables in `gen/diagnostics.py` and gen/explanations; do",
        "not edit. Codes are stable: none is given a second meaning.",
    ]
    for group, title in GROUPS.items():
        lines += ["", f"## RV-{group}xx: {title}"]
        for code in (code for code in CODES if code[3:5] == group):
            lines += ["", f"### {code}", "", CODES[code]]
            found = explanations().get(code)
            if found is not None:
                lines.append(found.why)
                difference = found.difference()
                lines += ["", "```diff", *difference, "```"] if difference else []
    return "\n".join(lines) + "\n"
