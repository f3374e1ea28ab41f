# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart new`: a project that checks, builds, runs and is proved as it stands."""

from __future__ import annotations

import argparse
import json
import re
from importlib import resources
from pathlib import Path

from ravenchart.behaviour.interpreter.stimuli_schema import events_schema
from ravenchart.failures import OK, Refused
from ravenchart.gen.diagnostics import render_all
from ravenchart.gen.files.reference import json_schema
from ravenchart.gen.pipeline import load
from ravenchart.hw_can.bench.schema import scenario_schema

from .results import NewResult

SYSTEM = "SYSTEM"
"""The placeholder for the name of the system in the files."""

FILES = {
    "model.yaml": "model.yaml",
    "Makefile": "Makefile",
    "README.md": "README.md",
    "gitignore.txt": ".gitignore",
    "settings.json": ".vscode/settings.json",
    "ci.yml": ".github/workflows/controller.yml",
}
"""File of the package to file of the project."""


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    sub.add_argument(
        "folder", type=Path, metavar="FOLDER", help="a new folder; the system is named after it"
    )


def execute(options: argparse.Namespace) -> int:
    """Write the project; the exit status."""
    folder: Path = options.folder
    files = project(folder.resolve().name)
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise Refused(f"ravenchart: error: {folder} is there already: choose another folder")
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    options.answer.result = NewResult(str(folder), list(files))
    print(f"{folder}: {len(files)} files. Next, there: `make check`, `make run`, `make prove`")
    return OK


def project(name: str) -> dict[str, str]:
    """File name to text of a project; Refused where no system can have that name."""
    words = [part.capitalize() for part in re.split(r"[\W_]+", name) if part]
    system = "_".join(words if words[-1:] == ["System"] else [*words, "System"])
    files = {target: _text(source, system) for source, target in FILES.items()}
    model = files["model.yaml"].encode()
    loaded = load(Path("model.yaml"), lambda _path, limit: model[:limit])
    if loaded.system is None:
        found = render_all(loaded.diagnostics, loaded.sources)
        raise Refused(f"{found}\nravenchart: error: a system cannot be named after {name!r}")
    unit = f"{system.lower()}-plant-activities.adb"
    files[f"user/{unit}"] = _text("activities.adb.txt", system)
    files[".vscode/model.schema.json"] = json_schema()
    for name, schema in (("scenario", scenario_schema()), ("events", events_schema())):
        files[f".vscode/{name}.schema.json"] = json.dumps(schema, indent=2) + "\n"
    return files


def _text(file: str, system: str) -> str:
    found = resources.files("ravenchart.commands") / "new_project" / file
    return found.read_text(encoding="utf-8").replace(SYSTEM, system)
