# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Whatever a chart is made of: an answer, no exception, the same each time."""

from __future__ import annotations

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from ravenchart.gen.diagnostics import render
from tests.support.chart_models import chart_text
from tests.support.effort import drawn
from tests.support.pump import loaded

KINDS = ("final", "choice", "junction", "history", "deep_history", "fork", "join", "terminate")
RELAXED = settings(
    max_examples=drawn(20, 80), deadline=None, suppress_health_check=[HealthCheck.too_slow]
)


PLAIN = (
    ("on: Go",),
    ("on: Go",),
    ("on: Stop", "guard: place > 3"),
    ("after: 10 ms",),
    ("every: 1 s", "effect: [raise: Go]"),
    ("when: place > 3",),
    (),
)
BRANCH = (("guard: place > 3",), ("guard: else",), ())
ODD = (("on: Go", "local: true"), ("on: Go", "after: 1 s"), ("guard: else",), ("internal: true",))


@st.composite
def vertices(draw: st.DrawFn, kinds: dict[str, str], depth: int = 0) -> str:
    """The vertices of one region, as one line of YAML; ``kinds`` grows by them."""
    own: list[str] = []
    for index in range(draw(st.integers(1, 4))):
        name = f"V{len(kinds)}"
        shapes = ("leaf", "leaf", "composite", "orthogonal", *KINDS)
        shape = "leaf" if index == 0 else draw(st.sampled_from(shapes))
        kinds[name] = shape
        if shape in KINDS:
            own.append(f"{name}: {{kind: {shape}}}")
        elif shape == "leaf" or depth == 2:
            inside = draw(st.sampled_from(("", "", "defer: [Go]", "exit: [raise: Go]")))
            own.append(f"{name}: {{{inside}}}")
        elif shape == "composite":
            own.append(f"{name}: {{{draw(nested(kinds, depth + 1))}}}")
        else:
            count = draw(st.integers(1, 3))
            inner = [f"{name}_{i}: {{{draw(nested(kinds, depth + 1))}}}" for i in range(count)]
            own.append(f"{name}: {{regions: {{{', '.join(inner)}}}}}")
    return ", ".join(own)


@st.composite
def nested(draw: st.DrawFn, kinds: dict[str, str], depth: int) -> str:
    """A region that begins in its first vertex."""
    first = f"V{len(kinds)}"
    inside = draw(vertices(kinds, depth))
    effect = draw(st.sampled_from((first, f"{{to: {first}, effect: [raise: Go]}}")))
    return f"initial: {effect}, states: {{{inside}}}"


@st.composite
def charts(draw: st.DrawFn) -> str:
    """A model of one chart that may or may not make sense."""
    kinds: dict[str, str] = {}
    states = draw(vertices(kinds))
    names = list(kinds)
    sources = [name for name in names if kinds[name] not in ("final", "terminate")]
    lines = []
    for index in range(draw(st.integers(1, 16))):
        source = draw(st.sampled_from(sources))
        keys: tuple[tuple[str, ...], ...] = BRANCH if kinds[source] in KINDS else PLAIN
        if kinds[source] in ("fork", "join", "history", "deep_history"):
            keys = ((),)
        if draw(st.integers(0, 39)) == 0:
            keys = ODD
        parts = [f"from: {source}", *draw(st.sampled_from(keys))]
        if kinds[source] in KINDS or draw(st.integers(0, 9)):
            parts.insert(1, f"to: {draw(st.sampled_from(names))}")
        lines.append(f"t{index}: {{{', '.join(parts)}}}\n")
    top = f"initial: {names[0]}\nqueue: 4\nsafe_state: {draw(st.sampled_from(names))}"
    if "defer" in states:
        top += "\ndeferred: 2"
    return chart_text("\n".join(_rows(states)), "".join(lines), region=top)


def _rows(states: str) -> list[str]:
    """The vertices of the top-level region, one a line."""
    rows: list[str] = []
    depth = start = 0
    for at, letter in enumerate(states):
        depth += (letter in "{[") - (letter in "}]")
        if letter == "," and depth == 0:
            rows.append(states[start:at].strip())
            start = at + 1
    return [*rows, states[start:].strip()]


@RELAXED
@given(charts())
def test_any_chart_is_judged(text: str) -> None:
    result = loaded(text)
    assert loaded(text) == result
    assert (result.system is None) == any(item.is_error for item in result.diagnostics)
    for item in result.diagnostics:
        render(item, result.sources).encode()
        assert item.code in render(item, result.sources)
