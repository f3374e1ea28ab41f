# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Changes of a YAML text in place: every byte that is not part of a change stays as it is.

A round trip through a YAML library writes the whole file anew and keeps its layout as well as the
library can. Here the characters of one value, entry or list item are exchanged, at the positions
of the parser that reads models. Each result is read again: a text that would say anything else
than intended is refused (`LayoutError`), so an unusual layout never becomes a wrong model.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

from ravenchart.gen.files import spans
from ravenchart.gen.files.spans import Plain, YamlMapping, YamlNode, YamlScalar, plain_tree

Exchange = Callable[[YamlNode], Plain | None]
"""The value of a node after a change; None where the value stays."""

_BREAK = re.compile(r"\r\n|\r|\n")
_COMMENT = re.compile(r" *#[^\r\n]*(?:\r\n|\r|\n)")


class LayoutError(Exception):
    """A text cannot be changed in place; the message is for people."""


@dataclass(frozen=True, slots=True)
class Document:
    """The text of a file, and its tree."""

    text: str
    root: YamlMapping

    @classmethod
    def of(cls, text: str) -> Document | None:
        """The document of a text; None where it is not YAML, or not one mapping."""
        root = _tree(text)
        return None if root is None else cls(text, root)

    def changed(self, text: str, exchange: Exchange) -> Document:
        """That of the new text, where it says what this one says but for what is exchanged."""
        made = Document.of(text)
        if made is None or plain_tree(made.root) != _exchanged(self.root, exchange):
            raise LayoutError("the layout of the file does not allow this change: edit the file")
        return made


@lru_cache(maxsize=8)
def _tree(text: str) -> spans.YamlMapping | None:
    """The tree of a text; kept, for a change makes it, and the state after the change asks."""
    return spans.spans(text)


@dataclass(frozen=True, slots=True)
class TakenItem:
    """An item of a list that was taken out: what it says, how, and what stood behind it."""

    says: Plain
    text: str
    comment: str = ""


def with_value(document: Document, value: YamlScalar, new: str) -> Document:
    """The document with another scalar in place of ``value``."""
    text = document.text
    made = text[: value.start] + new + text[value.end :]
    return document.changed(made, lambda node: new if node is value else None)


def with_entry(
    document: Document,
    mapping: YamlMapping,
    after: str,
    key: str,
    new: str,
    says: Plain | None = None,
) -> Document:
    """The document with an entry more, behind that of ``after``, whose value is a scalar.

    ``says`` is what ``new`` says where that is no scalar.
    """
    text, found = document.text, mapping.entry(after)
    if found is None or not isinstance(found[1], YamlScalar):
        raise LayoutError(f"there is no `{after}` behind which `{key}` could stand")
    first, value = found
    place, added = value.end, f", {key}: {new}"
    if not mapping.flow:
        margin = re.sub(r"[^ ]", " ", text[_line_start(text, first.start) : first.start])
        place, added = _below(text, value.end, f"{margin}{key}: {new}")

    def exchange(node: YamlNode) -> Plain | None:
        if node is not mapping:
            return None
        told = {name.value: plain_tree(inner) for name, inner in mapping.entries}
        return told | {key: new if says is None else says}

    return document.changed(text[:place] + added + text[place:], exchange)


def without_entry(document: Document, mapping: YamlMapping, key: str) -> Document:
    """The document without an entry whose value is a scalar; a comment behind it stays."""
    text, found = document.text, mapping.entry(key)
    if found is None:
        return document
    if mapping.flow:
        places = [(name.start, value.end) for name, value in mapping.entries]
        made = _cut(text, places, mapping.entries.index(found))
    else:
        made = _without_line(text, found[0].start, found[1].end, comment_stays=True)

    def exchange(node: YamlNode) -> Plain | None:
        if node is not mapping:
            return None
        return {name.value: plain_tree(v) for name, v in mapping.entries if name is not found[0]}

    return document.changed(made, exchange)


def with_block(
    document: Document,
    around: YamlMapping,
    after: str,
    key: str,
    scalars: Mapping[str, str],
    items: str,
    item: TakenItem,
) -> Document:
    """The document with a mapping more in the mapping ``around``, behind the entry of ``after``.

    It gets a line for each of the ``scalars``, and a list at ``items`` that holds ``item``.
    """
    text, found = document.text, around.entry(after)
    if found is None or around.flow:
        raise LayoutError(f"`{key}` cannot stand in a line of its own: edit the file")
    margin = text[_line_start(text, found[0].start) : found[0].start]
    if margin.strip(" "):
        raise LayoutError(f"`{key}` cannot stand in a line of its own: edit the file")
    inner = margin + "  "
    lines = [
        f"{margin}{key}:",
        *(f"{inner}{name}: {value}" for name, value in scalars.items()),
        f"{inner}{items}:",
        f"{inner}  - {item.text}{item.comment}",
    ]
    place, added = _below(text, found[1].end, _break_of(text, found[1].end).join(lines))

    def exchange(node: YamlNode) -> Plain | None:
        if node is not around:
            return None
        told = {name.value: plain_tree(inner) for name, inner in around.entries}
        return told | {key: {**scalars, items: [item.says]}}

    return document.changed(text[:place] + added + text[place:], exchange)


def without_block(document: Document, around: YamlMapping, key: str) -> Document:
    """The document without an entry, its lines, and the lines of comments right above it."""
    text, found = document.text, around.entry(key)
    if found is None:
        return document
    if around.flow:
        raise LayoutError(f"`{key}` does not stand in a line of its own: edit the file")
    made = _without_line(text, found[0].start, found[1].end, comment_stays=False)
    behind = _line_start(text, found[0].start)
    begin = behind
    while begin and _COMMENT.fullmatch(above := text[_line_start(text, begin - 1) : begin]):
        begin -= len(above)

    def exchange(node: YamlNode) -> Plain | None:
        if node is not around:
            return None
        return {name.value: plain_tree(v) for name, v in around.entries if name is not found[0]}

    return document.changed(made[:begin] + made[behind:], exchange)


def without_item(
    document: Document, mapping: YamlMapping, key: str, number: int, *, comment_stays: bool
) -> tuple[Document, TakenItem]:
    """The document without an item of the list at ``key``, and that item.

    In block style its line goes, and the comment at the end of the line with it unless
    ``comment_stays``. Lines of comments stay in any case.
    """
    text = document.text
    name, items = _list(mapping, key)
    taken = items.items[number]
    item = TakenItem(plain_tree(taken), text[taken.start : taken.end])
    if items.flow:
        made = _cut(text, [(one.start, one.end) for one in items.items], number)
    else:
        dash = _line_start(text, taken.start) + len(_dash(text, taken).rstrip(" ")) - 1
        if not comment_stays:
            item = TakenItem(
                item.says, item.text, text[taken.end : _line_end(text, taken.end)].rstrip()
            )
        made = _without_line(text, dash, taken.end, comment_stays=comment_stays)
        if len(items.items) == 1:
            colon = text.index(":", name.end) + 1
            made = f"{made[:colon]} []{made[colon:]}"

    def exchange(node: YamlNode) -> Plain | None:
        return (
            [plain_tree(one) for one in items.items if one is not taken] if node is items else None
        )

    return document.changed(made, exchange), item


def with_item(
    document: Document, mapping: YamlMapping, key: str, number: int, item: TakenItem
) -> Document:
    """The document with an item more in the list at ``key``, before that of the number now.

    In block style it gets a line, below that of the item before it.
    """
    text, items = document.text, _list(mapping, key)[1]
    before = items.items[:number]
    if items.flow and before:
        place, added = before[-1].end, f", {item.text}"
    elif items.flow:
        place, added = items.start + 1, item.text + (", " if items.items else "")
    elif before:
        line = f"{_dash(text, before[-1])}{item.text}{item.comment}"
        place, added = _below(text, before[-1].end, line)
    else:
        first = items.items[0]
        place = _line_start(text, first.start)
        added = f"{_dash(text, first)}{item.text}{item.comment}{_break_of(text, first.end)}"

    def exchange(node: YamlNode) -> Plain | None:
        if node is not items:
            return None
        told = [plain_tree(one) for one in items.items]
        return [*told[:number], item.says, *told[number:]]

    return document.changed(text[:place] + added + text[place:], exchange)


def is_flow(mapping: YamlMapping, key: str) -> bool:
    """Whether the list at ``key`` is written in brackets."""
    return _list(mapping, key)[1].flow


def _list(mapping: YamlMapping, key: str) -> tuple[YamlScalar, spans.Sequence]:
    """The list at a key of a mapping, with the key."""
    found = mapping.entry(key)
    if found is None or not isinstance(found[1], spans.Sequence):
        raise LayoutError(f"`{key}` is not a list")
    return found[0], found[1]


def _exchanged(node: YamlNode, exchange: Exchange) -> Plain:
    """The value of a tree after a change."""
    new = exchange(node)
    if new is not None:
        return new
    match node:
        case YamlScalar():
            return node.value
        case YamlMapping():
            return {key.value: _exchanged(value, exchange) for key, value in node.entries}
        case spans.Sequence():
            return [_exchanged(item, exchange) for item in node.items]


# --- Lines and brackets ------------------------------------------------------------


def _line_start(text: str, place: int) -> int:
    """Where the line begins that holds this place."""
    return max(text.rfind("\n", 0, place), text.rfind("\r", 0, place)) + 1


def _line_end(text: str, place: int) -> int:
    """Where its line break begins, or the text ends."""
    found = _BREAK.search(text, place)
    return len(text) if found is None else found.start()


def _break_of(text: str, place: int) -> str:
    """The line break behind a place, or the first of the text: that of the file."""
    found = _BREAK.search(text, place) or _BREAK.search(text)
    return "\n" if found is None else found[0]


def _below(text: str, place: int, line: str) -> tuple[int, str]:
    """Where a line is put that shall stand below that of a place, and what is put there."""
    return _line_end(text, place), _break_of(text, place) + line


def _dash(text: str, item: YamlNode) -> str:
    """The text before an item in its line: its margin, the dash and spaces."""
    head = text[_line_start(text, item.start) : item.start]
    if re.fullmatch(r" *- +", head) is None:
        raise LayoutError("the item does not stand in a line of its own: edit the file")
    return head


def _without_line(text: str, first: int, behind: int, *, comment_stays: bool) -> str:
    """The text without ``first:behind`` and the line or lines that hold it.

    A comment behind it keeps a line where it stays.
    """
    start, end = _line_start(text, first), _line_end(text, behind)
    if text[start:first].strip(" "):
        raise LayoutError("the entry does not stand in a line of its own: edit the file")
    comment = text[behind:end].strip(" ")
    if comment and comment_stays:
        return text[:first] + comment + text[end:]
    found = _BREAK.match(text, end)
    if found is not None:
        return text[:start] + text[found.end() :]
    return text[:start] + text[end:]


def _cut(text: str, places: Sequence[tuple[int, int]], number: int) -> str:
    """The text without one of the items in brackets, and one comma less; comments stay."""
    start, end = places[number]
    if number + 1 < len(places):
        between = text[end : places[number + 1][0]]
        rest = end + (len(between) if between.strip(" ") == "," else between.index(",") + 1)
        return text[:start] + text[rest:]
    if number and text[places[number - 1][1] : start].strip() == ",":
        start = places[number - 1][1]
    return text[:start] + text[end:]
