# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The JSON Schema of event files, for editors and other tools."""

from __future__ import annotations

from typing import Any

from ravenchart.gen.language.quantities import NANOSECONDS, pattern

_TIME = {
    "description": "Counted from the epoch of the processors; not before the entry above.",
    "anyOf": [{"type": "string", "pattern": pattern(NANOSECONDS)}, {"const": 0}],
}
_SCALAR: dict[str, Any] = {"type": ["integer", "boolean", "string"]}
_VALUE = {"anyOf": [_SCALAR, {"type": "object", "additionalProperties": {"$ref": "#/$defs/Value"}}]}


def _receiver(what: str) -> dict[str, Any]:
    return {"type": "string", "pattern": r"^\w+(\.\w+)+$", "description": what}


def _entry(what: str, required: list[str], **properties: Any) -> dict[str, Any]:
    return {
        "description": what,
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": False,
    }


def events_schema() -> dict[str, Any]:
    """The schema; names and values are checked with the model alone."""
    value, at = {"$ref": "#/$defs/Value"}, {"$ref": "#/$defs/Time"}
    raised = {"raise": _receiver("instance.event"), "with": value}
    arrived = {"put": _receiver("instance.port"), "value": value}
    interrupted = {"interrupt": _receiver("node.interrupt")}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Ravenchart: an event file",
        "type": "array",
        "minItems": 1,
        "items": {
            "anyOf": [
                _entry("An event of an instance.", ["at", "raise"], at=at, **raised),
                _entry("A value for an input port.", ["at", "put", "value"], at=at, **arrived),
                _entry("An interrupt of a node.", ["at", "interrupt"], at=at, **interrupted),
                _entry("The last instant; the last entry.", ["until"], until=at),
            ]
        },
        "$defs": {"Time": _TIME, "Value": _VALUE},
    }
