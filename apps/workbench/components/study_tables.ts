// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import { FaceStatistics, Proportion, Quantity, QuantitySummary, StudyConditionResult, StudyPage } from "../types";
import { say, sayCount } from "../texts";
import { Child, Markup, html, joined } from "./markup";
import { capitalised, localised, nothing, percent, shortNumber } from "./numbers";
import { badge, folded } from "./parts";
import { cell, colouredHead, countCell, emptyCell, numberCell, numbers, rowHead, table, valueCell, words } from "./tables";
import { faceHead } from "./contact_tables";
import { term } from "./glossary";
import { regionWords } from "./verdicts";

/// "p < 0.001", "p = 0.012"
export function pWords(p: number): string {
  return localised(p < 0.001 ? "p < 0.001" : "p = " + p.toFixed(p < 0.1 ? 3 : 2));
}

function pCell(p: number | null): Markup {
  return p === null ? emptyCell() : valueCell(p, pWords(p));
}

export function shareCell(one: Proportion, significant = 3): Markup {
  if (one.n === 0) return emptyCell();
  return valueCell(one.share, percent(one.share || 0, significant),
                   say("range", { low: shortNumber(100 * (one.low || 0), 2), high: percent(one.high || 0) }));
}

function estimateCell(one: { value: number | null; low: number | null; high: number | null }): Markup {
  return valueCell(one.value, shortNumber(one.value), say("range", { low: shortNumber(one.low), high: shortNumber(one.high) }));
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

/// "2 slips out, 1 not run"; `count` hands are of the kind that `key` names.
function listed(causes: { words: string; hands: number }[], count: number, key: string): string {
  const all = causes.map((one) => one.hands + " " + one.words);
  if (count > 0) all.push(say(key, { count }));
  return all.join(", ") || say("study.nobody");
}

/// Means of the main quantities by product, for the first condition.
export function overviewTable(page: StudyPage): Markup {
  const first = page.conditions[0];
  const rows = first.products.map((one, p) => {
    const means = ["grip_force_n"].concat(page.main_quantities).map((key) => meanCell(one.quantities[key]));
    return html`<tr>${productHead(page, p)}<td class="n">${say("study.of", { count: one.hands_holding, n: one.hands })}</td>${means}${shareCell(one.accommodation.inside)}</tr>
`;
  });
  return table({
    caption: page.conditions.length > 1 ? say("study.overview_of", { title: first.title }) : say("study.overview"),
    columns: [words(say("summary.product")), numbers(say("study.hands")), numbers(term("grip_force", say("summary.grip_force"))),
              numbers(term("peak_on_cells", say("summary.cells"))), numbers(term("peak_at_vertex", say("regions.peak"))),
              numbers(say("study.mean_pressure")), numbers(term("contact_area", say("summary.area"))),
              numbers(term("sum_of_forces", say("summary.force"))),
              numbers(say(page.limits.length === 0 ? "study.held" : "study.inside"))],
    rows,
  });
}

/// Of a pair: a difference that the tests show but that is smaller than what a simulated grasp can
/// resolve is none.
function verdictBadge(verdict: string, isResolved: boolean): Markup {
  if (verdict === "shown") return isResolved ? badge("good", say("study.differ")) : badge("fair", say("study.within_error"));
  if (verdict === "not_shown") return badge("fair", say("study.not_shown.badge"));
  return verdict === "none" ? badge("fair", say("study.no_difference")) : badge("bad", say("study.few.badge"));
}

const toldApart = 0.1; // share of the larger mean: kToldApart of grasp_index.h

export function comparisonTable(page: StudyPage, one: StudyConditionResult): Markup | null {
  if (page.products.length < 2) return null;
  const rows = one.comparisons.map(({ quantity, pairs }) => pairs.map((pair) => {
    const head = html`${rowHead(quantityWords(quantity))}${cell(page.products[pair.second].name + " − " + page.products[pair.first].name)}<td class="n">${say("study.of", { count: pair.pairs, n: pair.hands })}${pair.left_out_words && html`<br><span class="range">${pair.left_out_words}</span>`}</td>`;
    const figures: Child = pair.verdict === "too_few_pairs" ? html`<td colspan="5"></td>`
      : [html`<td class="n">${say("study.of", { count: pair.lower_in_second, n: pair.pairs })}</td>`, estimateCell(pair.difference), estimateCell(pair.effect_size), pCell(pair.t_p_holm), pCell(pair.wilcoxon_p_holm)];
    const mean = (product: number) => {
      const summary = one.products[product].quantities[quantity.key];
      return Math.abs((summary && summary.mean) || 0);
    };
    const isResolved = Math.abs(pair.difference.value || 0) > toldApart * Math.max(mean(pair.first), mean(pair.second));
    return html`<tr>${head}${figures}${cell(verdictBadge(pair.verdict, isResolved))}</tr>
`;
  }));
  return table({
    caption: say("study.pairs"),
    columns: [words(say("study.quantity")), words(say("study.pair")), numbers(say("study.hands")), numbers(say("study.agree")),
              numbers(term("interval", say("study.difference"))), numbers(term("effect_size", say("study.effect"))),
              numbers(term("t_test", say("study.ttest"))), numbers(term("p_value", say("study.wilcoxon"))), words(say("study.verdict"))],
    rows,
  });
}

/// Which part of each product hands hold, and how.
export function holdTable(page: StudyPage, one: StudyConditionResult): Markup | null {
  if (!one.products.some((product) => product.holds.some((hold) => hold.words !== null))) return null;
  const rows = one.products.map((product, p) => product.holds.map((hold) => html`<tr>${productHead(page, p)}${cell(hold.part === null ? "" : hold.part + " " + hold.part_name)}${hold.along === null ? emptyCell() : valueCell(hold.along, percent(hold.along))}${cell(capitalised(hold.words || say("study.by_coordinates")))}<td class="n">${say("study.of", { count: hold.hands, n: product.hands })}</td></tr>
`));
  return table({
    caption: say("study.holds"),
    columns: [words(say("summary.product")), words(say("study.part")), numbers(say("study.along")), words(term("hold", say("study.hold"))), numbers(say("study.hands"))],
    rows,
  });
}

export function accommodationSection(page: StudyPage, one: StudyConditionResult): Markup {
  const rows = one.products.map((product, p) => {
    const { accommodation: a, exclusion } = product;
    const lengths = a.shortest_outside_mm === null ? nothing
      : say("range", { low: shortNumber(a.shortest_outside_mm), high: shortNumber(a.longest_outside_mm) });
    return html`<tr>${productHead(page, p)}${shareCell(a.in_hand)}${shareCell(a.inside)}${cell(listed(a.outside_because_of, a.not_run, "study.not_run"))}<td class="n">${lengths}</td>${shareCell(exclusion.excluded)}${cell(listed(exclusion.because_of, exclusion.unknown, "study.unknown"))}</tr>
`;
  });
  return html`<h3>${say("study.left_out")}</h3><p>${say("study.limits", { limits: page.limits.join("; ") || say("study.no_limits") })}</p>${table({
    caption: say("study.shares"),
    columns: [words(say("summary.product")), numbers(say("study.in_hand")), numbers(say("study.inside")), words(say("study.outside")),
              numbers(say("study.outside_length")), numbers(say("study.excluded")), words(say("study.because"))],
    rows,
  })}${one.has_nails && html`<p>${say("study.nails")}</p>
`}`;
}

function lengthWords(size: { is_taken: boolean; from_mm: number | null; to_mm: number | null }): string {
  if (!size.is_taken) return say("study.sizes.nobody");
  const low = shortNumber(size.from_mm), high = shortNumber(size.to_mm);
  if (size.from_mm !== null && size.to_mm !== null) return say("study.sizes.between", { low, high });
  if (size.from_mm !== null) return say("study.sizes.from", { low });
  return size.to_mm !== null ? say("study.sizes.up_to", { high }) : say("study.sizes.all");
}

export function sizeSections(page: StudyPage, one: StudyConditionResult): Markup[] {
  return one.sizes.map((family) => {
    const rows = family.choices.map((choice) => {
      const sizes = choice.sizes.map((size) =>
        html`${page.products[size.product].name}: ${lengthWords(size)} <span class="range">${say("study.sizes.serves", { inside: size.inside, alone: size.alone })}</span>`);
      return html`<tr>${rowHead(choice.sizes.length)}${cell(joined(sizes, html`<br>`))}${shareCell(choice.served)}${shareCell(choice.served_by_length)}</tr>
`;
    });
    return html`<h3>${say("study.sizes", { family: family.family })}</h3>${table({
      caption: say("study.sizes.caption", { hands: sayCount("study.hands", family.hands) }),
      columns: [words(say("study.sizes.sizes")), words(say("study.sizes.which")), numbers(say("study.sizes.served")), numbers(say("study.sizes.by_length"))],
      rows,
    })}`;
  });
}

export function dependenceTable(page: StudyPage, one: StudyConditionResult): Markup | null {
  if (one.dependence.length === 0) return null;
  const rows = one.dependence.map((row) => html`<tr>${rowHead(quantityWords(row.quantity))}${cell(page.products[row.product].name)}${cell(say("study.dependence." + row.size))}${numberCell(row.slope_per_mm)}${numberCell(row.r2, 2)}${numberCell(row.rank_correlation, 2)}${pCell(row.p_value)}${countCell(row.hands)}</tr>
`);
  return folded(say("study.dependence"), table({
    caption: say("study.dependence.caption"),
    columns: [words(say("study.quantity")), words(say("summary.product")), words(say("study.dependence.hand")), numbers(say("study.dependence.slope")), numbers("R²"),
              numbers(say("study.dependence.rank")), numbers(say("study.dependence.p")), numbers(say("study.hands"))],
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
                       sayCount("study.hands", region.touching));
    });
    rows.push(html`<tr>${rowHead(capitalised(regionWords(name, page.vocabulary)))}${cells}</tr>
`);
  }
  if (rows.length === 0) return null;
  return folded(say("study.regions"), table({
    caption: say("study.regions.caption"),
    columns: [words(say("regions.region")), ...page.products.map((product) => numbers(product.name))],
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
  return folded(say("study.quantities"), table({
    caption: say("study.quantities.caption"),
    columns: [words(say("study.quantity")), ...page.products.map((product) => numbers(product.name))],
    rows,
  }));
}

function faceTable(page: StudyPage, one: FaceStatistics): Markup {
  const rows = one.faces.map((face) => html`<tr>${faceHead(face.title, face.part)}${shareCell(face.has_peak)}${shareCell(face.touched)}${valueCell(face.peak_mean_mpa, shortNumber(face.peak_mean_mpa), face.touching > 1 && "± " + shortNumber(face.peak_sd_mpa, 2))}${numberCell(face.peak_p95_mpa)}${numberCell(face.peak_max_mpa)}${shareCell(face.above)}${valueCell(face.force_share, percent(face.force_share || 0, 3))}</tr>
`);
  const rest = one.faces_touched - one.faces.length;
  const untouched = one.faces_in_all - one.faces_touched;
  return html`<p>${one.words}</p>${table({
    caption: [say("study.faces.caption", { product: page.products[one.product].name, hands: sayCount("study.hands", one.hands) }),
              rest > 0 && " " + say("study.faces.rest", { count: rest }),
              untouched > 0 && " " + say("study.faces.untouched", { count: untouched, all: one.faces_in_all })],
    columns: [words(say("faces.face")), numbers(say("study.faces.highest")), numbers(say("study.faces.touched")), numbers(say("faces.peak")),
              numbers(say("study.faces.p95")), numbers(say("study.faces.max")),
              numbers(say("study.faces.above", { limit: shortNumber(1000 * page.threshold_mpa, 2) })), numbers(say("study.faces.share"))],
    rows,
  })}`;
}

/// Products from CAD face by face; nothing for others.
export function faceStatisticsSection(page: StudyPage, one: StudyConditionResult): Markup | null {
  if (one.faces.length === 0) return null;
  return html`<h3>${say("study.faces")}</h3>${one.faces.map((faces) => faceTable(page, faces))}`;
}
