# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Claims about stacks, by the record of a build."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.model.system import Processor
from ravenchart.stacks.report import Memory

from .claim import Claim, ClaimKind, Pairs, Shown, own_tool
from .facts import Facts


def stacks(facts: Facts) -> Iterator[Claim]:
    """The stack of each processor holds its longest path."""
    for one in facts.checked.system.processors:
        record = next((r for r in facts.memory if r.node == one.node), None)
        yield _undeclared(facts, one) if record is None else _recorded(facts, one, record)


def _undeclared(facts: Facts, one: Processor) -> Claim:
    return Claim(
        f"stack-{one.name}", ClaimKind.MEMORY, (one.name,),
        f"The stack of {one.name} is at most {one.stack_bytes:,} bytes",
        "declared in the model, and compared with the longest path by each build (ASM-004)",
        "declaration", "none", Shown.USERS,
        ("no record of a build is given: use `--memory FILE`, which `ravenchart build` writes",),
        facts.sources,
    )  # fmt: skip


def _recorded(facts: Facts, one: Processor, record: Memory) -> Claim:
    found = next((s for s in record.stacks if s.task == one.name), None)
    wrong = list(_changed(facts, record))
    bound, path = 0, "no path"
    if found is None:
        wrong.append("the record has no such task")
    else:
        bound = found.bound
        path = ", ".join(f"{step.function} {step.bytes:,}" for step in found.path)
        if found.size != one.stack_bytes:
            wrong.append(f"the program gives it {found.size} bytes")
        if bound > one.stack_bytes:
            wrong.append(f"it takes up to {bound:,} bytes")
    partly = []
    if record.library is not None:
        partly.append(
            f"{record.library:,} bytes for the run-time library and the C library are an "
            "allowance: compared with runs, not computed"
        )
    verdict = Shown.NOT_MET if wrong else Shown.PARTLY if partly else Shown.MET
    inputs: Pairs = (*facts.sources, *record.sources.items())
    return Claim(
        f"stack-{one.name}", ClaimKind.MEMORY, (one.name,),
        f"The stack of {one.name}, {one.stack_bytes:,} bytes, holds the {bound:,} bytes that it "
        "takes at most",
        f"longest path in the call graphs of the compiler, mode {record.mode}, target "
        f"{record.target}, in bytes: {path}. No recursion, no call through a pointer (ASM-004).",
        "analysis of call graphs", own_tool(), verdict, (*wrong, *partly), inputs,
    )  # fmt: skip


def _changed(facts: Facts, record: Memory) -> Iterator[str]:
    """The sources that are not those of the build."""
    program = next((node.program for node in facts.nodes if node.name == record.node), None)
    now = program.digests() if program else {}
    for name in sorted(now.keys() | record.sources.keys()):
        if now.get(name) != record.sources.get(name):
            yield f"{name} is not as it was built"
