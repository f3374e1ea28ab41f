"""One run of a controller: started, put through a scenario, judged, reported."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console

from analysis.observed import Observation, TraceError, TraceMap, read_map, read_trace
from analysis.plots import svg
from analysis.report import RunReport, compare, executions, render
from analysis.timing import Analysis
from gen.terms import Ns
from hw_can.bench.peer import BenchError, Codec, Peer
from hw_can.bench.runner import ScenarioResult, run_scenario
from hw_can.bench.scenario import Scenario, ScenarioError, load_scenario

from .demo import judge, plots, result, summary
from .demo.process import ControllerProcess, Ended, StartError, separate_cores
from .demo.result import RunResult

DEFAULT_GRACE = 1.0
"""Grace of a controller whose model is not at hand, in s."""

Progress = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class RunRequest:
    """A built model to run: ``generated`` holds its trace map and DBC.

    Without a scenario the controller runs on its own for ``seconds``. The report
    goes to ``folder``.
    """

    analysis: Analysis
    executable: Path
    generated: Path
    scenario: Path | None
    seconds: float
    folder: Path


def run_model(request: RunRequest, console: Console | None = None) -> bool:
    """Run, print the summary and write the report; whether the verdict is PASS."""
    out = console or summary.terminal()
    trace_json = request.generated / "trace.json"
    try:
        with out.status("start the controller") as status:
            if request.scenario is None:
                outcome = run_alone(
                    request.executable,
                    trace_json,
                    request.seconds,
                    request.folder,
                    analysis=request.analysis,
                )
            else:
                outcome = run_controller(
                    request.executable,
                    trace_json,
                    _dbc(request),
                    request.scenario,
                    None,
                    request.folder,
                    lambda text: status.update(text),
                    analysis=request.analysis,
                )
    except (ScenarioError, BenchError, TraceError) as fault:
        out.print(str(fault), markup=False)
        return False
    written = write_report(outcome, request.analysis, request.folder)
    out.print(outcome.title, markup=False)
    print_summary(outcome, out)
    for path in written:
        out.print(f"report: {path}", markup=False, soft_wrap=True)
    summary.print_verdict(out, outcome.failures)
    return outcome.passed


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
) -> RunResult:
    """Run ``executable`` through ``scenario``, for at most ``duration`` seconds.

    The controller gets one core for itself where there are two; its trace stays in
    ``out_dir``. With ``analysis`` what was seen is held against the bounds. Raises
    ScenarioError, BenchError and TraceError for inputs that cannot be used, before
    anything runs; whatever goes wrong later is a failure in the result.
    """
    plan = load_scenario(scenario)
    codec = Codec.from_file(dbc)

    def play(process: ControllerProcess, grace: float) -> ScenarioResult:
        peer = Peer.connect(process.wait_for_port(), codec)
        return run_scenario(
            plan,
            peer,
            limit=duration,
            progress=progress,
            ended=lambda: process.ask_to_end(grace),
        )

    return _run(executable, trace_json, out_dir, plan.title, plan, play, analysis)


def run_alone(
    executable: Path,
    trace_json: Path,
    seconds: float,
    out_dir: Path,
    *,
    analysis: Analysis | None = None,
) -> RunResult:
    """Run ``executable`` for that long with nobody on its bus."""

    def play(process: ControllerProcess, grace: float) -> None:
        if not process.runs_for(seconds):
            raise StartError(f"the controller ended by itself within {seconds:g} s")

    title = f"{seconds:g} s without a scenario"
    return _run(executable, trace_json, out_dir, title, None, play, analysis)


def write_report(outcome: RunResult, analysis: Analysis, out_dir: Path) -> tuple[Path, ...]:
    """Write report.html, and positions.png after a scenario, into ``out_dir``; what it wrote."""
    out_dir.mkdir(parents=True, exist_ok=True)
    written: list[Path] = []
    pictures: list[tuple[str, str]] = []
    played = outcome.scenario_result
    if played is not None:
        figure = plots.positions(played.tracks, result.spans(outcome), result.marks(played))
        picture = out_dir / "positions.png"
        picture.write_bytes(plots.png(figure))
        written.append(picture)
        caption = "Target and true position of each axis, its states in the band above."
        pictures.append((caption, svg(figure)))
    run = RunReport(
        title=outcome.title,
        passed=outcome.passed,
        verdict="; ".join(outcome.failures) or "nothing failed",
        notes=outcome.notes,
        steps=outcome.steps,
        frames=tuple(result.frames(outcome)),
        comparable=outcome.ended.real_time,
        observation=outcome.observation,
        pictures=tuple(pictures),
    )
    page = out_dir / "report.html"
    page.write_text(render(analysis, run), encoding="utf-8")
    return (page, *written)


def print_summary(outcome: RunResult, console: Console | None = None) -> None:
    """Print what the run showed, 80 columns wide, without the verdict."""
    out = console or summary.terminal()
    if outcome.steps:
        summary.print_steps(out, outcome.steps)
    if outcome.observation is not None:
        summary.print_states(out, outcome.observation.states_visited())
    frames = list(result.frames(outcome))
    if frames:
        summary.print_frames(out, frames)
    if outcome.compared:
        summary.print_comparison(out, outcome.compared, comparable=outcome.ended.real_time)
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
) -> RunResult:
    """Start the controller, ``play``, stop it, and put everything together."""
    trace_map = read_map(_text(trace_json), trace_json.name)
    out_dir.mkdir(parents=True, exist_ok=True)
    trace = (out_dir / "trace.txt").absolute()
    trace.unlink(missing_ok=True)
    grace = analysis.system.shutdown.grace / 1e9 if analysis else DEFAULT_GRACE
    problems: list[str] = []
    played: ScenarioResult | None = None
    ended = Ended(0, False, False, ())
    with separate_cores() as core:
        try:
            process = ControllerProcess(executable, trace, core)
        except StartError as fault:
            problems.append(str(fault))
        else:
            try:
                played = play(process, grace)
            except (StartError, BenchError) as fault:
                problems.append(str(fault))
            finally:
                ended = process.stop(grace)
    seen = None if problems else _read(trace, trace_map, problems)
    if seen is not None:
        seen.stolen = Ns(ended.stolen)
    compared = compare(analysis, seen) if analysis and seen else ()
    executed = executions(analysis, seen) if analysis and seen else ()
    checks = judge.check_trace(plan.trace_checks, seen) if plan and seen else ()
    return RunResult(
        title=title,
        scenario=plan,
        scenario_result=played,
        observation=seen,
        ended=ended,
        steps=judge.step_rows(played, checks) if played else (),
        compared=compared,
        failures=(*problems, *judge.failures(ended, played, seen, checks, compared)),
        notes=tuple(result.notes(ended, played, seen, executed, compared)),
        clock_offset=result.clock_offset(played, seen, analysis.system) if analysis else None,
    )


def _read(trace: Path, trace_map: TraceMap, problems: list[str]) -> Observation | None:
    """The trace, or one more problem."""
    try:
        with trace.open(encoding="ascii", errors="replace") as lines:
            return read_trace(lines, trace_map, trace.name)
    except OSError as fault:
        problems.append(f"the controller wrote no trace: {fault.strerror}")
    except TraceError as fault:
        problems.append(str(fault))
    return None


def _dbc(request: RunRequest) -> Path:
    """The DBC of the model's bus; BenchError when it has none."""
    for bus in request.analysis.system.buses:
        return request.generated / f"{bus.name.lower()}.dbc"
    raise BenchError(f"{request.analysis.system.name} has no bus for a scenario to play on")


def _text(path: Path) -> str:
    """The text of an input file; TraceError when it cannot be read."""
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as fault:
        raise TraceError(f"{path}: error: cannot be read: {fault}") from None
