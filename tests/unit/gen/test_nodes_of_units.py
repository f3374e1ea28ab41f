# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The nodes of generated Ada: how each prints, what a unit needs, and what is no name."""

from __future__ import annotations

import pytest

from ravenchart.gen.emit.ada.declarations import (
    SPARK,
    AbstractState,
    ArrayDefinition,
    Aspect,
    Decl,
    DerivedDefinition,
    EnumType,
    GenericInstance,
    IndexConstrained,
    ModularDefinition,
    Object,
    Package,
    Param,
    RangeDefinition,
    RecordComponent,
    RecordDeclaration,
    Subprogram,
    SubtypeDeclaration,
    TypeDeclaration,
    Unit,
    UsePackage,
    UseType,
)
from ravenchart.gen.emit.ada.expression_text import flat
from ravenchart.gen.emit.ada.expressions import (
    BOX,
    NOTHING,
    OTHERS,
    TRUE,
    Aggregate,
    Arg,
    Attribute,
    CaseExpr,
    ChoiceList,
    Expr,
    ForAll,
    ForSome,
    IfExpr,
    Indexed,
    IntegerLiteral,
    Membership,
    OperatorChain,
    Parenthesized,
    Power,
    Prefix,
    Qualified,
    Range,
    RangeConstrained,
    Selected,
    StringLiteral,
    all_else,
    between,
    bits,
    call,
    choice_of,
    equal,
    member,
    number,
    old,
    one_of,
    plain,
    record,
    result,
    select,
    signed,
    up_to,
)
from ravenchart.gen.emit.ada.named import DottedName, defining, ref
from ravenchart.gen.emit.ada.statements import (
    NULL,
    Assign,
    Case,
    Comment,
    DelayUntil,
    Do,
    ExitStatement,
    ForLoop,
    IfStatement,
    Loop,
    Pragma,
    RaiseStatement,
    Return,
    Stmt,
    case_of,
    do,
)
from ravenchart.gen.emit.ada.text import print_item, print_unit
from ravenchart.gen.emit.ada.walking import named_units, names_in, rewritten

A, B, I = ref("A"), ref("B"), ref("I")  # noqa: E741

EXPRESSIONS: list[tuple[Expr, str]] = [
    (ref("Root.Unit", "Name"), "Root.Unit.Name"),
    (Selected(Indexed("A", I), "B"), "A (I).B"),
    (Indexed(Attribute("A", "Old"), plain(1)), "A'Old (1)"),
    (select(old("A.B"), "C"), "A.B'Old.C"),
    (Attribute("System.Priority", "First"), "System.Priority'First"),
    (result("Next"), "Next'Result"),
    (Qualified(ref("T.Sub"), A), "T.Sub'(A)"),
    (IntegerLiteral(1_000), "1_000"),
    (plain(1_000), "1000"),
    (bits(255), "16#FF#"),
    (IntegerLiteral(0xA000_0004, base=16), "16#A000_0004#"),
    (number(-5), "(-5)"),
    (signed(-5), "-5"),
    (Power(2, 62), "2**62"),
    (StringLiteral('the "word"'), '"the ""word"""'),
    (NOTHING, "null"),
    (BOX, "<>"),
    (OperatorChain("and then", (A, B)), "A and then B"),
    (Prefix("not", equal(A, B)), "not (A = B)"),
    (Parenthesized(A), "(A)"),
    (member(A, "T.B", between(-1, 3)), "A in T.B | -1 .. 3"),
    (one_of(A, ["B", "C"]), "A in B | C"),
    (one_of(A, ["B"]), "A = B"),
    (one_of(A, []), "False"),
    (call("F.By", A, Other=B), "F.By (A, Other => B)"),
    (call(Attribute("T.E", "Pos"), A), "T.E'Pos (A)"),
    (record({"Left": A, "Right": B}, ref("T.Pair")), "T.Pair'(Left => A, Right => B)"),
    (all_else(BOX), "(others => <>)"),
    (Aggregate((Arg("Left", A),), base=B), "(B with delta Left => A)"),
    (Aggregate((Arg(plain(0), A), Arg(OTHERS, B))), "(0 => A, others => B)"),
    (IfExpr(((A, B),), None), "(if A then B)"),
    (IfExpr(((A, B), (B, A)), TRUE), "(if A then B elsif B then A else True)"),
    (
        CaseExpr(A, [("T.B", TRUE), (up_to(B), A), (OTHERS, B)]),
        "(case A is when T.B => True, when 1 .. B => A, when others => B)",
    ),
    (
        choice_of(A, [("B", TRUE), ("C", A), ("D", TRUE)]),
        "(case A is when B | D => True, when C => A)",
    ),
    (ForAll("I", up_to(B), A), "(for all I in 1 .. B => A)"),
    (ForSome("I", Attribute("A", "Range"), B), "(for some I in A'Range => B)"),
]


@pytest.mark.parametrize(("made", "text"), EXPRESSIONS, ids=[text for _, text in EXPRESSIONS])
def test_each_expression_prints_as_ada(made: Expr, text: str) -> None:
    assert flat(made) == text


def _printed(*items: Decl) -> list[str]:
    """The lines of declarations, without those of the package around them."""
    return print_item(Unit("", (), Package("P", items))).text.splitlines()[1:-1]


STATEMENTS: list[tuple[Stmt, list[str]]] = [
    (Assign("A.B", TRUE), ["A.B := True;"]),
    (Assign(Indexed("A", I), B), ["A (I) := B;"]),
    (do("X.Put", A, Other=B), ["X.Put (A, Other => B);"]),
    (Do("X.Put"), ["X.Put;"]),
    (
        IfStatement(((A, (NULL,)),), (Do("X"),)),
        ["if A then", "   null;", "else", "   X;", "end if;"],
    ),
    (
        Case(A, [("B", (NULL,)), (OTHERS, (Do("X"),))]),
        ["case A is", "   when B =>", "      null;", "   when others =>", "      X;", "end case;"],
    ),
    (
        case_of(A, [("B", (NULL,)), ("C", (NULL,))]),
        ["case A is", "   when B | C =>", "      null;", "end case;"],
    ),
    (Loop(None, (ExitStatement(),)), ["loop", "   exit;", "end loop;"]),
    (
        Loop(ForLoop("I", up_to(plain(3))), (ExitStatement(A),)),
        ["for I in 1 .. 3 loop", "   exit when A;", "end loop;"],
    ),
    (Loop(ForLoop("I", "T.Row"), (NULL,)), ["for I in T.Row loop", "   null;", "end loop;"]),
    (DelayUntil(ref("Next")), ["delay until Next;"]),
    (
        RaiseStatement(ref("Program_Error"), StringLiteral("no")),
        ['raise Program_Error with "no";'],
    ),
    (Return(A), ["return A;"]),
    (Pragma("Warnings", (ref("Off"), Arg("Reason", StringLiteral("why")))),
     ['pragma Warnings (Off, Reason => "why");']),
    (Comment("Words."), ["--  Words."]),
]  # fmt: skip


@pytest.mark.parametrize(("made", "lines"), STATEMENTS, ids=[lines[0] for _, lines in STATEMENTS])
def test_each_statement_prints_as_ada(made: Stmt, lines: list[str]) -> None:
    body = _printed(Subprogram("Run", body=(made,)))
    assert [line.removeprefix("      ") for line in body[2:-1]] == lines


DECLARATIONS: list[tuple[Decl, str]] = [
    (EnumType("E", ("A", "B")), "type E is (A, B);"),
    (TypeDeclaration("T", DerivedDefinition(ref("Base.T"))), "type T is new Base.T;"),
    (TypeDeclaration("T", RangeDefinition(up_to(plain(3)))), "type T is range 1 .. 3;"),
    (
        TypeDeclaration("T", ModularDefinition(OperatorChain("**", (plain(2), plain(32))))),
        "type T is mod 2 ** 32;",
    ),
    (TypeDeclaration("T", ArrayDefinition("E", "B.C")), "type T is array (E) of B.C;"),
    (
        TypeDeclaration("T", ArrayDefinition(up_to(plain(3)), "B.C")),
        "type T is array (1 .. 3) of B.C;",
    ),
    (SubtypeDeclaration("S", "Base.T"), "subtype S is Base.T;"),
    (
        SubtypeDeclaration("S", RangeConstrained("Base.T", Range(A, B))),
        "subtype S is Base.T range A .. B;",
    ),
    (Object("X", "Base.T", A), "X : Base.T := A;"),
    (
        Object("X", IndexConstrained("Base.T", up_to(plain(3))), constant=True),
        "X : constant Base.T (1 .. 3);",
    ),
    (Object("X", None, number(3), constant=True), "X : constant := 3;"),
    (Object("X", ArrayDefinition("E", "B.C")), "X : array (E) of B.C;"),
    (GenericInstance("G", "Lib.G", (Arg("Of_It", A),)), "package G is new Lib.G (Of_It => A);"),
    (UseType("Lib.T"), "use type Lib.T;"),
    (UsePackage(ref("Lib")), "use Lib;"),
    (RecordDeclaration("R", ()), "type R is null record;"),
    (
        Subprogram("F", (Param("P", "in out", "T"), Param("Q", "in", "B", TRUE)), "R.T"),
        "function F (P : in out T; Q : B := True) return R.T;",
    ),
]


@pytest.mark.parametrize(("made", "line"), DECLARATIONS, ids=[line for _, line in DECLARATIONS])
def test_each_declaration_prints_as_ada(made: Decl, line: str) -> None:
    assert [one.strip() for one in _printed(made)] == [line]


def test_the_options_of_an_abstract_state_stand_behind_its_name() -> None:
    state = Aspect("Abstract_State", AbstractState("Kept", ("Synchronous", "External")))
    text = print_unit(Unit("", (), Package("P", (), (SPARK, state))))
    assert "Abstract_State => (Kept with Synchronous, External)" in " ".join(text.split())


# --- What a unit needs -----------------------------------------------------------------

LIB = ref("Lib.Unit")
USED = ref(LIB, "Used")

NEEDING: dict[str, Decl] = {
    "parameter": Subprogram("P", (Param("X", "in", USED),)),
    "default": Subprogram("P", (Param("X", "in", "T", USED),)),
    "attribute of a parameter's type": Subprogram(
        "P", (Param("X", "in", Attribute(USED, "Base")),)
    ),
    "result": Subprogram("F", (), USED),
    "aspect": Subprogram("P", aspects=(Aspect("Global", record({"In_Out": USED})),)),
    "object": Object("X", USED),
    "constraint": Object("X", RangeConstrained("T", Range(number(0), USED))),
    "value": Object("X", "T", call("F", A, Other=USED)),
    "component": RecordDeclaration("R", (RecordComponent("C", USED),)),
    "array": TypeDeclaration("T", ArrayDefinition("E", USED)),
    "index of an array": TypeDeclaration("T", ArrayDefinition(USED, "E")),
    "parent": TypeDeclaration("T", DerivedDefinition(USED)),
    "subtype": SubtypeDeclaration("S", USED),
    "generic": GenericInstance("G", USED, ()),
    "actual of a generic": GenericInstance("G", "H", (Arg("Of_It", USED),)),
    "used type": UseType(USED),
    "called function": Object("X", "T", call(USED)),
    "type of an attribute": Object("X", "T", call(Attribute(USED, "Pos"), A)),
    "element": Object("X", "T", Selected(Indexed(USED, I), "C")),
    "index": Object("X", "T", Indexed("A", USED)),
    "qualification": Object("X", "T", Qualified(USED, A)),
    "type of an aggregate": Object("X", "T", record({"C": A}, USED)),
    "choice of an aggregate": Object("X", "T", Aggregate((Arg(USED, A),))),
    "base of an aggregate": Object("X", "T", Aggregate((Arg("C", A),), base=USED)),
    "choice": Object("X", "T", CaseExpr(A, [(ChoiceList((B, USED)), A), (OTHERS, B)])),
    "membership": Object("X", "T", Membership(A, ChoiceList((Range(A, USED),)))),
    "domain": Object("X", "T", ForAll("I", USED, A)),
    "condition": Object("X", "T", ForSome("I", "T", equal(USED, I))),
    "called procedure": Subprogram("P", body=(Do(USED),)),
    "target": Subprogram("P", body=(Assign(USED, A),)),
    "domain of a loop": Subprogram("P", body=(Loop(ForLoop("I", USED), (NULL,)),)),
    "choice of a statement": Subprogram("P", body=(Case(A, [(USED, (NULL,))]),)),
    "exit": Subprogram("P", body=(Loop(None, (ExitStatement(USED),)),)),
    "delay": Subprogram("P", body=(DelayUntil(USED),)),
    "exception": Subprogram("P", body=(RaiseStatement(USED, StringLiteral("why")),)),
    "pragma": Pragma("Assert", (equal(USED, A),)),
    "nested package": Package("Q", (UseType(USED),)),
    "declaration of a body": Subprogram("P", declarations=(Object("X", USED),), body=(NULL,)),
}


@pytest.mark.parametrize("place", NEEDING)
def test_a_unit_needs_what_a_name_in_it_is_of(place: str) -> None:
    found = named_units(Unit("", (), Package("P", (NEEDING[place],))))
    assert {ref("Lib"), LIB, USED} <= found


def test_a_unit_does_not_need_what_it_declares_selects_or_says() -> None:
    item = Package(
        "P",
        (
            Comment("Lib.Unit.Used"),
            Object("Lib", "T", StringLiteral("Lib.Unit")),
            Object("X", "T", record({"Lib": Selected(Indexed("A", I), "Unit")})),
        ),
    )
    assert {name.text for name in named_units(Unit("", (), item))} == {"P", "T", "A", "I"}


def test_static_functions_and_delta_aggregates_ask_for_the_newer_language() -> None:
    static = Subprogram("F", (), "T", (Aspect("Static"),), expression=A)
    changed = Object("X", "T", Aggregate((Arg("C", A),), base=B))
    for item, pragmas in ((static, 1), (changed, 2), (Object("Static", "T", A), 0)):
        assert print_unit(Unit("", (), Package("P", (item,)))).count("pragma ") == pragmas


def test_a_node_is_written_anew_where_something_in_it_changes() -> None:
    fact = IfExpr(((equal(A, B), old("A.C")),), None)
    changed = rewritten(fact, lambda node: ref("D") if node == old("A.C") else None)
    assert flat(changed) == "(if A = B then D)"
    assert rewritten(fact, lambda node: None) is fact
    assert list(names_in(changed)) == [A, B, ref("D")]


# --- What is no name -------------------------------------------------------------------


@pytest.mark.parametrize(
    "text",
    [
        *("", "A.", ".A", "A..B", "A B", "A (I)", "A'First", "A | B", "1 .. 2", "A + B", '"A"'),
        *("1", "1A", "_A", "A_", "A__B", "<>", "A := B", "-A", "\N{GREEK SMALL LETTER MU}A"),
        *("range", "A.Others", "NULL", "A => B", "A;"),
    ],
)
def test_a_text_that_is_no_name_is_refused(text: str) -> None:
    with pytest.raises(AssertionError, match="of Ada"):
        ref(text)
    with pytest.raises(AssertionError, match="of Ada"):
        Do(text)
    with pytest.raises(AssertionError, match="of Ada"):
        Object("X", text)
    with pytest.raises(AssertionError, match="of Ada"):
        CaseExpr(A, [(text, B)])


def test_a_declaration_introduces_one_identifier() -> None:
    assert defining("A") == defining(A) == "A"
    for text in ("A.B", "A (I)"):
        with pytest.raises((AssertionError, ValueError)):
            Object(text, "T")


def test_names_are_in_the_order_of_their_texts() -> None:
    texts = ["A.B", "A", "A_B", "AB", "A.B.C", "A.B_C", "A1"]
    assert [name.text for name in sorted(map(ref, texts))] == sorted(texts)


def test_a_name_knows_its_parts() -> None:
    name = ref("Root.Unit", "Name")
    assert name == DottedName(("Root", "Unit", "Name")) == ref(ref("Root.Unit"), "Name")
    assert (name.first, name.last, name.parent) == ("Root", "Name", ref("Root.Unit"))
    assert name.file_stem == "root-unit-name"
