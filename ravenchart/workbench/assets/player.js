// SPDX-FileCopyrightText: Ravenchart contributors
// SPDX-License-Identifier: Apache-2.0

// How the time of a replay goes on: the clock is in the server, so all pages show the same instant.

import { html, useRef, useState } from "./preact.js";
import { useBench } from "./parts.js";

export const seconds = (ns) => (ns / 1e9).toFixed(3);

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10];
const STEPS = [["event", "transition or fault"], ["value", "recorded value"], ["record", "record"]];

/** `look` shows the instant at once, also while time rests. */
export function Player({ of, nodes, look }) {
  const { send } = useBench();
  const [problem, setProblem] = useState("");
  const [chosen, setChosen] = useState(null);
  const [moved, setMoved] = useState(null); // where the slider is, while it is moved
  const [typed, setTyped] = useState("");
  const seeking = useRef({ busy: false, next: null });
  const there = STEPS.filter(([name]) => of.steps[name] > 0);
  const what = chosen ?? there[0]?.[0] ?? "record";
  const at = moved ?? of.at;

  async function act(message) {
    setProblem("");
    try {
      await send(message);
    } catch (error) {
      setProblem(error.message);
    }
    await look();
  }
  async function seek(wanted) {
    const now = seeking.current;
    now.next = wanted;
    if (now.busy) return; // a slider moves faster than what it shows: the newest instant counts
    now.busy = true;
    while (now.next !== null) {
      const next = now.next;
      now.next = null;
      await act({ kind: "seek", at: next });
    }
    now.busy = false;
    setMoved(null);
  }
  function slide(event) {
    const wanted = Math.min(of.end, Math.round(Number(event.target.value) * 1e6));
    setMoved(wanted);
    seek(wanted);
  }
  function key(event) {
    if (event.key !== " ") return;
    event.preventDefault();
    act({ kind: of.playing ? "pause" : "play" });
  }
  function go(event) {
    event.preventDefault();
    const wanted = Number(typed.replace(",", "."));
    if (typed.trim() === "" || !(wanted >= 0)) setProblem("an instant is a number of seconds, such as 1.25");
    else seek(Math.round(wanted * 1e9));
  }
  return html`<div class="player" role="group" aria-label="Replay">
    <div class="bar-of-tools">
      <button class="main" onClick=${() => act({ kind: of.playing ? "pause" : "play" })}>${of.playing ? "Pause" : "Play"}</button>
      <label>Speed <select value=${of.speed} onChange=${(e) => act({ kind: "speed", speed: Number(e.target.value) })}>
        ${SPEEDS.map((one) => html`<option key=${one} value=${one}>${one} ×</option>`)}</select></label>
      <button onClick=${() => act({ kind: "previous", what })}>Previous</button>
      <label><span class="unseen">Step to</span><select value=${what} onChange=${(e) => setChosen(e.target.value)}>${STEPS.map(
        ([name, text]) => html`<option key=${name} value=${name}>${text} (${of.steps[name]})</option>`)}</select></label>
      <button onClick=${() => act({ kind: "next", what })}>Next</button>
    </div>
    <div class="bar-of-tools">
      <div class="track"><input type="range" aria-label="Instant" min="0" max=${of.end / 1e6} step="any" value=${at / 1e6}
        aria-valuetext="${seconds(at)} s" onInput=${slide} onKeyDown=${key} />
        ${of.gaps.map((gap, index) => html`<i key=${index} style=${{ left: `${100 * gap.after / of.end}%`,
          width: `${100 * (gap.until - gap.after) / of.end}%` }}></i>`)}</div>
      <span class="clock number">${seconds(at)} s of ${seconds(of.end)} s</span>
      <form onSubmit=${go}><label><span class="unseen">Go to, in s</span><input type="text" size="4" value=${typed} placeholder="s"
        inputmode="decimal" spellcheck="false" autocomplete="off" onInput=${(e) => setTyped(e.target.value)} /></label>
        <button>Go</button></form>
    </div>
    ${problem && html`<p class="error" role="alert">${problem}</p>`}
    ${of.gaps.length > 0 && html`<${Gaps} of=${of} nodes=${nodes} />`}
    ${of.said.map((one, index) => html`<p key=${index} class="error">${nodes > 1 ? `${one.node}: ` : ""}The controller said: ${one.text}</p>`)}
    ${of.cut.map((node) => html`<p key=${node} class="error">The trace of ${node} was cut off: the counts of its end are missing.</p>`)}
  </div>`;
}

/** What was lost around the instant, or next after it. */
function Gaps({ of, nodes }) {
  const words = { trace: "trace records", values: "recorded values" };
  const whole = of.gaps.reduce((sum, gap) => sum + gap.count, 0);
  const here = of.gaps.filter((gap) => gap.after <= of.at && of.at <= gap.until);
  return html`<p class="error">The trace has gaps (red): ${whole} records were lost.
    ${here.map((gap) => ` Here ${gap.count} ${words[gap.what]}${nodes > 1 ? ` of ${gap.node}` : ""}, between ${seconds(gap.after)} s
      and ${seconds(gap.until)} s.`)}</p>`;
}
