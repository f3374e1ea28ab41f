# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Frames and calls of the run-time library of a board, as its code in the image has them.

The sum of all that the instructions of a function take of the stack is at least its frame: parts
of a prologue that exclude each other count twice. A size in a register has no bound.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from .graph import INDIRECT, Function, Graph, StackFrame

_HEAD = re.compile(r"^[0-9a-f]+ <([^>]+)>:$")
_LINE = re.compile(r"^\s*[0-9a-f]+:\s+(?:[0-9a-f]{2,8} )*\s*([a-z][a-z0-9.]*)\s*(.*)$")
_TARGET = re.compile(r"<([^>+]+)(\+0x[0-9a-f]+)?>")
_PUSH = re.compile(r"\[sp, #-(\d+)\]!")
_DOWN = re.compile(r"^sp, sp, #(0x[0-9a-f]+|\d+)(?:, lsl #(\d+))?")
_POST = re.compile(r"\[sp\], #-(\d+)")

CALLS = {"bl"}
JUMPS = {"b"}
POINTERS = {"blr"}
LEAPS = {"br"}
"""AArch64. `br` is a jump table or a call in the place of a return."""


def read(disassembly: Iterable[str]) -> Graph:
    """The functions of an AArch64 image, by the words of ``objdump -d --no-show-raw-insn``."""
    graph: Graph = {}
    for name, lines in _functions(disassembly):
        made = _function(name, lines)
        if name in graph:  # local functions of one name: the worse of both
            made.size = max(made.size, graph[name].size)
            made.calls |= graph[name].calls
        graph[name] = made
    return graph


def _functions(disassembly: Iterable[str]) -> Iterator[tuple[str, list[tuple[str, str]]]]:
    """Each function with its instructions: (mnemonic, operands)."""
    name, lines = "", list[tuple[str, str]]()
    for line in disassembly:
        head = _HEAD.match(line)
        if head:
            if name:
                yield name, lines
            name, lines = head[1], []
        else:
            found = _LINE.match(line)
            if found:
                lines.append((found[1], found[2]))
    if name:
        yield name, lines


def _function(name: str, lines: list[tuple[str, str]]) -> Function:
    made = Function(name, 0)
    table = any(mnemonic == "adr" for mnemonic, _ in lines)
    for mnemonic, operands in lines:
        if mnemonic in CALLS | JUMPS or mnemonic.startswith("b.") or mnemonic[:2] in ("cb", "tb"):
            target = _TARGET.search(operands)
            if target and (target[1] != name or mnemonic in CALLS):
                made.calls.setdefault(target[1], "")
        elif mnemonic in POINTERS or (mnemonic in LEAPS and not table):
            made.calls.setdefault(INDIRECT, "")
        taken = _taken(mnemonic, operands)
        if taken is None:
            made.frame = StackFrame.DYNAMIC
        else:
            made.size += taken
    return made


def _taken(mnemonic: str, operands: str) -> int | None:
    """Bytes that an instruction takes of the stack; None where a register has the number."""
    pushed = _PUSH.search(operands) or _POST.search(operands)
    if pushed:
        return int(pushed[1])
    if mnemonic == "sub" and operands.startswith("sp,"):
        down = _DOWN.match(operands)
        return None if down is None else int(down[1], 0) << int(down[2] or 0)
    return 0
