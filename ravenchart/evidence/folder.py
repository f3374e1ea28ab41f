# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The folder of evidence: pages for people, and the same for programs.

Nothing in it has a date, the name of a machine or an absolute path: equal inputs give equal bytes.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path

from jinja2 import PackageLoader
from markupsafe import Markup, escape

from ravenchart.analysis.present import report
from ravenchart.analysis.present.page import environment
from ravenchart.building.checking import generated_folder
from ravenchart.gen.diagnostics import Diagnostic
from ravenchart.paths import ROOT

from . import exchange, gsn, ledger, standards
from .claim import Claim, ClaimKind, own_tool
from .claims import claims
from .documents import (
    FORMAT,
    ClaimEntry,
    ElementEntry,
    Evidence,
    Fault,
    Finding,
    Input,
    Lack,
    ProbeEntry,
    RequirementEntry,
)
from .facts import Facts
from .gaps import gaps
from .lists import Requirement
from .tracing import Traceability, claims_about, traced_requirements

INDEX, DATA, TIMING = "index.html", "evidence.json", "timing.html"
TREE, SARIF, SBOM = "claims.svg", "findings.sarif", "sbom.cdx.json"
FAULTS = ROOT / "docs" / "faults.md"
"""The fault matrix, made of the tests; not part of an installed package."""
WORDS = {
    "claim": "Claims that are not met, or only partly",
    "assumption": "Assumptions in use",
    "outside": "Parts outside SPARK",
    "given": "Bounds that rest on figures which are given, not measured",
    "test": "Tests that did not pass",
    "limit": "What no such folder shows",
}
"""The headings of what is not shown."""


@dataclass(frozen=True, slots=True)
class FolderTexts:
    """The texts of a folder, and what they say."""

    texts: Mapping[str, str]
    evidence: Evidence
    claims: tuple[Claim, ...]
    findings: tuple[Diagnostic, ...]


def default_folder(model: Path) -> Path:
    """Beside the model: `evidence`, or `evidence-NAME` of a main file `NAME.yaml`."""
    return model.parent / generated_folder(model).replace("generated", "evidence", 1)


def make(
    facts: Facts,
    requirements: Sequence[Requirement] | None = None,
    scenarios: Sequence[Path] | None = None,
) -> FolderTexts:
    """All texts of the folder."""
    found = claims(facts)
    trace = (
        None if requirements is None else traced_requirements(facts, found, requirements, scenarios)
    )
    back = trace or traced_requirements(facts, found, (), ())
    findings = (*facts.checked.diagnostics, *(trace.findings if trace else ()))
    texts = {
        TIMING: report.render_report(facts.checked.analysis),
        TREE: gsn.draw(
            facts.checked.system.name,
            facts.checked.system.digest,
            found,
            [one.id for one in ledger.in_use(facts.checked.system, facts.driver)],
        ),
        SARIF: exchange.text(exchange.sarif(findings, found)),
        SBOM: exchange.text(exchange.sbom(facts)),
    }
    names = sorted((INDEX, DATA, *texts))
    evidence = _document(facts, found, trace, back, findings, names)
    texts[DATA] = exchange.text(asdict(evidence))
    texts[INDEX] = _page(evidence, texts[TREE])
    return FolderTexts(texts, evidence, found, findings)


def _document(
    facts: Facts,
    found: Sequence[Claim],
    trace: Traceability | None,
    back: Traceability,
    findings: Sequence[Diagnostic],
    names: list[str],
) -> Evidence:
    system = facts.checked.system
    named: dict[str, list[str]] = {}
    for link in facts.links:
        for claim in claims_about(facts, link, found):
            named.setdefault(claim.id, []).extend(link.ids)
    return Evidence(
        FORMAT,
        own_tool(),
        system.name,
        [Input(*pair) for pair in facts.sources],
        system.digest,
        facts.driver,
        list(gaps(facts, found)) + _untraced(trace),
        [_claim(claim, named.get(claim.id, ())) for claim in found],
        None if trace is None else _requirements(trace),
        [
            ElementEntry(
                one.link.element,
                one.link.kind,
                str(one.link.origin),
                list(one.link.ids),
                list(one.code),
                [claim.id for claim in one.claims],
            )
            for one in back.backward
        ],
        [Finding(d.code, d.severity.value, str(d.origin), d.message) for d in findings],
        standards.standards(found, trace),
        standards.problems(),
        _faults(),
        list(facts.memory),
        [name for name in names if name != DATA],
    )


def _untraced(trace: Traceability | None) -> list[Lack]:
    if trace is None:
        return [Lack("limit", "traceability", "no list of requirements is given")]
    return [Lack("claim", one.code, one.message) for one in trace.findings]


def _claim(claim: Claim, ids: Iterable[str]) -> ClaimEntry:
    return ClaimEntry(
        claim.id,
        claim.kind.value,
        list(claim.elements),
        list(dict.fromkeys(ids)),
        claim.statement,
        claim.theorem,
        claim.method,
        claim.tool,
        claim.verdict.value,
        list(claim.reasons),
        claim.digest,
        [Input(*pair) for pair in claim.inputs],
    )


def _requirements(trace: Traceability) -> list[RequirementEntry]:
    return [
        RequirementEntry(
            one.requirement.id,
            one.requirement.text,
            [link.element for link in one.links],
            list(one.code),
            [claim.id for claim in one.claims],
            [ProbeEntry(probe.name, probe.outcome) for probe in one.probes],
        )
        for one in trace.forward
    ]


def _faults() -> list[Fault]:
    """The rows of docs/faults.md."""
    if not FAULTS.is_file():
        return []
    rows = []
    for line in FAULTS.read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split(" | ")] if line[:2] == "| " else []
        if len(cells) == 5 and (test := re.fullmatch(r"\[(.*)\]\(\.\./(.*)\)", cells[4])):
            fault, found_by, follows, within, _ = cells
            rows.append(Fault(fault, found_by, follows, within, f"{test[2]}: {test[1]}"))
    return rows


# --- Pages -----------------------------------------------------------------------


def _page(evidence: Evidence, tree: str) -> str:
    pages = environment(PackageLoader("ravenchart.evidence"))
    pages.filters |= {
        "code": _code,
        "word": _word,
        "anchor": _anchor,
        "sentence": lambda text: f"{text[:1].upper()}{text[1:]}",
    }
    counts = {word: 0 for word in ("met", "partly", "not met", "not shown", "user's")}
    for claim in evidence.claims:
        counts[claim.verdict] += 1
    return pages.get_template("evidence.html").render(
        evidence=evidence,
        tree=Markup(tree),
        counts=counts,
        kinds=[kind.value for kind in ClaimKind],
        missing=[
            (heading, listed)
            for kind, heading in WORDS.items()
            if (listed := [gap for gap in evidence.not_shown if gap.kind == kind])
        ],
        files=(TIMING, TREE, DATA, SARIF, SBOM),
    )


def _code(text: str) -> Markup:
    """Text of the ledger: what is between backticks is code, between asterisks emphasised."""
    marked = re.sub(r"`([^`]*)`", r"<code>\1</code>", str(escape(text)))
    return Markup(re.sub(r"(?<![*\w])\*([^*<>]+)\*", r"<em>\1</em>", marked))


def _word(verdict: str) -> str:
    """The class of a verdict in the style sheet."""
    return {"met": "good", "partly": "some", "user's": "soft"}.get(verdict, "bad")


def _anchor(id_: str) -> str:
    return re.sub(r"[^A-Za-z0-9_.-]", "_", id_)


# --- On disk ---------------------------------------------------------------------


def write(folder: Path, made: FolderTexts) -> None:
    """Write the folder; files of an earlier one that are no longer made go."""
    remove(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in made.texts.items():
        (folder / name).write_text(text, encoding="utf-8")


def remove(folder: Path) -> None:
    """Delete what an earlier run wrote there, and nothing else."""
    data = folder / DATA
    if not data.is_file():
        return
    with suppress(ValueError, KeyError, TypeError):
        for name in json.loads(data.read_text(encoding="utf-8"))["files"]:
            if isinstance(name, str) and re.fullmatch(r"[a-z_]+(\.[a-z]+)+", name):
                (folder / name).unlink(missing_ok=True)
    data.unlink()
