# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Arrays of instances written out, before any name is looked up.

In the trees of the files an array becomes its elements, and an entry or item whose references have
stars becomes one for each element. So no later stage knows of arrays. Each element keeps the
location of its array, and each entry that of the entry with the star.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.origins import Origin

from .arrays import ALL, ArrayNames, InstanceArray, InstanceLevel, StarNames
from .copies import ListCopy, TreeCopy
from .forms import check
from .located import Map, Seq
from .schema import ModelFile

LISTED = (
    *(
        "activities",
        "on_deadline_miss",
        "on_overrun",
        "on_silence",
        "array",
        "facade",
        "raises",
        "to",
    ),
    *("on_error_passive", "on_bus_off", "on_recovered", "on", "on_error"),
)
"""The keys of lists, outside of components, whose items may have stars."""

PROVIDERS = ("array", "facade")
"""Those whose items may also name numbered interfaces and devices."""

SINGLE = ("released_by", "from")
"""The keys of messages and processors that name one thing."""

JOINED = {"connections": ("ports",), "bindings": ("requires", "provides", "devices")}
"""Lists whose items have two ends, and the sections with the names that such an end may number."""


@dataclass(frozen=True, slots=True)
class WrittenOut:
    """The forms of a model without arrays, the arrays, and what is wrong with them."""

    forms: tuple[ModelFile, ...]
    arrays: tuple[InstanceArray, ...]
    found: tuple[Diagnostic, ...]


def written_out(forms: Sequence[ModelFile], *, whole: bool) -> WrittenOut:
    """The files of a model with each array as its elements.

    A file without arrays and stars stays the same object. ``whole`` tells that all files could be
    read: otherwise an array may be declared in a file that is missing.
    """
    names = ArrayNames.of([form.tree for form in forms], whole=whole)
    made: list[ModelFile] = []
    for form in forms:
        tree = _file(form.tree, names)
        plain, found = (form, []) if tree is form.tree else check(tree)
        for one in found:  # of all elements that are too long, the first is enough
            if all((one.code, one.origin) != (other.code, other.origin) for other in names.found):
                names.found.append(one)
        made.append(plain or form)
    return WrittenOut(tuple(made), names.arrays, tuple(dict.fromkeys(names.found)))


def _file(tree: Map, names: ArrayNames) -> Map:
    """The tree of a file without arrays."""
    made = TreeCopy(tree)
    components = tree.get("components")
    if isinstance(components, Map):
        inside = TreeCopy(components)
        for name, form in components.items():
            if isinstance(form, Map):
                inside.put(name, _joined(form, names.components[name.lower()], names))
        made.put("components", inside.tree)
    for section in ("buses", "messages", "processors", "devices", "shutdown"):
        if isinstance(given := tree.get(section), Map):
            made.put(section, _lists(given, names))
    if isinstance(chains := tree.get("chains"), Map):
        made.put("chains", _chains(chains, names))
    if isinstance(record := tree.get("record"), Seq):
        made.put("record", _items(record, names))
    return _joined(made.tree, names.top, names)


def _joined(given: Map, level: InstanceLevel, names: ArrayNames) -> Map:
    """The instances of a level, and what joins them, in the tree that holds them."""
    made = TreeCopy(given)
    instances = given.get("instances")
    if isinstance(instances, Map):
        made.put("instances", _instances(instances, level, names))
    for section, numbered in JOINED.items():
        joins = given.get(section)
        if isinstance(joins, Seq):
            made.put(section, _joins(joins, level, names, numbered))
    return made.tree


# --- Instances -------------------------------------------------------------------------


def _instances(given: Map, level: InstanceLevel, names: ArrayNames) -> Map:
    made = TreeCopy(given)
    for name, form in given.items():
        if not isinstance(form, Map):
            continue
        at, array = given.keys_at[name], level.arrays.get(name.lower())
        if array is None or "count" not in form:
            plain = _element(name, form, None, names)
            if "count" in form.dropped:  # nothing refers to it, so only its own form is looked at
                made.split(name, {f"{name}_1": plain})
            else:
                made.put(name, plain)
            continue
        first = level.declared.get(name.lower(), array.origin)
        if first != at:
            _clash(f"`{name}`", at, first, names)
        elements: dict[str, object] = {}
        for number, element in enumerate(array.elements if array.origin == at else ()):
            other = level.declared.get(element.lower())
            if other is not None:
                _clash(f"`{element}`, an element of the array {name}", at, other, names)
            else:
                elements[element] = _element(name, form, number, names)
        made.split(name, elements)
    return made.tree


def _clash(what: str, at: Origin, other: Origin, names: ArrayNames) -> None:
    notes = [(other, "the other is here")]
    message = f"a second instance is named {what}"
    names.found.append(error("RV-0303", at, message, notes=notes, hint="rename one of them"))


def _element(name: str, form: Map, number: int | None, names: ArrayNames) -> Map:
    """An instance: the element of that number, counted from 0, or one that is no array."""
    made = TreeCopy(form)
    made.drop("count")
    given = form.get("parameters")
    if not isinstance(given, Map):
        return made.tree
    values = TreeCopy(given)
    for key, value in given.items():
        if not isinstance(value, Seq):
            continue
        at, count = given.values_at[key].origin, form.get("count")
        if number is not None and len(value) == count:
            values.put(key, value[number], value.items_at[number])
            continue
        if number is not None and not value.damaged:
            message = f"`{key}` has {len(value)} values, but {name} has {count} elements"
            hint = "give one value for each element, or one for all of them without a list"
            names.error("RV-0209", at, message, hint)
        elif number is None and "count" not in form.dropped:
            message = f"`{key}` must be a single value, not a list: {name} is no array"
            names.error("RV-0203", at, message, f"give {name} the key `count`, or one value")
        values.lose(key)
    made.put("parameters", values.tree)
    return made.tree


# --- What has references ----------------------------------------------------------------


def _joins(given: Seq, level: InstanceLevel, names: ArrayNames, numbered: tuple[str, ...]) -> Seq:
    """Connections or bindings, one for each element."""
    made = ListCopy(given)
    for number, form in enumerate(given):
        if isinstance(form, Map):
            found = _join(form, level, names, numbered)
            if found is None:
                made.lose(number)
            elif found != [form]:
                made.put(number, list(found))
    return made.sequence()


def _join(
    form: Map, level: InstanceLevel, names: ArrayNames, numbered: tuple[str, ...]
) -> list[Map] | None:
    """The connections or bindings that one stands for; None where that cannot be known.

    An array that one interface of the model is bound to stays together, as a list.
    """
    whole, keys = form, ["from", "to"]
    if isinstance(listed := form["to"], Seq):
        copied = TreeCopy(form)
        copied.put("to", _items(listed, names, numbered))
        whole, keys = copied.tree, ["from"]
    texts = {key: str(form[key]) for key in keys}
    places = {key: form.values_at[key].origin for key in keys}
    ends = {key: names.names(texts[key], places[key], level, numbered) for key in keys}
    size = names.size((texts[key], places[key], end) for key, end in ends.items())
    if size is None:
        return None
    first, last = ends["from"], ends.get("to")
    gathers = numbered is JOINED["bindings"] and level is names.top
    if gathers and last and last.has_star and not last.fits and first and not first.has_star:
        items, made = Seq(places["to"]), TreeCopy(form)
        items += last.names
        items.items_at += [form.values_at["to"]] * len(items)
        made.put("to", items)
        return [made.tree]
    if any(end is not None and end.has_star for end in ends.values()):
        return [_with(whole, ends, element) for element in range(size)]
    return [whole]


def _with(form: Map, ends: dict[str, StarNames | None], number: int) -> Map:
    """A connection or binding of one element."""
    made = TreeCopy(form)
    for key, names in ends.items():
        if names is not None:
            made.put(key, names.at(number))
    return made.tree


def _chains(given: Map, names: ArrayNames) -> Map:
    """Chains, one for each element of the arrays on their ways."""
    made = TreeCopy(given)
    known = {name.lower() for name in given}
    for name, form in given.items():
        path = form.get("path") if isinstance(form, Map) else None
        if not isinstance(form, Map) or not isinstance(path, Seq):
            continue
        texts = [str(text) for text in path]
        places = [place.origin for place in path.items_at]
        parts = [names.names(*one, names.top) for one in zip(texts, places, strict=True)]
        size = names.size(zip(texts, places, parts, strict=True))
        if size is None:
            made.lose(name)
            continue
        if not any(part is not None and part.has_star for part in parts):
            continue
        chains: dict[str, object] = {}
        for number in range(size):
            own = f"{name}_{number + 1}"
            if own.lower() in known:
                message = f"a second chain is named `{own}`, one of {size} that `{name}` stands for"
                names.error("RV-0303", given.keys_at[name], message, "rename one of them")
                continue
            way = ListCopy(path)
            for place, part in enumerate(parts):
                way.put(place, [] if part is None else [part.at(number)])
            chain = TreeCopy(form)
            chain.put("path", way.sequence())
            chains[own] = chain.tree
        made.split(name, chains)
    return made.tree


def _lists(given: Map, names: ArrayNames) -> Map:
    """A mapping with an item for each element in all lists of references inside."""
    made = TreeCopy(given)
    for key, value in given.items():
        if key in LISTED and isinstance(value, Seq):
            numbered = JOINED["bindings"] if key in PROVIDERS else ()
            made.put(key, _items(value, names, numbered))
        elif key == "phases" and isinstance(value, Map):
            made.put(key, _keys(value, names))
        elif isinstance(value, Map) and key != "signals":
            made.put(key, _lists(value, names))
        elif key == "to" and isinstance(value, str) and ALL in value:
            items = Seq(given.values_at[key].origin)
            items.append(value)
            items.items_at.append(given.values_at[key])
            made.put(key, _items(items, names))
        elif key in SINGLE and isinstance(value, str) and "*" in value:
            message = f"`{value}` stands for several elements, but `{key}` takes one"
            hint = "name one element: write its number in place of the star"
            names.error("RV-0306", given.values_at[key].origin, message, hint)
            made.lose(key)
    return made.tree


def _keys(given: Map, names: ArrayNames) -> Map:
    """A mapping whose keys are references, with an entry for each element."""
    made = TreeCopy(given)
    for key, value in given.items():
        found = names.names(key, given.keys_at[key], names.top)
        if found is None:
            made.lose(key)
        elif found.has_star:
            made.split(key, dict.fromkeys(found.names, value))
    return made.tree


def _items(given: Seq, names: ArrayNames, numbered: tuple[str, ...] = ()) -> Seq:
    """A list of references, with an item for each element."""
    made = ListCopy(given)
    for number, text in enumerate(given):
        if not isinstance(text, str):
            continue
        found = names.names(text, given.items_at[number].origin, names.top, numbered)
        if found is None:
            made.lose(number)
        elif found.has_star:
            made.put(number, list(found.names))
    return made.sequence()
