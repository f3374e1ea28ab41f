"""Frame codecs: a Pack and an Unpack for each layout that travels on a bus.

A frame of up to 8 bytes is one 64-bit word, a longer one several: byte 0 is the lowest
of the first. Unpack refuses raw values outside the type, and of a multiplexed message
looks at the signals of its page alone: the others are then the type's defaults. A ghost
lemma shows that what is packed is what is unpacked.
"""

from __future__ import annotations

from collections.abc import Callable

from ..model import Message, System
from ..signals import ByteOrder, Signal, bits_of, signals_of
from ..terms import IntegerType, RecordType, default
from .ada import (
    SPARK,
    TRUE,
    Aggregate,
    Arg,
    Aspect,
    Assign,
    Comment,
    Decl,
    Do,
    Expr,
    If,
    IfExpr,
    Object,
    Package,
    Param,
    Pragma,
    Prefix,
    Ref,
    Return,
    Stmt,
    Subprogram,
    Unit,
    UseType,
    arguments,
    call,
    chain,
    equal,
    member,
    number,
)
from .coding import (
    NUMBER,
    WORD,
    Coding,
    all_of,
    as_bits,
    container,
    literal_name,
    placed,
    within_width,
    word_bits,
)
from .naming import ada_case, default_value, scalar, type_name

WORDS = "Ravenchart.Can.Fd_Frames.Fd_Words"
"""The words of a CAN FD frame."""

FD_WORDS = 8
"""How many there are."""


def codec_name(message: Message) -> str:
    """What its Pack and Unpack are called after: the type, or the message with a layout of its own.

    A layout is the type's where none is given.
    """
    plain = message.signals == signals_of(message.type)
    return ada_case(message.type.name if plain else message.name)


def words_of(message: Message) -> int:
    """Words that the signals of a message take."""
    return -(-bits_of(message.signals) // 64)


def emit_codecs(system: System, header: str) -> tuple[Unit, ...]:
    """Spec and body of the codecs; nothing for a system without messages."""
    layouts: dict[str, Message] = {}
    for message in system.messages:
        layouts.setdefault(codec_name(message).lower(), message)
    if not layouts:
        return ()
    codecs = [_Codec(system, message) for message in layouts.values()]
    kinds = {container(s) for codec in codecs for s in codec.signals} | {WORD}
    spec: list[Decl] = [UseType(k) for k in sorted(kinds)]
    if any(isinstance(s.type, IntegerType) for codec in codecs for s in codec.signals):
        spec.append(UseType(NUMBER))
    codings = {c.name.lower(): c for codec in codecs for c in codec.codings.values()}
    spec += [c.spec() for c in codings.values()]
    counted = any(c.is_wide_number for c in codings.values())
    body: list[Decl] = [as_bits()] if counted else []
    body += [c.body() for c in codings.values()]
    for codec in codecs:
        spec += codec.spec()
        body += codec.body()
    name = f"{ada_case(system.name)}.Codecs"
    withs: tuple[str, ...] = ("Interfaces",)
    if any(codec.words > 1 for codec in codecs):
        withs = ("Interfaces", "Ravenchart.Can.Fd_Frames")
    return (
        Unit(header, withs, Package(name, tuple(spec), (SPARK, Aspect("Pure")))),
        Unit(header, (), Package(name, tuple(body), (SPARK,), is_body=True)),
    )


class _Codec:
    def __init__(self, system: System, message: Message) -> None:
        self.system, self.type, self.signals = system, message.type, message.signals
        self.name = codec_name(message)
        self.ada_type = type_name(system, message.type)
        self.codings = {s.name: Coding(system, s, self.name) for s in self.signals}
        self.words = words_of(message)
        self.frame = "Word" if self.words == 1 else "Words"
        self.frame_type = WORD if self.words == 1 else WORDS
        self.label = message.type.name if self.name == ada_case(message.type.name) else message.name
        self.selector = next((s for s in self.signals if s.selects), None)

    @property
    def _joined(self) -> str:
        """What makes a frame of raw values."""
        return f"{self.frame}_Of_{self.name}"

    def _raw_name(self, signal: Signal) -> str:
        return f"{self.name}_{ada_case(signal.name)}_Raw"

    def _item(self, signal: Signal, item: str) -> str:
        return item if signal.field is None else f"{item}.{ada_case(signal.field)}"

    def _local(self, signal: Signal) -> str:
        return f"{ada_case(signal.name)}_Raw"

    def _word(self, frame: str) -> Callable[[int], str]:
        """A word of a frame by its number."""
        return lambda index: frame if self.words == 1 else f"{frame} ({index})"

    def _raw(self, signal: Signal, frame: str) -> Expr:
        """The bits of a signal of a frame."""
        return call(self._raw_name(signal), Ref(frame))

    # --- Pages of multiplexed messages -------------------------------------------

    def _when(self, signal: Signal, fact: Expr, selected: Expr, *, raw: bool) -> Expr:
        """A fact about a signal, if it is in the frame; ``selected`` is the multiplexor."""
        there = self._there(signal, selected, raw=raw)
        return fact if there is None or fact == TRUE else IfExpr(((there, fact),), None)

    def _there(self, signal: Signal, selected: Expr, *, raw: bool) -> Expr | None:
        """Is a signal in the frame? None: it always is. ``selected`` is a value unless ``raw``."""
        if self.selector is None or not signal.pages:
            return None
        if raw:
            return member(selected, " | ".join(f"{page:_}" for page in signal.pages))
        values = [literal_name(self.system, self.selector, v) for v in self._values(signal)]
        return member(selected, " | ".join(values))

    def _values(self, signal: Signal) -> list[int | str]:
        assert self.selector is not None
        return [self.selector.value(page) for page in signal.pages]

    def _selected(self, item: str) -> Expr:
        """The multiplexor of a value; anything where there is none."""
        return Ref(item if self.selector is None else self._item(self.selector, item))

    def _selected_raw(self, frame: str) -> Expr:
        return Ref(frame) if self.selector is None else self._raw(self.selector, frame)

    def _selected_local(self) -> Expr:
        return Ref("" if self.selector is None else self._local(self.selector))

    def _default(self, signal: Signal) -> Expr:
        value = default(signal.type)
        assert not isinstance(value, tuple)
        return scalar(self.system, signal.type, value)

    # --- The spec ----------------------------------------------------------------

    def spec(self) -> list[Decl]:
        """The bits of each signal, Pack, Unpack and the lemma."""
        frame = Param(self.frame, "in", self.frame_type)
        items: list[Decl] = []
        for s in self.signals:
            raw = word_bits(s, self._word(self.frame))
            items.append(Subprogram(self._raw_name(s), (frame,), container(s), expression=raw))
            items.append(Comment(f"[{self.label}.{s.name}] {_place(s)}"))
        packed = all_of(*self._carries())
        valid = all_of(*(self._is_valid(s, self.frame) for s in self.signals))
        taken: Expr = all_of(*self._taken())
        unpacked = all_of(Ref("Valid"), taken)
        if valid != TRUE:
            other = equal(Ref("Item"), default_value(self.system, self.type))
            taken = IfExpr(((Ref("Valid"), taken),), other)
            unpacked = all_of(equal(Ref("Valid"), valid), taken)
        items += [
            Subprogram(
                f"Pack_{self.name}",
                (Param("Item", "in", self.ada_type),),
                self.frame_type,
                aspects=(Aspect("Post", packed),),
            ),
            Subprogram(
                f"Unpack_{self.name}",
                (frame, Param("Item", "out", self.ada_type), Param("Valid", "out", "Boolean")),
                aspects=(
                    *self._by_reference(),
                    Aspect("Post", unpacked),
                ),
            ),
            Comment("Valid when all bits stand for values."),
            Subprogram(
                f"Lemma_{self.name}_Survives",
                (Param("Item", "in", self.ada_type),),
                aspects=(Aspect("Ghost"),),
            ),
            Comment("What is packed is what is unpacked."),
        ]
        return items

    def _by_reference(self) -> list[Aspect]:
        """What has Unpack write its record in place.

        GNAT hands a record of up to 16 bytes back by copy, and the processor waits until
        all fields are in memory before it reads them as one: three times as long in all.
        Records are passed by reference under convention C (Ada RM B.3, 69).
        """
        return [Aspect("Convention", Ref("C"))] if isinstance(self.type, RecordType) else []

    def _is_valid(self, signal: Signal, frame: str) -> Expr:
        valid = self.codings[signal.name].valid(self._raw(signal, frame))
        return self._when(signal, valid, self._selected_raw(frame), raw=True)

    def _carries(self) -> list[Expr]:
        """For each field that is in the frame: its bits stand for the item's."""
        facts: list[Expr] = []
        for s in self.signals:
            coding, raw = self.codings[s.name], self._raw(s, f"Pack_{self.name}'Result")
            same = equal(call(coding.value_of, raw), Ref(self._item(s, "Item")))
            for fact in (coding.valid(raw), same):
                facts.append(self._when(s, fact, self._selected("Item"), raw=False))
        return facts

    def _taken(self) -> list[Expr]:
        """Each field is what its bits stand for, or the default where a page has no room for it."""
        selected = self._selected_raw(self.frame)
        return [
            equal(Ref(self._item(s, "Item")), self._decoded(s, self._raw(s, self.frame), selected))
            for s in self.signals
        ]

    def _decoded(self, signal: Signal, raw: Expr, selected: Expr) -> Expr:
        """The value of a field of a valid frame, where ``selected`` is its multiplexor."""
        decoded: Expr = call(self.codings[signal.name].value_of, raw)
        there = self._there(signal, selected, raw=True)
        return decoded if there is None else IfExpr(((there, decoded),), self._default(signal))

    # --- The body ----------------------------------------------------------------

    def body(self) -> list[Decl]:
        """What joins the bits, then Pack, Unpack and the lemma."""
        return [self._join(), self._pack(), self._unpack(), self._lemma()]

    def _join(self) -> Subprogram:
        """The words of all raw values: bits alone, which is what provers of bit vectors like."""
        name = self._joined
        params = tuple(Param(self._local(s), "in", container(s)) for s in self.signals)
        selected = self._selected_local()
        fits: list[Expr] = []
        kept: list[Expr] = []
        for s in self.signals:
            local = Ref(self._local(s))
            limit = within_width(local, s)
            fits += [] if limit is None else [limit]
            there = self._there(s, selected, raw=True)
            if there is not None:
                fits.append(IfExpr(((Prefix("not", there), equal(local, number(0))),), None))
            same = equal(self._raw(s, f"{name}'Result"), local)
            kept.append(self._when(s, same, selected, raw=True))
        words = [
            chain("or", [p for s in self.signals for p in placed(s, self._local(s), word)])
            for word in range(self.words)
        ]
        before = [Aspect("Pre", all_of(*fits))] if fits else []
        joined = words[0]
        if self.words > 1:
            parts = [Arg(str(index), word) for index, word in enumerate(words)]
            rest = () if self.words == FD_WORDS else (Arg("others", number(0)),)
            joined = Aggregate((*parts, *rest))
        return Subprogram(
            name,
            params,
            self.frame_type,
            aspects=(*before, Aspect("Post", all_of(*kept))),
            expression=joined,
        )

    def _pack(self) -> Subprogram:
        declarations: list[Decl] = []
        for s in self.signals:
            taken: Expr = call(self.codings[s.name].bits_of, Ref(self._item(s, "Item")))
            there = self._there(s, self._selected("Item"), raw=False)
            if there is not None:
                taken = IfExpr(((there, taken),), number(0))
            declarations.append(Object(self._local(s), container(s), taken, constant=True))
        word = call(self._joined, *(Ref(self._local(s)) for s in self.signals))
        return Subprogram(
            f"Pack_{self.name}",
            (Param("Item", "in", self.ada_type),),
            self.frame_type,
            declarations=tuple(declarations),
            body=(Return(word),),
        )

    def _unpack(self) -> Subprogram:
        selected = self._selected_local()
        declarations = tuple(
            Object(self._local(s), container(s), self._raw(s, self.frame), constant=True)
            for s in self.signals
        )
        good: list[Expr] = []
        values: dict[str, Expr] = {}
        for s in self.signals:
            coding, local = self.codings[s.name], Ref(self._local(s))
            good.append(self._when(s, coding.valid(local), selected, raw=True))
            values[ada_case(s.name)] = self._decoded(s, local, selected)
        is_valid = all_of(*good)
        if isinstance(self.type, RecordType):
            built: Expr = Aggregate(tuple(Arg(name, value) for name, value in values.items()))
        else:
            (built,) = values.values()
        item: Stmt = Assign("Item", built)
        if is_valid != TRUE:  # all bits may stand for values
            absent = Assign("Item", default_value(self.system, self.type))
            item = If(((Ref("Valid"), (item,)),), (absent,))
        return Subprogram(
            f"Unpack_{self.name}",
            (
                Param(self.frame, "in", self.frame_type),
                Param("Item", "out", self.ada_type),
                Param("Valid", "out", "Boolean"),
            ),
            declarations=declarations,
            body=(Assign("Valid", is_valid), item),
        )

    def _lemma(self) -> Subprogram:
        same: list[Expr] = [equal(Ref("Copy"), Ref("Item"))]
        if any(s.pages for s in self.signals):
            same = []
            for s in self.signals:
                fact = equal(Ref(self._item(s, "Copy")), Ref(self._item(s, "Item")))
                same.append(self._when(s, fact, self._selected("Item"), raw=False))
        return Subprogram(
            f"Lemma_{self.name}_Survives",
            (Param("Item", "in", self.ada_type),),
            declarations=(
                Object("Copy", self.ada_type),
                Object("Valid", "Boolean"),
            ),
            body=(
                Do(
                    f"Unpack_{self.name}",
                    arguments(call(f"Pack_{self.name}", Ref("Item")), Ref("Copy"), Ref("Valid")),
                ),
                Pragma("Assert", (all_of(Ref("Valid"), *same),)),
            ),
        )


def _place(signal: Signal) -> str:
    """Where a signal stands, in words."""
    if signal.order is ByteOrder.INTEL:
        words = f"bits {signal.start} .. {signal.start + signal.width - 1}"
    else:
        words = f"{signal.width} bits from {signal.start} on, the most significant first"
    return f"{words}, signed" if signal.signed else words
