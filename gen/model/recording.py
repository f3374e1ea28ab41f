# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The recordings of a model: ports and data items whose values enter the trace, and charts."""

from __future__ import annotations

from dataclasses import dataclass

from ravenchart.gen.language.terms import IntegerType, RecordType, ScalarType
from ravenchart.gen.origins import Origin

from .component import Data, Port
from .statechart import Region

OBJECT = "recording"
"""The protected object that holds the recorded values of a node."""


@dataclass(frozen=True, slots=True)
class RecordedItem:
    """A port, data item or region of an instance that `record` names.

    The states of regions are in the trace anyway: they need no code.
    """

    origin: Origin
    instance: str
    item: Port | Data | Region
    field: str | None = None
    """Of a record the one field that is recorded; None: all of them."""

    @property
    def element(self) -> str:
        """``instance.item``, or ``instance.item.field`` where it is one field."""
        own = f"{self.instance}.{self.item.name}"
        return own if self.field is None else f"{own}.{self.field}"

    @property
    def values(self) -> tuple[RecordedValue, ...]:
        """The scalars that are recorded of a port or data item: of a record its fields."""
        if isinstance(self.item, Region):
            return ()
        of_type, own = self.item.type, f"{self.instance}.{self.item.name}"
        if not isinstance(of_type, RecordType):
            return (RecordedValue(own, self, None, of_type),)
        return tuple(
            RecordedValue(f"{own}.{one.name}", self, one.name, one.type)
            for one in of_type.fields
            if self.field in (None, one.name)
        )


@dataclass(frozen=True, slots=True)
class RecordedValue:
    """One scalar of a recorded item: it has a number and a track of its own."""

    element: str
    """``instance.item``, with the field of a record behind it."""
    of: RecordedItem
    field: str | None
    type: ScalarType

    @property
    def literals(self) -> tuple[str, ...]:
        """The literals of an enumeration or Boolean, in order of number; () of an integer."""
        return () if isinstance(self.type, IntegerType) else self.type.literals

    @property
    def unit(self) -> str | None:
        """The unit of an integer, where its type has one."""
        return self.type.unit if isinstance(self.type, IntegerType) else None
