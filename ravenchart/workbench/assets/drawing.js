// Middle: the structure and the charts. A click on an element shows where it stands in the source.

import { html, useState } from "./preact.js";
import { useBench } from "./parts.js";
import { Canvas, plain } from "./canvas.js";

export function Drawing() {
  const { state, show } = useBench();
  const [name, setName] = useState("structure");
  const chosen = state.drawings.includes(name) ? name : "structure";
  const names = state.drawings.map((one) => ({ key: one, text: one }));
  return html`<${Canvas} names=${names} chosen=${chosen} choose=${setName} version=${state.number}
    finish=${(paper, made) => connect(paper, made.places, show)} />`;
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
