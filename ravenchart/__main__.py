"""The `ravenchart` command: check, generate, build, prove, analyse and run any model.

`start` is what a process begins with; it has the table of exit statuses.
"""

from __future__ import annotations

if __name__ == "__main__":  # `python -m ravenchart`: before anything else is imported
    from .start import main as begin

    raise SystemExit(begin())

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path

from ravenchart.analysis.plain.build import PlainSystem
from ravenchart.analysis.present import report
from ravenchart.analysis.present.figures import figures
from ravenchart.analysis.present.table import show as show_table
from ravenchart.building.steps import Refused
from ravenchart.building.toolchain import ToolFailed, ToolMissing
from ravenchart.gen.diagnostics import render
from ravenchart.hw_can.bench.peer import BenchError
from ravenchart.proof.spark_results import Outside
from ravenchart.running.running import RunRequest, controller, run_model
from tests import house

from . import start
from .building import steps
from .commands import allocate, bus, draw, loopback, observed, plain, simulate
from .databases import database as import_database
from .proof import outside_spark, proving
from .running import scenarios

OK, WRONG, UNUSABLE, NOT_JUDGED = 0, 1, 2, 3


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; the exit status."""
    options = _parser().parse_args(arguments)
    try:
        status: int = options.command(options)
    except Refused as refused:
        print(refused, file=sys.stderr)
        return WRONG
    except (ToolFailed, outside_spark.WrongList) as failed:
        print(str(failed).rstrip(), file=sys.stderr)
        return WRONG
    except BrokenPipeError:
        raise  # nobody reads the output: `start` tells that from other broken pipes
    except (ToolMissing, BenchError) as problem:
        print(f"ravenchart: error: {problem}", file=sys.stderr)
        return UNUSABLE
    except OSError as problem:
        print(f"ravenchart: error: {said_of(problem)}", file=sys.stderr)
        return UNUSABLE
    except KeyboardInterrupt:
        print("ravenchart: interrupted", file=sys.stderr)
        return 130
    return status


def said_of(problem: OSError) -> str:
    """What the system says of a file, with its name and without a number."""
    reason = problem.strerror or str(problem)
    reason = f"{reason[:1].lower()}{reason[1:]}"
    return reason if problem.filename is None else f"{problem.filename}: {reason}"


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="ravenchart",
        description="From one model of a real-time controller to a proved SPARK Ada program, "
        "its timing analysis and its CAN bench.",
        epilog=start.STATUSES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")

    def command(name: str, work: object, help_text: str) -> argparse.ArgumentParser:
        sub = commands.add_parser(name, help=help_text, description=help_text)
        sub.add_argument("model", type=Path, metavar="MODEL", help="the model's YAML file")
        sub.set_defaults(command=work)
        return sub

    command("check", _check, "check the model: its rules and its deadlines")
    command("generate", _generate, "write generated/ beside the model")
    build = command("build", _build, "generate, and compile the controller")
    prove = command("prove", _prove, "generate, and prove the controller with gnatprove")
    for sub in (build, prove):
        sub.add_argument("--driver", choices=house.DRIVERS, help="the CAN driver")
    build.add_argument(
        "--mode", choices=("checks", "release"), default="checks",
        help="checks: every contract is executed; release: -O2, proof stands for checks",
    )  # fmt: skip
    prove.add_argument(
        "--whole", action="store_true",
        help="prove the runtime and the HAL again, which `make prove` proves by themselves",
    )  # fmt: skip
    prove.add_argument(
        "--fresh", action="store_true",
        help="run gnatprove also where the same content was proved before",
    )  # fmt: skip
    prove.add_argument("--record", type=Path, help="write the proof record to this file")
    analyse = command(
        "analyse", _analyse, "response times against deadlines, of a model or of CSV or JSON"
    )
    analyse.add_argument("--html", type=Path, metavar="FILE", help="write the report there too")
    analyse.add_argument(
        "--observed", type=Path, metavar="FILE",
        help="hold the execution times in the trace of a run, or of a plain file in a plain file, "
        "against the budgets",
    )  # fmt: skip
    output = analyse.add_mutually_exclusive_group()
    output.add_argument("--json", action="store_true", help="print everything as JSON")
    output.add_argument("--export", choices=plain.EXPORTS, help="print the system for that tool")
    allocation = command(
        "allocate", _allocate, "put the periodic rows of a model into processors anew, and check"
    )
    allocation.add_argument(
        "--strategy", choices=tuple(allocate.STRATEGIES), required=True,
        help="a processor for each period; for each instance where rates fit; as few as do; "
        "as much slack as there is",
    )  # fmt: skip
    allocation.add_argument("--yaml", action="store_true", help="print it for the model")
    run = command("run", _run, "build and run the controller on this machine")
    run.add_argument("--scenario", type=Path, help="play this scenario on its CAN bus")
    run.add_argument(
        "--seconds", type=float, default=10.0, help="how long without a scenario (default 10)"
    )
    run.add_argument(
        "--strict", action="store_true",
        help="exit status 3 where the run passed, but its timing could not be judged",
    )  # fmt: skip
    run.add_argument("--report", type=Path, metavar="DIR", help="where the report goes")
    _add_draw(commands)
    _add_loopback(commands)
    _add_bus(commands)
    _add_import(commands)
    simulation = command("simulate", _simulate, "run the model in virtual time, step by step")
    simulation.add_argument("--events", type=Path, metavar="FILE", required=True, help="stimuli")
    simulation.add_argument(
        "--interpreter", action="store_true", help="by the interpreter, not the generated program"
    )
    simulation.add_argument("--json", action="store_true", help="one JSON object for each step")
    return parser


def _add_draw(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    help_text = "draw the charts and the component structure"
    sub = commands.add_parser("draw", help=help_text, description=help_text)
    source = sub.add_mutually_exclusive_group(required=True)
    source.add_argument(
        "model", type=Path, nargs="?", metavar="MODEL", help="the model's YAML file"
    )
    source.add_argument(
        "--from-ada",
        type=Path,
        metavar="FILE",
        help="draw what the generated spec of a region says",
    )
    sub.add_argument("--out", type=Path, metavar="DIR", help="where to (default: drawings/ beside)")
    sub.add_argument("--format", choices=draw.FORMATS, default="svg", help="default: svg")
    sub.set_defaults(command=_draw)


def _add_loopback(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    help_text = "test any python-can interface that has two ends on one bus"
    sub = commands.add_parser("loopback", help=help_text, description=help_text)
    loopback.add_arguments(sub)
    sub.set_defaults(command=_loopback)


def _add_bus(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    help_text = "put a simulated CAN bus behind a TCP port, for any number of processes"
    sub = commands.add_parser("bus", help=help_text, description=help_text)
    bus.add_arguments(sub)
    sub.set_defaults(command=_bus)


def _add_import(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    help_text = "print the messages of a CAN database as types, ports and messages of a model"
    sub = commands.add_parser(
        "import", aliases=["import-dbc"], help=help_text, description=help_text
    )
    sub.add_argument(
        "database", type=Path, metavar="FILE", help="the database: DBC, KCD, SYM or ARXML"
    )
    seen = sub.add_mutually_exclusive_group(required=True)
    seen.add_argument("--node", help="the node of the database that the model is of")
    seen.add_argument("--all", action="store_true", help="a node that receives every message")
    sub.add_argument(
        "--period", metavar="TIME",
        help="least time between frames of a message whose database has no cycle time: `100 ms`",
    )  # fmt: skip
    sub.add_argument(
        "--periods", type=Path, metavar="FILE",
        help="the same for single messages, in YAML: `message: 20 ms`",
    )  # fmt: skip
    sub.add_argument(
        "--lenient", action="store_true",
        help="read a database whose signals share bits or reach beyond their frame",
    )  # fmt: skip
    sub.set_defaults(command=_import_dbc)


def _checked(
    options: argparse.Namespace, *, deadlines: bool = True, finish: bool = False
) -> steps.Checked:
    checked = steps.check(options.model, deadlines=deadlines, finish=finish)
    if checked.warnings:
        print(checked.warnings, file=sys.stderr)
    return checked


def _check(options: argparse.Namespace) -> int:
    system = _checked(options, finish=True).system
    instances = _several(len(system.instances), "instance")
    processors = _several(len(system.processors), "processor")
    messages = _several(len(system.messages), "message")
    print(f"{system.name}: {instances} on {processors}, {messages}; every deadline is met")
    return OK


def _several(count: int, what: str) -> str:
    return f"{count} {what}" if count == 1 else f"{count} {what}s"


def _generate(options: argparse.Namespace) -> int:
    _written(steps.write_program(_checked(options)))
    return OK


def _written(written: steps.Written) -> None:
    print(f"{written.folder}: {_several(written.files, 'file')}, {written.changed} changed")
    for name in written.edited:
        print(
            f"warning: {written.folder / name} was edited by hand and is generated again; "
            f"your version is kept as {name}{steps.EDITED}",
            file=sys.stderr,
        )
    for path in written.missing:
        where = f"its spec is in {written.folder}, the body is yours"
        if path.suffix == ".ads":
            where = "both spec and body of what a device remembers are yours"
        print(f"note: {path} is not there yet; {where}", file=sys.stderr)


def _build(options: argparse.Namespace) -> int:
    checked = _checked(options)
    _written(steps.write_program(checked))
    for made in steps.programs_of(checked):
        print(f"built {made.build(options.mode, options.driver)}")
    return OK


def _prove(options: argparse.Namespace) -> int:
    checked = _checked(options)
    _written(steps.write_program(checked))
    driver = options.driver or steps.default_driver(checked)
    steps.check_driver(checked, driver)
    made = steps.programs_of(checked)
    if options.record is not None and len(made) > 1:
        raise Refused("ravenchart: error: --record is for a system with one node")
    reasons = outside_spark.reasons_for_model(checked.folder)
    clean = True
    outside: dict[Outside, None] = {}
    for one in made:
        proof = proving.prove(one.proof(driver, whole=options.whole), fresh=options.fresh)
        where = f" on {one.node}" if len(made) > 1 else ""
        print(f"{checked.system.name}{where}: {proof.summary()}", flush=True)
        clean = clean and proof.clean
        outside |= dict.fromkeys(proof.results.outside)
        if options.record is not None:
            options.record.write_text(proving.record_text(proof), encoding="utf-8")
    for line in outside_spark.lines(tuple(outside), reasons):
        print(line, file=sys.stderr if line.startswith("error") else sys.stdout)
    return OK if clean and outside_spark.agree(tuple(outside), reasons) else WRONG


def _analyse(options: argparse.Namespace) -> int:
    printed = options.json or options.export is not None
    if printed and (options.html is not None or options.observed is not None):
        raise Refused("ravenchart: error: --json and --export go without --html and --observed")
    if options.model.suffix.lower() in plain.ENDINGS:
        if options.html is not None:
            raise Refused(f"{options.model}: error: --html is for models")
        met = plain.run(
            options.model, as_json=options.json, export=options.export, seen=options.observed
        )
        return OK if met else WRONG
    checked = _checked(options, deadlines=False)
    if options.export is not None:
        chains = tuple(latency.chain for _, latency in checked.analysis.limited)
        system = PlainSystem(checked.analysis.network, chains)
        print(plain.exported(system, options.export, options.model, checked.system.name), end="")
        return OK
    if options.json:
        print(json.dumps(figures(checked.analysis), indent=1))
        return OK if checked.analysis.schedulable else WRONG
    show_table(checked.analysis)
    if options.html is not None:
        options.html.write_text(report.render(checked.analysis), encoding="utf-8")
        print(f"report: {options.html}")
    good = checked.analysis.schedulable
    if options.observed is not None:
        good = observed.within_budgets(checked, options.observed) and good
    return OK if good else WRONG


def _allocate(options: argparse.Namespace) -> int:
    checked = _checked(options, deadlines=False)
    proposal = allocate.propose(checked.analysis, options.strategy)
    if options.yaml:
        print(allocate.yaml(proposal), end="")
    else:
        allocate.show(proposal)
    return OK if proposal.analysis.schedulable else WRONG


def _run(options: argparse.Namespace) -> int:
    checked = _checked(options)
    if options.scenario is not None:
        scenarios.checked(options.scenario, checked.system)
    _written(steps.write_program(checked))
    controllers = []
    for made in steps.programs_of(checked):
        controllers.append(controller(made))
        print(f"built {controllers[-1].executable}")
    home = steps.build_home(checked, steps.default_driver(checked))
    folder = options.report or home / "report"
    request = RunRequest(
        checked.analysis,
        tuple(controllers),
        checked.generated,
        options.scenario,
        options.seconds,
        folder,
    )
    outcome = run_model(request)
    if outcome is None or not outcome.passed:
        return WRONG
    return NOT_JUDGED if options.strict and outcome.not_judged else OK


def _simulate(options: argparse.Namespace) -> int:
    checked = _checked(options, deadlines=False)
    trace = simulate.simulated(
        checked, options.events, interpreter=options.interpreter, as_json=options.json
    )
    left_out = simulate.left_out(checked.system) if options.interpreter else None
    if left_out is not None:
        print(render(left_out, {}), file=sys.stderr)
    print(trace, end="")
    return OK


def _draw(options: argparse.Namespace) -> int:
    if options.from_ada is not None:
        drawings = draw.texts_of_ada(options.from_ada, options.format)
    else:
        drawings = draw.texts(_checked(options, deadlines=False).system, options.format)
    folder = options.out or (options.from_ada or options.model).parent / "drawings"
    draw.write(drawings, folder)
    print(f"{folder}: {len(drawings)} drawings")
    return OK


def _loopback(options: argparse.Namespace) -> int:
    return OK if loopback.tested(options) else WRONG


def _bus(options: argparse.Namespace) -> int:
    return bus.serve(bus.words(options))


def _import_dbc(options: argparse.Namespace) -> int:
    given = import_database.periods(options.period, options.periods)
    found = import_database.imported(options.database, options.node, given, lenient=options.lenient)
    print(found.text, end="")
    for problem in found.problems:
        print(problem, file=sys.stderr)
    return WRONG if found.problems else OK
