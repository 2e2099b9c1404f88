// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// A page in inches and pounds: numbers before a unit, and columns of tables whose head ends in one.
// The chart of the first screen changes with them. Pictures, other charts and coordinates of the
// product keep the units that stand beside them.

import { converted, headed, inUsUnits, units } from "./unit_words";

function textsIn(root: Element): Text[] {
  const walker = document.createTreeWalker(root, NodeFilter.SHOW_TEXT, {
    acceptNode: (node) => node.parentElement?.closest("script,style,svg,code,pre,h1,.project,.view-says")
      ? NodeFilter.FILTER_REJECT : NodeFilter.FILTER_ACCEPT,
  });
  const found: Text[] = [];
  while (walker.nextNode()) found.push(walker.currentNode as Text);
  return found;
}

/// The unit of every column of a table with one simple row of heads.
function columnUnits(table: HTMLTableElement): (string | null)[] {
  const rows = table.tHead?.rows;
  if (!rows || rows.length !== 1) return [];
  return [...rows[0].cells].map((head) => headed.exec((head.textContent ?? "").trim())?.[1] ?? null);
}

const before = new Map<Text, string>();

/// A small chart of one unit: its title and the numbers at its bars.
function changeChart(chart: SVGElement, comma: boolean): void {
  const metric = chart.dataset.unit ?? "";
  if (!units[metric]) return;
  for (const text of chart.querySelectorAll("text")) {
    const node = text.firstChild;
    if (!(node instanceof Text)) continue;
    change(node, text.dataset.value !== undefined
      ? converted(node.data, units[metric].factor, comma)
      : node.data.replace(headed, (end) => end.replace(metric, units[metric].name)));
  }
}

function change(node: Text, text: string): void {
  if (text === node.data) return;
  if (!before.has(node)) before.set(node, node.data);
  node.data = text;
}

export function showUsUnits(comma: boolean): void {
  for (const table of document.querySelectorAll<HTMLTableElement>("table")) {
    const columns = columnUnits(table);
    columns.forEach((metric, c) => {
      if (!metric) return;
      for (const node of textsIn(table.tHead?.rows[0].cells[c] as Element)) {
        change(node, node.data.replace(headed, (end) => end.replace(metric, units[metric].name)));
      }
      for (const body of table.tBodies) {
        for (const row of body.rows) {
          if (row.cells.length !== columns.length) continue;
          for (const node of textsIn(row.cells[c])) change(node, converted(node.data, units[metric].factor, comma));
        }
      }
    });
  }
  for (const chart of document.querySelectorAll<SVGElement>("svg[data-unit]")) changeChart(chart, comma);
  for (const node of textsIn(document.body)) {
    if (!before.has(node)) change(node, inUsUnits(node.data, comma));
  }
}

export function showMetricUnits(): void {
  for (const [node, text] of before) node.data = text;
  before.clear();
}
