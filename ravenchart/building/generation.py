"""The program of a checked model, written beside it."""

from __future__ import annotations

import hashlib
import os
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from ravenchart.analysis.findings.claims import Unclaimed, claims_of, uncertified
from ravenchart.failures import Refused
from ravenchart.gen.diagnostics import in_order, render, render_all
from ravenchart.gen.emit.clashes import clashes
from ravenchart.gen.emit.program import (
    first_versions,
    generate,
    user_units,
)
from ravenchart.gen.model.claims import Claims
from ravenchart.gen.rules.unready import unready

from .checking import Checked, without_collector

MANIFEST = "generated.list"
"""SHA-256 and name of each file of the last generation, as `sha256sum` prints them.

Only these files are ever deleted, and an edit of one of them is noticed.
"""


EDITED = ".edited"
"""Ending of the copy that is kept of an edited file."""


def without_clashes(checked: Checked) -> None:
    """Refused where names would clash in the generated program."""
    found = in_order(clashes(checked.system), checked.sources)
    if found:
        raise Refused(render_all(found, checked.sources), found)


def claims(checked: Checked) -> Claims:
    """What the program's certificate claims, in ns. Refused when something cannot be shown."""
    gaps = tuple(uncertified(checked.analysis))
    if gaps:
        raise Refused("\n".join(render(gap, {}) for gap in gaps), gaps)
    try:
        return claims_of(checked.analysis)
    except Unclaimed as problem:
        raise Refused(f"{checked.path}: error: {problem}: leave some of its time unused") from None


@dataclass(frozen=True, slots=True)
class Written:
    """What a generation did.

    ``files`` were generated, the manifest not counted; of these ``changed`` have other bytes
    than before. ``edited`` had been changed by hand: their copies lie beside them.
    ``first`` are units of the user that were not there and got a first version; ``untouched``
    are those that are still as first written, and do nothing.
    """

    folder: Path
    files: int
    changed: int
    edited: tuple[str, ...]
    first: tuple[Path, ...]
    untouched: tuple[Path, ...]


@without_collector()
def write_program(checked: Checked) -> Written:
    """Write generated/ beside the model; user/ is never touched.

    Files are replaced only when their bytes differ, so that builds stay
    incremental; files of the last generation that are no longer made go. `Refused` for
    what can be analysed only.
    """
    gaps = tuple(unready(checked.system))
    if gaps:
        raise Refused("\n".join(render(gap, {}) for gap in gaps), gaps)
    without_clashes(checked)
    folder = checked.generated
    folder.mkdir(parents=True, exist_ok=True)
    files = generate(checked.system, claims(checked))
    old = _manifest(folder)
    edited = tuple(n for n, digest in old.items() if _edited(folder / n, digest, files.get(n)))
    for name in edited:
        (folder / name).replace(folder / f"{name}{EDITED}")
    changed = 0
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        changed += replace_file(folder / name, text)
    digests = {name: _digest(text.encode("utf-8")) for name, text in sorted(files.items())}
    listed = "".join(f"{digest}  {name}\n" for name, digest in digests.items())
    replace_file(folder / MANIFEST, listed)
    for gone in {name for name in old if name not in files}:
        (folder / gone).unlink(missing_ok=True)
        if (folder / gone).parent != folder:
            with suppress(OSError):  # it is not empty, or was never there
                (folder / gone).parent.rmdir()
    texts = first_versions(checked.system)
    first = _write_absent(checked.folder, texts)
    return Written(folder, len(files), changed, edited, first, _untouched(checked, texts))


def _manifest(folder: Path) -> dict[str, str]:
    """Name to SHA-256 of each file of the last generation; "" where the list has no digest."""
    if not (folder / MANIFEST).is_file():
        return {}
    lines = (folder / MANIFEST).read_text(encoding="utf-8").splitlines()
    pairs = (line.rpartition("  ")[::2] for line in lines)
    return {name: digest for digest, name in pairs if _is_inside(name)}


def _edited(path: Path, digest: str, text: str | None) -> bool:
    """Whether the file is neither what was generated last time nor ``text``, the new one.

    A generation that was cut short leaves files that are new already.
    """
    if not digest or not path.is_file():
        return False
    found = path.read_bytes()
    return _digest(found) != digest and (text is None or found != text.encode("utf-8"))


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def write_first_versions(checked: Checked) -> tuple[Path, ...]:
    """Write what is the user's and not there yet; the files that were written."""
    return _write_absent(checked.folder, first_versions(checked.system))


def _write_absent(folder: Path, texts: Mapping[str, str]) -> tuple[Path, ...]:
    """Write the texts whose files are not there; the files that were written."""
    absent = [(folder / name, text) for name, text in texts.items() if not (folder / name).exists()]
    for path, text in absent:
        path.parent.mkdir(parents=True, exist_ok=True)
        replace_file(path, text)
    return tuple(path for path, _ in absent)


def _untouched(checked: Checked, texts: Mapping[str, str]) -> tuple[Path, ...]:
    """The units of the user that still do nothing: they are as first written."""
    units = ((checked.folder / name, texts[name]) for name in user_units(checked.system))
    return tuple(unit for unit, text in units if unit.read_bytes() == text.encode("utf-8"))


def _is_inside(name: str) -> bool:
    """Whether a generated file can have that name: in generated/, or one or two folders below."""
    parts = Path(name).parts
    return len(parts) in (1, 2, 3) and ".." not in parts and not Path(name).is_absolute()


def replace_file(path: Path, text: str) -> bool:
    """Put ``text`` at ``path`` in one step; False when it stands there already.

    The compiler takes a source whose time is the same to the second for the one that it
    compiled. So the file gets the second before this one, or the one after that of the
    file it replaces: what is written later, by the user too, always has another.
    """
    data = text.encode("utf-8")
    stamp = int(time.time()) - 1
    if path.is_file():
        if path.read_bytes() == data:
            return False
        stamp = max(stamp, int(path.stat().st_mtime) + 1)
    beside = path.with_name(f".{path.name}.{os.getpid()}")
    beside.write_bytes(data)
    os.utime(beside, (stamp, stamp))
    beside.replace(path)
    return True
