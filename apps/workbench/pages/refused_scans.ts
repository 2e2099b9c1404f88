// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import { RefusedScansPage } from "../types";
import { say, sayCount, useLanguage } from "../texts";
import { firstScreen } from "../components/first_screen";
import { badge } from "../components/parts";
import { handNotes, kindOf, pictureSection, postureWords, scansSection } from "../components/scan_tables";
import { documentPage } from "./document";

/// The page of MR images that no hand came of: the step that failed and why, and what was found until then.
export function refusedScansPage(page: RefusedScansPage): string {
  const { report, view } = page;
  useLanguage(view.language);
  const { step, posture, message } = report.refusal;
  const reference = report.scans[0];
  const shown = kindOf(view.pictures, ["scan_" + posture + "_"]);
  return documentPage({
    title: say("refused.title"),
    first: firstScreen({
      kicker: say("mri.kicker", { scans: sayCount("mri.scans", report.scans.length) }),
      tone: "bad",
      sentence: posture ? say("refused.sentence.posture", { step: say("refused.step." + step), posture: postureWords(posture) })
                        : say("refused.sentence", { step: say("refused.step." + step) }),
      reasons: [message],
      cards: [{
        title: say("refused.card"), badge: badge("bad", say("refused.badge")),
        pictures: shown.length > 0 ? shown : kindOf(view.pictures, ["scan_reference_"]),
        facts: [[say("mri.bones"), say("study.of", { count: reference.bones.length, n: view.bones })],
                [say("refused.unnamed"), String(reference.unnamed_bones)],
                [say("mri.markers"), String(reference.markers)]],
      }],
      scale: null,
      chart: null,
      next: say("refused.next"),
      command: "palmar hand from-mri IMAGES --known person.toml --out hand.hand.glb",
    }),
    sections: [
      pictureSection("scans", say("scan.every"), view.pictures, ["scan_"]),
      scansSection(report.scans, view.postures, view.bones), handNotes(report.notes),
    ],
    maker: view.maker,
    data: [{ id: "palmar-scan", attachment: "report" }, { id: "palmar-view", attachment: "view" }],
    hasViewer: false,
  });
}
