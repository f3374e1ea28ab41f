# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The claims about a controller, each with its evidence and the verdict that follows.

A verdict is never better than the facts. A claim without evidence is not shown. A claim about
content that differs from the proved content is not met.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator

from ravenchart.behaviour.limits import OF_PROTOCOLS, ON_MODEL, UNFINISHED
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import (
    component_package,
    instance_package,
    region_package,
    root_package,
)
from ravenchart.gen.emit.components.packages import ACTIVITIES, FLOWS, activity_package
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.statechart import Region

from . import records
from .bounds import bounds
from .claim import NO_RECORD, Claim, ClaimKind, Pairs, Shown, own_tool, verdict_of
from .coverage import coverage
from .endings import endings
from .facts import Facts, NodeFacts
from .memory import stacks
from .protocols import protocols
from .records import BelievedRecord
from .results import FAILED, SKIPPED


def claims(facts: Facts) -> tuple[Claim, ...]:
    """Every claim, in the order of the argument."""
    return (
        *(_translation(facts, node) for node in facts.programs),
        *(_program(facts, node) for node in facts.programs),
        *endings(facts),
        *_charts(facts),
        *_frames(facts),
        *_behaviour(facts),
        *protocols(facts),
        *bounds(facts),
        *_runtime(facts),
        *stacks(facts),
        _tests(facts),
        *coverage(facts),
    )


def _on(facts: Facts, node: NodeFacts) -> str:
    if node in facts.libraries:
        return f" of the library {node.name}"
    return f" on {node.name}" if len(facts.nodes) > 1 else ""


def _several(count: int, what: str) -> str:
    return f"{count:,} {what}" if count == 1 else f"{count:,} {what}s"


def _id(word: str, facts: Facts, node: NodeFacts) -> str:
    is_one = len(facts.nodes) == 1 and node in facts.nodes
    return word if is_one else f"{word}-{node.name}"


# --- Program ---------------------------------------------------------------------


def _translation(facts: Facts, node: NodeFacts) -> Claim:
    problems = [facts.ungenerated] if facts.ungenerated else list(node.differences)
    if not problems and not node.files:
        problems = ["no program is generated"]
    return Claim(
        _id("generated", facts, node),
        ClaimKind.TRANSLATION,
        (facts.checked.system.name,),
        f"The generated files{_on(facts, node)} are exactly those that this model gives",
        "The program is generated again in memory and compared with the files, byte by byte; "
        "no other source lies among them.",
        "comparison",
        own_tool(),
        verdict_of(problems),
        tuple(problems),
        (*facts.sources, *node.files),
    )


def _record_problems(node: NodeFacts) -> tuple[str, ...]:
    """Why what is proved of a program says nothing of this model; empty where it does."""
    if node.record is None:
        return (NO_RECORD,)
    others = (f"the program is not what this model gives: {one}" for one in node.differences)
    return (*node.record.problems, *others)


def _inputs(node: NodeFacts) -> Pairs:
    record = node.record
    own = () if record is None else ((f"record {record.name}", record.digest), *record.sources)
    return (*own, *node.files)


def _tool(record: BelievedRecord | None) -> str:
    return records.UNKNOWN_TOOL if record is None else record.tool


def _program(facts: Facts, node: NodeFacts) -> Claim:
    record = node.record
    problems = list(_record_problems(node))
    verdict = verdict_of(problems, shown=record is not None)
    if record is not None and verdict is Shown.MET and record.outside:
        reasons = dict(facts.reasons)
        open_ = records.uncovered(record.outside, [*reasons])
        problems = [f"{name} is outside SPARK, without a reason" for name in open_]
        verdict = Shown.NOT_MET if open_ else Shown.PARTLY
        problems = problems or [f"{len(record.outside)} units or bodies are outside SPARK"]
    checks = "" if record is None else f" {record.checks:,} checks, {record.proved:,} proved."
    return Claim(
        _id("program", facts, node),
        ClaimKind.PROGRAM,
        (facts.checked.system.name,),
        f"The program{_on(facts, node)} has no run-time error, no data race, no use of an unset "
        "value and no ceiling violation",
        "gnatprove: flow analysis and proof of every check of every generated unit and of the "
        f"user's bodies, nothing justified by hand, nothing assumed by `pragma Assume`.{checks}",
        "proof",
        _tool(record),
        verdict,
        tuple(problems),
        _inputs(node),
    )


def _proved_unit(
    node: NodeFacts, unit: str, *, may_be_simple: bool = False
) -> tuple[Shown, tuple[str, ...], str]:
    """The verdict on a unit: its record holds, and has checks of it; and how many.

    One that ``may_be_simple`` may need no check, if only the proof read it.
    """
    record = node.record
    problems = _record_problems(node)
    if record is None:
        return Shown.NOT_SHOWN, problems, ""
    if not problems:
        found = record.of_unit(unit)
        count = sum(one.checks for one in found)
        outside = [name for name in record.outside if _is_within(name, unit)]
        if outside:
            return Shown.PARTLY, tuple(f"{name} is outside SPARK" for name in outside), ""
        if not count and may_be_simple and _was_read(record, unit):
            return Shown.MET, (), " No check was needed."
        if not count:
            return Shown.NOT_MET, (f"the record has no check of {unit}",), ""
        provers = sorted({name for one in found for name in one.provers})
        by = f", by {', '.join(provers)}" if provers else ""
        told = f" {_several(count, 'check')} in {_several(len(found), 'subprogram')}{by}."
        return Shown.MET, (), told
    return Shown.NOT_MET, problems, ""


def _is_within(name: str, unit: str) -> bool:
    return f"{name.lower()}.".startswith(f"{unit.lower()}.")


def _was_read(record: BelievedRecord, unit: str) -> bool:
    """The body of a unit is among the sources of a record."""
    body = f"{unit.lower().replace('.', '-')}.adb"
    return any(name.rpartition("/")[2] == body for name, _ in record.sources)


def _homes(facts: Facts, component: Component) -> Iterator[tuple[NodeFacts, str]]:
    """Each program with the code of a component, and the suffix of a claim about it.

    That is the library which declares it, or each node with an instance.
    """
    library = facts.checked.system.library_of(component)
    for node in facts.libraries if library else ():
        if library is not None and node.name == library.name:
            yield node, ""
    for node in () if library else facts.nodes:
        here = node.program.part.instances
        if any(one.component.name == component.name for one in here):
            yield node, f"-{node.name}" if len(facts.nodes) > 1 else ""


def _charts(facts: Facts) -> Iterator[Claim]:
    system = facts.checked.system
    for component in system.components:
        for node, suffix in _homes(facts, component):
            for region in component.regions:
                unit = region_package(system.home_of(component), component, region).text
                verdict, problems, told = _proved_unit(node, unit)
                yield Claim(
                    f"chart-{component.name}.{region.name}{suffix}",
                    ClaimKind.CHARTS,
                    (f"{component.name}.{region.name}",),
                    f"{component.name}.{region.name}{_on(facts, node)}: the chosen transition is "
                    "enabled and none that precedes it is; each step ends in the target "
                    "configuration, with exits and entries in order",
                    _theorem(region) + told,
                    "proof",
                    _tool(node.record),
                    verdict,
                    problems,
                    _inputs(node),
                )
            yield from _invariants(facts, component, node, suffix)
            yield from _bodies(facts, component, node, suffix)
            yield from _contracts(facts, component, node, suffix)


def _invariants(
    facts: Facts, component: Component, node: NodeFacts, suffix: str
) -> Iterator[Claim]:
    """The invariants that are contracts of the code."""
    system = facts.checked.system
    for safe in system.safe_regions:
        if safe.component != component.name:
            continue
        region = component.region(safe.region)
        unit = region_package(system.home_of(component), component, region).text
        verdict, problems, told = _proved_unit(node, unit)
        for name in safe.invariants:
            yield Claim(
                f"code-never-{component.name}.{name}{suffix}",
                ClaimKind.CHARTS,
                (f"{component.name}.{name}",),
                f"{component.name}.{name}: after each step of {safe.region}{_on(facts, node)} the "
                "condition is false of its states and data",
                "`Is_Kept` is the predicate of the region's state in each instance, and contract "
                f"of `Step`; `Is_Safe` is contract of each transition.{told}",
                "proof",
                _tool(node.record),
                verdict,
                problems,
                _inputs(node),
            )


def _theorem(region: Region) -> str:
    parts = ["contracts of `Choose`, `Fire` and `Step` over the declared form of the chart"]
    if region.deferral_depth:
        parts.append("deferred events are kept, and come before the queue once they are due")
    if any(state.regions and len(state.regions) > 1 for state in region.states):
        parts.append("orthogonal regions each take what they chose, in order")
    return f"{'; '.join(parts)}. Not stated: what an effect does to the data."


def _bodies(facts: Facts, component: Component, node: NodeFacts, suffix: str) -> Iterator[Claim]:
    """Activities: flows that are generated, and bodies of the user."""
    package = component_package(facts.checked.system.home_of(component), component)
    for child, mine in ((FLOWS, False), (ACTIVITIES, True)):
        names = [a.name for a in component.activities if a.by_user == mine and not a.forwards]
        if not names:
            continue
        unit = ref(package, child).text
        verdict, problems, told = _proved_unit(node, unit, may_be_simple=True)
        unstated = [a.name for a in component.activities if a.by_user and not a.ensures]
        if mine and unstated and verdict is Shown.MET:
            verdict = Shown.PARTLY
            problems = ("what the user's bodies compute is not stated by a contract",)
            if len(unstated) < len(names):
                problems = (f"no contract states what these compute: {', '.join(unstated)}",)
        yield Claim(
            f"activities-{component.name}.{child.lower()}{suffix}",
            ClaimKind.PROGRAM,
            tuple(f"{component.name}.{name}" for name in names),
            f"The activities of {component.name}{_on(facts, node)} ({', '.join(names)}) read and "
            "write only what the model says, within the ranges of the types",
            "gnatprove: the parameters of each activity are what it reads and writes, with the "
            f"ranges of the model.{told}",
            "proof",
            _tool(node.record),
            verdict,
            problems,
            _inputs(node),
        )


def _contracts(facts: Facts, component: Component, node: NodeFacts, suffix: str) -> Iterator[Claim]:
    """Conditions of activities: `requires` is shown at each call, `ensures` of each body."""
    system = facts.checked.system
    places = facts.nodes if node in facts.libraries else (node,)
    for activity in component.activities:
        own = component_package(system.home_of(component), component)
        home = node, ref(own, activity_package(component, activity)).text
        callers = [
            (place, instance_package(system, one).text)
            for place in places
            for one in place.program.part.instances
            if any(s.name == activity.name for s in place.program.part.slots_of(one.name))
            and one.component.name == component.name
        ]
        for side, clauses, when, units, theorem in (
            ("requires", activity.requires, "begins", callers, _PRE),
            ("ensures", activity.ensures, "ends", callers and [home], _POST),
        ):
            if not clauses or not units:
                continue
            found = [_proved_unit(place, unit) for place, unit in units]
            verdict, problems, told = next((f for f in found if f[0] is not Shown.MET), found[0])
            yield Claim(
                f"{side}-{component.name}.{activity.name}{suffix}",
                ClaimKind.PROGRAM,
                (f"{component.name}.{activity.name}",),
                f"{component.name}.{activity.name}: the conditions of `{side}` hold when an "
                f"execution {when}{_on(facts, node)}",
                theorem + (told if len(units) == 1 else ""),
                "proof",
                _tool(node.record),
                verdict,
                problems,
                _inputs(node),
            )


_PRE = "precondition of the activity's procedure, proved where each instance calls it."
_POST = "postcondition of the activity's procedure, proved of its body."


def _frames(facts: Facts) -> Iterator[Claim]:
    system = facts.checked.system
    for node in facts.nodes:
        part = node.program.part
        if not part.messages:
            continue
        verdict, problems, told = _proved_unit(node, f"{root_package(system)}.Codecs")
        guarded = [message.name for message in part.messages if message.protection]
        names = tuple(message.name for message in part.messages)
        yield Claim(
            _id("codecs", facts, node),
            ClaimKind.BUS,
            names,
            f"Pack and Unpack of every message{_on(facts, node)} give each raw value by the layout "
            "table, and a value survives both",
            "contracts of Pack and Unpack over `Ravenchart.Can.Layouts`; bits of no signal are 0, "
            f"raw values out of range are refused.{told}",
            "proof",
            _tool(node.record),
            verdict,
            problems,
            _inputs(node),
        )
        if guarded:
            yield Claim(
                _id("protection", facts, node),
                ClaimKind.BUS,
                tuple(guarded),
                f"Frames of {', '.join(guarded)}{_on(facts, node)} are used only if they are "
                "intact and in sequence",
                "contracts of `Ravenchart.Can.Protection`, asserted before each Unpack. That the "
                "CRC finds errors of few bits is tested, not proved.",
                "proof",
                _tool(node.record),
                Shown.PARTLY if verdict is Shown.MET else verdict,
                problems or ("the CRC's power to find errors is tested, not proved",),
                _inputs(node),
            )


# --- Behaviour -------------------------------------------------------------------

_OF_OTHER_CLAIMS = (UNFINISHED, "RV-1108", "RV-1109", ON_MODEL, *OF_PROTOCOLS)
_ALONE = "the invariant is no contract of the generated code"
_IN_CODE = "that the generated code keeps it is a claim of its own"


def _behaviour(facts: Facts) -> Iterator[Claim]:
    system = facts.checked.system
    found = [one for one in facts.checked.diagnostics if one.code.startswith("RV-11")]
    unfinished = [one for one in found if one.code == UNFINISHED]
    others = [one for one in found if one.code not in _OF_OTHER_CLAIMS]
    regions = tuple(f"{c.name}.{r.name}" for c in system.components for r in c.regions)
    told = tuple(f"{one.origin}: {one.message} ({one.code})" for one in (*others, *unfinished))
    tool = f"{own_tool()}, z3"
    if regions:
        verdict = verdict_of(told, shown=bool(others) or not unfinished)
        yield Claim(
            "behaviour-rules", ClaimKind.BEHAVIOUR, regions,
            "No chart gets stuck, goes on for ever in one step, has a state or transition that "
            "nothing reaches, or is unable to reach its safe state",
            "search of all situations of each component, guards and data by a solver; about the "
            "model, not about its code",
            "model checking", tool, verdict, told, facts.sources,
        )  # fmt: skip
    open_ = False
    for component in system.components:
        open_ = open_ or any(one.origin == component.origin for one in unfinished)
        for invariant in component.invariants:
            broken = [one for one in found if one.origin == invariant.origin]
            alone = not any(
                invariant.name in safe.invariants
                for safe in system.safe_regions
                if safe.component == component.name
            )
            reasons = tuple(f"{o.message} ({o.code})" for o in broken if o.code != ON_MODEL)
            verdict = verdict_of(reasons, shown=bool(reasons) or not open_)
            if verdict is Shown.NOT_SHOWN:
                reasons = ("the search of the situations was not finished",)
            yield Claim(
                f"never-{component.name}.{invariant.name}", ClaimKind.BEHAVIOUR,
                (f"{component.name}.{invariant.name}",),
                f"{component.name}.{invariant.name}: the condition holds in no reachable situation",
                "search of all situations, and induction over each step by a solver; about the "
                f"model: {_ALONE if alone else _IN_CODE}",
                "model checking", tool, verdict, reasons, facts.sources,
            )  # fmt: skip


# --- What is under and around the program ----------------------------------------


def _runtime(facts: Facts) -> Iterator[Claim]:
    theorem = (
        "gnatprove: contracts of queues, blackboards, timers, processors and the CAN layer, on "
        "one instance of each generic"
    )
    statement = f"Runtime, CAN layer and the driver {facts.driver} keep their contracts"
    if not facts.runtime:
        yield Claim(
            "runtime", ClaimKind.RUNTIME, (facts.checked.system.name,), statement, theorem, "proof",
            records.UNKNOWN_TOOL, Shown.NOT_SHOWN, ("its proof records are not given",), (),
        )  # fmt: skip
    reasons = dict(facts.runtime_reasons)
    for record in facts.runtime:
        problems = list(record.problems)
        open_ = records.uncovered(record.outside, [*reasons])
        problems += [f"{name} is outside SPARK, without a reason" for name in open_]
        verdict = verdict_of(problems)
        if not problems and record.outside:
            used = [n for n in reasons if len(records.uncovered(record.outside, [n]))
                    < len(record.outside)]  # fmt: skip
            problems = [f"{name} is outside SPARK: {reasons[name]}" for name in used]
            verdict = Shown.PARTLY
        counts = f". {record.checks:,} checks, {record.proved:,} proved."
        yield Claim(
            record.name.removesuffix(".toml"), ClaimKind.RUNTIME, (facts.checked.system.name,),
            f"{statement} ({record.name})", theorem + counts, "proof", record.tool, verdict,
            tuple(problems), ((f"record {record.name}", record.digest), *record.sources),
        )  # fmt: skip


def _tests(facts: Facts) -> Claim:
    reasons: list[str] = []
    verdict = Shown.NOT_SHOWN
    if facts.tests is None:
        reasons = ["no results of tests are given: use `--tests FILE`"]
    elif not facts.tests:
        reasons = ["the results hold no test"]
    else:
        failed = [test for test in facts.tests if test.outcome == FAILED]
        skipped = [test for test in facts.tests if test.outcome == SKIPPED]
        reasons = [f"{test.name} failed: {test.why}" for test in failed]
        reasons += [f"{test.name} was skipped: {test.why}" for test in skipped]
        verdict = Shown.NOT_MET if failed else Shown.PARTLY if skipped else Shown.MET
    count = 0 if facts.tests is None else len(facts.tests)
    text = "".join(f"{t.name} {t.outcome} {t.requirements}\n" for t in facts.tests or ())
    digest = hashlib.sha256(text.encode("utf-8")).hexdigest()
    return Claim(
        "tests", ClaimKind.TESTS, (facts.checked.system.name,), f"{_several(count, 'test')} passed"
        if count else "The tests pass", "results of a test run in the form of JUnit; that the "
        "run was one of this program is the user's word", "test", "the user's test runner",
        verdict, tuple(reasons), (("results of tests", digest),) if count else (),
    )  # fmt: skip


def unit_files(facts: Facts, stem: str) -> tuple[str, ...]:
    """The generated files of a unit and its children, by the beginning of their names."""
    found = []
    for node in facts.programs:
        for name, _ in node.files:
            file = name.rpartition("/")[2].rpartition(".")[0]
            if name.endswith(records.ADA) and (file == stem or file.startswith(f"{stem}-")):
                found.append(name)
    return tuple(found)
