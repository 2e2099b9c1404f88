// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import { HandFromScanPage } from "../types";
import { html } from "../components/markup";
import { creaseSection, dotSection, foundSection, handNotes, picturesOf, sizeWords, tapeSection, titled, truthSection } from "../components/scan_tables";
import { documentPage } from "./document";

/// The page of a hand from surface scans.
export function handFromScanPage(page: HandFromScanPage): string {
  const { report, view } = page;
  const d = report.dimensions;
  const sizes = sizeWords(report.side, { length: d.hand_length_mm, circumference: d.hand_circumference_mm,
                                         width: d.hand_width_mm, thickness: d.hand_thickness_mm });
  return documentPage({
    title: "Hand from a scan: " + report.hand,
    summary: html`<p>${sizes}; skin ${report.skin_mean_mm.toFixed(2)} mm from the scan in the mean, 95 % within ${report.skin_p95_mm.toFixed(2)} mm.</p>`,
    body: html`${picturesOf(view.pictures, ["hand_", "distance_"])}${truthSection(page)}${handNotes(report.notes)}${foundSection(page)}${tapeSection(page)}${creaseSection(page)}${dotSection(page)}${titled("Every scan", picturesOf(view.pictures, ["scan_"]))}`,
    maker: view.maker,
    data: [{ id: "palmar-scan", attachment: "report" }, { id: "palmar-view", attachment: "view" }],
    hasViewer: false,
  });
}
