"""The whole check of one model."""

from __future__ import annotations

from pathlib import Path

from .declared import check_component
from .deployment import Deployment
from .findings import Report, UnusableError
from .model import read
from .timing import Timing

ALWAYS = (
    "who shares objects other than devices: each task counts as blocked for a critical section",
    "how guards are put together, and all effects, entries and exits",
    "leaves that histories restore",
    "bodies of the program: gnatprove proves them against the declared form",
    "use of the certificate's facts by the program: the compiler compares them",
)
"""What this checker does not look at."""


def checked(main: Path, generated: Path | None = None) -> Report:
    """The report on a model and its generated program."""
    report = Report()
    model = read(main)
    deployment = Deployment(model)
    usual = main.name.lower() == "model.yaml"
    name = "generated" if usual else f"generated-{main.name.removesuffix('.yaml')}"
    folder = main.parent / name if generated is None else generated
    for program, instances in deployment.programs(folder):
        if not program.is_dir():
            raise UnusableError(f"{program} is missing: generate the program first")
        path = program / f"{model.name.lower()}-timing_certificate.ads"
        Timing(deployment, path, report).check()
        kinds = model.section("components")
        here = (deployment.instances.map(one).text("component") or "" for one in instances)
        for component in dict.fromkeys(kinds.name(kind) for kind in here):
            if component is not None:
                check_component(model, component, program, report)
    for what in ALWAYS:
        report.skip(what, 0)
    return report
