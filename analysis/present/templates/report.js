// SPDX-FileCopyrightText: Ravenchart contributors
// SPDX-License-Identifier: Apache-2.0

"use strict";
// Sorts and filters the tables. Without it the report says the same, in its own order.

const LONG = 8; // from so many rows on a table gets a filter

// A row of the table, with the rows of its activities below it.
function groups(body) {
  const found = [];
  for (const row of body.rows) {
    if (row.classList.contains("activity") && found.length) found[found.length - 1].push(row);
    else found.push([row]);
  }
  return found;
}

// What a cell sorts by: its exact time, its first number, or its text; "-" comes first.
function key(row, column) {
  const cell = row.cells[column];
  const text = cell ? cell.textContent.trim() : "";
  const exact = cell && cell.querySelector("data");
  if (exact) return [1, Number(exact.value), text];
  if (cell && cell.classList.contains("n")) {
    const number = Number.parseInt(text, 16) && text.startsWith("0x") ? Number(text) : parseFloat(text);
    return Number.isNaN(number) ? [0, 0, text] : [1, number, text];
  }
  return [0, 0, text];
}

function compared(a, b) {
  return a[0] - b[0] || a[1] - b[1] || a[2].localeCompare(b[2], "en", { numeric: true });
}

function sorted(table, heading) {
  const down = heading.getAttribute("aria-sort") === "ascending";
  for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
  heading.setAttribute("aria-sort", down ? "descending" : "ascending");
  const body = table.tBodies[0];
  const order = groups(body).map((rows) => [key(rows[0], heading.cellIndex), rows]);
  order.sort((a, b) => (down ? compared(b[0], a[0]) : compared(a[0], b[0])));
  for (const [, rows] of order) body.append(...rows);
}

function filtered(table, wanted) {
  const words = wanted.toLowerCase().split(/\s+/).filter(Boolean);
  for (const rows of groups(table.tBodies[0])) {
    const text = rows.map((row) => row.textContent.toLowerCase()).join(" ");
    const shown = words.every((word) => text.includes(word));
    for (const row of rows) row.hidden = !shown;
  }
}

for (const table of document.querySelectorAll("table")) {
  const count = groups(table.tBodies[0]).length;
  if (count < 2) continue;
  for (const heading of table.tHead.rows[0].cells) {
    if (!heading.textContent.trim()) continue;
    const button = document.createElement("button");
    button.type = "button";
    button.title = "sort by this column";
    button.append(...heading.childNodes);
    button.addEventListener("click", () => sorted(table, heading));
    heading.append(button);
  }
  if (count < LONG) continue;
  const filter = document.createElement("input");
  filter.type = "search";
  filter.placeholder = "filter rows";
  filter.setAttribute("aria-label", "filter rows");
  filter.addEventListener("input", () => filtered(table, filter.value));
  table.before(filter);
}
