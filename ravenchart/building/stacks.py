# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Stacks and memory of the program of a node: bounds, sizes, and what is wrong with them."""

from __future__ import annotations

import json
import os
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from pydantic import TypeAdapter, ValidationError

from ravenchart.failures import Refused, ToolFailed, Unusable
from ravenchart.gen.diagnostics import Diagnostic, error, render_all
from ravenchart.gen.emit.ada.naming import root_package
from ravenchart.gen.language.names import path_name
from ravenchart.gen.model.statechart import After, Every
from ravenchart.gen.model.system import System
from ravenchart.gen.origins import Origin
from ravenchart.paths import ROOT
from ravenchart.stacks import graph, longest, machine, memory, symbols
from ravenchart.stacks.longest import LIBRARY, Depths, Rules, StackBound
from ravenchart.stacks.report import Memory, MemoryPart, PathStep, Stack
from ravenchart.tools import children
from ravenchart.tools.kept import file_digest

from .targets import KnownFrame, Target, file_of

CALL_GRAPHS = "-fcallgraph-info=su,da"
"""With it the compiler writes a call graph with frames beside each object."""
FRAMES = ROOT / "spark_runtime" / "frames.toml"
"""The bounds of frames of Ravenchart's own sources that the compiler has none for."""
ENDINGS = frozenset({"__gnat_last_chance_handler"})
ATTACHING = "system__interrupts__install_restricted_handlers"
"""The procedure that attaches interrupt handlers. The call graph does not name the handlers."""
LINES = "ravenchart-interrupt_sources.adb"
"""The unit that attaches those of the runtime, which `pointers` of a target names."""
PUT_ALL = "ravenchart_put_all"
"""By this name the runtime of this machine calls the report of a program, for its snapshots."""
SAFE = 1_024
"""Sizes are suggested in whole KiB."""


@dataclass(frozen=True, slots=True)
class BuiltProgram:
    """A program that is built: its image, objects and tools, and the model that it is made of."""

    system: System
    """The part of the node."""
    image: Path
    objects: tuple[Path, ...]
    target: Target
    mode: str
    tools: str
    """The prefix of the names of nm, size and objdump."""
    sources: Mapping[str, tuple[str, ...]]
    """The lines of the model's files, for messages."""
    digests: Mapping[str, str]
    folder: Path
    """Of the model."""


def objects_of(image: Path) -> tuple[Path, ...]:
    """The objects that the binder has listed for a program."""
    bound = image.parent / f"b__{image.name}.adb"
    text = bound.read_text(encoding="utf-8", errors="replace")
    listed = re.findall(r"^ *-- +(\S.*\.o)$", text.rpartition("BEGIN Object file")[2], re.M)
    own = image.parent / f"b__{image.name}.o"
    return (*(Path(one) if Path(one).is_absolute() else image.parent / one for one in listed), own)


def without_graph(objects: Iterable[Path]) -> bool:
    """Is there an object whose call graph is missing, or of an earlier compilation?

    The compiler writes it behind the ALI file.
    """
    return _stale(objects) is not None


def must_have_graphs(objects: Iterable[Path]) -> None:
    """ToolFailed where the compiler has written no call graph of an object."""
    missing = _stale(objects)
    if missing is not None:
        raise ToolFailed(
            f"{missing}: error: the compiler has written no call graph: {CALL_GRAPHS} needs GCC "
            "10 or later"
        )


def _stale(objects: Iterable[Path]) -> Path | None:
    return next((one for one in objects if not _is_fresh(one)), None)


def _is_fresh(item: Path) -> bool:
    made, unit = item.with_suffix(".ci"), item.with_suffix(".ali")
    if not made.is_file():
        return False
    return not unit.is_file() or made.stat().st_mtime_ns >= unit.stat().st_mtime_ns


def record_of(image: Path) -> Path:
    """Where what is found of a program is kept."""
    return image.parent / f"{image.name}.memory.json"


def keep(image: Path, found: Memory) -> None:
    """Keep what is found beside the program."""
    write(found, record_of(image))


def write(found: Memory, path: Path) -> None:
    """Write a record of stacks and memory."""
    path.write_text(json.dumps(asdict(found), indent=1) + "\n", encoding="utf-8")


def kept(image: Path) -> Memory:
    """The record of a program's stacks and memory."""
    return read_record(record_of(image))


def read_record(path: Path) -> Memory:
    """A record of stacks and memory. Unusable where it is none."""
    try:
        return TypeAdapter(Memory).validate_json(path.read_bytes())
    except (OSError, ValidationError) as fault:
        raise Unusable(f"{path} is no record of stacks and memory: {fault}") from None


def facts_of(target: Target) -> tuple[Path, ...]:
    """The files, beside program and this module, that decide whether its stacks are enough."""
    return FRAMES, file_of(target.name)


def is_known(image: Path, target: Target) -> bool:
    """Was this very program found to have stacks that are large enough?"""
    kept = record_of(image)
    read = (image, *facts_of(target), Path(__file__))
    return kept.is_file() and kept.stat().st_mtime_ns >= max(r.stat().st_mtime_ns for r in read)


def examine(made: BuiltProgram) -> Memory:
    """The stacks and the memory of a program. Refused where a stack has no bound, or not the bytes.

    ToolFailed where a tool cannot say what is asked.
    """
    listed = symbols.read(_said(made, "nm", "-S"))
    by_name = {one.name: one for one in listed}
    functions = _graph(made)
    depths = Depths(functions, _rules(made, frozenset(by_name)))
    stacks = [*_tasks(made, depths, by_name), *_others(made, depths, by_name)]
    wrong = [*_problems(made, depths), *(d for one in stacks for d in _too_small(made, one))]
    if wrong:
        files = {one.file for d in wrong for one in (d.origin, *(place for place, _ in d.notes))}
        lines = {name: _lines(name) for name in files - made.sources.keys()}
        raise Refused(render_all(wrong, {**made.sources, **lines}), wrong)
    for step in (step for one in stacks for step in one.path):
        step.called = _named(step.called, made.folder)
    sections = memory.sections(_said(made, "size", "-A"))
    parts = list(memory.parts(listed, _owners(made.system), sections))
    flash, ram = memory.totals(sections)
    if made.target.facts.stacks.library is not None:  # on a board they are in the tasks
        given = sum(one.size or 0 for one in stacks)
        parts.append(memory.UsedMemory("stacks of tasks", 0, given))
        ram += given
    return Memory(
        made.system.nodes[0].name,
        made.target.name,
        made.mode,
        made.target.facts.stacks.library,
        stacks,
        [MemoryPart(one.name, one.flash, one.ram) for one in parts],
        flash,
        ram,
        dict(made.digests),
    )


def digests(folders: Iterable[Path], folder: Path) -> dict[str, str]:
    """SHA-256 of each Ada source in folders, by its name from the folder of the model."""
    files = sorted(path for home in folders for path in home.glob("*.ad[sb]"))
    return {named(p, folder): file_digest(p) for p in files}


def put_all(system: System) -> str:
    """The symbol of the report of a program, which the linker gives the name `PUT_ALL`."""
    return f"{root_package(system).lower()}__reports__put_all"


def _said(made: BuiltProgram, tool: str, *options: str) -> str:
    words = [f"{made.tools}{tool}", *options, str(made.image)]
    done = children.run(words, errors="replace")
    if done.returncode != 0:
        raise ToolFailed(f"{' '.join(words)}\n{done.stdout}{done.stderr}")
    return str(done.stdout)


def _graph(made: BuiltProgram) -> graph.Graph:
    """The functions of the program and, where it is in the image, of the run-time library."""
    texts = (one.with_suffix(".ci").read_text("utf-8", "replace") for one in made.objects)
    try:
        found = graph.read(texts)
    except ValueError as fault:
        raise ToolFailed(f"a call graph of {made.image} cannot be read: {fault}") from None
    reports = put_all(made.system)
    if reports in found:
        found[PUT_ALL] = found[reports]
    if made.target.facts.stacks.library is None:
        ours = {graph.plain_symbol(one.name) for one in found.values()}
        code = machine.read(_said(made, "objdump", "-d", "--no-show-raw-insn").splitlines())
        found |= {name: one for name, one in code.items() if graph.plain_symbol(name) not in ours}
    return found


def _rules(made: BuiltProgram, linked: frozenset[str]) -> Rules:
    facts = made.target.facts.stacks
    ours = tomllib.loads(FRAMES.read_text("utf-8"))
    given = {name: KnownFrame.model_validate(one) for name, one in ours.items()} | facts.frames
    regions = [r for c in made.system.components for r in c.regions]
    timers = max((_timers(r.transitions) for r in regions), default=0)
    bounds = {
        name: StackBound(one.bytes + timers * one.timer, one.why, one.depth)
        for name, one in given.items()
    }
    return Rules(facts.library, bounds, facts.pointers, linked, ENDINGS)


def _timers(transitions: Sequence[object]) -> int:
    triggers = (getattr(one, "trigger", None) for one in transitions)
    return sum(isinstance(one, After | Every) for one in triggers)


# --- The stacks ------------------------------------------------------------------


def _tasks(
    made: BuiltProgram, depths: Depths, by_name: Mapping[str, symbols.Symbol]
) -> Iterator[Stack]:
    """The stack of each task, in the order of the model."""
    values = symbols.Values(made.image, by_name)
    known = _known(made.system)
    roots = [title for title, one in depths.graph.items() if graph.is_task(one.name)]
    order = {name: number for number, name in enumerate(known)}
    for root in sorted(roots, key=lambda r: (order.get(_unit(r), len(order)), r)):
        task, _, declared = known.get(_unit(root), (graph.ada_name(root), None, None))
        name = graph.symbol(root)
        if any(task == bus.name for bus in made.system.buses):  # several tasks of one driver
            task = f"{task}.{graph.ada_name(root).rpartition('.')[2].lower()}"
        size = _size(name, values) or declared
        if size is None:
            raise ToolFailed(f"{made.image}: the size of the stack of {task} is not in the program")
        yield _stack(made, depths, task, root, size, _ending(made, depths))


def _size(body: str, values: symbols.Values) -> int | None:
    """The size of the stack of a task: its own, or `Stack_Bytes` of a package around it."""
    around = body.split("__")[:-1]
    names = ["__".join((*around[:count], "stack_bytes")) for count in range(len(around), 0, -1)]
    found = (values.number(name) for name in (body.replace("TKB", "TKZ"), *names))
    return next((size for size in found if size is not None), None)


def _unit(root: str) -> str:
    """The part of the symbol of a task body that the model decides."""
    parts = graph.symbol(root).split("__")
    return "__".join(parts[:2])


def _known(system: System) -> dict[str, tuple[str, Origin, int | None]]:
    """The unit of a task to its name, its place in the model and its stack there."""
    root = system.name.lower()
    found: dict[str, tuple[str, Origin, int | None]] = {
        f"{root}__{one.name.lower()}": (one.name, one.origin, one.stack_bytes)
        for one in system.processors
    }
    for node in system.nodes:
        if node.supervision is not None:
            name = f"{root}__liveness_supervision"
            found[name] = (f"{node.name}.supervisor", node.origin, None)
        if node.probe is not None:
            found[f"{root}__host_probe"] = f"{node.name}.probe", node.origin, None
    for bus in system.buses:
        found[f"{root}__{bus.name.lower()}"] = bus.name, bus.origin, None
    return found


def _ending(made: BuiltProgram, depths: Depths) -> int:
    """Bytes of the calls that the run-time library makes on the stack of a task that ends."""
    wanted = set(made.target.facts.stacks.on_end)
    found = [title for title, one in depths.graph.items() if graph.plain_symbol(one.name) in wanted]
    return max(map(depths.depth, found), default=0)


def _interrupted(made: BuiltProgram, depths: Depths) -> int:
    """Bytes that an interrupt takes of the stack of the task that it interrupts."""
    facts = made.target.facts.stacks.interrupted
    if facts is None:
        return 0
    return facts.frame + max((_depth(made, depths, name) for name in facts.calls), default=0)


def _depth(made: BuiltProgram, depths: Depths, name: str) -> int:
    if name not in depths.graph:
        raise ToolFailed(f"{made.image} has no {name}, which {made.target.name} needs")
    return depths.depth(name)


def _stack(
    made: BuiltProgram, depths: Depths, task: str, root: str, size: int | None, ending: int = 0
) -> Stack:
    extra = _interrupted(made, depths)
    bound = max(depths.depth(root), ending) + extra
    return Stack(task, bound, extra, ending, size, _path(depths, root))


def _path(depths: Depths, root: str) -> list[PathStep]:
    return [PathStep(_function(one.title), one.size, one.place) for one in depths.path(root)]


def _function(title: str) -> str:
    return title if title == LIBRARY else graph.ada_name(graph.symbol(title))


def _others(
    made: BuiltProgram, depths: Depths, by_name: Mapping[str, symbols.Symbol]
) -> Iterator[Stack]:
    """The stack of the environment task, and that of interrupts."""
    facts = made.target.facts.stacks
    size = None if facts.environment is None else _between(made, by_name, *facts.environment)
    yield _stack(made, depths, "environment task", "main", size)
    place = facts.interrupts
    if place is None:
        return
    size = _between(made, by_name, place.first, place.last) // place.count
    handlers = depths.rules.pointers.get("system__bb__interrupts__interrupt_wrapper", ())
    levels = max(len([one for one in handlers if one in depths.graph]), 1)
    once = _depth(made, depths, place.root)
    bound = levels * (place.frame + once)
    yield Stack("interrupts", bound, bound - once, 0, size, _path(depths, place.root))


def _between(
    made: BuiltProgram, by_name: Mapping[str, symbols.Symbol], first: str, last: str
) -> int:
    for name in (first, last):
        if name not in by_name:
            raise ToolFailed(f"{made.image} has no {name}, which {made.target.name} needs")
    return by_name[last].at - by_name[first].at


# --- What is wrong ----------------------------------------------------------------


def _too_small(made: BuiltProgram, one: Stack) -> Iterator[Diagnostic]:
    if one.size is None or one.bound <= one.size:
        return
    places = {name: origin for name, origin, _ in _known(made.system).values()}
    owner_name = one.task if one.task in places else one.task.partition(".")[0]
    origin = places.get(owner_name, made.system.nodes[0].origin)
    notes = [(_origin(step.called) or origin, f"{step.bytes:,} bytes: {step.function}")
             for step in one.path]  # fmt: skip
    if one.ending + one.interrupts == one.bound:
        notes.append((origin, f"{one.ending:,} bytes: the handler of the end of a task"))
    if one.interrupts:
        notes.append((origin, f"{one.interrupts:,} bytes: an interrupt"))
    least = -(-one.bound // SAFE)
    owner = next((p for p in made.system.processors if p.name == one.task), None)
    hint = f"write `stack: {least} KiB` or more, or take large objects out of the path"
    if owner is None:
        hint = f"it needs {least} KiB"
    yield error(
        "RV-1501", origin,
        f"the stack of {one.task} is too small: it takes up to {one.bound:,} bytes > "
        f"{one.size:,} bytes",
        notes=notes, hint=hint,
    )  # fmt: skip


def _problems(made: BuiltProgram, depths: Depths) -> Iterator[Diagnostic]:
    """Why paths have no bound."""
    unknown = made.system.nodes[0].origin
    for one in depths.problems:
        match one:
            case longest.Recursion(cycle, place):
                names = " -> ".join(map(graph.ada_name, cycle))
                yield error(
                    "RV-1502", _origin(place) or unknown,
                    f"recursion: {names}; the depth of the stack has no bound",
                    hint="write it as a loop with a bound",
                )  # fmt: skip
            case longest.Indirect(caller, place):
                yield error(
                    "RV-1503", _origin(place) or unknown,
                    f"{graph.ada_name(caller)} calls through a pointer; which subprogram, the "
                    "call graph does not say",
                    hint="call each subprogram by its name, for example in a case statement",
                )  # fmt: skip
            case longest.Unbounded(name, place, objects):
                yield error(
                    "RV-1504", _origin(place) or unknown,
                    f"the size of the frame of {graph.ada_name(name)} has no known bound",
                    notes=[(_origin(o.rpartition(" ")[2]) or unknown,
                            f"{o.rpartition(' ')[0] or 'an object'} has a size of run time")
                           for o in objects],
                    hint="give its objects bounds that are static",
                )  # fmt: skip
            case longest.Missing(name, caller):
                raise ToolFailed(f"{made.image}: {caller} calls {name}, which has no code there")
    for title in depths.graph:
        function = depths.graph[title]
        attached = next((c for c in function.calls if c.startswith(ATTACHING)), None)
        if attached is None or LINES in function.calls[attached]:
            continue
        if function.place and made.target.facts.stacks.interrupts is not None:
            yield error(
                "RV-1503", _origin(function.calls[attached]) or unknown,
                f"{graph.ada_name(function.name)} attaches a handler of an interrupt; which "
                "subprogram, the call graph does not say",
            )  # fmt: skip


_PLACE = re.compile(r"^(.+):(\d+):(\d+)$")


def _origin(place: str) -> Origin | None:
    """A place as the compiler writes it, the file as seen from here."""
    found = _PLACE.match(_near(place))
    return None if found is None else Origin(found[1], int(found[2]), int(found[3]))


def _near(place: str) -> str:
    """A place with its file from the folder of the call, where it is below that."""
    here = f"{os.getcwd()}{os.sep}"
    return place.removeprefix(here)


def _named(place: str, folder: Path) -> str:
    """A place with its file from the checkout or package, else from the folder of the model."""
    found = _PLACE.match(place)
    if found is None:
        return place
    return f"{named(Path(found[1]), folder)}:{found[2]}:{found[3]}"


def named(path: Path, folder: Path) -> str:
    """The name of a file: from the folder of the model, else from the checkout or package."""
    whole = Path(os.path.abspath(path))
    for base in (Path(os.path.abspath(folder)), ROOT):
        if whole.is_relative_to(base):
            return whole.relative_to(base).as_posix()
    return Path(os.path.relpath(whole, os.path.abspath(folder))).as_posix()


def _lines(name: str) -> tuple[str, ...]:
    path = Path(name)
    if not path.is_file():
        return ()
    return tuple(path.read_text("utf-8", "replace").splitlines())


# --- The parts of the memory --------------------------------------------------------


def _owners(system: System) -> dict[str, str]:
    """Prefix of symbols to the part of the program that they belong to."""
    root = system.name.lower()
    found = {"ada_main": memory.BINDER, "adainit": memory.BINDER, "adafinal": memory.BINDER}
    found |= {"ravenchart__can": "CAN layer", "ravenchart__": memory.RUNTIME}
    found |= {f"{root}__": "the rest of the generated program", f"{root}_main": "main program"}
    found |= {f"{root}__{one.name.lower()}__": f"charts and activities of {one.name}"
              for one in system.components}  # fmt: skip
    found |= {f"{root}__{path_name(one.name).lower()}__":
              f"{one.name}: protected objects, state, glue"
              for one in system.instances}  # fmt: skip
    found |= {f"{root}__{one.name.lower()}__": f"{one.name}: task and table"
              for one in system.processors}  # fmt: skip
    found |= {f"{root}__{one.name.lower()}__": f"{one.name}: queues, driver, reception"
              for one in system.buses}  # fmt: skip
    found |= {f"{root}__codecs__": "codecs", f"{root}__trace__": "trace",
              f"{root}__recording__": "recorded values",
              f"{root}__reports__": "reports", f"{root}__liveness_supervision__": "supervision",
              f"{root}__host_probe__": "probe"}  # fmt: skip
    return found
