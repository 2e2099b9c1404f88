// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/study_record.h"

namespace palmar::study {

std::string name_of(StudyOutcome outcome) {
  switch (outcome) {
    case StudyOutcome::kHeld:
      return "held";
    case StudyOutcome::kPartlyHeld:
      return "partly_held";
    case StudyOutcome::kSlipsOut:
      return "slips_out";
    case StudyOutcome::kTooLarge:
      return "too_large";
    case StudyOutcome::kTooSmall:
      return "too_small";
    case StudyOutcome::kNotGraspable:
      return "not_graspable";
    case StudyOutcome::kFailed:
      break;
  }
  return "failed";
}

bool is_same(const StudyHold& a, const StudyHold& b) {
  const grasp::Hold &x = a.hold, &y = b.hold;
  return x.part == y.part && x.grip == y.grip && x.along == y.along && x.edge == y.edge &&
         x.toward == y.toward && x.turn == y.turn && x.is_over_end == y.is_over_end &&
         a.words == b.words;
}

}  // namespace palmar::study
