// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import { Assessment, ContactTotals, Picture, Vocabulary } from "../types";
import { Child, Markup, html } from "./markup";
import { shortNumber } from "./numbers";
import { badge } from "./parts";
import { groupedTable, rowHead } from "./tables";
import { isInHand, statusVerdict, statusWords } from "./verdicts";
import { bandComparison } from "./error_band";

function thumbnail(pictures: Picture[], name: string): Markup | null {
  const found = pictures.filter((one) => one.name === name && one.thumbnail !== null)[0];
  return found ? html`<img src="${found.thumbnail}" alt="${found.alt}">` : null;
}

function card(one: Assessment, pictures: Picture[], index: number, vocabulary: Vocabulary): Markup {
  const { contact } = one;
  const figure = (name: string, value: number, unit: string) =>
    html`<div><dt>${name}</dt><dd>${shortNumber(value)} ${unit}</dd></div>`;
  // Seen from the palm's side, what is too large would hide the hand.
  const content: Child = isInHand(one)
    ? html`${thumbnail(pictures, "map_open_hand")}${thumbnail(pictures, "grasp_palm")}<dl>${figure("Grip force", contact.grip_force_n, "N")}${figure("Force", contact.force_n, "N")}${figure("Contact area", contact.contact_area_mm2, "mm²")}${figure("Peak on sensor cells", contact.peak_pressure_cells_mpa, "MPa")}${figure("Peak at one vertex", contact.peak_pressure_mpa, "MPa")}</dl>`
    : html`${thumbnail(pictures, "grasp_back")}<p>Not in the hand: no forces or pressures to compare.</p>`;
  return html`<div class="card"><h4><a href="#product-${index}">${one.product.name}</a> ${badge(statusVerdict(one), statusWords(one, vocabulary))}</h4>${content}</div>`;
}

/// Region by region: the first product, the second, and second minus first.
function differenceTable(first: Assessment, second: Assessment, vocabulary: Vocabulary): Markup {
  const none = { force_n: 0, contact_area_mm2: 0, peak_pressure_cells_mpa: 0 };
  type Shown = Pick<ContactTotals, "force_n" | "contact_area_mm2" | "peak_pressure_cells_mpa">;
  const of = (one: Assessment, name: string): Shown | undefined =>
    one.contact.regions.filter((region) => region.region === name)[0];
  const cells = (a: number, b: number) =>
    html`<td class="n">${shortNumber(a)}</td><td class="n">${shortNumber(b)}</td><td class="n" data-value="${b - a}">${b > a && "+"}${shortNumber(b - a)}</td>`;
  const row = (name: string, a: Shown, b: Shown) => [
    rowHead(name), cells(a.force_n, b.force_n), cells(a.contact_area_mm2, b.contact_area_mm2),
    cells(a.peak_pressure_cells_mpa, b.peak_pressure_cells_mpa)];
  const rows: Markup[] = [];
  for (const name in vocabulary.regions) {
    const a = of(first, name), b = of(second, name);
    if (a || b) rows.push(html`<tr data-region="${name}">${row(vocabulary.regions[name].words, a || none, b || none)}</tr>`);
  }
  return groupedTable({
    id: "difference",
    caption: "Difference by region: A is " + first.product.name + ", B is " + second.product.name +
      "; B − A above 0 means that B presses more",
    first: "Region",
    groups: ["Force, N", "Area, mm²", "Peak on cells, MPa"],
    parts: ["A", "B", "B − A"],
    rows: html`${rows}<tr class="total" data-region="total">${row("Whole hand", first.contact, second.contact)}</tr>`,
  });
}

/// Products side by side; of exactly two also the difference in every region. Nothing for one.
export function comparison(all: Assessment[], pictures: Picture[][], vocabulary: Vocabulary): Markup | null {
  if (all.length < 2) return null;
  const areTwo = all.length === 2 && isInHand(all[0]) && isInHand(all[1]);
  return html`<h3 id="comparison">Side by side</h3>
<div class="cards">${all.map((one, i) => card(one, pictures[i], i, vocabulary))}</div>
${areTwo && html`${differenceTable(all[0], all[1], vocabulary)}${bandComparison(all[0], all[1])}`}`;
}
