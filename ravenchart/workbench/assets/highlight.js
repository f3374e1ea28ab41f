// SPDX-FileCopyrightText: Ravenchart contributors
// SPDX-License-Identifier: Apache-2.0

// What is active in a drawing of a chart, and what its last execution took.

import { plain } from "./canvas.js";

const END = /^(foot|header) /;

/** Marks the groups of a drawing. Graphviz names each group in its title: a state by its name, a
    label by `A to B`, and an edge by what it joins: `A->A to B`, or `A->B` without a label. */
export function highlight(paper, arrows, chart) {
  const active = new Set(chart.active);
  const labels = new Set();
  const lines = new Set();
  for (const name of chart.last?.taken ?? []) {
    for (const [title, line] of arrows[name] ?? []) {
      if (line) lines.add(`${title}\n${plain(line)}`);
      else labels.add(title);
    }
  }
  for (const group of paper.querySelectorAll("g.node, g.edge, g.cluster")) {
    const title = plain(group.querySelector(":scope > title")?.textContent ?? "");
    const name = title.replace(/^cluster /, "");
    const ends = title.split("->").map((one) => one.trim().replace(END, ""));
    const drawn = ends.length === 2
      && (ends.some((one) => labels.has(one)) || labels.has(ends.join(" to ")) || labels.has(ends.toReversed().join(" to ")));
    group.classList.toggle("active", ends.length === 1 && active.has(name));
    group.classList.toggle("taken", drawn);
    for (const text of group.querySelectorAll(":scope > text, :scope > g > text")) {
      text.classList.toggle("taken", lines.has(`${title}\n${plain(text.textContent)}`));
    }
  }
  const leaf = [...paper.querySelectorAll("g.node.active")].pop();
  if (leaf) reveal(leaf, paper);
}

/** Scrolls the paper, and nothing around it, so that an element can be seen. */
function reveal(element, paper) {
  const [mine, theirs] = [element.getBoundingClientRect(), paper.getBoundingClientRect()];
  if (mine.top < theirs.top || mine.bottom > theirs.bottom) {
    paper.scrollTop += (mine.top + mine.bottom - theirs.top - theirs.bottom) / 2;
  }
  if (mine.left < theirs.left || mine.right > theirs.right) {
    paper.scrollLeft += (mine.left + mine.right - theirs.left - theirs.right) / 2;
  }
}
