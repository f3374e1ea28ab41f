# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The API reference has a page for each Ada specification, and a line that says what it holds."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

import pytest

from ravenchart.paths import ROOT


@pytest.fixture(scope="module")
def api() -> Any:
    """The module that writes the pages; it belongs to the configuration of the site."""
    spec = importlib.util.spec_from_file_location("api_pages", ROOT / "docs" / "site" / "api.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def specs() -> list[Path]:
    """The Ada specifications of the product."""
    tops = ("spark_runtime", "hw_can", "analysis")
    return [path for top in tops for path in sorted((ROOT / top).rglob("*.ads"))]


def test_every_folder_of_specifications_is_listed(api: Any) -> None:
    assert {path.parent.relative_to(ROOT).as_posix() for path in specs()} == set(api.ADA)


def test_the_table_has_the_first_sentence_of_each_specification(api: Any) -> None:
    for path in specs():
        said = api._first_sentence(path.read_text(encoding="utf-8"))
        assert len(said.split()) >= 3 and "SPDX" not in said, path
    blackboards = ROOT / "spark_runtime" / "src" / "ravenchart-blackboards.ads"
    said = api._first_sentence(blackboards.read_text(encoding="utf-8"))
    assert said == "Last value of a sampled datum: one writer, any number of readers"
