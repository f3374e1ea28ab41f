# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The compiler sees that a file is another, however soon after the last one it is written."""

from pathlib import Path

from ravenchart.building.generation import replace_file


def test_no_two_contents_of_a_file_have_the_same_second(tmp_path: Path) -> None:
    file = tmp_path / "a.adb"
    seconds = set()
    for text in ("one", "two", "three", "four"):
        assert replace_file(file, text)
        seconds.add(int(file.stat().st_mtime))
        assert not replace_file(file, text)
    assert len(seconds) == 4


def test_what_the_user_writes_next_has_another_second(tmp_path: Path) -> None:
    file = tmp_path / "a.adb"
    replace_file(file, "first version")
    written = int(file.stat().st_mtime)
    file.write_text("as the user wants it", encoding="utf-8")
    assert int(file.stat().st_mtime) > written
