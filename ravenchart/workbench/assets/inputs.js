// SPDX-FileCopyrightText: Ravenchart contributors
// SPDX-License-Identifier: Apache-2.0

// Left: what may come from outside. Events and values are offered for the next release.

import { html, useState } from "./preact.js";
import { useBench } from "./parts.js";

export function Inputs() {
  const { state, chart } = useBench();
  const [name, setName] = useState(chart.instance);
  const instance = state.instances.find((one) => one.name === name) ?? state.instances[0];
  const all = [...instance.ports.map((one) => ({ ...one, port: true })), ...instance.events];
  const outer = all.filter((one) => one.outside);
  const inner = all.filter((one) => !one.outside);
  const input = (one) => html`<${Input} key=${`${instance.name} ${one.port} ${one.name}`} of=${one}
    message=${(value) => one.port ? { kind: "put", instance: instance.name, port: one.name, value }
      : { kind: "raise", instance: instance.name, event: one.name, value }} />`;
  return html`<section class="pane inputs" aria-labelledby="inputs-title">
    <h2 id="inputs-title">From outside</h2>
    <p class="remark">For the next release, at ${state.next}.</p>
    <label class="instance">Instance <select value=${instance.name} onChange=${(e) => setName(e.target.value)}>
      ${state.instances.map((one) => html`<option key=${one.name} value=${one.name}>${one.name}: ${one.component}</option>`)}
    </select></label>
    ${outer.length === 0 && html`<p class="remark">Nothing comes from outside of the model.</p>`}
    ${outer.map(input)}
    ${inner.length > 0 && html`<details><summary>What the model gives itself</summary>${inner.map(input)}</details>`}
  </section>`;
}

/** An event or port with fields for its value. */
function Input({ of, message }) {
  const verb = of.port ? "Put" : "Raise";
  const { send } = useBench();
  const [value, setValue] = useState(() => first(of.type));
  const [error, setError] = useState("");
  async function give(event) {
    event.preventDefault();
    setError("");
    try {
      await send(message(told(of.type, value)));
    } catch (problem) {
      setError(problem.message);
    }
  }
  return html`<form class="input" aria-label="${verb} ${of.name}" onSubmit=${give}>
    <div class="head"><span class="name">${of.name} <span class="remark">${of.port ? "port" : "event"}</span></span><button aria-label="${verb} ${of.name}">${verb}</button></div>
    ${of.type && html`<${Value} type=${of.type} value=${value} change=${setValue} label=${of.name} />`}
    ${error && html`<p class="error" role="alert">${error}</p>`}</form>`;
}

function Value({ type, value, change, label }) {
  if (type.kind === "record") {
    return html`<div class="fields">${type.fields.map((one) => html`<label key=${one.name}><span>${one.name}</span>
      <${Scalar} type=${one.type} value=${value[one.name]} label="${label} ${one.name}"
        change=${(part) => change({ ...value, [one.name]: part })} /></label>`)}</div>`;
  }
  return html`<div class="fields"><${Scalar} type=${type} value=${value} change=${change} label=${label} /></div>`;
}

function Scalar({ type, value, change, label }) {
  const onInput = (event) => change(event.target.value);
  if (type.kind === "enumeration") {
    return html`<select aria-label=${label} value=${value} onChange=${onInput}>
      ${type.literals.map((one) => html`<option key=${one} value=${one}>${one}</option>`)}</select>`;
  }
  const range = `${type.first} .. ${type.last}${type.unit ? ` ${type.unit}` : ""}`;
  return html`<span class="scalar"><input type="text" inputmode="numeric" size="8" aria-label=${label} value=${value}
    title=${range} autocomplete="off" onInput=${onInput} /><span class="remark">${range}</span></span>`;
}

/** The value nearest to zero, the first literal, field by field. */
function first(type) {
  if (!type) return null;
  if (type.kind === "record") return Object.fromEntries(type.fields.map((one) => [one.name, first(one.type)]));
  return type.kind === "enumeration" ? type.literals[0] : String(Math.min(Math.max(0, type.first), type.last));
}

/** A value as an event file has it; what is no whole number is refused by the server, in words. */
function told(type, value) {
  if (!type) return null;
  if (type.kind === "record") return Object.fromEntries(type.fields.map((one) => [one.name, told(one.type, value[one.name])]));
  const number = type.kind === "integer" && /^\s*-?\d{1,15}\s*$/.test(value);
  return number ? Number(value) : value.trim();
}
