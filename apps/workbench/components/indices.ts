// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import { GraspIndex } from "../types";
import { Markup, html } from "./markup";
import { nothing, shortNumber } from "./numbers";
import { emptyCell, numbers, rowHead, table, valueCell, words } from "./tables";

const headings: { [group: string]: string } = {
  grip: "Grip: how firm, how even, in balance",
  stability: "Stability: how firmly it sits",
  ease: "Ease: how natural the posture is",
  fitness: "Fitness: how well the shapes agree",
  comfort: "Comfort: pressure against what people bear",
  effort: "Effort: what the muscles have to do",
  reach: "Reach: what the fingers get to",
};

function heading(group: string): string {
  return headings[group] || group;
}

const units: { [unit: string]: string } = { "": "", mm2: " mm²", mm3: " mm³", deg: "°" };

function indexCell(index: GraspIndex | undefined): Markup {
  if (!index || index.value === null) return emptyCell();
  const unit = units[index.unit];
  return valueCell(index.value, shortNumber(index.value) + (unit === undefined ? " " + index.unit : unit));
}

function better(index: GraspIndex): string {
  return index.better === "up" ? "↑ more is better" : index.better === "down" ? "↓ less is better" : nothing;
}

function range(index: GraspIndex): string {
  const { lowest, highest } = index;
  if (lowest === null) return highest === null ? nothing : "up to " + shortNumber(highest);
  return highest === null ? "from " + shortNumber(lowest) : shortNumber(lowest) + " to " + shortNumber(highest);
}

/// `lastRemark`: of the row above, not said twice.
function row(index: GraspIndex, lastRemark: string): Markup {
  return html`<tr data-index="${index.key}">${rowHead(html`<details><summary>${index.name}</summary><p>${index.definition}.</p>${index.source && html`<p>Source: ${index.source}.</p>`}<p>Key: <code>${index.key}</code></p></details>${index.remark !== lastRemark && index.remark && html`<span class="range">${index.remark}</span>`}`)}${indexCell(index)}<td>${range(index)}</td><td>${better(index)}</td></tr>`;
}

/// Groups in the order in which they appear first.
function groupsOf(indices: GraspIndex[]): string[] {
  const groups: string[] = [];
  for (const one of indices) if (groups.indexOf(one.group) < 0) groups.push(one.group);
  return groups;
}

/// A table per group; names unfold to definitions.
export function indexSection(indices: GraspIndex[]): Markup | null {
  if (indices.length === 0) return null;
  const tables = groupsOf(indices).map((group) => {
    let remark = "";
    const rows = indices.filter((one) => one.group === group).map((one) => {
      const made = row(one, remark);
      remark = one.remark;
      return made;
    });
    return table({
      caption: heading(group),
      className: "indices",
      columns: [words("Index"), numbers("Value"), words("Possible range"), words("Better")],
      rows,
    });
  });
  return html`<h3>Indices of this grasp</h3>
<p>They are never added up to one number, and those of different groups can't be weighed against each other. Open a name for its definition and source.</p>
${tables}`;
}

/// A column per product; nothing for one product or without indices.
export function indexComparison(names: string[], indices: GraspIndex[][]): Markup | null {
  if (names.length < 2) return null;
  const known: { [key: string]: true } = {};
  const all: GraspIndex[] = [];
  for (const product of indices) {
    for (const one of product) {
      if (known[one.key]) continue;
      known[one.key] = true;
      all.push(one);
    }
  }
  if (all.length === 0) return null;
  const rows = groupsOf(all).map((group) => {
    const members = all.filter((one) => one.group === group).map((one) => {
      const cells = indices.map((product) => indexCell(product.filter((other) => other.key === one.key)[0]));
      return html`<tr data-index="${one.key}">${rowHead(one.name)}${cells}<td>${better(one)}</td></tr>`;
    });
    return html`<tr><th scope="rowgroup" colspan="${names.length + 2}"><strong>${heading(group)}</strong></th></tr>${members}`;
  });
  return table({
    caption: "Indices side by side",
    columns: [words("Index"), ...names.map(numbers), words("Better")],
    rows,
  });
}
