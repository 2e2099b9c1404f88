// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/study/study_comparison.h"
#include "palmar/study/study_results.h"

namespace palmar {

// Sentences and labels of a study's report.

/// "slips out", "too large for the hand", "no answer": how a grasp ended, as a clause.
std::string plain_words(StudyOutcome outcome);

/// The same from the name of an outcome or "not_run", "no_value"; any other text as it is.
std::string cause_words(const std::string& cause);

/// "Held; peak 0.31 MPa on sensor cells, 3850 mm², 92 N" or why there is nothing to show.
std::string grasp_words(const StudyRecord& record);

/// "17, P5 woman: 164 mm long, 178 mm round": a hand in lists.
std::string hand_words(const StudyPlan& plan, int hand);

/// "p < 0.001", "p = 0.012"
std::string p_words(double p);

/// "Handle r10 has a lower peak pressure on sensor cells than handle r3: 0.21 against 0.34 MPa,
/// 38 % less (difference 0.13, 95 % interval 0.11 to 0.15 MPa; 30 hands, p < 0.001)." One sentence
/// or two about a pair, whatever its verdict.
std::string pair_words(const StudyPlan& plan, const StudyQuantity& quantity,
                       const ProductPair& pair);

/// What left hands out of a pair: "handle r3: 2 slip out, 1 not run"; empty if nothing did.
std::string left_out_words(const StudyPlan& plan, const ProductPair& pair);

}  // namespace palmar
