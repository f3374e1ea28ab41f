# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The server: the protocol on one side, a model at one moment on the other.

One thread reads models, since the pipeline is not made for several; the protocol goes on
meanwhile. A change is looked at when nothing has changed for `PAUSE`.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TypeVar

from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcInvalidParams
from pygls.lsp.server import LanguageServer
from pygls.uris import from_fs_path, to_fs_path

from ravenchart.editing.evaluation import MARK, Evaluation
from ravenchart.gen.diagnostics import Diagnostic, Severity
from ravenchart.gen.origins import Origin
from ravenchart.paths import version

from . import model as models
from .completing import key_meaning, proposals
from .hovering import described
from .model import OpenModel, real
from .renaming import NotRenamedError, place_of, renamed
from .symbols import ModelSymbol, Token
from .texts import FileText

PAUSE = 0.2
"""Seconds without a change before a model is looked at."""

T = TypeVar("T")


class ModelServer(LanguageServer):
    """The server, and what it knows of each model."""

    def __init__(self) -> None:
        super().__init__("ravenchart", version())
        self.reading = ThreadPoolExecutor(1, "models")
        self.main_files: dict[str, str] = {}
        """The main file of each file that was seen to belong to a model."""
        self.waiting: dict[str, asyncio.Task[None]] = {}
        self.told: dict[str, set[str]] = {}
        """The files of a model for which the editor got diagnostics."""

    def documents(self) -> dict[str, str]:
        """The open texts by the absolute names of their files."""
        return {
            real(path): one.source.removeprefix(MARK)
            for uri, one in self.workspace.text_documents.items()
            if (path := to_fs_path(uri)) is not None
        }

    async def alone(self, work: Callable[[], T]) -> T:
        """Do something in the thread that reads models."""
        return await asyncio.get_running_loop().run_in_executor(self.reading, work)

    def main_file(self, name: str, documents: models.Open) -> str:
        """The main file of the model that a file belongs to."""
        return models.main_file(name, documents, self.main_files.get)

    # --- Diagnostics

    def look(self, uri: str, pause: float, *, behaviour: bool) -> None:
        """Check the model of a document soon, and publish its diagnostics."""
        name = _name(uri)
        before = self.waiting.pop(name, None)
        if before is not None:
            before.cancel()
        self.waiting[name] = asyncio.ensure_future(self._look(name, pause, behaviour))

    async def _look(self, name: str, pause: float, behaviour: bool) -> None:
        await asyncio.sleep(pause)
        documents = self.documents()
        main, now, found = await self.alone(lambda: self._found(name, documents, behaviour))
        by_file: dict[str, list[lsp.Diagnostic]] = {real(file): [] for file in now.texts}
        for one in found:
            by_file.setdefault(real(one.origin.file), []).append(_diagnostic(one, now))
        for file in self.told.get(main, set()) - set(by_file):
            by_file[file] = []
        self.told[main] = {file for file, told in by_file.items() if told}
        for file, told in by_file.items():
            self.main_files[file] = main
            uri = from_fs_path(file)
            assert uri is not None
            self.text_document_publish_diagnostics(lsp.PublishDiagnosticsParams(uri, told))

    def _found(
        self, name: str, documents: models.Open, behaviour: bool
    ) -> tuple[str, OpenModel, tuple[Diagnostic, ...]]:
        main = self.main_file(name, documents)
        now, evaluation = models.evaluated(Path(main), documents)
        found = evaluation.found
        if behaviour and evaluation.analysis is not None:
            found = models.checked(Path(main), documents)
        return main, now, found

    # --- Names

    async def symbol(
        self, uri: str, position: lsp.Position
    ) -> tuple[OpenModel, ModelSymbol, Token, models.Open] | None:
        """The name at a position, in the model that it belongs to."""
        documents, name = self.documents(), _name(uri)

        def found() -> tuple[OpenModel, ModelSymbol, Token, models.Open] | None:
            now = models.model(Path(self.main_file(name, documents)), documents)
            file = now.file(name)
            if file is None:
                return None
            there = now.symbols.at(file, now.texts[file].offset_of(position))
            return None if there is None else (now, *there, documents)

        return await self.alone(found)

    def evaluated(self, name: str, documents: models.Open) -> tuple[OpenModel, Evaluation]:
        """The model of a file with its timing; in the thread that reads models."""
        return models.evaluated(Path(self.main_file(name, documents)), documents)


def _name(uri: str) -> str:
    return real(to_fs_path(uri) or uri)


def _location(token: Token, now: OpenModel) -> lsp.Location:
    uri = from_fs_path(real(token[0])) or ""
    return lsp.Location(uri, now.texts[token[0]].range(place_of(token)))


def _diagnostic(one: Diagnostic, now: OpenModel) -> lsp.Diagnostic:
    notes = [
        lsp.DiagnosticRelatedInformation(
            lsp.Location(from_fs_path(real(origin.file)) or "", _marked(origin, now)), text
        )
        for origin, text in one.notes
    ]
    error = one.severity is Severity.ERROR
    return lsp.Diagnostic(
        _marked(one.origin, now),
        one.message if one.hint is None else f"{one.message}\nhint: {one.hint}",
        lsp.DiagnosticSeverity.Error if error else lsp.DiagnosticSeverity.Warning,
        one.code,
        source="ravenchart",
        related_information=notes or None,
    )


def _marked(origin: Origin, now: OpenModel) -> lsp.Range:
    text = now.texts.get(origin.file)
    if text is None:
        start = lsp.Position(max(0, origin.line - 1), max(0, origin.column - 1))
        return lsp.Range(start, start)
    return text.marked(origin)


def server() -> ModelServer:
    """The server with all that it answers."""
    made = ModelServer()
    feature = made.feature

    @feature(lsp.TEXT_DOCUMENT_DID_OPEN)
    async def opened(ls: ModelServer, given: lsp.DidOpenTextDocumentParams) -> None:
        ls.look(given.text_document.uri, 0, behaviour=True)

    @feature(lsp.TEXT_DOCUMENT_DID_CHANGE)
    async def changed(ls: ModelServer, given: lsp.DidChangeTextDocumentParams) -> None:
        ls.look(given.text_document.uri, PAUSE, behaviour=False)

    @feature(lsp.TEXT_DOCUMENT_DID_SAVE)
    async def saved(ls: ModelServer, given: lsp.DidSaveTextDocumentParams) -> None:
        ls.look(given.text_document.uri, 0, behaviour=True)

    @feature(
        lsp.TEXT_DOCUMENT_COMPLETION,
        lsp.CompletionOptions(trigger_characters=[" ", ".", "{", "["]),
    )
    async def complete(ls: ModelServer, given: lsp.CompletionParams) -> list[lsp.CompletionItem]:
        documents, name = ls.documents(), _name(given.text_document.uri)

        def found() -> list[lsp.CompletionItem]:
            main = Path(ls.main_file(name, documents))
            offset = FileText(documents[name]).offset_of(given.position)
            return [
                lsp.CompletionItem(
                    one.word,
                    kind=lsp.CompletionItemKind.Property
                    if one.is_key
                    else lsp.CompletionItemKind.Reference,
                    detail=one.detail or None,
                    insert_text=f"{one.word}: " if one.is_key else None,
                )
                for one in proposals(main, name, offset, documents)
            ]

        return await ls.alone(found)

    @feature(lsp.TEXT_DOCUMENT_HOVER)
    async def hover(ls: ModelServer, given: lsp.HoverParams) -> lsp.Hover | None:
        documents, name = ls.documents(), _name(given.text_document.uri)

        def found() -> lsp.Hover | None:
            now, evaluation = ls.evaluated(name, documents)
            file = now.file(name)
            if file is None:
                return None
            text = now.texts[file]
            offset = text.offset_of(given.position)
            there = now.symbols.at(file, offset)
            if there is not None:
                told: str | None = described(there[0], now, evaluation)
            else:
                told = key_meaning(text.text, offset)
            if not told:
                return None
            return lsp.Hover(lsp.MarkupContent(lsp.MarkupKind.Markdown, told))

        return await ls.alone(found)

    _names(made)
    return made


def _names(made: ModelServer) -> None:
    """The requests about names: definition, references, rename."""

    @made.feature(lsp.TEXT_DOCUMENT_DEFINITION)
    async def definition(ls: ModelServer, given: lsp.DefinitionParams) -> lsp.Location | None:
        there = await ls.symbol(given.text_document.uri, given.position)
        if there is None or there[1].declared is None:
            return None
        return _location(there[1].declared, there[0])

    @made.feature(lsp.TEXT_DOCUMENT_REFERENCES)
    async def references(ls: ModelServer, given: lsp.ReferenceParams) -> list[lsp.Location]:
        there = await ls.symbol(given.text_document.uri, given.position)
        if there is None:
            return []
        now, symbol = there[:2]
        declared = given.context.include_declaration
        shown = (one for one in sorted(symbol.tokens) if declared or one != symbol.declared)
        return [_location(one, now) for one in shown]

    @made.feature(lsp.TEXT_DOCUMENT_PREPARE_RENAME)
    async def prepare(ls: ModelServer, given: lsp.PrepareRenameParams) -> lsp.Range | None:
        there = await ls.symbol(given.text_document.uri, given.position)
        if there is None or there[1].declared is None:
            return None
        return there[0].texts[there[2][0]].range(place_of(there[2]))

    @made.feature(lsp.TEXT_DOCUMENT_RENAME, lsp.RenameOptions(prepare_provider=True))
    async def rename(ls: ModelServer, given: lsp.RenameParams) -> lsp.WorkspaceEdit:
        there = await ls.symbol(given.text_document.uri, given.position)
        if there is None:
            raise JsonRpcInvalidParams("there is no name of the model here")
        now, symbol, _, documents = there
        new = given.new_name
        try:
            places = await ls.alone(lambda: renamed(now, symbol, new, documents))
        except NotRenamedError as problem:
            raise JsonRpcInvalidParams(str(problem)) from problem
        return lsp.WorkspaceEdit(
            {
                from_fs_path(name) or "": [
                    lsp.TextEdit(_range(now, name, span), new) for span in spans
                ]
                for name, spans in places.items()
            }
        )


def _range(now: OpenModel, name: str, span: tuple[int, int]) -> lsp.Range:
    file = now.file(name)
    assert file is not None
    return now.texts[file].range(span)
