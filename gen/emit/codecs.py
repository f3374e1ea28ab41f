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
    Say,
    Stmt,
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
    spec: list[Decl] = [UseType(WORD)]
    body: list[Decl] = []
    shifted = (s.offset for m in layouts.values() for s in m.signals)
    if any(shifted):
        body.append(UseType("Ravenchart.Number"))
    for message in layouts.values():
        codec = _Codec(system, message)
        spec += codec.spec()
        body += codec.body()
    name = f"{ada_case(system.name)}.Codecs"
    return (
        Unit(header, ("Interfaces",), Package(name, tuple(spec), (SPARK, Aspect("Pure")))),
        Unit(header, (), Package(name, tuple(body), (SPARK,), is_body=True)),
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

    def _encoded(self, signal: Signal, item: str) -> Expr:
        """The raw value of one field of ``item``."""
        value = self._item(signal, item)
        if isinstance(signal.type, EnumerationType):
            position = f"{type_name(self.system, signal.type)}'Pos"
            return call(WORD, call(position, Ref(value)))
        shifted = Chain("-", (Ref(value), number(signal.offset))) if signal.offset else Ref(value)
        return call(WORD, shifted)

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
        packed = chain(
            "and then",
            [
                equal(
                    call(self._raw_name(s), Ref(f"Pack_{self.name}'Result")),
                    self._encoded(s, "Item"),
                )
                for s in self.signals
            ],
        )
        valid = both(
            *(
                Chain("<=", (call(self._raw_name(s), Ref("Word")), number(self._largest(s))))
                for s in self.signals
            )
        )
        taken = both(
            *(
                equal(call(self._raw_name(s), Ref("Word")), self._encoded(s, "Item"))
                for s in self.signals
            )
        )
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

    def body(self) -> list[Decl]:
        return [self._pack(), self._unpack(), self._lemma()]

    def _pack(self) -> Subprogram:
        declarations: list[Decl] = []
        terms: list[Expr] = []
        claims: list[Stmt] = []
        for s in self.signals:
            local = self._local(s)
            declarations.append(Object(local, WORD, self._encoded(s, "Item"), constant=True))
            mask = (1 << s.width) - 1
            claims.append(Pragma("Assert", (Chain("<=", (Ref(local), Ref(f"16#{mask:X}#"))),)))
            shifted = Ref(f"Interfaces.Shift_Left ({local}, {s.start})") if s.start else Ref(local)
            terms.append(shifted)
        declarations.append(Object("Word", WORD))
        word = chain("or", terms)
        after = [
            Pragma("Assert", (equal(call(self._raw_name(s), Ref("Word")), Ref(self._local(s))),))
            for s in self.signals
        ]
        return Subprogram(
            f"Pack_{self.name}",
            (Param("Item", "in", self.ada_type),),
            WORD,
            declarations=tuple(declarations),
            body=(
                *claims,
                Assign("Word", word),
                *after,
                Say("return Word"),
            ),
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
