# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A model whose input ports are put into groups, with the rows of these in its tables."""

from __future__ import annotations

import random
import re
import shutil
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tests.support.as_library import merge, write

Json = dict[str, Any]
GROUP = "handled_apart"
SPARE = "spare_input"
HANDLES = ".ports"
WCET = "50 us"
LIMIT = "100 s"


@dataclass
class Grouped:
    """The merged files of a model, changed in place.

    With ``chance`` the groups are drawn, with periods and processors of their own. Without it the
    last input ports of each component are a group that runs right behind its port region.
    """

    model: Json
    chance: random.Random | None = None
    groups: dict[str, list[str]] = field(default_factory=dict)
    """The names of those of each component."""

    def make(self) -> None:
        """Group the ports of every component with two inputs or more, or with a spare one."""
        self._add_spares()
        released = dict(self._released())
        for name, component in self.model["components"].items():
            ports = component.get("ports", {}) if isinstance(component, dict) else {}
            inputs = [port for port, form in ports.items() if "in" in form]
            if len(inputs) > 1 and "port_region" in component:
                apart = released.get(name)
                self.groups[name] = self._group(component["port_region"], inputs, apart)
        for processor in list(self.model["processors"].values()):
            self._table(processor)
        for chain in self.model.get("chains", {}).values():
            chain |= {key: LIMIT for key in ("reaction", "age") if key in chain}

    # --- a second input port where there is only one

    def _add_spares(self) -> None:
        """One for each component whose instances are neither in others nor in arrays."""
        inner = [c for c in self.model["components"].values() if "instances" in c]
        hidden = {i["component"] for c in inner for i in c["instances"].values()}
        entries = self.model["instances"].items()
        hidden |= {one["component"] for _, one in entries if "count" in one}
        homes: dict[str, str] = {}
        for name, one in list(entries):
            component = self.model["components"][one["component"]]
            ports = component.get("ports", {}).items()
            inputs = [port for port, form in ports if "in" in form and port != SPARE]
            if one["component"] in hidden or len(inputs) != 1 or "port_region" not in component:
                continue
            component["ports"].setdefault(SPARE, {"in": "Boolean", "max_age": "1 s"})
            source = homes.setdefault(one["node"], f"spare_source_{len(homes)}")
            wire = {"from": f"{source}.told", "to": f"{name}.{SPARE}"}
            self.model.setdefault("connections", []).append(wire)
        for node, source in homes.items():
            self.model["components"]["Spare_Source_Type"] = {
                "ports": {"told": {"out": "Boolean"}},
                "activities": {
                    "tell": {
                        "period": "100 ms",
                        "wcet": "100 us",
                        "body": [{"send": "told", "with": "true"}],
                    }
                },
            }
            self.model["instances"][source] = {"component": "Spare_Source_Type", "node": node}
            self._run(f"{source}.tell", {"node": node})

    # --- groups

    def _released(self) -> list[tuple[str, str]]:
        """The components with a port that releases a processor, each with that port."""
        found = []
        for processor in self.model["processors"].values():
            owner, _, port = processor.get("released_by", "").rpartition(".")
            if processor["activities"][0] == owner + HANDLES:
                found.append((self._component(owner), port))
        return found

    def _group(self, region: Json, inputs: list[str], released: str | None) -> list[str]:
        times = {key: region[key] for key in ("period", "wcet", "deadline") if key in region}
        parts = [inputs[len(inputs) // 2 :]]
        if released is not None:
            parts = [[released]]
        elif self.chance is not None:
            apart = self.chance.sample(inputs, self.chance.randint(1, len(inputs) - 1))
            cut = self.chance.randint(0, len(apart) - 1)
            parts = [part for part in (apart[:cut], apart[cut:]) if part]
        found = region.setdefault("groups", {})
        for number, part in enumerate(parts):
            own = times | {"wcet": WCET, "ports": part}
            if self.chance is not None and released is None:
                count, unit = region["period"].split()
                own["period"] = f"{int(count) * self.chance.choice((1, 2, 3))} {unit}"
            found[f"{GROUP}_{number}"] = own
        return list(found)

    def _table(self, processor: Json) -> None:
        """Put the rows of the groups of its port regions behind these, or apart."""
        made = []
        chains = self.model.get("chains", {}).values()
        logical = any("logical_execution_time" in chain for chain in chains)
        kept = logical or {"logical_execution_time", "schedule"} & processor.keys()
        together = self.chance is None or kept
        same: Json = {key: processor[key] for key in ("node", "core") if key in processor}
        for row in processor["activities"]:
            owner = row.removesuffix(HANDLES)
            groups = [] if owner == row else self.groups.get(self._component(owner), [])
            rows = [f"{owner}.{group}" for group in groups]
            if rows and "released_by" in processor:
                made += rows
                self._run(row, same)
                continue
            made.append(row)
            if together:
                made += rows
                continue
            for one in rows:
                self._run(one, same)
        processor["activities"] = made

    def _run(self, row: str, keys: Json) -> None:
        """A processor of its own for a row."""
        number = len(self.model["processors"])
        own = keys | {"stack": "16 KiB", "activities": [row]}
        self.model["processors"][f"apart_{number}"] = own

    def _component(self, owner: str) -> str:
        """The component of an instance, or of an array, at the end of a path."""
        found: Json = self.model
        for name in owner.split("."):
            inside = found["instances"]
            entry = inside.get(name) or inside[re.sub(r"_(\*|\d+)$", "", name)]
            found = self.model["components"][entry["component"]]
        return str(entry["component"])


def grouped(folder: Path, out: Path, chance: random.Random | None = None) -> Path:
    """Write the model of a folder there, with groups; its main file."""
    shutil.copytree(folder, out, ignore=shutil.ignore_patterns("generated*", "*.yaml"))
    model: Json = {}
    merge(model, folder / "model.yaml")
    Grouped(model, chance).make()
    write(out / "model.yaml", model)
    return out / "model.yaml"
