// SPDX-FileCopyrightText: Ravenchart contributors
// SPDX-License-Identifier: Apache-2.0

// Middle: the structure and the charts. A click on an element shows where it stands in the source.

import { html } from "./preact.js";
import { useBench } from "./parts.js";
import { Canvas, plain } from "./canvas.js";
import { highlight } from "./highlight.js";

const AT_REST = { active: [], last: null };

export function Drawing() {
  const { state, show, drawing, setDrawing, running } = useBench();
  const chosen = state.drawings.includes(drawing.name) ? drawing.name : "structure";
  const names = state.drawings.map((one) => ({ key: one, text: one }));
  const charts = running.filter((one) => one.drawing === chosen);
  const chart = charts.find((one) => one.name === drawing.chart) ?? charts[0];
  function finish(paper, made) {
    connect(paper, made.places, show);
    highlight(paper, made.arrows, chart ?? AT_REST);
  }
  return html`<${Canvas} names=${names} chosen=${chosen} choose=${(name) => setDrawing({ name, chart: null })}
    version=${state.number} marks=${JSON.stringify(chart ?? null)} finish=${finish}>
    ${chart && html`<p class="bar-of-tools"><label>Active in <select value=${chart.name}
      onChange=${(e) => setDrawing({ name: chosen, chart: e.target.value })}>${charts.map((one) => html`<option
        key=${one.name} value=${one.name}>${one.name}</option>`)}</select></label>
      <span class="remark">${chart.last.taken.length ? `last transition: ${chart.last.taken[0]}` : "no transition yet"}</span></p>`}<//>`;
}

/** Makes buttons of the elements whose location is known. */
function connect(paper, places, show) {
  const whole = new Map();
  const inside = new Map();
  for (const place of places) {
    const text = plain(place.text);
    const [table, key] = text ? [inside, `${plain(place.title)}\n${text}`] : [whole, plain(place.title)];
    if (!table.has(key)) table.set(key, place);
  }
  for (const group of paper.querySelectorAll("g")) {
    const title = plain(group.querySelector(":scope > title")?.textContent ?? "");
    const at = whole.get(title);
    for (const text of group.querySelectorAll(":scope > text, :scope > g > text")) {
      const found = inside.get(`${title}\n${plain(text.textContent)}`);
      if (found) button(text, plain(text.textContent), found, show);
    }
    if (!at) continue;
    const label = title.replace(/^(cluster|header|table) /, "");
    if (!group.querySelector(".link")) {
      button(group, label, at, show);
      continue;
    }
    // A button holds no other button: the first text of its own is the one for the keyboard.
    const own = group.querySelector(":scope > text:not(.link), :scope > g > text:not(.link)");
    if (own) button(own, label, at, show);
    group.onclick = clicked(at, show);
  }
}

function clicked(at, show) {
  return (event) => {
    event.stopPropagation();
    show(at);
  };
}

function button(element, label, at, show) {
  element.classList.add("link");
  element.setAttribute("tabindex", "0");
  element.setAttribute("role", "button");
  element.setAttribute("aria-label", `${label}, source ${at.file}:${at.line}`);
  element.onclick = clicked(at, show);
  element.onkeydown = (event) => {
    if (event.key !== "Enter" && event.key !== " ") return;
    event.preventDefault();
    event.stopPropagation();
    show(at);
  };
}
