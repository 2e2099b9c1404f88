// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The small charts of first screens. Their numbers follow as a table for those who can't see them.

import { say } from "../texts";
import { Markup, html } from "./markup";
import { coordinate, percent, shortNumber, signedNumber } from "./numbers";

/// Of two products; told apart without red and green (Okabe, Ito 2008).
export const productColours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7"];

const width = 430;

function unseenTable(caption: string, heads: string[], rows: string[][]): Markup {
  return html`<div class="unseen"><table><caption>${caption}</caption><thead><tr>${heads.map((one) => html`<th scope="col">${one}</th>`)}</tr></thead><tbody>${rows.map((row) => html`<tr>${row.map((one, i) => i === 0 ? html`<th scope="row">${one}</th>` : html`<td>${one}</td>`)}</tr>`)}</tbody></table></div>`;
}

/// Bars per group and product with a mark in each group: pressures by region and where discomfort
/// begins.
export function groupedBars(options: {
  title: string;
  unit: string;
  mark: string;
  names: string[];
  groups: { name: string; values: number[]; mark: number }[];
}): Markup {
  const { groups, names } = options;
  const left = 224, right = 40, bar = names.length > 2 ? 7 : 10, gap = 9, top = 24;
  const each = bar * names.length + gap;
  let most = 0;
  for (const group of groups) most = Math.max(most, group.mark, ...group.values);
  const x = (value: number) => left + (most > 0 ? (value / most) * (width - left - right) : 0);
  const legend = names.length > 1 ? 18 : 0;
  const height = top + legend + groups.length * each + 4;
  const drawn = groups.map((group, g) => {
    const y = top + legend + g * each;
    // Over the bars, with a white edge so that it is seen on them; figures that it would cross stand behind it.
    const line = `M${coordinate(x(group.mark))} ${coordinate(y - 3)}v${bar * names.length + 5}`;
    const mark = html`<path d="${line}" stroke="#fff" stroke-width="3.5"/><path d="${line}" stroke="#1d2329" stroke-width="1.5" stroke-dasharray="3 2"/>`;
    const bars = group.values.map((value, i) =>
      html`<rect x="${left}" y="${coordinate(y + i * bar)}" width="${coordinate(x(value) - left)}" height="${bar - 1}" fill="${productColours[i % 4]}"/>`);
    const figures = group.values.map((value, i) => {
      const beside = x(Math.max(value, 0)) + 4, room = 30;
      const isHit = x(group.mark) > beside - 4 && x(group.mark) < beside + room;
      return html`<text x="${coordinate(isHit ? x(group.mark) + 4 : beside)}" y="${coordinate(y + i * bar + bar - 1.5)}" font-size="10.5" data-value="${String(value)}">${shortNumber(value, 2)}</text>`;
    });
    return html`<text x="${left - 6}" y="${coordinate(y + 0.5 * bar * names.length + 3)}" text-anchor="end">${group.name}</text>${bars}${mark}${figures}`;
  });
  const keys = names.length > 1 ? names.map((name, i) =>
    html`<rect x="${coordinate(i * width / names.length)}" y="20" width="10" height="10" fill="${productColours[i % 4]}"/><text x="${coordinate(i * width / names.length + 14)}" y="29">${name.length > 26 ? name.slice(0, 25) + "…" : name}</text>`) : null;
  return html`<figure class="small-chart"><svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" role="img" font-size="12" fill="#1d2329" data-unit="${options.unit}" aria-label="${options.title}"><text x="0" y="11" font-weight="600">${options.title}</text>${keys}${drawn}</svg><figcaption>${options.mark}</figcaption>${unseenTable(options.title, ["", ...names, options.mark], groups.map((group) => [group.name, ...group.values.map((one) => shortNumber(one) + " " + options.unit), shortNumber(group.mark) + " " + options.unit]))}</figure>`;
}

/// One bar per hand, sorted: by how much more or less one product presses than the other.
export function changeBars(title: string, changes: number[], better: string, worse: string): Markup {
  const sorted = changes.slice().sort((a, b) => a - b);
  const top = 24, height = 176, left = 40, bottom = 20;
  let most = 0.1;
  for (const one of sorted) most = Math.max(most, Math.abs(one));
  const zero = top + (height - top - bottom) / 2;
  const scale = (height - top - bottom) / 2 / most;
  const each = (width - left) / Math.max(1, sorted.length);
  const bars = sorted.map((one, i) =>
    html`<rect x="${coordinate(left + i * each)}" y="${coordinate(one < 0 ? zero : zero - one * scale)}" width="${coordinate(Math.max(1, each - 1.5))}" height="${coordinate(Math.abs(one) * scale)}" fill="${one < 0 ? productColours[0] : productColours[1]}"/>`);
  const label = (value: number) =>
    html`<text x="${left - 5}" y="${coordinate(zero - value * scale + 4)}" text-anchor="end" font-size="11">${signedNumber(100 * value, 2)}</text>`;
  const lower = sorted.filter((one) => one < 0).length;
  const caption = say("chart.changes.caption", { better, worse, lower, hands: sorted.length });
  return html`<figure class="small-chart"><svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" role="img" font-size="12" fill="#1d2329" aria-label="${title}"><text x="0" y="11" font-weight="600">${title}</text>${label(most)}${label(0)}${label(-most)}${bars}<path d="M${left} ${coordinate(zero)}H${width}" stroke="#1d2329"/></svg><figcaption>${caption}</figcaption>${unseenTable(title, [say("chart.changes.hand"), say("chart.changes.change")], sorted.map((one, i) => [String(i + 1), (one > 0 ? "+" : "") + percent(one)]))}</figure>`;
}
