# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Declarations and units of generated Ada as nodes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from ravenchart.gen.frozen import built, frozen

from .expressions import Arg, Attribute, Domain, Expr, Range, RangeConstrained
from .named import DottedName, Named, defining, identifier, ref
from .statements import Comment, Pragma, Stmt

# --- Types ---------------------------------------------------------------------------


@built
class IndexConstrained:
    """``mark (low .. high)``"""

    mark: DottedName
    bounds: Range

    def __init__(self, mark: Named, bounds: Range) -> None:
        self.mark, self.bounds = ref(mark), bounds


@frozen
class DerivedDefinition:
    """``new parent``"""

    parent: DottedName


@frozen
class RangeDefinition:
    """``range low .. high``"""

    bounds: Range


@frozen
class ModularDefinition:
    """``mod modulus``"""

    modulus: Expr


@built
class ArrayDefinition:
    """``array (index) of component``"""

    index: Domain
    component: DottedName

    def __init__(self, index: Domain | str, component: Named) -> None:
        self.index = ref(index) if isinstance(index, str) else index
        self.component = ref(component)


Subtype = DottedName | Attribute | RangeConstrained | IndexConstrained
"""A subtype mark, perhaps with a constraint."""
Definition = DerivedDefinition | RangeDefinition | ModularDefinition | ArrayDefinition


def _subtype(given: Subtype | str) -> Subtype:
    return ref(given) if isinstance(given, str) else given


# --- Declarations --------------------------------------------------------------------


@frozen
class AbstractState:
    """``(name with options)``: what the aspect of that name declares."""

    name: str
    options: tuple[str, ...]


class Aspect(NamedTuple):
    """One aspect; a Boolean one has no value."""

    name: str
    value: Expr | AbstractState | None = None


@built
class Param:
    """One formal parameter; ``mode`` is ``in``, ``out`` or ``in out``."""

    name: str
    mode: str
    type: DottedName | Attribute
    default: Expr | None

    def __init__(
        self,
        name: Named,
        mode: str,
        type: Named | Attribute,
        default: Expr | None = None,
    ) -> None:
        self.name, self.mode, self.default = defining(name), mode, default
        self.type = type if isinstance(type, Attribute) else ref(type)


@built
class EnumType:
    """An enumeration type; ``notes`` are comments on its literals, empty for one without."""

    name: str
    literals: tuple[str, ...]
    notes: tuple[Comment, ...]

    def __init__(
        self, name: Named, literals: Iterable[str], notes: tuple[Comment, ...] = ()
    ) -> None:
        self.name, self.notes = defining(name), notes
        self.literals = tuple(map(identifier, literals))


@built
class TypeDeclaration:
    """``type name is definition;``"""

    name: str
    definition: Definition

    def __init__(self, name: Named, definition: Definition) -> None:
        self.name, self.definition = defining(name), definition


@built
class SubtypeDeclaration:
    """``subtype name is base;``

    ``behind_package``: units that see it by themselves name it behind its package all the same.
    """

    name: str
    base: Subtype
    aspects: tuple[Aspect, ...]
    behind_package: bool

    def __init__(
        self,
        name: Named,
        base: Subtype | str,
        aspects: tuple[Aspect, ...] = (),
        behind_package: bool = False,
    ) -> None:
        self.name, self.base = defining(name), _subtype(base)
        self.aspects, self.behind_package = aspects, behind_package


@built
class RecordComponent:
    """One record component."""

    name: str
    type: Subtype
    initial: Expr | None

    def __init__(
        self,
        name: Named,
        type: Subtype | str,
        initial: Expr | None = None,
    ) -> None:
        self.name, self.type, self.initial = defining(name), _subtype(type), initial


@built
class RecordDeclaration:
    """A record type."""

    name: str
    components: tuple[RecordComponent, ...]

    def __init__(self, name: Named, components: tuple[RecordComponent, ...]) -> None:
        self.name, self.components = defining(name), components


@built
class Object:
    """An object or, without type, a named number."""

    name: str
    type: Subtype | ArrayDefinition | None
    value: Expr | None
    constant: bool
    aspects: tuple[Aspect, ...]

    def __init__(
        self,
        name: Named,
        type: Subtype | ArrayDefinition | str | None,
        value: Expr | None = None,
        constant: bool = False,
        aspects: tuple[Aspect, ...] = (),
    ) -> None:
        self.name, self.value = defining(name), value
        self.type = ref(type) if isinstance(type, str) else type
        self.constant, self.aspects = constant, aspects


@built
class Subprogram:
    """A subprogram: its spec, or its body when ``body`` or ``expression`` is given."""

    name: str
    params: tuple[Param, ...]
    result: DottedName | None
    aspects: tuple[Aspect, ...]
    declarations: tuple[Decl, ...]
    body: tuple[Stmt, ...] | None
    expression: Expr | None

    def __init__(
        self,
        name: Named,
        params: tuple[Param, ...] = (),
        result: Named | None = None,
        aspects: tuple[Aspect, ...] = (),
        declarations: tuple[Decl, ...] = (),
        body: tuple[Stmt, ...] | None = None,
        expression: Expr | None = None,
    ) -> None:
        self.name, self.params = defining(name), params
        self.result = None if result is None else ref(result)
        self.aspects, self.declarations = aspects, declarations
        self.body, self.expression = body, expression


@built
class GenericInstance:
    """``package name is new generic (...);``, or a ``procedure``.

    ``behind_package`` as in `SubtypeDeclaration`.
    """

    name: str
    generic: DottedName
    args: tuple[Arg, ...]
    kind: str
    behind_package: bool

    def __init__(
        self,
        name: Named,
        generic: Named,
        args: tuple[Arg, ...],
        kind: str = "package",
        behind_package: bool = False,
    ) -> None:
        self.name, self.generic, self.args = defining(name), ref(generic), args
        self.kind, self.behind_package = kind, behind_package


@built
class Package:
    """A package spec, or a body; nested or the unit itself.

    ``independent``: none of its subprograms calls another one of them.
    """

    name: DottedName
    items: tuple[Decl, ...]
    aspects: tuple[Aspect, ...]
    is_body: bool
    independent: bool

    def __init__(
        self,
        name: Named,
        items: tuple[Decl, ...],
        aspects: tuple[Aspect, ...] = (),
        is_body: bool = False,
        independent: bool = False,
    ) -> None:
        self.name, self.items, self.aspects = ref(name), items, aspects
        self.is_body, self.independent = is_body, independent


@frozen
class Protected:
    """A single protected object: its spec with what it holds, or without that its body."""

    name: str
    items: tuple[Subprogram, ...]
    kept: tuple[Object, ...] = ()
    aspects: tuple[Aspect, ...] = ()


@built
class SingleTask:
    """A single task: its spec with aspects, or its body."""

    name: str
    aspects: tuple[Aspect, ...]
    body: tuple[Stmt, ...] | None

    def __init__(
        self,
        name: Named,
        aspects: tuple[Aspect, ...] = (),
        body: tuple[Stmt, ...] | None = None,
    ) -> None:
        self.name, self.aspects, self.body = defining(name), aspects, body


@built
class FunctionRenaming:
    """``function name return result renames renamed;``: a literal stays static by it."""

    name: str
    result: DottedName
    renamed: DottedName

    def __init__(self, name: Named, result: Named, renamed: Named) -> None:
        self.name = ref(name).text
        self.result, self.renamed = ref(result), ref(renamed)


@built
class ObjectRenaming:
    """``name : type renames renamed;``"""

    name: str
    type: DottedName
    renamed: DottedName

    def __init__(self, name: Named, type: Named, renamed: Named) -> None:
        self.name = ref(name).text
        self.type, self.renamed = ref(type), ref(renamed)


@built
class PackageRenaming:
    """``package name renames renamed;``: a unit of its own."""

    name: DottedName
    renamed: DottedName

    def __init__(self, name: Named, renamed: Named) -> None:
        self.name, self.renamed = ref(name), ref(renamed)


@built
class UseType:
    """``use type name;``"""

    name: DottedName

    def __init__(self, name: Named) -> None:
        self.name = ref(name)


@frozen
class UsePackage:
    """``use name;``"""

    name: DottedName


Decl = (
    EnumType
    | TypeDeclaration
    | SubtypeDeclaration
    | RecordDeclaration
    | Object
    | Subprogram
    | GenericInstance
    | Package
    | Protected
    | SingleTask
    | FunctionRenaming
    | ObjectRenaming
    | UseType
    | UsePackage
    | Pragma
    | Comment
)

# --- Units ---------------------------------------------------------------------------


@frozen
class Unit:
    """A compilation unit with its context clause and header comment."""

    header: str
    withs: tuple[DottedName, ...]
    item: Package | Subprogram | GenericInstance | PackageRenaming

    @property
    def name(self) -> DottedName:
        """Its full name."""
        return ref(self.item.name)

    @property
    def is_body(self) -> bool:
        """Is it a body? Of a subprogram that is a unit there is no other."""
        match self.item:
            case Package(is_body=is_body):
                return is_body
            case Subprogram(body=body):
                return body is not None
        return False

    @property
    def file_name(self) -> str:
        """GNAT's name for the file that holds it."""
        return f"{self.name.file_stem}.{'adb' if self.is_body else 'ads'}"


SPARK = Aspect("SPARK_Mode")
