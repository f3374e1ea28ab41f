# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The commands of an instance: those that it serves, calls and gets replies of."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.derive.calls import gathers
from ravenchart.gen.emit.ada.declarations import Decl, Subprogram
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import ada_case, default_value
from ravenchart.gen.emit.ada.statements import Assign, Comment, Stmt, do
from ravenchart.gen.emit.commands.device_calls import (
    call_body,
    from_afar,
    published,
    put_body,
    put_spec,
    take_body,
    take_spec,
    taken_replies,
    told_full,
)
from ravenchart.gen.emit.commands.gathered_answers import conclude_bodies, concluded
from ravenchart.gen.emit.commands.gathered_calls import array_calls
from ravenchart.gen.emit.commands.remote_calls import remotes, watch_body
from ravenchart.gen.emit.commands.remote_reads import copies, copy_name
from ravenchart.gen.model.commands import Gathered, Need, Provided
from ravenchart.gen.model.component import Port

from .site import Site


class Commands(Site):
    """The procedures for the commands of an instance."""

    def _command_specs(self) -> Iterator[Decl]:
        for provided in self._served():
            yield put_spec(self.instance, provided)
            yield Comment(f"[{self._element(provided.name)}] queue a request; never blocks.")
        for spec, item in published(self.system, self.instance):
            yield spec
            yield Comment(f"[{self._element(item)}] the value published last.")
        for binding in taken_replies(self.system, self.instance):
            yield take_spec(self.system, binding.need)
            yield Comment(f"[{self._element(binding.need.name)}] deliver the reply.")
        for spec, _ in from_afar(self.system, self.instance):
            yield spec
            yield Comment(
                f"[{self.instance.name}] called for messages of another node; never blocks."
            )

    def _served(self) -> tuple[Provided, ...]:
        return tuple(one for one in self.instance.component.provides if one.server is not None)

    def _command_bodies(self) -> Iterator[Decl]:
        system, instance = self.system, self.instance
        for provided in self._served():
            yield put_body(instance, provided, self._lost(provided.name))
        for spec, item in published(system, instance):
            read: Stmt = do(ref(f"{ada_case(item)}_Board", "Read"), ref("Reply"))
            if not self._has_object(item):
                read = Assign("Reply", ref(f"{ada_case(item)}_Own"))
            yield Subprogram(spec.name, spec.params, body=(read,))
        yield from conclude_bodies(system, instance)
        for binding in taken_replies(system, instance):
            yield take_body(system, instance, binding.need)
        yield from (body for _, body in from_afar(system, instance))
        for remote in remotes(system, instance):
            if remote.reply is not None:
                kept = f"{ada_case(remote.need.name)}_Call"
                yield watch_body(remote.need, kept, self._passed(remote.need))
        for copy in copies(system, instance):
            yield watch_body(copy.need, copy_name(copy.need), self._passed(copy.need))

    def _lost(self, name: str) -> tuple[Stmt, ...]:
        """Report a call that found no place."""
        return (self._fault("Queue_Overflow", name, "port"),)

    def _passed(self, need: Need) -> tuple[Stmt, ...]:
        """Report a reply that did not come in time, and tell of it."""
        whole = self.system.bound[self.instance.name, need.command.name]
        if need.is_part and gathers(self.system, whole):
            assert need.reply is not None
            late = concluded(need, "Timed_Out", default_value(self.system, need.reply))
            return (self._fault("Stale_Input", need.name, "port"), late)
        told = () if need.on_timeout is None else (self._raise(need.on_timeout),)
        return (self._fault("Stale_Input", need.name, "port"), *told)

    def _call_bodies(self, port: Port) -> Iterator[Subprogram]:
        binding, lost = self.system.bound[self.instance.name, port.name], self._lost(port.name)
        if isinstance(binding.provider, Gathered):
            yield from array_calls(self.system, self.instance, binding, lost)
        else:
            yield call_body(self.system, binding, told_full(self.instance, binding.need), lost)
