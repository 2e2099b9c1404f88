// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import { HandFromMriPage } from "../types";
import { html } from "../components/markup";
import { boneErrorSection, handNotes, jointRangeSection, picturesOf, scansSection, segmentSection, sizeWords, skinSection, titled } from "../components/scan_tables";
import { counted } from "../components/numbers";
import { documentPage } from "./document";

/// The page of a hand from MR images: tables 2-2 to 2-5 of Xie (2014) for this person.
export function handFromMriPage(page: HandFromMriPage): string {
  const { report, view } = page;
  const { hand } = report;
  const errors = picturesOf(view.pictures, ["error_"]);
  const sizes = sizeWords(report.side, { length: hand.hand_length_mm, circumference: hand.hand_circumference_mm,
                                         width: hand.hand_width_mm, thickness: hand.hand_thickness_mm });
  return documentPage({
    title: "Hand from MRI: " + hand.name,
    summary: html`<p>${sizes}; from ${counted(report.scans.length, "scan")}.</p>`,
    body: html`${picturesOf(view.pictures, ["hand_"])}${handNotes(report.notes)}${scansSection(page)}${boneErrorSection(report, view.charts)}${skinSection(report)}${errors && html`<h3>Where the posed hand misses the scan</h3>
<p>Grey: nothing to compare with (markers, skin that touches skin, the cut through the forearm).</p>
${errors}`}${jointRangeSection(report, view.vocabulary)}${segmentSection(hand.segments, view.vocabulary)}${titled("Every scan", picturesOf(view.pictures, ["scan_"]))}`,
    maker: view.maker,
    data: [{ id: "palmar-scan", attachment: "report" }, { id: "palmar-view", attachment: "view" }],
    hasViewer: false,
  });
}
