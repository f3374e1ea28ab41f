# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The JSON Schema of scenarios, made of the forms that read them: for editors and other tools."""

from __future__ import annotations

from typing import Any

from pydantic import TypeAdapter

from ravenchart.described import untitled

from .forms import BUS_EVENTS, EXPECTED, DriveForm, PlantForm, TraceCheck, WholeForm
from .steps import STEPS

DRAFT = "https://json-schema.org/draft/2020-12/schema"
TITLE = "Ravenchart: a scenario"


def scenario_schema() -> dict[str, Any]:
    """The schema; names of messages, regions and the like are checked with the model alone."""
    whole = WholeForm.model_json_schema()
    kinds = [
        *STEPS.values(),
        *BUS_EVENTS.values(),
        *EXPECTED.values(),
        TraceCheck,
        DriveForm,
        PlantForm,
    ]
    _, shared = TypeAdapter.json_schemas(
        [(kind.__name__, "validation", TypeAdapter(kind)) for kind in kinds]
    )

    def items(known: Any) -> dict[str, Any]:
        return {"anyOf": [{"$ref": f"#/$defs/{kind.__name__}"} for kind in known]}

    properties = whole["properties"]
    properties["steps"]["items"] = items(STEPS.values())
    properties["bus"]["items"] = items(BUS_EVENTS.values())
    properties["expect"]["items"] = items(EXPECTED.values())
    properties["expect_trace"]["items"] = {"$ref": "#/$defs/TraceCheck"}
    properties["drives"]["additionalProperties"] = {"$ref": "#/$defs/DriveForm"}
    properties["plants"]["additionalProperties"] = {"$ref": "#/$defs/PlantForm"}
    made = untitled({"$schema": DRAFT, **whole, "title": TITLE, **shared})
    assert isinstance(made, dict)
    return made
