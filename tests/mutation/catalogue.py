# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""All rules by kind, and the mutants of a generated program."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from . import fact_rules, firing_rules, model_rules, program_rules, selection_rules
from .mutants import Files, Mutant, Part, Rule, numbered


@dataclass(frozen=True, slots=True)
class Entry:
    """A rule, its kind, the files that it looks at, and in which part it breaks something."""

    kind: str
    rule: Rule
    looks_at: Callable[[str, str], bool]
    part: Part = "code"


def _region_body(name: str, text: str) -> bool:
    return name.endswith(".adb") and "procedure Fire" in text


def _region_spec(name: str, text: str) -> bool:
    return name.endswith(".ads") and "type Selection is" in text


def _ceilings(name: str, text: str) -> bool:
    return name.endswith((".ads", ".adb")) and "Ceiling => System" in text


def _spec(name: str, text: str) -> bool:
    return name.endswith(".ads") and "Timing_Certificate." in text


def _given(name: str, text: str) -> bool:
    return name.endswith((".ads", ".adb")) and "Timing_Certificate." in text


def _executing(name: str, text: str) -> bool:
    return name.endswith(".adb") and "procedure Execute (Item : Row) is" in text


def _certificate(name: str, _text: str) -> bool:
    return name.endswith("-timing_certificate.ads")


def _codecs(name: str, _text: str) -> bool:
    return name.endswith("-codecs.adb")


def _codec_spec(name: str, _text: str) -> bool:
    return name.endswith("-codecs.ads")


def _frames(name: str, text: str) -> bool:
    return name.endswith((".ads", ".adb")) and ("_Frame" in text or "function Accepts" in text)


def _model(name: str, _text: str) -> bool:
    return name.endswith(".yaml")


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
    Entry("ceiling", program_rules.ceiling, _ceilings),
    Entry("certificate", program_rules.certificate, _certificate),
    Entry("fact", fact_rules.task, _spec),
    Entry("fact", fact_rules.table, _spec),
    Entry("fact", fact_rules.bus, _given),
    Entry("fact", fact_rules.calls, _executing),
    Entry("fact", fact_rules.sums, _certificate, "declared"),
    Entry("fact", fact_rules.supposed, _certificate, "declared"),
    Entry("codec", program_rules.codec_in_code, _codecs),
    Entry("codec", program_rules.codec_declared, _codec_spec, "declared"),
    Entry("frame", program_rules.frame_in_code, _frames),
    Entry("frame", program_rules.frame_declared, _codec_spec, "declared"),
    Entry("target", model_rules.target, _model, "model"),
    Entry("source", model_rules.source, _model, "model"),
    Entry("trigger", model_rules.trigger, _model, "model"),
    Entry("guard", model_rules.guard, _model, "model"),
    Entry("history", model_rules.history, _model, "model"),
    Entry("deferral", model_rules.deferral, _model, "model"),
    Entry("time-out", model_rules.timeout, _model, "model"),
    Entry("period", model_rules.period, _model, "model"),
    Entry("certificate", model_rules.certificate, _model, "model"),
)
"""In the order of the report."""

KINDS = tuple(dict.fromkeys(e.kind for e in ENTRIES))


def mutants_of(files: Files) -> list[Mutant]:
    """Every mutant of a program, in order of rule, file and place; each text once."""
    found: dict[tuple[str, str], Mutant] = {}
    for entry in ENTRIES:
        for name in sorted(files):
            if entry.looks_at(name, files[name]):
                made = numbered(entry.kind, entry.part, name, entry.rule(name, files))
                for mutant in made:
                    found.setdefault((name, mutant.applied(files[name])), mutant)
    return list(found.values())
