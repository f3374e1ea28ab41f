# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The example of two nodes, with text of its model replaced."""

from __future__ import annotations

from pathlib import Path

from ravenchart.gen.diagnostics import render
from ravenchart.gen.files.load import read_file
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import Loaded, load
from ravenchart.paths import ROOT

MODEL = ROOT / "examples" / "two_nodes" / "model.yaml"
_TEXT = MODEL.read_text(encoding="utf-8")
BUS = _TEXT[_TEXT.index("  link:\n") : _TEXT.index("\ninstances:")]
RECEPTION = (
    "  reception: {released_by: link, period: 1 ms, stack: 32 KiB, activities: [link.receive]}\n"
)
TOGETHER = ("component: Linear_Servo, node: drive", "component: Linear_Servo, node: panel")


def loaded(*replacements: tuple[str, str]) -> Loaded:
    """The example with text replaced in its main file; each must be there once."""

    def read(path: Path, most: int) -> bytes:
        text = read_file(path, most).decode()
        if path.name == MODEL.name:
            for old, new in replacements:
                assert text.count(old) == 1, old
                text = text.replace(old, new)
        return text.encode()

    return load(MODEL, read)


def system_of(*replacements: tuple[str, str]) -> System:
    """Its `System`, which must be there."""
    found = loaded(*replacements)
    assert found.system is not None, said(found)
    return found.system


def said(found: Loaded) -> str:
    """Its diagnostics, as they are printed."""
    return "\n".join(render(one, found.sources) for one in found.diagnostics)


AFTER = "    recovery: {after: 100 ms}\n"


def by_chart(text: str) -> str:
    """The text of a file of the example, so that its charts request recovery from bus-off."""
    asked = "    recovery: {on: [servo.Rejoin, supervisor.Rejoin]}\n"
    again = "rejoin: {from: Safe_Off_Bus, every: 200 ms, effect: [{raise: Rejoin}]}\n"
    text = text.replace(AFTER, asked).replace("Bus_Back]\n    data", "Bus_Back, Rejoin]\n    data")
    return text.replace("connected:", f"{again}          connected:")
