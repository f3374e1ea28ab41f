# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The locations in a model's files of the elements that its drawings show.

Graphviz names each group of an SVG drawing in its ``title``. By that name, or by the name and a
text inside the group, the page finds the location of the clicked element.
"""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.building import drawings
from ravenchart.gen.draw.picture import label
from ravenchart.gen.draw.wrapping import wrapped
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.statechart import Region, Transition, TransitionKind
from ravenchart.gen.model.system import System
from ravenchart.gen.origins import Origin

Located = tuple[str, str, Origin]
"""The title of a group, a text in it ("" for the group itself), and where that stands."""


def locations(system: System, name: str) -> tuple[Located, ...]:
    """Where the elements of a drawing stand; none of a drawing that is not there."""
    if name == drawings.STRUCTURE:
        return tuple(_of_structure(system))
    found = drawings.charts(system).get(name)
    return () if found is None else tuple(_of_chart(*found))


def _of_structure(system: System) -> Iterator[Located]:
    for node in system.nodes:
        yield f"cluster node {node.name}", "", node.origin
    for bus in system.buses:
        yield f"cluster bus {bus.name}", "", bus.origin
    for instance in system.instances:
        yield instance.name, "", instance.origin
        for port in instance.component.ports:
            yield instance.name, port.name, port.origin
    for device in system.devices:
        yield f"device {device.name}", "", device.origin
    for message in system.messages:
        yield f"message {message.name}", "", message.origin
    for processor in system.processors:
        for title in (f"cluster processor {processor.name}", f"table {processor.name}"):
            yield title, "", processor.origin
        for slot in processor.slots:
            yield f"table {processor.name}", slot.element, slot.origin


def _of_chart(component: Component, region: Region) -> Iterator[Located]:
    vertices = [(state.name, state.origin) for state in region.states]
    vertices += [(one.name, one.origin) for one in region.pseudostates]
    for name, origin in vertices:
        for title in (name, f"cluster {name}", f"header {name}"):
            yield title, "", origin
    for state in region.states:
        for nested in state.regions:
            yield f"cluster {state.name} {nested.name}", "", nested.origin
    for transition in region.transitions:
        for title, line in arrow(transition):
            yield title, line, transition.origin


def arrows(region: Region) -> dict[str, list[tuple[str, str]]]:
    """Of each transition of a chart, which groups of its drawing show it, with their lines."""
    return {one.name: list(arrow(one)) for one in region.transitions}


def arrow(transition: Transition) -> Iterator[tuple[str, str]]:
    """The titles of the groups that draw a transition, with each line of its label.

    An internal transition is text inside its state; the others have groups of their own ("").
    """
    lines = wrapped(label(transition))
    if transition.kind is TransitionKind.INTERNAL:
        for line in lines:
            yield transition.source, line
            yield f"header {transition.source}", line
        return
    inside = f"{transition.source} to {transition.target}"
    for title in (inside, f"{inside} inside"):
        yield title, ""
        yield from ((title, line) for line in lines)
