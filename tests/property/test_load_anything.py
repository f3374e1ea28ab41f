# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Whatever a file holds: no exception, located errors, the same result twice."""

from __future__ import annotations

from pathlib import Path

import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from ravenchart.gen.diagnostics import render
from ravenchart.gen.language.expressions import Malformed, Term, parse
from ravenchart.gen.pipeline import Loaded, load
from tests.support.effort import drawn
from tests.support.pump import PUMP

ROOT = Path(__file__).parent.parent.parent
EXAMPLES = [
    PUMP,
    (ROOT / "tests" / "feature" / "arrays" / "model.yaml").read_text(),
    *(path.read_text() for path in sorted((ROOT / "examples").glob("*/model.yaml"))),
    *(
        (ROOT / "examples" / "cartesian_robot" / n).read_text()
        for n in ("joint.yaml", "types.yaml")
    ),
]
WORDS = sorted({word for text in EXAMPLES for word in text.split()})
RELAXED = settings(
    max_examples=drawn(15, 60), deadline=None, suppress_health_check=[HealthCheck.too_slow]
)


def loads(content: bytes) -> Loaded:
    """What loading gives, checked for what holds of every result."""

    def read(path: Path, limit: int) -> bytes:
        if path != Path("model.yaml"):
            raise FileNotFoundError(2, "No such file or directory")
        return content[:limit]

    result = load(Path("model.yaml"), read)
    again = load(Path("model.yaml"), read)
    assert result == again
    assert (result.system is None) == any(item.is_error for item in result.diagnostics)
    for item in result.diagnostics:
        for origin in (item.origin, *(place for place, _ in item.notes)):
            assert origin.file == "model.yaml"
            lines = result.sources.get(origin.file, ())
            assert origin.line == origin.column == 1 or 1 <= origin.line <= len(lines)
            assert 1 <= origin.column <= max(map(len, lines), default=0) + 2
        render(item, result.sources).encode()
    order = [(item.origin.line, item.origin.column) for item in result.diagnostics]
    assert order == sorted(order)
    return result


@RELAXED
@given(st.binary(max_size=200))
def test_bytes(content: bytes) -> None:
    loads(content)


@RELAXED
@given(st.text(max_size=200))
def test_text(text: str) -> None:
    loads(text.encode("utf-8", "surrogatepass"))


SCALARS = st.one_of(
    st.sampled_from(WORDS),
    st.integers(),
    st.booleans(),
    st.none(),
    st.text(max_size=8),
    st.sampled_from(["10 ms", "1 us", "user", "0x10", "a.b", "in(A.B)", "1 +", "true", "[", "{"]),
)
KEYS_TEXT = """
system include types components nodes buses instances connections messages processors shutdown
parameters ports port_region events data regions activities period wcet deadline queue initial
safe_state states transitions from to on after when guard effect internal entry exit set send
raise if then else with type default in out kind depth max_age range unit values fields body
reads writes sends raises while node component bus id stack released_by A B C
kind defer deferred every local never done event
"""
KEYS = st.sampled_from(KEYS_TEXT.split())
TREES = st.recursive(
    SCALARS,
    lambda inner: st.one_of(st.lists(inner, max_size=4), st.dictionaries(KEYS, inner, max_size=6)),
    max_leaves=40,
)


@RELAXED
@given(st.dictionaries(KEYS, TREES, max_size=6))
def test_yaml_of_any_shape(tree: dict[str, object]) -> None:
    loads(yaml.safe_dump(tree, allow_unicode=True).encode("utf-8", "replace"))


@RELAXED
@given(st.data())
def test_model_with_words_exchanged(data: st.DataObject) -> None:
    text = data.draw(st.sampled_from(EXAMPLES))
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(text) - 1))
        end = min(len(text), at + data.draw(st.integers(0, 12)))
        with_ = data.draw(st.sampled_from([*WORDS, *" \n:{}[]-'", ""]))
        text = text[:at] + with_ + text[end:]
    loads(text.encode())


@RELAXED
@given(st.data())
def test_model_with_a_line_left_out_or_moved(data: st.DataObject) -> None:
    lines = data.draw(st.sampled_from(EXAMPLES)).splitlines()
    taken = lines.pop(data.draw(st.integers(0, len(lines) - 1)))
    if data.draw(st.booleans()):
        lines.insert(data.draw(st.integers(0, len(lines))), taken)
    loads("\n".join(lines).encode())


@RELAXED
@given(st.data())
def test_model_with_a_part_replaced_by_any_other(data: st.DataObject) -> None:
    tree = yaml.load(data.draw(st.sampled_from(EXAMPLES)), Loader=yaml.BaseLoader)
    inside = tree
    while True:
        keys = list(inside) if isinstance(inside, dict) else list(range(len(inside)))
        key = data.draw(st.sampled_from(keys))
        below = inside[key]
        if not (isinstance(below, dict | list) and below and data.draw(st.booleans())):
            break
        inside = below
    inside[key] = data.draw(TREES)
    loads(yaml.safe_dump(tree, sort_keys=False, allow_unicode=True).encode("utf-8", "replace"))


TOKENS_TEXT = """
if then else and or not = /= < <= > >= + - * / ( ) . , abs min max clamp fresh in level limit
wanted Off Filling 0 1 1000 0x1F true false Control Idle
"""
TOKENS = st.sampled_from(TOKENS_TEXT.split())


@RELAXED
@given(st.lists(TOKENS, max_size=20).map(" ".join))
def test_expression_of_any_tokens(text: str) -> None:
    assert isinstance(parse(text), Term | Malformed)
    loads(PUMP.replace("level < limit", '"' + text + '"').encode())


@RELAXED
@given(st.text(max_size=60))
def test_expression_of_any_text(text: str) -> None:
    assert isinstance(parse(text), Term | Malformed)
