# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The English of the project, sentence by sentence, with the place where each stands."""

from __future__ import annotations

import argparse
import ast
import inspect
import io
import json
import re
import tokenize
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from ravenchart.command_line import whole_parser
from ravenchart.gen.diagnostics import CODES
from ravenchart.paths import ROOT

GENERATED = ("model-reference.md", "errors.md", "faults.md")
PAGES = (
    *(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "SECURITY.md")),
    *(path for path in sorted((ROOT / "docs").glob("*.md")) if path.name not in GENERATED),
    ROOT / "proofs/assumptions.md",
    ROOT / "examples" / "README.md",
    *sorted((ROOT / "examples").glob("*/README.md")),
)
SPOKEN = (
    *("gen/files", "gen/language", "gen/model", "gen/resolve", "gen/rules", "gen/derive"),
    "gen/emit",
    *("analysis", "behaviour", "hw_can/bench", "ravenchart/commands", "ravenchart/running"),
    *("ravenchart/databases", "ravenchart/building", "ravenchart/proof", "ravenchart/workbench"),
)
"""Folders whose texts reach a user."""

PRODUCT = ("gen", "behaviour", "analysis", "hw_can", "ravenchart")
"""Folders of the product's Python; `ravenchart` holds links to the others."""
TEMPLATES = (
    *sorted((ROOT / "analysis/present/templates").glob("*.html")),
    *sorted((ROOT / "ravenchart/evidence/templates").glob("*.html")),
    ROOT / "ravenchart/commands/loopback.html",
    *sorted((ROOT / "ravenchart/workbench/assets").glob("*.html")),
)

ADA = (
    *("spark_runtime", "hw_can", "analysis/kernel", "proofs", "tests/ada"),
    *(
        str(path.relative_to(ROOT))
        for part in ("user", "generated")
        for path in sorted((ROOT / "examples").glob(f"*/{part}"))
    ),
)
"""Folders of Ada: the hand-written, and the generated of the examples."""

ADA_COMMENT = re.compile(r"""((?:[^"'-]|"[^"]*"|(?<![\w)])'.'|'|-(?!-))*)--(.*)""")
"""Code and comment of a line of Ada."""

SENTENCE = re.compile(r"(?<=[.?!])\)? (?=[\"(`*A-Z0-9]|gnatprove)")


@dataclass(frozen=True)
class Sentence:
    """One sentence: its file, with the line or the key, and its words."""

    location: str
    text: str

    @property
    def length(self) -> int:
        """How many words it has; a piece of code is one."""
        return sum(1 for word in self.text.split() if re.search(r"\w", word))


def sentences(location: str, text: str) -> Iterator[Sentence]:
    """The sentences of a paragraph of Markdown or of a message."""
    text = re.sub(r"``[^`]+``|`[^`]*`", "`x`", text)
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)
    text = " ".join(text.replace("**", "").split())
    for part in SENTENCE.split(text):
        if part:
            yield Sentence(location, part)


def of_page(path: Path) -> Iterator[Sentence]:
    """The sentences of a page: of paragraphs, list items and cells, without listings."""
    name = str(path.relative_to(ROOT))
    block: list[str] = []
    first, listing = 1, False
    lines = [*path.read_text(encoding="utf-8").splitlines(), ""]
    for number, line in enumerate(lines, 1):
        fence = line.lstrip().startswith("```")
        listing ^= fence
        starts = re.match(r"\s*([-*#]+|\d+\.) |\||\s*$", line)
        if block and (fence or starts):
            yield from sentences(f"{name}:{first}", " ".join(block))
            block = []
        if fence or listing or line.startswith("    "):
            continue
        if line.startswith("|"):
            for cell in re.split(r"(?<!\\)\|", line):
                yield from sentences(f"{name}:{number}", cell)
            continue
        if not block:
            first = number
        if said := re.sub(r"^\s*([-*#]+|\d+\.) ", "", line).strip():
            block.append(said)


def of_schema() -> Iterator[Sentence]:
    """The sentences of the descriptions of the file format."""
    whole = json.loads((ROOT / "docs/model.schema.json").read_text(encoding="utf-8"))

    def walk(at: str, node: object) -> Iterator[Sentence]:
        if isinstance(node, dict):
            if isinstance(said := node.get("description"), str):
                yield from sentences(f"schema {at}", said)
            for key, value in node.items():
                yield from walk(f"{at}/{key}", value)
        elif isinstance(node, list):
            for value in node:
                yield from walk(at, value)

    yield from walk("", whole)


def of_help(parser: argparse.ArgumentParser | None = None) -> Iterator[Sentence]:
    """The sentences of every help text."""
    parser = parser or whole_parser()
    for said in (parser.description, parser.epilog):
        yield from sentences(parser.prog, said or "")
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for one in {id(it): it for it in action.choices.values()}.values():
                yield from of_help(one)
        elif action.help and action.help != argparse.SUPPRESS:
            location = f"{parser.prog} {'/'.join(action.option_strings) or action.dest}"
            yield from sentences(location, action.help)


def of_messages() -> Iterator[Sentence]:
    """The sentences of messages and hints, as they stand in the sources."""
    for code, said in CODES.items():
        yield from sentences(code, said)
    for folder in SPOKEN:
        for path in sorted((ROOT / folder).rglob("*.py")):
            tree = ast.parse(path.read_text(encoding="utf-8"))
            for node in _texts(tree):
                yield from _of_text(str(path.relative_to(ROOT)), node)


def _texts(node: ast.AST) -> Iterator[ast.expr]:
    """Text literals that are not docstrings; those of an f-string as a whole."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.Expr) and isinstance(child.value, ast.Constant):
            continue
        if isinstance(child, ast.JoinedStr) or (
            isinstance(child, ast.Constant) and isinstance(child.value, str)
        ):
            yield child
        else:
            yield from _texts(child)


def _of_text(name: str, node: ast.expr) -> Iterator[Sentence]:
    parts = node.values if isinstance(node, ast.JoinedStr) else [node]
    text = "".join(
        part.value if isinstance(part, ast.Constant) and isinstance(part.value, str) else "x"
        for part in parts
    )
    if text.count(" ") >= 2:
        yield from sentences(f"{name}:{node.lineno}", text)


def of_explanations() -> Iterator[Sentence]:
    """The sentences of the reasons that `explain` prints."""
    for path in sorted((ROOT / "gen/explanations").glob("*.yaml")):
        name = str(path.relative_to(ROOT))
        text = path.read_text(encoding="utf-8")
        for found in re.finditer(r"^ *why: (?:[|>]-?\n)?(.*(?:\n    +\S.*)*)", text, re.M):
            yield from sentences(f"{name}:{text[: found.start()].count(chr(10)) + 1}", found[1])


def of_comments() -> Iterator[Sentence]:
    """The sentences of docstrings, of the texts below attributes, and of comments in Python."""
    for folder in PRODUCT:
        for path in sorted((ROOT / folder).rglob("*.py")):
            name, text = str(path.relative_to(ROOT)), path.read_text(encoding="utf-8")
            for node in ast.walk(ast.parse(text)):
                match node:
                    case ast.Expr(ast.Constant(str(said)) as at):
                        yield from _of_docstring(name, at.lineno, said)
            yield from _of_hashes(name, text)


def _of_docstring(name: str, line: int, said: str) -> Iterator[Sentence]:
    """Its paragraphs and list items, without listings."""
    for paragraph in re.finditer(r"(?:^(?! {4,}\S).*\S.*\n?)+", inspect.cleandoc(said), re.M):
        for part in re.split(r"\n(?=[-*] )", paragraph[0]):
            yield from sentences(f"{name}:{line}", part.removeprefix("- "))


def _of_hashes(name: str, text: str) -> Iterator[Sentence]:
    """Comments; those of lines that follow each other are one text."""
    block: list[str] = []
    first = last = 0
    tokens = [*tokenize.generate_tokens(io.StringIO(text).readline)]
    for token in tokens:
        if token.type != tokenize.COMMENT or token.string.startswith(("# SPDX", "# ---", "#!")):
            continue
        number = token.start[0]
        said = re.sub(r"^#+|\b(noqa|type: ignore|fmt:|pragma:).*", "", token.string).strip()
        if block and number != last + 1:
            yield from sentences(f"{name}:{first}", " ".join(block))
            block = []
        if not block:
            first = number
        block.append(said)
        last = number
    yield from sentences(f"{name}:{first}", " ".join(block))


def of_ada() -> Iterator[Sentence]:
    """The sentences of comments in Ada sources and projects."""
    for folder in ADA:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in (".ads", ".adb", ".gpr"):
                name = str(path.relative_to(ROOT))
                yield from _of_dashes(name, path.read_text(encoding="utf-8"))


def _of_dashes(name: str, text: str) -> Iterator[Sentence]:
    """Comments of Ada: lines that follow each other at one column are one text.

    An empty comment and the box above a subprogram separate texts. A keyword of a header and an
    indented line begin one that goes on in the lines that are indented further. Identifiers of
    model elements have no words.
    """
    block: list[str] = []
    first = column = margin = 0
    hanging = False
    for number, line in enumerate([*text.splitlines(), ""], 1):
        found = ADA_COMMENT.fullmatch(line)
        code, said = found.groups() if found else (line, "")
        if re.fullmatch(r"-*| .* --|  SPDX-.*", said):
            said = ""
        keyword = re.match(r"  (Guarantees|Tasking|Timing|Analysis|Assumptions) {2,}", said)
        indent = len(said) - len(said.lstrip())
        goes_on = said and not keyword and not code.strip() and len(code) == column
        if not (goes_on and indent >= margin and hanging == (indent > margin)):
            words = re.sub(r"\[[\w. ]+\] ?", "", " ".join(block))
            yield from sentences(f"{name}:{first}", re.sub(r"\w+(?:\.\w+)+", "X", words))
            block, first, column = [], number, len(code)
            margin, hanging = indent, bool(keyword) or indent > 2
        if said:
            block.append(said[keyword.end() if keyword else 0 :].strip())


def of_templates() -> Iterator[Sentence]:
    """The sentences of pages that the tool writes: their text without marks and code."""
    for path in TEMPLATES:
        text = re.sub(r"(?s)<(script|style|svg)\b.*?</\1>|{#.*?#}|{%.*?%}|<!--.*?-->",
                      _lines, path.read_text(encoding="utf-8"))  # fmt: skip
        text = re.sub(r"(?s){{.*?}}", lambda m: "x" + _lines(m), text)
        text = re.sub(r"(?s)</?(b|i|em|strong|code|a|span|abbr|sub|sup|kbd)\b[^>]*>", _lines, text)
        for found in re.finditer(r"(?s)[^<>]*\w[^<>]*(?=<)", text):
            line = text[: found.start()].count("\n") + 1
            yield from sentences(f"{path.relative_to(ROOT)}:{line}", found[0])


def _lines(found: re.Match[str]) -> str:
    return "\n" * found[0].count("\n")
