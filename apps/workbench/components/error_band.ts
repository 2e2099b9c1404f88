// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// How much the results depend on how soft or stiff people's skin is.

import { Assessment, ContactBand, ContactTotals, RegionContact, TrustedMarkup, Vocabulary } from "../types";
import { say } from "../texts";
import { term } from "./glossary";
import { Markup, html } from "./markup";
import { shortNumber, signedNumber } from "./numbers";
import { charts, folded } from "./parts";
import { groupedTable, numberCell, rowHead } from "./tables";
import { rangeWords } from "./contact_tables";
import { regionWords } from "./verdicts";

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
    html`<tr data-band-region="${region.region}">${rowHead(regionWords(region.region, vocabulary))}${cells(region, band)}</tr>`);
  return groupedTable({
    id: "error-band",
    caption: say("band.caption"),
    first: say("regions.region"),
    groups: [say("regions.force"), say("regions.area"), say("regions.cells")],
    parts: [say("band.soft"), say("band.middle"), say("band.stiff")],
    last: say("band.sensitivity"),
    rows: html`${rows}<tr class="total" data-band-region="total">${rowHead(say("regions.whole"))}${cells(assessment.contact, total)}</tr>`,
  });
}

function sensitivities(assessment: Assessment, total: ContactBand, chart: TrustedMarkup | null, vocabulary: Vocabulary): Markup {
  const sorted = bandedRegions(assessment).sort((a, b) => b.band.force_per_modulus_n - a.band.force_per_modulus_n);
  // The fewest regions that make up half of it.
  let sum = 0, half = 0;
  while (half < sorted.length && sum < 0.5 * total.force_per_modulus_n) sum += sorted[half++].band.force_per_modulus_n;
  const first = say("band.first", {
    region: regionWords(sorted[0].region.region, vocabulary),
    force: shortNumber(stiffer * sorted[0].band.force_per_modulus_n, 2),
  });
  const together = half > 1 ? say("band.half", { half, count: sorted.length }) : say("band.half_alone");
  // Force is homogeneous of degree one in all moduli (Euler): what the skin's sensitivities leave of
  // it is the sleeve's.
  const sleeve = stiffer * (assessment.contact.force_n - total.force_per_modulus_n);
  return html`<p>${first} ${together}${assessment.settings.coatings.length > 0 && " " + say("band.sleeve", { force: shortNumber(sleeve, 2) })}</p>
${chart && charts([chart])}`;
}

/// `chart`: the force that 10 % stiffer skin adds, region by region.
export function errorBandSection(assessment: Assessment, chart: TrustedMarkup | null, vocabulary: Vocabulary): Markup | null {
  const { contact, settings } = assessment;
  const band = contact.band;
  if (!band || bandedRegions(assessment).length === 0) return null;
  const words = settings.shear_modulus_mpa !== null
    ? html`<p>${say("band.one_stiffness")}</p>
`
    : html`<p>${say("band.words", {
      force: rangeWords(band.force_n), middle_force: shortNumber(contact.force_n),
      cells: rangeWords(band.peak_pressure_cells_mpa), middle_cells: shortNumber(contact.peak_pressure_cells_mpa),
    })}</p>
${!hasBothEnds(band) && html`<p class="note fair">${say("band.unsolved")}</p>
`}`;
  return html`<h3>${say("band.title")} ${term("error_band")}</h3>
${words}${sensitivities(assessment, band, chart, vocabulary)}${folded(say("band.folded"), bandTable(assessment, band, vocabulary))}`;
}

/// Whether soft or stiff skin changes which of two products presses harder.
export function bandComparison(first: Assessment, second: Assessment): Markup | null {
  const a = first.contact.band, b = second.contact.band;
  if (!a || !b || !hasBothEnds(a) || !hasBothEnds(b)) return null;
  const sign = (value: number) => (value > 0 ? 1 : value < 0 ? -1 : 0);
  const sentence = (what: string, unit: string, key: "force_n" | "peak_pressure_cells_mpa") => {
    const low = (b[key].low || 0) - (a[key].low || 0);
    const middle = b[key].nominal - a[key].nominal;
    const high = (b[key].high || 0) - (a[key].high || 0);
    const isSure = sign(low) === sign(middle) && sign(middle) === sign(high);
    return say("order.sentence", { what, unit, low: signedNumber(low, 2), middle: signedNumber(middle, 2), high: signedNumber(high, 2) }) +
      " " + say(isSure ? "order.sure" : "order.depends");
  };
  return html`<p><strong>${say("order.title")}</strong> ${say("order.same_skin")} ${sentence(say("order.force"), "N", "force_n")} ${sentence(say("order.cells"), "MPa", "peak_pressure_cells_mpa")}</p>
`;
}
