// Middle: the structure and the charts as `ravenchart draw` draws them. A click on an element
// shows where it stands in the source.

import { html, useEffect, useRef, useState } from "./preact.js";
import { useBench } from "./parts.js";
import { get } from "./link.js";

const STEP = 1.25;
const plain = (text) => text.replace(/[\u00a0\s]+/g, " ").trim();

export function Drawing() {
  const { state, show } = useBench();
  const [name, setName] = useState("structure");
  const [made, setMade] = useState(null);
  const [problem, setProblem] = useState("");
  const [zoom, setZoom] = useState(null); // null: as wide as the pane
  const known = useRef({});
  const paper = useRef(null);
  const chosen = state.drawings.includes(name) ? name : "structure";

  useEffect(() => {
    let wanted = true;
    const before = known.current[chosen];
    if (before && before !== made) setMade(before);
    get("drawing", before ? { name: chosen, mark: before.mark } : { name: chosen }).then((found) => {
      const now = { name: chosen, svg: found.svg ?? before?.svg, mark: found.mark, places: found.places };
      known.current[chosen] = now;
      if (wanted) {
        setMade(now);
        setProblem("");
      }
    }).catch((error) => wanted && setProblem(error.message));
    return () => { wanted = false; };
  }, [chosen, state.number]);

  const svg = made?.svg;
  useEffect(() => {
    if (svg) draw(paper.current, svg);
  }, [svg]);
  useEffect(() => {
    if (made) connect(paper.current, made.places, show);
  }, [made]);
  useEffect(() => {
    if (svg) scale(paper.current, zoom);
  }, [svg, zoom]);

  const by = (factor) => setZoom((now) => Math.min(4, Math.max(0.1, (now ?? fitted(paper.current)) * factor)));
  function wheel(event) {
    if (!event.ctrlKey) return;
    event.preventDefault();
    by(event.deltaY < 0 ? STEP : 1 / STEP);
  }
  return html`<section class="pane drawing" aria-labelledby="drawing-title">
    <div class="bar-of-tools">
      <h2 id="drawing-title" class="unseen">Drawing</h2>
      <label><span class="unseen">Drawing</span><select value=${chosen} onChange=${(e) => setName(e.target.value)}>
        ${state.drawings.map((one) => html`<option key=${one} value=${one}>${one}</option>`)}</select></label>
      <span class="gap"></span>
      <button onClick=${() => by(1 / STEP)} aria-label="Zoom out">−</button>
      <button onClick=${() => by(STEP)} aria-label="Zoom in">+</button>
      <button onClick=${() => setZoom(null)}>Fit</button>
      <button onClick=${() => setZoom(1)}>100 %</button>
    </div>
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

/** The zoom at which a drawing is as wide as its pane, or of its own size where that is less. */
function fitted(paper) {
  const svg = paper.querySelector("svg");
  return svg ? Math.min(1, (paper.clientWidth - 16) / Number(svg.dataset.width)) : 1;
}

function scale(paper, zoom) {
  const svg = paper.querySelector("svg");
  if (svg) svg.setAttribute("width", Math.round(Number(svg.dataset.width) * (zoom ?? fitted(paper))));
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
