# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What Alire writes for a crate before it calls gprbuild: config/<crate>_config.gpr.

`alr` itself is not used. The switches are those that Alire 2 documents for its three build
profiles, changed by the `[build-switches]` of the crate.
"""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

PROFILES = ("release", "validation", "development")
SECTIONS = ["-ffunction-sections", "-fdata-sections"]
SWITCHES: dict[str, dict[str, list[str]]] = {
    "source_encoding": {"utf-8": ["-gnatW8"], "compiler_default": []},
    "optimization": {
        "performance": ["-O3", "-gnatn", *SECTIONS],
        "size": ["-Os", "-gnatn", *SECTIONS],
        "debug": ["-Og", *SECTIONS],
    },
    "debug_info": {"no": [], "yes": ["-g"]},
    "runtime_checks": {
        "none": ["-gnatp"],
        "default": [],
        "overflow": ["-gnatp", "-gnato"],
        "everything": ["-gnato"],
    },
    "compile_checks": {
        "none": [],
        "warnings": ["-gnatwa", "-gnatw.X", "-gnatVa"],
        "errors": ["-gnatwa", "-gnatw.X", "-gnatVa", "-gnatwe"],
    },
    "contracts": {"no": [], "yes": ["-gnata"]},
    "style_checks": {"no": [], "yes": ["-gnaty3abcefhiklmnprtux"]},
    "ada_version": {"compiler_default": [], "ada12": ["-gnat12"], "ada2022": ["-gnat2022"]},
}
"""The switches of each choice, by category."""
DEFAULTS = {
    "release": {
        "optimization": "performance",
        "debug_info": "no",
        "runtime_checks": "default",
        "compile_checks": "none",
        "contracts": "no",
        "style_checks": "no",
    },
    "validation": {
        "optimization": "performance",
        "debug_info": "yes",
        "runtime_checks": "everything",
        "compile_checks": "errors",
        "contracts": "yes",
        "style_checks": "yes",
    },
    "development": {
        "optimization": "debug",
        "debug_info": "yes",
        "runtime_checks": "default",
        "compile_checks": "warnings",
        "contracts": "no",
        "style_checks": "yes",
    },
}
"""What is chosen in each profile where the crate says nothing."""


def manifest(crate: Path) -> dict[str, Any]:
    """The alire.toml of a crate."""
    return tomllib.loads((crate / "alire.toml").read_text(encoding="utf-8"))


def switches(crate: Path, profile: str) -> list[str]:
    """Those with which a crate is compiled in a profile."""
    chosen: dict[str, Any] = {
        "source_encoding": "utf-8", "ada_version": "compiler_default", **DEFAULTS[profile]
    }  # fmt: skip
    own = manifest(crate).get("build-switches", {})
    for changes in (own.get("*", {}), own.get(profile, {})):
        chosen |= {category.lower(): choice for category, choice in changes.items()}
    found: list[str] = []
    for category, choices in SWITCHES.items():
        choice = chosen[category]
        found += choice if isinstance(choice, list) else choices[choice.lower()]
    return found


def configure(crate: Path, profile: str) -> None:
    """Write the configuration of a crate."""
    known = manifest(crate)
    name = "_".join(part.capitalize() for part in known["name"].split("_"))
    listed = "\n          ,".join(f'"{one}"' for one in switches(crate, profile))
    kinds = ", ".join(f'"{one}"' for one in PROFILES)
    text = f"""\
--  Configuration for {known["name"]} as Alire generates it
abstract project {name}_Config is
   Crate_Version := "{known["version"]}";
   Crate_Name := "{known["name"]}";

   Alire_Host_OS := "linux";

   Alire_Host_Arch := "x86_64";

   Alire_Host_Distro := "debian";
   Ada_Compiler_Switches := External_As_List ("ADAFLAGS", " ");
   Ada_Compiler_Switches := Ada_Compiler_Switches &
          (
           {listed}
          );

   type Build_Profile_Kind is ({kinds});
   Build_Profile : Build_Profile_Kind := "{profile}";

end {name}_Config;
"""
    folder = crate / known.get("configuration", {}).get("output_dir", "config")
    folder.mkdir(exist_ok=True)
    (folder / f"{known['name']}_config.gpr").write_text(text, encoding="utf-8")


def project_path(*crates: Path) -> str:
    """GPR_PROJECT_PATH as Alire sets it: the folders of the project files of all crates."""
    return ":".join(
        str((crate / name).parent) for crate in crates for name in manifest(crate)["project-files"]
    )
