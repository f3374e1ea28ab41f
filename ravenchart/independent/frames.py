# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""CAN frames: how many bytes a value takes, and how long a frame is on the bus.

The longest frame with all stuff bits is that of Davis, Burns, Bril and Lukkien 2007, eq. 1:
C = (g + 8 s + 13 + (g + 8 s - 1) / 4) bit times, with g = 34 or 54. That of CAN FD follows
ISO 11898-1: the part at the nominal rate and the part that may be faster.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from .findings import UnusableError
from .model import Mapping, Model, integer

SIZES = (*range(1, 9), 12, 16, 20, 24, 32, 48, 64)
HEADERS = {"e2e_p1": 12, "e2e_p1b": 12, "e2e_p1c": 16, "e2e_p2": 12, "e2e_p5": 24}
HEADERS |= {"e2e_p11": 12, "e2e_p11c": 16}
"""Bits of the header of each profile of end-to-end protection (AUTOSAR PRS_E2EProtocol)."""


@dataclass(frozen=True, slots=True)
class Frame:
    """The form of a frame."""

    length: int
    extended: bool
    fd: bool

    @property
    def head(self) -> int:
        """Bits that stuffing can lengthen, but the data; of CAN FD those up to the switch."""
        if self.fd:
            return 36 if self.extended else 17
        return 54 if self.extended else 34

    @property
    def stuffed(self) -> int:
        """Bits that stuffing can lengthen."""
        return self.head + (5 if self.fd else 0) + 8 * self.length

    @property
    def early(self) -> int:
        """Stuff bits of a CAN FD frame before the switch."""
        return (self.head - 1) // 4

    @property
    def body(self) -> int:
        """Bits of a CAN FD frame between the switch and the end of its CRC; none of others."""
        if not self.fd:
            return 0
        checks = 4 + 17 + 6 if self.length <= 16 else 4 + 21 + 7
        return self.stuffed - self.head + (self.stuffed - 1) // 4 - self.early + checks

    @property
    def bits(self) -> int:
        """Bits at the nominal rate, with the 3 to the next frame."""
        if self.fd:
            return self.head + self.early + 13
        return self.stuffed + 13 + (self.stuffed - 1) // 4

    def time(self, rate: int, data_rate: int) -> int:
        """The longest transmission in ns, rounded up."""
        return up((Fraction(self.bits, rate) + Fraction(self.body, data_rate)) * 10**9)

    def parts(self) -> dict[str, int]:
        """The figures of a frame that the certificate states."""
        if not self.fd:
            return {"Length": self.length}
        parts = ("length", "head", "early", "stuffed", "body", "bits")
        return {part.capitalize(): getattr(self, part) for part in parts}


def up(value: Fraction) -> int:
    """Rounded up."""
    return -(-value.numerator // value.denominator)


# --- How many bytes ------------------------------------------------------------------


@dataclass(slots=True)
class _Signal:
    name: str
    width: int
    start: int | None
    motorola: bool
    pages: frozenset[str]

    def bits(self, start: int) -> set[int]:
        if not self.motorola:
            return set(range(start, start + self.width))
        found = set[int]()
        for _ in range(self.width):
            found.add(start)
            start += 15 if start % 8 == 0 else -1
        return found


def length_of(model: Model, kind: str | None, form: Mapping, fd: bool) -> int:
    """The bytes of a value of a type, laid out as the form of its message says."""
    if kind is None:
        return 0
    given = form.map("signals") if form else Mapping()
    protected = form.map("protection").text("profile") if form else None
    held = set(range(HEADERS.get(protected or "", 0)))
    signals = []
    for name, scalar in _scalars(model, kind):
        own = given.name(name)
        place = Mapping() if own is None else given.map(own)
        selects = bool(form) and (form.text("multiplexor") or "").lower() == name.lower()
        signals.append(_signal(model, name, scalar, place, selects))
    taken: list[tuple[_Signal, set[int]]] = []
    for signal in sorted(signals, key=lambda s: s.start is None):
        if signal.start is not None:
            taken.append((signal, signal.bits(signal.start)))
            continue
        busy = set(held)
        for other, bits in taken:
            if not signal.pages or not other.pages or signal.pages & other.pages:
                busy |= bits
        start = 0
        while clash := busy & set(range(start, start + signal.width)):
            start = max(clash) + 1
        taken.append((signal, signal.bits(start)))
    length = max(1, (max(max(bits) for _, bits in taken) + 8) // 8)
    if form and form.map("authentication"):
        sealed = form.map("authentication")  # AUTOSAR SecOC: freshness value and MAC come last
        length += (sealed.number("freshness_bits", 64) + sealed.number("mac_bits", 64)) // 8
    return next((size for size in SIZES if size >= length), length) if fd else length


def _scalars(model: Model, kind: str) -> list[tuple[str, str]]:
    """The fields of a type with the types of them; `value` where it has none."""
    types = model.section("types")
    own = types.name(kind)
    fields = types.map(own).map("fields") if own is not None else Mapping()
    return [(name, str(type_)) for name, type_ in fields.items()] or [("value", kind)]


def _signal(model: Model, name: str, kind: str, form: Mapping, selects: bool) -> _Signal:
    types = model.section("types")
    own = types.name(kind)
    low, high, is_range = 0, 1, False
    if own is not None:
        ends, values = types.map(own).texts("range"), types.map(own).texts("values")
        is_range = bool(ends)
        low, high = (integer(e) for e in ends) if ends else (0, len(values) - 1)
    elif kind.lower() != "boolean":
        raise UnusableError(f"the type {kind} is not declared")
    signed = bool(form) and form.true("signed")
    offset = low if is_range and not signed and not (selects and form) else 0
    if form and form.text("offset") is not None:
        offset = form.number("offset", 0)
    codes = [integer(code) for code in form.texts("codes")] if form else []
    if codes:
        low, high = min(codes), max(codes)
    low, high = low - offset, high - offset
    if signed:
        width = max(n if n >= 0 else -n - 1 for n in (low, high)).bit_length() + 1
    else:
        width = max(1, high.bit_length())
    start = form.number("start", 0) if form and form.text("start") is not None else None
    if form:
        width = form.number("width", width)
    pages = frozenset(text.lower() for text in form.texts("when")) if form else frozenset[str]()
    return _Signal(name, width, start, bool(form) and form.text("order") == "motorola", pages)
