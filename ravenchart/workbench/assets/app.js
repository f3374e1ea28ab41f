// SPDX-FileCopyrightText: Ravenchart contributors
// SPDX-License-Identifier: Apache-2.0

// The workbench: one state from the server, shown in three panes.

import { html, render, useEffect, useLayoutEffect, useRef, useState } from "./preact.js";
import { Components } from "./components.js";
import { Drawing } from "./drawing.js";
import { Finding, Outcomes } from "./outcomes.js";
import { Processors } from "./processors.js";
import { Bench, rewind } from "./parts.js";
import { Link, get } from "./link.js";

function App() {
  const [state, setState] = useState(null);
  const [reached, setReached] = useState(true);
  const [problem, setProblem] = useState("");
  const [selected, setSelected] = useState(null);
  const [tab, setTab] = useState(null); // null: none was chosen
  const [drawing, setDrawing] = useState({ name: "structure", chart: null }); // chart: of which instance
  const [running, setRunning] = useState([]); // the charts that Live shows, with what is active
  const [at, setAt] = useState(null);
  const [saving, setSaving] = useState(false);
  const link = useRef(null);
  const moved = useRef(null); // the row that gets the focus back when it has moved
  const wasMet = useRef(true);

  useEffect(() => {
    link.current = new Link(setState, setReached);
  }, []);
  useEffect(() => {
    if (!state) return;
    document.title = `${state.dirty ? "• " : ""}${state.system}: workbench`;
    if (wasMet.current && !state.met) setTab("findings");
    wasMet.current = state.met;
  }, [state]);
  useLayoutEffect(() => { // before the next key comes
    if (moved.current && document.activeElement === document.body) { // its element was replaced
      document.querySelector(`.processors [data-row="${CSS.escape(moved.current)}"]`)?.focus();
    }
  }, [state]);

  async function act(message, row = message.row) {
    setProblem("");
    try {
      if (row) moved.current = row;
      return await link.current.act(message);
    } catch (error) {
      setProblem(error.message);
      throw error;
    }
  }
  const quietly = (message) => act(message).catch(() => {});
  function show(place) {
    setAt(place);
    setTab("source");
  }
  useEffect(() => {
    function key(event) {
      const way = rewind(event);
      if (way) {
        event.preventDefault();
        quietly({ kind: way });
      } else if ((event.ctrlKey || event.metaKey) && !event.altKey && event.key.toLowerCase() === "s") {
        event.preventDefault();
        setSaving(true);
      }
    }
    const elsewhere = () => { moved.current = null; };
    window.addEventListener("keydown", key);
    window.addEventListener("pointerdown", elsewhere);
    return () => {
      window.removeEventListener("keydown", key);
      window.removeEventListener("pointerdown", elsewhere);
    };
  }, []);

  if (!state) return html`<main class="waiting"><h1>Ravenchart workbench</h1>
    <p role="status">${reached ? "The model is being analysed." : "The workbench cannot be reached."}</p></main>`;
  const shown = tab ?? (state.replay ? "live" : "findings");
  const send = (message) => link.current.act(message); // whoever asks shows what is refused
  const bench = { state, act, send, show, selected, select: setSelected, drawing, setDrawing, running, setRunning };
  return html`<${Bench.Provider} value=${bench}>
    <${Header} quietly=${quietly} save=${() => setSaving(true)} setTab=${setTab} />
    <div class="banners">
      ${!reached && html`<p class="banner bad" role="alert">The workbench has ended or cannot be reached. Start it
        again, and open the address that it prints.</p>`}
      ${state.outside.length > 0 && html`<div class="banner warn" role="alert">
        <p><b>${state.outside.join(", ")}</b> changed on the disk while there are changes here. Nothing is overwritten.</p>
        <button onClick=${() => quietly({ kind: "take" })}>Show the files on the disk</button>
        <button onClick=${() => quietly({ kind: "keep" })}>Keep my changes</button>
        <p class="remark">Undo brings your changes back. If you keep them, the diff shows what a save would take back.</p></div>`}
      ${state.stale && html`<p class="banner bad" role="alert">The model has errors, see Findings. Figures and drawings are
        those of the last state without errors.</p>`}
      ${problem && html`<p class="banner bad" role="alert">${problem}
        <button onClick=${() => setProblem("")}>Close</button></p>`}
    </div>
    <main class="panes">
      <${Components} />
      <div class="middle ${shown === "live" ? "moving" : ""}"><${Drawing} /><${Outcomes} tab=${shown} setTab=${setTab} at=${at} /></div>
      <${Processors} />
    </main>
    ${saving && html`<${SaveDialog} close=${() => setSaving(false)} act=${link.current} />`}
  <//>`;
}

function Header({ quietly, save, setTab }) {
  return html`<${Bench.Consumer}>${({ state }) => html`<header>
    <h1>${state.system}</h1><span class="remark model"><bdi>${state.model}</bdi></span>
    <button class="verdict ${state.met ? "ok" : "bad"}" onClick=${() => setTab("findings")}
      ><span aria-live="polite">${state.verdict.replace(`${state.system}: `, "")}</span></button>
    <span class="gap"></span>
    <button disabled=${state.undo === null} title=${state.undo ?? "nothing to undo"}
      onClick=${() => quietly({ kind: "undo" })}>Undo</button>
    <button disabled=${state.redo === null} title=${state.redo ?? "nothing to redo"}
      onClick=${() => quietly({ kind: "redo" })}>Redo</button>
    <button class="main" disabled=${!state.dirty} onClick=${save}>Save …</button>
  </header>`}<//>`;
}

/** Shows the diff; saves when that is wanted. */
function SaveDialog({ close, act }) {
  const dialog = useRef(null);
  const [diff, setDiff] = useState(null);
  const [refusal, setRefusal] = useState(null);
  const [busy, setBusy] = useState(false);
  useEffect(() => {
    dialog.current.showModal();
    get("diff").then((found) => setDiff(found.diff)).catch((error) => setRefusal(error));
  }, []);
  async function save(late) {
    setBusy(true);
    try {
      await act.act({ kind: "save", late });
      dialog.current.close();
    } catch (error) {
      setRefusal(error);
    }
    setBusy(false);
  }
  return html`<dialog ref=${dialog} aria-labelledby="save-title" onClose=${close}>
    <h2 id="save-title">Save</h2>
    <div class="diff" tabindex="0" role="group" aria-label="Differences">${(diff ?? "").split("\n").map((line, index) => html`<div
      key=${index} class=${kind(line)}>${line || " "}</div>`)}</div>
    ${diff === "" && html`<p>The files are as on the disk.</p>`}
    ${refusal && html`<div role="alert"><p class="error"><b>${refusal.message}.</b></p>
      <ul class="findings">${(refusal.findings ?? []).map((one, index) => html`<${Finding} key=${index} of=${one} />`)}</ul></div>`}
    ${busy && html`<p role="status">The model is being checked …</p>`}
    <div class="answers">
      ${refusal?.late && html`<button disabled=${busy} onClick=${() => save(true)}>Save all the same</button>`}
      <button class="main" disabled=${busy || !diff || refusal} onClick=${() => save(false)}>Save</button>
      <button onClick=${() => dialog.current.close()}>Cancel</button>
    </div>
  </dialog>`;
}

function kind(line) {
  if (line.startsWith("+++") || line.startsWith("---")) return "file";
  return { "+": "added", "-": "removed", "@": "place" }[line[0]] ?? "";
}

render(html`<${App} />`, document.getElementById("app"));
