# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A model under change: its states, how to go back, and the files on the disk.

Nothing is written before `save`. The files are compared with the disk at every look: what has
changed there is taken over where nothing was changed here, else it is shown and left to people.
"""

from __future__ import annotations

import difflib
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from ravenchart.allocation.proposals import WantedTable
from ravenchart.building import checking
from ravenchart.editing.edits import LayoutError
from ravenchart.editing.evaluation import Evaluation, Texts, evaluate, over
from ravenchart.editing.tables import rearranged
from ravenchart.failures import Refused
from ravenchart.gen.diagnostics import Diagnostic
from ravenchart.gen.files.load import LARGEST, read_file
from ravenchart.reported import found_of

from . import changes
from .changes import ChangeRefusedError
from .requests import Move, SetProcessor, SetTime

MOST_STATES = 1_000
"""Changes that can be undone."""

Bounds = Mapping[str, int | None]
"""The response of each row, in ns."""

Stamp = tuple[int, int, int] | None
"""Inode, size and time of a file; None of one that is not there."""


class InvalidError(ChangeRefusedError):
    """The files cannot be saved for what is wrong in them, which is with ``found``."""

    def __init__(self, text: str, found: Sequence[Diagnostic], *, late: bool) -> None:
        super().__init__(text)
        self.found = tuple(found)
        self.late = late
        """Only deadlines or limits are not kept: people may save that."""

    def more(self) -> dict[str, Any]:
        """The findings, and whether people may save all the same."""
        return {"findings": [asdict(found_of(one)) for one in self.found], "late": self.late}


@dataclass(frozen=True, slots=True)
class SessionState:
    """The files after a change, and what the change was."""

    texts: Texts
    label: str


@dataclass(slots=True)
class _Disk:
    """The files as they were last seen on the disk and taken over or written."""

    texts: dict[str, bytes]
    stamps: dict[str, Stamp] = field(default_factory=dict)
    """Of the last look."""
    pending: dict[str, Stamp] = field(default_factory=dict)
    """Of the look before, where a file may still be written to."""
    outside: dict[str, bytes] = field(default_factory=dict)
    """The text of files that have changed outside and are not taken over; b"" of one gone."""


class Session:
    """A model that is changed; one thread at a time may call it."""

    def __init__(self, path: Path) -> None:
        """That of the model at ``path``; Refused, as by `check`, where it has errors."""
        checking.check(path, deadlines=False)
        self.path = path
        self.number = 0
        """Of the state that is shown: counts everything that people can see change."""
        self.now = self.good = self.saved = evaluate(path, {})
        """The state, the last one without errors, and that of the disk."""
        self._states = [SessionState(self.now.texts, "")]
        self._at = 0
        self._disk = _Disk(dict(self.now.texts))
        self._disk.stamps = {name: _stamp(name) for name in self._disk.texts}

    # --- What there is

    @property
    def dirty(self) -> bool:
        """The files here are not those on the disk."""
        return self.now.texts != self._disk.texts

    @property
    def saved_digest(self) -> str | None:
        """The digest of the saved model; None where it has errors. Any thread may ask."""
        analysis = self.saved.analysis  # read once: another thread may save meanwhile
        return None if analysis is None else analysis.system.digest

    @property
    def outside(self) -> tuple[str, ...]:
        """Files that have changed outside while there were changes here."""
        return tuple(self._disk.outside)

    @property
    def undo_label(self) -> str | None:
        """The change that `undo` takes back; None where there is none."""
        return self._states[self._at].label if self._at else None

    @property
    def redo_label(self) -> str | None:
        """The change that `redo` makes again."""
        return self._states[self._at + 1].label if self._at + 1 < len(self._states) else None

    def diff(self) -> str:
        """The changes that `save` would make, as a unified diff."""
        return "".join(
            line
            for name, new in self.now.texts.items()
            for line in _diff(name, self._disk.texts.get(name, b""), new)
        )

    # --- Changes

    def change(self, wish: Move | SetTime | SetProcessor) -> bool:
        """Make a change, and analyse it; False where it changes nothing."""
        made = changes.changed(self.now, wish)
        if made.texts == self.now.texts:
            return False
        self._take(SessionState(made.texts, made.label))
        return True

    def adopt(self, tables: Sequence[WantedTable], bounds: Bounds, label: str) -> None:
        """Make these tables a change, which must have the bounds that were found for them."""
        try:
            made = evaluate(self.path, rearranged(self.path, self.now, tables))
        except LayoutError as problem:
            raise ChangeRefusedError(str(problem)) from problem
        analysis = made.analysis
        if analysis is None or {row.row.name: row.bound for _, row in analysis.rows()} != bounds:
            raise ChangeRefusedError(
                "the text of the model does not allow these tables: "
                "`ravenchart allocate --yaml` prints what to write"
            )
        self._take(SessionState(made.texts, label), made)

    def step(self, by: int) -> bool:
        """Go back (-1) or forward (1) by one change; False where there is none."""
        if not 0 <= self._at + by < len(self._states):
            return False
        self._at += by
        self._show(self._states[self._at].texts)
        return True

    # --- The disk

    def look(self) -> bool:
        """Look whether files have changed outside; True where there is something to show.

        A file that may still be written to is looked at again the next time.
        """
        disk, fresh = self._disk, {}
        for name in disk.texts:
            stamp = _stamp(name)
            if stamp == disk.stamps.get(name):
                disk.pending.pop(name, None)
            elif disk.pending.get(name, ()) != stamp:
                disk.pending[name] = stamp
            else:
                del disk.pending[name]
                disk.stamps[name] = stamp
                fresh[name] = _read(name)
        if not fresh:
            return False
        before = dict(disk.outside)
        for name, found in fresh.items():
            if found == disk.texts[name]:
                disk.outside.pop(name, None)
            else:
                disk.outside[name] = found
        if disk.outside == before:
            return False
        if disk.outside and not self.dirty:
            self.take()
        else:
            self.number += 1
        return True

    def take(self) -> None:
        """Take the files over as they are on the disk; the changes here can be had by `undo`."""
        if not self._disk.outside:
            return
        names = ", ".join(self._disk.outside)
        stamps = {name: _stamp(name) for name in self._disk.texts}
        fresh = evaluate(self.path, {})
        stamps |= {name: _stamp(name) for name in fresh.texts if name not in stamps}
        self._disk = _Disk(dict(fresh.texts), stamps)
        self._take(SessionState(fresh.texts, f"changed outside: {names}"), fresh)
        self.saved = fresh if fresh.analysis is not None else self.saved

    def keep(self) -> None:
        """Keep the changes here: the diff then shows what `save` takes back of the others'."""
        if not self._disk.outside:
            return
        self._disk.texts |= self._disk.outside
        self._disk.outside = {}
        self._see_disk()
        self.number += 1

    def save(self, *, late: bool) -> tuple[str, ...]:
        """Write the files that have changed; their names. `InvalidError` for wrong ones.

        A file that has changed outside is not overwritten. Where that is seen before the first
        file is written, nothing is written (`ChangeRefusedError`).
        """
        self._see_outside()
        self._judge(late=late)
        self._see_outside()  # the rules of behaviour may have taken seconds
        disk = self._disk
        written: list[str] = []
        for name, content in self.now.texts.items():
            if disk.texts.get(name) == content:
                continue
            try:
                found = _replace(Path(name), content, disk.texts.get(name, b""))
            except OSError as problem:
                reason = problem.strerror or str(problem)
                raise self._stopped(f"cannot write {name}: {reason}", written) from problem
            if found is not None:
                disk.outside[name] = found
                raise self._stopped(f"changed on the disk: {name}", written)
            disk.texts[name], disk.stamps[name] = content, _stamp(name)
            written.append(name)
        if written:
            self.saved = self.now
            self.number += 1
        return tuple(written)

    def _stopped(self, reason: str, written: Sequence[str]) -> ChangeRefusedError:
        """Why a save ended before its last file, and which files were written before."""
        self.number += 1
        if not written:
            return ChangeRefusedError(f"nothing was saved: {reason}")
        self._see_disk()
        return ChangeRefusedError(f"{reason}; written before that: {', '.join(written)}")

    def _judge(self, *, late: bool) -> None:
        """`InvalidError` where `check` would refuse the files for more than people allow."""
        if self.now.analysis is None:
            found = self.now.found
            raise InvalidError("the model has errors, so nothing was saved", found, late=False)
        try:
            checking.check(self.path, deadlines=False, read=over(self.now.texts))
        except Refused as problem:
            found = tuple(one for one in problem.found if isinstance(one, Diagnostic))
            text = "the model has errors, so nothing was saved"
            raise InvalidError(text, found, late=False) from problem
        missed = [one for one in self.now.late if one.is_error]
        if missed and not late:
            text = "a deadline or limit is not kept, so nothing was saved"
            raise InvalidError(text, missed, late=True)

    def _see_outside(self) -> None:
        """`ChangeRefusedError` where a file on the disk is not what it was."""
        for name, known in self._disk.texts.items():
            found = _read(name)
            if found != known:
                self._disk.outside[name] = found
        if self._disk.outside:
            self.number += 1
            names = ", ".join(self._disk.outside)
            raise ChangeRefusedError(f"nothing was saved: changed on the disk: {names}")

    def _see_disk(self) -> None:
        """Analyse what is on the disk now."""
        found = evaluate(self.path, self._disk.texts)
        self.saved = found if found.analysis is not None else self.saved

    # --- States

    def _take(self, state: SessionState, found: Evaluation | None = None) -> None:
        """Go on to a new state; those that were taken back are forgotten."""
        self._states[self._at + 1 :] = [state]
        del self._states[: -MOST_STATES - 1]
        self._at = len(self._states) - 1
        self._show(state.texts, found)

    def _show(self, texts: Texts, found: Evaluation | None = None) -> None:
        self.now = found or evaluate(self.path, texts)
        if self.now.analysis is not None:
            self.good = self.now
        self.number += 1


def _diff(name: str, old: bytes, new: bytes) -> Iterator[str]:
    """The lines of a unified diff; a last line without line break is marked as `diff` does."""
    before, after = (one.decode("utf-8", "replace").splitlines(keepends=True) for one in (old, new))
    for line in difflib.unified_diff(before, after, name, f"{name} (workbench)"):
        yield line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n"


def _read(name: str) -> bytes:
    """The content of a file; empty where it cannot be read."""
    try:
        return read_file(Path(name), LARGEST + 1)
    except (OSError, ValueError):
        return b""


def _stamp(name: str) -> Stamp:
    try:
        found = os.stat(name)
    except (OSError, ValueError):
        return None
    return found.st_ino, found.st_size, found.st_mtime_ns


def _replace(path: Path, content: bytes, known: bytes) -> bytes | None:
    """Put the content at ``path`` in one step, with the rights that the file had.

    A file that is neither ``known`` nor the content stays as it is: what is in it is returned.
    """
    real = path.resolve()
    mode = real.stat().st_mode if real.exists() else 0o644
    beside = real.with_name(f".{real.name}.{os.getpid()}")
    try:
        with beside.open("wb") as file:
            os.fchmod(file.fileno(), mode & 0o7777)
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        if (found := _read(str(real))) not in (known, content):
            return found
        beside.replace(real)
        return None
    finally:
        with suppress(OSError):
            beside.unlink()
