# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The whole analysis of a model as one JSON object: that of plain files, and more.

Times are whole ns. A response without a bound is null, with the reason.
"""

from __future__ import annotations

from dataclasses import asdict

from ravenchart.analysis.findings import advice
from ravenchart.analysis.plain.build import PlainSystem
from ravenchart.analysis.plain.results import (
    DETAILED,
    Json,
    PlainResult,
    everything,
    latency_figures,
)
from ravenchart.analysis.system.authentication import authentications
from ravenchart.analysis.system.commands import command_times
from ravenchart.analysis.system.protection import protected
from ravenchart.analysis.system.timing import Analysis
from ravenchart.analysis.units import ratio


def figures(analysis: Analysis) -> Json:
    """Everything, for `json.dumps`; factors of execution times leave frames as they are."""
    system = analysis.system
    limits = tuple(latency for _, latency in analysis.limited)
    detailed = len(analysis.found.responses) <= DETAILED
    scaling = analysis.scaling if detailed else None
    plain = PlainSystem(analysis.network, tuple(one.chain for one in limits))
    rows = {row.row.name: row.bound for _, row in analysis.rows()}
    result = PlainResult(plain, analysis.found, limits, detailed, scaling)
    return everything(result) | {
        "system": system.name,
        "digest": system.digest,
        "met": analysis.schedulable,
        "load": {name: ratio(share) for name, share in analysis.loads.items()},
        "activities": [
            {
                "activity": slot.element,
                "processor": processor.name,
                "period": slot.timing.period,
                "deadline": slot.timing.deadline,
                "wcet": slot.timing.wcet,
                "every": slot.divisor,
                "phase": slot.phase,
                "response": rows.get(slot.element),
            }
            for processor in system.processors
            for slot in processor.slots
        ],
        "receptions": [
            {"message": name, "response": one.bound, "waited": one.wait}
            for name, one in analysis.deliveries.items()
        ],
        "objects": [
            {
                "object": item.element,
                "ceiling": item.ceiling,
                "section": item.section,
                "users": list(item.users),
            }
            for item in system.objects
        ],
        "commands": [asdict(one) for one in command_times(analysis)],
        "protected": [
            {
                "message": row.message.name,
                "profile": row.protection.name,
                "random": row.random,
                "residual": float(row.residual),
                "residual_per_hour": row.rate,
                "tolerated": row.tolerated,
                "stale": [{"port": str(one.port), "found": one.found} for one in row.silences],
            }
            for row in protected(analysis)
        ],
        "authenticated": [
            {
                "message": row.message.name,
                "profile": row.authentication.name,
                "key": row.authentication.key,
                "mac_bits": row.authentication.mac_bits,
                "random": row.authentication.random,
                "tolerated": row.tolerated,
                "stale": [{"port": str(one.port), "found": one.found} for one in row.silences],
            }
            for row in authentications(analysis)
        ],
        "transfers": [
            {
                "message": one.message.name,
                "bytes": one.transport.length,
                "segments": one.transport.segments,
                "flow_control": one.flow.name,
                "rounds": one.transport.rounds,
                "round_trip": one.round_trip,
                "bound": one.bound,
                "cycle": one.cycle,
                "timeout": one.transport.timeout,
            }
            for one in analysis.transfers.values()
        ],
        "transmission": [
            {
                "message": message.name,
                "mode": mode.mode.value,
                "minimum_delay": message.period,
                "longest": mode.longest,
            }
            for message in system.messages
            if (mode := message.transmission) is not None
        ],
        **_streams(analysis),
        "changes": advice.figures(advice.of_model(analysis)),
        "ways": [latency_figures(latency) for latency in analysis.chains],
    }


def _streams(analysis: Analysis) -> Json:
    """The streams to monitors; no entry where no node declares one."""
    found = [
        {
            "stream": one.name,
            "node": one.node.name,
            "period": one.response.task.period,
            "wcet": one.response.task.wcet,
            "response": one.bound,
            "reason": None if one.response.reason is None else one.response.reason.value,
            "met": one.holds,
            "load": ratio(one.load),
            "unread": one.unread,
            "apart": one.apart,
            "trace": one.node.trace_depth,
            "records": None if one.records is None else one.records.trace,
            "values": None if one.records is None else one.records.values,
        }
        for one in analysis.streams
    ]
    return {"streams": found} if found else {}
