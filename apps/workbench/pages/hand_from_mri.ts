// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import { HandFromMriPage } from "../types";
import { say, sayCount, useLanguage } from "../texts";
import { FirstScreen, firstScreen } from "../components/first_screen";
import { html } from "../components/markup";
import { fixedNumber } from "../components/numbers";
import { Section, badge } from "../components/parts";
import { boneErrorSection, handNotes, jointRangeSection, kindOf, pictureSection, picturesOf, scansSection, segmentSection, sizeWords, skinSection } from "../components/scan_tables";
import { documentPage } from "./document";

const good = 1.0, fair = 2.0; // mm, mean distance of the skin from its scan: our choice

function answer(page: HandFromMriPage): FirstScreen {
  const { report, view } = page;
  const { hand } = report;
  const { mean_mm, p95_mm } = report.skin_registration;
  const tone = mean_mm < good ? "good" : mean_mm < fair ? "fair" : "bad";
  return {
    kicker: say("mri.kicker", { scans: sayCount("mri.scans", report.scans.length) }),
    tone,
    sentence: say("scan.sentence." + tone, { mean: fixedNumber(mean_mm, 2), p95: fixedNumber(p95_mm, 2) }),
    reasons: [sizeWords(report.side, { length: hand.hand_length_mm, circumference: hand.hand_circumference_mm,
                                       width: hand.hand_width_mm, thickness: hand.hand_thickness_mm }),
              ...report.notes.slice(0, 3)],
    cards: [{
      title: hand.name, badge: badge(tone, say("scan.badge." + tone)),
      pictures: [...kindOf(view.pictures, ["hand_"]).slice(0, 1), ...kindOf(view.pictures, ["error_"]).slice(0, 1)],
      facts: [[say("scan.fact.length"), fixedNumber(hand.hand_length_mm, 1) + " mm"],
              [say("scan.fact.circumference"), fixedNumber(hand.hand_circumference_mm, 1) + " mm"],
              [say("scan.fact.skin"), fixedNumber(mean_mm, 2) + " mm"]],
    }],
    scale: null,
    chart: null,
    next: say("scan.next"),
    command: "palmar assess product.stl --unit mm --hand " + hand.name + ".hand.glb",
  };
}

/// Where the posed hand misses its scans.
function errorSection(page: HandFromMriPage): Section | null {
  const errors = picturesOf(page.view.pictures, ["error_"]);
  return errors && { id: "errors", title: say("mri.errors"), content: html`<p>${say("mri.errors.words")}</p>
${errors}` };
}

/// The page of a hand from MR images: tables 2-2 to 2-5 of Xie (2014) for this person.
export function handFromMriPage(page: HandFromMriPage): string {
  const { report, view } = page;
  useLanguage(view.language);
  const { hand } = report;
  return documentPage({
    title: say("mri.title", { hand: hand.name }),
    first: firstScreen(answer(page)),
    sections: [
      pictureSection("pictures", say("scan.pictures"), view.pictures, ["hand_"]),
      handNotes(report.notes), scansSection(report.scans, view.postures, hand.bones.length), boneErrorSection(report, view.charts), skinSection(report), errorSection(page),
      jointRangeSection(report, view.vocabulary), segmentSection(hand.segments, view.vocabulary),
      pictureSection("scans", say("scan.every"), view.pictures, ["scan_"]),
    ],
    maker: view.maker,
    data: [{ id: "palmar-scan", attachment: "report" }, { id: "palmar-view", attachment: "view" }],
    hasViewer: false,
  });
}
