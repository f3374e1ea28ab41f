# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The timing certificate: named numbers and static functions, every claim checked by the compiler.

Both are exact and known before anything runs; a sum too large for a function is longer than any
window. A claimed bound is a time within which a job must be done. Beside it stands the demand that
can arise within that time. The least time that holds its demand bounds the response, so a claimed
bound that holds its demand is no less. The recurrences are those of Joseph and Pandya 1986,
Audsley et al. 1993 (tasks), Lehoczky 1990 (several jobs) and Davis, Burns, Bril, Lukkien 2007
(frames).
"""

from __future__ import annotations

from collections.abc import Sequence, Set

from ravenchart.gen.derive.instants import has_offset
from ravenchart.gen.emit.ada.declarations import (
    SPARK,
    Aspect,
    Decl,
    Object,
    Package,
    Subprogram,
    Unit,
    UsePackage,
)
from ravenchart.gen.emit.ada.expressions import (
    Attribute,
    Expr,
    OperatorChain,
    StringLiteral,
    call,
    number,
)
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import ada_case, priority
from ravenchart.gen.emit.ada.statements import Comment
from ravenchart.gen.emit.ada.walking import names_in
from ravenchart.gen.model.claims import ChainClaim, Claims
from ravenchart.gen.model.logical import logical_of
from ravenchart.gen.model.nodes import SUPERVISOR, Node
from ravenchart.gen.model.system import SharedObject, System, Task

from .buses import bus_claims, bus_terms
from .certified import CERTIFICATE
from .chains import chain_claims
from .demand import demand, has_phases, longest_of, sums, work_of_jobs
from .hops import hops_of
from .interference import UNIT, task_functions
from .mailboxes import mailbox_depths
from .offsets import offset_claims
from .protection import age_limited_ports, protection_claims
from .tables import driver_levels, order, table_terms
from .terms import (
    IN_WINDOWS,
    LATE,
    OVERLAP,
    RESPONSE,
    assured,
    exact,
    less_periods,
    name_of,
    named_number,
    plus,
    refuse,
    stated,
    times,
)
from .transport import transfer_claims, transferred

LETTERS = (
    "Times are in nanoseconds.\n"
    "T: period or least separation.\n"
    "D: deadline.\n"
    "J: longest time from the event to the release.\n"
    "C: longest execution (with context switches) or transmission.\n"
    "B: blocking.\n"
    "Wcet: worst-case execution time of an activity, with the commands that it calls.\n"
    "R: claimed response-time bound, from the event.\n"
    "W: claimed time from the start of a busy period.\n"
    "X_Up (W): demand within W of X and all of higher priority.\n"
    "X_Rest (W): demand within W of X and the later ones of its priority.\n"
    "Needs: the demand within W. If the demand is more than W, W is too short. If the demand is "
    "less, a term is missing.\n"
)

CLAIMED = (
    "The claimed response-time bounds: the bound of each element, and the jitter of those that it "
    "releases."
)


def emit_certificate(system: System, claims: Claims, header: str) -> Unit:
    """The certificate of a system; its claims are those of the analysis."""
    items: list[Decl] = [
        Comment("SHA-256 of the model; the program writes it into the trace."),
        Object("Model_Digest", "String", StringLiteral(system.digest), constant=True),
        UsePackage(UNIT),
        Comment(LETTERS),
    ]
    elements = [task.element for task in system.tasks] + [m.element for m in system.frames]
    items.append(Comment(CLAIMED))
    items += [stated(f"{name_of(one)}_R", claims.of(one).response) for one in elements]
    for node in system.nodes:
        own = ada_case(node.name)
        items += [
            Comment(f"[{node.name}] the times of the platform, each the longest"),
            stated(f"{own}_Context_Switch", node.context_switch),
            stated(f"{own}_Critical_Section", node.critical_section),
        ]
        items += [stated(_section(system, item), item.section) for item in _longer(system, node)]
        if node.release:
            items.append(stated(f"{own}_Release", node.release))
        if node.tick is not None:
            items.append(stated(f"{own}_Tick_T", node.tick.period))
            items.append(stated(f"{own}_Tick_C", node.tick.wcet))
    items += driver_levels(system)
    for task in system.tasks:
        items += _terms(system, task)
    for node in system.nodes:
        for core in range(1, node.cores + 1):
            items += task_functions(system, node, core)
            items += order(system, node, core)
    for bus in system.buses:
        items += bus_terms(system, bus)
    items += mailbox_depths(system)
    hops = {hop for chain in system.chains for hop in hops_of(system, chain)}
    rows = {hop.element for hop in hops if hop.kind == "row"}
    handed = {hop.element for hop in hops if hop.kind == "handed"}
    for message, end in age_limited_ports(system):
        received = system.reception(message, end)
        handed |= set() if received is None else {received.element}
    for _, _, there, back in transferred(system):
        handed |= {there.element, back.element}
    for task in system.tasks:
        items += _claims(system, task, claims, rows)
    for node in system.nodes:
        items += _silences(system, node)
    for bus in system.buses:
        items += bus_claims(system, bus, claims, handed)
    items += transfer_claims(system, claims)
    for chain in system.chains:
        items += chain_claims(system, chain, claims.chains.get(chain.name, ChainClaim()))
    items += protection_claims(system, claims)
    package = Package(
        ref(ada_case(system.name), CERTIFICATE), _used(items), (SPARK, Aspect("Pure"))
    )
    return Unit(header, (ref("System"), UNIT), package)


def _used(items: Sequence[Decl]) -> tuple[Decl, ...]:
    """Without the functions that nothing behind them calls."""
    kept: list[Decl] = []
    called: set[str] = set()
    for item in reversed(items):
        if not isinstance(item, Subprogram) or item.name in called:
            called |= {name.first for name in names_in(item)}
            kept.append(item)
    return tuple(reversed(kept))


def blocker(system: System, task: Task) -> tuple[SharedObject, str] | None:
    """The object through which a task of lower priority can delay ``task`` longest, and that."""
    level = {t.element: t.priority for t in system.tasks}
    found: tuple[SharedObject, str] | None = None
    for item in system.objects:
        lower = next((user for user in item.users if level.get(user, 0) < task.priority), None)
        longer = found is None or item.section > found[0].section
        here = (item.node, item.core) == (task.node, task.core)
        reaches = here and item.ceiling >= task.priority
        if reaches and lower is not None and longer:
            found = item, lower
    return found


def _longer(system: System, node: Node) -> list[SharedObject]:
    """The objects of a node with a section of their own: the longest call of a device."""
    return [
        item
        for item in system.objects
        if item.node == node.name and item.section != node.critical_section
    ]


def _section(system: System, item: SharedObject) -> DottedName:
    """The longest time inside an object."""
    node = system.node(item.node)
    own = item.element if item in _longer(system, node) else f"{item.node}.critical"
    return ref(f"{name_of(own)}_Section")


def _silences(system: System, node: Node) -> list[Decl]:
    """When a processor is silent, and when its supervisor has found it at the latest."""
    if node.supervision is None:
        return []
    own, task = ada_case(node.name), name_of(f"{node.name}.{SUPERVISOR}")
    text = (
        f"[{node.name}] L: a processor is silent when a release has not completed this long after "
        "it was due. S: the supervisor has reported the silence this long after the release was "
        "due."
    )
    items: list[Decl] = [Comment(text), stated(f"{own}_Margin", node.supervision.margin)]
    for processor in system.processors:
        if processor.node == node.name:
            name = name_of(processor.name)
            items.append(named_number(f"{name}_L", plus(ref(f"{name}_D"), ref(f"{own}_Margin"))))
            found = plus(ref(f"{name}_L"), ref(f"{task}_T"), ref(f"{task}_R"))
            items.append(named_number(f"{name}_S", found))
    return items


# --- Terms ---------------------------------------------------------------------------


def _terms(system: System, task: Task) -> list[Decl]:
    """The numbers of a task."""
    own = name_of(task.element)
    held = blocker(system, task)
    blocking = _section(system, held[0]) if held else number(0)
    items: list[Decl] = [Comment(_words(system, task, held))]
    if task.driver_of is None:
        items.append(named_number(f"{own}_Priority", priority(task.priority)))
    for slot in task.slots:
        items.append(stated(f"{name_of(slot.element)}_Wcet", slot.timing.wcet))
    if not task.slots:
        items.append(stated(f"{own}_Wcet", task.wcet))
    items += [stated(f"{own}_T", task.period), stated(f"{own}_D", task.deadline)]
    if has_offset(system, task):
        items.append(stated(f"{own}_O", task.offset))
    lasting = logical_of(system, task.element)
    if lasting is not None:
        items.append(stated(f"{own}_Let", lasting))
        problem = "makes values visible before its deadline"
        items.append(refuse(ref(f"{own}_D"), ref(f"{own}_Let"), task.element, problem))
    items += table_terms(task)
    items.append(named_number(f"{own}_J", _jitter(system, task)))
    items += [named_number(name, value) for name, value in sums(task).items()]
    if has_phases(task):
        items.append(named_number(f"{own}_Longest", longest_of(task)))
    items.append(named_number(f"{own}_B", blocking))
    return items


def _words(system: System, task: Task, held: tuple[SharedObject, str] | None) -> str:
    """The meaning of the numbers of a task."""
    if task.released_by is not None:
        what = f"the driver, released by {task.released_by}"
    elif task.sporadic:
        what = "released by arrivals, at least T apart; an arrival may also wait until T is over"
    else:
        what = "released every T"
        if has_offset(system, task):
            what += ", first O after the epoch of its node"
    text = f"[{task.element}] {what}."
    if logical_of(system, task.element) is not None:
        own = any(one.logical is not None for one in system.processors if one.name == task.element)
        where = "" if own else " on the way of a chain"
        text += f" Let: what it sends{where} is visible so long after its release."
    text += f" B: {held[1]} in {held[0].element}." if held else " B: no blocking."
    rare = sorted({slot.divisor for slot in task.slots if slot.divisor > 1})
    if has_phases(task):
        text += " Longest: the rows that a release executes at most, by their phases."
    if rare:
        every = ", ".join(f"C_{n}: rows of one release in {n}" for n in rare)
        text += f" C: rows of every release; {every}."
    return text


def _jitter(system: System, task: Task) -> Expr:
    """The latest release after the event: the tick, and the response of the releaser."""
    terms: list[Expr] = []
    if task.jitter or task.released_by is None:
        terms.append(number(task.jitter))
    if task.released_by is not None:
        terms.append(ref(f"{name_of(task.released_by)}_R"))
    if task.timed and system.node(task.node).tick is not None:
        terms = [term for term in terms if term != number(0)]
        terms.append(ref(f"{ada_case(task.node)}_Tick_T"))
    return plus(*terms)


# --- Claims --------------------------------------------------------------------------


def _claims(system: System, task: Task, claims: Claims, rows: Set[str]) -> list[Decl]:
    """The jobs of a task, one after the other, with its response and those of ``rows``."""
    own, label = name_of(task.element), task.element
    windows = claims.of(label).windows
    jitter, period, bound = (ref(f"{own}_{letter}") for letter in "JTR")
    items: list[Decl] = [Comment(f"[{label}] {IN_WINDOWS}")]
    last: Expr = ref(f"{own}_W")
    ends: list[Expr] = []
    for job, window in enumerate(windows):
        tail = "" if len(windows) == 1 else f"_{job + 1}"
        last, needs = ref(f"{own}_W{tail}"), f"{own}_Needs{tail}"
        if len(windows) == 1:
            items.append(named_number(f"{own}_W", OperatorChain("-", (bound, jitter))))
        else:
            items.append(stated(f"{own}_W{tail}", window))
        items.append(named_number(needs, demand(system, task, last, work_of_jobs(task, job + 1))))
        items.append(exact(last, [ref(needs)], label, RESPONSE))
        ends.append(less_periods(plus(jitter, last), own, job))
    if len(windows) > 1:
        items.append(exact(bound, ends, label, RESPONSE))
    deadline: Expr = ref(f"{own}_D")
    if claims.of(label).since or len(windows) > 1:
        limit = times(number(len(windows)), period)
        items.append(refuse(plus(jitter, last), limit, label, OVERLAP))
    held = ref(f"{own}_Needs{tail}"), last
    if claims.of(label).since:
        items.append(assured(held))
        items += offset_claims(system, task, claims.of(label))
    else:
        if len(windows) == 1:
            first = call(Attribute("Time", "Min"), deadline, period)
            items.append(refuse(bound, first, label, f"{LATE} or overlap"))
        else:
            items.append(refuse(bound, deadline, label, LATE))
        items.append(assured(held, (bound, deadline)))
    for place, slot in enumerate(task.slots, 1):
        if slot.element in rows:
            items += _row(system, task, place, claims)
    return items


def _row(system: System, task: Task, place: int, claims: Claims) -> list[Decl]:
    """When the first ``place`` rows of a job are done, in a release that executes them all."""
    row, own = task.slots[place - 1].element, name_of(task.element)
    done, bound = name_of(row), claims.rows.get(row, 0)
    if place == len(task.slots) and bound == claims.of(task.element).response:
        return [
            Comment(f"[{row}] the last row, done when {task.element} completes"),
            named_number(f"{done}_Done", ref(f"{own}_R")),
        ]
    needed = longest_of(task, place)
    window = ref(f"{done}_W")
    return [
        Comment(f"[{row}] Done: the time from the event of its processor until it is done"),
        stated(f"{done}_Done", bound),
        named_number(f"{done}_W", OperatorChain("-", (ref(f"{done}_Done"), ref(f"{own}_J")))),
        named_number(f"{done}_Needs", demand(system, task, window, needed)),
        exact(window, [ref(f"{done}_Needs")], row, RESPONSE),
    ]
