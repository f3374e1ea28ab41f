# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""All rules by kind, and the mutants of a generated program."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ravenchart.gen.emit.ada.declarations import EnumType, Package, Subprogram, Unit
from ravenchart.gen.emit.ada.walking import names_in
from ravenchart.gen.emit.certificate.certified import CERTIFICATE

from . import fact_rules, firing_rules, model_rules, program_rules, selection_rules
from .mutants import Files, Mutant, Part, TextRule, UnitRule, Units, numbered


@dataclass(frozen=True, slots=True)
class Entry:
    """A rule, its kind, the units that it looks at, and in which part it breaks something."""

    kind: str
    rule: UnitRule
    looks_at: Callable[[Unit], bool]
    part: Part = "code"


def _declares(unit: Unit, kind: type[EnumType] | type[Subprogram], name: str) -> bool:
    items = unit.item.items if isinstance(unit.item, Package) else ()
    return any(isinstance(one, kind) and one.name == name for one in items)


def _region_body(unit: Unit) -> bool:
    return unit.is_body and _declares(unit, Subprogram, "Fire")


def _region_spec(unit: Unit) -> bool:
    return not unit.is_body and _declares(unit, EnumType, "Selection")


def _any(_: Unit) -> bool:
    return True


def _spec(unit: Unit) -> bool:
    return not unit.is_body and _using(unit)


def _certificate(unit: Unit) -> bool:
    return unit.name.last == CERTIFICATE


def _using(unit: Unit) -> bool:
    return any(name.first == CERTIFICATE for name in names_in(unit.item))


def _executing(unit: Unit) -> bool:
    return unit.is_body and _declares(unit, Subprogram, "Execute")


def _codecs(unit: Unit) -> bool:
    return unit.is_body and unit.name.last == "Codecs"


def _codec_spec(unit: Unit) -> bool:
    return not unit.is_body and unit.name.last == "Codecs"


ENTRIES = (
    Entry("target", firing_rules.target_in_code, _region_body),
    Entry("target", firing_rules.target_declared, _region_spec, "declared"),
    Entry("source", selection_rules.source_in_code, _region_body),
    Entry("source", selection_rules.source_declared, _region_spec, "declared"),
    Entry("trigger", selection_rules.trigger_in_code, _region_body),
    Entry("trigger", selection_rules.trigger_declared, _region_spec, "declared"),
    Entry("guard", selection_rules.guard_in_code, _region_body),
    Entry("guard", selection_rules.guard_declared, _region_spec, "declared"),
    Entry("priority", selection_rules.priority_in_code, _region_body),
    Entry("priority", selection_rules.priority_declared, _region_spec, "declared"),
    Entry("order", firing_rules.order, _region_body),
    Entry("missing action", firing_rules.missing, _region_body),
    Entry("history", firing_rules.history_in_code, _region_body),
    Entry("history", firing_rules.history_declared, _region_spec, "declared"),
    Entry("deferral", firing_rules.deferral, _region_body),
    Entry("deferral", firing_rules.deferral_declared, _region_spec, "declared"),
    Entry("time-out", firing_rules.timeout, _region_body),
    Entry("time-out", firing_rules.timeout_declared, _region_spec, "declared"),
    Entry("domain", firing_rules.domain_declared, _region_spec, "declared"),
    Entry("completion", firing_rules.completion, _region_body),
    Entry("ceiling", program_rules.ceiling, _any),
    Entry("certificate", program_rules.certificate, _certificate),
    Entry("fact", fact_rules.task, _spec),
    Entry("fact", fact_rules.table, _spec),
    Entry("fact", fact_rules.bus, _using),
    Entry("fact", fact_rules.calls, _executing),
    Entry("fact", fact_rules.sums, _certificate, "declared"),
    Entry("fact", fact_rules.supposed, _certificate, "declared"),
    Entry("codec", program_rules.codec_in_code, _codecs),
    Entry("codec", program_rules.codec_declared, _codec_spec, "declared"),
    Entry("frame", program_rules.frame_in_code, _any),
    Entry("frame", program_rules.frame_declared, _codec_spec, "declared"),
)
"""The rules over generated units, in the order of the report."""

OF_MODELS: tuple[tuple[str, TextRule], ...] = (
    ("target", model_rules.target),
    ("source", model_rules.source),
    ("trigger", model_rules.trigger),
    ("guard", model_rules.guard),
    ("history", model_rules.history),
    ("deferral", model_rules.deferral),
    ("time-out", model_rules.timeout),
    ("period", model_rules.period),
    ("certificate", model_rules.certificate),
)
"""Those over the files of models."""

KINDS = tuple(dict.fromkeys((*(e.kind for e in ENTRIES), *(kind for kind, _ in OF_MODELS))))


def mutants_of(files: Files) -> list[Mutant]:
    """Every mutant of a program, in order of rule, file and place; each text once."""
    units: Units = {n: u for n, u in sorted(files.items()) if isinstance(u, Unit)}
    texts = {n: t for n, t in sorted(files.items()) if isinstance(t, str)}
    found: dict[object, Mutant] = {}
    for entry in ENTRIES:
        for name, unit in units.items():
            if entry.looks_at(unit):
                for mutant in numbered(entry.kind, entry.part, name, entry.rule(name, units)):
                    if (changed := _changed_items(mutant, unit)) is not None:
                        found.setdefault((name, changed), mutant)
    for kind, rule in OF_MODELS:
        for name, text in texts.items():
            for mutant in numbered(kind, "model", name, rule(name, texts)):
                found.setdefault((name, mutant.applied(text)), mutant)
    return list(found.values())


def _changed_items(mutant: Mutant, unit: Unit) -> object | None:
    """The declarations of a unit that a mutant changes, by position; None where it changes none."""
    broken = mutant.broken(unit)
    assert isinstance(broken, Unit)
    if not isinstance(unit.item, Package) or not isinstance(broken.item, Package):
        return None if broken == unit else broken
    pairs = zip(unit.item.items, broken.item.items, strict=True)
    changed = tuple(
        (place, other)
        for place, (one, other) in enumerate(pairs)
        if one is not other and one != other
    )
    return changed or None
