// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What the program runs to write a page: JSON in, a whole page out. No browser is there; the language
// is that of 2009 (ES5), to which the build compiles everything below.

import { AssessmentPage, HandFromMriPage, HandFromScanPage, RefusedScansPage, StudyPage } from "./types";
import { assessmentPage } from "./pages/assessment";
import { handFromMriPage } from "./pages/hand_from_mri";
import { handFromScanPage } from "./pages/hand_from_scan";
import { refusedScansPage } from "./pages/refused_scans";
import { studyPage } from "./pages/study";

type Page = AssessmentPage | StudyPage | HandFromMriPage | HandFromScanPage | RefusedScansPage;

export function render(page: Page): string {
  switch (page.kind) {
    case "assessment":
      return assessmentPage(page);
    case "study":
      return studyPage(page);
    case "hand_from_mri":
      return handFromMriPage(page);
    case "hand_from_scan":
      return handFromScanPage(page);
    case "refused_scans":
      return refusedScansPage(page);
  }
}
