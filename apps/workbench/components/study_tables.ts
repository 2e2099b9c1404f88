// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import { FaceStatistics, Proportion, Quantity, QuantitySummary, StudyConditionResult, StudyPage } from "../types";
import { Child, Markup, html, joined } from "./markup";
import { capitalised, counted, nothing, percent, shortNumber } from "./numbers";
import { badge, folded } from "./parts";
import { cell, colouredHead, countCell, emptyCell, numberCell, numbers, rowHead, table, valueCell, words } from "./tables";
import { faceHead } from "./contact_tables";

/// "p < 0.001", "p = 0.012"
export function pWords(p: number): string {
  return p < 0.001 ? "p < 0.001" : "p = " + p.toFixed(p < 0.1 ? 3 : 2);
}

function pCell(p: number | null): Markup {
  return p === null ? emptyCell() : valueCell(p, pWords(p));
}

export function shareCell(one: Proportion, significant = 3): Markup {
  if (one.n === 0) return emptyCell();
  return valueCell(one.share, percent(one.share || 0, significant),
                   shortNumber(100 * (one.low || 0), 2) + " to " + percent(one.high || 0));
}

function estimateCell(one: { value: number | null; low: number | null; high: number | null }): Markup {
  return valueCell(one.value, shortNumber(one.value), shortNumber(one.low) + " to " + shortNumber(one.high));
}

function meanCell(one: QuantitySummary | undefined): Markup {
  if (!one) return emptyCell();
  return valueCell(one.mean, shortNumber(one.mean), "± " + shortNumber(one.sd, 2));
}

function quantityWords(one: Quantity): string {
  return capitalised(one.name) + (one.unit && ", " + one.unit);
}

function productHead(page: StudyPage, product: number): Markup {
  return colouredHead(page.products[product].colour, page.products[product].name);
}

function listed(causes: { words: string; hands: number }[], others: [number, string][]): string {
  const all = causes.map((one) => one.hands + " " + one.words);
  for (const [count, what] of others) if (count > 0) all.push(count + " " + what);
  return all.join(", ") || "nobody";
}

/// Means of the main quantities by product, for the first condition.
export function overviewTable(page: StudyPage): Markup {
  const first = page.conditions[0];
  const rows = first.products.map((one, p) => {
    const means = ["grip_force_n"].concat(page.main_quantities).map((key) => meanCell(one.quantities[key]));
    return html`<tr>${productHead(page, p)}<td class="n">${one.hands_holding} of ${one.hands}</td>${means}${shareCell(one.accommodation.inside)}</tr>
`;
  });
  return table({
    caption: "Mean ± standard deviation over the hands that hold the product" +
      (page.conditions.length > 1 ? ": " + first.title : "") + ".",
    columns: [words("Product"), numbers("Hands"), numbers("Grip force, N"), numbers("Peak on sensor cells, MPa"), numbers("Peak at a vertex, MPa"),
              numbers("Mean pressure, MPa"), numbers("Contact area, mm²"), numbers("Sum of normal forces, N"),
              numbers(page.limits.length === 0 ? "Held" : "Inside the limits")],
    rows,
  });
}

const verdicts: { [name: string]: Markup } = {
  shown: badge("good", "differ"),
  not_shown: badge("fair", "not shown"),
  none: badge("fair", "no difference"),
  too_few_pairs: badge("bad", "too few hands"),
};

export function comparisonTable(page: StudyPage, one: StudyConditionResult): Markup | null {
  if (page.products.length < 2) return null;
  const rows = one.comparisons.map(({ quantity, pairs }) => pairs.map((pair) => {
    const head = html`${rowHead(quantityWords(quantity))}${cell(page.products[pair.second].name + " − " + page.products[pair.first].name)}<td class="n">${pair.pairs} of ${pair.hands}${pair.left_out_words && html`<br><span class="range">${pair.left_out_words}</span>`}</td>`;
    const figures: Child = pair.verdict === "too_few_pairs" ? html`<td colspan="4"></td>`
      : [estimateCell(pair.difference), estimateCell(pair.effect_size), pCell(pair.t_p_holm), pCell(pair.wilcoxon_p_holm)];
    return html`<tr>${head}${figures}${cell(verdicts[pair.verdict])}</tr>
`;
  }));
  return table({
    caption: "Products over the same hands. Differences are second minus first, with 95 % intervals; p values are corrected after Holm over the pairs of a quantity.",
    columns: [words("Quantity"), words("Pair"), numbers("Hands"), numbers("Difference"), numbers("Cohen’s dz"),
              numbers("t-test"), numbers("Wilcoxon"), words("Verdict")],
    rows,
  });
}

/// By which part and how hands hold each product.
export function holdTable(page: StudyPage, one: StudyConditionResult): Markup | null {
  if (!one.products.some((product) => product.holds.some((hold) => hold.words !== null))) return null;
  const rows = one.products.map((product, p) => product.holds.map((hold) => html`<tr>${productHead(page, p)}${cell(hold.part === null ? "" : hold.part + " " + hold.part_name)}${hold.along === null ? emptyCell() : valueCell(hold.along, percent(hold.along))}${cell(capitalised(hold.words || "where coordinates say"))}<td class="n">${hold.hands} of ${product.hands}</td></tr>
`));
  return table({
    caption: "How the product is held: found once and the same for every hand, unless there are several lines.",
    columns: [words("Product"), words("Part"), numbers("Along it"), words("Hold"), numbers("Hands")],
    rows,
  });
}

export function accommodationSection(page: StudyPage, one: StudyConditionResult): Markup {
  const rows = one.products.map((product, p) => {
    const { accommodation: a, exclusion } = product;
    const lengths = a.shortest_outside_mm === null ? nothing
      : shortNumber(a.shortest_outside_mm) + " to " + shortNumber(a.longest_outside_mm);
    return html`<tr>${productHead(page, p)}${shareCell(a.in_hand)}${shareCell(a.inside)}${cell(listed(a.outside_because_of, [[a.not_run, "not run"]]))}<td class="n">${lengths}</td>${shareCell(exclusion.excluded)}${cell(listed(exclusion.because_of, [[exclusion.unknown, "without an answer"]]))}</tr>
`;
  });
  return html`<h3>Who is left out</h3><p>Limits: ${page.limits.join("; ") || "none stated, so inside means held"}.</p>${table({
    caption: "Shares of hands with 95 % intervals after Wilson. Excluded: can’t hold the product by the person’s own range, strength and nails.",
    columns: [words("Product"), numbers("In the hand"), numbers("Inside the limits"), words("Outside because of"),
              numbers("Their hand length, mm"), numbers("Excluded"), words("Because of")],
    rows,
  })}${one.has_nails && html`<p>Exclusion by nails is an upper bound: hands close as if they had no nails, and a person with long ones holds a product otherwise.</p>
`}`;
}

function lengthWords(size: { is_taken: boolean; from_mm: number | null; to_mm: number | null }): string {
  if (!size.is_taken) return "nobody by length alone";
  if (size.from_mm !== null && size.to_mm !== null) return shortNumber(size.from_mm) + " to " + shortNumber(size.to_mm) + " mm";
  if (size.from_mm !== null) return "from " + shortNumber(size.from_mm) + " mm";
  return size.to_mm !== null ? "up to " + shortNumber(size.to_mm) + " mm" : "everybody";
}

export function sizeSections(page: StudyPage, one: StudyConditionResult): Markup[] {
  return one.sizes.map((family) => {
    const rows = family.choices.map((choice) => {
      const sizes = choice.sizes.map((size) =>
        html`${page.products[size.product].name}: ${lengthWords(size)} <span class="range">(serves ${size.inside}, ${size.alone} of them alone)</span>`);
      return html`<tr>${rowHead(choice.sizes.length)}${cell(joined(sizes, html`<br>`))}${shareCell(choice.served)}${shareCell(choice.served_by_length)}</tr>
`;
    });
    return html`<h3>Sizes of ${family.family}</h3>${table({
      caption: "The best one, two and three sizes for " + counted(family.hands, "hand") + ", and who takes which by hand length.",
      columns: [words("Sizes"), words("Which, and for whom"), numbers("Served if all are tried on"), numbers("Served by hand length")],
      rows,
    })}`;
  });
}

export function dependenceTable(page: StudyPage, one: StudyConditionResult): Markup | null {
  if (one.dependence.length === 0) return null;
  const rows = one.dependence.map((row) => html`<tr>${rowHead(quantityWords(row.quantity))}${cell(page.products[row.product].name)}${cell(row.size)}${numberCell(row.slope_per_mm)}${numberCell(row.r2, 2)}${numberCell(row.rank_correlation, 2)}${pCell(row.p_value)}${countCell(row.hands)}</tr>
`);
  return folded("How it depends on the size of the hand", table({
    caption: "Linear regression of a quantity on hand length or circumference; not corrected for the number of tests.",
    columns: [words("Quantity"), words("Product"), words("Hand"), numbers("Slope per mm"), numbers("R²"),
              numbers("Rank correlation"), numbers("p of the slope"), numbers("Hands")],
    rows,
  }));
}

export function studyRegionTable(page: StudyPage, one: StudyConditionResult): Markup | null {
  const rows: Markup[] = [];
  for (const name in page.vocabulary.regions) {
    if (!one.products.some((product) => product.regions[name] !== undefined)) continue;
    const cells = one.products.map((product) => {
      const region = product.regions[name];
      if (!region) return emptyCell();
      return valueCell(region.force_n, shortNumber(region.force_n) + " N",
                       shortNumber(region.area_mm2) + " mm², " + shortNumber(region.peak_pressure_cells_mpa) + " MPa, " +
                       counted(region.touching, "hand"));
    });
    rows.push(html`<tr>${rowHead(capitalised(page.vocabulary.regions[name].words))}${cells}</tr>
`);
  }
  if (rows.length === 0) return null;
  return folded("Regions of the hand", table({
    caption: "Mean force; below: mean area, mean of the peaks on sensor cells, hands that touch. Hands that don’t touch with a region count with 0.",
    columns: [words("Region"), ...page.products.map((product) => numbers(product.name))],
    rows,
  }));
}

export function quantityTable(page: StudyPage, one: StudyConditionResult): Markup {
  const rows = page.quantities.map((quantity) => {
    const cells = one.products.map((product) => {
      const q = product.quantities[quantity.key];
      if (!q) return emptyCell();
      const percentiles = [q.p5, q.median, q.p95].filter((value) => value !== null).map((value) => shortNumber(value));
      return valueCell(q.mean, shortNumber(q.mean) + " ± " + shortNumber(q.sd, 2), percentiles.join(" · ") + " (" + q.n + ")");
    });
    return html`<tr>${rowHead(html`${quantityWords(quantity)}<br><code>${quantity.key}</code>`)}${cells}</tr>
`;
  });
  return folded("All quantities and indices", table({
    caption: "Mean ± standard deviation; below: 5th percentile, median, 95th percentile (hands); below five hands the median alone.",
    columns: [words("Quantity"), ...page.products.map((product) => numbers(product.name))],
    rows,
  }));
}

function faceTable(page: StudyPage, one: FaceStatistics): Markup {
  const rows = one.faces.map((face) => html`<tr>${faceHead(face.title, face.part)}${shareCell(face.has_peak)}${shareCell(face.touched)}${valueCell(face.peak_mean_mpa, shortNumber(face.peak_mean_mpa), face.touching > 1 && "± " + shortNumber(face.peak_sd_mpa, 2))}${numberCell(face.peak_p95_mpa)}${numberCell(face.peak_max_mpa)}${shareCell(face.above)}${valueCell(face.force_share, percent(face.force_share || 0, 3))}</tr>
`);
  const rest = one.faces_touched - one.faces.length;
  const untouched = one.faces_in_all - one.faces_touched;
  return html`<p>${one.words}</p>${table({
    caption: ["Faces of " + page.products[one.product].name + " over " + counted(one.hands, "hand") + " that hold it. Peaks: mean ± standard deviation over the hands that touch the face. ",
              rest > 0 && "Another " + rest + " are in faces.csv. ",
              untouched > 0 && "Of " + one.faces_in_all + " faces nobody touches " + untouched + "."],
    columns: [words("Face"), numbers("Highest of the product in"), numbers("Touched by"), numbers("Peak, MPa"),
              numbers("95th percentile, MPa"), numbers("Largest, MPa"),
              numbers("Peak above " + shortNumber(1000 * page.threshold_mpa, 2) + " kPa"), numbers("Share of the force")],
    rows,
  })}`;
}

/// Products from CAD face by face; nothing for others.
export function faceStatisticsSection(page: StudyPage, one: StudyConditionResult): Markup | null {
  if (one.faces.length === 0) return null;
  return html`<h3>Faces of the products</h3>${one.faces.map((faces) => faceTable(page, faces))}`;
}
