# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The program of a checked model, written beside it."""

from __future__ import annotations

import hashlib
import os
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from ravenchart.analysis.findings.claims import Unclaimed, claims_of, uncertified
from ravenchart.failures import Refused
from ravenchart.gen.diagnostics import in_order, render, render_all
from ravenchart.gen.emit.clashes import clashes
from ravenchart.gen.emit.program import (
    first_versions,
    generate,
    library_files,
    user_units,
)
from ravenchart.gen.model.claims import Claims
from ravenchart.gen.rules.folding import folded
from ravenchart.gen.rules.unready import unready

from .checking import Checked
from .garbage import without_collector
from .written import EDITED, MANIFEST, Written
from .written import listed as listed_in


def without_clashes(checked: Checked) -> None:
    """Refused where names would clash in the generated program."""
    clashing = folded(clashes(checked.system), checked.system.instances)
    found = in_order(clashing, checked.sources)
    if found:
        raise Refused(render_all(found, checked.sources), found)


def claims(checked: Checked) -> Claims:
    """The values that the program's certificate states, in ns; Refused if one cannot be shown."""
    gaps = tuple(uncertified(checked.analysis))
    if gaps:
        raise Refused("\n".join(render(gap, {}) for gap in gaps), gaps)
    try:
        return claims_of(checked.analysis)
    except Unclaimed as problem:
        raise Refused(f"{checked.path}: error: {problem}: leave some of its time unused") from None


@without_collector()
def write_program(checked: Checked) -> Written:
    """Write generated/ beside the model; user/ is never touched.

    Files are replaced only when their bytes differ, so that builds stay
    incremental; files of the last generation that are no longer made go. `Refused` for
    what can be analysed only. The libraries that the model uses are written before it, each
    beside its own main file.
    """
    libraries = [_written(one) for one in checked.libraries]
    return _joined(_written(checked), libraries)


def _joined(own: Written, libraries: Sequence[Written]) -> Written:
    """The result for a system, with what was found of the libraries that it uses."""
    if not libraries:
        return own
    user = dict(own.user)
    for one in libraries:
        made = {one.folder / name: digest for name, digest in listed_in(one.folder).items()}
        user |= {one.folder / MANIFEST: one.manifest, **made, **one.user}
    return replace(
        own,
        changed=own.changed + sum(one.changed for one in libraries),
        files=own.files + sum(one.files for one in libraries),
        edited=(
            *own.edited,
            *(os.path.relpath(x.folder / name, own.folder) for x in libraries for name in x.edited),
        ),
        first=(*(path for one in libraries for path in one.first), *own.first),
        untouched=(*(path for one in libraries for path in one.untouched), *own.untouched),
        user=user,
    )


def _written(checked: Checked) -> Written:
    gaps = tuple(unready(checked.system))
    if gaps:
        raise Refused("\n".join(render(gap, {}) for gap in gaps), gaps)
    without_clashes(checked)
    folder = checked.generated
    folder.mkdir(parents=True, exist_ok=True)
    files = texts_of(checked)
    old = listed_in(folder)
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
    user = {name: _digest((checked.folder / name).read_bytes()) for name in texts}
    units = user_units(checked.system)
    untouched = tuple(n for n in units if user[n] == _digest(texts[n].encode("utf-8")))
    return Written(
        folder,
        len(files),
        changed,
        edited,
        first,
        tuple(checked.folder / name for name in untouched),
        _digest(listed.encode("utf-8")),
        {checked.folder / name: digest for name, digest in user.items()},
    )


def texts_of(checked: Checked) -> dict[str, str]:
    """File name to text of all that is generated of a model or a library, in memory."""
    if checked.system.is_library:
        return library_files(checked.system)
    return generate(checked.system, claims(checked))


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
    models = (*checked.libraries, checked)
    return tuple(
        path for one in models for path in _write_absent(one.folder, first_versions(one.system))
    )


def _write_absent(folder: Path, texts: Mapping[str, str]) -> tuple[Path, ...]:
    """Write the texts whose files are not there; the files that were written."""
    absent = [(folder / name, text) for name, text in texts.items() if not (folder / name).exists()]
    for path, text in absent:
        path.parent.mkdir(parents=True, exist_ok=True)
        replace_file(path, text)
    return tuple(path for path, _ in absent)


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
