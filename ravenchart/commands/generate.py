"""`ravenchart generate`: the program of a model, written beside it."""

from __future__ import annotations

import argparse

from ravenchart.failures import OK

from . import common

add_arguments = common.add_model


def execute(options: argparse.Namespace) -> int:
    """Write it; the exit status."""
    options.answer.result = common.generated(common.checked(options), options.answer)
    return OK
