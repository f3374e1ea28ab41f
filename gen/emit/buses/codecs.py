# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Frame codecs: a Pack and an Unpack for each layout that travels on a bus.

A frame of up to 8 bytes is one 64-bit word, a longer one several: byte 0 is the lowest of the
first. Unpack refuses raw values outside the type. Of a multiplexed message it looks at the
signals of the page alone: the others are then the type's defaults. The contracts of both state
the frame's content by the layout table, and so without the codec's own functions. A ghost lemma
shows that Unpack gives back the packed value.
"""

from __future__ import annotations

from collections.abc import Callable

from ravenchart.gen.emit.ada.declarations import (
    SPARK,
    Aspect,
    Decl,
    Object,
    Package,
    Param,
    Subprogram,
    Unit,
    UseType,
)
from ravenchart.gen.emit.ada.expressions import (
    OTHERS,
    TRUE,
    Aggregate,
    Arg,
    Expr,
    Holder,
    IfExpr,
    Indexed,
    OperatorChain,
    Power,
    Prefix,
    bits,
    both,
    call,
    chain,
    equal,
    member,
    number,
    plain,
    record,
    result,
    signed,
)
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import NUMBER, ada_case, default_value, scalar, type_name
from ravenchart.gen.emit.ada.statements import (
    NULL,
    Assign,
    Comment,
    IfStatement,
    Pragma,
    Return,
    Stmt,
    do,
)
from ravenchart.gen.language.terms import RecordType, Type, default, has_one_value
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.signals import RAW_LIMIT, Signal, bits_of, signals_of
from ravenchart.gen.model.system import System

from .coding import (
    WORD,
    Coding,
    all_of,
    as_bits,
    choice_of_value,
    container,
    placed,
    within_width,
    word_bits,
)
from .layout_tables import ANY, FD, FRAME_ROW, LAYOUTS, LEMMAS, LayoutTable, frame_row, place

WORDS = ref("Ravenchart.Can.Fd_Frames.Fd_Words")
"""The words of a CAN FD frame."""

FD_WORDS = 8
"""How many there are."""


def _is(of_type: Type, left: Expr, right: Expr) -> Expr | None:
    """Are two values the same? None where the type has but one: the compiler warns of that."""
    return None if has_one_value(of_type) else equal(left, right)


def codec_name(message: Message) -> str:
    """The package of its codec: of the type, or of the message with a layout of its own.

    A layout is the type's where none is given. No codec of a type is called like one of a
    message, whatever the model calls them.
    """
    if _is_plain(message):
        return f"Type_{ada_case(message.type.name)}"
    return f"Message_{ada_case(message.name)}"


def _is_plain(message: Message) -> bool:
    """Has it the layout of its type?"""
    return message.signals == signals_of(message.type)


def words_of(message: Message) -> int:
    """Words that the signals of a message take."""
    return -(-bits_of(message.signals) // 64)


def emit_codecs(system: System, header: str) -> tuple[Unit, ...]:
    """Spec and body of the codecs; nothing for a system without messages."""
    layouts: dict[str, Message] = {}
    for message in (m for m in system.messages if not m.controls):
        layouts.setdefault(codec_name(message).lower(), message)
    if not layouts:
        return ()
    codecs = [_Codec(system, message) for message in layouts.values()]
    kinds = {container(s) for codec in codecs for s in codec.signals} | {WORD, NUMBER}
    spec: list[Decl] = [UseType(k) for k in sorted(kinds)]
    codings = [c for codec in codecs for c in codec.codings.values()]
    shared = {c.name.lower(): c for c in codings if c.is_shared}.values()
    spec += [c.spec() for c in shared]
    body: list[Decl] = [as_bits()] if any(c.is_wide_number for c in codings) else []
    body += [c.body() for c in shared]
    for codec in codecs:
        spec.append(Package(codec.name, tuple(codec.spec())))
        body.append(Package(codec.name, tuple(codec.body()), is_body=True))
    spec.append(FRAME_ROW)
    for message in system.messages:
        spec += [Comment(f"[{message.name}] the frame of this message"), frame_row(message)]
    name = ref(ada_case(system.name), "Codecs")
    withs: tuple[DottedName, ...] = (ref("Interfaces"), ANY, LAYOUTS)
    lemmas: tuple[DottedName, ...] = ()
    if any(codec.words > 1 for codec in codecs):
        withs, lemmas = (*withs, FD), (LEMMAS,)
    return (
        Unit(header, withs, Package(name, tuple(spec), (SPARK, Aspect("Pure")))),
        Unit(header, lemmas, Package(name, tuple(body), (SPARK,), is_body=True)),
    )


class _Codec:
    def __init__(self, system: System, message: Message) -> None:
        self.system, self.type, self.signals = system, message.type, message.signals
        self.name = codec_name(message)
        self.ada_type = type_name(system, message.type)
        self.codings = {s.name: Coding(system, s) for s in self.signals}
        self.words = words_of(message)
        self.frame = "Word" if self.words == 1 else "Words"
        self.frame_type = WORD if self.words == 1 else WORDS
        self.label = message.type.name if _is_plain(message) else message.name
        self.table = LayoutTable(system, self.signals)
        self.selector = next((s for s in self.signals if s.selects), None)

    def _raw_name(self, signal: Signal) -> str:
        return f"Raw_Of_{ada_case(signal.name)}"

    def _item(self, signal: Signal, item: str) -> DottedName:
        return ref(item) if signal.field is None else ref(item, ada_case(signal.field))

    def _local(self, signal: Signal) -> str:
        """The raw value of a signal, in a variable or parameter."""
        return f"Local_{ada_case(signal.name)}"

    def _word(self, frame: Holder) -> Callable[[int], Expr]:
        """A word of a frame by its number."""
        return lambda index: frame if self.words == 1 else Indexed(frame, plain(index))

    def _raw(self, signal: Signal, frame: Holder) -> Expr:
        """The bits of a signal of a frame."""
        return call(self._raw_name(signal), frame)

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
            return member(selected, *map(signed, signal.pages))
        values = [choice_of_value(self.system, self.selector, v) for v in self._values(signal)]
        return member(selected, *values)

    def _values(self, signal: Signal) -> list[int | str]:
        assert self.selector is not None
        return [self.selector.value(page) for page in signal.pages]

    def _selected(self, item: str) -> Expr:
        """The multiplexor of a value; anything where there is none."""
        return ref(item) if self.selector is None else self._item(self.selector, item)

    def _selected_local(self) -> Expr:
        return TRUE if self.selector is None else ref(self._local(self.selector))

    def _default(self, signal: Signal) -> Expr:
        value = default(signal.type)
        assert not isinstance(value, tuple)
        return scalar(self.system, signal.type, value)

    # --- The spec ----------------------------------------------------------------

    def spec(self) -> list[Decl]:
        """The layout table, the bits of each signal, Pack, Unpack and the lemma."""
        frame = Param(self.frame, "in", self.frame_type)
        items: list[Decl] = []
        for s in self.signals:
            items.append(Comment(f"[{self.label}.{s.name}] {place(s)}"))
            items += self.table.row(s)
        items.append(self.table.fits())
        for s in self.signals:
            raw = word_bits(s, self._word(ref(self.frame)))
            items.append(Subprogram(self._raw_name(s), (frame,), container(s), expression=raw))
        items += [c.spec() for c in self.codings.values() if not c.is_shared]
        items += [
            Subprogram(
                "Pack",
                (Param("Item", "in", self.ada_type),),
                self.frame_type,
                aspects=(Aspect("Post", all_of(*self._carries(), *self._gaps())),),
            ),
            Comment("The raw values stand where the table says; bits of no signal are 0."),
            Subprogram(
                "Unpack",
                (frame, Param("Item", "out", self.ada_type), Param("Valid", "out", "Boolean")),
                aspects=(*self._by_reference(), Aspect("Post", self._unpacked())),
            ),
            Comment("Valid is True when all bits stand for values."),
            Subprogram(
                "Lemma_Survives",
                (Param("Item", "in", self.ada_type),),
                aspects=(Aspect("Ghost"),),
            ),
            Comment("Unpack returns the value that Pack was given."),
        ]
        return items

    def _by_reference(self) -> list[Aspect]:
        """The aspect by which Unpack writes its record in place.

        GNAT hands a record of up to 16 bytes back by copy. The processor then waits until all
        fields are in memory before it reads them as one: three times as long in all. Records
        are passed by reference under convention C (Ada RM B.3, 69).
        """
        return [Aspect("Convention", ref("C"))] if isinstance(self.type, RecordType) else []

    def _there_in(self, signal: Signal, frame: Holder) -> Expr | None:
        """Does the table say that a signal is in a frame? None: it always is."""
        if self.selector is None or not signal.pages:
            return None
        return member(self.table.number_in(self.selector, frame), *map(signed, signal.pages))

    def _carries(self) -> list[Expr]:
        """For each field that is in the frame: its raw value is the item's."""
        selected = self._selected("Item")
        facts: list[Expr] = []
        for s in self.signals:
            same = equal(
                self.table.number_in(s, result("Pack")),
                self.table.raw_value(s, self._item(s, "Item")),
            )
            facts.append(self._when(s, same, selected, raw=False))
        return facts

    def _gaps(self) -> list[Expr]:
        """Bits of no signal are 0."""
        taken = sum(1 << bit for bit in {bit for s in self.signals for bit in s.bits()})
        facts: list[Expr] = []
        word = self._word(result("Pack"))
        for index in range(1 if self.words == 1 else FD_WORDS):
            free = ~(taken >> 64 * index) & (1 << 64) - 1
            if free == (1 << 64) - 1:
                facts.append(equal(word(index), number(0)))
            elif free:
                left = OperatorChain("and", (word(index), bits(free)))
                facts.append(equal(left, number(0)))
        return facts

    def _unpacked(self) -> Expr:
        """Valid as the table says it, and each field what the table says or its default."""
        valid: list[Expr] = []
        taken: list[Expr] = []
        for s in self.signals:
            shown = self.table.number_in(s, ref(self.frame))
            holds = self.table.has_value(s, shown)
            same = self.table.stands_for(s, shown, self._item(s, "Item"))
            there = self._there_in(s, ref(self.frame))
            if there is not None:
                absent = _is(s.type, self._item(s, "Item"), self._default(s))
                holds = TRUE if holds == TRUE else IfExpr(((there, holds),), None)
                same = IfExpr(((there, same),), absent)
            valid.append(holds)
            taken.append(same)
        if all_of(*valid) == TRUE:
            return all_of(ref("Valid"), *taken)
        other = _is(self.type, ref("Item"), default_value(self.system, self.type))
        read = IfExpr(((ref("Valid"), all_of(*taken)),), other)
        return all_of(equal(ref("Valid"), all_of(*valid)), read)

    def _decoded(self, signal: Signal, raw: Expr, selected: Expr) -> Expr:
        """The value of a field of a valid frame, where ``selected`` is its multiplexor."""
        decoded: Expr = call(self.codings[signal.name].value_of, raw)
        there = self._there(signal, selected, raw=True)
        return decoded if there is None else IfExpr(((there, decoded),), self._default(signal))

    # --- From the codec's own functions to the table -------------------------------

    def _bits_lemma(self, signal: Signal) -> Subprogram:
        """The bits that the codec takes are those of the row: a fact about bits alone."""
        return Subprogram(
            f"Lemma_Bits_{ada_case(signal.name)}",
            (Param(self.frame, "in", self.frame_type),),
            aspects=(
                Aspect("Ghost"),
                Aspect(
                    "Post",
                    equal(self._widened(signal), self.table.bits_in(signal, ref(self.frame))),
                ),
            ),
            body=self._bit_steps(signal),
        )

    def _bit_steps(self, signal: Signal) -> tuple[Stmt, ...]:
        if self.words == 1:
            return (NULL,)
        taken, lemmas = self.table.lemmas_of_bits(signal, ref(self.frame))
        return Pragma("Assert", (equal(self._widened(signal), taken),)), *lemmas

    def _widened(self, signal: Signal) -> Expr:
        raw = self._raw(signal, ref(self.frame))
        return raw if container(signal) == WORD else call(WORD, raw)

    def _value_lemma(self, signal: Signal) -> Subprogram:
        """The codec counts bits as the row does: a fact about numbers alone."""
        coding, raw = self.codings[signal.name], ref("Raw")
        shown = self.table.counted(signal, raw if container(signal) == WORD else call(WORD, raw))
        valid = coding.valid(raw)
        same = self.table.stands_for(signal, shown, call(coding.value_of, raw))
        holds = self.table.has_value(signal, shown)
        if signal.other is not None:
            sent = equal(shown, number(signal.raw(signal.other)))
            same = both(same, IfExpr(((equal(raw, coding.of_other()), sent),), None))
        if valid != TRUE:
            same = IfExpr(((valid, same),), None)
            holds = equal(valid, holds)
        fits = within_width(raw, signal)
        return Subprogram(
            f"Lemma_Value_{ada_case(signal.name)}",
            (Param("Raw", "in", container(signal)),),
            aspects=(
                Aspect("Ghost"),
                *([] if fits is None else [Aspect("Pre", fits)]),
                Aspect("Post", all_of(holds, same)),
            ),
            body=self._as_numbers(signal, shown),
        )

    def _as_numbers(self, signal: Signal, shown: Expr) -> tuple[Stmt, ...]:
        """The number of the row, case by case: provers take the step to numbers here alone."""
        counted: Expr = call(NUMBER, ref("Raw"))
        if signal.signed:
            below = OperatorChain("<=", (ref("Raw"), bits((1 << signal.width - 1) - 1)))
            full = number(1 << signal.width)
            counted = IfExpr(((below, counted),), OperatorChain("-", (counted, full)))
        elif container(signal) == WORD:
            below = OperatorChain("<=", (ref("Raw"), bits(RAW_LIMIT - 1)))
            counted = IfExpr(((below, counted),), Power(2, 62))
        steps: list[Expr] = [equal(shown, counted)]
        if container(signal) != WORD:
            widened = call(NUMBER, call(WORD, ref("Raw")))
            steps.insert(0, equal(widened, call(NUMBER, ref("Raw"))))
        return tuple(Pragma("Assert", (step,)) for step in steps)

    def _by_table(self, signal: Signal, frame: str) -> list[Stmt]:
        """The lemmas by which provers see that the table says the same of a frame."""
        name = ada_case(signal.name)
        return [
            do(f"Lemma_Bits_{name}", ref(frame)),
            do(f"Lemma_Value_{name}", ref(self._local(signal))),
        ]

    # --- The body ----------------------------------------------------------------

    def body(self) -> list[Decl]:
        """Codings, what joins the bits, then Pack, Unpack and the lemma."""
        own = [c.body() for c in self.codings.values() if not c.is_shared]
        lemmas = [made(s) for s in self.signals for made in (self._bits_lemma, self._value_lemma)]
        return [*own, *lemmas, self._join(), self._pack(), self._unpack(), self._lemma()]

    def _join(self) -> Subprogram:
        """The words of all raw values: bits alone, which is what provers of bit vectors like."""
        name = f"{self.frame}_Of"
        params = tuple(Param(self._local(s), "in", container(s)) for s in self.signals)
        selected = self._selected_local()
        fits: list[Expr] = []
        kept: list[Expr] = []
        for s in self.signals:
            local = ref(self._local(s))
            limit = within_width(local, s)
            fits += [] if limit is None else [limit]
            there = self._there(s, selected, raw=True)
            if there is not None:
                fits.append(IfExpr(((Prefix("not", there), equal(local, number(0))),), None))
            same = equal(self._raw(s, result(name)), local)
            kept.append(self._when(s, same, selected, raw=True))
        words = [
            chain(
                "or", [p for s in self.signals for p in placed(s, self._local(s), word)], number(0)
            )
            for word in range(self.words)
        ]
        before = [Aspect("Pre", all_of(*fits))] if fits else []
        joined = words[0]
        if self.words > 1:
            parts = [Arg(plain(index), word) for index, word in enumerate(words)]
            rest = () if self.words == FD_WORDS else (Arg(OTHERS, number(0)),)
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
            taken: Expr = call(self.codings[s.name].bits_of, self._item(s, "Item"))
            there = self._there(s, self._selected("Item"), raw=False)
            if there is not None:
                taken = IfExpr(((there, taken),), number(0))
            declarations.append(Object(self._local(s), container(s), taken, constant=True))
        word = call(ref(f"{self.frame}_Of"), *(ref(self._local(s)) for s in self.signals))
        return Subprogram(
            "Pack",
            (Param("Item", "in", self.ada_type),),
            self.frame_type,
            declarations=(*declarations, Object("Frame", self.frame_type, word, constant=True)),
            body=(
                *(step for s in self.signals for step in self._by_table(s, "Frame")),
                Return(ref("Frame")),
            ),
        )

    def _unpack(self) -> Subprogram:
        selected = self._selected_local()
        declarations = tuple(
            Object(self._local(s), container(s), self._raw(s, ref(self.frame)), constant=True)
            for s in self.signals
        )
        good: list[Expr] = []
        values: dict[str, Expr] = {}
        for s in self.signals:
            coding, local = self.codings[s.name], ref(self._local(s))
            good.append(self._when(s, coding.valid(local), selected, raw=True))
            values[ada_case(s.name)] = self._decoded(s, local, selected)
        is_valid = all_of(*good)
        if isinstance(self.type, RecordType):
            built: Expr = record(values)
        else:
            (built,) = values.values()
        item: Stmt = Assign("Item", built)
        if is_valid != TRUE:  # all bits may stand for values
            absent = Assign("Item", default_value(self.system, self.type))
            item = IfStatement(((ref("Valid"), (item,)),), (absent,))
        return Subprogram(
            "Unpack",
            (
                Param(self.frame, "in", self.frame_type),
                Param("Item", "out", self.ada_type),
                Param("Valid", "out", "Boolean"),
            ),
            declarations=declarations,
            body=(
                *(step for s in self.signals for step in self._by_table(s, self.frame)),
                Assign("Valid", is_valid),
                item,
            ),
        )

    def _lemma(self) -> Subprogram:
        differs = _is(self.type, ref("Copy"), ref("Item"))
        copy = "Copy" if differs else "Unused_Copy"
        same: list[Expr] = [differs or TRUE]
        if any(s.pages for s in self.signals):
            same = []
            for s in self.signals:
                fact = equal(self._item(s, "Copy"), self._item(s, "Item"))
                same.append(self._when(s, fact, self._selected("Item"), raw=False))
        return Subprogram(
            "Lemma_Survives",
            (Param("Item", "in", self.ada_type),),
            declarations=(
                Object(copy, self.ada_type),
                Object("Valid", "Boolean"),
            ),
            body=(
                do("Unpack", call("Pack", ref("Item")), ref(copy), ref("Valid")),
                Pragma("Assert", (all_of(ref("Valid"), *same),)),
            ),
        )
