// SPDX-FileCopyrightText: Ravenchart contributors
// SPDX-License-Identifier: Apache-2.0

// A recorded value over time: each point holds until the next one. Where not all recorded values have a point, the
// plot says how many have.

import { html } from "./preact.js";

const [WIDTH, HEIGHT] = [300, 30];

/** `of` has the points, with times in ns and positions among the literals or numbers, and the number of values
    `recorded` from the first to the last one; the time shown ends `now` and takes `span`. */
export function Plot({ of, now, span, name }) {
  if (!of) return null;
  const numbers = of.points.map(([, number]) => number);
  const [low, high] = [Math.min(...numbers), Math.max(...numbers)];
  const word = (number) => of.literals[number] ?? String(number);
  const x = (at) => (WIDTH * Math.max(0, 1 - (now - at) / span)).toFixed(1);
  const y = (number) => (HEIGHT * (high === low ? 0.5 : (high - number) / (high - low))).toFixed(1);
  const steps = of.points.map(([at, number], index) => index ? `H${x(at)}V${y(number)}` : `M${x(at)} ${y(number)}`);
  const range = low === high ? word(low) : `${word(low)} … ${word(high)}`;
  const drawn = of.points.length < of.recorded ? `; ${of.points.length} of ${of.recorded} values drawn` : "";
  return html`<div class="plot"><svg viewBox="0 0 ${WIDTH} ${HEIGHT}" preserveAspectRatio="none" role="img"
      aria-label="${name} over time: ${range}${drawn}"><line x1="0" x2=${WIDTH} y1=${HEIGHT} y2=${HEIGHT} />
      <path d="${steps.join("")}H${WIDTH}" /></svg><span class="remark number">${range}${drawn}</span></div>`;
}
