"""How an instance calls what its required commands are bound to."""

from __future__ import annotations

from ..commands import Device, Server
from ..model import Instance, Port, System
from .ada import Do, Param, Ref, Subprogram, arguments
from .components import send_flag
from .naming import ada_case, type_name


def providers(system: System, instance: Instance) -> tuple[str, ...]:
    """The packages, below the root, of what an instance calls."""
    found: dict[str, None] = {}
    for binding in system.bindings:
        provider = binding.provider
        if binding.instance != instance.name or provider is None:
            continue
        owner = provider.instance if isinstance(provider, Server) else provider.name
        if owner != instance.name:
            found[ada_case(owner)] = None
    return tuple(found)


def call_body(system: System, instance: Instance, port: Port) -> Subprogram:
    """A required command as the instance calls it, whatever provides it."""
    binding = system.bound[instance.name, port.name]
    name = ada_case(port.name)
    params = () if port.is_void else (Param("Item", "in", type_name(system, port.type)),)
    given = () if port.is_void else arguments(Ref("Item"))
    assert isinstance(binding.provider, Device)
    body = (Do(f"{ada_case(binding.provider.name)}.{name}", given),)
    return Subprogram(send_flag(port), params, body=body)
