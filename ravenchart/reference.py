# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The pages about the command line that are made of the command line itself.

`python -m ravenchart.reference` writes docs/answer.schema.json, docs/evidence.schema.json,
docs/scenario.schema.json, docs/events.schema.json and docs/ravenchart.1.
"""

from __future__ import annotations

import json
from typing import Any

from . import manual
from .behaviour.interpreter.stimuli_schema import events_schema
from .command_line import COMMANDS, WITHOUT_JSON, whole_parser
from .commands.answer import FORMAT
from .commands.results import RESULTS
from .described import untitled
from .evidence.documents import Evidence
from .failures import MEANINGS
from .gen.files.reference import write
from .grammar import grammar
from .hw_can.bench.schema import scenario_schema
from .paths import ROOT, version
from .reported import Found

SCHEMA, MANUAL, EVIDENCE = "answer.schema.json", "ravenchart.1", "evidence.schema.json"
SCENARIO, EVENTS = "scenario.schema.json", "events.schema.json"


def answer_schema() -> dict[str, Any]:
    """The JSON Schema of what `--json` prints."""
    from pydantic import TypeAdapter

    adapters = [(name, "validation", TypeAdapter(of)) for name, of in RESULTS.items()]
    found = ("Found", "validation", TypeAdapter(Found))
    made, shared = TypeAdapter.json_schemas([*adapters, found])  # type: ignore[list-item]
    results = {name: made[(name, "validation")] for name in RESULTS}
    variants = [_variant(None, {"type": "null"})]
    for name in COMMANDS:
        if name in results:
            variants.append(_variant(name, {"anyOf": [results[name], {"type": "null"}]}))
        elif name not in WITHOUT_JSON:
            variants.append(_variant(name, {"type": "null"}))
    schema = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Ravenchart: the answer of a command with --json",
        "oneOf": [*variants, _figures()],
        "$defs": shared["$defs"],
    }
    plain = untitled(schema)
    assert isinstance(plain, dict)
    return plain


def evidence_schema() -> dict[str, Any]:
    """The JSON Schema of evidence.json."""
    from pydantic import TypeAdapter

    made = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        **TypeAdapter(Evidence).json_schema(),
        "title": "Ravenchart: evidence.json",
    }
    plain = untitled(made)
    assert isinstance(plain, dict)
    return plain


def _variant(command: str | None, result: dict[str, Any]) -> dict[str, Any]:
    """The object of one command; None: of a call that names no command."""
    return {
        "type": "object",
        "properties": {**_head(command), "result": result},
        "required": [*_head(command), "result"],
        "additionalProperties": False,
    }


def _figures() -> dict[str, Any]:
    """The object of `analyse`: what it found stands beside the other keys."""
    own = {"unit": {"const": "ns"}, "met": {"type": "boolean"}}
    lists = {name: {"type": "array"} for name in ("tasks", "messages", "chains")}
    properties = {**_head("analyse"), **own, "load": {"type": "object"}, **lists}
    return {
        "type": "object",
        "properties": properties,
        "required": list(properties),
        "not": {"required": ["result"]},
    }


def _head(command: str | None) -> dict[str, Any]:
    statuses = [int(one) for words in MEANINGS for one in words.split(", ")]
    return {
        "format": {"const": FORMAT, "description": "The version of this format."},
        "version": {"type": "string", "description": "The version of Ravenchart."},
        "command": {"const": command},
        "status": {"enum": statuses, "description": "The exit status."},
        "diagnostics": {
            "type": "array",
            "items": {"$ref": "#/$defs/Found"},
            "description": "Errors, warnings and notes.",
        },
    }


def pages() -> dict[str, str]:
    """File name to text of each page."""
    return {
        SCHEMA: json.dumps(answer_schema(), indent=2) + "\n",
        EVIDENCE: json.dumps(evidence_schema(), indent=2) + "\n",
        SCENARIO: json.dumps(scenario_schema(), indent=2) + "\n",
        EVENTS: json.dumps(events_schema(), indent=2) + "\n",
        MANUAL: manual.page(grammar(whole_parser()), version()),
    }


if __name__ == "__main__":
    write(ROOT / "docs", pages().items())
