# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Reference pages written from the tables that the loader itself uses.

`python -m ravenchart.gen.files.reference` writes docs/model.schema.json, docs/model-reference.md
and docs/errors.md.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ravenchart.gen import explanations

from .schema import ModelFile
from .schema_base import REQUIREMENTS

SCHEMA, REFERENCE, ERRORS = "model.schema.json", "model-reference.md", "errors.md"

TITLES: Mapping[str, str] = {
    "ModelFile": "A model file",
    "RangeType": "Type: an integer range",
    "ValuesType": "Type: an enumeration",
    "FieldsType": "Type: a record",
    "ComponentForm": "Component",
    "ParameterForm": "Parameter",
    "InputForm": "Port: input",
    "OutputForm": "Port: output",
    "PortRegionForm": "Port region",
    "PortGroupForm": "Group of ports",
    "EventForm": "Event",
    "DataForm": "Data item",
    "InvariantForm": "Invariant",
    "RegionForm": "Region",
    "InitialForm": "Initial transition",
    "StateForm": "State",
    "NestedRegionForm": "Region of a state",
    "TransitionForm": "Transition",
    "ActivityForm": "Activity",
    "SetForm": "Action: set",
    "SendForm": "Action: send",
    "RaiseForm": "Action: raise",
    "IfForm": "Action: if",
    "CallForm": "Action: call",
    "CommandForm": "Command",
    "RequiredForm": "Required interface",
    "NeedForm": "Required command",
    "ProvidedForm": "Provided interface",
    "ProtocolForm": "Protocol",
    "ProtocolStepForm": "Protocol: transition",
    "DeviceTypeForm": "Device type",
    "DeviceParameterForm": "Device parameter",
    "RegisterForm": "Register",
    "DeviceForm": "Device",
    "BindingForm": "Binding",
    "InnerBindingForm": "Binding inside a component",
    "NodeForm": "Node",
    "ProbeForm": "Probe",
    "SupervisionForm": "Supervision",
    "InterruptForm": "Interrupt",
    "StreamForm": "Stream",
    "TickForm": "Tick",
    "BusForm": "Bus",
    "WatchForm": "Watch of a bus",
    "DelayedForm": "Recovery of a bus: after",
    "RequestedForm": "Recovery of a bus: on",
    "ErrorsForm": "Errors of a bus",
    "InstanceForm": "Instance",
    "InnerInstanceForm": "Instance inside a component",
    "ConnectionForm": "Connection",
    "InnerConnectionForm": "Connection inside a component",
    "MessageForm": "Message",
    "SignalForm": "Signal",
    "ProtectionForm": "Protection",
    "AuthenticationForm": "Authentication",
    "TransmissionForm": "Transmission mode",
    "TransportForm": "Transport",
    "ProcessorForm": "Processor",
    "ChainForm": "Chain",
    "ShutdownForm": "Shutdown",
}
"""The forms in the order of the reference, with their headings."""

INTRODUCTION = """\
# Reference of the model language

For engineers who write models. The page lists every key, with its meaning, type and range.

Written by `make docs` from the schema that the loader checks models against; do not
edit. For editors, the same schema is in [model.schema.json](model.schema.json). The errors are
listed in [errors.md](errors.md).

A model is one YAML file and those it includes. Numbers are decimal or `0x...`, with underscores
between digits if wished; `true` and `false` are Booleans; everything else is text. Anchors,
aliases, tags and tabs are refused. Names are Ada identifiers of at most 60 characters, and case
does not count; one of more than 24 may be refused where a generated line would not fit 79 columns.
An instance inside another one is named by its path, `arm.shoulder`. In ends of connections
and bindings, and in lists, `wheel_*` stands for all elements of an [array](arrays.md).
A *duration* is a number with `ns`, `us`, `ms` or `s`, exact in nanoseconds and at
most one hour; a *size* has `B`, `KiB` or `MiB`; a *bit rate* `bit/s`, `kbit/s` or `Mbit/s`.

Every mapping of a model that is an element may have the key `req`, also a state or an action: the
list of the ids of the requirements that it implements, `req: [R-12, R-13]`. An id has letters,
digits and `- _ . : /`, at most 64. The ids change neither program nor timing;
[Evidence](evidence.md) says what is made of them. The tables below do not repeat the key.

## Expressions

Operators, loosest first: `if a then b else c`; `or`; `and`; `not`; `= /= < <= > >=`; `+ -`;
`* /`; unary `-`. Parentheses group. Functions: `abs(x)`, `min(x, y)`, `max(x, y)`,
`clamp(x, low, high)`, `fresh(port)`, `stale(port)`, `never_received(port)`, and
`in(Region.State)`. A name is a data item, a parameter or an input port of the component, or a
field of one (`order.target`). An enumeration literal takes its type from what it is compared with
or given to; where that has the literal, it goes before a name of another type. `/` rounds towards
zero.

Bounds are computed from the ranges of the types. `if`, `and` and `or` let what stands behind a
comparison use it: in `if x < 1000 then x + 1 else 0`, `x + 1` is at most 1000. The actions under
`if` use its condition too, until one of them sets the name. A value that is set or sent must
provably fit its target. A divisor must provably differ from 0, and every intermediate result must
fit 64 bits. `+ - = /= < <= > >= min max clamp if` take operands of one unit or plain numbers; of
the operands of `*` one has no unit, and so has the divisor of `/`. A comparison of constants, or of
a value with itself, is an error: its outcome never changes.

In a [contract](contracts.md) a name is something that the activity reads, writes or sends. In its
`ensures`, `old(item)` or `old(item.field)` is a data item before the execution, and `sent(port)`
says whether the execution sends on a port, or calls a command that has an argument.

In guard and effect of a transition `on` an event with a type, `event` is the value that came with
it, or `event.field` a field of it.

## Charts

Names of states, pseudostates and nested regions are all different in one region. A state with
`states` is composite and has one region; with several `regions` it is orthogonal, and all of them
are active while it is. A final state or pseudostate is declared among the states, by its `kind`,
and has no other key. A state or transition may have a name that generated code uses itself: there
its kind is added, so the transition `t` is the literal `T_Transition`.

A transition from a state has one trigger; without any it is taken when the state completes: a leaf
on entry, a composite when each of its regions is in a final state, a state with a do activity
(`while`) when that has raised `done` besides. A transition from a pseudostate is a segment: it has
no trigger, and goes on in the same step.

| kind | what it does |
| --- | --- |
| `final` | ends its region; nothing leaves it |
| `choice` | the first segment whose guard holds is taken, guards read after the effects before it |
| `junction` | joins and splits ways; all guards are read before any effect |
| `history` | enters the state of its region that was left last, by default inside |
| `deep_history` | enters what was active in its region when that was left last, at any depth |
| `fork` | enters states in different regions of one orthogonal state |
| `join` | waits until states in different regions of one orthogonal state have completed |
| `terminate` | ends the whole region, without exits |

A choice or junction tries its segments in model order, one with `guard: else` last. One segment may
leave a history: it is taken when nothing is recorded.
"""


def schema() -> dict[str, Any]:
    """The JSON Schema of model files."""
    made = ModelFile.model_json_schema(by_alias=True)
    made["$schema"] = "https://json-schema.org/draft/2020-12/schema"
    made["title"] = "Ravenchart model"
    tidied = _tidied(made)
    assert isinstance(tidied, dict)
    return tidied


def _tidied(node: Any) -> Any:
    """The schema without what says nothing: titles of keys, defaults and choices of null."""
    if isinstance(node, list):
        return [_tidied(item) for item in node]
    if not isinstance(node, dict):
        return node
    kept = {
        name: _tidied(item)
        for name, item in node.items()
        if not (name == "title" and isinstance(item, str) and not item.startswith("Ravenchart"))
        and not (name == "default" and item is None)
    }
    if "patternProperties" in kept:
        kept["additionalProperties"] = False
    choices = [one for one in kept.get("anyOf", []) if one != {"type": "null"}]
    if len(choices) < len(kept.get("anyOf", [])):
        del kept["anyOf"]
        kept |= choices[0] if len(choices) == 1 else {"anyOf": choices}
    return kept


def reference() -> str:
    """The reference page: every form with its keys."""
    made = schema()
    forms: dict[str, Any] = {"ModelFile": made, **made["$defs"]}
    parts = [INTRODUCTION]
    for name, title in TITLES.items():
        form = forms[name]
        required = form.get("required", [])
        text = form["description"].split("\n\n")[0].replace("\n", " ")
        lines = [f"## {title}", "", text, "", "| key | value | meaning |", "| --- | --- | --- |"]
        own = {key: v for key, v in form["properties"].items() if key != REQUIREMENTS}
        for key, value in own.items():
            need = " (required)" if key in required else ""
            meaning = value.get("description", "").replace("|", "\\|")
            if "default" in value:
                meaning += f" Default: `{json.dumps(value['default']).strip(chr(34))}`."
            lines.append(f"| `{key}`{need} | {_kind(value)} | {meaning} |")
        parts.append("\n".join(lines) + "\n")
    return "\n".join(parts)


def _kind(value: Mapping[str, Any]) -> str:
    """The kind of a key's value, in words."""
    if "$ref" in value:
        return _link(value["$ref"])
    if "enum" in value:
        return " or ".join(f"`{one}`" for one in value["enum"])
    if "const" in value:
        return f"`{value['const']}`"
    for choice in ("anyOf", "oneOf"):
        if choice in value:
            return " or ".join(dict.fromkeys(_kind(one) for one in value[choice]))
    kind = value.get("type")
    if kind == "array":
        return f"list of {_kind(value['items'])}"
    if kind == "object" and "patternProperties" in value:
        return f"mapping of names to {_kind(next(iter(value['patternProperties'].values())))}"
    if kind == "object":
        return f"mapping of names to {_kind(value['additionalProperties'])}"
    if kind == "integer":
        return "number"
    if kind == "boolean":
        return "`true` or `false`"
    if isinstance(kind, list):
        return "value or expression"
    return _text_kind(value.get("pattern", ""))


def _text_kind(pattern: str) -> str:
    """The kind of text that a pattern stands for."""
    for mark, word in (("ns|", "duration"), ("KiB", "size"), ("kbit", "bit rate")):
        if mark in pattern:
            return word
    if "\\." in pattern:
        return "`owner.name`" if pattern.endswith("+$") else "`name` or `owner.name`"
    return "name" if pattern else "text"


def _link(reference_: str) -> str:
    """A link to the form that a ``$ref`` names."""
    title = TITLES.get(reference_.rsplit("/", 1)[-1], reference_)
    anchor = re.sub(r"[^a-z0-9 -]", "", title.lower()).replace(" ", "-")
    return f"[{title.lower()}](#{anchor})"


def json_schema() -> str:
    """The JSON Schema of a model's files, for editors."""
    return json.dumps(schema(), indent=2, ensure_ascii=False) + "\n"


def pages() -> dict[str, str]:
    """File name to text of each page."""
    return {SCHEMA: json_schema(), REFERENCE: reference(), ERRORS: explanations.page()}


def write(directory: Path, made: Iterable[tuple[str, str]]) -> None:
    """Write the pages."""
    directory.mkdir(exist_ok=True)
    for name, text in made:
        (directory / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    write(Path(__file__).resolve().parents[2] / "docs", pages().items())
