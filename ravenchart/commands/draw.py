# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart draw`: pictures of a model's charts and structure, or of generated Ada."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from pathlib import Path

from ravenchart.building.drawings import FORMATS, svg, texts
from ravenchart.failures import OK, Refused
from ravenchart.gen.draw.ada_chart import picture_of_ada
from ravenchart.gen.draw.ada_text import NotDeclaredError
from ravenchart.terminal import progress

from . import common
from .results import DrawResult


def texts_of_ada(file: Path, form: str = "svg") -> dict[str, str]:
    """The same for the chart that the spec of a generated region declares; or Refused."""
    try:
        chart = picture_of_ada(file.name, lambda name: _sibling(file, name))
    except NotDeclaredError as problem:
        raise Refused(str(problem)) from problem
    return {f"{chart.title}{FORMATS[form].suffix}": FORMATS[form].chart(chart)}


def _sibling(file: Path, name: str) -> str | None:
    path = file.with_name(name)
    return path.read_text(encoding="utf-8") if path.is_file() else None


def write(drawings: Mapping[str, str], folder: Path) -> None:
    """Write drawings; where they are SVG, Graphviz makes them of their DOT texts."""
    done = {name: svg(text) if name.endswith(".svg") else text for name, text in drawings.items()}
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in done.items():
        (folder / name).write_text(text, encoding="utf-8")


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    source = sub.add_mutually_exclusive_group(required=True)
    source.add_argument(
        "model", type=Path, nargs="?", metavar="MODEL", help="the model's YAML file"
    )
    source.add_argument(
        "--from-ada",
        type=Path,
        metavar="FILE",
        help="draw the chart that the generated spec of a region declares",
    )
    sub.add_argument(
        "--out",
        type=Path,
        metavar="DIR",
        help="folder for the drawings (default: drawings/ beside)",
    )
    sub.add_argument(
        "--format", choices=FORMATS, default="svg", help="format of the drawings (default: svg)"
    )


def execute(options: argparse.Namespace) -> int:
    """Draw it; the exit status."""
    if options.from_ada is not None:
        drawings = texts_of_ada(options.from_ada, options.format)
    else:
        found = common.checked(options, deadlines=False, library=True)
        drawings = texts(found.system, options.format)
    folder = options.out or (options.from_ada or options.model).parent / "drawings"
    with progress("draw"):
        write(drawings, folder)
    options.answer.result = DrawResult(str(folder), options.format, list(drawings))
    print(f"{folder}: {common.several(len(drawings), 'drawing')}")
    return OK
