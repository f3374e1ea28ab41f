# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rules for the time inside protected objects, which is part of the tasks that call them."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.derive.sharing import too_long
from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.language.quantities import shown
from ravenchart.gen.model.system import System


def sections_are_part_of_tasks(system: System) -> Iterator[Diagnostic]:
    """No call of a protected object lasts longer than all that its task executes.

    ``system`` is completed.
    """
    for item, task in too_long(system):
        message = (
            f"a call of {item.element} may take {shown(item.section)}, "
            f"longer than all of {task.element}, {shown(task.wcet)}"
        )
        hint = f"raise the `wcet` of {task.element}"
        if task.slots:
            hint = f"put rows of {task.element} into a table with others, or raise a `wcet` of them"
        yield error("RV-0709", task.origin, message, hint=hint)
