# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The calls of devices by rows: their time, the tasks inside a device, the idle fallbacks.

Follows docs/devices.md. A driver works inside its caller, so its time is in the row's WCET. A
fallback that no command needs is not executed. A device that several tasks call is a protected
object. A driver works inside it for as long as its longest command takes.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from .model import Mapping, Model, Text, handler_of, quantity

EXPRESSIONS = ("guard", "when", "with", "if")


@dataclass(frozen=True, slots=True)
class Offer:
    """A command that is bound: the time of a call, and the devices in it."""

    time: int
    devices: tuple[str, ...]


class Equipment:
    """The devices of a model and the bindings to them."""

    def __init__(self, model: Model, component_of: Callable[[str], Mapping]) -> None:
        self.model, self.component_of = model, component_of
        self.devices = model.section("devices")
        self.bound: dict[tuple[str, str], list[str]] = {}
        for binding in model.bindings:
            owner, _, interface = (binding.text("from") or "").rpartition(".")
            self.bound[owner.lower(), interface.lower()] = binding.texts("to")

    def _bound(self, instance: str, interface: str, command: str) -> Offer | None:
        """A command of what an interface is bound to; None where that has none of that name."""
        providers = self.bound.get((instance.lower(), interface.lower()))
        return self._joined(providers, command) if providers else None

    def _joined(self, members: list[str], command: str) -> Offer | None:
        """A command of an array, which all its members have."""
        parts = [self._offered(member, command) for member in members]
        found = [part for part in parts if part is not None]
        if len(found) < len(parts):
            return None
        return Offer(sum(p.time for p in found), tuple(d for p in found for d in p.devices))

    def _offered(self, provider: str, command: str) -> Offer | None:
        """A command of a provider; None where it has none of that name."""
        owner, dot, interface = provider.rpartition(".")
        if dot:
            own = self.component_of(owner).map("provides")
            form = own.map(own.name(interface) or interface)
            names = [*form.texts("commands"), *form.map("published"), *form.map("events")]
            return Offer(0, ()) if command.lower() in map(str.lower, names) else None
        name = self.devices.name(provider) or provider
        form = self.devices.map(name)
        if form.text("type"):
            provides = self.kind(name).map("provides")
            key = provides.name(command)
            return None if key is None else Offer(quantity(str(provides[key])), (name,))
        if "array" in form:
            return self._joined(form.texts("array"), command)
        choose = form.map("choose")
        chosen = choose.name(command)
        members = form.texts("facade") if chosen is None else [str(choose[chosen])]
        offers = (self._offered(member, command) for member in members)
        return next((one for one in offers if one is not None), None)

    def members(self, provider: str) -> list[str]:
        """A provider, or those that a facade or an array stands for."""
        form = self.devices.map(self.devices.name(provider) or provider)
        parts = [*form.texts("facade"), *form.texts("array")]
        return [one for member in parts for one in self.members(member)] or [provider]

    def kind(self, device: str) -> Mapping:
        """The type of a piece of equipment."""
        types = self.model.section("device_types")
        text = self.devices.map(device).text("type") or ""
        return types.map(types.name(text) or text)

    def _needs(self, instance: str) -> Iterator[tuple[str, str | None, Offer | None]]:
        """Each command that an instance requires, its fallback, and what is bound to it."""
        for interface, form in self.component_of(instance).map("requires").maps():
            commands = form.map("commands")
            for command in commands or form.texts("commands"):
                offer = self._bound(instance, interface, command)
                fallback = commands.map(command).text("else") if commands else None
                yield command, fallback, offer

    def _heard(self, instance: str, row: str) -> Iterator[Offer]:
        """The events of devices that a row of an instance asks for: it handles their ports."""
        component = self.component_of(instance)
        for interface, form in component.map("requires").maps():
            for event, port in form.map("events").items():
                offer = self._bound(instance, interface, event)
                asks = handler_of(component, str(port)) == row
                if asks and offer is not None and offer.devices:
                    yield offer

    def idle(self, instance: str) -> set[str]:
        """The fallbacks of an instance, in lower case, whose commands are all bound."""
        needs = list(self._needs(instance))
        named = [(f.partition(".")[0].lower(), offer) for _, f, offer in needs if f]
        return {a for a, offer in named if offer} - {a for a, offer in named if offer is None}

    def _calls(self, instance: str, row: str) -> Iterator[tuple[Offer, int]]:
        """The bound commands that a row calls, and how often in an execution."""
        component = self.component_of(instance)
        yield from ((offer, 1) for offer in self._heard(instance, row))
        form = component.map("regions").map(row) or component.map("activities").map(row)
        steps = form.number("steps", 1)
        reads = 1
        forwarded: set[str] = set()
        for _, served in component.map("provides").maps():
            if (served.text("served_by") or "").lower() == row.lower():
                steps = reads = served.number("queue", 1)
                if form.text("body") == "forward":
                    forwarded = {one.lower() for one in served.texts("commands")}
        commands = self.model.section("commands")
        for command, _, offer in self._needs(instance):
            if offer is None or not (command.lower() in forwarded or _uses(form, command)):
                continue
            key = commands.name(command) or command
            yield offer, reads if commands.map(key).text("kind") == "read" else steps

    def time(self, instance: str, row: str) -> int:
        """The time that the calls of a row add to its WCET."""
        return sum(offer.time * times for offer, times in self._calls(instance, row))

    def called(self, instance: str, row: str) -> set[str]:
        """The pieces of equipment that a row calls."""
        return {device for offer, _ in self._calls(instance, row) for device in offer.devices}

    def section(self, device: str, least: int) -> int:
        """The longest time inside a device that several tasks call."""
        kind = self.kind(device)
        times = [quantity(str(time)) for time in kind.map("provides").values()]
        return max(least, kind.time("make_safe", 0), *times)

    def begun(self, device: str) -> bool:
        """Does the main program call it, at start or end?"""
        return any(key in self.kind(device) for key in ("initialise", "self_test", "make_safe"))


def _uses(form: Mapping, command: str) -> bool:
    """Whether a row calls or reads a command."""
    listed = (*form.texts("reads"), *form.texts("calls"))
    if command.lower() in map(str.lower, listed):
        return True
    word = re.compile(rf"(?<![\w.]){re.escape(command)}(?!\w)", re.IGNORECASE)
    return any(
        text.lower() == command.lower() if key == "call" else bool(word.search(text))
        for key, text in _expressions(form)
    )


def _expressions(value: object, inside: str = "") -> Iterator[tuple[str, str]]:
    """All expressions and calls below, with the key they stand at."""
    if isinstance(value, Mapping):
        for key, item in value.items():
            here = inside or (key if key in (*EXPRESSIONS, "call") else "")
            if key == "to" and "set" in value:
                here = "to"
            yield from _expressions(item, here)
    elif isinstance(value, list):
        for item in value:
            yield from _expressions(item, inside)
    elif isinstance(value, Text) and inside:
        yield inside, str(value)
