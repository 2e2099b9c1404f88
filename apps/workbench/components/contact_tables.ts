// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import { Assessment, ContactResult, ContactTotals, FrictionResult, TissueRange, Vocabulary } from "../types";
import { say, sayName } from "../texts";
import { Child, Markup, html } from "./markup";
import { length, nothing, percent, shortNumber } from "./numbers";
import { badge, note } from "./parts";
import { term } from "./glossary";
import { cell, colouredHead, emptyCell, numberCell, numbers, rowHead, table, valueCell, words } from "./tables";
import { isInHand, regionWords, statusVerdict, statusWords } from "./verdicts";

/// "8.7 to 12"; a dash for an end that could not be solved.
export function rangeWords(range: TissueRange): string {
  return say("range", { low: shortNumber(range.low), high: shortNumber(range.high) });
}

function rangeCell(value: number, range: TissueRange | null): Markup {
  if (!range) return numberCell(value);
  return html`<td class="n" data-value="${value}">${shortNumber(value)}<div class="range">${rangeWords(range)}</div></td>`;
}

function resultCells(assessment: Assessment, vocabulary: Vocabulary): Child {
  const { contact, verdict } = assessment;
  const comfort = verdict.comfort;
  if (!isInHand(assessment) || !comfort) {
    // A posture that holds nothing has forces, too, but they say nothing about holding.
    return [emptyCell(), emptyCell(), emptyCell(), emptyCell(), html`<td colspan="3">${say("summary.not_in_hand")}</td>`];
  }
  const band = contact.band;
  return [
    numberCell(contact.grip_force_n),
    rangeCell(contact.peak_pressure_cells_mpa, band && band.peak_pressure_cells_mpa),
    rangeCell(contact.contact_area_mm2, band && band.contact_area_mm2),
    rangeCell(contact.force_n, band && band.force_n),
    cell(say("summary.share", { percent: percent(comfort.moment.share), region: regionWords(comfort.moment.region, vocabulary) })),
    cell(say("summary.share", { percent: percent(comfort.repeated.share), region: regionWords(comfort.repeated.region, vocabulary) })),
    valueCell(comfort.minutes.share_of_skin, percent(comfort.minutes.share_of_skin)),
  ];
}

/// One row per product, linked to its section (#product-N).
export function summaryTable(assessments: Assessment[], vocabulary: Vocabulary): Markup {
  return table({
    caption: say("summary.caption"),
    columns: [words(say("summary.product")), words(say("summary.fit")), numbers(term("grip_force", say("summary.grip_force"))),
              numbers(term("peak_on_cells", say("summary.cells"))), numbers(term("contact_area", say("summary.area"))),
              numbers(term("sum_of_forces", say("summary.force"))), words(say("summary.moment")), words(say("summary.repeated")),
              numbers(say("summary.minutes"))],
    rows: assessments.map((one, i) =>
      html`<tr>${rowHead(html`<a href="#product-${i}">${one.product.name}</a>`)}<td>${badge(statusVerdict(one), statusWords(one, vocabulary))}</td>${resultCells(one, vocabulary)}</tr>`),
  });
}

export function regionTable(contact: ContactResult, vocabulary: Vocabulary): Markup {
  const figures = (one: ContactTotals) => [
    numberCell(one.force_n), numberCell(one.contact_area_mm2), numberCell(one.peak_pressure_mpa),
    numberCell(one.peak_pressure_cells_mpa), numberCell(one.mean_pressure_mpa), numberCell(one.max_penetration_mm)];
  const rows = contact.regions.map((one) => {
    const region = vocabulary.regions[one.region];
    return html`<tr data-region="${one.region}">${colouredHead(region.colour, regionWords(one.region, vocabulary))}${figures(one)}${numberCell(region.discomfort_onset_mpa)}${numberCell(region.pain_onset_mpa)}</tr>`;
  });
  return table({
    caption: say("regions.caption"),
    columns: [words(term("region", say("regions.region"))), numbers(say("regions.force")), numbers(say("regions.area")),
              numbers(term("peak_at_vertex", say("regions.peak"))), numbers(term("peak_on_cells", say("regions.cells"))),
              numbers(say("regions.mean")), numbers(say("regions.depth")), numbers(term("discomfort", say("regions.discomfort"))),
              numbers(term("pain", say("regions.pain")))],
    rows: html`${rows}<tr class="total" data-region="total">${rowHead(say("regions.whole"))}${figures(contact)}<td></td><td></td></tr>`,
  });
}

/// The faces of a product from CAD; nothing for other products.
export function faceSection(assessment: Assessment): Markup | null {
  const faces = assessment.faces;
  if (!faces || faces.length === 0) return null;
  const hottest = faces.filter((one) => one.has_peak).pop();
  const rows = faces.map((one) => html`<tr>${faceHead(one.title, one.part)}${numberCell(one.force_n)}${numberCell(one.contact_area_mm2)}${numberCell(one.area_mm2)}${numberCell(one.peak_pressure_mpa)}${numberCell(one.mean_pressure_mpa)}</tr>
`);
  return html`<h3>${say("faces.title")}</h3>${hottest && html`<p>${say("faces.hottest", { face: hottest.title, pressure: shortNumber(hottest.peak_pressure_mpa, 2) })}</p>
`}${table({
    caption: say("faces.caption"),
    columns: [words(say("faces.face")), numbers(say("faces.force")), numbers(say("faces.pressed")), numbers(say("faces.area")),
              numbers(say("faces.peak")), numbers(say("faces.mean"))],
    rows,
  })}`;
}

export function faceHead(title: string, part: string): Markup {
  const begin = title.charAt(0).toUpperCase() + title.slice(1);
  return rowHead(html`${begin}${part && html`<br><span class="range">${part}</span>`}`);
}

/// Whether friction holds the load. `sentence`: the verdict in words.
export function frictionSection(friction: FrictionResult | undefined, sentence: string, vocabulary: Vocabulary): Markup | null {
  if (!friction || friction.status === "off") return null;
  const begin = say("friction." + (friction.status === "held" || friction.status === "slips" ? friction.status : "not_held"));
  const share = (value: number) => valueCell(100 * value, shortNumber(100 * value, 2));
  const rows = friction.regions.map((one) => html`<tr data-friction-region="${one.region}">${rowHead(regionWords(one.region, vocabulary))}${numberCell(one.normal_force_n)}${numberCell(one.friction_limit_n)}${numberCell(length(one.friction_force_n))}${share(one.slip_margin)}${share(one.slipping_share_of_area)}</tr>`);
  return html`<h3>${say("friction.title")}</h3>${note(friction.status === "held" ? "good" : "bad", begin, sentence)}${rows.length > 0 && html`${table({
    caption: say("friction.caption"),
    columns: [words(say("regions.region")), numbers(say("friction.normal")), numbers(say("friction.most")),
              numbers(say("friction.used")), numbers(say("friction.margin")), numbers(say("friction.slips_area"))],
    rows,
  })}<p>${say("friction.margin.words")}</p>
`}`;
}

export function stopTable(assessment: Assessment, vocabulary: Vocabulary): Markup {
  return table({
    caption: say("stops.caption"),
    columns: [words(say("stops.segment")), words(say("stops.because")), numbers(say("stops.depth"))],
    rows: assessment.grasp.segments.map((one) => html`<tr data-segment="${one.segment}">${rowHead(sayName("region", one.segment, vocabulary.segments[one.segment]))}${cell(sayName("stop", one.stopped_by, vocabulary.stops[one.stopped_by] || one.stopped_by))}${numberCell(one.penetration_mm)}</tr>`),
  });
}

export function postureTable(assessment: Assessment, vocabulary: Vocabulary): Markup {
  const rows: Markup[] = [];
  for (const name in vocabulary.motions) {
    const motion = vocabulary.motions[name];
    const range = motion.lower_deg === null ? nothing
      : say("range", { low: shortNumber(motion.lower_deg, 2), high: shortNumber(motion.upper_deg, 2) });
    rows.push(html`<tr data-dof="${name}">${rowHead(motion.words)}${numberCell(assessment.grasp.posture[name + "_deg"])}<td class="n">${range}</td></tr>`);
  }
  return table({
    caption: say("posture.caption"),
    columns: [words(say("posture.joint")), numbers(say("posture.angle")), numbers(say("posture.range"))],
    rows,
  });
}

/// Three numbers in one cell.
function vectorCell(vector: number[], significant: number): Markup {
  return html`<td class="n" data-value="${vector.join(" ")}">${vector.map((one) => shortNumber(one, significant)).join(", ")}</td>`;
}

export function placementTable(assessment: Assessment): Markup {
  const { grasp } = assessment;
  const place = grasp.product_from_hand;
  const q = place.quaternion_wxyz;
  // Of the two quaternions of a rotation, the one that turns by less than half a turn.
  const sign = q[0] < 0 ? -1 : 1;
  const sine = length(q.slice(1));
  const axis = sine > 0 ? q.slice(1).map((one) => (sign * one) / sine) : [1, 0, 0];
  const angle = (2 * Math.atan2(sine, sign * q[0]) * 180) / Math.PI;
  const row = (name: string, value: Markup) => html`<tr>${rowHead(name)}${value}</tr>`;
  return table({
    caption: say("placement.caption"),
    columns: [words(say("placement.quantity")), numbers(say("placement.value"))],
    rows: [row(say("placement.point"), vectorCell(grasp.grip_point_mm, 4)),
           row(say("placement.axis"), vectorCell(grasp.grip_axis, 3)),
           row(say("placement.girth"), numberCell(grasp.grip_girth_mm, 4)),
           row(say("placement.origin"), vectorCell(place.translation_mm, 4)),
           row(say("placement.turn"), numberCell(angle)),
           row(say("placement.about"), vectorCell(axis, 3))],
  });
}

function sleeveWords(assessment: Assessment): [string, string][] {
  const corner = (p: number[]) => "(" + p.map((one) => shortNumber(one)).join(", ") + ")";
  return assessment.settings.coatings.map((one): [string, string] => {
    const box = one.box_corners_mm;
    const where = box ? say("sleeve.between", { first: corner(box[0]), second: corner(box[1]) }) : say("sleeve.whole");
    return [say("sleeve.title"), say("sleeve.words", {
      thickness: shortNumber(one.thickness_mm), modulus: shortNumber(1000 * one.shear_modulus_mpa),
      poisson: shortNumber(one.poisson, 2), where,
    })];
  });
}

export function settingsTable(assessment: Assessment): Markup {
  const s = assessment.settings;
  const isGiven = s.at_mm !== null || s.axis !== null || s.turn_deg !== null;
  const row = (key: string, value: string): [string, string] => [say("setting." + key), value];
  const choice = (key: string, isFirst: boolean): [string, string] =>
    row(key, say("setting." + key + (isFirst ? ".yes" : ".no")));
  const rows: [string, string][] = [
    row("palm_depth", shortNumber(s.palm_limit_depth_mm) + " mm"),
    row("finger_depth", shortNumber(s.finger_limit_depth_mm) + " mm"),
    choice("placement", isGiven),
    row("grip", assessment.grasp.grip),
    row("grip_force", (s.grip_force_asked_n !== null ? shortNumber(s.grip_force_asked_n) + " N: " : "") + s.grip_force_from),
    choice("rest", s.balance),
    row("equations", s.contact_model),
    choice("kernel", s.kernel === "patch"),
    choice("tissue", s.tissue_model === "halfspace"),
    choice("coupled", s.regions === "coupled"),
    choice("swelling", s.swelling),
    row("cell", shortNumber(s.cell_area_mm2) + " mm²"),
    row("modulus", s.shear_modulus_mpa !== null ? shortNumber(s.shear_modulus_mpa) + " MPa" : say("setting.modulus.grows")),
    ...sleeveWords(assessment),
    choice("band", s.error_band),
    row("seed", String(s.seed)),
  ];
  return table({
    caption: say("settings.caption"),
    columns: [words(say("settings.setting")), words(say("placement.value"))],
    rows: rows.map(([name, value]) => html`<tr>${rowHead(name)}${cell(value)}</tr>`),
  });
}
