# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The API pages of the documentation: one for each Ada package, one for each Python package.

And one that leads to the evidence of the examples.

They are made of the sources at each build, below build/, so that none of them is ever old.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HOME = ROOT / "build" / "api"
"""Where the pages are written."""

ADA = {
    "spark_runtime/src": "The run-time support, which every generated program uses.",
    "spark_runtime/native": "Looks at a running controller on Linux, and signals as interrupts.",
    "spark_runtime/light": "The one unit of a port to a board that has a body for each board.",
    "spark_runtime/zynqmp": "Interrupts of the first board.",
    "spark_runtime/zynqmp/gateway": "The second serial line of the first board, for python-can.",
    "spark_runtime/devices": "For programs whose devices can fail at their start.",
    "spark_runtime/simulated": "In place of tasks and clock where a program runs in virtual time.",
    "hw_can/hal": "Frames, codecs, protection, and what a CAN driver offers.",
    "hw_can/drivers/serial": "Frames as lines of an slcan adapter.",
    "hw_can/drivers/slcan": "The driver of an slcan adapter: its serial line.",
    "hw_can/drivers/bus": "The driver of a simulated bus: a member of its server.",
    "hw_can/drivers/socketcan": "The driver of the CAN sockets of Linux.",
    "hw_can/drivers/ctucanfd": "The driver of the core CTU CAN FD: registers and frames.",
    "hw_can/drivers/xilinx": "The driver of the controller of Zynq: registers and frames.",
    "hw_can/drivers/sockets": "Connections of drivers that use sockets.",
    "hw_can/drivers/tcp": "Streams over TCP.",
    "hw_can/simulator": "A CAN bus bit by bit: frames, arbitration, fault confinement.",
    "hw_can/server": "Nodes with buffers on a simulated bus, and its server.",
    "hw_can/protocol": "Records between the nodes and the server of a simulated bus.",
    "analysis/kernel": "The kernel of the timing analysis.",
}
"""Folders of package specifications, and what is in them."""

PYTHON = {
    "gen": "From the files of a model to Ada.",
    "analysis": "Response times, chains, reports.",
    "behaviour": "The interpreter of charts, and the rules of behaviour.",
    "hw_can": "The bench, the bus client and the loopback tests.",
    "ravenchart": "The command line.",
}
"""Packages below `ravenchart`, and what is in them."""


def write() -> None:
    """Write all pages anew."""
    shutil.rmtree(HOME, ignore_errors=True)
    HOME.mkdir(parents=True)
    pages = [_ada_folder(folder, text) for folder, text in ADA.items()]
    (HOME / "ada.md").write_text(_index("Ada packages", pages), encoding="utf-8")
    pages = [_python_package(name, text) for name, text in PYTHON.items()]
    (HOME / "python.md").write_text(_index("Python packages", pages), encoding="utf-8")
    (HOME / "evidence.md").write_text(_evidence(), encoding="utf-8")


EVIDENCE = ROOT / "build" / "site_extra" / "evidence"
"""Folders of evidence that `make site` wrote; the site has them as they are."""


def _evidence() -> str:
    """A page that leads to the evidence of the examples: raw links, for these are no pages."""
    names = sorted(one.parent.name for one in EVIDENCE.glob("*/index.html"))
    items = "\n".join(
        f'<li><a href="../../evidence/{name}/index.html">{name}</a></li>' for name in names
    )
    listed = f"<ul>\n{items}\n</ul>\n" if names else "`make site` writes it.\n"
    text = "What is shown of the examples and what is not, as an assessor gets it; see"
    return f"# Evidence of the examples\n\n{text} [Evidence](../../docs/evidence.md).\n\n{listed}"


def _index(title: str, pages: list[str]) -> str:
    listed = "\n".join(pages)
    return f"# {title}\n\n```{{toctree}}\n:maxdepth: 2\n:titlesonly:\n\n{listed}\n```\n"


def _ada_folder(folder: str, text: str) -> str:
    """A page for each specification of a folder, and one that lists them; the name of that."""
    home = HOME / folder.replace("/", "-")
    home.mkdir()
    rows, names = [], []
    for spec in sorted((ROOT / folder).glob("*.ads")):
        source = spec.read_text(encoding="utf-8")
        name = _ada_name(spec)
        page = f"# {name}\n\n[{folder}/{spec.name}](../../../{folder}/{spec.name})\n\n"
        page += f"```ada\n{source.rstrip()}\n```\n"
        (home / f"{spec.stem}.md").write_text(page, encoding="utf-8")
        rows.append(f"| [{name}]({spec.stem}.md) | {_first_sentence(source)} |")
        names.append(spec.stem)
    listed = "\n".join(names)
    table = "\n".join(["| package | holds |", "| --- | --- |", *rows])
    tree = f"```{{toctree}}\n:hidden:\n:titlesonly:\n\n{listed}\n```\n"
    index = f"# {folder}\n\n{text}\n\n{table}\n\n{tree}"
    (home / "index.md").write_text(index, encoding="utf-8")
    return f"{home.name}/index"


def _ada_name(spec: Path) -> str:
    """The name of a unit, from its file."""
    parts = spec.stem.split("-")
    return ".".join("_".join(word.capitalize() for word in part.split("_")) for part in parts)


def _first_sentence(source: str) -> str:
    """The first sentence of the comment at the head of a specification."""
    words = []
    for line in source.partition("\n\n")[2].splitlines():  # behind the licence
        if not line.startswith("--") or line == "--":
            break
        words.append(line.removeprefix("--").strip())
    return " ".join(words).partition(". ")[0].rstrip(".:")


def _python_package(name: str, text: str) -> str:
    """A page for each folder of modules of a package, and one that lists them; the name of that."""
    home = HOME / f"python-{name}"
    home.mkdir()
    top = "ravenchart" if name == "ravenchart" else f"ravenchart.{name}"
    pages = []
    for folder, modules in _folders(ROOT / name, top):
        title = folder.removeprefix(f"{top}.")
        blocks = "\n".join(
            f"## {module.rpartition('.')[2]}\n\n```{{eval-rst}}\n.. automodule:: {module}\n"
            "   :members:\n   :member-order: bysource\n```\n"
            for module in modules
        )
        (home / f"{folder}.md").write_text(f"# {title}\n\n{blocks}", encoding="utf-8")
        pages.append(folder)
    listed = "\n".join(pages)
    index = f"# {top}\n\n{text}\n\n```{{toctree}}\n:maxdepth: 1\n:titlesonly:\n\n{listed}\n```\n"
    (home / "index.md").write_text(index, encoding="utf-8")
    return f"{home.name}/index"


def _folders(place: Path, name: str) -> Iterator[tuple[str, list[str]]]:
    """The folders of modules in a package, each with its modules, outermost first."""
    modules = sorted(
        f"{name}.{one.stem}" for one in place.glob("*.py") if not one.stem.startswith("__")
    )
    if modules:
        yield name, modules
    for inner in sorted(one for one in place.iterdir() if (one / "__init__.py").is_file()):
        if not inner.is_symlink():
            yield from _folders(inner, f"{name}.{inner.name}")
