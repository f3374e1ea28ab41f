# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The facts about an instance that its emitters share."""

from __future__ import annotations

from dataclasses import dataclass

from ravenchart.gen.derive.crossing import crosses
from ravenchart.gen.emit.ada.expressions import Expr
from ravenchart.gen.emit.ada.named import DottedName, Named
from ravenchart.gen.emit.ada.naming import component_name, priority
from ravenchart.gen.emit.ada.statements import Stmt, do
from ravenchart.gen.emit.language.events import event_value
from ravenchart.gen.emit.tables.port_calls import mailbox_of
from ravenchart.gen.emit.tables.trace_calls import fault, note
from ravenchart.gen.emit.tables.value_calls import record_values
from ravenchart.gen.model.component import Activity, Data, Port
from ravenchart.gen.model.instances import End, Instance
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import Slot, System


@dataclass(frozen=True, slots=True)
class Site:
    """One instance in its system, with its connections and objects there."""

    system: System
    instance: Instance
    noted: bool = False
    """For simulation: every behaviour and step says that it was executed."""

    @property
    def component(self) -> str:
        """The component's package, as seen from the instance's."""
        return component_name(self.instance.component)

    def _slots(self) -> tuple[Slot, ...]:
        own = self.system.slots_of(self.instance.name)
        return tuple(s for s in own if not s.of_bus)

    def _element(self, name: str) -> str:
        return f"{self.instance.name}.{name}"

    def _ceiling(self, name: str) -> Expr:
        return priority(self.system.object(self._element(name)).ceiling)

    def _has_object(self, name: str) -> bool:
        return self.system.has_object(self._element(name))

    def _writer(self, data: Data) -> Region | Activity | None:
        component = self.instance.component
        runnables: tuple[Region | Activity, ...] = (*component.regions, *component.activities)
        return next((r for r in runnables if data.name in r.writes), None)

    def _targets(self, port: str) -> tuple[list[End], list[str]]:
        """Input ports of the same node, and messages, that an output port feeds."""
        end = End(self.instance.name, port)
        ports = [c.target for c in self.system.connections if c.source == end]
        messages = [m for m in self.system.messages if m.source == end]
        return ports, [m.name for m in messages]

    def _is_idle(self, port: Port) -> bool:
        """Whether nothing takes a value sent there: a command that is not provided."""
        return port.is_command and self.system.bound[self.instance.name, port.name].provider is None

    def _connected_inputs(self) -> tuple[Port, ...]:
        targets = [c.target for c in self.system.connections]
        targets += [t for m in self.system.messages for t in m.targets]
        names = {t.name for t in targets if t.instance == self.instance.name}
        names |= {poll.port for poll in self.system.polls if poll.instance == self.instance.name}
        here = (p for p in self.instance.component.inputs() if self.noted or p.name in names)
        return tuple(p for p in here if not self._crosses(p))

    def _crosses(self, port: Port) -> bool:
        """Whether the values of an input port come from another core."""
        return crosses(self.system, End(self.instance.name, port.name))

    def _mailbox(self, port: Port) -> DottedName:
        return mailbox_of(self.system, End(self.instance.name, port.name))

    def _note(
        self, kind: str, name: str, element_kind: str, item: Expr | None = None
    ) -> tuple[Stmt, ...]:
        return note(self.system, kind, self._element(name), element_kind, item)

    def _record(self, name: str, holder: Named) -> tuple[Stmt, ...]:
        """Record the values of a port or data item, which the Ada object ``holder`` has."""
        return record_values(self.system, self.instance.name, name, holder, simulated=self.noted)

    def _fault(self, kind: str, name: str, element_kind: str) -> Stmt:
        return fault(kind, self._element(name), element_kind)

    def _raise(self, event: str, value: Expr | None = None) -> Stmt:
        return do("Offer", event_value(self.instance.component, event, value))
