# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The operation of a queue by which the processor that it releases waits for a value or call."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.emit.ada.declarations import Decl, Param, Subprogram
from ravenchart.gen.emit.ada.expressions import Prefix
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.statements import Assign, Comment, do
from ravenchart.gen.model.commands import Provided
from ravenchart.gen.model.component import Port
from ravenchart.gen.model.instances import End, Requests

from .site import Site


def releases(site: Site, port: Port) -> bool:
    """Whether the values of an input port release a processor."""
    return site.system.woken_by(End(site.instance.name, port.name)) is not None


def wakes(site: Site, provided: Provided) -> bool:
    """Whether the calls of a provided interface release a processor."""
    return site.system.called(Requests(site.instance.name, provided.name)) is not None


def wait_spec(site: Site, port: Port) -> Iterator[Decl]:
    """How the processor waits for a value; in a simulation, how one asks whether it would."""
    if releases(site, port):
        yield from _specs(site, port.name, "this port until a value waits")


def wait_body(site: Site, port: Port) -> Iterator[Decl]:
    """Their bodies."""
    if releases(site, port):
        yield from _bodies(site, port.name, "Mailbox")


def call_spec(site: Site, provided: Provided) -> Iterator[Decl]:
    """The same for the calls of an interface."""
    if wakes(site, provided):
        yield from _specs(site, provided.name, "this interface until a call waits")


def call_wait(site: Site, provided: Provided) -> Iterator[Decl]:
    """Their bodies."""
    if wakes(site, provided):
        yield from _bodies(site, provided.name, "Queue")


def _specs(site: Site, name: str, until: str) -> Iterator[Decl]:
    yield Subprogram(f"Await_{ada_case(name)}")
    yield Comment(f"[{site.instance.name}.{name}] suspend the processor of {until}.")
    if site.noted:
        yield Subprogram(f"Ask_{ada_case(name)}", _ASKED)


def _bodies(site: Site, name: str, queue: str) -> Iterator[Decl]:
    own = ada_case(name)
    yield Subprogram(f"Await_{own}", body=(do(ref(f"{own}_{queue}", "Wait")),))
    if site.noted:
        empty = Assign("Waiting", Prefix("not", ref(f"{own}_{queue}", "Is_Empty")))
        yield Subprogram(f"Ask_{own}", _ASKED, body=(empty,))


_ASKED = (Param("Waiting", "out", "Boolean"),)
