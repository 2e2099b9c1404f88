// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// How much the results depend on how soft or stiff people's skin is.

import { Assessment, ContactBand, ContactTotals, RegionContact, TrustedMarkup, Vocabulary } from "../types";
import { Markup, html } from "./markup";
import { percent, shortNumber } from "./numbers";
import { charts, folded } from "./parts";
import { groupedTable, numberCell, rowHead } from "./tables";
import { rangeWords } from "./contact_tables";
import { regionsWithoutBloodFlow } from "./verdicts";

const stiffer = 0.1; // the change in which sensitivities are given

interface BandedRegion {
  region: RegionContact;
  band: ContactBand;
}

function bandedRegions(assessment: Assessment): BandedRegion[] {
  const all: BandedRegion[] = [];
  for (const region of assessment.contact.regions) if (region.band) all.push({ region, band: region.band });
  return all;
}

export function hasBothEnds(band: ContactBand): boolean {
  return band.force_n.low !== null && band.force_n.high !== null;
}

function bandTable(assessment: Assessment, total: ContactBand, vocabulary: Vocabulary): Markup {
  const cells = (nominal: ContactTotals, band: ContactBand) => [
    numberCell(band.force_n.low), numberCell(nominal.force_n), numberCell(band.force_n.high),
    numberCell(band.contact_area_mm2.low), numberCell(nominal.contact_area_mm2), numberCell(band.contact_area_mm2.high),
    numberCell(band.peak_pressure_cells_mpa.low), numberCell(nominal.peak_pressure_cells_mpa),
    numberCell(band.peak_pressure_cells_mpa.high), numberCell(stiffer * band.force_per_modulus_n)];
  const rows = bandedRegions(assessment).map(({ region, band }) =>
    html`<tr data-band-region="${region.region}">${rowHead(vocabulary.regions[region.region].words)}${cells(region, band)}</tr>`);
  return groupedTable({
    id: "error-band",
    caption: "Soft, middle and stiff tissue",
    first: "Region",
    groups: ["Force, N", "Area, mm²", "Peak on cells, MPa"],
    parts: ["soft", "middle", "stiff"],
    last: "10 % stiffer skin here adds to the hand's force, N",
    rows: html`${rows}<tr class="total" data-band-region="total">${rowHead("Whole hand")}${cells(assessment.contact, total)}</tr>`,
  });
}

function sensitivities(assessment: Assessment, total: ContactBand, chart: TrustedMarkup | null, vocabulary: Vocabulary): Markup {
  const sorted = bandedRegions(assessment).sort((a, b) => b.band.force_per_modulus_n - a.band.force_per_modulus_n);
  // The fewest regions that make up half of it.
  let sum = 0, half = 0;
  while (half < sorted.length && sum < 0.5 * total.force_per_modulus_n) sum += sorted[half++].band.force_per_modulus_n;
  const together = half > 1
    ? "The first " + half + " of the " + sorted.length + " regions below make up half of the effect: "
    : "That region alone makes up half of the effect of all: ";
  // Force is homogeneous of degree one in all moduli (Euler): what the skin's sensitivities leave of
  // it is the sleeve's.
  const sleeve = stiffer * (assessment.contact.force_n - total.force_per_modulus_n);
  return html`<p><strong>What matters most.</strong> If only the skin of the ${vocabulary.regions[sorted[0].region.region].words} were 10 % stiffer, the hand would press with ${shortNumber(stiffer * sorted[0].band.force_per_modulus_n, 2)} N more. ${together}measure the skin there if you need a surer force.${assessment.settings.coatings.length > 0 && " A sleeve that is 10 % stiffer would add " + shortNumber(sleeve, 2) + " N."}</p>
${chart && charts([chart])}`;
}

function limitsWords(assessment: Assessment, total: ContactBand, vocabulary: Vocabulary): string {
  let soft = 0, stiff = 0, share = 0;
  for (const { region, band } of bandedRegions(assessment)) {
    const { low, high } = band.peak_pressure_cells_mpa;
    if (low !== null && low > vocabulary.blood_flow_stop_mpa) ++soft;
    if (high !== null && high > vocabulary.blood_flow_stop_mpa) ++stiff;
    share = Math.max(share, (band.peak_pressure_mpa.high || 0) / vocabulary.regions[region.region].pain_onset_mpa);
  }
  const pain = total.force_n.high === null ? ""
    : " With stiff tissue the region nearest to pain reaches " + percent(share) + " of its limit.";
  if (!hasBothEnds(total)) return pain;
  const middle = regionsWithoutBloodFlow(assessment.contact, vocabulary);
  if (soft === middle && middle === stiff) {
    return pain + " The number of regions short of blood in a long grip, " + middle + ", is the same for all three.";
  }
  return pain + " Regions short of blood in a long grip: " + soft + " with soft, " + middle + " with middle, " +
    stiff + " with stiff tissue.";
}

/// `chart`: the force that 10 % stiffer skin adds, region by region.
export function errorBandSection(assessment: Assessment, chart: TrustedMarkup | null, vocabulary: Vocabulary): Markup | null {
  const { contact, settings } = assessment;
  const band = contact.band;
  if (!band || bandedRegions(assessment).length === 0) return null;
  const words = settings.shear_modulus_mpa !== null
    ? html`<p>One stiffness was given for all skin, so soft, middle and stiff tissue are the same here.</p>
`
    : html`<p>Other people's skin is softer or stiffer than the middle values used above. Between the soft and the stiff end of the tissue's range, in the same posture, the hand presses with ${rangeWords(band.force_n)} N (middle ${shortNumber(contact.force_n)} N), and the peak on sensor cells is ${rangeWords(band.peak_pressure_cells_mpa)} MPa (middle ${shortNumber(contact.peak_pressure_cells_mpa)} MPa).${limitsWords(assessment, band, vocabulary)} The lines on the bars above show the same per region. The shape of the hand, its posture and the depth have ranges of their own, which are not in these.</p>
${!hasBothEnds(band) && html`<p class="note fair">For one end of the range the contact could not be solved; its place holds a dash.</p>
`}`;
  return html`<h3>How sure are these numbers?</h3>
${words}${sensitivities(assessment, band, chart, vocabulary)}${folded("Every region with soft, middle and stiff tissue", bandTable(assessment, band, vocabulary))}`;
}

/// Whether soft or stiff skin changes which of two products presses harder.
export function bandComparison(first: Assessment, second: Assessment): Markup | null {
  const a = first.contact.band, b = second.contact.band;
  if (!a || !b || !hasBothEnds(a) || !hasBothEnds(b)) return null;
  const signed = (value: number) => (value > 0 ? "+" : "") + shortNumber(value, 2);
  const sign = (value: number) => (value > 0 ? 1 : value < 0 ? -1 : 0);
  const sentence = (what: string, unit: string, key: "force_n" | "peak_pressure_cells_mpa") => {
    const low = (b[key].low || 0) - (a[key].low || 0);
    const middle = b[key].nominal - a[key].nominal;
    const high = (b[key].high || 0) - (a[key].high || 0);
    const isSure = sign(low) === sign(middle) && sign(middle) === sign(high);
    return what + " B − A is " + signed(low) + " " + unit + " with soft, " + signed(middle) + " with middle and " +
      signed(high) + " with stiff tissue" +
      (isSure ? ": the order does not depend on the skin." : ": which is higher depends on the skin.");
  };
  return html`<p><strong>Does the skin change the order?</strong> Both products meet the same skin. ${sentence("Force:", "N", "force_n")} ${sentence("Peak on sensor cells:", "MPa", "peak_pressure_cells_mpa")}</p>
`;
}
