# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Records, as those of `dataclass`, whose classes and instances are made faster."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import MISSING, Field, FrozenInstanceError, dataclass, field, fields
from operator import attrgetter
from reprlib import recursive_repr
from typing import Any, NoReturn, TypeVar, dataclass_transform

T = TypeVar("T")
Fields = Sequence[Field[Any]]


@dataclass_transform(frozen_default=True, field_specifiers=(field,))
def frozen(cls: type[T]) -> type[T]:
    """What ``dataclass(frozen=True, slots=True)`` makes, in less time.

    `dataclass` compiles six methods for each class, and its frozen records look up each slot by
    name when they are made. Here one method is compiled, and it has the slots at hand.
    """
    made, methods = _with_slots(cls, guarded=True)
    return _with_methods(cls, made, methods | FROZEN | {"__hash__": _hash(_hashed(made))})


@dataclass_transform(frozen_default=True, field_specifiers=(field,))
def trusted(cls: type[T]) -> type[T]:
    """The same, frozen by the type checker's word alone: for records that are made by the million.

    One that guards itself at run time too takes twice as long to make.
    """
    made, methods = _with_slots(cls, guarded=False)
    return _with_methods(cls, made, methods | {"__hash__": _hash(_hashed(made))})


@dataclass_transform(field_specifiers=(field,))
def slotted(cls: type[T]) -> type[T]:
    """What ``dataclass(slots=True)`` makes, in less time."""
    made, methods = _with_slots(cls, guarded=False)
    return _with_methods(cls, made, methods | {"__hash__": None})


def _with_slots(cls: type[T], *, guarded: bool) -> tuple[Any, dict[str, Any]]:
    """The class with a slot for each field, and what all records do."""
    if not cls.__doc__:
        cls.__doc__ = cls.__name__  # `dataclass` would describe the parameters
    made = dataclass(init=False, repr=False, eq=False, slots=True)(cls)
    known = fields(made)  # type: ignore[arg-type]
    return made, {
        "__init__": _init(made, known, guarded),
        "__eq__": _eq(_values([one for one in known if one.compare])),
        "__repr__": _repr([one.name for one in known if one.repr]),
    }


def _with_methods(cls: type[T], made: Any, methods: dict[str, Any]) -> type[T]:
    """The class with the methods that it has not defined by itself."""
    for name, method in methods.items():
        if name not in cls.__dict__:
            setattr(made, name, method)
    return made  # type: ignore[no-any-return]


def _init(made: type, known: Fields, guarded: bool) -> Callable[..., None]:
    """The method that sets the slots: of a record that is ``guarded`` each by its descriptor."""
    names: dict[str, Any] = {"_missing": MISSING}
    taken: list[str] = []
    only_named: list[str] = []
    body: list[str] = []
    for one in known:
        name, made_anew = one.name, one.default_factory is not MISSING
        optional = made_anew or one.default is not MISSING
        names[f"_set_{name}"] = getattr(made, name).__set__
        names[f"_default_{name}"] = one.default  # of one with a factory this is `_missing`
        names[f"_new_{name}"] = one.default_factory
        if one.init:
            given = f"{name}=_default_{name}" if optional else name
            (only_named if one.kw_only else taken).append(given)
        value = name if one.init else f"_default_{name}"
        if made_anew:
            value = f"_new_{name}()"
            value += f" if {name} is _missing else {name}" if one.init else ""
        if one.init or optional:
            body.append(f" _set_{name}(self, {value})" if guarded else f" self.{name} = {value}")
    if hasattr(made, "__post_init__"):
        body.append(" self.__post_init__()")
    parameters = ["self", *taken, *(["*", *only_named] if only_named else [])]
    text = "\n".join([f"def __init__({', '.join(parameters)}):", *(body or [" pass"])])
    exec(text, names)
    init: Callable[..., None] = names["__init__"]
    init.__qualname__ = f"{made.__qualname__}.__init__"
    init.__annotations__ = {one.name: one.type for one in known if one.init} | {"return": None}
    return init


def _values(chosen: Fields) -> Callable[[Any], tuple[Any, ...]]:
    """The values of these fields."""
    names = [one.name for one in chosen]
    if len(names) > 1:
        return attrgetter(*names)
    if names:
        only = attrgetter(*names)
        return lambda record: (only(record),)
    return lambda record: ()


def _hashed(made: Any) -> Callable[[Any], tuple[Any, ...]]:
    """The values of the fields that count for its hash."""
    return _values([f for f in fields(made) if (f.compare if f.hash is None else f.hash)])


def _eq(values: Callable[[Any], tuple[Any, ...]]) -> Callable[[Any, Any], Any]:
    def equals(self: Any, other: Any) -> Any:
        if other.__class__ is self.__class__:
            return values(self) == values(other)
        return NotImplemented

    return equals


def _hash(values: Callable[[Any], tuple[Any, ...]]) -> Callable[[Any], int]:
    return lambda self: hash(values(self))


def _repr(names: Sequence[str]) -> Callable[[Any], str]:
    @recursive_repr()
    def shown(self: Any) -> str:
        parts = ", ".join(f"{name}={getattr(self, name)!r}" for name in names)
        return f"{self.__class__.__qualname__}({parts})"

    return shown


def _refuse_to_set(self: Any, name: str, value: object) -> NoReturn:
    raise FrozenInstanceError(f"cannot assign to field {name!r}")


def _refuse_to_delete(self: Any, name: str) -> NoReturn:
    raise FrozenInstanceError(f"cannot delete field {name!r}")


def _state(self: Any) -> list[Any]:
    return [getattr(self, one.name) for one in fields(self)]


def _set_state(self: Any, state: list[Any]) -> None:
    for one, value in zip(fields(self), state, strict=True):
        object.__setattr__(self, one.name, value)


FROZEN: dict[str, Callable[..., Any]] = {
    "__setattr__": _refuse_to_set,
    "__delattr__": _refuse_to_delete,
    "__getstate__": _state,
    "__setstate__": _set_state,
}
"""Methods of each class whose records cannot be changed."""
