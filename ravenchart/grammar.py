# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The commands and their options as data, read from the parsers that read them.

Shell completion and the manual page are made of it, so neither is written by hand.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from pathlib import Path


class ArgumentKind(Enum):
    """The kind of value that an option or argument takes."""

    NOTHING = "nothing"
    TEXT = "text"
    MODEL = "model"
    FILE = "file"
    FOLDER = "folder"


FILES = {
    "MODEL": ArgumentKind.MODEL,
    "FILE": ArgumentKind.FILE,
    "DIR": ArgumentKind.FOLDER,
    "FOLDER": ArgumentKind.FOLDER,
}
"""The kinds of files and folders, by their placeholders in the help."""
AS_LISTED = ": %(choices)s"
"""Ends the help of an option whose choices are too many for its usage: argparse lists them."""
ENDINGS = ("yaml", "yml", "csv", "json")
"""How the names of models end, and of the plain files that `analyse` takes too."""


@dataclass(frozen=True, slots=True)
class Word:
    """An option, or an argument where there are no ``flags``."""

    flags: tuple[str, ...]
    metavar: str
    kind: ArgumentKind
    choices: tuple[str, ...]
    help: str
    required: bool
    repeated: bool


@dataclass(frozen=True, slots=True)
class CommandWords:
    """A command; ``words`` are its options, then its arguments."""

    name: str
    aliases: tuple[str, ...]
    help: str
    usage: str
    words: tuple[Word, ...]

    @property
    def options(self) -> tuple[Word, ...]:
        """Its options."""
        return tuple(word for word in self.words if word.flags)

    @property
    def arguments(self) -> tuple[Word, ...]:
        """Its arguments."""
        return tuple(word for word in self.words if not word.flags)

    @property
    def names(self) -> tuple[str, ...]:
        """Its name and its aliases."""
        return (self.name, *self.aliases)


@dataclass(frozen=True, slots=True)
class Grammar:
    """The whole command line."""

    program: str
    description: str
    options: tuple[Word, ...]
    commands: tuple[CommandWords, ...]


def grammar(parser: argparse.ArgumentParser) -> Grammar:
    """That of a parser whose commands have all their options."""
    (subs,) = (a for a in parser._actions if isinstance(a, argparse._SubParsersAction))
    own = tuple(_word(action) for action in parser._actions if action is not subs)
    return Grammar(parser.prog, parser.description or "", own, tuple(_commands(subs)))


def _commands(subs: argparse._SubParsersAction[argparse.ArgumentParser]) -> Iterator[CommandWords]:
    names: dict[argparse.ArgumentParser, list[str]] = {}
    for name, parser in subs.choices.items():
        names.setdefault(parser, []).append(name)
    for parser, (name, *aliases) in names.items():
        words = sorted(map(_word, parser._actions), key=lambda word: not word.flags)
        usage = " ".join(parser.format_usage().removeprefix("usage: ").split())
        yield CommandWords(name, tuple(aliases), parser.description or "", usage, tuple(words))


def _word(action: argparse.Action) -> Word:
    takes = action.nargs != 0
    named = action.metavar if isinstance(action.metavar, str) else action.dest.upper()
    kind = FILES.get(named, ArgumentKind.FILE if action.type is Path else ArgumentKind.TEXT)
    return Word(
        tuple(action.option_strings),
        named if takes else "",
        kind if takes else ArgumentKind.NOTHING,
        tuple(map(str, action.choices or ())),
        (action.help or "").removesuffix(AS_LISTED),
        action.required,
        isinstance(action, argparse._AppendAction),
    )
