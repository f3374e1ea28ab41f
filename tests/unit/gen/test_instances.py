# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Provers see only instances of generics: each generic of runtime and CAN layer has one."""

from __future__ import annotations

import re

from ravenchart.paths import ROOT

SOURCES = ("spark_runtime/src", "hw_can/hal", "hw_can/protocol", "hw_can/simulator")
GENERIC = re.compile(r"^generic\b.*?^(?:package|procedure|function) ([\w.]+)", re.M | re.S | re.I)


def generics() -> set[str]:
    """The library units that are generic."""
    found = set()
    for folder in SOURCES:
        for path in (ROOT / folder).glob("*.ads"):
            if match := GENERIC.search(path.read_text(encoding="utf-8")):
                found.add(match[1])
    return found


def instantiated(*folders: str) -> set[str]:
    """What is instantiated in some folders, without the packages that it is in."""
    texts = [
        path.read_text(encoding="utf-8")
        for folder in folders
        for path in (ROOT / folder).rglob("*.ad[sb]")
    ]
    names = (name for text in texts for name in re.findall(r"\bis\s+new\s+([\w.]+)", text))
    return {name.rsplit(".", 1)[-1] for name in names}


def test_each_generic_has_an_instance_that_is_proved() -> None:
    short, found = instantiated("proofs/instances", *SOURCES), generics()
    assert len(found) > 20 and "Ravenchart.Offers" in found
    assert [one for one in sorted(found) if one.rsplit(".", 1)[-1] not in short] == []
