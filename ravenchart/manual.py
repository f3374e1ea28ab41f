# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The manual page, in the man macros of roff, made of the grammar."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator, Mapping

from .failures import MEANINGS
from .grammar import ArgumentKind, CommandWords, Grammar, Word

SECTION = 1

ENVIRONMENT: Mapping[str, str] = {
    "NO_COLOR": "Where it is set and not empty, nothing is printed in colour or bold.",
    "FORCE_COLOR": "Where it is set and not empty, a pipe gets colour too, unless NO_COLOR is set.",
    "TERM": "Where it is `dumb`, nothing is printed in colour or bold, and no progress is shown.",
    "PATH": "Where gprbuild, gcc, gnatprove and dot are looked for.",
    "GPR_PROJECT_PATH": "Further folders of GNAT projects, for user code that needs them.",
    "XDG_CACHE_HOME": "Results are kept in `ravenchart` below it; default: `~/.cache`.",
}
"""Variables that users set."""

FILES: Mapping[str, str] = {
    "model.yaml": "The main file of a model.",
    "user/": "Beside the model: activities and drivers that the user writes.",
    "generated/": "Beside the model: the program. `generated-NAME/` for a main file `NAME.yaml`; "
    "below it a folder for each deployment.",
    "outside_spark.toml": "Beside the model: what may be outside SPARK, with the reasons.",
    "~/.cache/ravenchart/": "Results of earlier checks and proofs. It may be deleted.",
}
"""The files and folders that commands read and write."""

SEE_ALSO = ("gprbuild(1)", "gnatprove(1)", "dot(1)")


def page(grammar: Grammar, version: str) -> str:
    """The page of the whole command line."""
    name = grammar.program
    lines = [
        f'.\\" Made by `make docs` from the parsers of {name}; do not edit.',
        f'.TH {name.upper()} {SECTION} "" "{name} {version}" "User Commands"',
        ".nh",
        ".ad l",
        ".SH NAME",
        f"{name} \\- generate, prove and analyse SPARK Ada from models of controllers",
        ".SH SYNOPSIS",
        f".B {name}",
        r"[\fB\-\-help\fR] [\fB\-\-version\fR] \fICOMMAND\fR [\fIOPTION\fR ...]",
        ".SH DESCRIPTION",
        _text(grammar.description),
        ".PP",
        "Results go to standard output, errors and warnings to standard error.",
        _text("With `--json`, standard output holds one JSON object."),
        ".SH OPTIONS",
        *(line for word in grammar.options for line in _word(word)),
        ".SH COMMANDS",
        *(line for command in grammar.commands for line in _command(command)),
        ".SH EXIT STATUS",
        *_table(MEANINGS),
        ".SH ENVIRONMENT",
        *_table(ENVIRONMENT),
        ".SH FILES",
        *_table(FILES),
        ".SH SEE ALSO",
        ",\n".join(_reference(one) for one in SEE_ALSO),
    ]
    return "\n".join(lines) + "\n"


def _command(command: CommandWords) -> Iterator[str]:
    yield f".SS {_escaped(command.name)}"
    yield f"{_text(_sentence(command.help))}"
    yield ".PP"
    yield _synopsis(command)
    if command.aliases:
        yield ".PP"
        yield f"Also called {', '.join(map(_bold, command.aliases))}."
    for word in (*command.arguments, *command.options):
        if "--help" not in word.flags:
            yield from _word(word)


def _synopsis(command: CommandWords) -> str:
    """The usage, with the literal words in bold."""
    program, name, *rest = command.usage.split(" ")
    parts = [rf"\fB{program} {name}\fR"]
    for part in rest:
        parts.append(re.sub(r"(--?[a-z][a-z-]*)", lambda m: rf"\fB{m[1]}\fR", part))
    return "".join(f"{one} " for one in parts).strip().replace("-", "\\-")


def _word(word: Word) -> Iterator[str]:
    yield ".TP"
    flags = ", ".join(map(_bold, word.flags))
    metavar = "" if word.kind is ArgumentKind.NOTHING else rf"\fI{_escaped(word.metavar)}\fR"
    yield " ".join(filter(None, [flags, metavar]))
    choices = f"One of {', '.join(word.choices)}." if word.choices else ""
    more = "May be given several times." if word.repeated else ""
    yield _text(" ".join(filter(None, [_sentence(word.help), choices, more])))


def _table(rows: Mapping[str, str]) -> Iterator[str]:
    for name, meaning in rows.items():
        yield ".TP"
        yield _bold(name)
        yield _text(_sentence(meaning))


def _reference(name: str) -> str:
    page, _, section = name.partition("(")
    return rf"\fB{page}\fR({section}"


def _sentence(text: str) -> str:
    """The text as a sentence; a word of code at its start stays as it is."""
    if not text:
        return ""
    start = text[0] if re.match(r"\w*[`_:]", text) else text[0].upper()
    return f"{start}{text[1:]}" + ("" if text.endswith((".", "`)")) else ".")


def _text(text: str) -> str:
    """Running text: what stands between backquotes in bold, a new line where a sentence ends."""
    escaped = re.sub(r"`([^`]*)`", r"\\fB\1\\fR", _escaped(text))
    sentences = re.sub(r"(?<=[.:;]) (?=[A-Z])", "\n", escaped).splitlines()
    lines = [line for one in sentences for line in _wrapped(one)]
    return "\n".join(rf"\&{line}" if line[:1] in (".", "'") else line for line in lines)


def _wrapped(text: str) -> list[str]:
    """In lines that end at spaces alone."""
    return textwrap.wrap(text, 78, break_long_words=False, break_on_hyphens=False)


def _bold(text: str) -> str:
    return rf"\fB{_escaped(text)}\fR"


def _escaped(text: str) -> str:
    return text.replace("\\", r"\e").replace("-", r"\-")
