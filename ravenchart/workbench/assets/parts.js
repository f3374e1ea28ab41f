// SPDX-FileCopyrightText: Ravenchart contributors
// SPDX-License-Identifier: Apache-2.0

// Parts that several panes of the page have in common.

import { createContext, html, useContext, useEffect, useRef, useState } from "./preact.js";

/** What every pane can use: the state, `act` (a refusal is shown above), `send` (it is thrown),
    `show` (a location), the selected row, the drawing, and the charts that run. */
export const Bench = createContext(null);
export const useBench = () => useContext(Bench);

/** A button that shows a location in the source. */
export function Place({ at, children, label }) {
  const { show } = useBench();
  const title = `${at.file}:${at.line}`;
  return html`<button class="place" title=${title} aria-label=${label ? `${label}, source ${title}` : null}
    onClick=${() => show(at)}>${children}</button>`;
}

/** The arrow keys of a row of tabs, whose entries begin with their names: the next one is shown. */
export const tabKeys = (tabs, tab, setTab) => (event) => {
  const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
  if (!step) return;
  const now = tabs.findIndex(([name]) => name === tab);
  const next = tabs[(now + step + tabs.length) % tabs.length][0];
  setTab(next);
  document.getElementById(`tab-${next}`)?.focus();
};

/** A value that people may change: Enter or leaving the field sends it, Escape takes it back.
    What follows from other values is shown as a placeholder. */
export function Field({ label, value, follows, width = 8, optional = false, send, hidden = true }) {
  const [text, setText] = useState(value ?? "");
  const [error, setError] = useState("");
  const last = useRef(value ?? "");
  useEffect(() => {
    last.current = value ?? "";
    setText(value ?? "");
    setError("");
  }, [value]);
  async function commit(event) {
    const wanted = event.currentTarget.value.trim(); // `text` may be of before the last key
    if (wanted === last.current) return;
    if (wanted === "" && !optional) return void setText(last.current);
    try {
      await send(wanted === "" ? null : wanted);
      setError("");
    } catch (problem) {
      setError(problem.message);
    }
  }
  function key(event) {
    if (event.key === "Enter") commit(event);
    if (event.key === "Escape") {
      setText(last.current);
      setError("");
    }
    event.stopPropagation();
  }
  return html`<span class="field ${error ? "wrong" : ""}"><label><span class=${hidden ? "unseen" : ""}>${label}</span>
    <input type="text" size=${width} value=${text} placeholder=${follows ?? ""} spellcheck="false"
      autocomplete="off" aria-invalid=${error ? "true" : null} onInput=${(e) => setText(e.target.value)}
      onBlur=${commit} onKeyDown=${key} /></label>
    ${error && html`<span class="error" role="alert">${error}</span>`}</span>`;
}

/** A response against its deadline; the line across is the saved state's. */
export function Bar({ of }) {
  if (of.bound === null) return html`<span class="bar none" role="img" aria-label="no bound"></span>`;
  const moved = of.saved !== null && of.saved !== of.bound;
  const text = `response ${of.bound_text} us of ${of.limit_text} us`;
  return html`<span class="bar" role="img" aria-label=${text}>
    ${of.bar.map((part) => html`<span key=${part.kind} class="part ${part.kind}" title=${part.kind}
      style=${{ width: `${part.share}%` }}></span>`)}
    <span class="deadline" style=${{ left: `${of.deadline_at}%` }}></span>
    ${moved && html`<span class="saved" style=${{ left: `${of.saved_at}%` }}></span>`}</span>`;
}

/** A word for a verdict, never by colour alone. */
export function Word({ met, text }) {
  return html`<span class="word ${met ? "ok" : "bad"}">${text ?? (met ? "ok" : "MISS")}</span>`;
}

/** Which way a key goes through the states: "undo", "redo", or null; not while somebody types. */
export function rewind(event) {
  if (!(event.ctrlKey || event.metaKey) || event.altKey) return null;
  if (event.target instanceof HTMLInputElement) return null;
  const name = event.key.toLowerCase();
  if (name === "y" || (name === "z" && event.shiftKey)) return "redo";
  return name === "z" ? "undo" : null;
}
