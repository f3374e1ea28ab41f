# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The rooms of the house and who imports whom, counted and drawn.

`python -m tests.support.rooms` writes docs/pictures/house/: the packages of `ravenchart`, and those
of `gen`. A room is a package or module at that depth. An arrow goes from a room to one that it
imports; of two ways the drawing has the longer one. A back arrow is one of a circle.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import grimp
import networkx as nx

from ravenchart.building import drawings
from ravenchart.paths import ROOT

PICTURES = ROOT / "docs" / "pictures" / "house"
PACKAGES = {"ravenchart": 2, "ravenchart.gen": 3}
"""What is drawn, with the parts of a room's name."""


@dataclass(frozen=True, slots=True)
class House:
    """The rooms of a package, with the arrows between them."""

    name: str
    arrows: nx.DiGraph[str]

    @property
    def levels(self) -> int:
        """Rooms on the longest way down."""
        return int(nx.dag_longest_path_length(nx.condensation(self.arrows))) + 1

    @property
    def back_arrows(self) -> list[tuple[str, str]]:
        """The arrows of circles."""
        circle = nx.condensation(self.arrows).graph["mapping"]
        return sorted((a, b) for a, b in self.arrows.edges if circle[a] == circle[b])

    def dot(self) -> str:
        """The drawing, as Graphviz reads it."""
        shown = self.arrows if self.back_arrows else nx.transitive_reduction(self.arrows)
        rooms = sorted(self.arrows)
        lines = [f'  "{one}" [label="{one.removeprefix(self.name + ".")}"]' for one in rooms]
        lines += [f'  "{a}" -> "{b}"' for a, b in sorted(shown.edges)]
        style = 'node [shape=box, fontname="Helvetica"]\n  edge [color="gray40"]'
        return "\n".join([f'digraph "{self.name}" {{', f"  {style}", *lines, "}", ""])


@cache
def _modules() -> grimp.ImportGraph:
    return grimp.build_graph("ravenchart", cache_dir=None)


def house(name: str) -> House:
    """The rooms of a package that is drawn."""
    depth = PACKAGES[name]
    arrows: nx.DiGraph[str] = nx.DiGraph()

    def room(module: str) -> str:
        return ".".join(module.split(".")[:depth])

    for module in sorted(_modules().modules):
        for other in sorted(_modules().find_modules_directly_imported_by(module)):
            inside = all(one.startswith(f"{name}.") for one in (module, other))
            if inside and room(module) != room(other):
                arrows.add_edge(room(module), room(other))
    return House(name, arrows)


def main() -> None:
    """Write the drawings, and print what was counted."""
    PICTURES.mkdir(exist_ok=True)
    for name in PACKAGES:
        made = house(name)
        (PICTURES / f"{name}.svg").write_text(drawings.svg(made.dot()), encoding="utf-8")
        print(
            f"{name}: {len(made.arrows)} rooms on {made.levels} levels, "
            f"{len(made.back_arrows)} back arrows"
        )


if __name__ == "__main__":
    main()
