// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import { Child, Markup, html } from "./markup";
import { fixedNumber, nothing, shortNumber } from "./numbers";

export interface Column {
  words: Child;
  isNumber?: boolean;
}

export function words(text: Child): Column {
  return { words: text };
}
export function numbers(text: Child): Column {
  return { words: text, isNumber: true };
}

/// A table that scrolls sideways where the page is narrow. `rows` are <tr> elements.
export function table(options: {
  caption: Child;
  columns: Column[];
  rows: Child;
  className?: string;
}): Markup {
  const heads = options.columns.map((one) =>
    html`<th scope="col"${one.isNumber && html` class="n"`}>${one.words}</th>`);
  return html`<div class="wide"><table${options.className && html` class="${options.className}"`}><caption><span>${options.caption}</span></caption><thead><tr>${heads}</tr></thead><tbody>${options.rows}</tbody></table></div>
`;
}

/// A table whose columns stand in groups of equal parts, such as A, B and B − A.
export function groupedTable(options: {
  id: string;
  caption: Child;
  first: string;
  groups: Child[];
  parts: string[];
  last?: string;
  rows: Child;
}): Markup {
  const groups = options.groups.map((one) =>
    html`<th colspan="${options.parts.length}" scope="colgroup">${one}</th>`);
  const parts = options.groups.map(() =>
    options.parts.map((one) => html`<th class="n" scope="col">${one}</th>`));
  return html`<div class="wide"><table id="${options.id}"><caption><span>${options.caption}</span></caption><thead><tr><th rowspan="2" scope="col">${options.first}</th>${groups}${options.last && html`<th rowspan="2" class="n" scope="col">${options.last}</th>`}</tr><tr>${parts}</tr></thead><tbody>${options.rows}</tbody></table></div>
`;
}

export function cell(content: Child): Markup {
  return html`<td>${content}</td>`;
}

export function rowHead(content: Child): Markup {
  return html`<th scope="row">${content}</th>`;
}

/// A swatch of a colour before words, as the head of a row.
export function colouredHead(colour: string, content: Child): Markup {
  return rowHead(html`<span class="swatch" style="background:${colour}"></span>${content}`);
}

/// A number cell of any content; `value` stands in full in data-value.
export function valueCell(value: number | null | undefined, content: Child, below?: Child): Markup {
  if (value === null || value === undefined) return html`<td class="n">${nothing}</td>`;
  return html`<td class="n" data-value="${value}">${content}${below && html`<br><span class="range">${below}</span>`}</td>`;
}

/// A number shortened for reading and in full in data-value; a dash for none.
export function numberCell(value: number | null | undefined, significant = 3): Markup {
  return valueCell(value, shortNumber(value, significant));
}

/// A number with just so many decimals.
export function fixedCell(value: number | null | undefined, decimals = 2): Markup {
  return valueCell(value, fixedNumber(value, decimals));
}

export function countCell(count: number): Markup {
  return html`<td class="n">${count}</td>`;
}

export function emptyCell(): Markup {
  return html`<td class="n">${nothing}</td>`;
}
