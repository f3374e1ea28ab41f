# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The parts of the file format: values with their limits, and located mappings.

The forms themselves are in `schema`.
"""

import re
from typing import Annotated, Any, TypeVar

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    ModelWrapValidatorHandler,
    PlainValidator,
    PrivateAttr,
    WithJsonSchema,
    model_validator,
)
from pydantic import Field as PydanticField
from pydantic_core import PydanticCustomError

from ravenchart.gen.language.names import (
    DATABASE_NAME,
    IDENTIFIER,
    LONGEST_DATABASE_NAME,
    LONGEST_NAME,
    LONGEST_REQUIREMENT,
    LONGEST_VERSION,
    REQUIREMENT,
    VERSION,
    database_problem_of,
    database_text_problem_of,
    problem_of,
)
from ravenchart.gen.language.quantities import (
    BITS_PER_SECOND,
    BYTES,
    LONGEST,
    NANOSECONDS,
    parsed_duration,
    pattern,
    quantity,
)
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.origins import Origin

from .located import Map, Seq, TextPlace


def key(description: str, **limits: Any) -> Any:
    """A key with its description and limits."""
    return PydanticField(description=description, **limits)


def optional(description: str, **limits: Any) -> Any:
    """A key that may be left out."""
    return PydanticField(default=None, description=description, **limits)


def _has(*keys: str) -> Any:
    """The tag of the first of these keys that a mapping has."""

    def tag(value: Any) -> str | None:
        if isinstance(value, dict):
            return next((f"<{name}>" for name in keys if name in value), None)
        return None

    return tag


def by_key(what: str, *keys: str) -> Discriminator:
    """The choice between forms by the first of these keys that a mapping has."""
    message = f"{what} is a mapping with one of the keys {', '.join(f'`{name}`' for name in keys)}"
    return Discriminator(
        _has(*keys),
        custom_error_type="choice",
        custom_error_message=message,
    )


# --- Values --------------------------------------------------------------------


def _name(text: str) -> str:
    problem = problem_of(text)
    if problem is not None:
        raise _coded(*problem)
    return text


def _database_name(text: str) -> str:
    problem = database_problem_of(text)
    if problem is not None:
        raise _coded("RV-0622", problem)
    return text


def _database_text(text: str) -> str:
    problem = database_text_problem_of(text)
    if problem is not None:
        raise _coded("RV-0622", problem)
    return text


def _coded(code: str, message: str) -> PydanticCustomError:
    """An error whose message is a sentence."""
    return PydanticCustomError("coded", "{message}", {"code": code, "message": message})


def _required(code: str, message: str) -> PydanticCustomError:
    """An error whose message follows the subject of the sentence and precedes the value found."""
    return PydanticCustomError("required", "{message}", {"code": code, "message": message})


def _positive(value: object) -> object:
    parsed = _duration(value)
    if parsed == 0:
        raise _required("RV-0205", "must be longer than 0")
    return parsed


def _duration(value: object) -> Ns:
    parsed = parsed_duration(value) if isinstance(value, str) else None
    if parsed is None:
        shape = "a duration such as `20 ms` (ns, us, ms or s; whole nanoseconds)"
        raise _required("RV-0205", f"must be {shape}")
    if parsed > LONGEST:
        raise _required("RV-0205", "must be at most one hour")
    return parsed


def _flag(value: object) -> object:
    return {"yes": True, "no": False}.get(value, value) if isinstance(value, str) else value


def _stack(value: object) -> object:
    parsed = quantity(value, BYTES) if isinstance(value, str) else None
    if parsed is None or not 2**10 <= parsed <= 2**26:
        raise _required("RV-0206", "must be a size such as `32 KiB`, from 1 KiB to 64 MiB")
    return parsed


def _bit_rate(value: object) -> object:
    parsed = quantity(value, BITS_PER_SECOND) if isinstance(value, str) else None
    if parsed is None or not 10_000 <= parsed <= 1_000_000:
        raise _required("RV-0207", "must be a bit rate such as `500 kbit/s`, 10 kbit/s to 1 Mbit/s")
    return parsed


def _data_rate(value: object) -> object:
    parsed = quantity(value, BITS_PER_SECOND) if isinstance(value, str) else None
    if parsed is None or not 10_000 <= parsed <= 10_000_000:
        raise _required("RV-0207", "must be a bit rate such as `2 Mbit/s`, 10 kbit/s to 10 Mbit/s")
    return parsed


Name = Annotated[
    str,
    AfterValidator(_name),
    WithJsonSchema({"type": "string", "pattern": IDENTIFIER, "maxLength": LONGEST_NAME}),
]
"""An Ada identifier."""

DatabaseName = Annotated[
    str,
    AfterValidator(_database_name),
    WithJsonSchema(
        {"type": "string", "pattern": DATABASE_NAME, "maxLength": LONGEST_DATABASE_NAME}
    ),
]
"""The name of a message, a signal or a node in CAN databases."""

DatabaseText = Annotated[
    str,
    AfterValidator(_database_text),
    WithJsonSchema({"type": "string", "minLength": 1, "maxLength": LONGEST_DATABASE_NAME}),
]
"""The name of a value of a signal in CAN databases."""

Reference = Annotated[str, WithJsonSchema({"type": "string", "pattern": IDENTIFIER})]
"""The name of something declared elsewhere."""

_path = f"{IDENTIFIER[:-1]}(\\.{IDENTIFIER[1:-1]})"
OwnedReference = Annotated[str, WithJsonSchema({"type": "string", "pattern": f"{_path}+$"})]
"""``owner.name``: something that belongs to an instance or region.

An instance inside another is a path: ``arm.shoulder.name``.
"""
PathReference = Annotated[str, WithJsonSchema({"type": "string", "pattern": f"{_path}*$"})]
"""``name`` or ``owner.name``: an element of its own, or something that belongs to an instance."""

_starred = f"{IDENTIFIER[:-1]}(_\\*)?(\\.{IDENTIFIER[1:-1]}(_\\*)?)"
StarredReference = Annotated[str, WithJsonSchema({"type": "string", "pattern": f"{_starred}+$"})]
"""``owner.name``, or with a star several: ``wheel_*.speed`` for an array ``wheel``."""
StarredPath = Annotated[str, WithJsonSchema({"type": "string", "pattern": f"{_starred}*$"})]
"""``name`` or ``owner.name``, or with a star several."""

_duration_schema = {"type": "string", "pattern": pattern(NANOSECONDS)}
Span = Annotated[int, BeforeValidator(_duration), WithJsonSchema(_duration_schema)]
"""A duration, in ns; may be 0."""
PositiveSpan = Annotated[int, BeforeValidator(_positive), WithJsonSchema(_duration_schema)]
"""A duration longer than 0, in ns."""
Flag = Annotated[
    bool,
    BeforeValidator(_flag),
    WithJsonSchema({"anyOf": [{"type": "boolean"}, {"enum": ["yes", "no"]}]}),
]
"""`yes` or `no`; `true` and `false` are the same."""
StackSize = Annotated[
    int, BeforeValidator(_stack), WithJsonSchema({"type": "string", "pattern": pattern(BYTES)})
]
_bit_rate_schema = {"type": "string", "pattern": pattern(BITS_PER_SECOND)}
BitRate = Annotated[int, BeforeValidator(_bit_rate), WithJsonSchema(_bit_rate_schema)]
DataRate = Annotated[int, BeforeValidator(_data_rate), WithJsonSchema(_bit_rate_schema)]


def _requirement(value: object) -> object:
    well_formed = isinstance(value, str) and re.match(REQUIREMENT, value)
    if not well_formed or len(str(value)) > LONGEST_REQUIREMENT:
        raise _required("RV-0211", "must be the id of a requirement such as `R-12`")
    return value


def _each_once(ids: list[str]) -> list[str]:
    twice = next((one for number, one in enumerate(ids) if one in ids[:number]), None)
    if twice is not None:
        raise _coded("RV-0211", f"the requirement {twice} is named twice")
    return ids


RequirementId = Annotated[
    str,
    BeforeValidator(_requirement),
    WithJsonSchema({"type": "string", "pattern": REQUIREMENT, "maxLength": LONGEST_REQUIREMENT}),
]
"""The id of a requirement in a list of requirements."""


def _scalar(value: object) -> int | bool | str:
    if not isinstance(value, int | str):
        raise _required("RV-0203", "must be a single value")
    if value == "":
        raise _required("RV-0203", "must be a value")
    return value


def _version(value: object) -> object:
    if not (isinstance(value, str) and re.match(VERSION, value)) or len(value) > LONGEST_VERSION:
        raise _required("RV-0811", "must be a version such as `1.2.0`")
    return value


Version = Annotated[
    str,
    BeforeValidator(_version),
    WithJsonSchema({"type": "string", "pattern": VERSION, "maxLength": LONGEST_VERSION}),
]
"""A version: numbers, and behind them what else tells it apart, as in semver.org, 2.0.0."""

ScalarValue = Annotated[
    int | bool | str,
    PlainValidator(_scalar),
    WithJsonSchema({"type": ["integer", "boolean", "string"]}),
]
Constant = ScalarValue
"""A number, ``true`` or ``false``, or an enumeration literal."""
ExpressionText = ScalarValue
"""An expression as text; a number or Boolean may stand alone."""


def _shape(value: object) -> str:
    """The tag of a value's shape, to choose between the forms that a key allows."""
    return "<list>" if isinstance(value, list) else "<map>" if isinstance(value, dict) else "<one>"


def shaped(what: str) -> Discriminator:
    """The choice of a form by the value's shape; ``what`` says which are allowed."""
    return Discriminator(
        _shape,
        custom_error_type="shape",
        custom_error_message=f"must be {what}",
    )


REQUIREMENTS = "req"
"""The key that every element may have."""

# --- Elements ------------------------------------------------------------------

E = TypeVar("E", bound="Element")


class Element(BaseModel):
    """A mapping of the file format, which remembers where it and its parts were read."""

    model_config = ConfigDict(extra="forbid", strict=True, defer_build=True)
    _raw: Map = PrivateAttr(default_factory=lambda: Map(Origin("", 1, 1)))

    req: Annotated[list[RequirementId], AfterValidator(_each_once)] | None = optional(
        "Ids of the requirements that the element implements.", min_length=1
    )

    @model_validator(mode="wrap")
    @classmethod
    def _remember(cls: type[E], data: Any, handler: ModelWrapValidatorHandler[E]) -> E:
        element = handler(data)
        if isinstance(data, Map):
            element._raw = data
        return element

    @property
    def tree(self) -> Map:
        """The mapping that was read."""
        private = self.__pydantic_private__  # `self._raw` would search for it
        assert private is not None
        found: Map = private["_raw"]
        return found

    @property
    def origin(self) -> Origin:
        """Where the element begins: its key, or its first character in a list."""
        return self.tree.origin

    @property
    def damaged(self) -> bool:
        """Whether something inside was wrong and taken out."""
        return self.tree.damaged

    def has(self, name: str) -> bool:
        """Whether the key is given."""
        return name in self.tree

    def at(self, name: str) -> Origin:
        """Where the value of the key stands; where the element begins, without it."""
        place = self.tree.values_at.get(name)
        return self.origin if place is None else place.origin

    def at_key(self, name: str) -> Origin:
        """Where the key itself stands; where the element begins, without it."""
        return self.tree.keys_at.get(name, self.origin)

    def place(self, name: str, inside: str | None = None) -> TextPlace:
        """The place of the key's value, or of an entry of the mapping that it holds."""
        value = self.tree.get(name)
        if inside is not None and isinstance(value, Map):
            return value.values_at.get(inside, TextPlace(value.origin))
        return self.tree.values_at.get(name, TextPlace(self.origin))

    def item_at(self, name: str, index: int) -> Origin:
        """Where an item of the list under the key stands."""
        return self.item_place(name, index).origin

    def item_place(self, name: str, index: int) -> TextPlace:
        """The place of an item of the list under the key."""
        value = self.tree.get(name)
        if isinstance(value, Seq) and index < len(value.items_at):
            return value.items_at[index]
        return self.place(name)

    def entry_at(self, name: str, entry: str) -> Origin:
        """Where the key ``entry`` of the mapping under the key ``name`` stands."""
        value = self.tree.get(name)
        return value.keys_at.get(entry, value.origin) if isinstance(value, Map) else self.at(name)

    def dropped(self, name: str) -> tuple[str, ...]:
        """The entries of the mapping under the key that were wrong and taken out."""
        value = self.tree.get(name)
        return tuple(value.dropped) if isinstance(value, Map) else ()

    def list_damaged(self, name: str) -> bool:
        """Whether an item of the list under the key was wrong and taken out."""
        value = self.tree.get(name)
        return isinstance(value, Seq) and value.damaged

    def lost(self, name: str) -> bool:
        """Whether the key was given with a wrong value, and taken out."""
        return name in self.tree.dropped
