# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Lines of any words: the shell refuses each in words of its own, or carries it out."""

from __future__ import annotations

import io
import random

import pytest
from rich.console import Console

from ravenchart.hw_can.bench.interfaces import BusEnd, joined_peer
from ravenchart.hw_can.bench.peer import BenchError
from ravenchart.paths import ROOT
from ravenchart.running.remote import NoAnswerError, RemoteSystem
from ravenchart.running.shell import USAGES, Shell
from ravenchart.running.vocabulary import BusVocabulary, WordError
from tests.support.far_end import system_of

LINES = 1_000
ODD = ("1", "-5", "21.5", "=", "x=1", "'", '"', "#", "\\", "é", "9" * 30, "low", "", "\x1b[0m")


def whole(words: BusVocabulary, chance: random.Random) -> str:
    """A message with most of its fields, at the ends of their ranges or with names."""
    message = chance.choice(words.outside())
    given = [
        f"{name}={chance.choice([one.minimum, one.maximum, 'x', *(one.choices or {}).values()])}"
        for name, one in words.fields(message).items()
        if chance.random() < 0.9
    ]
    return " ".join(["send", message, *given])


@pytest.mark.parametrize("feature", ["authenticated", "flexible", "pages", "protected", "signals"])
def test_no_line_gets_another_exception(feature: str, monkeypatch: pytest.MonkeyPatch) -> None:
    words = BusVocabulary.of(system_of(ROOT / "tests" / "feature" / feature / "model.yaml"))
    verbs = [verb for verb in USAGES if verb != "wait"]
    known = [*verbs, *words.commands, *words.messages, *words.observable(), *ODD]
    chance, done = random.Random(feature), 0
    with RemoteSystem(
        words, joined_peer({"bus": BusEnd("virtual", feature, fd=True)}, words.codec)
    ) as far:
        shell = Shell(far, Console(file=io.StringIO(), width=80))
        monkeypatch.setattr("ravenchart.running.shell.PATIENCE", 0.0)
        for _ in range(LINES):
            some = " ".join(chance.choices(known, k=chance.randint(1, 5)))
            line = whole(words, chance) if chance.random() < 0.6 else some
            try:
                shell.do(line)
                done += 1
            except (WordError, NoAnswerError, BenchError) as refused:
                assert str(refused).splitlines()[0].strip()
            shell.completions(f"{line} ", chance.choice(known)[:2])
    assert 0 < done < LINES
