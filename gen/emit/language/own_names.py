# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Transitions, states and events with names of generated code: their kind is added in Ada.

So no name is reserved: a transition `t` is the literal ``T_Transition``. Traces, drawings
and messages keep the model's name.
"""

from __future__ import annotations

from collections.abc import Set

from ravenchart.gen.emit.ada.naming import ada_case

_EVERYWHERE = """
ada boolean false interfaces natural positive ravenchart standard system true
"""
_REGION = """
active active_at_first after before beginning box c chart choice chosen completed configuration
d data deferrals domain done_states due event event_lists fired firing firings first i
initial_entry inputs ins item j last leaf memory name none now occurrence outbox past region
released segment selection self t time_outs timers top_transition transition variables visit
was
"""
_STATES = "leaf configuration"
_NODES = "disorder node nodes nowhere region self"

_EVENTS = "activities event event_lists event_name flows no_event"

IN_REGION = frozenset((_EVERYWHERE + _REGION).split())
"""Names in lower case that a region's package declares or needs to see."""
IN_STATES = frozenset((_EVERYWHERE + _STATES).split())
"""Those of a region's package of states."""
IN_NODES = frozenset((_EVERYWHERE + _NODES).split())
"""Those of the ghost package of nodes."""

IN_EVENTS = frozenset((_EVERYWHERE + _EVENTS).split())
"""Those of a component's package, and of units below it, that stand beside its events."""

BESIDE_REGIONS = frozenset(("node", "none", "selection", "top"))
"""Those that records with a field for each orthogonal region need to see beside their fields."""


def transition_literal(name: str) -> str:
    """A transition as its region's package names it."""
    return _apart(name, IN_REGION, "Transition")


def state_literal(name: str) -> str:
    """A state or pseudostate as the package of states names it."""
    return _apart(name, IN_STATES, "State")


def node_literal(name: str) -> str:
    """A state or pseudostate as the ghost package of nodes names it."""
    return _apart(name, IN_NODES, "State")


def event_literal(name: str) -> str:
    """An event as its component's package names it."""
    return _apart(name, IN_EVENTS, "Event")


def region_label(name: str) -> str:
    """An orthogonal region as the fields of such records name it."""
    return _apart(name, BESIDE_REGIONS, "Region")


def _apart(name: str, taken: Set[str], kind: str) -> str:
    own = ada_case(name)
    return f"{own}_{kind}" if name.lower() in taken else own
