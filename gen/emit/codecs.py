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


def _container(signal: Signal) -> str:
    """The smallest type of bits that holds a signal: provers work bit by bit."""
    return f"Interfaces.Unsigned_{next(n for n in (8, 16, 32, 64) if signal.width <= n)}"


def _narrowed(signal: Signal, word: Expr) -> Expr:
    """A word as the bits of a signal."""
    return word if _container(signal) == WORD else call(_container(signal), word)


def _widened(signal: Signal, bits: str) -> Expr:
    """The bits of a signal as a word."""
    return Ref(bits) if _container(signal) == WORD else call(WORD, Ref(bits))


def emit_codecs(system: System, header: str) -> tuple[Unit, ...]:
    """Spec and body of the codecs; nothing for a system without messages."""
    layouts: dict[str, Message] = {}
    for message in system.messages:
        layouts.setdefault(message.type.name.lower(), message)
    if not layouts:
        return ()
    kinds = {_container(s) for m in layouts.values() for s in m.signals} | {WORD}
    spec: list[Decl] = [UseType(k) for k in (*sorted(kinds), "Ravenchart.Number")]
    scalars = {s.type.name.lower(): s for m in layouts.values() for s in m.signals}
    body: list[Decl] = [f(system, s) for s in scalars.values() for f in (_bits, _value)]
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
        Unit(header, (), Package(name, tuple(body), (SPARK,), is_body=True)),
    )


def _largest(signal: Signal) -> int:
    if isinstance(signal.type, IntegerType):
        return signal.type.last - signal.type.first
    return len(signal.type.literals) - 1


def _raw_integer(system: System, signal: Signal, value: str) -> Expr:
    """The raw value of ``value`` as an integer."""
    if isinstance(signal.type, EnumerationType):
        return call(f"{type_name(system, signal.type)}'Pos", Ref(value))
    counted = call("Ravenchart.Number", Ref(value))
    return Chain("-", (counted, number(signal.offset))) if signal.offset else counted


def _bits_name(signal: Signal) -> str:
    return f"Bits_Of_{ada_case(signal.type.name)}"


def _bits(system: System, signal: Signal) -> Subprogram:
    """From a scalar to its bits: the one step from integers to bits, proved by itself."""
    name = _bits_name(signal)
    raw = _raw_integer(system, signal, "Item")
    result = Ref(f"{name}'Result")
    post = both(
        Chain("<=", (result, number(_largest(signal)))),
        equal(call("Ravenchart.Number", result), raw),
    )
    return Subprogram(
        name,
        (Param("Item", "in", type_name(system, signal.type)),),
        _container(signal),
        aspects=(Aspect("Post", post),),
        expression=call(_container(signal), raw),
    )


def _value(system: System, signal: Signal) -> Subprogram:
    """From the bits of a scalar back to it."""
    name, of_type = f"{ada_case(signal.type.name)}_Of_Bits", type_name(system, signal.type)
    if isinstance(signal.type, EnumerationType):
        result: Expr = call(f"{of_type}'Val", Ref("Raw"))
    else:
        counted: Expr = call("Ravenchart.Number", Ref("Raw"))
        if signal.offset:
            counted = Chain("+", (counted, number(signal.offset)))
        result = call(of_type, counted)
    back = _raw_integer(system, signal, f"{name}'Result")
    return Subprogram(
        name,
        (Param("Raw", "in", _container(signal)),),
        of_type,
        aspects=(
            Aspect("Pre", Chain("<=", (Ref("Raw"), number(_largest(signal))))),
            Aspect("Post", equal(call("Ravenchart.Number", Ref("Raw")), back)),
        ),
        expression=result,
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
        return _raw_integer(self.system, signal, self._item(signal, item))

    def _raw_of(self, signal: Signal, item: str) -> Expr:
        """The bits of one field of ``item``."""
        return call(_bits_name(signal), Ref(self._item(signal, item)))

    def _decoded(self, signal: Signal) -> Expr:
        return call(f"{ada_case(signal.type.name)}_Of_Bits", Ref(self._local(signal)))

    def _local(self, signal: Signal) -> str:
        return f"{ada_case(signal.field or 'value')}_Raw"

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
                    _container(s),
                    expression=_narrowed(s, Ref(f"{shifted} and 16#{mask:X}#")),
                )
            )
            items.append(
                Comment(f"[{self.type.name}.{s.field or 'value'}] bits {s.start} .. {last}")
            )
        packed = both(*self._carries(f"Pack_{self.name}'Result", "Item"))
        valid = both(
            *(
                Chain("<=", (call(self._raw_name(s), Ref("Word")), number(_largest(s))))
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
            facts.append(Chain("<=", (raw, number(_largest(s)))))
            facts.append(equal(call("Ravenchart.Number", raw), self._position(s, item)))
        return facts

    def body(self) -> list[Decl]:
        return [self._join(), self._pack(), self._unpack(), self._lemma()]

    def _join(self) -> Subprogram:
        """The word of all raw values: bits alone, which is what provers of bit vectors like."""
        name = f"Word_Of_{self.name}"
        params = tuple(Param(self._local(s), "in", _container(s)) for s in self.signals)
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
            call("Interfaces.Shift_Left", _widened(s, self._local(s)), number(s.start))
            if s.start
            else _widened(s, self._local(s))
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
            Object(self._local(s), _container(s), self._raw_of(s, "Item"), constant=True)
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
            Object(
                self._local(s), _container(s), call(self._raw_name(s), Ref("Word")), constant=True
            )
            for s in self.signals
        )
        good = both(
            *(Chain("<=", (Ref(self._local(s)), number(_largest(s)))) for s in self.signals)
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
