# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Traceability: requirement to element, generated code, claim and test, and back."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from ravenchart.gen.diagnostics import Diagnostic, error, in_order
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import (
    ada_case,
    component_package,
    instance_package,
    region_package,
    root_package,
)
from ravenchart.gen.emit.certificate.certified import CERTIFICATE
from ravenchart.gen.emit.components.packages import ACTIVITIES, FLOWS
from ravenchart.gen.files.links import Link
from ravenchart.gen.files.located import Map, Seq, grow
from ravenchart.gen.model.instances import Instance
from ravenchart.gen.model.system import System
from ravenchart.gen.origins import Origin
from ravenchart.running import scenarios

from .claim import Claim, ClaimKind, Shown
from .claims import unit_files
from .facts import Facts
from .lists import Requirement
from .results import PASSED, Test

NO_ELEMENT, UNKNOWN_ID, NO_TEST, NO_PROOF = "RV-1403", "RV-1404", "RV-1405", "RV-1406"
PROOFS = (ClaimKind.PROGRAM, ClaimKind.CHARTS, ClaimKind.BUS, ClaimKind.BEHAVIOUR, ClaimKind.TIMING)
"""Claims that can show that a requirement is implemented as the model says."""


@dataclass(frozen=True, slots=True)
class Probe:
    """Something that tests: a step or expectation of a scenario, or a test with its outcome."""

    name: str
    outcome: str
    """`passed`, `failed` or `skipped`; `not at hand` of a scenario."""
    requirements: tuple[str, ...]
    origin: Origin | None = None

    @property
    def counts(self) -> bool:
        """It exists, and no result speaks against it."""
        return self.outcome in (PASSED, UNKNOWN)


UNKNOWN = "result not given"


@dataclass(frozen=True, slots=True)
class Trace:
    """A requirement with all that belongs to it."""

    requirement: Requirement
    links: tuple[Link, ...]
    code: tuple[str, ...]
    claims: tuple[Claim, ...]
    probes: tuple[Probe, ...]


@dataclass(frozen=True, slots=True)
class Back:
    """An element of the model with its requirements, for the way back."""

    link: Link
    code: tuple[str, ...]
    claims: tuple[Claim, ...]


@dataclass(frozen=True, slots=True)
class Traceability:
    """Both ways, and what is wrong with them."""

    forward: tuple[Trace, ...]
    backward: tuple[Back, ...]
    probes: tuple[Probe, ...]
    findings: tuple[Diagnostic, ...]


def traced_requirements(
    facts: Facts,
    found: Sequence[Claim],
    requirements: Sequence[Requirement],
    given: Sequence[Path] | None,
) -> Traceability:
    """Requirements traced through a model; scenarios ``given``: None for those beside it."""
    probes = (*_scenarios(facts, given), *_tested(facts.tests or ()))
    backward = tuple(
        Back(link, code_of(facts, link), claims_about(facts, link, found)) for link in facts.links
    )
    forward = tuple(_trace(one, backward, probes) for one in requirements)
    known = {one.id for one in requirements}
    findings = in_order(
        (*_unknown(known, facts.links, probes), *(d for t in forward for d in _gaps(t)))
    )
    return Traceability(forward, backward, probes, findings)


def _trace(one: Requirement, backward: Sequence[Back], probes: Sequence[Probe]) -> Trace:
    mine = [back for back in backward if one.id in back.link.ids]
    code = tuple(dict.fromkeys(name for back in mine for name in back.code))
    claims = tuple({claim.id: claim for back in mine for claim in back.claims}.values())
    tests = tuple(probe for probe in probes if one.id in probe.requirements)
    return Trace(one, tuple(back.link for back in mine), code, claims, tests)


# --- From an element -------------------------------------------------------------


def claims_about(facts: Facts, link: Link, found: Sequence[Claim]) -> tuple[Claim, ...]:
    """The claims about an element: about itself, what is around it, or what is inside it."""
    if not link.path:
        return tuple(claim for claim in found if claim.kind in PROOFS)
    names = {link.element.lower()}
    system = facts.checked.system
    instance = next((i for i in system.instances if i.name == link.element), None)
    if link.section == "instances" and instance is not None:
        names.add(instance.component.name.lower())
    if link.section == "chains":  # one with stars is one for each element
        names |= {chain.name.lower() for chain in system.chains if chain.origin == link.origin}
    for inside in instances_inside(system, link):
        names |= {inside.name.lower(), inside.component.name.lower()}
    own = _about(names, found)
    if not own and link.section == "components" and len(link.path) > 1:
        own = _about({str(link.path[1]).lower()}, found)  # a port, an event or data
    if own:
        return own
    return tuple(
        claim for claim in found if claim.kind is ClaimKind.PROGRAM and _whole(facts, claim)
    )


def _whole(facts: Facts, claim: Claim) -> bool:
    """The claim is about the whole program."""
    return claim.elements == (facts.checked.system.name,)


def _about(names: set[str], found: Sequence[Claim]) -> tuple[Claim, ...]:
    return tuple(
        claim
        for claim in found
        if any(_overlap(name, one.lower()) for name in names for one in claim.elements)
    )


def _overlap(element: str, about: str) -> bool:
    return element == about or element.startswith(f"{about}.") or about.startswith(f"{element}.")


def code_of(facts: Facts, link: Link) -> tuple[str, ...]:
    """The generated files that implement an element."""
    system = facts.checked.system
    inside = [instance_package(system, one) for one in instances_inside(system, link)]
    if inside:
        return tuple(n for unit in inside for n in unit_files(facts, unit.file_stem))
    for unit in _units(system, link):
        files = unit_files(facts, unit.file_stem)
        if files:
            return files
    return ()


def instances_inside(system: System, link: Link) -> tuple[Instance, ...]:
    """The instances that an element stands for which is no instance of the system itself.

    Of a composite these are all that it has, or one of them; of an array its elements.
    """
    name = str(link.path[1]) if len(link.path) > 1 else ""
    if link.section == "instances":
        return tuple(
            i
            for i in system.instances
            if i.name != name and i.name.partition(".")[0] in link.elements
        )
    is_inner = link.path[2:3] == ("instances",) and len(link.path) > 3
    own = link.elements if is_inner else None
    return tuple(
        one
        for one in system.instances
        if link.section == "components"
        and name in one.composites
        and (own is None or one.name.split(".")[one.composites.index(name) + 1] in own)
    )


def _units(system: System, link: Link) -> Iterator[DottedName]:
    """The Ada units of an element, the nearest first."""
    root = root_package(system)
    name = str(link.path[1]) if len(link.path) > 1 else ""
    if link.section == "components":
        component = next((c for c in system.components if c.name == name), None)
        if component is not None:
            home = system.home_of(component)
            package = component_package(home, component)
            inside = str(link.path[3]) if len(link.path) > 3 else ""
            if link.path[2:3] == ("regions",):
                region = next((r for r in component.regions if r.name == inside), None)
                if region is not None:
                    yield region_package(home, component, region)
            elif link.path[2:3] == ("activities",):
                flows = {a.name for a in component.activities if a.flow is not None}
                yield ref(package, FLOWS if inside in flows else ACTIVITIES)
            yield package
    elif link.section == "instances":
        instance = next((i for i in system.instances if i.name == name), None)
        if instance is not None:
            yield instance_package(system, instance)
    elif link.section in ("processors", "buses", "devices", "device_types"):
        yield ref(root, ada_case(name))
    elif link.section == "messages":
        yield ref(root, "Codecs")
    elif link.section in ("chains", "nodes"):
        yield ref(root, CERTIFICATE)
    yield ref(root)


# --- Tests -----------------------------------------------------------------------


def _scenarios(facts: Facts, given: Sequence[Path] | None) -> Iterator[Probe]:
    """The requirements that scenarios name; Refused where one does not fit the model."""
    folder = facts.checked.folder
    paths = sorted(folder.glob("*.yaml")) if given is None else given
    for path in paths:
        tree, _ = grow(path.read_text(encoding="utf-8", errors="replace"), path.name)
        is_one = tree is not None and {"scenario", "steps"} <= tree.keys()
        if given is None and not (is_one and [*_named(tree, "", path.name, ())]):
            continue
        title = scenarios.checked(path, facts.checked.system).title
        yield from _named(tree, f"{path.name}: {title}", path.name, ())


def _named(node: object, title: str, file: str, place: tuple[str, ...]) -> Iterator[Probe]:
    """Each mapping of a scenario that names requirements."""
    if isinstance(node, Map):
        ids = node.get("req")
        if isinstance(ids, Seq):
            where = f" ({' '.join(place)})" if place else ""
            origin = Origin(file, node.origin.line, node.origin.column)
            yield Probe(f"{title}{where}", UNKNOWN, tuple(map(str, ids)), origin)
        for key, inner in node.items():
            if key != "with":
                yield from _named(inner, title, file, (*place, key))
    elif isinstance(node, Seq):
        for number, inner in enumerate(node, 1):
            yield from _named(inner, title, file, (*place, str(number)))


def _tested(tests: Sequence[Test]) -> Iterator[Probe]:
    for test in tests:
        if test.requirements:
            yield Probe(test.name, test.outcome, test.requirements)


# --- Findings --------------------------------------------------------------------


def _unknown(
    known: set[str], links: Sequence[Link], probes: Sequence[Probe]
) -> Iterator[Diagnostic]:
    """Elements and tests that name an id which the list does not have."""
    hint = "correct the id, or add it to the list"
    for link in links:
        for one in link.ids:
            if one not in known:
                message = f"{link.element} names the requirement {one}, which the list lacks"
                yield error(UNKNOWN_ID, link.origin, message, hint=hint)
    for probe in probes:
        for one in probe.requirements:
            if one not in known:
                message = f"{probe.name} names the requirement {one}, which the list lacks"
                yield error(UNKNOWN_ID, probe.origin or Origin("tests", 1, 1), message, hint=hint)


def _gaps(trace: Trace) -> Iterator[Diagnostic]:
    """Reports that a requirement lacks an element, a test or a proof."""
    one = trace.requirement
    if not trace.links:
        hint = f"write `req: [{one.id}]` at the elements that implement it"
        yield error(NO_ELEMENT, one.origin, f"no element of the model names {one.id}", hint=hint)
    if not any(probe.counts for probe in trace.probes):
        if trace.probes:
            outcome = ", ".join(f"{probe.name} {probe.outcome}" for probe in trace.probes)
            message = f"no test of {one.id} passed: {outcome}"
        else:
            message = f"no test and no scenario names {one.id}"
        hint = "write `req` at an expectation of a scenario, or give `--tests`"
        yield error(NO_TEST, one.origin, message, hint=hint)
    proofs = [claim for claim in trace.claims if claim.kind in PROOFS]
    open_ = [claim for claim in proofs if claim.verdict in (Shown.NOT_MET, Shown.NOT_SHOWN)]
    if trace.links and (open_ or not proofs):
        told = [f"{claim.id} is {claim.verdict.value}" for claim in open_] or ["there is none"]
        message = f"not every claim about the elements of {one.id} is met: {', '.join(told)}"
        hint = "prove the program, and give its record with `--record FILE`"
        yield error(NO_PROOF, one.origin, message, hint=hint)
