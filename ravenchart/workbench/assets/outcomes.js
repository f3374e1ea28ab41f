// SPDX-FileCopyrightText: Ravenchart contributors
// SPDX-License-Identifier: Apache-2.0

// Below the drawing: what is wrong, chains, buses, advice, tables, and the source of what was clicked.

import { html, useEffect, useRef, useState } from "./preact.js";
import { Bar, Place, Word, tabKeys, useBench } from "./parts.js";
import { get, time } from "./link.js";
import { Allocation } from "./allocation.js";
import { Live } from "./live.js";

export function Outcomes({ tab, setTab, at }) {
  const { state } = useBench();
  const errors = state.findings.length;
  const late = state.chains.filter((one) => !one.met).length;
  const missed = state.messages.filter((one) => !one.met).length;
  const tabs = [
    ["findings", "Findings", errors, Findings], ["chains", "Chains", late, Chains],
    ["buses", "Buses", missed, Buses], ["advice", "Room and advice", 0, Advice],
    ["allocation", "Allocation", 0, Allocation], ["live", state.replay ? "Replay" : "Live", 0, Live],
    ["source", "Source", 0, () => html`<${Source} at=${at} />`],
  ];
  const Shown = (tabs.find(([name]) => name === tab) ?? tabs[0])[3];
  return html`<section class="pane outcomes" aria-label="Outcome">
    <div role="tablist" aria-label="Outcome" onKeyDown=${tabKeys(tabs, tab, setTab)}>${tabs.map(([name, label, count]) => html`<button
      key=${name} id="tab-${name}" role="tab" aria-selected=${name === tab} aria-controls="outcome"
      tabindex=${name === tab ? 0 : -1} onClick=${() => setTab(name)}>${label}${count > 0
        ? html` <span class="count">${count}</span>` : ""}</button>`)}</div>
    <div id="outcome" role="tabpanel" aria-labelledby="tab-${tab}" tabindex="0"><${Shown} /></div>
  </section>`;
}

function Findings() {
  const { state } = useBench();
  if (!state.findings.length) return html`<p>${state.verdict}</p>`;
  return html`<ul class="findings">${state.findings.map((one, index) => html`<${Finding} key=${index} of=${one} />`)}</ul>`;
}

export function Finding({ of }) {
  return html`<li class=${of.severity}>
    <p><b>${of.severity}</b> <${Place} at=${of}>${of.file}:${of.line}<//> ${of.message} <code>${of.code}</code></p>
    ${of.notes.map((note, index) => html`<p key=${index} class="note"><${Place} at=${note}>${note.file}:${note.line}<//> ${note.message}</p>`)}
    ${of.hint && html`<p class="hint">${of.hint}</p>`}</li>`;
}

function Chains() {
  const { state } = useBench();
  if (!state.chains.length) return html`<p>The model limits no chain.</p>`;
  return html`<table><thead><tr><th>chain</th><th>limit of</th><th class="number">bound</th><th class="number">saved</th>
    <th class="number">limit</th><th>verdict</th></tr></thead><tbody>
    ${state.chains.flatMap((chain) => chain.limits.map((one) => html`<tr key=${chain.name + one.what}>
      <td><${Place} at=${chain}>${chain.name}<//></td><td>${one.what}</td>
      <td class="number"><b>${time(one.bound)}</b></td>
      <td class="number ${one.saved === one.bound ? "" : "moved"}">${time(one.saved)}</td><td class="number">${time(one.limit)}</td>
      <td><${Word} met=${one.met} /></td></tr>`))}</tbody></table>`;
}

function Buses() {
  const { state } = useBench();
  if (!state.messages.length) return html`<p>The model has no message on a bus.</p>`;
  const loads = state.loads.filter((load) => load.kind === "bus");
  return html`<p>${loads.map((load) => `${load.name}: load ${load.text}, every frame at its longest`).join("; ")}</p>
    <table><thead><tr><th>message</th><th>identifier</th><th class="number">T</th><th class="number">C</th>
    <th class="number">R</th><th class="number">saved</th><th class="number">D</th><th>R of D</th>
    <th>verdict</th></tr></thead><tbody>${state.messages.map((one) => html`<tr key=${one.bus + one.name}>
      <td><${Place} at=${one}>${one.name}<//></td><td><code>${one.identifier}</code></td>
      <td class="number">${one.period}</td><td class="number">${one.wcet_text} us</td>
      <td class="number"><b>${time(one.bound)}</b></td>
      <td class="number ${one.saved === one.bound ? "" : "moved"}">${one.saved === null ? "none" : time(one.saved)}</td>
      <td class="number">${time(one.limit)}</td><td><${Bar} of=${one} /></td><td><${Word} met=${one.met} text=${one.word} /></td></tr>`)}</tbody></table>`;
}

function Advice() {
  const { state } = useBench();
  if (state.stale) return html`<p>There is no advice while the model has errors.</p>`;
  return html`<p>${state.verdict}</p>${state.overloads.map((line) => html`<p key=${line} class="error">${line}</p>`)}
    ${state.room === null ? html`<p aria-live="polite">The room to grow is being looked for …</p>`
    : html`<pre class="advice">${state.room.join("\n")}</pre>`}
    <p class="remark">Saved state: ${state.saved_verdict}</p>`;
}

/** The text of a file, with the line of what was clicked. */
function Source({ at }) {
  const { state } = useBench();
  const [found, setFound] = useState(null);
  const line = useRef(null);
  useEffect(() => {
    let wanted = true;
    if (at) get("source", { file: at.file }).then((text) => wanted && setFound(text)).catch(() => {});
    return () => { wanted = false; };
  }, [at, state.number]);
  useEffect(() => {
    const pane = document.getElementById("outcome");
    if (line.current && pane) pane.scrollTop = line.current.offsetTop - pane.clientHeight / 3;
  }, [found?.file, at]);
  if (!at) return html`<p>Click an element of a drawing, a name or a finding: its source is shown here.</p>`;
  if (found?.file !== at.file) return html`<p>${at.file}</p>`;
  return html`<p class="source-name"><b>${at.file}:${at.line}</b></p><div class="source">${found.lines.map((text, index) => html`<div
    key=${index} class=${index + 1 === at.line ? "line here" : "line"} ref=${index + 1 === at.line ? line : null}
    aria-current=${index + 1 === at.line ? "true" : null}><span class="margin">${index + 1}</span><code>${text}</code></div>`)}</div>`;
}
