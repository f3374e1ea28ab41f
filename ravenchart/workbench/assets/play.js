// SPDX-FileCopyrightText: Ravenchart contributors
// SPDX-License-Identifier: Apache-2.0

// Charts in motion: one situation from the server, shown as drawing, reasons, values and trace.

import { html, render, useEffect, useRef, useState } from "./preact.js";
import { Canvas } from "./canvas.js";
import { highlight } from "./highlight.js";
import { Inputs } from "./inputs.js";
import { Reasons, Recording, Situation, Trace } from "./situation.js";
import { Bench, rewind, tabKeys, useBench } from "./parts.js";
import { Link } from "./link.js";

function App() {
  const [state, setState] = useState(null);
  const [reached, setReached] = useState(true);
  const [problem, setProblem] = useState("");
  const [name, setName] = useState(null);
  const [tab, setTab] = useState("reasons");
  const [busy, setBusy] = useState(0); // acts under way
  const link = useRef(null);
  const chart = state?.charts.find((one) => one.name === name) ?? state?.charts[0];
  const shown = useRef(null); // the chart, for keys
  shown.current = chart?.name;

  useEffect(() => {
    link.current = new Link(setState, setReached);
  }, []);
  useEffect(() => {
    if (state) document.title = `${state.now ?? "start"}: ${state.system}`;
  }, [state]);

  async function act(message) {
    setProblem("");
    setBusy((count) => count + 1);
    try {
      return await link.current.act(message);
    } catch (error) {
      setProblem(error.message);
      return null;
    } finally {
      setBusy((count) => count - 1);
    }
  }
  useEffect(() => {
    function key(event) {
      const way = rewind(event);
      if (way) act({ kind: way });
      else if (event.key === "F8") act({ kind: "execution", chart: shown.current });
      else if (event.key === "F9") act({ kind: event.shiftKey ? "time_out" : "firing", chart: shown.current });
      else return;
      event.preventDefault();
    }
    window.addEventListener("keydown", key);
    return () => window.removeEventListener("keydown", key);
  }, []);

  if (!state) return html`<main class="waiting"><h1>Ravenchart</h1>
    <p role="status">${reached ? "The model is being read." : "The page has no connection to ravenchart simulate."}</p></main>`;
  const names = state.charts.map((one) => ({ key: one.name, text: one.name }));
  const send = (message) => link.current.act(message); // whoever asks shows what is refused
  return html`<${Bench.Provider} value=${{ state, act, send, chart }}>
    <header>
      <h1>${state.system}</h1><span class="remark model"><bdi>${state.model}</bdi></span>
      <span class="clock number" role="status">${state.now === null ? "not started" : `executed up to ${state.now}`}</span>
      <span class="remark number">next release ${state.next}</span>
      ${busy > 0 && html`<span class="busy remark">executing …</span>`}
      <span class="gap"></span>
      <button disabled=${state.undo === null} title=${state.undo ?? "nothing to undo"}
        onClick=${() => act({ kind: "undo" })}>Undo</button>
      <button disabled=${state.redo === null} title=${state.redo ?? "nothing to redo"}
        onClick=${() => act({ kind: "redo" })}>Redo</button>
    </header>
    <div>
      ${!reached && html`<p class="banner bad" role="alert">The page has no connection: ravenchart simulate has ended.</p>`}
      ${problem && html`<p class="banner bad" role="alert">${problem}
        <button onClick=${() => setProblem("")}>Close</button></p>`}
      ${state.remark && html`<p class="banner warn" role="status">${state.remark}</p>`}
      ${state.warning && html`<p class="banner warn">${state.warning}. Raise their events by hand; data that they write
        keep their values.</p>`}
    </div>
    <main class="panes play">
      <${Inputs} key=${chart.instance} />
      <div class="middle">
        <${Canvas} names=${names} chosen=${chart.drawing} selected=${chart.name} choose=${setName} version=${0} least=${0.7}
          marks=${state.number + chart.name} finish=${(paper, made) => highlight(paper, made.arrows, chart)}>
          <${Time} /><//>
        <${Outcome} tab=${tab} setTab=${setTab} />
      </div>
      <${Situation} />
    </main>
  <//>`;
}

/** How time goes on. */
function Time() {
  const { state, act, chart } = useBench();
  const [text, setText] = useState("100 ms");
  const go = (kind) => act({ kind, chart: chart.name });
  function wait(event) {
    event.preventDefault();
    act({ kind: "wait", duration: text });
  }
  return html`<div class="bar-of-tools time" role="group" aria-label="Time">
    <button class="main" title="F8" onClick=${() => go("execution")}>One execution</button>
    <button title="F9" onClick=${() => go("firing")}>Until it fires</button>
    <button title="Shift+F9" disabled=${!chart.timers.length} onClick=${() => go("time_out")}>Until a time-out</button>
    <form onSubmit=${wait}><label><span class="unseen">Duration</span><input type="text" size="8" value=${text}
      spellcheck="false" autocomplete="off" onInput=${(e) => setText(e.target.value)} /></label>
      <button>Wait</button></form>
    ${state.waiting > 0 && html`<span class="remark">${state.waiting} waiting for the release at ${state.next}</span>`}
  </div>`;
}

function Outcome({ tab, setTab }) {
  const tabs = [["reasons", "Last execution", Reasons], ["trace", "Trace", Trace], ["file", "Event file", Recording]];
  const Shown = tabs.find(([name]) => name === tab)[2];
  return html`<section class="pane outcomes" aria-label="Outcome">
    <div role="tablist" aria-label="Outcome" onKeyDown=${tabKeys(tabs, tab, setTab)}>${tabs.map(([name, label]) => html`<button
      key=${name} id="tab-${name}" role="tab" aria-selected=${name === tab} aria-controls="outcome"
      tabindex=${name === tab ? 0 : -1} onClick=${() => setTab(name)}>${label}</button>`)}</div>
    <div id="outcome" role="tabpanel" aria-labelledby="tab-${tab}" tabindex="0"><${Shown} /></div>
  </section>`;
}

render(html`<${App} />`, document.getElementById("app"));
