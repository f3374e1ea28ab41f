// SPDX-FileCopyrightText: Ravenchart contributors
// SPDX-License-Identifier: Apache-2.0

// Below the drawing and right of it: what the last execution did and why, trace, values, event file.

import { html, useState } from "./preact.js";
import { useBench } from "./parts.js";

/** The steps of the last execution, with every transition from a state that was active. */
export function Reasons() {
  const { chart } = useBench();
  if (!chart.last) return html`<p>${chart.name} has not been executed yet. Let time go on by one execution.</p>`;
  return html`<p class="remark">Execution at ${chart.last.at}</p>
    ${chart.last.steps.map((step, index) => html`<${Step} key=${index} step=${step} number=${index + 1} of=${chart.last.steps.length} />`)}`;
}

function Step({ step, number, of }) {
  const notes = [
    step.deferring.length > 0 && `the event is deferred by ${step.deferring.join(", ")}`,
    step.sent.length > 0 && `sent: ${step.sent.join("; ")}`,
    step.raised.length > 0 && `raised: ${step.raised.join("; ")}`,
    step.lost > 0 && "the event was lost: no more can be deferred",
  ].filter(Boolean);
  return html`<section class="step">
    <h3>Step${of > 1 ? ` ${number}` : ""} for ${step.occurrence}</h3>
    <p>${step.behaviours.length ? html`<code>${step.behaviours.join(", ")}</code>` : "Nothing fired."}</p>
    ${notes.map((text) => html`<p key=${text} class="remark">${text}</p>`)}
    ${step.verdicts.length > 0 && html`<table><thead><tr><th>transition</th><th>why</th><th>from, to</th><th>label</th></tr></thead>
      <tbody>${step.verdicts.map((one) => html`<tr key=${one.transition} class=${one.fired ? "fired" : ""}>
        <td>${one.transition}</td><td>${one.fired ? html`<b class="word ok">fired</b>` : one.reason}</td>
        <td>${one.source === one.target ? one.source : `${one.source} → ${one.target}`}</td><td>${one.label}</td></tr>`)}</tbody></table>`}
  </section>`;
}

/** The lines that `ravenchart simulate` prints, newest last. */
export function Trace() {
  const { state } = useBench();
  if (!state.trace.length) return html`<p>No step has executed a behaviour yet.</p>`;
  return html`${state.left_out > 0 && html`<p class="remark">${state.left_out} earlier lines are left out.</p>`}
    <pre class="lines">${state.trace.join("\n")}</pre>`;
}

/** What was done, for `ravenchart simulate --events`. */
export function Recording() {
  const { state } = useBench();
  const [told, setTold] = useState("");
  if (state.file === null) return html`<p>Nothing has been executed yet: there is no event file.</p>`;
  const copy = () => navigator.clipboard.writeText(state.file)
    .then(() => setTold("Copied."), () => setTold("The browser refuses: select the text and copy it."));
  return html`<div class="bar-of-tools"><button onClick=${copy}>Copy</button>
      <a class="button" href="events.yaml" download="events.yaml">Save as a file</a>
      <span class="remark" role="status">${told}</span></div>
    <p class="remark">ravenchart simulate ${state.model} --interpreter --events events.yaml prints the same trace.
      ${state.waiting > 0 ? ` ${state.waiting} waiting for the next release: not yet in the file.` : ""}</p>
    <pre class="lines">${state.file}</pre>`;
}

/** Right: what is active and waits in the chart, and the values of its instance. */
export function Situation() {
  const { state, chart } = useBench();
  const instance = state.instances.find((one) => one.name === chart.instance);
  return html`<section class="pane situation" aria-labelledby="situation-title">
    <h2 id="situation-title">${chart.name}</h2>
    <p class="remark">executed every ${chart.period}</p>
    <h3>Active</h3>
    <p aria-live="polite">${chart.active.length ? chart.active.join(", ") : "nothing: the first execution enters the initial state"}${
      chart.stopped ? " (terminated)" : ""}</p>
    <h3>Waiting</h3>
    <dl><dt>queue of ${chart.depth}</dt><dd>${chart.queue.join(", ") || "empty"}</dd>
      ${chart.deferred.length > 0 && html`<dt>deferred</dt><dd>${chart.deferred.join(", ")}</dd>`}
      ${chart.timers.map((one) => html`<dt key=${one.transition}>time-out of ${one.transition}</dt><dd class="number">in ${one.left}</dd>`)}</dl>
    <${Values} title="Data" of=${instance.data} />
    <${Values} title="Parameters" of=${instance.parameters} />
    ${instance.ports.length > 0 && html`<h3>Input ports</h3><dl>${instance.ports.map((one) => html`<dt key=${one.name}>${one.name}</dt>
      <dd>${one.state}${one.state === "never received" ? "" : `: ${one.value}, age ${one.age} ${one.age === 1 ? "execution" : "executions"}`}${
        one.waiting.length ? `; arrived: ${one.waiting.join(", ")}` : ""}</dd>`)}</dl>`}
  </section>`;
}

function Values({ title, of }) {
  if (!of.length) return null;
  return html`<h3>${title}</h3><dl>${of.map((one) => html`<dt key=${one.name}>${one.name}</dt><dd class="number">${one.value}</dd>`)}</dl>`;
}
