// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import { Assessment, MeasuredPressure, TrustedMarkup, Vocabulary } from "../types";
import { say } from "../texts";
import { Markup, html } from "./markup";
import { shortNumber, signedNumber } from "./numbers";
import { charts } from "./parts";
import { numberCell, numbers, rowHead, table, valueCell, words } from "./tables";
import { regionWords } from "./verdicts";

const fewDigits = 2;
const smallForce = 0.05; // N; rounding

function partWords(name: string, vocabulary: Vocabulary): string {
  if (name === "beside the hand") return say("sensors.beside_hand");
  return name in vocabulary.regions ? regionWords(name, vocabulary) : name;
}

function differenceCell(difference: number): Markup {
  return valueCell(difference, signedNumber(difference));
}

/// What was measured beside what is simulated, in numbers.
function comparison(one: MeasuredPressure, vocabulary: Vocabulary): Markup {
  const interval = one.pearson.low !== undefined && one.pearson.high !== undefined &&
    say("sensors.interval", { low: shortNumber(one.pearson.low, fewDigits), high: shortNumber(one.pearson.high, fewDigits) });
  const rows = one.parts.map((part) => html`<tr>${rowHead(partWords(part.name, vocabulary))}${valueCell(part.cells, String(part.cells))}${numberCell(part.measured_n)}${numberCell(part.simulated_n)}${differenceCell(part.simulated_n - part.measured_n)}</tr>
`);
  return html`<p>${say("sensors.agreement", {
    pearson: shortNumber(one.pearson.r, fewDigits), spearman: shortNumber(one.spearman.r, fewDigits), cells: one.pearson.n,
    rms: shortNumber(1000 * one.rms_mpa, 3), mean: shortNumber(1000 * one.mean_difference_mpa, 3),
  })}${interval && " " + interval}</p>
<p>${say("sensors.peaks", { measured: shortNumber(1000 * one.peak_measured_mpa, 3), simulated: shortNumber(1000 * one.peak_simulated_mpa, 3) })}</p>
${table({
    caption: say("sensors.parts", { source: one.source }),
    columns: [words(say("regions.region")), numbers(say("sensors.cells")), numbers(say("sensors.measured")),
              numbers(say("sensors.simulated")), numbers(say("sensors.difference"))],
    rows: html`${rows}<tr class="total">${rowHead(say("sensors.all"))}<td></td>${numberCell(one.force_measured_n)}${numberCell(one.force_simulated_n)}${differenceCell(one.force_simulated_n - one.force_measured_n)}</tr>`,
  })}`;
}

/// The sensor's map; nothing for products without one.
export function sensorSection(assessment: Assessment, map: TrustedMarkup | null, vocabulary: Vocabulary): Markup | null {
  const sensors = assessment.sensors;
  if (!sensors) return null;
  return html`<h3>${say("sensors.title")}</h3><p>${say("sensors." + sensors.layout.kind, {
    name: sensors.layout.name, pitch: String(sensors.layout.pitch_mm), cells: sensors.cells.length,
  })} ${say("sensors.totals", {
    force: shortNumber(sensors.force_n), beside: sensors.force_beside_n < smallForce ? "0" : shortNumber(sensors.force_beside_n), peak: shortNumber(1000 * sensors.peak_pressure_mpa),
  })}</p>
${map && charts([map])}${sensors.measured && comparison(sensors.measured, vocabulary)}`;
}
