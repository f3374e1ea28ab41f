# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Forms read from a YAML tree: each part that does not fit becomes a located diagnostic."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from ravenchart.gen.diagnostics import Diagnostic, error, in_order, render_all
from ravenchart.gen.files.located import FormPath, Map, Seq, lines_of
from ravenchart.gen.language.names import REQUIREMENT, nearest, nearest_hint
from ravenchart.gen.origins import Origin

KEYS, VALUES, UNKNOWN, MISFIT = "RV-1302", "RV-1303", "RV-1304", "RV-1306"
"""Codes: wrong keys, a wrong value, a name that does not exist, parts that do not fit together."""

SHAPES = {
    "dict_type": "a mapping, `{key: value}`",
    "model_type": "a mapping, `{key: value}`",
    "list_type": "a list",
    "string_type": "text",
    "string_pattern_mismatch": "`owner.name`",
    "int_type": "a whole number",
    "int_parsing": "a whole number",
    "bool_type": "`true` or `false`",
    "too_short": "at least one item",
}
"""The required shape of a value, by the kind of error that pydantic reports."""

Form = TypeVar("Form", bound=BaseModel)


@dataclass(slots=True)
class Source:
    """A file as a tree, and its errors so far."""

    file: str
    text: str
    tree: Map
    found: list[Diagnostic] = field(default_factory=list)

    def at(self, path: FormPath, *, key: bool = False) -> Origin:
        """The location of a value, or its ``key``; for a missing value that of its container."""
        node: object = self.tree
        origin = self.tree.origin
        for number, part in enumerate(path):
            if isinstance(node, Map) and part in node:
                last = key and number == len(path) - 1
                origin = node.keys_at[str(part)] if last else node.values_at[str(part)].origin
                node = node[str(part)]
            elif isinstance(node, Seq) and isinstance(part, int) and part < len(node):
                origin, node = node.items_at[part].origin, node[part]
            else:
                break
        return origin

    def wrong(
        self, code: str, path: FormPath, message: str, hint: str | None = None, *, key: bool = False
    ) -> None:
        """Report an error."""
        self.found.append(error(code, self.at(path, key=key), message, hint=hint))

    def read(self, form: type[Form], value: object, path: FormPath) -> Form | None:
        """A form with the keys of a mapping; None, and diagnostics, where it does not fit."""
        try:
            return form.model_validate(value)
        except ValidationError as fault:
            items = fault.errors()
            slips = [one["loc"] for one in items if one["type"] == "extra_forbidden"]
            meant = {(*slip[:-1], nearest(str(slip[-1]), keys_of_form(form))) for slip in slips}
            for item in items:
                if item["type"] != "missing" or item["loc"] not in meant:
                    self._report(form, path, item["loc"], item["type"], item.get("ctx", {}), item)
        return None

    def _report(
        self,
        form: type[BaseModel],
        path: FormPath,
        place: Sequence[int | str],
        kind: str,
        context: object,
        item: object,
    ) -> None:
        """Report one part that does not fit, in words."""
        assert isinstance(context, dict) and isinstance(item, dict)
        names = keys_of_form(form)
        inside = self._inside((*path, *place))
        if kind == "missing":
            shown = ", ".join(f"`{name}`" for name in names)
            self.wrong(KEYS, path, f"the key `{place[-1]}` is missing", f"the keys are {shown}")
        elif kind == "extra_forbidden":
            shown = ", ".join(f"`{name}`" for name in names)
            hint = nearest_hint(str(place[-1]), names) or f"the keys here are {shown}"
            self.wrong(KEYS, inside, f"`{place[-1]}` has no place here", hint, key=True)
        else:
            name = next((part for part in reversed(inside) if isinstance(part, str)), "")
            given = item.get("input")
            found = "" if isinstance(given, dict | list) else f", not {_shown(given)}"
            told = f"`{name}` must be {self._wanted(kind, context, item)}{found}"
            self.wrong(VALUES, inside, told if name else told.replace("`` ", "this "))

    def _wanted(self, kind: str, context: dict[str, object], item: dict[str, object]) -> str:
        if kind == "string_pattern_mismatch" and context["pattern"] == REQUIREMENT:
            return "the id of a requirement such as `R-12`"
        if kind == "value_error":
            return str(context["error"])
        if kind == "literal_error":
            return str(context["expected"]).replace("'", "`").replace("True", "`true`")
        if kind == "greater_than_equal":
            return f"at least {context['ge']}"
        return SHAPES.get(kind) or str(item["msg"]).lower()

    def _inside(self, path: FormPath) -> FormPath:
        """The part of a path that the file has: pydantic adds the members of unions."""
        node: object = self.tree
        for number, part in enumerate(path):
            if isinstance(node, Map) and part in node:
                node = node[str(part)]
            elif isinstance(node, Seq) and isinstance(part, int) and part < len(node):
                node = node[part]
            else:
                return path[:number]
        return path

    def told(self) -> str:
        """All errors, in the order of the file, as compilers print them."""
        return rendered(self.found, self.file, self.text)


def rendered(found: Sequence[Diagnostic], file: str, text: str) -> str:
    """Diagnostics of one file, each once."""
    once = {(one.origin, one.message): one for one in found}
    sources = {file: lines_of(text)} if text else {}
    return render_all(in_order(once.values()), sources)


def keys_of_form(form: type[BaseModel]) -> list[str]:
    """The keys of a form, as a file has them."""
    return [one.alias or name for name, one in form.model_fields.items() if name != "req"]


def _shown(value: object) -> str:
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    return f"`{str(value)[:40]}`"
