# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`check --watch`: a real process that sees its files change."""

from __future__ import annotations

import os
import queue
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from ravenchart.gen.explanations import MODEL, explanations
from tests.support.processes import ROOT

pytestmark = [pytest.mark.clock, pytest.mark.slow]

PATIENCE = 60.0
"""Seconds for a check on a busy machine."""

PASSED = re.compile(r"Infusion_System: .*every deadline is met \((\d) files? watched\)")
FAILED = re.compile(r"FAILED: (\d+) errors?.* \(\d files? watched\)")


class Watch:
    """The process, and its lines as they come; standard error is among them."""

    def __init__(self, model: Path) -> None:
        words = [sys.executable, "-P", "-m", "ravenchart.start", "check", str(model), "--watch"]
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        self.process = subprocess.Popen(
            words, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        self._lines: queue.Queue[str] = queue.Queue()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self._lines.put(line.rstrip("\n"))

    def run(self) -> list[str]:
        """The lines of one check, verdict last."""
        lines: list[str] = []
        while not lines or not lines[-1].endswith("watched)"):
            lines.append(self._lines.get(timeout=PATIENCE))
        return [line for line in lines if line]

    def is_quiet(self, seconds: float) -> bool:
        """Whether nothing is printed for that long."""
        time.sleep(seconds)
        return self._lines.empty()

    def end(self, number: int) -> tuple[int, list[str]]:
        """Ask it to end; its exit status and its last lines."""
        self.process.send_signal(number)
        status = self.process.wait(PATIENCE)
        time.sleep(0.2)
        return status, [self._lines.get_nowait() for _ in range(self._lines.qsize())]


@pytest.fixture
def model(tmp_path: Path) -> Path:
    """A model of two files."""
    text = (ROOT / "examples" / "pump" / "model.yaml").read_text(encoding="utf-8")
    head, _, components = text.partition("\ncomponents:")
    types, _, rest = components.partition("\ninstances:")
    (tmp_path / "parts.yaml").write_text(f"components:{types}\n", encoding="utf-8")
    path = tmp_path / "model.yaml"
    path.write_text(f"{head}\ninclude: [parts.yaml]\ninstances:{rest}", encoding="utf-8")
    return path


@pytest.fixture
def watch(model: Path) -> Iterator[Watch]:
    made = Watch(model)
    yield made
    if made.process.poll() is None:
        made.process.kill()
        made.process.wait()


def test_each_change_is_a_run_of_its_own_and_ctrl_c_ends_it(watch: Watch, model: Path) -> None:
    first = watch.run()
    assert re.fullmatch(rf"--- \d\d:\d\d:\d\d check {re.escape(str(model))} ---", first[0])
    passed = PASSED.fullmatch(first[-1])
    assert passed and passed[1] == "2"
    assert watch.is_quiet(1.0)
    good = model.read_text()
    model.write_text(good + "\t: [\n")  # broken YAML
    lines = watch.run()
    assert lines[0].startswith("--- ") and FAILED.fullmatch(lines[-1])
    assert any("error:" in line and "RV-01" in line for line in lines)
    model.write_text(good)
    assert PASSED.fullmatch(watch.run()[-1])
    status, last = watch.end(signal.SIGINT)
    assert (status, last) == (130, ["ravenchart: interrupted"])


def test_a_file_that_is_included_counts_also_when_it_is_replaced(watch: Watch, model: Path) -> None:
    assert PASSED.fullmatch(watch.run()[-1])
    part = model.with_name("parts.yaml")
    good = part.read_text()
    for text, seen in ((good + "nonsense: 1\n", FAILED), (good, PASSED)):
        beside = part.with_name(".parts.yaml.swp")
        beside.write_text(text)
        beside.replace(part)
        assert seen.fullmatch(watch.run()[-1])


def test_a_file_that_vanishes_for_a_moment_is_no_error_and_one_that_stays_away_is(
    watch: Watch, model: Path
) -> None:
    assert PASSED.fullmatch(watch.run()[-1])
    part = model.with_name("parts.yaml")
    text = part.read_text()
    part.unlink()
    time.sleep(0.3)
    part.write_text(text)
    assert PASSED.fullmatch(watch.run()[-1])
    part.unlink()
    lines = watch.run()
    assert FAILED.fullmatch(lines[-1]) and any("RV-0101" in line for line in lines)
    part.write_text(text)
    assert PASSED.fullmatch(watch.run()[-1])


def test_a_model_that_is_not_there_yet_is_waited_for(tmp_path: Path) -> None:
    path = tmp_path / "model.yaml"
    watch = Watch(path)
    try:
        assert FAILED.fullmatch(watch.run()[-1])
        path.write_text(explanations()["RV-0305"].corrected.files[MODEL])
        assert watch.run()[-1].endswith("every deadline is met (1 file watched)")
        assert watch.end(signal.SIGTERM)[0] == 143
    finally:
        watch.process.kill()
