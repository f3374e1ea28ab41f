# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`--bounds FILE`: bounds of execution times from a static WCET tool, compared with the model."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from ravenchart import rounded
from ravenchart.analysis.plain.bounds import Bound, read_bounds
from ravenchart.analysis.units import microseconds
from ravenchart.building.checking import Checked
from ravenchart.failures import Refused
from ravenchart.gen.model.system import System
from ravenchart.running.measured import MeasuredRow, key_of, origin_of

from .plain import text_of


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare where the bounds are."""
    sub.add_argument(
        "--bounds", type=Path, metavar="FILE",
        help="compare the bounds of a static WCET tool with the WCETs: CSV with the columns "
        "row or function, and wcet_us, or cycles and clock_hz",
    )  # fmt: skip


def of_model(options: argparse.Namespace, checked: Checked) -> Mapping[str, Bound]:
    """The bounds that are given, by row; Refused with everything that is wrong with the file."""
    if options.bounds is None:
        return {}
    found = read_bounds(text_of(options.bounds), str(options.bounds), checked.system)
    if isinstance(found, tuple):
        raise Refused("\n".join(map(str, found)))
    return found


def rows(checked: Checked, given: Mapping[str, Bound]) -> list[MeasuredRow]:
    """Every row with its WCET and its bound; nothing is measured."""
    found = {name: one.wcet for name, one in given.items()}
    return [
        MeasuredRow(slot.element, slot.timing.wcet, None, None, found.get(slot.element))
        for slot in checked.system.slots
    ]


def findings(
    table: Sequence[MeasuredRow], given: Mapping[str, Bound], system: System
) -> Iterator[str]:
    """An error for each WCET that a figure refutes, where the WCET stands, with a hint."""
    for one in table:
        place, key = origin_of(system, one.row), key_of(system, one.row)
        seen, bound = one.measured or 0, given.get(one.row)
        took = f"{one.row} was measured to take"
        if seen > one.wcet:
            longest, stated = rounded.beside(seen, one.wcet)
            wanted = microseconds(one.proposed or seen)
            yield (
                f"{place}: error: {took} {longest}, above its `{key}` of {stated}\n"
                f"{place}: hint: write `{key}: {wanted} us` or more"
            )
        if bound is not None and bound.wcet > one.wcet:
            longest, stated = rounded.beside(bound.wcet, one.wcet)
            yield (
                f"{bound.place}: error: the bound of {one.row}, {longest}, is above its `{key}` "
                f"of {stated}\n"
                f"{place}: note: the `{key}` of {one.row} is here\n"
                f"{place}: hint: write `{key}: {microseconds(bound.wcet)} us` or more"
            )
        if bound is not None and seen > bound.wcet:
            longest, stated = rounded.beside(seen, bound.wcet)
            yield (
                f"{bound.place}: error: {took} {longest}, above its bound of {stated}\n"
                f"{bound.place}: hint: let the tool analyse the program that was measured, for "
                "the processor that it was measured on"
            )
