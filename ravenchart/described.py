# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Objects that are written as JSON and described by a JSON Schema."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar


class Described:
    """A part of the object: the text below a key describes it, and there are no other keys."""

    __slots__ = ()
    __pydantic_config__: ClassVar[dict[str, Any]] = {
        "use_attribute_docstrings": True,
        "extra": "forbid",
    }


@dataclass(slots=True)
class Result(Described):
    """The result of a command."""


def untitled(node: Any) -> Any:
    """The schema without the titles and defaults that pydantic adds."""
    if isinstance(node, list):
        return [untitled(item) for item in node]
    if not isinstance(node, dict):
        return node
    return {
        name: untitled(item)
        for name, item in node.items()
        if not (name == "title" and isinstance(item, str) and not item.startswith("Ravenchart"))
        and name != "default"
    }
