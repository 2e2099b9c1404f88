// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import { HandFromScanPage } from "../types";
import { say, useLanguage } from "../texts";
import { FirstScreen, firstScreen } from "../components/first_screen";
import { fixedNumber } from "../components/numbers";
import { badge } from "../components/parts";
import { creaseSection, dotSection, foundSection, handNotes, kindOf, pictureSection, sizeWords, tapeSection, truthSection } from "../components/scan_tables";
import { documentPage } from "./document";

const good = 1.0, fair = 2.0; // mm, mean distance of the skin from its scan: our choice

function answer(page: HandFromScanPage): FirstScreen {
  const { report, view } = page;
  const d = report.dimensions;
  const tone = report.skin_mean_mm < good ? "good" : report.skin_mean_mm < fair ? "fair" : "bad";
  return {
    kicker: say("scan.kicker"),
    tone,
    sentence: say("scan.sentence." + tone, { mean: fixedNumber(report.skin_mean_mm, 2), p95: fixedNumber(report.skin_p95_mm, 2) }),
    reasons: [sizeWords(report.side, { length: d.hand_length_mm, circumference: d.hand_circumference_mm,
                                       width: d.hand_width_mm, thickness: d.hand_thickness_mm }),
              ...report.notes.slice(0, 3)],
    cards: [{
      title: report.hand, badge: badge(tone, say("scan.badge." + tone)),
      pictures: [...kindOf(view.pictures, ["hand_"]).slice(0, 1), ...kindOf(view.pictures, ["distance_"]).slice(0, 1)],
      facts: [[say("scan.fact.length"), fixedNumber(d.hand_length_mm, 1) + " mm"],
              [say("scan.fact.circumference"), fixedNumber(d.hand_circumference_mm, 1) + " mm"],
              [say("scan.fact.skin"), fixedNumber(report.skin_mean_mm, 2) + " mm"]],
    }],
    scale: null,
    chart: null,
    next: say("scan.next"),
    command: "palmar assess product.stl --unit mm --hand " + report.hand + ".hand.glb",
  };
}

/// The page of a hand from surface scans.
export function handFromScanPage(page: HandFromScanPage): string {
  const { report, view } = page;
  useLanguage(view.language);
  return documentPage({
    title: say("scan.title", { hand: report.hand }),
    first: firstScreen(answer(page)),
    sections: [
      pictureSection("pictures", say("scan.pictures"), view.pictures, ["hand_", "distance_"]),
      truthSection(page), handNotes(report.notes), foundSection(page), tapeSection(page), creaseSection(page), dotSection(page),
      pictureSection("scans", say("scan.every"), view.pictures, ["scan_"]),
    ],
    maker: view.maker,
    data: [{ id: "palmar-scan", attachment: "report" }, { id: "palmar-view", attachment: "view" }],
    hasViewer: false,
  });
}
