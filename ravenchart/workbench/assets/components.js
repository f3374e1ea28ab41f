// SPDX-FileCopyrightText: Ravenchart contributors
// SPDX-License-Identifier: Apache-2.0

// Left: the components, what they have to run with its times, and the processor of each instance.

import { html } from "./preact.js";
import { Field, Place, useBench } from "./parts.js";

const KINDS = { ports: "ports", region: "chart", activity: "activity" };
const TIMES = [["period", "T"], ["wcet", "C"], ["deadline", "D"]];

export function Components() {
  const { state } = useBench();
  return html`<section class="pane components" aria-labelledby="components-title">
    <h2 id="components-title">Components</h2>
    <p class="remark">T period, C worst-case execution time, D deadline: those of all instances.</p>
    ${state.components.map((one) => html`<${Component} key=${one.name} of=${one} />`)}
  </section>`;
}

function Component({ of }) {
  return html`<article>
    <h3><${Place} at=${of} label=${of.name}>${of.name}<//>
      <span class="remark"> ${of.instances.join(", ") || "no instance"}</span></h3>
    ${of.rows.map((row) => html`<${Row} key=${row.name} row=${row} />`)}
  </article>`;
}

function Row({ row }) {
  const { send, selected, select } = useBench();
  const first = row.runs[0]?.row;
  const chosen = row.runs.some((run) => run.row === selected);
  return html`<div class="declared ${chosen ? "chosen" : ""}">
    <div class="head"><${Place} at=${row} label=${row.name}>${row.name}<//>
      <span class="kind">${KINDS[row.kind]}</span></div>
    <div class="times">${TIMES.map(([key, letter]) => html`<${Field} key=${key} hidden=${false} width="7"
      label=${html`<abbr title="${key} of ${row.owner}.${row.name}">${letter}</abbr>`}
      value=${row.times[key]} follows=${key === "deadline" ? row.times.period : ""}
      optional=${key === "deadline"}
      send=${(value) => send({ kind: "time", row: first, key, value })} />`)}</div>
    <div class="runs">${row.runs.map((run) => html`<button key=${run.row} class="run"
      aria-pressed=${run.row === selected} onClick=${() => select(run.row)}>
      ${run.row.split(".").slice(0, -1).join(".")} <span class="on">${run.on ?? "not allocated"}</span></button>`)}</div>
  </div>`;
}
