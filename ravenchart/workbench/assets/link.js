// SPDX-FileCopyrightText: Ravenchart contributors
// SPDX-License-Identifier: Apache-2.0

// The link to the server: the state as a stream, and messages one after the other.
// All addresses are relative, so they begin with the token.

/** A time in ns as people read it, rounded up as the reports round it. */
export function time(ns) {
  if (ns === null || ns === undefined) return "no bound";
  if (Math.abs(ns) >= 1e6) return `${Math.ceil(ns / 1e3) / 1e3} ms`;
  return `${Math.ceil(ns / 100) / 10} us`;
}

/** What a server answers, or an Error with its text, findings and `late`. */
async function answered(response, whole = (found) => found.json()) {
  if (response.ok) return whole(response);
  const found = await response.json().catch(() => ({ error: `status ${response.status}` }));
  throw Object.assign(new Error(found.error), found, { status: response.status });
}

export async function get(path, query = {}) {
  return answered(await fetch(`${path}?${new URLSearchParams(query)}`));
}

/** Shows every state to `show`, newest last, and whether the server can be reached to `reached`. */
export class Link {
  constructor(show, reached) {
    this.number = -1;
    this.text = "";
    this.show = show;
    this.queue = Promise.resolve();
    const events = new EventSource("events");
    events.addEventListener("state", (event) => this.take(event.data));
    events.addEventListener("open", () => reached(true));
    events.addEventListener("error", () => reached(false));
  }

  /** Shows a state. A change brings it twice, as its answer and in the stream: it is drawn once.
      `again`: also the one that is shown, for people may have chosen something else. */
  take(text, again = false) {
    if (text === this.text && !again) return;
    const state = JSON.parse(text);
    if (state.number < this.number) return; // an older one that came later
    this.text = text;
    this.number = state.number;
    this.state = state;
    this.show(state);
  }

  /** Sends a message about the state that is shown when its turn comes, or what a function makes
      of that state: keys that are pressed fast are steps from there, not from what they saw. */
  act(message) {
    const sent = this.queue.then(async () => {
      const told = typeof message === "function" ? message(this.state) : message;
      if (!told) return this.state;
      const number = this.number;
      const body = JSON.stringify({ ...told, number });
      const headers = { "content-type": "application/json" };
      const posted = await fetch("act", { method: "POST", headers, body });
      this.take(await answered(posted, (found) => found.text()), this.number === number);
      return this.state;
    });
    this.queue = sent.catch(() => {});
    return sent;
  }
}
