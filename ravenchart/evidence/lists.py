# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Lists of requirements: CSV with the columns `id` and `text`, or ReqIF.

ReqIF is the OMG's exchange format for requirements, an XML file. Of it the ids and texts of all
`SPEC-OBJECT`s are read: `ReqIF.ForeignID` or else `IDENTIFIER`, and `ReqIF.Text` or else
`ReqIF.Name` and `LONG-NAME`.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from xml.parsers import expat

from ravenchart.failures import Refused
from ravenchart.gen.diagnostics import Diagnostic, error, render_all
from ravenchart.gen.language.names import LONGEST_REQUIREMENT, REQUIREMENT
from ravenchart.gen.origins import Origin

LARGEST = 16 * 2**20
"""Bytes of a list at most."""
UNREADABLE, WRONG_ID = "RV-1401", "RV-1402"
IDS = ("ReqIF.ForeignID",)
TEXTS = ("ReqIF.Text", "ReqIF.Name", "ReqIF.ChapterName")


@dataclass(frozen=True, slots=True)
class Requirement:
    """One requirement of a list."""

    id: str
    text: str
    origin: Origin


def read(path: Path, shown: str | None = None) -> tuple[Requirement, ...]:
    """The requirements of a file, in its order; Refused with everything that is wrong.

    ``shown`` is the name of the file in messages and origins; its path unless given.
    """
    name = shown or str(path)
    content = path.read_bytes()[: LARGEST + 1]
    found: list[Diagnostic] = []
    requirements: tuple[Requirement, ...] = ()
    start = Origin(name, 1, 1)
    if len(content) > LARGEST:
        found.append(error(UNREADABLE, start, f"{name} is larger than {LARGEST // 2**20} MiB"))
    elif path.suffix.lower() in (".reqif", ".xml"):
        requirements = tuple(_reqif(content, name, found))
    else:
        requirements = tuple(_csv(content, name, found))
    if not found and not requirements:
        found.append(error(UNREADABLE, start, f"{name} has no requirement"))
    found += _wrong_ids(requirements)
    if found:
        raise Refused(render_all(found, {}), found)
    return requirements


def _wrong_ids(requirements: tuple[Requirement, ...]) -> Iterator[Diagnostic]:
    first: dict[str, Origin] = {}
    for one in requirements:
        if not re.match(REQUIREMENT, one.id) or len(one.id) > LONGEST_REQUIREMENT:
            message = f"`{one.id[:80]}` is not the id of a requirement"
            hint = "use letters, digits and - _ . : / such as `R-12`, at most 64 characters"
            yield error(WRONG_ID, one.origin, message, hint=hint)
        elif one.id in first:
            notes = [(first[one.id], "the first is here")]
            yield error(WRONG_ID, one.origin, f"the id {one.id} is given twice", notes=notes)
        first.setdefault(one.id, one.origin)


def _csv(content: bytes, name: str, found: list[Diagnostic]) -> Iterator[Requirement]:
    """The rows of a CSV file whose first row has the names of the columns."""
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        found.append(error(UNREADABLE, Origin(name, 1, 1), f"{name} is not UTF-8 text"))
        return
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    columns: list[str] | None = None
    begins = 1
    try:
        for row in reader:
            at, begins = Origin(name, begins, 1), reader.line_num + 1
            if not any(cell.strip() for cell in row):
                continue
            if columns is None:
                columns = [cell.strip().lower() for cell in row]
                lacks = [wanted for wanted in ("id", "text") if wanted not in columns]
                if lacks:
                    message = f"the first row has no column `{lacks[0]}`"
                    hint = "begin the file with the line `id,text`"
                    found.append(error(UNREADABLE, at, message, hint=hint))
                    return
            elif len(row) != len(columns):
                message = f"the row has {len(row)} columns, but the first row has {len(columns)}"
                hint = "put quotes around a text with a comma"
                found.append(error(UNREADABLE, at, message, hint=hint))
            else:
                cells = dict(zip(columns, row, strict=True))
                yield Requirement(cells["id"].strip(), " ".join(cells["text"].split()), at)
    except csv.Error as problem:
        message = f"not CSV: {problem}"
        found.append(error(UNREADABLE, Origin(name, reader.line_num, 1), message))


# --- ReqIF -----------------------------------------------------------------------


@dataclass(slots=True)
class _Node:
    """An element of an XML file, names without their namespace."""

    name: str
    line: int
    attributes: dict[str, str] = field(default_factory=dict)
    inside: list[_Node] = field(default_factory=list)
    words: list[str] = field(default_factory=list)

    def all(self, name: str) -> Iterator[_Node]:
        """The elements of that name at any depth."""
        for node in self.inside:
            if node.name == name:
                yield node
            yield from node.all(name)

    def text(self) -> str:
        """All text in it."""
        return " ".join(" ".join(self._texts()).split())

    def _texts(self) -> Iterator[str]:
        yield from self.words
        for node in self.inside:
            yield from node._texts()


class _NoDoctype(Exception):  # noqa: N818
    """The file declares entities, which could make it grow without bound."""


def _grown(content: bytes) -> _Node:
    root = _Node("", 1)
    open_: list[_Node] = [root]
    parser = expat.ParserCreate()
    parser.buffer_text = True

    def start(name: str, attributes: dict[str, str]) -> None:
        node = _Node(name.rpartition(":")[2], parser.CurrentLineNumber, attributes)
        open_[-1].inside.append(node)
        open_.append(node)
        if len(open_) > 200:
            raise _NoDoctype("elements are nested more than 200 deep")

    def refuse(*_: object) -> None:
        raise _NoDoctype("a DOCTYPE is not allowed")

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda _: open_.pop()
    parser.CharacterDataHandler = lambda text: open_[-1].words.append(text)
    parser.StartDoctypeDeclHandler = refuse
    parser.Parse(content, True)
    return root


def _reqif(content: bytes, name: str, found: list[Diagnostic]) -> Iterator[Requirement]:
    try:
        root = _grown(content)
    except expat.ExpatError as problem:
        message = f"not XML: {expat.ErrorString(problem.code)}"
        found.append(error(UNREADABLE, Origin(name, problem.lineno, problem.offset + 1), message))
        return
    except (_NoDoctype, ValueError) as problem:
        found.append(error(UNREADABLE, Origin(name, 1, 1), f"{name}: {problem}"))
        return
    if not any(node.name == "REQ-IF" for node in root.inside):
        message = f"{name} is no ReqIF: its outermost element must be REQ-IF"
        found.append(error(UNREADABLE, Origin(name, 1, 1), message))
        return
    kinds = {
        node.attributes["IDENTIFIER"]: node.attributes.get("LONG-NAME", "")
        for kind in ("STRING", "XHTML", "INTEGER")
        for node in root.all(f"ATTRIBUTE-DEFINITION-{kind}")
        if "IDENTIFIER" in node.attributes
    }
    for node in root.all("SPEC-OBJECT"):
        values = dict(_values(node, kinds))
        own = node.attributes.get("IDENTIFIER", "")
        id_ = next((values[key] for key in IDS if values.get(key)), own)
        named = node.attributes.get("LONG-NAME", "")
        text = next((values[key] for key in TEXTS if values.get(key)), named)
        yield Requirement(id_, text, Origin(name, node.line, 1))


def _values(node: _Node, kinds: dict[str, str]) -> Iterator[tuple[str, str]]:
    """Name and value of the attributes of a SPEC-OBJECT."""
    for kind in ("STRING", "XHTML", "INTEGER"):
        for value in node.all(f"ATTRIBUTE-VALUE-{kind}"):
            reference = next(value.all(f"ATTRIBUTE-DEFINITION-{kind}-REF"), None)
            held = next(value.all("THE-VALUE"), None)
            text = value.attributes.get("THE-VALUE") or (held.text() if held else "")
            if reference is not None:
                yield kinds.get(reference.text(), ""), text
