# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A program for an emulated board together with the gateway to the bus of its host.

The gateway is an Ada unit in the folder `gateway` of the target. A main program of its own starts
it, and then the main program of the model, in a project that extends the generated one.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.paths import ROOT
from ravenchart.stacks.report import Memory
from ravenchart.tools import toolchain

from . import stacks
from .programs import Program
from .targets import Board, Gateway, file_of

MODE = "release"
MAIN = """\
with {main};
with Ravenchart.Gateways;
with System;

procedure Gateway_Main
with Priority => System.Priority'First
is
begin
   Ravenchart.Gateways.Start;
   {main};
end Gateway_Main;
"""
PROJECT = """\
with "ravenchart.gpr";

project Gateway extends "{program}" is

   for Source_Dirs use (".", {folders});
   for Object_Dir use "objects";
   for Exec_Dir use ".";
   for Create_Missing_Dirs use "True";
   for Main use ("gateway_main.adb");

   package Compiler renames Ravenchart.Compiler;

end Gateway;
"""


def build(
    program: Program,
    board: Board,
    gateway: Gateway,
    warn: Callable[[str], None],
    tell: Callable[[str], None],
) -> tuple[Path, Memory]:
    """Compile the program and the gateway; the path of the image, and the stacks and the memory of
    the program without the gateway. Raises as `Program.build`.
    """
    memory = stacks.kept(program.build(MODE, gateway.driver, warn=warn, board=board, tell=tell))
    home = program.home(gateway.driver, board.place) / "gateway"
    home.mkdir(parents=True, exist_ok=True)
    main = f"{ada_case(program.checked.system.name)}_Main"
    places = file_of(board.target.name).parent / "gateway", ROOT / "hw_can" / "drivers" / "serial"
    folders = ", ".join(f'"{place}"' for place in places)
    texts = {
        "gateway_main.adb": MAIN.format(main=main),
        "gateway.gpr": PROJECT.format(program=program.project, folders=folders),
    }
    for name, text in texts.items():
        path = home / name
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")
    variables = {
        **program.scenario(MODE, gateway.driver, board.place),
        **board.scenario(),
    }
    options = [*board.options(), "-p", "-q", "-j0", "-P", "gateway.gpr"]
    said = toolchain.run("gprbuild", options, home, variables)
    if said.strip():
        warn(said.rstrip())
    return home / "gateway_main", memory
