# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Functions with their frames and calls, and the call graphs of the compiler that hold them.

GCC writes one file for each unit in the language of VCG (``-fcallgraph-info=su,da``). A node has
the symbol as its title; one that is local to a unit has the file before it. A node with a frame
is of this unit, a node of the form of an ellipse is called and lies elsewhere.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import Enum

INDIRECT = "__indirect_call"
"""GCC's name for the target of a call through a pointer."""


class StackFrame(Enum):
    """The kinds of frame sizes, in the words of ``-fstack-usage``."""

    STATIC = "static"
    BOUNDED = "dynamic,bounded"
    DYNAMIC = "dynamic"


@dataclass(slots=True)
class Function:
    """A function: its frame in bytes, and where each of its callees is called."""

    name: str
    """The symbol."""
    size: int
    frame: StackFrame = StackFrame.STATIC
    place: str = ""
    """``file:line:column``; empty in a library."""
    calls: dict[str, str] = field(default_factory=dict)
    """Title of the callee to the place of the call."""
    objects: tuple[str, ...] = ()
    """The objects of dynamic size, each with its place."""


Graph = dict[str, Function]
"""Title to function."""

_NODE = re.compile(
    r'^node: \{ title: "(?P<title>[^"]*)" label: "(?P<label>(?:[^"\\]|\\.)*)"(?P<rest>[^\n]*)$',
    re.M,
)
_EDGE = re.compile(
    r'^edge: \{ sourcename: "([^"]*)" targetname: "([^"]*)"(?: label: "([^"]*)")?', re.M
)
_SIZE = re.compile(r"(\d+) bytes \((static|dynamic,bounded|dynamic)\)")
BUILT_IN = "<built-in>"
"""Where the compiler says that a function of its own stands."""


def read(texts: Iterable[str]) -> Graph:
    """The functions of call graphs. ValueError where a text is no call graph."""
    graph: Graph = {}
    for text in texts:
        if not text.startswith("graph:"):
            raise ValueError("it is no call graph")
        for node in _NODE.finditer(text):
            made = _function(node["title"], node["label"])
            if made is not None and node["title"] not in graph:
                graph[node["title"]] = made
        for edge in _EDGE.finditer(text):
            caller = graph.get(edge[1])
            if caller is None:
                raise ValueError(f"{edge[1]} calls, and has no frame")
            caller.calls.setdefault(edge[2], edge[3] or "")
    return graph


def _function(title: str, label: str) -> Function | None:
    """The function of a node; None where its code is elsewhere."""
    _, *parts = label.split("\\n")
    sized = next((n for n, part in enumerate(parts) if _SIZE.fullmatch(part)), None)
    if sized is None:
        return None
    match = _SIZE.fullmatch(parts[sized])
    assert match is not None
    place = parts[0] if sized > 0 and parts[0] != BUILT_IN else ""
    objects = tuple(part.strip() for part in parts[sized + 2 :])
    return Function(symbol(title), int(match[1]), StackFrame(match[2]), place, {}, objects)


def symbol(title: str) -> str:
    """The symbol of a title."""
    return title.rpartition(":")[2]


_ADDED = re.compile(
    r"(___wrapped_statements(\.\d+)?)?(\.(constprop|isra|part|cold|lto_priv)(\.\d+)?)*$"
)


def plain_symbol(name: str) -> str:
    """The symbol of the subprogram that a function was made of.

    The compiler makes special copies of functions, and from GNAT 13 on a function inside each
    subprogram with a postcondition, for its statements.
    """
    return _ADDED.sub("", name)


_TASK = re.compile(r"TKB(X[bn]*)?$")
"""GNAT's symbol of a task body; `X` and letters follow inside a body."""


def is_task(name: str) -> bool:
    """Whether a symbol is that of a task body."""
    return _TASK.search(plain_symbol(name)) is not None


def ada_name(name: str) -> str:
    """A symbol as people read it: `pump_1__run_ports` is `Pump_1.Run_Ports`."""
    base = re.sub(r"(TKB(X[bn]*)?|\.\d+)$", "", plain_symbol(name).removeprefix("_ada_"))
    parts = [p for p in base.split("__") if p]
    if len(parts) < 2:
        return name
    return ".".join("_".join(w.capitalize() for w in p.split("_")) for p in parts)
