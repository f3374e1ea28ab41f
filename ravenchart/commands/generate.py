"""`ravenchart generate`: the program of a model, written beside it."""

from __future__ import annotations

import argparse

from ravenchart.building import generation
from ravenchart.failures import OK

from . import common

add_arguments = common.add_model


def execute(options: argparse.Namespace) -> int:
    """Write it; the exit status."""
    written = generation.write_program(common.checked(options))
    options.answer.result = common.tell_written(written, options.answer)
    return OK
