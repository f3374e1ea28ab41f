# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A model under change: what is written, what is taken back, and what is never overwritten."""

from __future__ import annotations

import os
import shutil
import stat
from pathlib import Path

import pytest

from ravenchart.analysis.present.figures import figures
from ravenchart.building import checking
from ravenchart.failures import Refused
from ravenchart.paths import ROOT
from ravenchart.workbench.changes import ChangeRefusedError
from ravenchart.workbench.requests import Move, SetProcessor, SetTime
from ravenchart.workbench.session import InvalidError, Session

ROBOT = ROOT / "examples" / "cartesian_robot"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A copy of the robot's model, whose joint is in a file of its own."""
    for path in ROBOT.glob("*.yaml"):
        shutil.copy(path, tmp_path)
    joint = tmp_path / "joint.yaml"
    now = b"period: 10 ms\n        wcet: 150 us\n"
    text = joint.read_bytes()
    assert text.count(now) == 1
    joint.write_bytes(text.replace(now, b"period: 10 ms\n        wcet: 300 us\n"))
    return tmp_path


@pytest.fixture
def session(folder: Path) -> Session:
    """The robot under change."""
    return Session(folder / "model.yaml")


def time(session: Session, row: str, key: str, value: str | None) -> bool:
    """Change a time of a row."""
    return session.change(
        SetTime.model_validate(
            {"kind": "time", "row": row, "key": key, "value": value, "number": session.number}
        )
    )


def processor(session: Session, name: str, key: str, value: str | int | None) -> bool:
    """Change a processor."""
    wish = {"kind": "processor", "processor": name, "key": key, "value": value, "number": 0}
    return session.change(SetProcessor.model_validate(wish))


def move(session: Session, row: str, to: str, place: int) -> bool:
    """Move a row."""
    return session.change(Move(kind="move", row=row, to=to, place=place, number=session.number))


def settled(session: Session) -> bool:
    """Look at the disk until a change has been still for one look."""
    return session.look() or session.look()


def bound(session: Session, name: str) -> int | None:
    """The response-time bound of a processor now."""
    assert session.now.analysis is not None
    return session.now.analysis.response(name).bound


def test_a_time_is_changed_in_the_file_in_which_it_stands(session: Session, folder: Path) -> None:
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    old = bound(session, "control")
    assert time(session, "joint_y.position_control", "wcet", "400 us")
    assert bound(session, "control") != old
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before
    assert session.save(late=False) == (str(folder / "joint.yaml"),)
    after = {path.name: path.read_bytes() for path in folder.iterdir()}
    changed = [name for name in before if before[name] != after[name]]
    assert changed == ["joint.yaml"] and sorted(before) == sorted(after)
    lines = zip(before["joint.yaml"].splitlines(), after["joint.yaml"].splitlines(), strict=True)
    differing = [(old.strip(), new.strip()) for old, new in lines if old != new]
    assert differing == [(b"wcet: 300 us", b"wcet: 400 us")]


@pytest.mark.slow
@pytest.mark.parametrize("change", ["move", "wcet", "priority"])
def test_the_analysis_is_that_of_the_saved_files(session: Session, change: str) -> None:
    if change == "move":
        assert move(session, "joint_x.ports", "trajectory", 1)
    elif change == "wcet":
        assert time(session, "joint_x.Motion", "wcet", "900 us")
    else:
        assert processor(session, "control", "priority", 30)
    assert session.now.analysis is not None
    mine = figures(session.now.analysis)
    session.save(late=True)
    saved = checking.check(session.path, deadlines=False)
    assert figures(saved.analysis) == mine
    assert session.now.analysis.system.digest == saved.system.digest
    assert not session.dirty


@pytest.mark.slow
def test_undo_and_redo_go_through_all_states_to_the_byte(session: Session) -> None:
    texts = [dict(session.now.texts)]
    for number in range(5):
        assert time(session, "joint_x.position_control", "wcet", f"{300 + 10 * (number + 1)} us")
        texts.append(dict(session.now.texts))
    for known in reversed(texts[:-1]):
        assert session.step(-1)
        assert session.now.texts == known
    assert not session.step(-1)
    assert not session.dirty and session.undo_label is None
    assert session.redo_label == "wcet of Joint.position_control: 300 us to 310 us"
    for known in texts[1:]:
        assert session.step(1)
        assert session.now.texts == known
    assert not session.step(1)


def test_a_change_after_undo_forgets_what_was_taken_back(session: Session) -> None:
    time(session, "joint_x.position_control", "wcet", "310 us")
    session.step(-1)
    move(session, "joint_x.ports", "control", 1)
    assert session.redo_label is None
    assert session.undo_label == "joint_x.ports: place 1 of control to 2"


def test_what_changes_nothing_is_no_state(session: Session) -> None:
    number = session.number
    assert not time(session, "joint_x.position_control", "wcet", "300 us")
    assert not move(session, "joint_x.ports", "control", 0)
    assert session.number == number and session.undo_label is None


def test_a_deadline_is_missed_in_words_and_saved_only_when_people_say_so(
    session: Session, folder: Path
) -> None:
    before = (folder / "joint.yaml").read_bytes()
    time(session, "joint_x.position_control", "wcet", "4 ms")
    assert any(one.code in ("RV-0901", "RV-0902") for one in session.now.late)
    with pytest.raises(InvalidError) as refused:
        session.save(late=False)
    assert refused.value.late
    assert refused.value.found[0].origin.file == str(folder / "model.yaml")
    assert (folder / "joint.yaml").read_bytes() == before
    assert session.save(late=True) == (str(folder / "joint.yaml"),)


def test_a_model_with_errors_is_shown_with_its_locations_and_not_saved(
    session: Session, folder: Path
) -> None:
    before = (folder / "joint.yaml").read_bytes()
    time(session, "joint_x.position_control", "period", "15 ms")
    assert session.now.analysis is None and session.good.analysis is not None
    assert {one.code for one in session.now.found} == {"RV-0704"}
    for late in (False, True):
        with pytest.raises(InvalidError) as refused:
            session.save(late=late)
        assert not refused.value.late and refused.value.found == session.now.found
    assert (folder / "joint.yaml").read_bytes() == before
    assert time(session, "joint_x.position_control", "period", "10 ms")
    assert session.now.analysis is not None and not session.dirty


def test_a_processor_may_be_empty_for_a_while(session: Session) -> None:
    for row in ("joint_x", "joint_y", "joint_z"):
        assert move(session, f"{row}.trajectory_step", "control", 0)
    assert [one.code for one in session.now.found] == ["RV-0209"]
    assert move(session, "joint_z.trajectory_step", "trajectory", 0)
    assert session.now.analysis is not None


@pytest.mark.parametrize(
    ("value", "why"),
    [("5", "not a duration"), ("0 ms", "outside the range"), ("2 h", "not a duration"),
     ("7200 s", "outside the range"), ("1 ms, x: 1", "not a duration"), ("٣ ms", "not a duration")],
)  # fmt: skip
def test_a_wrong_duration_is_refused_with_the_reason(
    session: Session, value: str, why: str
) -> None:
    with pytest.raises(ChangeRefusedError, match=why):
        time(session, "joint_x.position_control", "wcet", value)
    assert not session.dirty


def test_what_is_not_in_the_model_is_refused(session: Session) -> None:
    with pytest.raises(ChangeRefusedError, match="no processor has the row"):
        move(session, "joint_q.ports", "control", 0)
    with pytest.raises(ChangeRefusedError, match="no processor named"):
        move(session, "joint_x.ports", "elsewhere", 0)
    with pytest.raises(ChangeRefusedError, match="does not declare"):
        time(session, "joint_x.nothing", "wcet", "1 ms")
    with pytest.raises(ChangeRefusedError, match="needs a wcet"):
        time(session, "joint_x.ports", "wcet", None)
    with pytest.raises(ChangeRefusedError, match="that of its processor"):
        time(session, "robot_bus.receive", "period", "1 ms")
    for wrong in (0, 31, "7", True):
        with pytest.raises((ChangeRefusedError, ValueError)):
            processor(session, "control", "priority", wrong)


def test_a_priority_is_given_and_follows_from_the_deadline_again(
    session: Session, folder: Path
) -> None:
    before = dict(session.now.texts)
    assert processor(session, "supervision", "priority", 30)
    name = str(folder / "model.yaml")
    assert (
        b"    stack: 32 KiB\n    priority: 30\n    activities:\n      - coord"
        in (session.now.texts[name])
    )
    assert processor(session, "supervision", "priority", None)
    assert session.now.texts == before


def test_the_time_of_a_reception_is_that_of_the_driver(session: Session) -> None:
    assert time(session, "robot_bus.receive", "wcet", "50 us")
    assert session.undo_label == "driver_wcet of robot_bus: 40 us to 50 us"


def test_a_change_outside_is_taken_over_where_nothing_was_changed_here(
    session: Session, folder: Path
) -> None:
    path = folder / "joint.yaml"
    path.write_bytes(path.read_bytes().replace(b"wcet: 300 us", b"wcet: 350 us"))
    assert not session.look()  # it may still be written to
    assert session.look()
    assert not session.dirty and session.outside == ()
    assert session.undo_label == f"changed outside: {path}"
    assert b"wcet: 350 us" in session.now.texts[str(path)]
    assert not settled(session)


def test_a_change_outside_is_never_overwritten_unseen(session: Session, folder: Path) -> None:
    path = folder / "joint.yaml"
    time(session, "joint_x.position_control", "wcet", "400 us")
    theirs = path.read_bytes() + b"# theirs\n"
    path.write_bytes(theirs)
    with pytest.raises(ChangeRefusedError, match="nothing was saved: changed on the disk: "):
        session.save(late=True)
    assert path.read_bytes() == theirs and list(session.outside) == [str(path)]
    session.keep()
    assert "-# theirs" in session.diff() and session.outside == ()
    session.save(late=False)
    assert b"400 us" in path.read_bytes() and b"theirs" not in path.read_bytes()


@pytest.fixture
def both(session: Session, folder: Path) -> tuple[Path, Path]:
    """The two files that a change is in, in the order in which they are saved."""
    move(session, "joint_x.ports", "control", 1)
    time(session, "joint_x.position_control", "wcet", "400 us")
    names = [name for name in session.now.texts if name in session.diff()]
    assert names == [str(folder / "model.yaml"), str(folder / "joint.yaml")]
    return folder / "model.yaml", folder / "joint.yaml"


def changed_meanwhile(path: Path, monkeypatch: pytest.MonkeyPatch) -> bytes:
    """Another program writes to a file while the first file of a save is on its way to the disk."""
    theirs = path.read_bytes() + b"# theirs\n"
    written = os.fsync

    def sync(number: int) -> None:
        written(number)
        path.write_bytes(theirs)
        monkeypatch.setattr(os, "fsync", written)

    monkeypatch.setattr(os, "fsync", sync)
    return theirs


def test_a_file_that_changes_while_it_is_saved_is_not_overwritten(
    session: Session, both: tuple[Path, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    model, joint = both
    before, names = joint.read_bytes(), sorted(model.parent.iterdir())
    theirs = changed_meanwhile(model, monkeypatch)
    with pytest.raises(ChangeRefusedError, match=r"^nothing was saved: changed on the disk: "):
        session.save(late=False)
    assert (model.read_bytes(), joint.read_bytes()) == (theirs, before)
    assert session.outside == (str(model),) and session.dirty
    assert sorted(model.parent.iterdir()) == names


def test_a_file_that_changes_while_another_is_saved_is_not_overwritten(
    session: Session, both: tuple[Path, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    model, joint = both
    theirs = changed_meanwhile(joint, monkeypatch)
    with pytest.raises(ChangeRefusedError) as refused:
        session.save(late=False)
    assert str(refused.value) == f"changed on the disk: {joint}; written before that: {model}"
    assert model.read_bytes() == session.now.texts[str(model)]
    assert joint.read_bytes() == theirs and session.outside == (str(joint),)
    session.keep()
    assert "-# theirs" in session.diff() and str(model) not in session.diff()
    assert session.save(late=False) == (str(joint),)
    assert joint.read_bytes() == session.now.texts[str(joint)] and not session.dirty


def test_a_file_that_the_model_included_before_is_not_overwritten_unseen(
    session: Session, folder: Path
) -> None:
    """What was read of it is forgotten with the model that no longer includes it."""
    model, types = folder / "model.yaml", folder / "types.yaml"
    whole, old = model.read_bytes(), types.read_bytes()
    model.write_bytes(whole.replace(b"include: [types.yaml, ", b"include: [new.yaml, "))
    types.rename(folder / "new.yaml")
    assert settled(session) and session.now.analysis is not None
    types.write_bytes(b"# theirs\n")
    session.step(-1)
    with pytest.raises(ChangeRefusedError, match=r"changed on the disk: .*types.yaml"):
        session.save(late=False)
    assert types.read_bytes() == b"# theirs\n"
    session.keep()
    session.save(late=False)
    assert types.read_bytes() == old and model.read_bytes() == whole


@pytest.mark.slow
def test_what_changed_outside_can_be_taken_and_the_changes_here_had_back(
    session: Session, folder: Path
) -> None:
    path = folder / "joint.yaml"
    time(session, "joint_x.position_control", "wcet", "400 us")
    mine = dict(session.now.texts)
    theirs = path.read_bytes() + b"# theirs\n"
    path.write_bytes(theirs)
    assert settled(session) and list(session.outside) == [str(path)]
    assert session.now.texts == mine
    session.take()
    assert session.now.texts[str(path)] == theirs and not session.dirty
    session.step(-1)
    assert session.now.texts == mine and session.dirty
    assert "-# theirs" in session.diff()


def test_a_file_that_becomes_as_it_was_is_no_change(session: Session, folder: Path) -> None:
    path = folder / "joint.yaml"
    time(session, "joint_x.position_control", "wcet", "400 us")
    before = path.read_bytes()
    path.unlink()
    assert settled(session) and list(session.outside) == [str(path)]
    path.write_bytes(before)
    assert settled(session) and session.outside == ()


def test_an_error_made_outside_is_shown_and_the_last_good_analysis_stays(
    session: Session, folder: Path
) -> None:
    path = folder / "joint.yaml"
    before = path.read_bytes()
    for wrong in (b"\tjoint", b"\xff", b"", b"a: [", before.replace(b"wcet: 300 us\n", b"\n")):
        path.write_bytes(wrong)
        assert settled(session)
        assert session.now.analysis is None and session.good.analysis is not None
        assert all(one.origin.file for one in session.now.found) and session.now.found
    path.write_bytes(before)
    assert settled(session)
    assert session.now.analysis is not None


def test_the_rights_of_a_file_and_a_link_to_it_stay(folder: Path) -> None:
    real = folder / "real.yaml"
    (folder / "joint.yaml").rename(real)
    (folder / "joint.yaml").symlink_to(real)
    real.chmod(0o640)
    session = Session(folder / "model.yaml")
    time(session, "joint_x.position_control", "wcet", "400 us")
    session.save(late=False)
    assert (folder / "joint.yaml").is_symlink()
    assert b"400 us" in real.read_bytes()
    assert stat.S_IMODE(real.stat().st_mode) == 0o640
    assert not list(folder.glob(".*"))


def test_a_file_that_cannot_be_written_is_told(
    session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(number: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    time(session, "joint_x.position_control", "wcet", "400 us")
    before = {name: Path(name).read_bytes() for name in session.now.texts}
    with pytest.raises(ChangeRefusedError, match=r"cannot write .*joint.yaml: No space left"):
        session.save(late=False)
    assert {name: Path(name).read_bytes() for name in session.now.texts} == before
    assert session.dirty


def test_a_byte_order_mark_and_line_breaks_are_kept(folder: Path) -> None:
    path = folder / "joint.yaml"
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes().replace(b"\n", b"\r\n"))
    before = path.read_bytes()
    session = Session(folder / "model.yaml")
    time(session, "joint_x.position_control", "wcet", "400 us")
    session.save(late=False)
    assert path.read_bytes() == before.replace(b"wcet: 300 us", b"wcet: 400 us")


def test_the_diff_shows_the_lines_that_change(session: Session, folder: Path) -> None:
    assert session.diff() == ""
    time(session, "joint_x.position_control", "wcet", "400 us")
    lines = session.diff().splitlines()
    assert lines[:2] == [f"--- {folder / 'joint.yaml'}", f"+++ {folder / 'joint.yaml'} (workbench)"]
    assert [line for line in lines[2:] if line[0] in "+-"] == [
        "-        wcet: 300 us", "+        wcet: 400 us"
    ]  # fmt: skip


def test_a_model_with_errors_is_refused_as_check_refuses_it(folder: Path) -> None:
    path = folder / "joint.yaml"
    path.write_bytes(path.read_bytes().replace(b"wcet: 300 us", b"wcet: 300 hours"))
    with pytest.raises(Refused) as mine:
        Session(folder / "model.yaml")
    with pytest.raises(Refused) as theirs:
        checking.check(folder / "model.yaml")
    assert mine.value.shown() == theirs.value.shown()


def test_where_nothing_changed_outside_there_is_nothing_to_take_or_keep(session: Session) -> None:
    time(session, "joint_x.position_control", "wcet", "400 us")
    number, texts = session.number, session.now.texts
    session.take()
    session.keep()
    assert (session.number, session.now.texts) == (number, texts)
