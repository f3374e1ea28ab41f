// SPDX-FileCopyrightText: Ravenchart contributors
// SPDX-License-Identifier: Apache-2.0

// The running controllers and the bus, as `ravenchart monitor` shows them, or those of a replay: ten times a second
// while this tab is open.

import { html, useEffect, useRef, useState } from "./preact.js";
import { Word, useBench } from "./parts.js";
import { get, time } from "./link.js";
import { Plot } from "./plot.js";
import { Player, seconds } from "./player.js";
import { Responses } from "./responses.js";

const PERIOD = 100; // ms, as between two snapshots
const SHORTEST = 20; // ms between an answer and the next look
const PATIENCE = 1000; // ms until the next look where nothing runs
const LATE = 1; // s

export function Live() {
  const { setRunning } = useBench();
  const [found, setFound] = useState(null);
  const [problem, setProblem] = useState("");
  const look = useRef(null); // at once
  useEffect(() => {
    let next = 0;
    let asked = 0;
    let wanted = true;
    let shown = "[]";
    look.current = async () => {
      clearTimeout(next);
      const mine = asked += 1;
      const begun = performance.now();
      let pause = PATIENCE;
      try {
        const live = await get("live");
        if (!wanted || mine !== asked) return;
        setFound(live);
        setProblem("");
        const charts = live.nodes.flatMap((node) => node.drawn);
        if (JSON.stringify(charts) !== shown) setRunning(charts);
        shown = JSON.stringify(charts);
        if (live.replay ? live.replay.playing : live.nodes.some((node) => node.process !== null) || live.buses.length) pause = PERIOD;
      } catch (error) {
        if (wanted) setProblem(error.message);
      }
      if (wanted && mine === asked) next = setTimeout(look.current, Math.max(SHORTEST, begun + pause - performance.now()));
    };
    look.current();
    return () => { wanted = false; clearTimeout(next); setRunning([]); };
  }, []);
  if (problem) return html`<p class="error" role="alert">${problem}</p>`;
  if (!found) return html`<p role="status">Running controllers are being looked for …</p>`;
  return html`${found.replay && html`<${Player} of=${found.replay} nodes=${found.nodes.length} look=${() => look.current()} />`}
    ${found.text && html`<p>${found.text}</p>`}
    ${found.nodes.map((node) => html`<${Node} key=${node.node} of=${node} replay=${found.replay} nodes=${found.nodes.length} />`)}
    ${(found.buses ?? []).map((bus) => html`<${Bus} key=${bus.bus} of=${bus} />`)}`;
}

/** A bus: its load beside that of the analysis, and its messages with their last values. */
function Bus({ of }) {
  const faults = [["unknown", of.unknown], ["malformed", of.malformed], ["error frames", of.errors], ["missed", of.missed]].filter(([, count]) => count);
  return html`<section class="live" aria-label="Bus ${of.bus}">
    <h3>${of.bus}: ${of.interface}, ${seconds(of.now)} s ${of.gone && html`<span class=${of.ended ? "" : "error"}>${of.ended ? "" : "gone: "}${of.gone}</span>`}</h3>
    <p class=${of.bound !== null && of.load > of.bound ? "error" : ""}>load of the last second: at most ${percent(of.load)}; in the analysis: ${of.bound === null ? "-" : percent(of.bound)};
      frames: ${of.frames}${faults.map(([what, count]) => `, ${what} ${count}`).join("")}</p>
    <${Table} names=${["message", "identifier", "frames>", "last>", "shortest>", "period>", "last values"]} rows=${of.messages.map((one) => [
      one.name, one.identifier, one.frames, one.last === null ? "-" : `${((of.now - one.last) / 1e9).toFixed(1)} s ago`,
      one.shortest === null ? "-" : time(one.shortest), one.period === null ? "-" : time(one.period),
      Object.entries(one.fields).map(([name, value]) => `${name} ${value} ${one.units[name] ?? ""}`.trim()).join(", ")])} /></section>`;
}

function Node({ of, replay, nodes }) {
  const { state } = useBench();
  const late = !replay && of.process !== null && of.age > LATE;
  return html`<section class="live" aria-label="Controller of ${of.node}">
    <h3>${of.node}: ${replay ? recorded(of, nodes, replay.simulated) : running(of)}
      ${late && html`<span class="error">no news for ${of.age.toFixed(1)} s</span>`}</h3>
    ${of.real_time === false && html`<p class="remark">No real-time priorities: responses are not comparable with bounds.</p>`}
    ${!replay && (state.dirty || state.stale) && html`<p class="remark">Bounds are those of the saved model.</p>`}
    ${replay && !replay.playing && html`<p role="status">${instant(of)}</p>`}
    <${Table} names=${["processor", "due>", "completed>", "misses>", "last>", "worst>", "R>", "worst of R", "verdict"]} rows=${of.processors.map((one) => [
      one.name, one.due ?? "-", one.completed, one.misses, one.last_response === null ? "-" : time(one.last_response), time(one.worst_response), time(one.bound),
      one.bound && html`<${Share} of=${one.worst_response / one.bound} />`,
      html`<${Word} met=${one.word === "ok"} text=${one.word} />`])} />
    ${!(replay && of.counted === null) && html`<p class=${any(of.faults) ? "error" : ""}>faults: ${counts(of.faults)}</p>
    <p class=${any(of.lost) ? "error" : ""}>lost: ${counts(of.lost)}</p>`}
    ${!replay && html`<p class="remark">${of.overlooked}</p>`}
    <${Table} names=${["chart", "state", "for>", "transitions>"]} rows=${of.charts.map((one) => [
      html`<${Chart} name=${one.name} of=${of.drawn} />`, one.state ?? "-",
      one.since === null ? "-" : `${((of.now - one.since) / 1e9).toFixed(1)} s`, one.transitions])} />
    <${Table} names=${["last transitions and faults", "", "at>"]} rows=${of.last.map((one) => [
      one.element, one.kind === "fault" ? `FAULT ${one.what}` : one.what, `${seconds(one.at)} s`])} />
    <${Table} names=${["recorded value", "last>", "", "recorded>", "at>",
      `last ${Number((of.window / 1e9).toFixed(1))} s${replay ? "" : ": one value of each snapshot"}`]} rows=${of.values.map((one) => [
      one.name, one.value, one.unit, one.count, `${((of.now - one.last) / 1e9).toFixed(1)} s ago`,
      html`<${Plot} of=${of.plots[one.name]} now=${of.now} span=${of.window} name=${one.name} />`])} />
    <${Table} names=${["queue", "waiting>", "most>"]} rows=${of.queues.map((one) => [
      one.name, `${one.waiting ?? "?"} of ${one.depth}`, one.highest ?? "-"])} />
    <${Table} names=${["port, event, message", "", "count>", "last>"]} rows=${of.traffic.map((one) => [
      one.name, one.state ?? one.what, one.count, `${((of.now - one.last) / 1e9).toFixed(1)} s ago`])} />
    ${!(replay && of.counted === null) && html`<${Responses} rows=${of.responses} note=${of.responses_note} />`}
    ${of.said.map((text) => html`<p class="error">${text}</p>`)}
    <p class="remark">Not seen: ${of.not_seen.join("; ")}.</p></section>`;
}

function running(of) {
  const lives = of.process ? `process ${of.process}` : "running";
  const doing = of.ended ? "ended in order" : of.process !== null ? lives : "ENDED WITHOUT ITS REPORT";
  return `${doing}, ${seconds(of.now)} s, snapshot ${of.sequence}`;
}

function recorded(of, nodes, simulated) {
  if (of.starts !== null) return `starts at ${seconds(of.starts)} s`;
  if (simulated) return `simulated, ${seconds(of.now)} s${of.process !== null ? "" : ", the last line is here"}`;
  const end = of.process !== null ? "" : of.ended ? ", ended in order" : ", the trace was cut off here";
  const counted = of.counted === null ? "" : `, counts of ${seconds(of.counted)} s`;
  return `${seconds(of.now)} s${nodes > 1 ? " after its start" : ""}${counted}${end}`;
}

/** A response as a share of its bound. */
function Share({ of }) {
  const width = `${Math.min(100, 100 * of)}%`;
  return html`<span class="bar" role="img" aria-label="${Math.round(100 * of)} % of R"><span
    class="part ${of > 1 ? "late" : "own"}" style=${{ width }}></span></span>`;
}

/** The records of the instant that a replay shows. */
function instant(of) {
  const records = of.records.map((one) => `${one.kind} ${one.element} ${one.what}`.trim()).join("; ");
  return records ? `At this instant: ${records}` : "No record at this instant.";
}

/** The name of a region: it shows the drawing of its chart. */
function Chart({ name, of }) {
  const { setDrawing } = useBench();
  const chart = of.find((one) => name === one.name || name.startsWith(`${one.name}.`));
  if (!chart) return name;
  return html`<button class="place" title="show in the drawing ${chart.drawing}"
    onClick=${() => setDrawing({ name: chart.drawing, chart: chart.name })}>${name}</button>`;
}

/** A table; a column whose name ends in ">" is set to the right. */
function Table({ names, rows }) {
  if (!rows.length) return null;
  const side = (index) => names[index].endsWith(">") ? "number" : "";
  return html`<table><thead><tr>${names.map((name, index) => html`<th key=${index} class=${side(index)}>${name.replace(">", "")}</th>`)}</tr></thead>
    <tbody>${rows.map((row, number) => html`<tr key=${number}>${row.map((cell, index) => html`<td
      key=${index} class=${side(index)}>${cell}</td>`)}</tr>`)}</tbody></table>`;
}

const percent = (share) => `${(100 * share).toFixed(1)} %`;
const any = (found) => Object.keys(found).length > 0;
const counts = (found) => Object.entries(found).map(([what, number]) => `${what} ${number}`).join(", ") || "none";
