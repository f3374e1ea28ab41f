# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Why each code matters, with an error and its correction.

The one source of `ravenchart explain` and docs/errors.md, beside the table of meanings in
`gen.diagnostics`. ``bases`` holds correct models. An entry of ``NN.yaml`` names one of them,
makes of it the corrected model (``also``) and of that the wrong one (``wrong``). Each edit is
text that stands once, its replacement and, where it is long, how often that is repeated. Where
a code is not about a model alone, ``beside`` has the other files by their names, and ``command``
reports the code. Then ``wrong`` may edit any of the files, or the command. Tests apply all edits.
"""

from __future__ import annotations

import difflib
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

import yaml

from ravenchart.gen.diagnostics import CODES, GROUPS

WIDTH = 80
"""Longest line of an explanation, in characters."""

AROUND = 2
"""Lines of a file that are shown before and after a changed one."""

MODEL = "model.yaml"
"""The main file of each example."""

CHECK = f"check {MODEL}"

ENCODING = ("utf-8", "surrogateescape")
"""How the text of a file becomes its bytes: one file is wrong because it is not UTF-8."""


@dataclass(frozen=True, slots=True)
class Example:
    """Files by their names, the model among them, and what is called beside them."""

    command: str
    """One command a line; the last one reports the code."""
    files: Mapping[str, str]

    @property
    def commands(self) -> tuple[str, ...]:
        """The commands as they are typed."""
        return tuple(f"ravenchart {line}" for line in self.command.splitlines())


@dataclass(frozen=True, slots=True)
class Explanation:
    """The meaning of a code, why it matters, and two examples: with the error and without."""

    code: str
    why: str
    wrong: Example
    corrected: Example

    @property
    def meaning(self) -> str:
        """One sentence: what is wrong."""
        return CODES[self.code]

    def differences(self) -> dict[str, tuple[str, ...]]:
        """The correction of each file: lines to remove (-) and to add (+), with some around them.

        The name of a changed command is empty.
        """
        both = self.wrong, self.corrected
        wrong, corrected = ({"": "\n".join(e.commands), **e.files} for e in both)
        return {
            name: tuple(_difference(wrong[name], text))
            for name, text in corrected.items()
            if wrong[name] != text
        }


def _difference(wrong: str, corrected: str) -> Iterator[str]:
    made = difflib.unified_diff(wrong.splitlines(), corrected.splitlines(), lineterm="", n=AROUND)
    for line in list(made)[2:]:
        yield "  ..." if line.startswith("@@") else _shown(line.rstrip())


def _shown(line: str) -> str:
    """A line as far as it fits, with a byte that is not UTF-8 as an escape."""
    text = line.encode(*ENCODING).decode("utf-8", "backslashreplace")
    return text if len(text) <= WIDTH else f"{text[: WIDTH - 4]} ..."


@cache
def explanations() -> dict[str, Explanation]:
    """Code to explanation, in the order of the codes."""
    entries: dict[str, Any] = {}
    for group in GROUPS:
        file = resources.files(__name__) / f"{group}.yaml"
        entries |= yaml.safe_load(file.read_text(encoding="utf-8"))
    return {code: _explanation(code, entries[code]) for code in CODES}


def _explanation(code: str, entry: dict[str, Any]) -> Explanation:
    model = edited({MODEL: _base(entry["base"])}, entry.get("also", ()))
    corrected = {"": entry.get("command", CHECK), **model, **entry.get("beside", {})}
    wrong = edited(corrected, entry["wrong"])
    why = " ".join(entry["why"].split())
    return Explanation(code, why, _example(wrong), _example(corrected))


def _example(texts: Mapping[str, str]) -> Example:
    return Example(texts[""], {name: text for name, text in texts.items() if name})


def edited(texts: Mapping[str, str], edits: Iterable[Sequence[Any]]) -> dict[str, str]:
    """The texts with each edit made; ValueError unless its old text stands in them once."""
    made = dict(texts)
    for old, new, *times in edits:
        homes = [name for name, text in made.items() for _ in range(text.count(old))]
        if len(homes) != 1:
            raise ValueError(f"{old!r} stands {len(homes)} times in the files")
        made[homes[0]] = made[homes[0]].replace(old, new * (times[0] if times else 1))
    return made


@cache
def _base(name: str) -> str:
    file = resources.files(__name__) / "bases" / f"{name}.yaml"
    return file.read_text(encoding="utf-8")


def text(code: str) -> str:
    """The text that `ravenchart explain` prints, at most 80 columns wide."""
    found = explanations()[code]
    lines = [f"{code}  {GROUPS[code[3:5]]}", *textwrap.wrap(found.meaning, WIDTH), ""]
    lines += textwrap.wrap(found.why, WIDTH)
    if found.corrected.command != CHECK:
        lines += ["", f"Reported by: {found.wrong.commands[-1]}"]
    for name, difference in found.differences().items():
        told = "Remove the lines with -, add the lines with +:"
        if name not in ("", MODEL):
            told = f"In {name}, remove the lines with -, add the lines with +:"
        lines += ["", *textwrap.wrap(told, WIDTH), "", *difference]
    return "\n".join(lines) + "\n"


def page() -> str:
    """The page of all codes."""
    lines = [
        "# Errors and warnings",
        "",
        "For anybody who sees a code in a message. Each code has its meaning, the reason and a",
        "correction. `ravenchart explain CODE` prints the same. With `--wrong` or `--corrected` it",
        "prints the whole example, and writes it to a folder with `--out`.",
        "",
        "Written by `make docs` from the tables in `gen/diagnostics.py` and gen/explanations; do",
        "not edit. Codes are stable: none is given a second meaning.",
    ]
    for group, title in GROUPS.items():
        lines += ["", f"## RV-{group}xx: {title}"]
        for code in (code for code in CODES if code[3:5] == group):
            found = explanations()[code]
            lines += ["", f"### {code}", "", found.meaning, found.why]
            if found.corrected.command != CHECK:
                lines.append(f"`{found.wrong.commands[-1]}` reports it.")
            for name, difference in found.differences().items():
                lines += ["", f"In `{name}`:"] if name not in ("", MODEL) else []
                lines += ["", "```diff", *difference, "```"]
    return "\n".join(lines) + "\n"
