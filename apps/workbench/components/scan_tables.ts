// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Tables of hands from scans.

import { BoneError, HandFromMri, HandFromMriPage, HandFromScanPage, Picture, PlaceError, SegmentSize, Vocabulary } from "../types";
import { Child, Markup, html } from "./markup";
import { charts, folded, list, pictureFigures } from "./parts";
import { cell, fixedCell, numbers, rowHead, table, words } from "./tables";

/// "thumb flexion"
export function postureWords(posture: string): string {
  return posture.replace(/_/g, " ");
}

export function sizeWords(side: string, d: { length: number; circumference: number; width: number; thickness: number }): string {
  return (side === "left" ? "Left" : "Right") + " hand, length " + d.length.toFixed(1) + " mm, circumference " +
    d.circumference.toFixed(1) + " mm, width " + d.width.toFixed(1) + " mm, thickness " + d.thickness.toFixed(1) + " mm";
}

/// Pictures whose name begins with one of `kinds`.
export function picturesOf(pictures: Picture[], kinds: string[]): Markup | null {
  return pictureFigures(pictures.filter((one) => kinds.some((kind) => one.name.indexOf(kind) === 0)));
}

export function titled(title: string, content: Child): Markup | null {
  return content ? html`<h2>${title}</h2>
${content}` : null;
}

export function handNotes(notes: string[]): Markup | null {
  return notes.length === 0 ? null : titled("What to know about this hand", list(notes));
}

function fixedTable(caption: Child, heads: string[], rows: Child, texts = 1): Markup {
  return table({ caption, columns: heads.map((one, i) => (i < texts ? words(one) : numbers(one))), rows });
}

function row(head: Child, values: (number | null | undefined)[], decimals: number): Markup {
  return html`<tr>${rowHead(head)}${values.map((one) => fixedCell(one, decimals))}</tr>`;
}

// From MR images.

export function scansSection(page: HandFromMriPage): Markup {
  const { report } = page;
  const rows: Markup[] = [], missing: string[] = [];
  for (const posture of page.view.postures) {
    const scan = report.scans.filter((one) => one.posture === posture)[0];
    if (!scan) {
      missing.push(postureWords(posture));
      continue;
    }
    rows.push(html`<tr>${rowHead(postureWords(posture))}${cell(scan.series)}<td class="n">${scan.bones.length} of ${report.hand.bones.length}</td><td class="n">${scan.markers}</td>${fixedCell(scan.bone_error_estimate_mm)}${fixedCell(scan.air_threshold, 0)}${fixedCell(scan.bone_threshold, 0)}${fixedCell(scan.noise, 1)}</tr>`);
  }
  return html`<h2>What was scanned</h2>
${fixedTable("Scans, and what was found in them",
    ["Posture", "Series", "Bones found", "Markers found", "Expected error of a bone's surface, mm",
     "Air below (intensity)", "Cortical bone below (intensity)", "Noise (intensity)"], rows, 2)}${missing.length > 0 && html`<p>Not scanned: ${missing.join(", ")}.</p>
`}`;
}

const fingerBones = ["proximal phalanges II-V", "middle phalanges II-V", "distal phalanges II-V"];
const thumbBones = ["thumb_metacarpal", "thumb_proximal_phalanx", "thumb_distal_phalanx"];

function errorRows(errors: BoneError[], bones: string[], values: (error: BoneError | undefined) => (number | null | undefined)[]): Markup[] {
  const postures: string[] = [];
  for (const one of errors) if (postures.indexOf(one.posture) < 0) postures.push(one.posture);
  return postures.map((posture) => {
    let all: (number | null | undefined)[] = [];
    for (const bone of bones) {
      all = all.concat(values(errors.filter((one) => one.posture === posture && one.bone === bone)[0]));
    }
    return row(postureWords(posture), all, 2);
  });
}

export function boneErrorSection(report: HandFromMri, figures: string[]): Markup {
  const errors = report.bone_error_rows;
  if (errors.length === 0) {
    return html`<h2>How well the joints reproduce the scans</h2>
<p>No posture but the reference was scanned: the joints are those of the model, fitted to the bones, and can't be tried.</p>
`;
  }
  return html`<h2>How well the joints reproduce the scans</h2>
<p>A bone of the reference scan is moved to another posture, and the mean distance of its surface from the one scanned there is measured: moved freely (the lower limit), by joints with fixed axes, and, for the thumb, by a saddle joint (CMC) interpolated between its scanned limits. Xie (2014) found in two persons, in the limit postures and a grasp: fingers 0.44 to 1.06 mm by joints; thumb 0.80 to 1.22 mm with fixed axes and 0.35 to 0.96 mm interpolated; grasp within 1.5 mm (tables 2-2 to 2-4).</p>
${fixedTable("Fingers II to V: mean distance in mm, moved freely and by the joints",
    ["Posture", "First phalanges, freely", "by joints", "Middle phalanges, freely", "by joints", "Last phalanges, freely", "by joints"],
    errorRows(errors, fingerBones, (one) => one ? [one.icp_mm, one.single_axis_mm] : [null, null]))}${fixedTable(
    "Thumb: mean distance in mm, moved freely, by fixed axes, by the interpolated saddle joint",
    ["Posture", "Metacarpal, freely", "fixed axes", "interpolated", "First phalanx, freely", "fixed axes", "interpolated",
     "Last phalanx, freely", "fixed axes", "interpolated"],
    errorRows(errors, thumbBones, (one) => one ? [one.icp_mm, one.single_axis_mm, one.interpolated_cmc_mm] : [null, null, null]))}${charts(figures)}<p>The grasp was not used to make the joints.</p>
`;
}

function contactSection(report: HandFromMri): Markup {
  const head = html`<h3>Contact with what the grasp holds</h3>
`;
  const c = report.grasp_contact;
  if (!c) {
    const hasGrasp = report.scans.some((one) => one.posture === "grasp");
    return html`${head}<p>Not compared: ${hasGrasp ? html`no product was given (<code>--product FILE</code>, its surface where it was in the scanner).` : "no grasp was scanned."}</p>
`;
  }
  const share = (value: number) => (100 * value).toFixed(0) + " %";
  return html`${head}<p>Skin within ${c.range_mm} mm of ${c.product} counts as touching, of the scanned grasp and of the new hand in the same posture. Of the product's surface that the scanned hand touches, the new hand touches ${share(c.share_of_scan)}; of what the new hand touches, the scanned one touches ${share(c.share_of_hand)}.</p>
${fixedTable("Contact area, mm²",
    ["", "Skin of the scan", "Skin of the new hand", "Product touched by both", "Shared part of all that is touched"],
    html`<tr>${rowHead("grasp")}${fixedCell(c.scanned_area_mm2, 0)}${fixedCell(c.hand_area_mm2, 0)}${fixedCell(c.shared_area_mm2, 0)}<td class="n">${share(c.intersection_over_union)}</td></tr>`)}`;
}

export function skinSection(report: HandFromMri): Markup {
  const rows = report.skin_errors.map((one) =>
    row(postureWords(one.posture), [one.skinning_only_mm, one.markers_alone_mm, one.corrected_mm], 2));
  const { mean_mm, p95_mm } = report.skin_registration;
  const swelling = rows.length > 0
    ? html` When the thumb moves, its ball swells. Skin that follows the joints alone misses that; Xie (2014, table 2-5) found 3.7 mm there, and 0.6 mm once corrected by markers.</p>
${fixedTable("Thumb ball: mean distance of the posed skin from the scanned one, mm",
      ["Posture", "Skin follows the joints alone", "Corrected by the markers alone", "Corrected by markers and scanned skin"], rows)}`
    : html`</p>
<p>No limit posture of the thumb was scanned: the swelling of its ball isn't known.</p>
`;
  return html`<h2>Skin</h2>
<p>In the reference posture the hand's skin lies ${mean_mm.toFixed(2)} mm from the scanned one in the mean, 95 % of it within ${p95_mm.toFixed(2)} mm.${swelling}${contactSection(report)}`;
}

export function jointRangeSection(report: HandFromMri, vocabulary: Vocabulary): Markup {
  const rows = report.joints.map((one) => html`<tr>${rowHead(vocabulary.motions[one.dof].words)}${fixedCell(one.lower_deg, 0)}${fixedCell(one.upper_deg, 0)}${fixedCell(one.reference_deg, 0)}${cell(one.is_measured ? "measured" : "the model's")}</tr>`);
  return html`<h2>Joints</h2>
<p>0 is the straight finger as the model hand has it. An axis is measured if a scan bends the joint far enough; a range ends where a scanned limit posture does, else where the model's does.</p>
${folded("Ranges of motion of all joints",
    table({ caption: "Range, degrees",
            columns: [words("Motion"), numbers("From"), numbers("To"), numbers("In the reference scan"), words("Axis")], rows }))}`;
}

export function segmentSection(segments: { [name: string]: SegmentSize }, vocabulary: Vocabulary): Markup {
  const rows: Markup[] = [];
  for (const name in segments) {
    const one = segments[name];
    rows.push(row(vocabulary.segments[name], [one.length_mm, one.width_mm, one.thickness_mm], 1));
  }
  return html`<h2>Dimensions</h2>
${fixedTable("Segments between the creases, mm", ["Segment", "Length", "Width", "Thickness"], rows)}`;
}

// From surface scans.

export function foundSection(page: HandFromScanPage): Markup {
  const { report, view } = page;
  const rows = view.scans.map((one) => {
    const scan = report.scans[one.posture];
    const mean = one.posture === "reference" ? report.skin_mean_mm : scan && scan.fit_mean_mm;
    const seen = scan && scan.skin_share_seen;
    return html`<tr>${rowHead(postureWords(one.posture))}${cell(one.file)}${fixedCell(one.triangles, 0)}${fixedCell(one.dots, 0)}${fixedCell(one.lines, 0)}${fixedCell(mean)}${fixedCell(seen === undefined ? null : 100 * seen, 0)}</tr>`;
  });
  return html`<h2>Scans</h2>
${fixedTable("What was found in each scan",
    ["Posture", "File", "Triangles", "Dots", "Pieces of lines", "Skin to scan, mm", "Skin seen, %"], rows, 2)}`;
}

export function dotSection(page: HandFromScanPage): Markup | null {
  const joints = page.report.joints_by_dots;
  if (joints.length === 0) return null;
  const rows = joints.map((one) => html`<tr>${rowHead(page.view.vocabulary.segments[one.segment])}${cell(postureWords(one.posture))}${fixedCell(one.turn_deg, 1)}${fixedCell(one.residual_mm)}${fixedCell(one.axis_change_deg, 1)}${fixedCell(one.centre_change_mm, 1)}${fixedCell(one.dots, 0)}</tr>`);
  return html`<h2>Joints by the dots</h2>
<p>How far the joint before each segment turned between the reference scan and another, and how the dots changed the axis that the skin suggested. Dots that end up more than 1.5 mm from where a hinge would take them slid with the skin.</p>
${fixedTable("Joints",
    ["Joint before", "Scan", "Turn, deg", "Dots off, mm", "Axis moved, deg", "Centre moved, mm", "Dots"], rows, 2)}`;
}

export function creaseSection(page: HandFromScanPage): Markup | null {
  const rows: Markup[] = [];
  for (const name in page.report.proximal_creases) {
    rows.push(row(name === "palm" ? "wrist" : "before " + page.view.vocabulary.segments[name],
                  [page.report.proximal_creases[name].distal_of_expected_mm], 1));
  }
  if (rows.length === 0) return null;
  return html`<h2>Creases</h2>
${fixedTable("Drawn creases against where the skin's shape suggests them", ["Crease", "Distal of it, mm"], rows)}`;
}

const fingerPostures: { [posture: string]: string } = {
  reference: "Natural extended posture",
  finger_flexion: "Limit bended posture, full flexion",
  finger_abduction: "Limit bended posture, full abduction",
};

export function truthSection(page: HandFromScanPage): Markup | null {
  const { truth } = page.view;
  if (!truth) return null;
  const axes = { x: "x (breadth)", y: "y (length)", z: "z (thickness)" };
  const place = (one: PlaceError | null) => one && one.place_mm;
  const axis = (one: PlaceError | null) => one && one.axis_deg;
  return html`<h2>Against the truth</h2>
${fixedTable("Dimensions of the 15 segments: differences (Xie 2014: 1.2, 1.1, 1.0 mm)", ["", "Mean, mm", "Largest, mm"],
    truth.dimensions.map((one) => row(axes[one.axis], [one.mean_mm, one.largest_mm], 2)))}${fixedTable(
    "Fingers II to V in the mean (Xie 2014, tables 4-1 and 4-2)",
    ["", "PIP, mm", "PIP axis, deg", "DIP, mm", "DIP axis, deg", "Fingertip, mm"],
    truth.fingers.map((one) => row(fingerPostures[one.posture] || postureWords(one.posture),
                                   [place(one.pip), axis(one.pip), place(one.dip), axis(one.dip), place(one.tip)], 1)))}${truth.thumb_limits.length > 0 && fixedTable(
    "MP joint of the thumb where its metacarpal carries it", ["", "Place, mm", "Axis, deg"],
    truth.thumb_limits.map((one) => row(postureWords(one.posture), [one.place_mm, one.axis_deg], 1)))}${truth.skin && html`<p>Skin: ${truth.skin.mean_mm.toFixed(2)} mm from the true one in the mean, 95 % within ${truth.skin.p95_mm.toFixed(2)} mm.</p>
`}`;
}

export function tapeSection(page: HandFromScanPage): Markup {
  const { report, view } = page;
  const tape = report.along_the_skin, d = report.dimensions;
  const rows = [row("hand", [d.hand_length_mm, tape.hand_length_palmar_mm, tape.hand_length_dorsal_mm, d.hand_width_mm,
                             tape.palm_width_palmar_mm, tape.palm_width_dorsal_mm, d.hand_thickness_mm,
                             d.hand_circumference_mm], 1)];
  for (const name in view.segments) {
    const size = view.segments[name];
    const along = (what: string) => tape[name + "_" + what + "_mm"];
    rows.push(row(view.vocabulary.segments[name],
                  [size.length_mm, along("length_palmar"), along("length_dorsal"), size.width_mm, along("width_palmar"),
                   along("width_dorsal"), size.thickness_mm, along("girth")], 1));
  }
  return html`<h2>Dimensions</h2>
<p>Straight, as calipers measure, and along the skin, as a tape does that is held taut: lengths from crease to crease or to the fingertip, widths from the middle of one side to that of the other, girths all round. Widths, thicknesses and girths are taken half way along each segment, those of hand and palm over the knuckles; the hand reaches from the wrist's crease to the tip of the middle finger, the palm to that finger's base crease.</p>
${fixedTable("Hand and segments between the creases, mm",
    ["", "Length, straight", "along the palm's side", "along the back", "Width, straight", "along the palm's side",
     "along the back", "Thickness", "Girth"], rows)}`;
}
