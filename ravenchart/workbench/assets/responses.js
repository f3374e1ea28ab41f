// SPDX-FileCopyrightText: Ravenchart contributors
// SPDX-License-Identifier: Apache-2.0

// The observed responses of each activity beside C and R. Exact responses are solid bars, upper estimates hollow ones.

import { html } from "./preact.js";
import { time } from "./link.js";

const [WIDTH, HEIGHT] = [300, 30];

const sum = (counts) => counts.reduce((whole, one) => whole + one, 0);
const shown = (ns) => ns === null ? "-" : time(ns);

/** `rows` have the counts of each bin; `note` says where they come from. */
export function Responses({ rows, note }) {
  if (!rows.length) return null;
  return html`<table class="responses"><caption class="remark">Responses of activities, from when their releases were due.
      Solid: exact. Hollow: at most so long, until the next activity of the release began; not to be compared with R.
      Dashed line: C. Line: R. ${note}</caption>
    <thead><tr><th>activity</th><th class="number">C</th><th class="number">R</th><th class="number">longest</th>
      <th class="number">at most</th><th class="number">sampled</th><th>responses</th></tr></thead>
    <tbody>${rows.map((one) => html`<tr key="${one.processor} ${one.name}"><td>${one.name}</td>
      <td class="number">${time(one.wcet)}</td><td class="number">${time(one.bound)}</td>
      <td class="number">${shown(one.longest)}</td><td class="number">${shown(one.longest_at_most)}</td>
      <td class="number">${sampled(one)}</td><td class="plot"><${Histogram} of=${one} /></td></tr>`)}</tbody></table>`;
}

const sampled = (of) => `${sum(of.exact) + sum(of.at_most)} of ${of.executions}`;

function Histogram({ of }) {
  const bins = of.exact.length;
  const highest = Math.max(1, ...of.exact.map((count, bin) => count + of.at_most[bin]));
  const end = bins * of.width;
  const height = (count) => HEIGHT * count / highest;
  const bar = (kind, bin, count, below) => count > 0 && html`<rect key="${kind}${bin}" class=${kind} x=${WIDTH * bin / bins + 1}
    width=${WIDTH / bins - 2} y=${HEIGHT - height(below + count)} height=${height(count)} />`;
  const line = (kind, ns) => ns !== null && html`<line class=${kind} x1=${WIDTH * ns / end} x2=${WIDTH * ns / end} y1="0" y2=${HEIGHT} />`;
  return html`<div class="plot"><svg class="histogram" viewBox="0 0 ${WIDTH} ${HEIGHT}" preserveAspectRatio="none" role="img" aria-label=${inWords(of)}>
      <line x1="0" x2=${WIDTH} y1=${HEIGHT} y2=${HEIGHT} />
      ${of.exact.map((count, bin) => bar("exact", bin, count, 0))}${of.at_most.map((count, bin) => bar("at-most", bin, count, of.exact[bin]))}
      ${line("c", of.wcet)}${line("r", of.bound)}</svg>
    <span class="ends remark number"><span>0</span><span>${time(end)}</span></span></div>`;
}

/** The bars as text: for each bin that has responses, how many of each kind. */
function inWords(of) {
  const parts = of.exact.flatMap((exact, bin) => {
    const [from, to] = [time(bin * of.width), time((bin + 1) * of.width)];
    return [exact && `${exact} from ${from} to ${to}`, of.at_most[bin] && `${of.at_most[bin]} at most ${to}`].filter(Boolean);
  });
  return `Responses of ${of.name}: ${sampled(of)} sampled; C ${time(of.wcet)}, R ${time(of.bound)}; ${parts.join(", ") || "none"}`;
}
