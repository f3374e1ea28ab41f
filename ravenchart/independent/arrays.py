# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Arrays of instances, counted out: an instance for each element, a reference for each star.

Follows docs/arrays.md. A model that does not fit together is unusable.
"""

from __future__ import annotations

from dataclasses import replace

from .findings import UnusableError
from .model import Items, Mapping, Model, Text, Value

NUMBERED = {"connections": ("ports",), "bindings": ("requires", "provides", "devices")}
"""The lists of pairs, and where the names stand that may be numbered there."""

REFERRING = ("buses", "messages", "processors", "devices", "shutdown")


def counted_out(model: Model) -> Model:
    """The model with the elements of its arrays in their places."""
    counting = _Counting(model)
    top = counting.level(model.top)
    components = _same(model.section("components"))
    for name, form in components.maps():
        components[name] = counting.level(form)
    top["components"] = components
    for section in REFERRING:
        if section in top:
            top[section] = counting.lists(model.section(section))
    if "record" in top:
        top["record"] = counting.items(model.top["record"], model.top)
    return replace(model, top=top)


def _same(form: Mapping) -> Mapping:
    """A copy."""
    made = Mapping(form)
    made.file, made.line = form.file, form.line
    return made


def _put(form: Mapping, key: str, words: str) -> None:
    """Another text at a key."""
    text = Text(words)
    text.file, text.line = form.file, form.line
    form[key] = text


class _Counting:
    """The arrays of a model, and of each component inside it."""

    def __init__(self, model: Model) -> None:
        self.model = model

    def level(self, form: Mapping) -> Mapping:
        """The model or a component with its instances counted out, and what joins these."""
        made = _same(form)
        if "instances" in form:
            made["instances"] = self._instances(form.map("instances"))
        for section, numbered in NUMBERED.items():
            pairs = form.get(section)
            if isinstance(pairs, Items):
                made[section] = Items(
                    one
                    for pair in pairs
                    if isinstance(pair, Mapping)
                    for one in self._pairs(pair, form, numbered)
                )
        return made

    def _instances(self, forms: Mapping) -> Mapping:
        made = _same(forms)
        made.clear()
        for name, form in forms.maps():
            count = form.number("count", 0)
            for number in range(1, count + 1):
                made[f"{name}_{number}"] = self._instance(form, number)
            if not count:
                made[name] = form
        return made

    @staticmethod
    def _instance(form: Mapping, number: int) -> Mapping:
        made = _same(form)
        del made["count"]
        if "parameters" in form:
            given = _same(form.map("parameters"))
            for key, value in given.items():
                if isinstance(value, Items):
                    given[key] = value[number - 1]
            made["parameters"] = given
        return made

    def _pairs(self, pair: Mapping, around: Mapping, numbered: tuple[str, ...]) -> list[Mapping]:
        """A connection or binding for each element; a list of providers stays one."""
        keys = ["from", "to"]
        binds = numbered is NUMBERED["bindings"] and around is self.model.top
        one_for_all = "*" in str(pair.get("to", "")) and "*" not in (pair.text("from") or "")
        if isinstance(pair.get("to"), Items) or (binds and one_for_all):
            keys, pair = ["from"], _same(pair)
            pair["to"] = self.items(pair["to"], pair, numbered)
        ends = {key: self.names(pair.text(key) or "", around, numbered) for key in keys}
        made = []
        for number in range(_size(list(ends.values()), pair)):
            one = _same(pair)
            for key, names in ends.items():
                _put(one, key, names[number if len(names) > 1 else 0])
            made.append(one)
        return made

    def names(self, text: str, around: Mapping, numbered: tuple[str, ...] = ()) -> list[str]:
        """The names that a reference stands for; it begins with an instance of ``around``."""
        heads: list[tuple[str, Mapping | None]] = [("", around)]
        *owners, last = text.split(".")
        for word in owners:
            heads = [
                (f"{head}{name}.", inner)
                for head, level in heads
                for name, inner in self._elements(word, level)
            ]
        if not last.endswith("_*"):
            return [head + last for head, _ in heads]
        made: list[str] = []
        for head, level in heads:
            known = {
                name.lower()
                for section in numbered
                for name in (() if level is None else level.map(section))
            }
            number = 1
            while f"{last[:-1]}{number}".lower() in known:
                made.append(f"{head}{last[:-1]}{number}")
                number += 1
        if not made:
            raise UnusableError(f"`{text}` stands for nothing")
        return made

    def _elements(self, word: str, level: Mapping | None) -> list[tuple[str, Mapping | None]]:
        """The instances that a part of a path stands for, each with its component."""
        forms = None if level is None else level.map("instances")
        if forms is None:
            return [(word, None)]
        if word.endswith("_*"):
            own = forms.name(word[:-2])
            count = 0 if own is None else forms.map(own).number("count", 0)
            if own is None or not count:
                raise UnusableError(f"`{word}` is no array")
            kind = self._kind(forms.map(own))
            return [(f"{own}_{number}", kind) for number in range(1, count + 1)]
        own = forms.name(word) or forms.name(word.rpartition("_")[0])
        return [(word, None if own is None else self._kind(forms.map(own)))]

    def _kind(self, instance: Mapping) -> Mapping | None:
        """The component of an instance."""
        components = self.model.section("components")
        name = components.name(instance.text("component") or "")
        return None if name is None else components.map(name)

    def lists(self, form: Mapping) -> Mapping:
        """A part of the model with a text for each element in all its lists."""
        made = _same(form)
        for key, value in form.items():
            if isinstance(value, Mapping) and key != "signals":
                made[key] = self.lists(value)
            elif isinstance(value, Items) or key == "to":
                numbered = NUMBERED["bindings"] if key in ("array", "facade") else ()
                made[key] = self.items(value, form, numbered)
        return made

    def items(self, value: Value, near: Mapping, numbered: tuple[str, ...] = ()) -> Value:
        """A list, or the text in its place, with a text for each element."""
        if isinstance(value, Text) and "*" not in value:
            return value
        made = Items()
        for item in [value] if isinstance(value, Text) else value:
            if not isinstance(item, Text) or "*" not in item:
                made.append(item)  # type: ignore[arg-type]
                continue
            for name in self.names(item, self.model.top, numbered):
                text = Text(name)
                text.file, text.line = near.file, near.line
                made.append(text)
        return made


def _size(ends: list[list[str]], near: Mapping) -> int:
    """How many elements the ends of a pair have."""
    sizes = {len(names) for names in ends if len(names) > 1}
    if len(sizes) > 1:
        raise UnusableError(f"{near.file}:{near.line}: arrays of different sizes are joined")
    return next(iter(sizes), 1)
