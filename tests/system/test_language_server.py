# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The language server, asked by the client of pygls as an editor asks it."""

from __future__ import annotations

import asyncio
import shutil
import sys
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest
from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcException
from pygls.lsp.client import LanguageClient

from ravenchart.gen.pipeline import load
from ravenchart.paths import ROOT

ROBOT = ROOT / "examples" / "cartesian_robot"
PATIENCE = 60.0
"""Seconds for one answer."""


class Editor:
    """An editor with a folder: it opens files, types, and waits for diagnostics."""

    def __init__(self, client: LanguageClient, folder: Path) -> None:
        self.client = client
        self.folder = folder
        self.texts: dict[str, str] = {}
        self.told: asyncio.Queue[lsp.PublishDiagnosticsParams] = asyncio.Queue()

        def tell(told: lsp.PublishDiagnosticsParams) -> None:
            self.told.put_nowait(told)

        client.feature(lsp.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)(tell)

    def uri(self, name: str) -> str:
        """Of a file in the folder."""
        return (self.folder / name).as_uri()

    def open(self, name: str) -> None:
        """Open a file of the folder."""
        self.texts[name] = (self.folder / name).read_text()
        document = lsp.TextDocumentItem(self.uri(name), "yaml", 1, self.texts[name])
        self.client.text_document_did_open(lsp.DidOpenTextDocumentParams(document))

    def type(self, name: str, old: str, new: str) -> None:
        """Exchange a text in an open file, which is not saved."""
        assert self.texts[name].count(old) == 1
        self.texts[name] = self.texts[name].replace(old, new)
        document = lsp.VersionedTextDocumentIdentifier(2, self.uri(name))
        whole = [lsp.TextDocumentContentChangeWholeDocument(self.texts[name])]
        self.client.text_document_did_change(lsp.DidChangeTextDocumentParams(document, whole))

    async def diagnostics(self, name: str) -> list[lsp.Diagnostic]:
        """The next ones of a file."""
        while True:
            told = await asyncio.wait_for(self.told.get(), PATIENCE)
            if told.uri == self.uri(name):
                return list(told.diagnostics)

    def at(
        self, name: str, text: str, into: int = 0
    ) -> tuple[lsp.TextDocumentIdentifier, lsp.Position]:
        """The position of a text, which stands once in an open file, and so many characters on."""
        whole = self.texts[name]
        assert whole.count(text) == 1, (text, whole.count(text))
        before = whole[: whole.index(text) + into]
        line = before.count("\n")
        units = len(before.rpartition("\n")[2].encode("utf-16-le")) // 2
        return lsp.TextDocumentIdentifier(self.uri(name)), lsp.Position(line, units)

    def marked(self, name: str, range_: lsp.Range) -> str:
        """The characters of a range in one line."""
        assert range_.start.line == range_.end.line
        line = self.texts[name].splitlines()[range_.start.line].encode("utf-16-le")
        return line[2 * range_.start.character : 2 * range_.end.character].decode("utf-16-le")


Scene = Callable[[Editor], Awaitable[None]]


def played(folder: Path, scene: Scene) -> None:
    """Start a server as an editor does, play a scene with it, and end it."""

    async def play() -> None:
        client = LanguageClient("test", "1")
        editor = Editor(client, folder)
        await client.start_io(sys.executable, "-P", "-m", "ravenchart", "language-server")
        await client.initialize_async(
            lsp.InitializeParams(lsp.ClientCapabilities(), root_uri=folder.as_uri())
        )
        client.initialized(lsp.InitializedParams())
        await scene(editor)
        await asyncio.wait_for(client.shutdown_async(None), PATIENCE)
        client.exit(None)
        await client.stop()

    asyncio.run(play())


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    """The robot's model, with a character outside the basic plane before names."""
    folder = tmp_path / "a robot"
    folder.mkdir()
    for path in ROBOT.glob("*.yaml"):
        shutil.copy(path, folder)
    return folder


def test_what_is_typed_is_checked_and_marked(robot: Path) -> None:
    async def scene(editor: Editor) -> None:
        editor.open("model.yaml")
        assert await editor.diagnostics("model.yaml") == []
        editor.type("model.yaml", "component: Robot_Coordinator", "component: Robot_Cordinator")
        (found,) = await editor.diagnostics("model.yaml")
        assert found.code == "RV-0305" and found.source == "ravenchart"
        assert editor.marked("model.yaml", found.range) == "Robot_Cordinator"
        assert "did you mean `Robot_Coordinator`?" in found.message
        editor.type("model.yaml", "component: Robot_Cordinator", "component: Robot_Coordinator")
        assert await editor.diagnostics("model.yaml") == []

    played(robot, scene)


def test_errors_of_an_included_file_come_while_it_alone_is_open(robot: Path) -> None:
    async def scene(editor: Editor) -> None:
        editor.open("joint.yaml")
        assert await editor.diagnostics("joint.yaml") == []
        editor.type("joint.yaml", "wcet: 100 us}", "wcet: 100 years}")
        (found,) = await editor.diagnostics("joint.yaml")
        assert found.code == "RV-0205"

    played(robot, scene)


def test_a_name_leads_to_its_declaration_in_another_file(robot: Path) -> None:
    async def scene(editor: Editor) -> None:
        for name in ("model.yaml", "joint.yaml", "types.yaml"):
            editor.open(name)
        at = editor.at("joint.yaml", "on_stale: Feedback_Lost", len("on_stale: Fe"))
        found = await editor.client.text_document_definition_async(lsp.DefinitionParams(*at))
        assert isinstance(found, lsp.Location) and found.uri == editor.uri("joint.yaml")
        assert editor.marked("joint.yaml", found.range) == "Feedback_Lost"
        at = editor.at("joint.yaml", "{type: Travel}", 7)
        found = await editor.client.text_document_definition_async(lsp.DefinitionParams(*at))
        assert isinstance(found, lsp.Location) and found.uri == editor.uri("types.yaml")
        assert editor.marked("types.yaml", found.range) == "Travel"
        at = editor.at("joint.yaml", "# One axis", 3)
        assert await editor.client.text_document_definition_async(lsp.DefinitionParams(*at)) is None

    played(robot, scene)


def test_another_name_goes_to_every_file_and_the_model_stays_right(robot: Path) -> None:
    async def scene(editor: Editor) -> None:
        editor.open("joint.yaml")
        await editor.diagnostics("joint.yaml")
        editor.texts |= {name: (robot / name).read_text() for name in ("model.yaml", "types.yaml")}
        at = editor.at("joint.yaml", "order: {in:", 1)
        there = await editor.client.text_document_prepare_rename_async(lsp.PrepareRenameParams(*at))
        assert isinstance(there, lsp.Range) and editor.marked("joint.yaml", there) == "order"
        edit = await editor.client.text_document_rename_async(lsp.RenameParams(*at, "goal_order"))
        assert edit is not None and edit.changes is not None
        assert set(edit.changes) == {editor.uri("joint.yaml"), editor.uri("model.yaml")}
        for uri, edits in edit.changes.items():
            path = robot / uri.rpartition("/")[2]
            lines = path.read_text().splitlines(keepends=True)
            for one in reversed(edits):
                line, start, end = one.range.start.line, one.range.start, one.range.end
                assert lines[line][start.character : end.character] == "order"
                lines[line] = (
                    lines[line][: start.character] + one.new_text + lines[line][end.character :]
                )
            path.write_text("".join(lines))

    played(robot, scene)
    assert load(robot / "model.yaml").diagnostics == ()
    assert "order: " not in (robot / "joint.yaml").read_text().replace("goal_order: ", "")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("new", "reason"),
    [
        ("feedback", "there would be an error: .*feedback"),
        ("end", "reserved word of Ada"),
        ("two words", "is not a name"),
    ],
)
def test_a_name_that_would_break_the_model_is_refused(robot: Path, new: str, reason: str) -> None:
    async def scene(editor: Editor) -> None:
        editor.open("joint.yaml")
        at = editor.at("joint.yaml", "order: {in:", 1)
        with pytest.raises(JsonRpcException, match=reason):
            await editor.client.text_document_rename_async(lsp.RenameParams(*at, new))

    played(robot, scene)


def test_a_key_and_a_name_are_explained(robot: Path) -> None:
    async def scene(editor: Editor) -> None:
        for name in ("model.yaml", "joint.yaml"):
            editor.open(name)
        told = await _hovered(editor, "joint.yaml", "safe_state: Fault", 2)
        assert told == "State that must be reachable from every other."
        told = await _hovered(editor, "joint.yaml", "safe_state: Fault", len("safe_state: F"))
        assert told.startswith("**state of Motion** `Fault`\n\n```yaml\nFault:")
        told = await _hovered(editor, "model.yaml", "component: Robot_Coordinator", 14)
        assert "Robot_Coordinator:" in told
        assert "R = " not in told
        told = await _hovered(editor, "joint.yaml", "kind: queued", 2)
        assert told.startswith("`sampled` keeps the last value")
        told = await _hovered(editor, "model.yaml", "joint_x.Motion", 10)
        assert "R = " in told and "ms, D = 20 ms" in told

    played(robot, scene)


async def _hovered(editor: Editor, name: str, text: str, into: int) -> str:
    given = lsp.HoverParams(*editor.at(name, text, into))
    found = await editor.client.text_document_hover_async(given)
    assert found is not None and isinstance(found.contents, lsp.MarkupContent)
    return found.contents.value


async def _proposed(editor: Editor, name: str, text: str) -> dict[str, lsp.CompletionItem]:
    """The words for the place behind a text."""
    given = lsp.CompletionParams(*editor.at(name, text, len(text)))
    found = await editor.client.text_document_completion_async(given)
    assert isinstance(found, list)
    return {one.label: one for one in found}


def test_the_names_and_keys_that_could_stand_there_are_proposed(robot: Path) -> None:
    async def scene(editor: Editor) -> None:
        editor.open("joint.yaml")
        editor.open("model.yaml")
        events = await _proposed(editor, "joint.yaml", "on_stale: ")
        assert list(events) == ["Ordered", "Feedback_Lost", "Strayed", "Limit_Hit", "Drive_Failed"]
        kinds = await _proposed(editor, "joint.yaml", "order: {in: Joint_Order, kind: ")
        assert list(kinds) == ["sampled", "queued"]
        editor.type("joint.yaml", "safe_state: Fault", "safe_state: ")
        states = await _proposed(editor, "joint.yaml", "safe_state: ")
        assert {"Fault", "Idle", "Homing"} <= set(states)
        editor.type("joint.yaml", "        safe_state: \n", "        def\n")
        keys = await _proposed(editor, "joint.yaml", "        def")
        assert keys["deferred"].insert_text == "deferred: "
        assert "Deferred events" in (keys["deferred"].detail or "")
        assert "queue" not in keys and "component" not in keys

    played(robot, scene)


def test_positions_count_utf_16_units_as_editors_do(robot: Path) -> None:
    joint = robot / "joint.yaml"
    text = joint.read_text()
    old = "    port_region: {"
    assert text.count(old) == 1
    new = '    port_region: {req: ["\N{ROCKET}"], '
    joint.write_text(text.replace(old, new).replace("wcet: 100 us}", "wcet: 100 years}"))

    async def scene(editor: Editor) -> None:
        editor.open("joint.yaml")
        found = {one.code: one for one in await editor.diagnostics("joint.yaml")}
        assert editor.marked("joint.yaml", found["RV-0205"].range) == "100 years"

    played(robot, scene)
