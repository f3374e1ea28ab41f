# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The forms of commands and devices: dictionary, interfaces, device types, bindings."""

from typing import Annotated, Literal

from pydantic import Field as PydanticField
from pydantic import Tag

from .schema_base import (
    Constant,
    Element,
    Name,
    PathReference,
    PositiveSpan,
    Reference,
    StarredPath,
    StarredReference,
    key,
    optional,
    shaped,
)


class CommandForm(Element):
    """An entry of the command dictionary: what the name means in the whole project."""

    kind: Literal["void", "write", "read", "qualified_read", "event"] = key(
        "`void` takes nothing, `write` an argument, `read` gives a reply, `qualified_read` gives "
        "one to an argument; an `event` comes from the provider, with an argument."
    )
    argument: Reference | None = optional("The type of its argument.")
    reply: Reference | None = optional("The type of its reply; `void` and `write` may have one.")
    per_axis: bool = PydanticField(
        default=False,
        description="One value for each axis of the interface: with `axes: 4`, the scalar type "
        "`T` is the record `T_X4` with the fields `axis_1` to `axis_4`.",
    )


class NeedForm(Element):
    """A command of a required interface; with `else` it is optional."""

    else_: str | None = optional(
        "Fallback where nothing provides it: `activity.item`, the data item that "
        "this activity updates for it, or `nothing`.",
        alias="else",
    )
    on_reply: Reference | None = optional("Event raised with the reply of a call.")
    on_full: Reference | None = optional("Event raised when a call met a full queue.")
    on_timeout: Reference | None = optional(
        "Event raised when nothing came from another node within the binding's `time_limit`."
    )


class RequiredForm(Element):
    """A required interface: commands that one provider gives, whatever it is."""

    axes: int = PydanticField(default=1, ge=1, le=16, description="Axes it works on, 1 to 16.")
    commands: (
        Annotated[
            Annotated[list[Reference], Tag("<list>")]
            | Annotated[dict[Reference, NeedForm], Tag("<map>")],
            shaped("a list of commands, or a mapping from commands to their properties"),
        ]
        | None
    ) = optional(
        "The commands; in the component they are called by their names. An interface without any "
        "has `events`."
    )
    events: dict[Reference, Reference] | None = optional(
        "Events of the provider, each with the input port that it comes to."
    )


class ProtocolStepForm(Element):
    """A transition of a protocol: where a command may be called."""

    from_: Reference = key("A state in which the command may be called.", alias="from")
    to: Reference | None = optional("The state after the call; `from` unless given.")
    on: Reference = key("The command.")


class ProtocolForm(Element):
    """The order in which each client may call the commands of an interface.

    Commands that no transition names may be called in every state.
    """

    initial: Reference = key("The state before the first call.")
    states: list[Name] = key("Its states.", min_length=1)
    transitions: dict[Name, ProtocolStepForm] = key("Its transitions.", min_length=1)


class ProvidedForm(Element):
    """A provided interface of a component: queued commands, and data that it publishes."""

    axes: int = PydanticField(default=1, ge=1, le=16, description="Axes it works on, 1 to 16.")
    queue: int | None = optional(
        "Commands that wait at most, 1 to 1024; needed with `commands`.", ge=1, le=1024
    )
    served_by: Reference | None = optional(
        "The activity that executes what waits, oldest first; needed with `commands`."
    )
    commands: list[Reference] | None = optional("Commands that are queued.")
    published: dict[Reference, Reference] | None = optional(
        "Read commands, each with the data item that is its reply."
    )
    events: dict[Reference, Reference] | None = optional(
        "Events, each with the output port that it is sent on."
    )
    protocol: ProtocolForm | None = optional("The order in which a client may call `commands`.")


class DeviceParameterForm(Element):
    """A constant of a device, which its driver knows at compile time."""

    type: Reference = key("A scalar type.")
    default: Constant | None = optional("Value for devices that set none; without it all must.")


class RegisterForm(Element):
    """A register of a device: a word at an offset from the device's address."""

    offset: int = key("Bytes from the address of the device; a multiple of its own size.", ge=0)
    width: Literal[8, 16, 32] = PydanticField(default=32, description="Its bits: 8, 16 or 32.")
    access: Literal["read", "write", "read_write"] = key(
        "Access of the driver: `read`, `write` or `read_write`."
    )


class DeviceTypeForm(Element):
    """A type of device: a driver without a task of its own, called directly."""

    axes: int = PydanticField(default=1, ge=1, le=16, description="Axes it has, 1 to 16.")
    body: Literal["user", "simulated"] = PydanticField(
        default="user",
        description="`user`: the driver in `user/`; `simulated`: the one in `simulated/`, of which "
        "a first version is written.",
    )
    provides: dict[Reference, PositiveSpan] = key(
        "Its commands, each with its worst-case execution time; a component that "
        "requires an event polls the device for it.",
        min_length=1,
    )
    parameters: dict[Name, DeviceParameterForm] | None = optional(
        "Constants that each device may set."
    )
    registers: dict[Name, RegisterForm] | None = optional(
        "Its registers, which its driver reads and writes; needs `body: user`."
    )
    initialise: PositiveSpan | None = optional(
        "Worst-case execution time of the driver's `Initialise`, called once before the first "
        "release; without the key there is none."
    )
    self_test: PositiveSpan | None = optional(
        "Worst-case execution time of the driver's `Self_Test`, called once behind `Initialise`; "
        "where it fails, the controller does not start."
    )
    make_safe: PositiveSpan | None = optional(
        "Worst-case execution time of the driver's `Make_Safe`, called when the controller ends, "
        "also by a failure; from then on the device executes no command that acts."
    )
    protocol: ProtocolForm | None = optional(
        "The order in which a client may call its commands, `read` ones left out."
    )


class DeviceForm(Element):
    """A device, or several that are used as one."""

    type: Reference | None = optional("Its type: one piece of equipment.")
    address: int | None = optional(
        "Address of its first register in bytes, a multiple of 4; without it the registers are "
        "simulated and nothing else.",
        ge=0,
        lt=2**64,
    )
    parameters: dict[Reference, Constant] | None = optional("Values of the type's parameters.")
    array: list[StarredPath] | None = optional(
        "Devices, or `instance.interface`s, as one: a command goes to all, and axes are counted "
        "on.",
        min_length=1,
    )
    facade: list[StarredPath] | None = optional(
        "Devices, or `instance.interface`s, of several kinds as one: a command goes to the one "
        "that provides it.",
        min_length=1,
    )
    choose: dict[Reference, PathReference] | None = optional(
        "For a command that several of `facade` provide: which one is meant."
    )


class AnyBindingForm(Element):
    """A required interface, and what provides it."""

    from_: StarredReference = key("`instance.interface`, a required one.", alias="from")
    time_limit: PositiveSpan | None = optional(
        "Longest time from the caller's release until a reply from another node has arrived, "
        "and age of what is read there; needed for these. Inside a node it has an effect for "
        "elements of arrays only."
    )


class BindingForm(AnyBindingForm):
    """A required interface of an instance, and what provides it."""

    to: Annotated[
        Annotated[str, Tag("<one>")] | Annotated[list[StarredPath], Tag("<list>")],
        shaped("a device or `instance.interface`, or a list of these"),
    ] = key(
        "A device, or `instance.interface`, a provided one; several, or those of an array, work "
        "as one, as in `array` of a device."
    )
    bus: Reference | None = optional(
        "The bus that carries its commands, replies and events between nodes, where the model has "
        "several; without effect inside a node."
    )


class InnerBindingForm(AnyBindingForm):
    """A binding inside a component; one with its own interface delegates that."""

    from_: StarredPath = key(
        "`instance.interface`, a required one, or `interface`, one that the component provides.",
        alias="from",
    )
    to: StarredPath = key(
        "`instance.interface`, a provided one, or `interface`, one that the component requires."
    )
