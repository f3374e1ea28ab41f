# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The operation of a queued port by which the processor that it releases waits for a value."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.emit.ada.declarations import Decl, Param, Subprogram
from ravenchart.gen.emit.ada.expressions import Prefix
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.statements import Assign, Comment, do
from ravenchart.gen.model.component import Port
from ravenchart.gen.model.instances import End

from .site import Site


def releases(site: Site, port: Port) -> bool:
    """Whether the values of an input port release a processor."""
    return site.system.woken_by(End(site.instance.name, port.name)) is not None


def wait_spec(site: Site, port: Port) -> Iterator[Decl]:
    """How the processor waits for a value; in a simulation, how one asks whether it would."""
    if releases(site, port):
        yield Subprogram(f"Await_{ada_case(port.name)}")
        element = f"{site.instance.name}.{port.name}"
        yield Comment(f"[{element}] suspend the processor of this port until a value waits.")
        if site.noted:
            yield Subprogram(f"Ask_{ada_case(port.name)}", _ASKED)


def wait_body(site: Site, port: Port) -> Iterator[Decl]:
    """Their bodies."""
    if releases(site, port):
        name = ada_case(port.name)
        yield Subprogram(f"Await_{name}", body=(do(ref(f"{name}_Mailbox", "Wait")),))
        if site.noted:
            empty = Assign("Waiting", Prefix("not", ref(f"{name}_Mailbox", "Is_Empty")))
            yield Subprogram(f"Ask_{name}", _ASKED, body=(empty,))


_ASKED = (Param("Waiting", "out", "Boolean"),)
