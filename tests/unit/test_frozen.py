# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Records of `frozen`, `trusted` and `slotted` are those of `dataclass`, made in less time."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from dataclasses import FrozenInstanceError, asdict, dataclass, field, fields, replace
from typing import Any

import pytest

from ravenchart.gen.frozen import frozen, slotted, trusted


def _defined(decorator: Callable[[Any], Any]) -> dict[str, Any]:
    """Classes of every kind that is used, by name; in one scope, so that all names are alike."""

    class Plain:
        """Three fields, two with defaults."""

        a: int
        b: str = "x"
        c: tuple[int, ...] = ()

    class Empty:
        pass

    class Single:
        a: float

    class Fields:
        a: int
        made: list[int] = field(default_factory=list)
        aside: str = field(default="", compare=False)
        hidden: int = field(default=1, repr=False)
        named: int = field(default=7, kw_only=True)
        later: int = field(default=3, init=False)
        inside: dict[str, int] = field(init=False, default_factory=dict)

    class Checked:
        a: int

        def __post_init__(self) -> None:
            if self.a < 0:
                raise ValueError("below 0")

    class Own:
        a: int

        def __repr__(self) -> str:
            return "mine"

        def __eq__(self, other: object) -> bool:
            return True

        def __hash__(self) -> int:
            return 5

    found = (Plain, Empty, Single, Fields, Checked, Own)
    return {one.__name__: decorator(one) for one in found}


PAIRS = {
    "trusted": (_defined(trusted), _defined(dataclass(frozen=True, slots=True))),
    "frozen": (_defined(frozen), _defined(dataclass(frozen=True, slots=True))),
    "slotted": (_defined(slotted), _defined(dataclass(slots=True))),
}
CALLS: list[tuple[str, tuple[Any, ...], dict[str, Any]]] = [
    ("Plain", (1,), {}),
    ("Plain", (1, "y"), {"c": (2, 3)}),
    ("Plain", (), {"b": "z", "a": 4}),
    ("Empty", (), {}),
    ("Single", (1.5,), {}),
    ("Fields", (1,), {}),
    ("Fields", (1, [2], "told", 9), {"named": 8}),
    ("Checked", (0,), {}),
    ("Own", (1,), {}),
]
both = pytest.mark.parametrize("kind", PAIRS)
every = pytest.mark.parametrize(("name", "given", "named"), CALLS)


@both
@every
def test_a_record_has_the_values_and_the_text_of_a_dataclass(
    kind: str, name: str, given: tuple[Any, ...], named: dict[str, Any]
) -> None:
    ours, theirs = (classes[name](*given, **named) for classes in PAIRS[kind])
    assert repr(ours) == repr(theirs)
    assert asdict(ours) == asdict(theirs)
    assert [one.name for one in fields(ours)] == [one.name for one in fields(theirs)]
    assert type(ours).__match_args__ == type(theirs).__match_args__
    assert type(ours).__slots__ == type(theirs).__slots__
    assert not hasattr(ours, "__dict__")
    assert type(ours).__init__.__annotations__ == type(theirs).__init__.__annotations__


@both
@every
def test_equality_and_hash_are_those_of_a_dataclass(
    kind: str, name: str, given: tuple[Any, ...], named: dict[str, Any]
) -> None:
    results = []
    for classes in PAIRS[kind]:
        one, other = classes[name](*given, **named), classes[name](*given, **named)
        try:
            found: object = hash(one)
        except TypeError as problem:
            found = type(problem)
        results.append((one == other, one != other, one == given, one.__eq__(given), found))
    assert results[0] == results[1]


@both
def test_fields_that_do_not_count_are_not_compared(kind: str) -> None:
    for classes in PAIRS[kind]:
        one, other = classes["Fields"](1, aside="a"), classes["Fields"](1, aside="b")
        assert one == other != classes["Fields"](2, aside="a")
        assert "hidden" not in repr(one)
        assert one.made is not other.made


@both
@pytest.mark.parametrize(
    ("name", "given", "problem"),
    [
        ("Plain", (), TypeError),
        ("Plain", (1, 2, 3, 4), TypeError),
        ("Fields", (1, [], "", 1, 7), TypeError),
        ("Checked", (-1,), ValueError),
    ],
)
def test_a_wrong_call_is_refused(
    kind: str, name: str, given: tuple[Any, ...], problem: type[Exception]
) -> None:
    for classes in PAIRS[kind]:
        with pytest.raises(problem):
            classes[name](*given)


@pytest.mark.parametrize("classes", PAIRS["frozen"], ids=["ours", "theirs"])
def test_a_frozen_record_cannot_be_changed(classes: dict[str, Any]) -> None:
    record = classes["Plain"](1)
    with pytest.raises(FrozenInstanceError, match="cannot assign to field 'a'"):
        record.a = 2
    with pytest.raises(FrozenInstanceError, match="cannot delete field 'a'"):
        del record.a
    with pytest.raises((AttributeError, TypeError)):
        record.new = 2
    assert record.a == 1


@pytest.mark.parametrize("classes", PAIRS["slotted"], ids=["ours", "theirs"])
def test_a_slotted_record_can_be_changed_and_has_no_other_fields(classes: dict[str, Any]) -> None:
    record = classes["Plain"](1)
    record.a = 2
    assert record == classes["Plain"](2)
    with pytest.raises(AttributeError):
        record.new = 2


@both
def test_a_record_is_replaced_copied_and_matched(kind: str) -> None:
    cls = PAIRS[kind][0]["Plain"]
    record = cls(1, "y", (2,))
    assert replace(record, b="z") == cls(1, "z", (2,))
    assert copy.copy(record) == copy.deepcopy(record) == record
    match record:
        case cls(1, b, c=(two,)):
            assert (b, two) == ("y", 2)
        case _:
            pytest.fail("it is not matched by position")


@frozen
class Kept:
    """At the level of the module, as `pickle` wants it."""

    a: int
    b: tuple[str, ...]


def test_a_frozen_record_is_pickled() -> None:
    assert pickle.loads(pickle.dumps(Kept(1, ("x",)))) == Kept(1, ("x",))


def test_a_frozen_record_that_holds_itself_is_shown() -> None:
    @frozen
    class Ring:
        inside: list[Any]

    ring = Ring([])
    ring.inside.append(ring)
    assert repr(ring).endswith("Ring(inside=[...])")


def test_a_default_that_is_changed_by_a_record_is_refused() -> None:
    with pytest.raises(ValueError, match="mutable default"):

        @frozen
        class Shared:
            a: list[int] = []  # noqa: RUF012

    with pytest.raises(SyntaxError, match="non-default argument follows default"):

        @frozen
        class Order:
            a: int = 1
            b: int  # type: ignore[misc]
