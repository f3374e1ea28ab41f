// SPDX-FileCopyrightText: Ravenchart contributors
// SPDX-License-Identifier: Apache-2.0

// A pane with a drawing of the model, as `ravenchart draw` draws it: chosen by its name, and zoomed.

import { html, useEffect, useLayoutEffect, useRef, useState } from "./preact.js";
import { get } from "./link.js";

const STEP = 1.25;

/** The text of an element of a drawing, without the spaces that Graphviz puts in for room. */
export const plain = (text) => text.replace(/[\u00a0\s]+/g, " ").trim();

/** `names` are the choices, `selected` the one of them that the drawing `chosen` belongs to.
    `version` changes where the drawing may have changed; `finish` gets the paper and what the
    server said of the drawing, whenever one of them or `marks` changes. It is fitted to the width, but not below the zoom `least`. */
export function Canvas({ names, chosen, selected, choose, version, marks, finish, least = 0, children }) {
  const [made, setMade] = useState(null);
  const [problem, setProblem] = useState("");
  const [zoom, setZoom] = useState(null); // null: as wide as the pane
  const known = useRef({});
  const paper = useRef(null);

  useEffect(() => {
    let wanted = true;
    const before = known.current[chosen];
    if (before && before !== made) setMade(before);
    get("drawing", before ? { name: chosen, mark: before.mark } : { name: chosen }).then((found) => {
      const now = { ...found, name: chosen, svg: found.svg ?? before?.svg };
      known.current[chosen] = now;
      if (wanted) {
        setMade(now);
        setProblem("");
      }
    }).catch((error) => wanted && setProblem(error.message));
    return () => { wanted = false; };
  }, [chosen, version]);

  const svg = made?.svg;
  useLayoutEffect(() => {
    if (svg) draw(paper.current, svg);
  }, [svg]);
  useLayoutEffect(() => {
    if (svg) scale(paper.current, zoom, least);
  }, [svg, zoom]);
  useEffect(() => {
    if (made && made.name === chosen) finish(paper.current, made);
  }, [made, marks]);

  const by = (factor) => setZoom((now) => Math.min(4, Math.max(0.1, (now ?? fitted(paper.current, least)) * factor)));
  function wheel(event) {
    if (!event.ctrlKey) return;
    event.preventDefault();
    by(event.deltaY < 0 ? STEP : 1 / STEP);
  }
  return html`<section class="pane drawing" aria-labelledby="drawing-title">
    <div class="bar-of-tools">
      <h2 id="drawing-title" class="unseen">Drawing</h2>
      <label><span class="unseen">Drawing</span><select value=${selected ?? chosen}
        onChange=${(e) => choose(e.target.value)}>${names.map(({ key, text }) => html`<option key=${key} value=${key}>${text}</option>`)}</select></label>
      <span class="gap"></span>
      <button onClick=${() => by(1 / STEP)} aria-label="Zoom out">−</button>
      <button onClick=${() => by(STEP)} aria-label="Zoom in">+</button>
      <button onClick=${() => setZoom(null)}>Fit</button>
      <button onClick=${() => setZoom(1)}>100 %</button>
    </div>
    ${children}
    ${problem && html`<p class="error" role="alert">${problem}</p>`}
    <div class="paper" ref=${paper} tabindex="0" role="group" aria-label="Drawing of ${chosen}" onWheel=${wheel}></div>
  </section>`;
}

/** Puts the text of an SVG drawing into the page, as elements. */
function draw(paper, text) {
  const parsed = new DOMParser().parseFromString(text, "image/svg+xml").documentElement;
  if (parsed.nodeName !== "svg") return;
  const svg = document.importNode(parsed, true);
  svg.dataset.width = parseFloat(svg.getAttribute("width")) * 4 / 3; // pt to px
  svg.removeAttribute("height");
  svg.setAttribute("role", "group");
  paper.replaceChildren(svg);
}

/** The zoom at which a drawing is as wide as its pane, but `least` at least and 1 at most. */
function fitted(paper, least) {
  const svg = paper.querySelector("svg");
  return svg ? Math.min(1, Math.max(least, (paper.clientWidth - 16) / Number(svg.dataset.width))) : 1;
}

function scale(paper, zoom, least) {
  const svg = paper.querySelector("svg");
  if (svg) svg.setAttribute("width", Math.round(Number(svg.dataset.width) * (zoom ?? fitted(paper, least))));
}
