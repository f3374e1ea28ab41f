"""The timing certificate: every term a named number, every claim checked by the compiler.

For each task the response-time recurrence (Joseph and Pandya 1986; Audsley et
al. 1993) is evaluated at the claimed bound R: W = C + B + sum of
ceil ((R + J) / T) * C over the tasks of the same or higher priority. W <= R
and R <= T show that R bounds the response of the first and only job of the
busy period; R <= D is the deadline. The recurrence runs from the release, so a
task's own jitter is added to the claim before it is compared.
"""

from __future__ import annotations

from collections.abc import Mapping

from ..model import Processor, SharedObject, System, Task
from ..terms import Ns
from .ada import (
    SPARK,
    Aspect,
    Chain,
    Comment,
    Decl,
    Expr,
    Object,
    Package,
    Pragma,
    Ref,
    Unit,
    chain,
    number,
)
from .naming import ada_case, constant_name


def emit_certificate(system: System, bounds: Mapping[str, Ns], header: str) -> Unit:
    """``bounds`` claims a response time for every task, in ns from its release."""
    items: list[Decl] = [
        Comment(
            "Times in nanoseconds. For each task: T period or least separation, D deadline, "
            "C budget with two context switches, B blocking, J release jitter, R the claimed "
            "response time, W the demand that arises within R."
        )
    ]
    for node in system.nodes:
        name = ada_case(node.name)
        items.append(
            Object(f"{name}_Context_Switch", None, number(node.context_switch), constant=True)
        )
        items.append(
            Object(f"{name}_Critical_Section", None, number(node.critical_section), constant=True)
        )
    for task in system.tasks:
        items += _terms(system, task, bounds[task.element])
    for task in system.tasks:
        items += _claims(system, task)
    package = Package(
        f"{ada_case(system.name)}.Timing_Certificate", tuple(items), (SPARK, Aspect("Pure"))
    )
    return Unit(header, (), package)


def blocker(system: System, task: Task) -> SharedObject | None:
    """The object through which a task of lower priority can delay ``task`` longest."""
    level = {t.element: t.priority for t in system.tasks} | {"main": 0}
    found: SharedObject | None = None
    for item in system.objects:
        lower = any(level[u] < task.priority for u in item.users)
        longer = found is None or item.section > found.section
        if item.node == task.node and item.ceiling >= task.priority and lower and longer:
            found = item
    return found


def _terms(system: System, task: Task, bound: Ns) -> list[Decl]:
    name = constant_name(task.element)
    node = ada_case(task.node)
    processor = _processor(system, task)
    items: list[Decl] = [Comment(f"[{task.element}]")]
    budgets: list[str] = []
    if processor is not None:
        for slot in processor.slots:
            budget = f"{constant_name(slot.element)}_Budget"
            items.append(Object(budget, None, number(slot.timing.wcet), constant=True))
            budgets.append(budget)
    else:
        items.append(
            Object(
                f"{name}_Budget",
                None,
                Ref(f"{task.budget:_} - 2 * {node}_Context_Switch"),
                constant=True,
            )
        )
        budgets.append(f"{name}_Budget")
    total = Chain("+", tuple(Ref(b) for b in (*budgets, f"2 * {node}_Context_Switch")))
    blocking = Ref(f"{node}_Critical_Section") if blocker(system, task) else number(0)
    for letter, value in (
        ("T", number(task.period)),
        ("D", number(task.deadline)),
        ("J", number(task.jitter)),
        ("C", total),
        ("B", blocking),
        ("R", number(bound)),
    ):
        items.append(Object(f"{name}_{letter}", None, value, constant=True))
    return items


def _processor(system: System, task: Task) -> Processor | None:
    return next((p for p in system.processors if p.name == task.element), None)


def _claims(system: System, task: Task) -> list[Decl]:
    own = constant_name(task.element)
    terms: list[Expr] = [Ref(f"{own}_C"), Ref(f"{own}_B")]
    for other in system.tasks:
        if other.node == task.node and other is not task and other.priority >= task.priority:
            name = constant_name(other.element)
            arrivals = Chain(
                "/",
                (
                    Chain("+", (Ref(f"{own}_R"), Ref(f"{name}_J"), Ref(f"({name}_T - 1)"))),
                    Ref(f"{name}_T"),
                ),
            )
            terms.append(Chain("*", (arrivals, Ref(f"{name}_C"))))
    label = task.element
    total = Chain("+", (Ref(f"{own}_R"), Ref(f"{own}_J")))
    return [
        Comment(f"[{label}] what can delay it"),
        Object(f"{own}_W", None, Chain("+", tuple(terms)), constant=True),
        _refuse((f"{own}_W",), f"{own}_R", label, "can take longer than its claimed response time"),
        _refuse((f"{own}_R",), f"{own}_T", label, "can be released again before it completes"),
        _refuse((f"{own}_R", f"{own}_J"), f"{own}_D", label, "can miss its deadline"),
        Pragma("Assert", (Chain("<=", (Ref(f"{own}_W"), Ref(f"{own}_R"))),)),
        Pragma("Assert", (Chain("<=", (total, Ref(f"{own}_D"))),)),
    ]


def _refuse(left: tuple[str, ...], right: str, element: str, problem: str) -> Pragma:
    """A build fails, with our words, when the sum of ``left`` exceeds ``right``."""
    total = chain("+", [Ref(name) for name in left])
    words = Chain("&", (Ref(f'"{element} "'), Ref(f'"{problem}"')))
    return Pragma("Compile_Time_Error", (Chain(">", (total, Ref(right))), words))
