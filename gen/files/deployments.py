# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A model and one of its deployments, as one path: `model.yaml@bench`."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.language.names import meant
from ravenchart.gen.origins import Origin

from .schema import ModelFile

MARK = "@"
ENDINGS = (".yaml", ".yml")


def parted(path: Path) -> tuple[Path, str | None]:
    """The main file that a path names, and the deployment behind it, if there is one."""
    name, mark, chosen = path.name.rpartition(MARK)
    if mark and name.lower().endswith(ENDINGS):
        return path.with_name(name), chosen
    return path, None


def at(main: Path, name: str) -> Path:
    """The path of a deployment of the model whose main file that is."""
    return main.with_name(f"{main.name}{MARK}{name}")


def folder_of(name: str) -> str:
    """The folder of its program, below that of the model."""
    return name.lower()


def chosen_file(
    main: ModelFile, path: Path, chosen: str | None, found: list[Diagnostic]
) -> tuple[str, Origin] | None:
    """The file of the chosen deployment, and where it is named; reported where there is none."""
    named = main.deployments or {}
    _are_different(main, named, found)
    if chosen is None:
        if named:
            message = f"the model has deployments, and none is chosen: {', '.join(named)}"
            hint = f"choose one: `{at(path, next(iter(named))).name}`"
            found.append(error("RV-0809", main.at_key("deployments"), message, hint=hint))
        return None
    own = next((name for name in named if name.lower() == chosen.lower()), None)
    if own is not None:
        return named[own], main.place("deployments", own).origin
    lost = main.lost("deployments") or chosen.lower() in map(str.lower, main.dropped("deployments"))
    if not lost:
        message = f"there is no deployment named `{chosen}`"
        hint = meant(chosen, named) or f"add it: `deployments: {{{chosen}: FILE}}`"
        found.append(error("RV-0305", main.at_key("deployments"), message, hint=hint))
    return None


def _are_different(main: ModelFile, names: Iterable[str], found: list[Diagnostic]) -> None:
    """Report two names that differ by case alone."""
    seen: dict[str, str] = {}
    for name in names:
        first = seen.setdefault(name.lower(), name)
        if first != name:
            message = f"a second deployment is named `{name}`, like `{first}`: case does not count"
            notes = [(main.entry_at("deployments", first), "the first is here")]
            at_name = main.entry_at("deployments", name)
            hint = "rename one of them"
            found.append(error("RV-0303", at_name, message, notes=notes, hint=hint))
