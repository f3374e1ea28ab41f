# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Components inside components, written out: instances by their paths, and what joins these.

Follows docs/composites.md: all instances inside are on the node of the outermost one, and its
ports and interfaces are those that they lead to.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product

from .findings import UnusableError
from .model import Items, Mapping, Model, Text

LIMIT = 100_000
"""Instances at most: far more than any system has."""


def written_out(model: Model) -> Model:
    """The model with the instances inside others in the place of these."""
    if not any("instances" in form for _, form in model.section("components").maps()):
        return model
    parts = _Parts(model)
    top = _like(model.top, dict(model.top))
    top["instances"] = parts.plain
    for section in ("connections", "bindings"):
        top[section] = Items(parts.joins(section))
    for section, keys in (("messages", ("from", "to")), ("devices", ("array", "facade", "choose"))):
        top[section] = _like(model.section(section), {})
        for name, form in model.section(section).maps():
            top.map(section)[name] = parts.renamed(form, keys)
    return replace(model, top=top)


def _like(near: Mapping, entries: dict[str, Mapping | Items | Text]) -> Mapping:
    """A mapping at the place of another."""
    found = Mapping(entries)
    found.file, found.line = near.file, near.line
    return found


def _text(words: str, near: Mapping) -> Text:
    found = Text(words)
    found.file, found.line = near.file, near.line
    return found


class _Parts:
    """The instances of a model, by their paths."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self.plain = _like(model.section("instances"), {})
        """Those without others inside them."""
        self.around: dict[str, tuple[str, Mapping]] = {}
        """Those with others inside: path as declared and component, by path in lower case."""
        for name, form in model.section("instances").maps():
            self._place(name, form, form)

    def _place(self, path: str, form: Mapping, outermost: Mapping) -> None:
        components = self.model.section("components")
        kind = components.map(components.name(form.text("component") or "") or "")
        if "instances" in kind:
            self.around[path.lower()] = path, kind
            for name, inner in kind.map("instances").maps():
                self._place(f"{path}.{name}", inner, outermost)
        else:
            made = _like(form, dict(form))
            if "node" in outermost:
                made["node"] = outermost["node"]
            self.plain[path] = made
        if len(self.plain) > LIMIT:
            raise UnusableError(f"{form.file}:{form.line}: over {LIMIT:,} instances")

    def ends(self, section: str, key: str, text: str) -> list[str]:
        """The innermost ends that `instance.port` or `instance.interface` leads to.

        ``text`` is the value of `from` or `to` of a connection or binding; inside, its own name
        is at the other key.
        """
        owner, _, name = text.rpartition(".")
        if owner.lower() not in self.around:
            return [text]
        path, kind = self.around[owner.lower()]
        other = "to" if key == "from" else "from"
        return [
            end
            for form in kind.get(section, ())
            if isinstance(form, Mapping) and (form.text(other) or "").lower() == name.lower()
            for end in self.ends(section, key, f"{path}.{form.text(key)}")
        ]

    def joins(self, section: str) -> Iterator[Mapping]:
        """The connections or bindings of the system and of those inside, between instances."""
        levels = [
            ("", self.model.top),
            *((f"{path}.", kind) for path, kind in self.around.values()),
        ]
        for path, level in levels:
            for form in level.get(section, ()):
                if not isinstance(form, Mapping):
                    continue
                start, end = form.text("from") or "", form.text("to") or ""
                if path and not ("." in start and "." in end):
                    continue  # it leads from a port or interface of this level
                sources = self.ends(section, "from", path + start)
                if isinstance(form.get("to"), Items):
                    yield from self._gathered(form, sources)
                    continue
                for source, target in product(sources, self.ends(section, "to", path + end)):
                    made = _like(form, dict(form))
                    made["from"], made["to"] = _text(source, form), _text(target, form)
                    yield made

    def _gathered(self, form: Mapping, sources: list[str]) -> Iterator[Mapping]:
        """A binding of the model to several providers."""
        ends = [one for text in form.texts("to") for one in self.ends("bindings", "to", text)]
        for source in sources:
            made = _like(form, dict(form))
            made["from"], made["to"] = _text(source, form), Items(_text(one, form) for one in ends)
            yield made

    def renamed(self, form: Mapping, keys: tuple[str, ...]) -> Mapping:
        """A message or device whose references are those to what they lead to."""
        made = _like(form, dict(form))
        for key in (key for key in keys if key in form):
            section = "connections" if key in ("from", "to") else "bindings"
            end = "from" if key == "from" else "to"
            if key == "choose":
                chosen = {k: self.ends(section, end, str(v))[0] for k, v in form.map(key).items()}
                made[key] = _like(form, {k: _text(one, form) for k, one in chosen.items()})
                continue
            ends = [one for text in form.texts(key) for one in self.ends(section, end, text)]
            made[key] = Items(_text(one, form) for one in ends)
            if key == "from":
                made[key] = _text(ends[0], form)
        return made
