# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The formats of others: findings as SARIF 2.1.0, what is in the program as CycloneDX 1.6."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from ravenchart.building.programs import runtime_folders
from ravenchart.gen.diagnostics import CODES, Diagnostic
from ravenchart.paths import version
from ravenchart.tools.kept import file_digest

from . import records
from .claim import Claim, Shown
from .facts import Facts

SARIF_SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"
CLAIM_RULE = "EVIDENCE"
LICENCE = [{"license": {"id": "Apache-2.0"}}]


def text(document: object) -> str:
    """JSON, the same for the same content."""
    return json.dumps(document, indent=1, ensure_ascii=False) + "\n"


def sarif(findings: Sequence[Diagnostic], claims: Sequence[Claim]) -> dict[str, Any]:
    """Findings about model and traceability, and each claim that is not met or not shown."""
    codes = sorted({one.code for one in findings})
    rules = [{"id": code, "shortDescription": {"text": CODES[code]}} for code in codes]
    rules.append({"id": CLAIM_RULE, "shortDescription": {"text": "A claim is not met."}})
    results = [_result(one) for one in findings]
    for claim in claims:
        if claim.verdict in (Shown.NOT_MET, Shown.NOT_SHOWN):
            told = f"{claim.id} is {claim.verdict.value}: {'; '.join(claim.reasons[:3])}"
            level = "error" if claim.verdict is Shown.NOT_MET else "warning"
            results.append({"ruleId": CLAIM_RULE, "level": level, "message": {"text": told}})
    driver = {
        "name": "ravenchart",
        "version": version(),
        "rules": rules,
    }
    run = {"tool": {"driver": driver}, "columnKind": "unicodeCodePoints", "results": results}
    return {"$schema": SARIF_SCHEMA, "version": "2.1.0", "runs": [run]}


def _result(one: Diagnostic) -> dict[str, Any]:
    place = {
        "artifactLocation": {"uri": one.origin.file.replace("\\", "/"), "uriBaseId": "MODEL"},
        "region": {"startLine": one.origin.line, "startColumn": one.origin.column},
    }
    hint = "" if one.hint is None else f" ({one.hint})"
    return {
        "ruleId": one.code,
        "level": one.severity.value,
        "message": {"text": f"{one.message}{hint}"},
        "locations": [{"physicalLocation": place}],
    }


def sbom(facts: Facts) -> dict[str, Any]:
    """The components of the program; CycloneDX."""
    system = facts.checked.system
    folder = facts.checked.folder
    own = [
        _library(
            "runtime",
            "Ravenchart runtime and CAN layer",
            _files((p for place in runtime_folders(facts.driver) for p in place.glob("*")), folder),
        )
    ]
    for node in facts.programs:
        listed = [pair for pair in node.files if pair[0].endswith((*records.ADA, ".gpr"))]
        where = "of the library" if node in facts.libraries else "on"
        name = f"generated program {where} {node.name}"
        own.append(_library(f"generated-{node.name}", name, _components(listed)))
        paths = [p for p in records.own_sources(node.program) if node.program.generated not in
                 p.parents]  # fmt: skip
        if paths:
            made = _files(paths, folder)
            own.append(_users(f"user-{node.name}", f"bodies of the user {where} {node.name}", made))
    rest = {
        "type": "library",
        "bom-ref": "gnat-rts",
        "name": "GNAT run-time library (libgnat, libgnarl)",
        "description": "Its version is that of the compiler; it is not recorded here.",
    }
    refs = [one["bom-ref"] for one in own] + ["gnat-rts"]
    program = {"type": "application", "bom-ref": "program", "name": system.name}
    return {
        "bomFormat": "CycloneDX",
        "specVersion": "1.6",
        "version": 1,
        "metadata": {
            "tools": {"components": [_tool("ravenchart", version())]},
            "component": {
                **program,
                "version": system.digest,
                "description": "The version is the SHA-256 of the files of the model.",
            },
        },
        "components": [*own, rest],
        "dependencies": [{"ref": "program", "dependsOn": refs}],
    }


def _tool(name: str, of: str) -> dict[str, Any]:
    return {"type": "application", "name": name, "version": of, "licenses": LICENCE}


def _library(ref: str, name: str, parts: list[dict[str, Any]]) -> dict[str, Any]:
    head = {"type": "library", "bom-ref": ref, "name": name, "version": version()}
    return {**head, "licenses": LICENCE, "components": parts}


def _users(ref: str, name: str, parts: list[dict[str, Any]]) -> dict[str, Any]:
    return {"type": "library", "bom-ref": ref, "name": name, "components": parts}


def _files(paths: Iterable[Path], folder: Path) -> list[dict[str, Any]]:
    found = sorted(path for path in paths if path.is_file() and path.suffix in records.ADA)
    return _components((records.shown(path, folder), file_digest(path)) for path in found)


def _components(pairs: Iterable[tuple[str, str]]) -> list[dict[str, Any]]:
    return [
        {"type": "file", "name": name, "hashes": [{"alg": "SHA-256", "content": digest}]}
        for name, digest in pairs
    ]
