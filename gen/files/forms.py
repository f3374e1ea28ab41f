# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""From a tree to checked forms, with every mistake of form reported at once.

A wrong value is taken out of the tree, so that the rest can be checked. The value
leaves its name behind, so that its uses are not reported too.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.language.names import nearest, nearest_hint
from ravenchart.gen.origins import Origin

from .located import FormPath, Map, Seq, scalar_value
from .schema import ModelFile
from .schema_base import REQUIREMENTS

ELSEWHERE: dict[str, str] = (
    {
        name: "declare a vertex of that kind under `states`: `Name: {kind: ...}`"
        for name in ("choice", "choices", "junction", "fork", "join", "final", "terminate")
    }
    | {
        name: "declare it under the `states` it restores: `Name: {kind: history}` or `deep_history`"
        for name in ("history", "shallow_history", "deep_history")
    }
    | {
        "completion": "a transition without a trigger is taken when its source completes",
        "trigger": "write the trigger as `on`, `after`, `every` or `when`",
        "event": "write the trigger as `on`",
        "target": "write the target as `to`",
        "source": "write the source as `from`",
        "do": "write an activity with `while: Region.State`",
        "parallel": "write the regions of an orthogonal state under `regions`",
    }
)
"""Keys that people know from other tools, with how that is written here."""

KINDS = {
    "int_type": ("RV-0203", "must be a whole number"),
    "int_parsing_size": ("RV-0204", "is too large a number"),
    "bool_type": ("RV-0203", "must be `true` or `false`"),
    "string_type": ("RV-0203", "must be text"),
    "list_type": ("RV-0203", "must be a list"),
    "dict_type": ("RV-0203", "must be a mapping"),
    "model_type": ("RV-0203", "must be a mapping"),
    "model_attributes_type": ("RV-0203", "must be a mapping"),
}


def check(tree: Map) -> tuple[ModelFile | None, list[Diagnostic]]:
    """The file's form without its wrong values, and the errors."""
    found: list[Diagnostic] = []
    removed: set[int] = set()
    while True:
        read = _read(tree)
        if isinstance(read, ModelFile):
            return read, found
        paths: set[FormPath] = set()
        _mark_misspelt(tree, read)
        for item in read:
            place = ErrorPlace(tree, item["loc"])
            if not place.follows_from(removed, item["type"]):
                found.append(place.diagnostic(item))
            paths.add(place.path)
        if () in paths or not _remove(tree, paths, removed):
            return None, found


def _mark_misspelt(tree: Map, read: Iterable[ErrorDetails]) -> None:
    """A key beside which an unknown one reads as a slip of it counts as taken out."""
    for item in read:
        place = ErrorPlace(tree, item["loc"])
        if item["type"] == "extra_forbidden" and isinstance(place.container, Map):
            near = nearest(str(item["loc"][-1]), _allowed(item["loc"]))
            if near is not None and near not in place.container:
                place.container.dropped[near] = None


def _read(tree: Map) -> ModelFile | list[ErrorDetails]:
    """The file's form, or all in which the tree is none."""
    try:
        return ModelFile.model_validate(tree)
    except ValidationError as problem:
        return problem.errors(include_url=False)


def _holds(value: object, step: str | int) -> bool:
    """Whether a step of a path leads on from there."""
    if isinstance(value, Map):
        return step in value
    return isinstance(value, Seq) and isinstance(step, int) and step < len(value)


class ErrorPlace:
    """Where in a tree one of pydantic's errors is, given its ``loc``."""

    def __init__(self, tree: Map, loc: tuple[int | str, ...]) -> None:
        """Follow ``loc`` as far as the tree goes; tags of unions are stepped over."""
        self.value: object = tree
        self.container: Map | Seq | None = None
        path: list[str | int] = []
        self.missing: str | None = None
        self.is_key = bool(loc) and loc[-1] == "[key]"
        for step in loc[:-1] if self.is_key else loc:
            inside: Any = self.value
            if _holds(inside, step):
                self.container, self.value = inside, inside[step]
                path.append(step)
            elif isinstance(step, str) and not step.startswith("<"):
                self.missing = step
        self.path: FormPath = tuple(path)

    def follows_from(self, removed: set[int], kind: str) -> bool:
        """Whether the error is there only because something inside was taken out."""
        if kind == "missing" and isinstance(self.value, Map):
            return self.missing in self.value.dropped
        if kind == "too_short" and isinstance(self.value, Seq) and self.value.damaged:
            return True  # also where an earlier look took it out: see `expansion`
        if kind in ("too_short", "choice", "shape"):
            return id(self.value) in removed
        return False

    @property
    def origin(self) -> Origin:
        """Where the value stands, or the key when that is what is wrong."""
        last = self.path[-1] if self.path else None
        if isinstance(self.container, Map) and isinstance(last, str):
            if self.is_key or isinstance(self.value, Map):
                return self.container.keys_at[last]
            return self.container.values_at[last].origin
        if isinstance(self.container, Seq) and isinstance(last, int):
            return self.container.items_at[last].origin
        return self.value.origin if isinstance(self.value, Map | Seq) else Origin("", 1, 1)

    @property
    def subject(self) -> str:
        """How the value is called in a message."""
        if not self.path:
            return "the file"
        if isinstance(self.path[-1], str):
            return f"`{self.path[-1]}`"
        named = [step for step in self.path if isinstance(step, str)]
        return f"item {self.path[-1] + 1} of `{named[-1]}`" if named else "the item"

    def diagnostic(self, item: Any) -> Diagnostic:
        """The error in our words."""
        kind, context = item["type"], item.get("ctx", {})
        if kind == "coded":
            return error(context["code"], self.origin, context["message"])
        if kind == "required":
            message = f"{self.subject} {context['message']}{self._but()}"
            return error(context["code"], self.origin, message)
        if kind == "choice":
            return error("RV-0202", self.origin, item["msg"], hint=self._typing_hint())
        if kind == "shape":
            return error("RV-0203", self.origin, f"{self.subject} {item['msg']}{self._but()}")
        if kind == "missing":
            message = f"{self.subject} needs the key `{self.missing}`"
            return error("RV-0202", self.origin, message)
        if kind == "extra_forbidden":
            return self._unknown(_allowed(item["loc"]))
        if kind == "literal_error":
            words = context["expected"].replace("'", "`")
            words += " or a list of actions" if words == "`user`" else ""
            return error("RV-0208", self.origin, f"{self.subject} must be {words}{self._but()}")
        if kind in ("greater_than_equal", "less_than_equal"):
            bound = f"at least {context['ge']}" if "ge" in context else f"at most {context['le']}"
            return error("RV-0204", self.origin, f"{self.subject} must be {bound}{self._but()}")
        if kind in ("too_short", "too_long"):
            least, most = context.get("min_length"), context.get("max_length")
            bound = f"at least {least}" if kind == "too_short" else f"at most {most}"
            count = context.get("actual_length") or len(self.value)  # type: ignore[arg-type]
            noun = "element" if bound.endswith(" 1") else "elements"
            message = f"{self.subject} must have {bound} {noun}, not {count}"
            return error("RV-0209", self.origin, message)
        if kind == "string_too_long":
            message = f"{self.subject} must have at most {context['max_length']} characters"
            return error("RV-0204", self.origin, message)
        code, words = KINDS.get(kind, ("RV-0203", "has a wrong value"))
        quoted = isinstance(self.value, str) and not isinstance(scalar_value(self.value), str)
        if kind in ("int_type", "bool_type") and quoted:
            message = f"{self.subject} {words}, not the text `{self.value}`"
            return error(code, self.origin, message, hint="write it without quotes")
        return error(code, self.origin, f"{self.subject} {words}{self._but()}")

    def _but(self) -> str:
        """The kind or text of the value that stands there instead."""
        if isinstance(self.value, Map):
            return ", not a mapping"
        if isinstance(self.value, Seq):
            return ", not a list"
        if self.value == "":
            return ", but is empty"
        if isinstance(self.value, bool):
            return f", not `{str(self.value).lower()}`"
        text = str(self.value)
        return f", not `{text if len(text) <= 40 else text[:37] + '...'}`"

    def _typing_hint(self) -> str | None:
        """The nearest allowed key, where a mapping has none of those it needs."""
        if not isinstance(self.value, Map) or not self.value:
            return None
        for name in self.value:
            hint = nearest_hint(name, SHAPES)
            if hint is not None and name not in SHAPES:
                return hint
        return None

    def _unknown(self, allowed: list[str]) -> Diagnostic:
        """An unknown key, with what may be written instead."""
        name = str(self.path[-1]) if self.path else ""
        origin = self.origin
        if isinstance(self.container, Map) and name in self.container.keys_at:
            origin = self.container.keys_at[name]
        if name.lower() in ELSEWHERE and {"initial", "from"} & set(allowed):
            message = f"the key `{name}` is unknown here"
            hint = f"{ELSEWHERE[name.lower()]}; the keys here: {', '.join(allowed)}"
            return error("RV-0201", origin, message, hint=hint)
        if "(" in name or ")" in name or " " in name:
            hint = "inside { }, put an expression that has a comma into quotes"
            return error("RV-0201", origin, f"the key `{name}` is unknown here", hint=hint)
        near = nearest_hint(name, [*allowed, REQUIREMENTS])
        listed = f"the keys here: {', '.join(allowed)}"
        hint = f"{near} {listed}" if near else listed
        return error("RV-0201", origin, f"the key `{name}` is unknown here", hint=hint)


def keys_beside(tree: Map, key: str) -> dict[str, str]:
    """The keys that could stand where an unknown one does, each with what it means."""
    read = _read(tree)
    found: dict[str, str] = {}
    for item in () if isinstance(read, ModelFile) else read:
        if item["type"] == "extra_forbidden" and item["loc"][-1] == key:
            found |= _meanings(item["loc"][:-1])
        elif item["type"] == "choice":
            value = ErrorPlace(tree, item["loc"]).value
            if isinstance(value, Map) and key in value:
                found |= dict.fromkeys(re.findall(r"`(\w+)`", item["msg"]), "")
    return found


def words_for(tree: Map, value: str) -> tuple[str, ...]:
    """The words of which one could stand where an unknown one does."""
    read = _read(tree)
    return tuple(
        word
        for item in (() if isinstance(read, ModelFile) else read)
        if item["type"] == "literal_error" and item["input"] == value
        for word in re.findall(r"'(\w+)'", item["ctx"]["expected"])
    )


def _meanings(loc: Iterable[str | int]) -> dict[str, str]:
    """The keys of the form to which pydantic's ``loc`` leads, each with what it means."""
    form = _form_at(ModelFile, list(loc))
    if form is None:
        return {}
    return {f.alias or name: f.description or "" for name, f in form.model_fields.items()}


SHAPES = ("range", "values", "fields", "set", "send", "call", "raise", "if", "in", "out")
"""The keys by which a form is chosen."""


def _allowed(loc: Iterable[str | int]) -> list[str]:
    """The keys that the form at the end of ``loc``, without its last step, may have.

    Without `req`, which every form may have.
    """
    form = _form_at(ModelFile, list(loc)[:-1])
    if form is None:
        return []
    return [f.alias or name for name, f in form.model_fields.items() if name != REQUIREMENTS]


def _form_at(form: type[BaseModel], steps: list[str | int]) -> type[BaseModel] | None:
    """The form that a path of pydantic's leads to."""
    kind: Any = form
    for step in steps:
        if isinstance(kind, type) and issubclass(kind, BaseModel):
            kind.model_rebuild()  # forms inside each other; nothing where it is complete
            fields = {f.alias or name: f for name, f in kind.model_fields.items()}
            if step not in fields:
                return None
            kind = fields[str(step)].annotation
            kind = _without_none(kind)
        elif isinstance(step, str) and step.startswith("<"):
            kind = _tagged(kind, step)
        else:
            kind = _element(kind)
    return kind if isinstance(kind, type) and issubclass(kind, BaseModel) else None


def _without_none(kind: Any) -> Any:
    """``X`` for ``X | None``."""
    arguments = getattr(kind, "__args__", ())
    others = [item for item in arguments if item is not type(None)]
    return others[0] if len(others) == 1 and len(arguments) == 2 else kind


def _element(kind: Any) -> Any:
    """The element of a list or the value of a mapping."""
    arguments = getattr(kind, "__args__", ())
    return arguments[-1] if arguments else None


def _tagged(kind: Any, tag: str) -> Any:
    """The member of a union that has that tag."""
    for _ in range(2):
        for member in getattr(kind, "__args__", ()):
            metadata = getattr(member, "__metadata__", ())
            if any(getattr(item, "tag", None) == tag for item in metadata):
                return member.__args__[0] if hasattr(member, "__args__") else member
        kind = getattr(kind, "__origin__", kind)
    return None


def _remove(tree: Map, paths: set[FormPath], removed: set[int]) -> bool:
    """Take the values at these paths out, later items first; whether any was there."""
    outermost = [p for p in paths if not any(p[:n] in paths for n in range(len(p)))]
    any_gone = False
    for path in sorted(outermost, key=lambda p: [(str(type(s)), s) for s in p], reverse=True):
        inside: Any = tree
        chain: list[Map | Seq] = []
        for step in path[:-1]:
            if _holds(inside, step):
                chain.append(inside)
                inside = inside[step]
        last = path[-1]
        if not _holds(inside, last):
            continue
        del inside[last]
        if isinstance(inside, Map):
            inside.dropped[str(last)] = None
        else:
            del inside.items_at[last]
        removed.add(id(inside))
        any_gone = True
        for container in (*chain, inside):
            container.damaged = True
    return any_gone
