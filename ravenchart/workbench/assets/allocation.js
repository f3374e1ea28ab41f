// SPDX-FileCopyrightText: Ravenchart contributors
// SPDX-License-Identifier: Apache-2.0

// All periodic rows put together anew: a search with its best so far, and the button that takes it.

import { html, useState } from "./preact.js";
import { Word, useBench } from "./parts.js";
import { time } from "./link.js";

const STRATEGIES = [
  ["slack", "as much slack as possible"], ["fewest", "as few processors as possible"],
  ["period", "a processor for each period"], ["locality", "a processor for each instance where rates fit"],
];

export function Allocation() {
  const { state, act } = useBench();
  const { search } = state;
  const [strategy, setStrategy] = useState(search?.strategy ?? "slack");
  const quietly = (message) => act(message).catch(() => {});
  return html`<p class="search"><label>Look for <select value=${strategy} onChange=${(event) => setStrategy(event.target.value)}>
      ${STRATEGIES.map(([name, text]) => html`<option key=${name} value=${name}>${text}</option>`)}</select></label>
      ${search?.running ? html`<button onClick=${() => quietly({ kind: "stop" })}>Stop the search</button>`
      : html`<button disabled=${state.stale} onClick=${() => quietly({ kind: "search", strategy })}>Search</button>`}</p>
    <p class="remark">Sporadic processors, drivers and the host probe stay as they are.</p>
    <p role="status">${told(search)}</p>
    ${search?.best && html`<${Tables} search=${search} />
      <p><button class="main" disabled=${search.old} onClick=${() => quietly({ kind: "adopt" })}>Put these tables
        into the model</button> <span class="remark">Undo takes them back. Nothing is saved yet.</span></p>`}`;
}

function told(search) {
  if (!search) return "";
  if (search.old) return "The model has changed since this search: search again.";
  if (search.fault) return `The search ended: ${search.fault}`;
  const found = search.best?.verdict ?? "no tables yet";
  return search.running ? `Best so far: ${found}` : search.best ? `Found: ${found}` : "The search found no tables.";
}

function Tables({ search: { best } }) {
  return html`<table><thead><tr><th>processor</th><th>activities</th><th class="number">R</th><th class="number">D</th>
    <th>verdict</th></tr></thead><tbody>${best.tables.flatMap((table) => table.rows.map((row, index) => html`<tr key=${table.name + row}>
      <td>${index ? "" : html`<b>${table.name}</b>${table.released_by ? " (stays)" : ""}`}</td><td>${row}</td>
      <td class="number">${row in best.bounds ? time(best.bounds[row]) : ""}</td>
      <td class="number">${row in best.deadlines ? time(best.deadlines[row]) : ""}</td>
      <td>${row in best.bounds && html`<${Word} met=${best.bounds[row] !== null && best.bounds[row] <= best.deadlines[row]} />`}</td>
    </tr>`))}</tbody></table>`;
}
