"""`ravenchart check`: the rules of a model, its behaviour and its deadlines."""

from __future__ import annotations

import argparse

from ravenchart.failures import OK

from . import common
from .results import CheckResult

add_arguments = common.add_model


def execute(options: argparse.Namespace) -> int:
    """Check it; the exit status."""
    system = common.checked(options, finish=True).system
    options.answer.result = CheckResult(
        system.name,
        system.digest,
        len(system.instances),
        len(system.processors),
        len(system.messages),
    )
    instances = common.several(len(system.instances), "instance")
    processors = common.several(len(system.processors), "processor")
    messages = common.several(len(system.messages), "message")
    print(f"{system.name}: {instances} on {processors}, {messages}; every deadline is met")
    return OK
