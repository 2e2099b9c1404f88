// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Tables of hands from scans.

import { BoneError, HandFromMri, HandFromScanPage, Picture, PlaceError, SegmentSize, Vocabulary } from "../types";
import { say, sayName } from "../texts";
import { Child, Markup, html } from "./markup";
import { fixedNumber } from "./numbers";
import { Section, charts, folded, list, pictureFigures } from "./parts";
import { cell, fixedCell, numbers, rowHead, table, words } from "./tables";

/// "thumb flexion"
export function postureWords(posture: string): string {
  return sayName("posture.name", posture, posture.replace(/_/g, " "));
}

export function sizeWords(side: string, d: { length: number; circumference: number; width: number; thickness: number }): string {
  return say(side === "left" ? "scan.size.left" : "scan.size.right", {
    length: fixedNumber(d.length, 1), circumference: fixedNumber(d.circumference, 1),
    width: fixedNumber(d.width, 1), thickness: fixedNumber(d.thickness, 1),
  });
}

/// Pictures whose name begins with one of `kinds`.
export function kindOf(pictures: Picture[], kinds: string[]): Picture[] {
  return pictures.filter((one) => kinds.some((kind) => one.name.indexOf(kind) === 0));
}

export function picturesOf(pictures: Picture[], kinds: string[]): Markup | null {
  return pictureFigures(kindOf(pictures, kinds));
}

export function pictureSection(id: string, title: string, pictures: Picture[], kinds: string[]): Section | null {
  const content = picturesOf(pictures, kinds);
  return content && { id, title, content };
}

export function handNotes(notes: string[]): Section | null {
  return notes.length === 0 ? null : { id: "notes", title: say("scan.notes"), content: list(notes) };
}

function fixedTable(caption: Child, heads: string[], rows: Child, texts = 1): Markup {
  return table({ caption, columns: heads.map((one, i) => (i < texts ? words(one) : numbers(one))), rows });
}

function row(head: Child, values: (number | null | undefined)[], decimals: number): Markup {
  return html`<tr>${rowHead(head)}${values.map((one) => fixedCell(one, decimals))}</tr>`;
}

// From MR images.

/// `postures`: all that can be scanned; `bones`: how many a hand has.
export function scansSection(scans: HandFromMri["scans"], postures: string[], bones: number): Section {
  const rows: Markup[] = [], missing: string[] = [];
  for (const posture of postures) {
    const scan = scans.filter((one) => one.posture === posture)[0];
    if (!scan) {
      missing.push(postureWords(posture));
      continue;
    }
    rows.push(html`<tr>${rowHead(postureWords(posture))}${cell(scan.series)}<td class="n">${say("study.of", { count: scan.bones.length, n: bones })}</td><td class="n">${scan.markers}</td>${fixedCell(scan.bone_error_estimate_mm)}${fixedCell(scan.air_threshold, 0)}${fixedCell(scan.bone_threshold, 0)}${fixedCell(scan.noise, 1)}</tr>`);
  }
  return {
    id: "scanned",
    title: say("mri.scanned"),
    content: html`${fixedTable(say("mri.found"),
      [say("scan.posture"), say("mri.series"), say("mri.bones"), say("mri.markers"), say("mri.expected"),
       say("mri.air"), say("mri.cortical"), say("mri.noise")], rows, 2)}${missing.length > 0 && html`<p>${say("mri.not_scanned", { postures: missing.join(", ") })}</p>
`}`,
  };
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

export function boneErrorSection(report: HandFromMri, figures: string[]): Section {
  const errors = report.bone_error_rows;
  const section = (content: Child): Section => ({ id: "bones", title: say("mri.reproduce"), content });
  if (errors.length === 0) return section(html`<p>${say("mri.only_reference")}</p>
`);
  const freely = say("mri.freely"), byJoints = say("mri.by_joints"), fixed = say("mri.fixed"), saddle = say("mri.interpolated");
  return section(html`<p>${say("mri.reproduce.words")}</p>
${fixedTable(say("mri.fingers"),
    [say("scan.posture"), say("mri.first") + ", " + freely, byJoints, say("mri.middle") + ", " + freely, byJoints, say("mri.last") + ", " + freely, byJoints],
    errorRows(errors, fingerBones, (one) => one ? [one.icp_mm, one.single_axis_mm] : [null, null]))}${fixedTable(
    say("mri.thumb"),
    [say("scan.posture"), say("mri.metacarpal") + ", " + freely, fixed, saddle, say("mri.first") + ", " + freely, fixed, saddle,
     say("mri.last") + ", " + freely, fixed, saddle],
    errorRows(errors, thumbBones, (one) => one ? [one.icp_mm, one.single_axis_mm, one.interpolated_cmc_mm] : [null, null, null]))}${charts(figures)}<p>${say("mri.grasp_unused")}</p>
`);
}

function contactSection(report: HandFromMri): Markup {
  const head = html`<h3>${say("mri.contact")}</h3>
`;
  const c = report.grasp_contact;
  if (!c) {
    const hasGrasp = report.scans.some((one) => one.posture === "grasp");
    return html`${head}<p>${say(hasGrasp ? "mri.contact.no_product" : "mri.contact.no_grasp")}</p>
`;
  }
  const share = (value: number) => fixedNumber(100 * value, 0) + " %";
  return html`${head}<p>${say("mri.contact.words", { range: c.range_mm, product: c.product, of_scan: share(c.share_of_scan), of_hand: share(c.share_of_hand) })}</p>
${fixedTable(say("mri.contact.area"),
    ["", say("mri.contact.scan"), say("mri.contact.hand"), say("mri.contact.both"), say("mri.contact.shared")],
    html`<tr>${rowHead(postureWords("grasp"))}${fixedCell(c.scanned_area_mm2, 0)}${fixedCell(c.hand_area_mm2, 0)}${fixedCell(c.shared_area_mm2, 0)}<td class="n">${share(c.intersection_over_union)}</td></tr>`)}`;
}

export function skinSection(report: HandFromMri): Section {
  const rows = report.skin_errors.map((one) =>
    row(postureWords(one.posture), [one.skinning_only_mm, one.markers_alone_mm, one.corrected_mm], 2));
  const { mean_mm, p95_mm } = report.skin_registration;
  return {
    id: "skin",
    title: say("mri.skin"),
    content: html`<p>${say("mri.skin.words", { mean: fixedNumber(mean_mm, 2), p95: fixedNumber(p95_mm, 2) })} ${rows.length > 0 ? say("mri.skin.swells") : say("mri.skin.no_limits")}</p>
${rows.length > 0 && fixedTable(say("mri.skin.caption"),
      [say("scan.posture"), say("mri.skin.joints"), say("mri.skin.markers"), say("mri.skin.both")], rows)}${contactSection(report)}`,
  };
}

export function jointRangeSection(report: HandFromMri, vocabulary: Vocabulary): Section {
  const rows = report.joints.map((one) => html`<tr>${rowHead(vocabulary.motions[one.dof].words)}${fixedCell(one.lower_deg, 0)}${fixedCell(one.upper_deg, 0)}${fixedCell(one.reference_deg, 0)}${cell(say(one.is_measured ? "mri.joints.measured" : "mri.joints.model"))}${fixedCell(one.axis_error_deg, 1)}</tr>`);
  return {
    id: "joints",
    title: say("mri.joints"),
    content: html`<p>${say("mri.joints.words")}</p>
${folded(say("mri.joints.folded"),
      table({ caption: say("mri.joints.caption"),
              columns: [words(say("mri.joints.motion")), numbers(say("mri.joints.from")), numbers(say("mri.joints.to")), numbers(say("mri.joints.reference")), words(say("mri.joints.axis")), numbers(say("mri.joints.error"))], rows }))}`,
  };
}

export function segmentSection(segments: { [name: string]: SegmentSize }, vocabulary: Vocabulary): Section {
  const rows: Markup[] = [];
  for (const name in segments) {
    const one = segments[name];
    rows.push(row(segmentWords(name, vocabulary), [one.length_mm, one.width_mm, one.thickness_mm], 1));
  }
  return {
    id: "dimensions",
    title: say("scan.dimensions"),
    content: fixedTable(say("scan.segments"), [say("stops.segment"), say("scan.length"), say("scan.width"), say("scan.thickness")], rows),
  };
}

function segmentWords(name: string, vocabulary: Vocabulary): string {
  return sayName("region", name, vocabulary.segments[name]);
}

// From surface scans.

export function foundSection(page: HandFromScanPage): Section {
  const { report, view } = page;
  const rows = view.scans.map((one) => {
    const scan = report.scans[one.posture];
    const mean = one.posture === "reference" ? report.skin_mean_mm : scan && scan.fit_mean_mm;
    const seen = scan && scan.skin_share_seen;
    return html`<tr>${rowHead(postureWords(one.posture))}${cell(one.file)}${fixedCell(one.triangles, 0)}${fixedCell(one.dots, 0)}${fixedCell(one.lines, 0)}${fixedCell(mean)}${fixedCell(seen === undefined ? null : 100 * seen, 0)}</tr>`;
  });
  return {
    id: "found",
    title: say("scan.scans"),
    content: fixedTable(say("scan.found"),
      [say("scan.posture"), say("scan.file"), say("scan.triangles"), say("scan.dots"), say("scan.lines"), say("scan.skin_to_scan"), say("scan.seen")], rows, 2),
  };
}

export function dotSection(page: HandFromScanPage): Section | null {
  const joints = page.report.joints_by_dots;
  if (joints.length === 0) return null;
  const rows = joints.map((one) => html`<tr>${rowHead(segmentWords(one.segment, page.view.vocabulary))}${cell(postureWords(one.posture))}${fixedCell(one.turn_deg, 1)}${fixedCell(one.residual_mm)}${fixedCell(one.axis_change_deg, 1)}${fixedCell(one.axis_error_deg, 1)}${fixedCell(one.centre_change_mm, 1)}${fixedCell(one.dots, 0)}</tr>`);
  return {
    id: "dots",
    title: say("scan.by_dots"),
    content: html`<p>${say("scan.by_dots.words")}</p>
${fixedTable(say("mri.joints"),
      [say("scan.joint_before"), say("scan.scan"), say("scan.turn"), say("scan.dots_off"), say("scan.axis_moved"), say("scan.axis_error"), say("scan.centre_moved"), say("scan.dots")], rows, 2)}`,
  };
}

export function creaseSection(page: HandFromScanPage): Section | null {
  const rows: Markup[] = [];
  for (const name in page.report.proximal_creases) {
    rows.push(row(name === "palm" ? say("scan.wrist") : say("scan.before", { segment: segmentWords(name, page.view.vocabulary) }),
                  [page.report.proximal_creases[name].distal_of_expected_mm], 1));
  }
  if (rows.length === 0) return null;
  return { id: "creases", title: say("scan.creases"), content: fixedTable(say("scan.creases.caption"), [say("scan.crease"), say("scan.distal")], rows) };
}

export function truthSection(page: HandFromScanPage): Section | null {
  const { truth } = page.view;
  if (!truth) return null;
  const place = (one: PlaceError | null) => one && one.place_mm;
  const axis = (one: PlaceError | null) => one && one.axis_deg;
  return {
    id: "truth",
    title: say("truth.title"),
    content: html`${fixedTable(say("truth.dimensions"), ["", say("truth.mean"), say("truth.largest")],
      truth.dimensions.map((one) => row(say("truth.axis." + one.axis), [one.mean_mm, one.largest_mm], 2)))}${fixedTable(
      say("truth.fingers"),
      ["", "PIP, mm", say("truth.pip_axis"), "DIP, mm", say("truth.dip_axis"), say("truth.tip")],
      truth.fingers.map((one) => row(sayName("truth.posture", one.posture, postureWords(one.posture)),
                                     [place(one.pip), axis(one.pip), place(one.dip), axis(one.dip), place(one.tip)], 1)))}${truth.thumb_limits.length > 0 && fixedTable(
      say("truth.thumb"), ["", say("truth.place"), say("truth.axis")],
      truth.thumb_limits.map((one) => row(postureWords(one.posture), [one.place_mm, one.axis_deg], 1)))}${truth.skin && html`<p>${say("truth.skin", { mean: fixedNumber(truth.skin.mean_mm, 2), p95: fixedNumber(truth.skin.p95_mm, 2) })}</p>
`}`,
  };
}

export function tapeSection(page: HandFromScanPage): Section {
  const { report, view } = page;
  const tape = report.along_the_skin, d = report.dimensions;
  const rows = [row(say("tape.hand"), [d.hand_length_mm, tape.hand_length_palmar_mm, tape.hand_length_dorsal_mm, d.hand_width_mm,
                             tape.palm_width_palmar_mm, tape.palm_width_dorsal_mm, d.hand_thickness_mm,
                             d.hand_circumference_mm], 1)];
  for (const name in view.segments) {
    const size = view.segments[name];
    const along = (what: string) => tape[name + "_" + what + "_mm"];
    rows.push(row(segmentWords(name, view.vocabulary),
                  [size.length_mm, along("length_palmar"), along("length_dorsal"), size.width_mm, along("width_palmar"),
                   along("width_dorsal"), size.thickness_mm, along("girth")], 1));
  }
  return {
    id: "dimensions",
    title: say("scan.dimensions"),
    content: html`<p>${say("tape.words")}</p>
${fixedTable(say("tape.caption"),
      ["", say("tape.length"), say("tape.palm_side"), say("tape.back"), say("tape.width"), say("tape.palm_side"),
       say("tape.back"), say("scan.thickness"), say("tape.girth")], rows)}`,
  };
}
