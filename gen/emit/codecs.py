"""Frame codecs: one pair of Pack and Unpack for each type that travels on a bus.

Little-endian bits in one 64-bit word, raw value = value - offset. Unpack
refuses raw values outside the type; a ghost lemma shows that what is packed
is what is unpacked.
"""

from __future__ import annotations

from ..model import Message, Signal, System
from ..terms import EnumerationType, IntegerType, RecordType
from .ada import (
    SPARK,
    Aggregate,
    Arg,
    Aspect,
    Assign,
    Chain,
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
    Ref,
    Return,
    Subprogram,
    Unit,
    UseType,
    arguments,
    both,
    call,
    chain,
    equal,
    number,
)
from .naming import ada_case, default_value, type_name

WORD = "Interfaces.Unsigned_64"


def emit_codecs(system: System, header: str) -> tuple[Unit, ...]:
    """Spec and body of the codecs; nothing for a system without messages."""
    layouts: dict[str, Message] = {}
    for message in system.messages:
        layouts.setdefault(message.type.name.lower(), message)
    if not layouts:
        return ()
    spec: list[Decl] = [UseType(WORD), UseType("Ravenchart.Number")]
    body: list[Decl] = []
    for message in layouts.values():
        codec = _Codec(system, message)
        spec += codec.spec()
        body += codec.body()
    name = f"{ada_case(system.name)}.Codecs"
    return (
        Unit(
            header,
            ("Interfaces",),
            Package(name, tuple(spec), (SPARK, Aspect("Pure"))),
        ),
        Unit(header, ("Ravenchart.Can",), Package(name, tuple(body), (SPARK,), is_body=True)),
    )


class _Codec:
    def __init__(self, system: System, message: Message) -> None:
        self.system, self.type, self.signals = system, message.type, message.signals
        self.name = ada_case(message.type.name)
        self.ada_type = type_name(system, message.type)

    def _raw_name(self, signal: Signal) -> str:
        return f"{self.name}_{ada_case(signal.field or 'value')}_Raw"

    def _item(self, signal: Signal, item: str) -> str:
        return item if signal.field is None else f"{item}.{ada_case(signal.field)}"

    def _position(self, signal: Signal, item: str) -> Expr:
        """The raw value of one field of ``item``, as an integer."""
        value = self._item(signal, item)
        if isinstance(signal.type, EnumerationType):
            return call(f"{type_name(self.system, signal.type)}'Pos", Ref(value))
        counted = call("Ravenchart.Number", Ref(value))
        if not signal.offset:
            return counted
        return Chain("-", (counted, number(signal.offset)))

    def _raw_of(self, signal: Signal, item: str) -> Expr:
        """The bits of one field of ``item``."""
        last = number(self._largest(signal))
        return call("Ravenchart.Can.To_Raw", self._position(signal, item), last)

    def _decoded(self, signal: Signal) -> Expr:
        raw = Ref(self._local(signal))
        if isinstance(signal.type, EnumerationType):
            return call(f"{type_name(self.system, signal.type)}'Val", raw)
        inner: Expr = call("Ravenchart.Number", raw)
        if signal.offset:
            inner = Chain("+", (inner, number(signal.offset)))
        return call(type_name(self.system, signal.type), inner)

    def _local(self, signal: Signal) -> str:
        return f"{ada_case(signal.field or 'value')}_Raw"

    def _largest(self, signal: Signal) -> int:
        if isinstance(signal.type, IntegerType):
            return signal.type.last - signal.type.first
        return len(signal.type.literals) - 1

    def spec(self) -> list[Decl]:
        word = Param("Word", "in", WORD)
        items: list[Decl] = []
        for s in self.signals:
            mask, last = (1 << s.width) - 1, s.start + s.width - 1
            shifted = f"Interfaces.Shift_Right (Word, {s.start})" if s.start else "Word"
            items.append(
                Subprogram(
                    self._raw_name(s),
                    (word,),
                    WORD,
                    expression=Ref(f"{shifted} and 16#{mask:X}#"),
                )
            )
            items.append(
                Comment(f"[{self.type.name}.{s.field or 'value'}] bits {s.start} .. {last}")
            )
        packed = both(*self._carries(f"Pack_{self.name}'Result", "Item"))
        valid = both(
            *(
                Chain("<=", (call(self._raw_name(s), Ref("Word")), number(self._largest(s))))
                for s in self.signals
            )
        )
        taken = both(*self._carries("Word", "Item"))

        items += [
            Subprogram(
                f"Pack_{self.name}",
                (Param("Item", "in", self.ada_type),),
                WORD,
                aspects=(Aspect("Post", packed),),
            ),
            Subprogram(
                f"Unpack_{self.name}",
                (word, Param("Item", "out", self.ada_type), Param("Valid", "out", "Boolean")),
                aspects=(
                    Aspect(
                        "Post",
                        both(equal(Ref("Valid"), valid), IfExpr(((Ref("Valid"), taken),), None)),
                    ),
                ),
            ),
            Comment("Valid when every raw value is in range; otherwise Item is the default."),
            Subprogram(
                f"Lemma_{self.name}_Survives",
                (Param("Item", "in", self.ada_type),),
                aspects=(Aspect("Ghost"),),
            ),
            Comment("What is packed is what is unpacked."),
        ]
        return items

    def _carries(self, word: str, item: str) -> list[Expr]:
        """For each field: its raw value in ``word`` is in range and is the field's of ``item``."""
        facts: list[Expr] = []
        for s in self.signals:
            raw = call(self._raw_name(s), Ref(word))
            facts.append(Chain("<=", (raw, number(self._largest(s)))))
            facts.append(equal(call("Ravenchart.Number", raw), self._position(s, item)))
        return facts

    def body(self) -> list[Decl]:
        return [self._join(), self._pack(), self._unpack(), self._lemma()]

    def _join(self) -> Subprogram:
        """The word of all raw values: bits alone, which is what provers of bit vectors like."""
        name = f"Word_Of_{self.name}"
        params = tuple(Param(self._local(s), "in", WORD) for s in self.signals)
        fits = both(
            *(
                Chain("<=", (Ref(self._local(s)), Ref(f"16#{(1 << s.width) - 1:X}#")))
                for s in self.signals
            )
        )
        kept = both(
            *(
                equal(call(self._raw_name(s), Ref(f"{name}'Result")), Ref(self._local(s)))
                for s in self.signals
            )
        )
        parts: list[Expr] = [
            call("Interfaces.Shift_Left", Ref(self._local(s)), number(s.start))
            if s.start
            else Ref(self._local(s))
            for s in self.signals
        ]
        return Subprogram(
            name,
            params,
            WORD,
            aspects=(Aspect("Pre", fits), Aspect("Post", kept)),
            expression=chain("or", parts),
        )

    def _pack(self) -> Subprogram:
        declarations = tuple(
            Object(self._local(s), WORD, self._raw_of(s, "Item"), constant=True)
            for s in self.signals
        )
        word = call(f"Word_Of_{self.name}", *(Ref(self._local(s)) for s in self.signals))
        return Subprogram(
            f"Pack_{self.name}",
            (Param("Item", "in", self.ada_type),),
            WORD,
            declarations=declarations,
            body=(Return(word),),
        )

    def _unpack(self) -> Subprogram:
        declarations = tuple(
            Object(self._local(s), WORD, call(self._raw_name(s), Ref("Word")), constant=True)
            for s in self.signals
        )
        good = both(
            *(Chain("<=", (Ref(self._local(s)), number(self._largest(s)))) for s in self.signals)
        )
        if isinstance(self.type, RecordType):
            built: Expr = Aggregate(
                tuple(Arg(ada_case(s.field or ""), self._decoded(s)) for s in self.signals)
            )
        else:
            built = self._decoded(self.signals[0])
        return Subprogram(
            f"Unpack_{self.name}",
            (
                Param("Word", "in", WORD),
                Param("Item", "out", self.ada_type),
                Param("Valid", "out", "Boolean"),
            ),
            declarations=declarations,
            body=(
                Assign("Valid", good),
                If(
                    ((Ref("Valid"), (Assign("Item", built),)),),
                    (Assign("Item", default_value(self.system, self.type)),),
                ),
            ),
        )

    def _lemma(self) -> Subprogram:
        name = f"Lemma_{self.name}_Survives"
        params = (Param("Item", "in", self.ada_type),)
        return Subprogram(
            name,
            params,
            declarations=(
                Object("Copy", self.ada_type),
                Object("Valid", "Boolean"),
            ),
            body=(
                Do(
                    f"Unpack_{self.name}",
                    arguments(call(f"Pack_{self.name}", Ref("Item")), Ref("Copy"), Ref("Valid")),
                ),
                Pragma("Assert", (both(Ref("Valid"), equal(Ref("Copy"), Ref("Item"))),)),
            ),
        )
