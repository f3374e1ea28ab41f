# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart generate`: the program of a model, written beside it."""

from __future__ import annotations

import argparse

from ravenchart.building import unchanged
from ravenchart.failures import OK

from . import common

add_arguments = common.add_model


def execute(options: argparse.Namespace) -> int:
    """Write it, where it is not there as it would be written; the exit status."""
    before = unchanged.generation(options.model)
    if before is not None:
        options.answer.result = common.generated_before(before, options.answer)
        return OK
    checked = common.checked(options, library=True)
    written, options.answer.result = common.write(checked, options.answer)
    unchanged.keep(checked, written)
    return OK
