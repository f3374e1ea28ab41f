# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The documentation as a site: `make site` builds it with Sphinx into build/site.

The sources are the pages of the repository themselves, so that links between them, and from
them to a source, hold in both places. Sphinx: https://www.sphinx-doc.org
"""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(ROOT), str(HERE)]

import api  # noqa: E402 - found by the path above

api.write()

project = "Ravenchart"
author = "Ravenchart contributors"
project_copyright = author
with (ROOT / "pyproject.toml").open("rb") as settings:
    release = tomllib.load(settings)["project"]["version"]

extensions = ["myst_parser", "sphinx.ext.autodoc"]
root_doc = "docs/index"
include_patterns = [
    "README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md", "docs/*.md",
    "proofs/*.md", "examples/README.md", "examples/*/README.md", "build/api/**.md",
]  # fmt: skip
nitpicky = False
myst_heading_anchors = 4
autodoc_typehints = "signature"
toc_object_entries = False  # thousands of names would be in the navigation of every page
suppress_warnings = ["misc.highlighting_failure", "ref.python"]  # short names of types

html_theme = "furo"
html_title = f"Ravenchart {release}"
html_show_copyright = False
html_copy_source = False
html_extra_path = [str(one) for one in [ROOT / "build" / "site_extra"] if one.is_dir()]


def setup(app: Sphinx) -> None:
    """Docstrings here are plain text: what is indented in them continues the line above."""
    app.connect("autodoc-process-docstring", _as_plain_text)


def _as_plain_text(*given: Any) -> None:
    lines: list[str] = given[-1]
    lines[:] = [line.lstrip() for line in lines]
