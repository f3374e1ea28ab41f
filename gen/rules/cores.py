# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rules for nodes with several cores: each core has its own objects."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.derive.sharing import MAIN
from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.model.system import System


def shared_across_cores(system: System) -> Iterator[Diagnostic]:
    """Nothing is shared between cores: ceilings protect an object on one core only.

    ``system`` is completed.
    """
    if all(node.cores == 1 for node in system.nodes):
        return
    tasks = {task.element: task for task in system.tasks}
    for item in system.objects:
        homes = {user: tasks[user].core if user in tasks else 1 for user in item.users}
        first, *others = item.users
        for other in others:
            if homes[other] != homes[first]:
                one, two = (
                    f"{'the main program' if user == MAIN else user} (core {homes[user]})"
                    for user in (first, other)
                )
                origin = (tasks.get(other) or tasks[first]).origin
                message = f"{item.element} is shared by {one} and {two}"
                hint = "put them on one core: cores exchange nothing"
                yield error("RV-0711", origin, message, hint=hint)
                break
