# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""One run of a controller: started, put through a scenario, judged, reported."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console

from ravenchart import terminal
from ravenchart.analysis.present.plots import figure_svg
from ravenchart.analysis.present.report import RunReport, compare, executions, render_report
from ravenchart.analysis.system.journeys import journeys
from ravenchart.analysis.system.observed import (
    Observation,
    TraceError,
    TraceMap,
    merged,
    of_model,
    read_map,
    read_trace,
)
from ravenchart.analysis.system.timing import Analysis
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.system import System
from ravenchart.hw_can.bench.peer import BenchError, Codec, Peer
from ravenchart.hw_can.bench.runner import Progress, ScenarioResult, run_scenario
from ravenchart.hw_can.bench.scenario import Scenario, ScenarioError, load_scenario
from ravenchart.hw_can.bench.several import codec_of, joined_servers
from ravenchart.stacks.report import Memory

from . import bus_log, expected, judge, plots, result, snapshots, summary, value_plots
from .controllers import Controller, bus_servers, joining, joins_a_server
from .process import ControllerProcess, Ended, StartError, separate_cores
from .result import RunOutcome

DEFAULT_GRACE = 1.0
"""Grace of a controller without a model, in s."""


@dataclass(frozen=True, slots=True)
class RunRequest:
    """A built model to run: ``generated`` holds its DBC.

    Without a scenario the controllers run on their own for ``seconds``. The report
    goes to ``folder``, and what is on the bus to ``log``.
    """

    analysis: Analysis
    controllers: tuple[Controller, ...]
    generated: Path
    scenario: Path | None
    seconds: float
    folder: Path
    log: Path | None = None


def run_on_this_machine(request: RunRequest, progress: Progress) -> RunOutcome:
    """Run as processes of this machine. Raises as `run_controller`."""
    first = request.controllers[0]
    if joins_a_server(request.analysis.system, len(request.controllers)):
        return run_nodes(
            request.controllers,
            request.analysis,
            request.generated,
            request.scenario,
            request.seconds,
            request.folder,
            progress,
            log=request.log,
        )
    if request.scenario is None:
        return run_alone(
            first.executable,
            first.trace_json,
            request.seconds,
            request.folder,
            analysis=request.analysis,
        )
    return run_controller(
        first.executable,
        first.trace_json,
        dbc_of(request),
        request.scenario,
        None,
        request.folder,
        progress,
        analysis=request.analysis,
        log=request.log,
    )


def run_model(
    request: RunRequest,
    console: Console | None = None,
    refuse: Callable[[str], None] = lambda text: None,
    execute: Callable[[RunRequest, Progress], RunOutcome] = run_on_this_machine,
) -> RunOutcome | None:
    """Run, print the summary and write the report.

    None where nothing could be run: ``refuse`` gets the reason, which is printed too.
    """
    out = console or terminal.console()
    try:
        with terminal.progress("start the controller") as progress:
            outcome = execute(request, progress)
    except (ScenarioError, BenchError, TraceError) as fault:
        out.print(str(fault), markup=False, soft_wrap=True)
        refuse(str(fault))
        return None
    programs = {one.node: one.memory for one in request.controllers}
    with terminal.progress("write the report"):
        written = write_report(outcome, request.analysis, request.folder, programs)
    out.print(outcome.title, markup=False)
    print_summary(outcome, out)
    for path in written:
        out.print(f"report: {path}", markup=False, soft_wrap=True)
    summary.print_verdict(out, outcome.verdict, outcome.failures)
    return outcome


def run_controller(
    executable: Path,
    trace_json: Path,
    dbc: Path,
    scenario: Path,
    duration: float | None,
    out_dir: Path,
    progress: Progress = lambda text: None,
    *,
    analysis: Analysis | None = None,
    log: Path | None = None,
    watched: bool = True,
) -> RunOutcome:
    """Run ``executable`` through ``scenario``, for at most ``duration`` seconds.

    The controller gets one core for itself where there are two; its trace stays in
    ``out_dir``. With ``analysis`` the observation is compared with the bounds. Without
    ``watched`` the controller writes no snapshots. Raises ScenarioError, BenchError and
    TraceError for inputs that cannot be used, before anything runs; a later error is a
    failure in the result.
    """
    plan = load_scenario(scenario)
    if plan.bus_events:
        raise ScenarioError(f"{scenario.name}: error: `bus` is for a system with several nodes")
    codec = Codec.from_file(dbc)

    def play(process: ControllerProcess, grace: float) -> ScenarioResult:
        peer = Peer.connect(process.wait_for_port(), codec, record)
        return run_scenario(
            plan,
            peer,
            limit=duration,
            progress=progress,
            ended=lambda: process.ask_to_end(grace),
        )

    with bus_log.recorded(log, dbc.stem, executable) as record:
        title = plan.title
        return _run(executable, trace_json, out_dir, title, plan, play, analysis, watched=watched)


def run_alone(
    executable: Path,
    trace_json: Path,
    seconds: float,
    out_dir: Path,
    *,
    analysis: Analysis | None = None,
) -> RunOutcome:
    """Run ``executable`` for that long with no other node on its bus."""

    def play(process: ControllerProcess, grace: float) -> None:
        if not process.runs_for(seconds):
            raise StartError(f"the controller ended by itself within {seconds:g} s")

    title = f"{seconds:g} s without a scenario"
    return _run(executable, trace_json, out_dir, title, None, play, analysis)


def write_report(
    outcome: RunOutcome,
    analysis: Analysis,
    out_dir: Path,
    programs: Mapping[str, Memory | None] | None = None,
) -> tuple[Path, ...]:
    """Write report.html into ``out_dir``, and positions.png of drives; the paths of both.

    ``programs``: what `render` takes.
    """
    out_dir.mkdir(parents=True, exist_ok=True)
    written: list[Path] = []
    pictures: list[tuple[str, str]] = []
    played = outcome.scenario_result
    if played is not None and played.tracks:
        figure = plots.positions(played.tracks, result.spans(outcome), result.marks(played))
        picture = out_dir / "positions.png"
        picture.write_bytes(plots.png(figure))
        written.append(picture)
        caption = "Target and true position of each axis, its states in the band above."
        pictures.append((caption, figure_svg(figure)))
    if played is not None and any(track.values for track in played.plants.values()):
        caption = "Values that each plant gave to the controller."
        pictures.append((caption, figure_svg(plots.plant_values(played.plants))))
    pictures += value_plots.pictures(outcome.observation)
    run = RunReport(
        title=outcome.title,
        passed=outcome.passed,
        verdict="; ".join(outcome.failures) or _passed(outcome),
        notes=outcome.notes,
        steps=outcome.steps,
        frames=tuple(result.frames(outcome)),
        comparable=outcome.ended.real_time,
        journeys=outcome.journeys,
        observation=outcome.observation,
        pictures=tuple(pictures),
    )
    page = out_dir / "report.html"
    page.write_text(render_report(analysis, run, programs=programs), encoding="utf-8")
    return (page, *written)


def _passed(outcome: RunOutcome) -> str:
    """The text beside PASS."""
    return f"nothing failed; {outcome.gaps}" if outcome.gaps else "nothing failed"


def print_summary(outcome: RunOutcome, console: Console | None = None) -> None:
    """Print what the run showed, 80 columns wide, without the verdict."""
    out = console or terminal.console()
    if outcome.steps:
        summary.print_steps(out, outcome.steps)
    if outcome.observation is not None:
        summary.print_states(out, outcome.observation.states_visited())
    frames = list(result.frames(outcome))
    if frames:
        summary.print_frames(out, frames)
    if outcome.compared:
        summary.print_comparison(out, outcome.compared, comparable=outcome.ended.real_time)
    if outcome.journeys:
        summary.print_journeys(out, outcome.journeys)
    summary.print_positions(out, list(result.positions(outcome)))
    for note in outcome.notes:
        out.print(f"note: {note}", markup=False)


def _run(
    executable: Path,
    trace_json: Path,
    out_dir: Path,
    title: str,
    plan: Scenario | None,
    play: Callable[[ControllerProcess, float], ScenarioResult | None],
    analysis: Analysis | None,
    *,
    watched: bool = True,
) -> RunOutcome:
    """Start the controller, ``play``, stop it, and put everything together."""
    trace_map = read_map(_text(trace_json), trace_json.name)
    out_dir.mkdir(parents=True, exist_ok=True)
    trace = (out_dir / "trace.txt").absolute()
    trace.unlink(missing_ok=True)
    grace = analysis.system.shutdown.grace / 1e9 if analysis else DEFAULT_GRACE
    hidden = {} if watched else {snapshots.VARIABLE: None}
    problems: list[str] = []
    played: ScenarioResult | None = None
    ended = Ended(0, False, False, ())
    count = analysis.system.most_cores if analysis else 1
    with separate_cores(count) as cores:
        try:
            process = ControllerProcess(executable, trace, cores, **hidden)
        except StartError as fault:
            problems.append(str(fault))
        else:
            try:
                played = play(process, grace)
            except (StartError, BenchError) as fault:
                problems.append(str(fault))
            finally:
                ended = process.stop(grace)
    seen = None
    if not problems or (ended.reasons and trace.is_file()):
        seen = read(trace, trace_map, problems)
    return concluded(title, plan, played, seen, ended, problems, analysis)


def concluded(
    title: str,
    plan: Scenario | None,
    played: ScenarioResult | None,
    seen: Observation | None,
    ended: Ended,
    problems: list[str],
    analysis: Analysis | None,
    *,
    chains: bool = True,
) -> RunOutcome:
    """Everything that a run showed, put together and judged; ``chains`` where its bus took the
    time that frames take.
    """
    if seen is not None:
        seen.stolen = Ns(ended.stolen)
    disturbed = plan is not None and bool(plan.bus_events)
    took = journeys(analysis, seen) if analysis and seen and chains and not disturbed else ()
    compared = compare(analysis, seen) if analysis and seen else ()
    executed = executions(analysis, seen) if analysis and seen else ()
    checks = judge.check_trace(plan.trace_checks, seen) if plan and seen else ()
    system = analysis.system if analysis else None
    counted = expected.counted(seen, compared, executed, ended) if seen else {}
    unaccounted: tuple[str, ...] = ()
    if system and seen:
        real_time = ended.real_time
        unaccounted = tuple(judge.unaccounted(system, seen, compared, real_time=real_time))
    return RunOutcome(
        title=title,
        scenario=plan,
        scenario_result=played,
        observation=seen,
        ended=ended,
        steps=judge.step_rows(played, checks) if played else (),
        compared=compared,
        journeys=took,
        failures=(
            *judge.stops(ended),
            *problems,
            *unaccounted,
            *judge.failures(ended, played, seen, checks, compared, took),
            *expected.judged(plan, system, counted),
        ),
        notes=(
            *result.notes(ended, played, seen, executed, compared),
            *expected.told(plan, counted),
        ),
        clock_offset=result.clock_offset(played, seen, system) if system else None,
        not_judged=expected.not_judged(compared, executed, took, ended),
    )


def read(trace: Path, trace_map: TraceMap, problems: list[str]) -> Observation | None:
    """The trace, or one more problem."""
    try:
        with trace.open(encoding="ascii", errors="replace") as lines:
            seen = read_trace(lines, trace_map, trace.name)
        if seen.complete or seen.digest:
            of_model(seen, trace_map.digest, trace.name)
        return seen
    except OSError as fault:
        problems.append(f"the controller wrote no trace: {fault.strerror}")
    except TraceError as fault:
        problems.append(str(fault))
    return None


def codec_in(generated: Path, system: System) -> Codec:
    """That of the databases of the model's buses; BenchError when there is none."""
    if not system.buses:
        raise BenchError(f"{system.name} has no bus for a scenario to play on")
    files = {bus.name: generated / f"{bus.name.lower()}.dbc" for bus in system.buses}
    return codec_of({bus: Codec.from_file(path) for bus, path in files.items()})


def dbc_of(request: RunRequest) -> Path:
    """The DBC of the model's bus; BenchError when it has none."""
    for one in request.analysis.system.buses:
        return request.generated / f"{one.name.lower()}.dbc"
    raise BenchError(f"{request.analysis.system.name} has no bus for a scenario to play on")


def _text(path: Path) -> str:
    """The text of an input file; TraceError when it cannot be read."""
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as fault:
        raise TraceError(f"{path}: error: cannot be read: {fault}") from None


def run_nodes(
    controllers: Sequence[Controller],
    analysis: Analysis,
    generated: Path,
    scenario: Path | None,
    seconds: float,
    out_dir: Path,
    progress: Progress = lambda text: None,
    *,
    log: Path | None = None,
) -> RunOutcome:
    """Run the controllers of nodes on simulated buses, through ``scenario``.

    Without one they run for ``seconds``; ``generated`` has the databases. Raises as
    `run_controller`; ToolMissing and ToolFailed where the bus cannot be built.
    """
    plan = None if scenario is None else load_scenario(scenario)
    codec = codec_in(generated, analysis.system)
    maps = [read_map(_text(c.trace_json), c.trace_json.name) for c in controllers]
    out_dir.mkdir(parents=True, exist_ok=True)
    traces = [(out_dir / f"trace-{c.node}.txt").absolute() for c in controllers]
    for trace in traces:
        trace.unlink(missing_ok=True)
    grace = analysis.system.shutdown.grace / 1e9
    problems: list[str] = []
    played: ScenarioResult | None = None
    ended: list[Ended] = []
    cores = sorted(os.sched_getaffinity(0))
    with separate_cores(), bus_servers(analysis.system, controllers, plan, log) as channels:
        running: list[ControllerProcess] = []
        try:
            for process, joined in joining(analysis.system, controllers, traces, channels, cores):
                running.append(process)
                process.wait_until_joined(joined)
            if plan is None:
                early = next((p for p in running if not p.runs_for(seconds / len(running))), None)
                if early is not None:
                    raise StartError(f"a controller ended by itself within {seconds:g} s")
            else:
                peer = joined_servers(channels, codec)
                played = run_scenario(plan, peer, progress=progress)
        except (StartError, BenchError) as fault:
            problems.append(str(fault))
        finally:
            ended = [process.stop(grace) for process in running]
    seen: Observation | None = None
    stopped = any(one.reasons for one in ended) and all(trace.is_file() for trace in traces)
    if not problems or stopped:
        parts = [read(t, m, problems) for t, m in zip(traces, maps, strict=True)]
        if all(part is not None for part in parts):
            named = zip(controllers, parts, strict=True)
            seen = merged({c.node: part for c, part in named if part is not None})
    title = plan.title if plan else f"{seconds:g} s without a scenario"
    return concluded(title, plan, played, seen, all_ended(ended), problems, analysis)


def all_ended(ended: Sequence[Ended]) -> Ended:
    """How several controllers ended, as of one: the worst of each."""
    return Ended(
        exit_code=next((one.exit_code for one in ended if one.exit_code), 0),
        killed=any(one.killed for one in ended),
        real_time=all(one.real_time for one in ended),
        warnings=tuple(dict.fromkeys(line for one in ended for line in one.warnings)),
        stolen=max((one.stolen for one in ended), default=0),
    )
