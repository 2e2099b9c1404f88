// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import { Assessment, ContactResult, ContactTotals, FrictionResult, TissueRange, Vocabulary } from "../types";
import { Child, Markup, html } from "./markup";
import { length, nothing, percent, shortNumber } from "./numbers";
import { badge, note } from "./parts";
import { cell, colouredHead, emptyCell, numberCell, numbers, rowHead, table, valueCell, words } from "./tables";
import { isInHand, nearestToPain, regionsWithoutBloodFlow, statusVerdict, statusWords } from "./verdicts";

/// "8.7 to 12"; a dash for an end that could not be solved.
export function rangeWords(range: TissueRange): string {
  return shortNumber(range.low) + " to " + shortNumber(range.high);
}

function rangeCell(value: number, range: TissueRange | null): Markup {
  if (!range) return numberCell(value);
  return html`<td class="n" data-value="${value}">${shortNumber(value)}<div class="range">${rangeWords(range)}</div></td>`;
}

function resultCells(assessment: Assessment, vocabulary: Vocabulary): Child {
  const contact = assessment.contact;
  const nearest = nearestToPain(contact, vocabulary);
  if (!isInHand(assessment) || !nearest) {
    // A posture that holds nothing has forces, too, but they say nothing about holding.
    return [emptyCell(), emptyCell(), emptyCell(), emptyCell(), emptyCell(), cell(nothing),
            html`<td colspan="2">not in the hand: nothing to judge</td>`];
  }
  let hottest = contact.regions[0];
  for (const one of contact.regions) {
    if (one.peak_pressure_cells_mpa > hottest.peak_pressure_cells_mpa) hottest = one;
  }
  const share = percent(nearest.share) + " of pain onset";
  const pain = nearest.share >= 1 ? "Above pain onset: " : nearest.share >= 0.5 ? "Near: " : "Below: ";
  const band = contact.band;
  return [
    numberCell(contact.grip_force_n),
    rangeCell(contact.force_n, band && band.force_n),
    rangeCell(contact.contact_area_mm2, band && band.contact_area_mm2),
    rangeCell(contact.peak_pressure_mpa, band && band.peak_pressure_mpa),
    rangeCell(contact.peak_pressure_cells_mpa, band && band.peak_pressure_cells_mpa),
    cell(vocabulary.regions[hottest.region].words),
    cell(pain + share),
    cell(regionsWithoutBloodFlow(contact, vocabulary) + " of " + contact.regions.length + " regions above " +
         shortNumber(vocabulary.blood_flow_stop_mpa, 1) + " MPa"),
  ];
}

/// One row per product, linked to its section (#product-N).
export function summaryTable(assessments: Assessment[], vocabulary: Vocabulary): Markup {
  return table({
    caption: "Results at a glance",
    columns: [words("Product"), words("Does it fit?"), numbers("Grip force, N"), numbers("Force, N"), numbers("Contact area, mm²"),
              numbers("Peak pressure, MPa"), numbers("Peak on sensor cells, MPa"),
              words("Hottest region (sensor cells)"), words("Firm grip for a moment: pain (film peak)"),
              words("Grip held long: blood flow (sensor cells)")],
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
    return html`<tr data-region="${one.region}">${colouredHead(region.colour, region.words)}${figures(one)}${numberCell(region.pain_onset_mpa)}</tr>`;
  });
  return table({
    caption: "Contact by region of the hand",
    columns: [words("Region"), numbers("Force, N"), numbers("Area, mm²"), numbers("Peak, MPa"),
              numbers("Peak on cells, MPa"), numbers("Mean, MPa"),
              numbers("Depth before the skin gives way, mm"), numbers("Pain onset (film peak), MPa")],
    rows: html`${rows}<tr class="total" data-region="total">${rowHead("Whole hand")}${figures(contact)}<td></td></tr>`,
  });
}

/// The faces of a product from CAD; nothing for other products.
export function faceSection(assessment: Assessment): Markup | null {
  const faces = assessment.faces;
  if (!faces || faces.length === 0) return null;
  const hottest = faces.filter((one) => one.has_peak).pop();
  const rows = faces.map((one) => html`<tr>${faceHead(one.title, one.part)}${numberCell(one.force_n)}${numberCell(one.contact_area_mm2)}${numberCell(one.area_mm2)}${numberCell(one.peak_pressure_mpa)}${numberCell(one.mean_pressure_mpa)}</tr>
`);
  return html`<h3>Faces of the product</h3>${hottest && html`<p>Highest pressure on the product: ${hottest.title}, ${shortNumber(hottest.peak_pressure_mpa, 2)} MPa.</p>
`}${table({
    caption: "What the hand does to each face. Pressures count per area of the product, where skin that bends covers less than when it is flat, so they can differ by some ten per cent from those on the skin.",
    columns: [words("Face"), numbers("Force, N"), numbers("Area under pressure, mm²"), numbers("Area of the face, mm²"),
              numbers("Peak pressure, MPa"), numbers("Mean pressure, MPa")],
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
  const begin = friction.status === "held" ? "Held by friction." : friction.status === "slips" ? "Slips." : "Not held.";
  const share = (value: number) => valueCell(100 * value, shortNumber(100 * value, 2));
  const rows = friction.regions.map((one) => html`<tr data-friction-region="${one.region}">${rowHead(vocabulary.regions[one.region].words)}${numberCell(one.normal_force_n)}${numberCell(one.friction_limit_n)}${numberCell(length(one.friction_force_n))}${share(one.slip_margin)}${share(one.slipping_share_of_area)}</tr>`);
  return html`<h3>Friction</h3>${note(friction.status === "held" ? "good" : "bad", begin, sentence)}${rows.length > 0 && html`${table({
    caption: "Friction per region",
    columns: [words("Region"), numbers("Normal force, N"), numbers("Friction at most, N"),
              numbers("Friction in use, vector, N"), numbers("Slip margin, %"), numbers("Area that slips, %")],
    rows,
  })}<p>Slip margin: the share of the friction, coefficient times pressure, that is not in use; 0 where all of the region slips.</p>
`}`;
}

export function stopTable(assessment: Assessment, vocabulary: Vocabulary): Markup {
  return table({
    caption: "What stopped each segment",
    columns: [words("Segment"), words("Stopped because"), numbers("Depth in the product, mm (minus: gap)")],
    rows: assessment.grasp.segments.map((one) => html`<tr data-segment="${one.segment}">${rowHead(vocabulary.segments[one.segment])}${cell(vocabulary.stops[one.stopped_by] || one.stopped_by)}${numberCell(one.penetration_mm)}</tr>`),
  });
}

export function postureTable(assessment: Assessment, vocabulary: Vocabulary): Markup {
  const rows: Markup[] = [];
  for (const name in vocabulary.motions) {
    const motion = vocabulary.motions[name];
    const range = motion.lower_deg === null ? nothing
      : shortNumber(motion.lower_deg, 2) + " to " + shortNumber(motion.upper_deg, 2);
    rows.push(html`<tr data-dof="${name}">${rowHead(motion.words)}${numberCell(assessment.grasp.posture[name + "_deg"])}<td class="n">${range}</td></tr>`);
  }
  return table({
    caption: "Posture of the joints",
    columns: [words("Joint"), numbers("Angle, °"), numbers("Range of motion, °")],
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
    caption: "Placement (product frame)",
    columns: [words("Quantity"), numbers("Value")],
    rows: [row("Grip point, mm", vectorCell(grasp.grip_point_mm, 4)),
           row("Grip axis, towards the thumb", vectorCell(grasp.grip_axis, 3)),
           row("Girth of the product at the grip, mm", numberCell(grasp.grip_girth_mm, 4)),
           row("Hand origin (wrist), mm", vectorCell(place.translation_mm, 4)),
           row("Turn of the hand, °", numberCell(angle)),
           row("About the axis", vectorCell(axis, 3))],
  });
}

function sleeveWords(assessment: Assessment): [string, string][] {
  const corner = (p: number[]) => "(" + p.map((one) => shortNumber(one)).join(", ") + ")";
  return assessment.settings.coatings.map((one): [string, string] => {
    const box = one.box_corners_mm;
    return ["Sleeve on the product",
            shortNumber(one.thickness_mm) + " mm thick, shear modulus " + shortNumber(1000 * one.shear_modulus_mpa) +
            " kPa, Poisson's ratio " + shortNumber(one.poisson, 2) +
            (box ? ", between " + corner(box[0]) + " and " + corner(box[1]) + " mm" : ", on the whole product")];
  });
}

export function settingsTable(assessment: Assessment): Markup {
  const s = assessment.settings;
  const isGiven = s.at_mm !== null || s.axis !== null || s.turn_deg !== null;
  const rows: [string, string][] = [
    ["Limit depth of the palm", shortNumber(s.palm_limit_depth_mm) + " mm"],
    ["Limit depth of the fingers", shortNumber(s.finger_limit_depth_mm) + " mm"],
    ["Placement", isGiven ? "as asked" : "found from the product's shape"],
    ["Grip", assessment.grasp.grip],
    ["Grip force", (s.grip_force_asked_n !== null ? shortNumber(s.grip_force_asked_n) + " N: " : "") + s.grip_force_from],
    ["Comes to rest", s.balance ? "yes" : "no"],
    ["Equations of the contact", s.contact_model],
    ["Kernel", s.kernel === "patch" ? "patch (uniform pressure on each vertex's area)" : "point (Xie 2014, r held at 0.5 mm)"],
    ["Under the skin", s.tissue_model === "halfspace" ? "half-space" : "layer bonded to the bone"],
    ["Regions", s.regions === "coupled" ? "solved together" : "solved one by one"],
    ["Swelling of the skin", s.swelling ? "on" : "off"],
    ["Sensor cell", shortNumber(s.cell_area_mm2) + " mm²"],
    ["Shear modulus", s.shear_modulus_mpa !== null ? shortNumber(s.shear_modulus_mpa) + " MPa" : "grows with depth, per region"],
    ...sleeveWords(assessment),
    ["Ranges for soft and stiff tissue", s.error_band ? "on" : "left out"],
    ["Seed", String(s.seed)],
  ];
  return table({
    caption: "Settings",
    columns: [words("Setting"), words("Value")],
    rows: rows.map(([name, value]) => html`<tr>${rowHead(name)}${cell(value)}</tr>`),
  });
}
