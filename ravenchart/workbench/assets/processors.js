// SPDX-FileCopyrightText: Ravenchart contributors
// SPDX-License-Identifier: Apache-2.0

// Right: the processors with their responses, and their activities in order. A row is moved by
// dragging, by Shift and the arrow keys, or by the controls below it once it is selected.

import { html, useEffect, useRef, useState } from "./preact.js";
import { Bar, Field, Place, Word, useBench } from "./parts.js";
import { get, time } from "./link.js";

const TIMES = [["period", "Period T"], ["wcet", "WCET C"], ["deadline", "Deadline D"]];

export function Processors() {
  const { state } = useBench();
  const [drop, setDrop] = useState(null);
  return html`<section class="pane processors" aria-labelledby="processors-title">
    <h2 id="processors-title">Processors</h2>
    <p class="remark">Drag an activity, or focus it and press Shift with an arrow key.</p>
    <div class="legend" aria-hidden="true">${["jitter", "blocking", "own", "interference", "overhead"].map(
      (kind) => html`<span key=${kind}><i class="part ${kind}"></i>${kind}</span>`)}
      <span><i class="deadline"></i>deadline</span><span><i class="saved"></i>saved</span></div>
    ${state.loads.map((load) => html`<${Load} key=${load.name} of=${load} />`)}
    ${state.processors.map((one) => html`<${Processor} key=${one.name} of=${one}
      drop=${drop} setDrop=${setDrop} />`)}
    ${state.streams.map((one) => html`<${Stream} key=${one.name} of=${one} />`)}
  </section>`;
}

function Load({ of }) {
  const before = of.saved_text && of.saved_text !== of.text ? ` (saved ${of.saved_text})` : "";
  return html`<div class="load"><span>${of.kind} ${of.name}</span>
    <span class="bar" role="img" aria-label="load ${of.text}"><span class="part ${of.over ? "late" : "own"}"
      style=${{ width: `${of.share}%` }}></span></span>
    <span class=${of.over ? "word bad" : "number"}>${of.text}${of.over ? " overloaded" : ""}${before}</span></div>`;
}

function Processor({ of, drop, setDrop }) {
  const { act, send, state } = useBench();
  const list = useRef(null);
  const set = (key) => (value) =>
    send({ kind: "processor", processor: of.name, key,
      value: key === "priority" && /^\d{1,3}$/.test(value ?? "") ? Number(value) : value });
  const here = drop?.to === of.name ? drop.place : null;

  function place(event) {
    const items = [...list.current.querySelectorAll(":scope > li.row")];
    const below = items.findIndex((item) => {
      const box = item.getBoundingClientRect();
      return event.clientY < box.top + box.height / 2;
    });
    return below < 0 ? items.length : below;
  }
  function over(event) {
    if (!event.dataTransfer.types.includes("text/x-row")) return;
    event.preventDefault();
    const now = place(event);
    if (here !== now) setDrop({ to: of.name, place: now });
  }
  function dropped(event) {
    const row = event.dataTransfer.getData("text/x-row");
    setDrop(null);
    if (!row) return;
    event.preventDefault();
    let target = place(event);
    const own = of.rows.findIndex((one) => one.row === row);
    if (own >= 0 && own < target) target -= 1;
    act({ kind: "move", row, to: of.name, place: target }).catch(() => {});
  }

  const missed = [of, ...of.copies].some((one) => one.met === false);
  return html`<article class="processor ${missed ? "missed" : ""}" data-processor=${of.name}
      onDragOver=${over} onDrop=${dropped}
      onDragLeave=${(event) => !event.currentTarget.contains(event.relatedTarget) && setDrop(null)}>
    <h3><${Place} at=${of} label=${of.name}>${of.name}<//>
      <span class="remark"> ${[of.node, of.released_by && `on ${of.released_by}`].filter(Boolean).join(", ")}</span>
      ${of.met !== undefined && html`<${Word} met=${of.met} text=${of.word} />`}</h3>
    <div class="settings">
      <${Field} label="Period" hidden=${false} value=${of.written.period} follows=${of.period} optional
        width="7" send=${set("period")} />
      <${Field} label="Priority" hidden=${false} value=${of.written.priority}
        follows=${of.priority === null ? "" : String(of.priority)} optional width="3" send=${set("priority")} />
      <${Field} label="Deadline" hidden=${false} value=${of.written.deadline} follows=${of.deadline} optional
        width="7" send=${set("deadline")} />
    </div>
    ${of.limit !== undefined && html`<${Response} of=${of} />`}
    ${of.copies.map((one) => html`<div key=${one.node} class="copy" data-node=${one.node}>
      <span class="remark">on ${one.node}, priority ${one.priority}</span><${Word} met=${one.met} text=${one.word} />
      <${Response} of=${one} /></div>`)}
    <ol ref=${list} aria-label="Activities of ${of.name}">
      ${of.rows.map((row, number) => html`<${Row} key=${row.row} row=${row} number=${number} of=${of}
        mark=${here === number} setDrop=${setDrop} processors=${state.processors} />`)}
      ${of.rows.length === 0 && html`<li class="empty">no activity</li>`}
      ${here === of.rows.length && html`<li class="here" aria-hidden="true"></li>`}
    </ol>
  </article>`;
}

/** The bar of a response, its bound beside the deadline, and why there is none. */
function Response({ of }) {
  const saved = of.saved !== null && of.saved !== of.bound;
  return html`<div class="response"><${Bar} of=${of} />
      <span class="number"><b>R ${time(of.bound)}</b> of ${time(of.limit)}${saved ? `, saved ${time(of.saved)}` : ""}</span></div>
    ${of.reason && html`<p class="error">${of.reason}</p>`}`;
}

/** The main program of a node, below all processors of its core; nothing of it is changed here. */
function Stream({ of }) {
  return html`<article class="processor ${of.met ? "" : "missed"}" data-stream=${of.name}>
    <h3><${Place} at=${of} label=${of.name}>${of.name}<//>
      <span class="remark"> ${of.core}, lowest priority</span><${Word} met=${of.met} text=${of.word} /></h3>
    <${Response} of=${of} />
    ${of.said.map((line) => html`<p key=${line} class="remark">${line}</p>`)}
  </article>`;
}

function Row({ row, number, of, mark, setDrop, processors }) {
  const { act, selected, select } = useBench();
  const chosen = selected === row.row;
  const move = (to, place) => act({ kind: "move", row: row.row, to, place }).catch(() => {});
  const last = of.rows.length - 1;
  function key(event) {
    if (!event.key.startsWith("Arrow") || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    if (!event.shiftKey) {
      const all = [...document.querySelectorAll(".processors .row > button")];
      const step = { ArrowUp: -1, ArrowDown: 1 }[event.key] ?? 0;
      all[all.indexOf(event.currentTarget) + step]?.focus();
      return;
    }
    act((state) => step(state, row.row, event.key), row.row).catch(() => {});
  }
  function drag(event) {
    event.dataTransfer.setData("text/x-row", row.row);
    event.dataTransfer.setData("text/plain", row.row);
    event.dataTransfer.effectAllowed = "move";
  }
  return html`${mark && html`<li class="here" aria-hidden="true"></li>`}
    <li class="row ${chosen ? "chosen" : ""}">
      <button data-row=${row.row} draggable="true" aria-expanded=${chosen}
        aria-keyshortcuts="Shift+ArrowUp Shift+ArrowDown Shift+ArrowLeft Shift+ArrowRight"
        onDragStart=${drag} onDragEnd=${() => setDrop(null)} onKeyDown=${key}
        onClick=${() => select(chosen ? null : row.row)}>
        <span class="name">${row.row}</span>
        <span class="figures">C ${row.times.wcet ?? "?"}</span>
        <span class="number">${row.response === null ? "" : `R ${time(row.response)}`}</span>
      </button>
      ${chosen && html`<${Controls} row=${row} number=${number} last=${last} of=${of} move=${move}
        processors=${processors} />`}
    </li>`;
}

/** The message that moves a row by an arrow key; null where it leads nowhere. */
function step(state, row, key) {
  const index = state.processors.findIndex((one) => one.rows.some((other) => other.row === row));
  const of = state.processors[index];
  const number = of.rows.findIndex((one) => one.row === row);
  const aside = state.processors[index + ({ ArrowLeft: -1, ArrowRight: 1 }[key] ?? 0)];
  if (!aside) return null;
  const down = { ArrowUp: -1, ArrowDown: 1 }[key] ?? 0;
  const place = Math.min(number + down, aside.rows.length - (aside === of ? 1 : 0));
  if (place < 0 || (aside === of && place === number)) return null;
  return { kind: "move", row, to: aside.name, place };
}

function Controls({ row, number, last, of, move, processors }) {
  const { send } = useBench();
  const set = (key) => (value) => send({ kind: "time", row: row.row, key, value });
  return html`<div class="controls">
    <div class="settings">${TIMES.filter(([key]) => row.settable.includes(key)).map(([key, label]) => html`<${Field}
      key=${key} label=${label} hidden=${false} width="7" value=${row.written[key] ?? (key === "wcet" ? row.times.wcet : null)}
      follows=${row.times[key]} optional=${key === "deadline"} send=${set(key)} />`)}</div>
    ${row.kind !== "receive" && html`<${Growth} row=${row.row} />`}
    <div class="moves">
      <button disabled=${number === 0} onClick=${() => move(of.name, number - 1)}>Earlier</button>
      <button disabled=${number === last} onClick=${() => move(of.name, number + 1)}>Later</button>
      <label>Move to <select value=${of.name} onChange=${(event) => {
        const to = processors.find((one) => one.name === event.target.value);
        if (to.name !== of.name) move(to.name, to.rows.length);
      }}>${processors.map((one) => html`<option key=${one.name} value=${one.name}>${one.name}</option>`)}</select></label>
      <${Place} at=${row}>Row<//>
      ${row.declared.file && html`<${Place} at=${row.declared}>Declaration<//>`}
    </div>
  </div>`;
}

/** How far the WCET may grow, found when asked. */
function Growth({ row }) {
  const { state } = useBench();
  const [found, setFound] = useState(null);
  useEffect(() => {
    let wanted = true;
    setFound(null);
    const later = setTimeout(() => {
      get("growth", { row }).then((answer) => wanted && setFound(answer.text)).catch(() => {});
    }, 300);
    return () => {
      wanted = false;
      clearTimeout(later);
    };
  }, [row, state.number]);
  return html`<p class="growth" aria-live="polite">Largest C with every limit kept: <b>${found ?? "…"}</b></p>`;
}
