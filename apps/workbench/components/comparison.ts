// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import { Assessment, ContactTotals, Vocabulary } from "../types";
import { say } from "../texts";
import { Markup, html } from "./markup";
import { shortNumber, signedNumber } from "./numbers";
import { folded } from "./parts";
import { groupedTable, rowHead } from "./tables";
import { isInHand, regionWords } from "./verdicts";
import { bandComparison } from "./error_band";
import { indexComparison } from "./indices";

/// Region by region: the first product, the second, and second minus first.
function differenceTable(first: Assessment, second: Assessment, vocabulary: Vocabulary): Markup {
  const none = { force_n: 0, contact_area_mm2: 0, peak_pressure_cells_mpa: 0 };
  type Shown = Pick<ContactTotals, "force_n" | "contact_area_mm2" | "peak_pressure_cells_mpa">;
  const of = (one: Assessment, name: string): Shown | undefined =>
    one.contact.regions.filter((region) => region.region === name)[0];
  const cells = (a: number, b: number) =>
    html`<td class="n">${shortNumber(a)}</td><td class="n">${shortNumber(b)}</td><td class="n" data-value="${b - a}">${signedNumber(b - a)}</td>`;
  const row = (name: string, a: Shown, b: Shown) => [
    rowHead(name), cells(a.force_n, b.force_n), cells(a.contact_area_mm2, b.contact_area_mm2),
    cells(a.peak_pressure_cells_mpa, b.peak_pressure_cells_mpa)];
  const rows: Markup[] = [];
  for (const name in vocabulary.regions) {
    const a = of(first, name), b = of(second, name);
    if (a || b) rows.push(html`<tr data-region="${name}">${row(regionWords(name, vocabulary), a || none, b || none)}</tr>`);
  }
  return groupedTable({
    id: "difference",
    caption: say("difference.caption", { first: first.product.name, second: second.product.name }),
    first: say("regions.region"),
    groups: [say("regions.force"), say("regions.area"), say("regions.cells")],
    parts: ["A", "B", "B − A"],
    rows: html`${rows}<tr class="total" data-region="total">${row(say("regions.whole"), first.contact, second.contact)}</tr>`,
  });
}

/// Of exactly two products the difference in every region; of several their indices. Nothing for one.
export function comparison(all: Assessment[], vocabulary: Vocabulary): Markup | null {
  if (all.length < 2) return null;
  const areTwo = all.length === 2 && isInHand(all[0]) && isInHand(all[1]);
  const indices = indexComparison(all.map((one) => one.product.name), all.map((one) => one.index_table));
  return html`${areTwo && html`${bandComparison(all[0], all[1])}${differenceTable(all[0], all[1], vocabulary)}`}${indices && folded(say("index.title"), html`<p>${say("index.intro")}</p>
${indices}`)}`;
}
