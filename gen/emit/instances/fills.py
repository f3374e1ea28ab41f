# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""How many events wait in the queues of an instance: read by the report alone."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.emit.ada.declarations import Decl, Param, Subprogram
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.statements import Comment, do
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.statechart import Region

from .site import Site

FILL = ref("Ravenchart.Queueing.Fill")


def queued_regions(component: Component) -> tuple[Region, ...]:
    """The regions that have a queue of events."""
    return tuple(region for region in component.regions if region.events())


def read_name(region: Region) -> str:
    """The procedure of an instance that reads the fill of a region's queue."""
    return f"Read_{ada_case(region.name)}_Fill"


def fill_specs(site: Site) -> Iterator[Decl]:
    """These procedures."""
    for region in queued_regions(site.instance.component):
        yield Subprogram(read_name(region), _FOUND)
        element = f"{site.instance.name}.{region.name}"
        yield Comment(
            f"[{element}.queue] the number of waiting events; called by the main program."
        )


def fill_bodies(site: Site) -> Iterator[Decl]:
    """Their bodies."""
    for region in queued_regions(site.instance.component):
        read = do(ref(f"{ada_case(region.name)}_Queue", "Read_Fill"), ref("Found"))
        yield Subprogram(read_name(region), _FOUND, body=(read,))


_FOUND = (Param("Found", "out", FILL),)
