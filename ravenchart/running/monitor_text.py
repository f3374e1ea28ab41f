# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The output of a monitor as text: tables in 80 columns, or lines for a pipe."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from ravenchart import rounded

from .monitored import Overlooked, WatchedEvent, WatchedNode, WatchedProcessor, WatchedQueue
from .response_text import ResponseTable, response_lines
from .summary import columns

LATE = 1.0
"""The age of an older snapshot is shown; in s."""


def tables(
    title: str,
    node: WatchedNode,
    last: Sequence[WatchedEvent],
    age: float,
    overlooked: Overlooked,
) -> RenderableType:
    """One node; ``last`` are its last transitions and faults, ``age`` is that of the snapshot."""
    parts = _processors_and_losses(title, node, age)
    if node.charts:
        parts.append(_charts(node))
    elif any(one.highest is not None for one in node.queues):
        parts.append(_chart_queues(node.queues))
    if last:
        parts.append(_events(last))
    if node.traffic:
        parts.append(_traffic(node))
    if node.values:
        parts.append(_values(node))
    parts.append(ResponseTable(node.responses, node.responses_note))
    if overlooked.snapshots or overlooked.events:
        parts.append(Text(overlooked_in_words(overlooked)))
    parts += _said(node)
    parts.append(Text(f"not seen: {'; '.join(node.not_seen)}", style="dim"))
    return Group(*parts)


def response_tables(nodes: Sequence[tuple[str, WatchedNode, float]]) -> RenderableType:
    """The processors of all nodes, then the responses of activities; arguments as of `tables`."""
    parts: list[RenderableType] = []
    for title, node, age in nodes:
        parts += _processors_and_losses(title, node, age)
        parts += _said(node)
    parts += [ResponseTable(node.responses, node.responses_note) for _, node, _ in nodes]
    return Group(*parts)


def _processors_and_losses(title: str, node: WatchedNode, age: float) -> list[RenderableType]:
    parts: list[RenderableType] = [_head(title, node, age)]
    if node.processors:
        parts.append(_processors(node.processors))
    parts.append(_losses(node))
    return parts


def _said(node: WatchedNode) -> list[RenderableType]:
    return [Text(text, style="bold red") for text in node.said]


def overlooked_in_words(of: Overlooked) -> str:
    """How much of the controller was not looked at, and not listed."""
    return (
        f"snapshots not looked at: {of.snapshots} of {of.of}; transitions and faults not listed: "
        f"{of.events}"
    )


def state_of(node: WatchedNode) -> str:
    """How the controller is doing, in words."""
    if node.ended:
        return "ended in order"
    if node.process is None:
        return "ENDED WITHOUT ITS REPORT"
    return f"process {node.process}" if node.process else "running"


def lines(node: WatchedNode, name: str, *, counts: bool) -> Iterator[str]:
    """One node as lines: what happened, and with ``counts`` how each processor and chart is."""
    where = f"{name} " if name else ""
    for event in node.events:
        yield f"{where}{rounded.instant(event.at)} {event.element} {event.kind} {event.what}"
    now = rounded.instant(node.now)
    if node.unlisted:
        yield f"{where}{now} {node.unlisted} more transitions and faults, not listed"
    if not counts:
        return
    for one in node.processors:
        due = "" if one.due is None else f"due {one.due} "
        yield (
            f"{where}{now} {one.name} processor {due}completed {one.completed} misses "
            f"{one.misses} {_responses(one)} {one.word}"
        )
    for text in response_lines(node.responses):
        yield f"{where}{now} {text}"
    for chart in node.charts:
        if chart.state is not None:
            yield f"{where}{now} {chart.name} state {chart.state}"
    for queue in node.queues:
        waiting = "?" if queue.waiting is None else queue.waiting
        highest = "" if queue.highest is None else f" most {queue.highest}"
        yield f"{where}{now} {queue.name} queue {waiting} of {queue.depth}{highest}"
    for value in node.values:
        unit = f" {value.unit}" if value.unit else ""
        yield f"{where}{now} {value.name} value {value.value}{unit}"
    for what, number in node.lost.items():
        yield f"{where}{now} {what} lost {number}"
    for text in node.said:
        yield f"{where}{now} {text}"


def _responses(one: WatchedProcessor) -> str:
    """The last and the worst response of a processor, and its bound."""
    last = "-" if one.last_response is None else rounded.up(one.last_response)
    if one.bound is None:
        return f"last {last} worst {rounded.up(one.worst_response)} R -"
    worst, bound = rounded.beside(one.worst_response, one.bound)
    return f"last {last} worst {worst} R {bound}"


def _head(title: str, node: WatchedNode, age: float) -> Text:
    head = Text()
    head.append(f"{title}: ", style="bold")
    bad = node.process is None and not node.ended
    head.append(state_of(node), style="bold red" if bad else "bold")
    head.append(f", {rounded.instant(node.now)} s, snapshot {node.sequence}")
    if node.process is not None and age > LATE:
        head.append(f", no news for {age:.1f} s", style="bold red")
    if node.real_time is False:
        head.append("\nno real-time priorities: responses are not comparable with bounds")
    return head


def _processors(found: Sequence[WatchedProcessor]) -> Table:
    unit = rounded.unit_of(time for one in found for time in (one.worst_response, one.bound))
    times = (f"{name} {unit.name}>" for name in ("last", "worst", "R"))
    table = columns("processor", "due>", "completed>", "misses>", *times, "ratio>", "")
    for one in found:
        bad = one.misses > 0 or one.word == "ABOVE"
        worst, bound = unit.beside(one.worst_response, one.bound)
        table.add_row(
            one.name,
            "-" if one.due is None else str(one.due),
            str(one.completed),
            str(one.misses),
            unit.up(one.last_response),
            worst,
            bound,
            rounded.percent(Fraction(one.worst_response, one.bound)) if one.bound else "-",
            one.word,
            style="bold red" if bad else "",
        )
    return table


def _losses(node: WatchedNode) -> Text:
    text = Text()
    for word, found in (("faults", node.faults), ("lost", node.lost)):
        listed = ", ".join(f"{what} {number}" for what, number in found.items())
        text.append(f"{word}: {listed or 'none'}\n", style="bold red" if found else "")
    text.right_crop(1)
    return text


def _charts(node: WatchedNode) -> Table:
    table = columns("chart", "state", "for s>", "transitions>", "waiting>", "most>")
    queues = {one.name: one for one in node.queues}
    for one in node.charts:
        queue = queues.get(one.name)
        fill = ("", "") if queue is None else (_waiting(queue), str(queue.highest))
        spent = "-" if one.since is None else rounded.age(node.now - one.since)
        style = "dim" if one.state is None else ""
        table.add_row(one.name, one.state or "-", spent, str(one.transitions), *fill, style=style)
    return table


def _chart_queues(found: Sequence[WatchedQueue]) -> Table:
    """Where the states of charts are not known."""
    table = columns("chart", "waiting>", "most>")
    for one in found:
        table.add_row(one.name, _waiting(one), str(one.highest))
    return table


def _events(found: Sequence[WatchedEvent]) -> Table:
    table = columns("at s>", "last transitions and faults", "")
    for one in found:
        what = one.what if one.kind == "transition" else f"FAULT {one.what}"
        style = "" if one.kind == "transition" else "red"
        table.add_row(rounded.instant(one.at), one.element, what, style=style)
    return table


def _traffic(node: WatchedNode) -> Table:
    kinds = ("arrived", "handled", "sent", "raised")
    table = columns("port, event, message", *(f"{kind}>" for kind in kinds), "s ago>", "waiting>")
    waiting = {one.name: _waiting(one) for one in node.queues}
    counts: dict[str, dict[str, str]] = {}
    last: dict[str, int] = {}
    for one in node.traffic:
        counts.setdefault(one.name, {})[one.what] = one.state or str(one.count)
        last[one.name] = max(one.last, last.get(one.name, 0))
    for name, found in counts.items():
        cells = (found.get(kind, "") for kind in kinds) if "state" not in found else (
            found["state"], "", "", "",
        )  # fmt: skip
        ago = rounded.age(node.now - last[name])
        table.add_row(name, *cells, ago, waiting.get(name, ""))
    return table


def _values(node: WatchedNode) -> Table:
    table = columns("recorded value", "last>", "", "recorded>", "s ago>")
    for one in node.values:
        ago = rounded.age(node.now - one.last)
        table.add_row(one.name, one.value, one.unit, str(one.count), ago)
    return table


def _waiting(queue: WatchedQueue) -> str:
    return f"{'?' if queue.waiting is None else queue.waiting} of {queue.depth}"
