# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Many small models compiled as `ravenchart build` does, in one run of gprbuild.

Each model is a system of its own, so that what the compiler says of one is not kept
from being said by another; the runs share one project, which nothing is linked in.
The main program and the tasks are left out: they hardly depend on charts.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from ravenchart.analysis.findings.claims import claims_of
from ravenchart.analysis.system.timing import analyse
from ravenchart.failures import ToolFailed
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.program import generate
from ravenchart.tools import toolchain
from tests.support.interpreted import system_of


def complaints(models: Mapping[str, str], home: Path, mode: str) -> str:
    """What gprbuild says of these models, each under the name of its system; "": all compile."""
    source = home / "source"
    source.mkdir(parents=True, exist_ok=True)
    project = ""
    for name, text in models.items():
        system = system_of(text.replace(text.split("\n", 1)[0], f"system: {name}", 1))
        files = generate(system, claims_of(analyse(system)))
        root = ada_case(name).lower()
        project = f"{root}.gpr"
        others = ("reports", "timing_certificate", *(p.name.lower() for p in system.processors))
        left_out = {f"{root}_main", *(f"{root}-{other}" for other in others)}
        for file, content in files.items():
            if Path(file).stem not in left_out:
                (source / file).write_text(content)
    options = ["-p", "-q", "-c", "-u", "-k", "-j2", "-P", project]
    given = {"MODE": mode, "CAN_DRIVER": "loopback", "RAVENCHART_BUILD": str(home / "objects")}
    try:
        toolchain.run("gprbuild", options, source, given)
    except ToolFailed as problem:
        return str(problem)
    return ""
