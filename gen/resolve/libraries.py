# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The keys that the files of a library may have."""

from __future__ import annotations

from collections.abc import Sequence

from ravenchart.gen.files.schema import ModelFile
from ravenchart.gen.language.names import Findings

WRONG = "RV-0811"
SHARED = frozenset({"library", "version", "include", "types", "commands", "components"})
"""The keys of a library's files: what is the same in every system."""


def check_library(files: Sequence[ModelFile], findings: Findings) -> None:
    """Report what a library lacks, and what its own files cannot hold; main file first."""
    main = files[0]
    if main.version is None and not main.lost("version"):
        message = f"the library {main.library} has no version"
        hint = "add one: `version: 1.0.0`"
        findings.error(WRONG, main.at_key("library"), message, hint=hint)
    for file in files:
        for name in (key for key in file.tree if key not in SHARED):
            message = f"a library has no `{name}`"
            hint = "it stands in the systems that include the library"
            findings.error(WRONG, file.at_key(name), message, hint=hint)


def check_named(files: Sequence[ModelFile], findings: Findings) -> None:
    """Report a version of what is no library, and a library inside a system's main file."""
    for file in files:
        if file.version is not None and file.library is None and not file.lost("library"):
            message = "only a library has a version"
            hint = "add `library: NAME`, or remove it"
            findings.error(WRONG, file.at_key("version"), message, hint=hint)
