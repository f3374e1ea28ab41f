// SPDX-FileCopyrightText: Ravenchart contributors
// SPDX-License-Identifier: Apache-2.0

// Starts `ravenchart language-server` and joins it to the editor.
"use strict";

const { workspace } = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

exports.activate = async () => {
  const settings = workspace.getConfiguration("ravenchart");
  client = new LanguageClient(
    "ravenchart",
    "Ravenchart",
    { command: settings.get("command"), args: ["language-server"] },
    { documentSelector: [{ scheme: "file", language: "yaml", pattern: settings.get("files") }] },
  );
  await client.start();
};

exports.deactivate = () => client?.stop();
