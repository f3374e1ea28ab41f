# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Models broken or bent at random: what `generate` accepts compiles without a warning.

A seed picks a model of the checkout and one to four changes of it: another expression, number,
unit or name, an entry that goes or comes twice. The compiler looks at the meaning of every
generated unit (`-gnatc`); what it has seen before with the same specs is skipped.
Some seeds by themselves:

    python -m tests.support.model_fuzzer FIRST LAST
"""

from __future__ import annotations

import hashlib
import os
import random
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import yaml

from ravenchart.building import checking, generation
from ravenchart.failures import Refused
from ravenchart.gen.derive.calls import device_types
from ravenchart.gen.emit.ada.text import print_unit
from ravenchart.gen.emit.commands.devices import simulated_driver
from ravenchart.gen.emit.program import generate
from ravenchart.gen.model.system import System
from ravenchart.paths import ROOT
from tests.support.interpreted import plain
from tests.support.random_expressions import Words, condition, number_term

MODELS = sorted(
    path
    for pattern in (
        "tests/feature/*/model.yaml",
        "tests/nodes/*/model.yaml",
        "examples/*/model.yaml",
    )
    for path in ROOT.glob(pattern)
    if "\ninclude:" not in path.read_text(encoding="utf-8")
)
"""The models in one file."""

SOURCES = (
    "spark_runtime/src", "spark_runtime/native", "spark_runtime/devices", "hw_can/hal",
    "hw_can/drivers/loopback", "hw_can/simulator",
)  # fmt: skip
SWITCHES = (
    "-c", "-gnatc", "-gnat2012", "-gnatwa", "-gnatwe", "-gnaty3abcdefhiIklM79nprSux",
    f"-gnatec={ROOT / 'spark_runtime' / 'ravenscar.adc'}",
)  # fmt: skip
EFFORT = 1_000
"""Work of the rules of behaviour, which decide nothing that the compiler sees."""

NUMBERS = (
    0, 1, -1, 2, 7, 8, 9, 15, 16, 31, 32, 63, 64, 65, 127, 255, 256, 1_024, 2_047, 4_096, 65_535,
    65_536, 65_537, 1_048_576, 2**31, 2**32, 2**61, 2**62 - 1, 2**62, -(2**62),
)  # fmt: skip
UNITS = ("mm", "MM", "mV", "MV", "m/s", "m_per_s", "%", "percent", "0.1 degC", "m^2", "m_2",
         "\N{DEGREE SIGN}", "\N{MICRO SIGN}m", "#")  # fmt: skip
NAMES = (
    "A", "G", "I", "S", "T", "Item", "Pack", "Unpack", "Word", "Words", "Raw", "Valid", "Value",
    "State", "Step", "Fire", "Choose", "Event", "Poll", "Codecs", "Types", "Line", "Main", "Copy",
    "Integer", "Result", "Counters", "Processor", "Run", "Signal", "Place", "Target", "Source",
    "Memory", "Timers", "Config", "Number", "Local_Value", "Raw_Of_Value", "Frame", "Id", "Old",
    "Null_Event", "First", "Last", "Length", "Data", "Input", "Output", "Done", "Calls", "Reports",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of the model of one seed; ``text`` says what is wrong, or which errors it has."""

    seed: int
    kind: str
    """``refused``, ``compiled`` or ``wrong``."""
    text: str = ""


# --- Changes -------------------------------------------------------------------------


def _nodes(tree: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[tuple[Any, ...], Any]]:
    """Each value of a model with its keys."""
    pairs = tree.items() if isinstance(tree, dict) else enumerate(tree)
    for key, value in pairs:
        yield (*path, key), value
        if isinstance(value, dict | list):
            yield from _nodes(value, (*path, key))


def _container(tree: Any, path: tuple[Any, ...]) -> Any:
    for key in path[:-1]:
        tree = tree[key]
    return tree


def _another_number(tree: Any, chance: random.Random) -> None:
    found = [p for p, v in _nodes(tree) if isinstance(v, int) and not isinstance(v, bool)]
    if found:
        path = chance.choice(found)
        near = _container(tree, path)[path[-1]] + chance.choice((-1, 1))
        _container(tree, path)[path[-1]] = chance.choice((*NUMBERS, near, near, near))


def _another_unit(tree: Any, chance: random.Random) -> None:
    ranges = [v for _, v in _nodes(tree.get("types", {})) if isinstance(v, dict) and "range" in v]
    for one in chance.sample(ranges, min(len(ranges), 2)):
        one["unit"] = chance.choice(UNITS)


def _another_expression(tree: Any, chance: random.Random) -> None:
    """A guard, condition or value of a component; others where there is none."""
    found = []
    for name, component in tree.get("components", {}).items():
        for path, value in _nodes(component):
            if path[-1] in ("guard", "when", "if", "to", "with") and isinstance(value, str | int):
                found.append((name, path, value))
    found = [
        (n, p, v)
        for n, p, v in found
        if p[-1] != "to" or "set" in _container(tree["components"][n], p)
    ]
    if not found:
        return
    name, path, _ = chance.choice(found)
    component = tree["components"][name]
    words = Words.of(tree, component)
    is_condition = path[-1] in ("guard", "when", "if")
    made = condition(words, chance, 3) if is_condition else number_term(words, chance, 3)
    if not is_condition:  # mostly within the type
        made = chance.choice((made, f"clamp({made}, 0, 1)", f"min(max({made}, 0), 1)"))
    _container(component, path)[path[-1]] = made


def _without_an_entry(tree: Any, chance: random.Random) -> None:
    found = [p for p, _ in _nodes(tree) if len(p) > 1]
    path = chance.choice(found)
    del _container(tree, path)[path[-1]]


def _an_entry_twice(tree: Any, chance: random.Random) -> None:
    named = [
        p for p, v in _nodes(tree) if len(p) > 1 and isinstance(p[-1], str) and isinstance(v, dict)
    ]
    path = chance.choice(named)
    home = _container(tree, path)
    joined = (
        f"{path[-1]}_{chance.choice(('Raw', 'Value', 'Bits', '2', 'Position', 'Port', 'View'))}"
    )
    home[chance.choice((joined, chance.choice(NAMES)))] = home[path[-1]]


def _another_name(text: str, chance: random.Random) -> str:
    """The text with one of its names replaced everywhere."""
    names = sorted(set(re.findall(r"^ *([A-Za-z]\w*):", text, re.M)))
    others = sorted(set(re.findall(r"\b[A-Z]\w*\b", text)))
    old = chance.choice(others or names)
    joined = f"{chance.choice(others or names)}_{chance.choice(names)}"
    new = chance.choice((*NAMES, *NAMES, old.swapcase(), joined, joined, joined))
    return re.sub(rf"\b{old}\b", new, text)


CHANGES = (
    _another_number, _another_expression, _another_expression, _another_expression,
    _another_unit, _without_an_entry, _an_entry_twice,
)  # fmt: skip


def model_of(seed: int) -> str:
    """The text of the model of a seed."""
    chance = random.Random(seed)
    text = chance.choice(MODELS).read_text(encoding="utf-8")
    tree = plain(text)
    for _ in range(chance.randint(1, 3)):
        chance.choice(CHANGES)(tree, chance)
    text = yaml.safe_dump(tree, sort_keys=False, allow_unicode=True, width=10_000)
    return _another_name(text, chance) if chance.random() < 0.4 else text


# --- What becomes of it --------------------------------------------------------------


def tried(seed: int) -> Outcome:
    """Check, generate and compile the model of a seed."""
    text = model_of(seed)
    with tempfile.TemporaryDirectory() as place:
        model = Path(place) / "model.yaml"
        model.write_text(text, encoding="utf-8")
        try:
            checked = checking.check(model, deadlines=False, effort=EFFORT)
            generation.without_clashes(checked)
            files = generate(checked.system, generation.claims(checked))
        except Refused as refused:
            return Outcome(seed, "refused", str(refused))
        except Exception as broken:
            return Outcome(seed, "wrong", f"{type(broken).__name__}: {broken}")
        devices = _devices(checked.system)
        said = [_compiled(_with(devices, part), Path(place) / "ada") for part in _programs(files)]
    wrong = "\n".join(one for one in said if one)
    return Outcome(seed, "wrong" if wrong else "compiled", wrong)


def _devices(system: System) -> dict[str, str]:
    """Drivers as they are first written, for what the user writes as well."""
    units = [u for kind in device_types(system) for u in simulated_driver(system, kind, "Driver.")]
    return {unit.file_name: print_unit(unit) for unit in units}


def _with(devices: dict[str, str], part: dict[str, str]) -> dict[str, str]:
    """The units of a program, with those of its devices."""
    own = {n: t for n, t in devices.items() if f"{n[:-4].removesuffix('_states')}.ads" in part}
    return {**own, **part}


def _programs(files: dict[str, str]) -> Iterator[dict[str, str]]:
    """The Ada units of each program."""
    homes = dict.fromkeys(name.rpartition("/")[0] for name in files if name.endswith(".gpr"))
    for home in homes:
        own = {n.rpartition("/")[2]: t for n, t in files.items() if n.rpartition("/")[0] == home}
        yield {n: t for n, t in own.items() if n.endswith((".ads", ".adb"))}


SEEN: set[str] = set()
"""Units that were compiled, each with all specs that it sees."""


def _seen_by(name: str, units: dict[str, str]) -> str:
    """A digest of a unit and of the specs that it depends on."""
    found, ahead = {name}, [name]
    while ahead:
        one = ahead.pop()
        stem = one[:-4]
        parents = [stem.rsplit("-", n)[0] for n in range(1, stem.count("-") + 1)]
        withs = re.findall(r"^with ([\w.]+);", units[one], re.M)
        needed = [*parents, stem, *(unit.lower().replace(".", "-") for unit in withs)]
        fresh = {f"{unit}.ads" for unit in needed if f"{unit}.ads" in units} - found
        found |= fresh
        ahead += fresh
    text = "".join(f"{one}\n{units[one]}" for one in sorted(found))
    return hashlib.sha256(text.encode()).hexdigest()


def _compiled(units: dict[str, str], folder: Path) -> str:
    """What the compiler says of the units."""
    folder.mkdir(exist_ok=True)
    for name, text in units.items():
        (folder / name).write_text(text, encoding="utf-8")
    kept = [n for n in sorted(units) if n.endswith(".adb") or f"{n[:-1]}b" not in units]
    digests = {name: _seen_by(name, units) for name in kept}
    fresh = [name for name in kept if digests[name] not in SEEN]
    places = [f"-I{ROOT / source}" for source in SOURCES]
    said = []
    for name in fresh:
        done = subprocess.run(
            ["gcc", *SWITCHES, *places, name],
            cwd=folder,
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode == 0 and not done.stderr:
            SEEN.add(digests[name])
        else:
            said.append(done.stderr)
    for path in folder.iterdir():
        path.unlink()
    return "".join(said)


@lru_cache(maxsize=1)
def _workers() -> int:
    return max(1, len(os.sched_getaffinity(0)))


def outcomes(seeds: Sequence[int]) -> list[Outcome]:
    """What becomes of each seed, on all processors of this machine."""
    with ProcessPoolExecutor(_workers()) as pool:
        return list(pool.map(tried, seeds, chunksize=max(1, len(seeds) // (8 * _workers()))))


def main() -> None:
    """Try the seeds of the command line, and print what is wrong; of a single seed all."""
    first, last = int(sys.argv[1]), int(sys.argv[-1])
    found = outcomes(range(first, last + 1))
    if first == last:
        print(model_of(first), found[0].text, sep="\n")
    for outcome in found:
        if outcome.kind == "wrong":
            print(f"seed {outcome.seed}: {outcome.text}")
    for kind in ("refused", "compiled", "wrong"):
        print(f"{kind}: {sum(outcome.kind == kind for outcome in found)}")


if __name__ == "__main__":
    main()
