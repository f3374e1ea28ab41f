# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The file format of buses and of what travels on them: a part of `schema`."""

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Tag
from pydantic import Field as PydanticField

from ravenchart.gen.model.authentication import AuthenticationName
from ravenchart.gen.model.protection import ProfileName

from .schema_base import (
    BitRate,
    Constant,
    DatabaseName,
    DatabaseText,
    DataRate,
    Element,
    Flag,
    Name,
    OwnedReference,
    PositiveSpan,
    Reference,
    Span,
    StarredReference,
    key,
    optional,
    shaped,
)


def _policy(value: Any) -> str | None:
    """The tag of a policy of recovery."""
    if isinstance(value, dict):
        return next((f"<{name}>" for name in ("after", "on") if name in value), None)
    return "<one>"


RECOVERY = Discriminator(
    _policy,
    custom_error_type="choice",
    custom_error_message="recovery is `automatic`, or a mapping with one of the keys `after`, `on`",
)


class ErrorsForm(Element):
    """The errors of a bus that the analysis assumes."""

    period: PositiveSpan = key("Least time from one error to the next.")
    burst: int = PydanticField(
        default=1, ge=1, le=1000, description="Further errors that may occur at once, 1 to 1000."
    )


class WatchForm(Element):
    """When each node looks at how its controller stands on the bus: the row `bus.watch`."""

    period: PositiveSpan = key("Time from one look to the next.")
    wcet: PositiveSpan = key(
        "Worst-case execution time of one look, the events it raises included."
    )
    deadline: PositiveSpan | None = optional("Relative deadline; the period unless given.")


class DelayedForm(Element):
    """Recovery from bus-off after a delay."""

    after: PositiveSpan = key(
        "Recovery is requested so long after a look has found bus-off, in whole periods of "
        "`watch`, rounded up."
    )


class RequestedForm(Element):
    """Recovery from bus-off when a chart requests it."""

    on: list[StarredReference] = key(
        "`instance.Event`s that request it on the node of the instance; each node of the bus needs "
        "one.",
        min_length=1,
        max_length=64,
    )


class BusForm(Element):
    """A CAN bus."""

    bit_rate: BitRate = key("Nominal bit rate, 10 kbit/s to 1 Mbit/s.")
    driver_wcet: PositiveSpan = key(
        "Worst-case time of the driver for one frame in or out, and of the reception for handing "
        "one to every port that it goes to."
    )
    receive_depth: int = key("Received frames that wait at most, 1 to 1024.", ge=1, le=1024)
    transmit_depth: int = key("Frames to send that wait at most, 1 to 1024.", ge=1, le=1024)
    buffers: Literal["fifo", "priority"] = PydanticField(
        default="fifo",
        description="Which of a controller's frames goes to the bus first. `fifo`: the one that "
        "was sent first. `priority`: the most urgent; a node then sends at most as many messages "
        "as it has transmit buffers (`transmit_depth`, 8 at most), each within its period.",
    )
    errors: ErrorsForm | None = optional("Errors that delay frames; none unless given.")
    watch: WatchForm | None = optional(
        "When each node looks at its controller; the three lists below need it, and so does "
        "`recovery` with `after`. Each node of the bus then has the row `bus.watch` in one table."
    )
    on_error_passive: list[StarredReference] | None = optional(
        "`instance.Event`s raised when the controller of the instance's node has become "
        "error-passive (ISO 11898-1).",
        min_length=1,
        max_length=64,
    )
    on_bus_off: list[StarredReference] | None = optional(
        "`instance.Event`s raised when it has become bus-off.", min_length=1, max_length=64
    )
    on_recovered: list[StarredReference] | None = optional(
        "`instance.Event`s raised when it is error-active again after either.",
        min_length=1,
        max_length=64,
    )
    recovery: (
        Annotated[
            Annotated[Literal["automatic"], Tag("<one>")]
            | Annotated[DelayedForm, Tag("<after>")]
            | Annotated[RequestedForm, Tag("<on>")],
            RECOVERY,
        ]
        | None
    ) = optional(
        "Who requests recovery from bus-off; 128 times 11 recessive bits later the controller is "
        "back. `automatic`, which holds unless given: the driver, at once. `{after: 100 ms}`: the "
        "row `bus.watch`, after that time. `{on: [instance.Event]}`: the chart that raises the "
        "event."
    )
    data_rate: DataRate | None = optional(
        "Bit rate of the data of CAN FD frames, 10 kbit/s to 10 Mbit/s, not below `bit_rate`; they "
        "do not switch unless given. With it, what connections and commands between nodes carry is "
        "CAN FD where it needs more than 8 bytes."
    )
    identifiers: Literal["deadline", "audsley"] = PydanticField(
        default="deadline",
        description="How messages without `id` get one. `deadline`: the shortest deadline first. "
        "`audsley`: an order in which the bus meets all deadlines. Where no message "
        "has an `id` of its own, it is found whenever there is one. Of several messages that "
        "fit a place, the one with the longest deadline takes it. The search takes each "
        "message as sent without delay, since the delay of a sender may depend on the "
        "identifiers. The analysis of the whole system then checks the chosen order.",
    )


class SignalForm(Element):
    """Where a field of a message stands in the frame, and how it is coded there."""

    start: int | None = optional(
        "Its first bit, counted from bit 0 of byte 0: the least significant one of an Intel "
        "signal, the most significant one of a Motorola signal. Without it an Intel signal comes "
        "as low as there is room.",
        ge=0,
        le=511,
    )
    width: int | None = optional("Bits, 1 to 64; the fewest possible unless given.", ge=1, le=64)
    order: Literal["intel", "motorola"] = PydanticField(
        default="intel",
        description="`intel`: the least significant byte goes first; `motorola`: the most "
        "significant one, and `start` must be given.",
    )
    signed: bool = PydanticField(
        default=False, description="The raw value is in two's complement, of 62 bits at most."
    )
    offset: int | None = optional(
        "Raw value = value - offset; the least value of the type unless given, 0 where `signed`."
    )
    codes: list[int] | None = optional(
        "Raw values of the literals of an enumeration, in their order; their positions from 0 "
        "unless given.",
        min_length=1,
        max_length=256,
    )
    other: Reference | None = optional(
        "The literal of an enumeration for every raw value that `codes` gives to no other literal. "
        "Its own code is sent for it. Without it such raw values are refused."
    )
    when: (
        Annotated[
            Annotated[Constant, Tag("<one>")] | Annotated[list[Constant], Tag("<list>")],
            shaped("a value of the multiplexor, or a list of these"),
        ]
        | None
    ) = optional("Values of the multiplexor with which it is in the frame; always unless given.")
    database_name: DatabaseName | None = optional(
        "Its name in the database of the bus (DBC): an identifier of C, of up to 128 characters, "
        "that no other signal of the message has; the field's name unless given."
    )
    value_names: dict[Reference, DatabaseText] | None = optional(
        "Of an enumeration: literals, each with its name in the database of the bus, printable "
        'ASCII of up to 128 characters without `"` and `\\`; the literal unless given.',
        min_length=1,
    )


class ProtectionForm(Element):
    """End-to-end protection of a message: its header is at byte 0 of the frame."""

    profile: ProfileName = key(
        "The AUTOSAR E2E profile: `e2e_p1`, `e2e_p1b`, `e2e_p1c` (variants 1A, 1B, 1C), `e2e_p2`, "
        "`e2e_p5`, `e2e_p11`, `e2e_p11c` (11A, 11C)."
    )
    data_id: int | None = optional(
        "Data identifier, 0 to 0xFFFF; with `e2e_p1c` and `e2e_p11c` to 0x0FFF. Not with `e2e_p2`.",
        ge=0,
        le=0xFFFF,
    )
    data_ids: list[int] | None = optional(
        "With `e2e_p2`: 16 data identifiers, 0 to 0xFF, one for each value of the counter.",
        min_length=16,
        max_length=16,
    )
    max_delta: int = PydanticField(
        default=1,
        ge=1,
        le=254,
        description="The largest step of the counter that is used: `max_delta` - 1 frames may be "
        "lost. Less than the largest counter: 13 at most with `e2e_p1*` and `e2e_p11*`, 14 with "
        "`e2e_p2`, 254 with `e2e_p5`.",
    )
    sync: int = PydanticField(
        default=1,
        ge=1,
        le=14,
        description="Frames in sequence after the first one, and after one out of sequence, until "
        "a value is used again, 1 to 14.",
    )
    on_error: list[StarredReference] | None = optional(
        "`instance.Event`s raised on the node of the instance, which receives the message, for "
        "each frame that is corrupted, of another sender, repeated or out of sequence.",
        min_length=1,
        max_length=64,
    )


class AuthenticationForm(Element):
    """Authentication of a CAN FD message: freshness value and MAC are the last bytes of the frame.

    The user writes the unit that computes MACs (`user/*-authentication.adb`).
    """

    profile: AuthenticationName = key(
        "`secoc`: the MAC is of data identifier, data and whole freshness value (AUTOSAR SecOC)."
    )
    data_id: int = key(
        "Data identifier, 0 to 0xFFFF; no other message with the same key has it.", ge=0, le=0xFFFF
    )
    key_: Name = key("The name by which the user's unit knows the key.", alias="key")
    freshness_bits: Literal[8, 16, 24, 32, 40, 48, 56, 64] = PydanticField(
        default=64,
        description="Low bits of the freshness value in the frame, in whole bytes. With fewer than "
        "64 the receiver follows as long as fewer than 2^`freshness_bits` frames in a row are "
        "lost.",
    )
    mac_bits: Literal[24, 32, 40, 48, 56, 64, 72, 80, 88, 96, 104, 112, 120, 128] = PydanticField(
        default=64, description="First bits of the MAC in the frame, in whole bytes."
    )
    mac_wcet: PositiveSpan = key(
        "Worst-case time for the MAC of one frame: counts in addition to the `wcet` of the row "
        "that sends, and to `driver_wcet` where the frame is received."
    )
    on_error: list[StarredReference] | None = optional(
        "`instance.Event`s raised on the node of the instance, which receives the message, for "
        "each frame that is not verified.",
        min_length=1,
        max_length=64,
    )


class TransmissionForm(Element):
    """The transmission mode of a message: when a frame of it goes (AUTOSAR COM)."""

    mode: Literal["periodic", "on_change", "on_event", "mixed"] = key(
        "`periodic`: one for each value that the row sends, as without `send`. `on_change`: at the "
        "end of an execution of the row, if the value differs from the last one sent. `on_event`: "
        "if the row has sent a value since the last frame. `mixed`: as `on_change`, and the last "
        "value again every `period`."
    )
    minimum_delay: PositiveSpan | None = optional(
        "The least time from one frame to the next, a multiple of the period of the row; that "
        "period unless given. A value that comes earlier waits; a newer one takes its place."
    )
    period: PositiveSpan | None = optional(
        "With `mixed`: the longest time from one frame to the next, a multiple of the period of "
        "the row."
    )


class TransportForm(Element):
    """The value of a message in several classic frames: ISO-TP (ISO 15765-2), normal addressing."""

    profile: Literal["iso_tp"] = key("`iso_tp`.")
    flow_id: int = key(
        "CAN identifier of the frames of flow control, which the receiver sends; in the format "
        "of the message.",
        ge=0,
        le=0x1FFFFFFF,
    )
    block: int = PydanticField(
        default=0,
        ge=0,
        le=255,
        description="Consecutive frames that the receiver asks for at once (block size), 0 to "
        "255; 0: all that are left.",
    )
    separation: Span | None = optional(
        "Least time between two consecutive frames (STmin): 100 us to 900 us in steps of 100 us, "
        "or up to 127 ms in steps of 1 ms; none unless given."
    )
    flow_limit: int = PydanticField(
        default=0,
        ge=0,
        le=255,
        description="How often in a row the sender takes flow control that says wait (N_WFTmax).",
    )
    timeout: PositiveSpan | None = optional(
        "How long the sender waits for flow control (N_Bs), and the receiver for the next frame "
        "(N_Cr); 1 s unless given."
    )


class MessageForm(Element):
    """A port's value on a CAN bus, or with `bytes` a frame that others send to others."""

    bus: Reference = key("The bus.")
    id: int | None = optional(
        "CAN identifier, 0 to 0x7FF, or to 0x1FFFFFFF with `extended: true`; unless given, "
        "counted from 1 in the order that `identifiers` of the bus says.",
        ge=0,
    )
    extended: bool = PydanticField(default=False, description="A 29-bit identifier.")
    format: Literal["classic", "fd"] = PydanticField(
        default="classic",
        description="`classic` with up to 8 bytes, or `fd`, a CAN FD frame of up to 64. All "
        "nodes of its bus must then take CAN FD, also those outside the model.",
    )
    from_: OwnedReference | None = optional(
        "`instance.port` that sends; without it the sender is outside the system.", alias="from"
    )
    to: (
        Annotated[
            Annotated[StarredReference, Tag("<one>")]
            | Annotated[list[StarredReference], Tag("<list>")],
            shaped("`instance.port`, or a list of these"),
        ]
        | None
    ) = optional("`instance.port` that receives, or a list; without it all receivers are outside.")
    period: PositiveSpan | None = optional(
        "Time between two frames, the least one where they are sporadic; only for messages from "
        "outside, the others have the period of what sends them."
    )
    sporadic: Flag | None = optional(
        "For a message from outside. `yes` (unless given): `period` is only the "
        "least time between two frames, and the next one may never come. `no`: its sender "
        "queues one every `period` exactly. Reactions to a sporadic message are bounded; the "
        "age of values made from it is not."
    )
    send: TransmissionForm | None = optional(
        "When a frame goes, of a message with `from`; periodically unless given."
    )
    transport: TransportForm | None = optional(
        "The value has 9 to 64 bytes and travels in several classic frames, from one node of the "
        "model to another; none unless given."
    )
    bytes: int | None = PydanticField(
        default=None,
        ge=0,
        le=64,
        description="Data bytes, 0 to 8, of CAN FD up to 64; the fewest possible "
        "unless given. A frame "
        "with neither `from` nor `to` needs it: other nodes exchange it, and here it only takes "
        "its time on the bus.",
    )
    signals: dict[Name, SignalForm] | None = optional(
        "Position and coding of the fields in the frame, by name (`value` where the "
        "type has no fields). All other fields take the fewest bits possible, one behind the "
        "other.",
        min_length=1,
    )
    multiplexor: Reference | None = optional(
        "The field whose value selects the signals with `when` that are in the frame."
    )
    protection: ProtectionForm | None = optional(
        "End-to-end protection: counter and CRC in the frame; none unless given."
    )
    authentication: AuthenticationForm | None = optional(
        "Authentication: freshness value and MAC in the frame, which is CAN FD; none unless given. "
        "Not with `protection`."
    )
    deadline: PositiveSpan | None = optional(
        "From the release of what sends it, or from its arrival, until it is received; the period "
        "unless given."
    )
    database_name: DatabaseName | None = optional(
        "Its name in the database of the bus (DBC): an identifier of C, of up to 128 characters, "
        "that no other message of the bus has; its own name unless given."
    )
