// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/statistics/proportion.h"
#include "palmar/study/statistics/study_results.h"

namespace palmar::study {

/// Whether a grasp is inside all limits: in the hand, and every limited quantity has a value within
/// its edges (the edges count as inside).
bool is_inside(const StudyRecord& record, const std::vector<StudyLimit>& limits);

/// Why hands are outside; a hand may have several causes.
struct OutsideCause {
  std::string cause;  ///< "slips_out", "peak_pressure_cells_mpa above 0.3", "force_n has no value"
  int hands = 0;
};

/// Share of hands that a product suits under one condition. A hand that doesn't hold the product is
/// outside; a grasp that wasn't run is neither.
struct Accommodation {
  StudyCondition condition;
  int product = 0;
  int not_run = 0;                 ///< hands
  statistics::Proportion in_hand;  ///< held at least partly, of those that were run
  statistics::Proportion inside;   ///< of those that were run
  std::vector<statistics::Proportion> inside_limit;         ///< of StudyPlan::limits one by one
  std::vector<OutsideCause> causes;                         ///< most frequent first
  std::optional<double> shortest_outside, longest_outside;  ///< hand length, mm
  std::optional<double> shortest_inside, longest_inside;    ///< hand length, mm
};
/// Of every condition and product, conditions first. Intervals after Wilson.
std::vector<Accommodation> accommodation(const StudyResults& results, double level = 0.95);
Accommodation accommodation_of(const StudyResults& results, const StudyCondition& condition,
                               int product, double level = 0.95);

/// "peak pressure on sensor cells at most 0.3 MPa", "contact area 2000 to 4000 mm²".
std::string words_of(const StudyResults& results, const StudyLimit& limit);

}  // namespace palmar::study
