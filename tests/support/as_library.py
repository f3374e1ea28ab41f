# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A model whose types, commands and components are put into a library of their own."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from typing import Any

import yaml

NAME = "Parts_Of_It"
SHARED = ("types", "commands", "components")


def split(folder: Path, out: Path) -> Path:
    """Write the model of a folder there, in two parts; its main file."""
    shutil.copytree(folder, out, ignore=shutil.ignore_patterns("generated*", "*.yaml"))
    whole: dict[str, Any] = {}
    merge(whole, folder / "model.yaml")
    library = {key: whole.pop(key) for key in SHARED if key in whole}
    write(out / "parts/library.yaml", {"library": NAME, "version": "1.0.0", **library})
    write(out / "model.yaml", {**whole, "include": ["parts/library.yaml"]})
    for path in sorted((out / "user").rglob("*.ad[bs]")):
        name = re.match(rf"{whole['system']}-(\w+)-activities\.", path.name, re.I)
        kinds = {one.lower().removesuffix("_type") for one in library.get("components", {})}
        if name is not None and name[1].removesuffix("_type") in kinds:
            there = out / "parts" / path.parent.relative_to(out)
            there.mkdir(parents=True, exist_ok=True)
            text = re.sub(rf"\b{whole['system']}\b", NAME, path.read_text("utf-8"), flags=re.I)
            moved = path.name.replace(whole["system"].lower(), NAME.lower(), 1)
            (there / moved).write_text(text, "utf-8")
            path.unlink()
    return out / "model.yaml"


def merge(whole: dict[str, Any], path: Path) -> None:
    """Add the sections of a file, and of those that it includes."""
    tree = yaml.load(path.read_text("utf-8"), Loader=yaml.BaseLoader)  # texts as they stand
    for key, value in tree.items():
        if key == "include":
            continue
        if isinstance(value, dict):
            whole.setdefault(key, {}).update(value)
        elif isinstance(value, list):
            whole.setdefault(key, []).extend(value)
        else:
            whole[key] = value
    for name in tree.get("include", ()):
        merge(whole, path.parent / name)


def write(path: Path, tree: dict[str, Any]) -> None:
    path.parent.mkdir(exist_ok=True)
    path.write_text(_plain(tree), "utf-8")


def _plain(node: Any) -> str:
    """A tree in flow style, numbers and truth values without quotes."""
    if isinstance(node, dict):
        return "{" + ", ".join(f"{key}: {_plain(one)}" for key, one in node.items()) + "}"
    if isinstance(node, list):
        return "[" + ", ".join(map(_plain, node)) + "]"
    is_plain = re.fullmatch(r"-?\d+|0x[0-9A-Fa-f_]+|true|false|yes|no", node)
    return node if is_plain else json.dumps(node)
