// The running controllers, as `ravenchart monitor` shows them: ten times a second while this tab is open.

import { html, useEffect, useState } from "./preact.js";
import { Word, useBench } from "./parts.js";
import { get, time } from "./link.js";

const PERIOD = 100; // ms, as between two snapshots
const PATIENCE = 1000; // ms until the next look where nothing runs
const LATE = 1; // s

export function Live() {
  const [found, setFound] = useState(null);
  const [problem, setProblem] = useState("");
  useEffect(() => {
    let next = 0;
    let wanted = true;
    async function look() {
      let pause = PATIENCE;
      try {
        const live = await get("live");
        if (!wanted) return;
        setFound(live);
        setProblem("");
        if (live.nodes.some((node) => node.process !== null)) pause = PERIOD;
      } catch (error) {
        if (wanted) setProblem(error.message);
      }
      if (wanted) next = setTimeout(look, pause);
    }
    look();
    return () => { wanted = false; clearTimeout(next); };
  }, []);
  if (problem) return html`<p class="error" role="alert">${problem}</p>`;
  if (!found) return html`<p role="status">Running controllers are being looked for …</p>`;
  return html`${found.text && html`<p>${found.text}</p>`}
    ${found.nodes.map((node) => html`<${Node} key=${node.node} of=${node} />`)}`;
}

function Node({ of }) {
  const { state } = useBench();
  const doing = of.process !== null ? `process ${of.process}` : of.ended ? "ended in order" : "ENDED WITHOUT ITS REPORT";
  const late = of.process !== null && of.age > LATE;
  return html`<section class="live" aria-label="Controller of ${of.node}">
    <h3>${of.node}: ${doing}, ${seconds(of.now)} s, snapshot ${of.sequence}
      ${late && html`<span class="error">no news for ${of.age.toFixed(1)} s</span>`}</h3>
    ${of.real_time === false && html`<p class="remark">No real-time priorities: responses are not comparable with bounds.</p>`}
    ${(state.dirty || state.stale) && html`<p class="remark">Bounds are those of the saved model.</p>`}
    <${Table} names=${["processor", "due>", "completed>", "misses>", "worst>", "R>", "verdict"]} rows=${of.processors.map((one) => [
      one.name, one.due ?? "-", one.completed, one.misses, time(one.worst_response), time(one.bound),
      html`<${Word} met=${one.word === "ok"} text=${one.word} />`])} />
    <p class=${any(of.faults) ? "error" : ""}>faults: ${counts(of.faults)}</p>
    <p class=${any(of.lost) ? "error" : ""}>lost: ${counts(of.lost)}</p>
    <${Table} names=${["chart", "state", "for>", "transitions>"]} rows=${of.charts.map((one) => [
      one.name, one.state ?? "-", one.since === null ? "-" : `${((of.now - one.since) / 1e9).toFixed(1)} s`, one.transitions])} />
    <${Table} names=${["last transitions and faults", "", "at>"]} rows=${of.last.map((one) => [
      one.element, one.kind === "fault" ? `FAULT ${one.what}` : one.what, `${seconds(one.at)} s`])} />
    <${Table} names=${["queue", "waiting>"]} rows=${of.queues.map((one) => [one.name, `${one.waiting ?? "?"} of ${one.depth}`])} />
    <${Table} names=${["port, event, message", "", "count>", "last>"]} rows=${of.traffic.map((one) => [
      one.name, one.state ?? one.what, one.count, `${((of.now - one.last) / 1e9).toFixed(1)} s ago`])} />
    <${Table} names=${["recorded value", "last>", "", "recorded>", "at>"]} rows=${of.values.map((one) => [
      one.name, one.value, one.unit, one.count, `${((of.now - one.last) / 1e9).toFixed(1)} s ago`])} />
    <p class="remark">Not seen: ${of.not_seen.join("; ")}.</p></section>`;
}

/** A table; a column whose name ends in ">" is set to the right. */
function Table({ names, rows }) {
  if (!rows.length) return null;
  const side = (index) => names[index].endsWith(">") ? "number" : "";
  return html`<table><thead><tr>${names.map((name, index) => html`<th key=${index} class=${side(index)}>${name.replace(">", "")}</th>`)}</tr></thead>
    <tbody>${rows.map((row, number) => html`<tr key=${number}>${row.map((cell, index) => html`<td
      key=${index} class=${side(index)}>${cell}</td>`)}</tr>`)}</tbody></table>`;
}

const seconds = (ns) => (ns / 1e9).toFixed(3);
const any = (found) => Object.keys(found).length > 0;
const counts = (found) => Object.entries(found).map(([what, number]) => `${what} ${number}`).join(", ") || "none";
