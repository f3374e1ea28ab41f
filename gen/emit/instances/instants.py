# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The instants of rows that count by their releases: what they send is visible from then on.

A row knows the release of its execution without a clock, since no release is dropped or merged.
"""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.emit.ada.declarations import Decl, Object, UseType
from ravenchart.gen.emit.ada.expressions import Expr, call, number
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.statements import Assign, Comment, Stmt
from ravenchart.gen.emit.certificate.certified import CERTIFICATE, fact, offset_fact, timed_by
from ravenchart.gen.emit.certificate.terms import plus, times
from ravenchart.gen.model.component import Port
from ravenchart.gen.model.instances import End
from ravenchart.gen.model.logical import (
    LogicalLink,
    first_of,
    links_by_port,
    logical_links,
    period_of,
    timed_row,
)
from ravenchart.gen.model.system import Processor, Slot

from .site import Site

TIMES = ref("Ravenchart.Logical_Times")


def link_to(site: Site, port: Port) -> LogicalLink | None:
    """How the values of an input port become visible, where their sender decides that."""
    return links_by_port(site.system).get(End(site.instance.name, port.name))


def sends_visibly(site: Site, port: str) -> bool:
    """Whether values of an output port become visible at given instants anywhere."""
    end = End(site.instance.name, port)
    return any(one.connection.source == end for one in logical_links(site.system))


def visible_of(name: str) -> DottedName:
    """The variable of a row: from when on that is visible which its execution sends."""
    return ref(f"{ada_case(name)}_Visible")


def release_of(handler: str) -> DottedName:
    """The variable of a row that handles ports: the release of its execution."""
    return ref(f"{ada_case(handler)}_Release")


def instant_objects(site: Site) -> Iterator[Decl]:
    """These variables; the first execution of a row has its phase, from the epoch."""
    if any(_counting(site)) and not site.noted:
        yield UseType("Ravenchart.Nanoseconds")
    for slot, held, lasting in _counting(site):
        processor, _ = timed_row(site.system, slot.element)
        begin: Expr = number(first_of(processor, slot) + lasting)
        if not site.noted:
            late = times(_timed(processor, slot, "Phase"), fact(processor.name, "T"))
            terms = [late, offset_fact(site.system, processor.name)]
            begin = plus(*terms, *([fact(processor.name, "Let")] if lasting else []))
        if lasting:
            yield Comment(f"[{slot.element}] from when on that is visible which it sends")
        else:
            yield Comment(f"[{slot.element}] the release of its execution")
        yield Object(held, "Ravenchart.Nanoseconds", begin)


def next_instants(site: Site, slot: Slot) -> tuple[Stmt, ...]:
    """At the end of an execution of a row: the instant of the next one."""
    found = []
    for one, held, _ in _counting(site):
        if one.element == slot.element:
            processor, _ = timed_row(site.system, slot.element)
            period: Expr = number(period_of(processor, slot))
            if not site.noted:
                period = times(_timed(processor, slot, "Divisor"), fact(processor.name, "T"))
            found.append(Assign(held, call(ref(TIMES, "Later"), held, period)))
    return tuple(found)


def units_of_instants(site: Site) -> Iterator[DottedName]:
    """The units that the body of the instance needs for that."""
    if any(_counting(site)):
        yield TIMES
        if not site.noted:
            yield ref(ada_case(site.system.name), CERTIFICATE)


def _counting(site: Site) -> Iterator[tuple[Slot, DottedName, int]]:
    """Each row that counts: its variable, and how long after its releases that begins."""
    links = logical_links(site.system)
    for slot in site.system.slots_of(site.instance.name):
        sent = next((one for one in links if slot.element in one.rows), None)
        if sent is not None:
            yield slot, visible_of(slot.name), sent.lasting
        if any(one.handler == slot.element for one in links):
            yield slot, release_of(slot.name), 0


def _timed(processor: Processor, slot: Slot, what: str) -> DottedName:
    return fact(timed_by(processor.name, processor.slots, slot), what)
