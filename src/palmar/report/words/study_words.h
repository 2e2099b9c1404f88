// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/study/statistics/study_comparison.h"
#include "palmar/study/statistics/study_results.h"
#include "palmar/study/statistics/study_statistics.h"

namespace palmar::report {

// Sentences and labels of a study's report.

/// "slips out", "too large for the hand", "no answer": how a grasp ended, as a clause.
std::string plain_words(study::StudyOutcome outcome);

/// The same from the name of an outcome or "not_run", "no_value"; any other text as it is.
std::string cause_words(const std::string& cause);

/// "Held; peak 0.31 MPa on sensor cells, 3850 mm², 92 N" or why there is nothing to show.
std::string grasp_words(const study::StudyRecord& record);

/// "17, P5 woman: 164 mm long, 178 mm round": a hand in lists.
std::string hand_words(const study::StudyPlan& plan, const study::StudyCondition& condition,
                       int hand);

/// "1 hand", "6 hands"
std::string counted(int number, const std::string& one);

/// What sets a condition apart from the others of its plan: "gloves", "ANSUR II women, tripod";
/// "" if it is the only one.
std::string condition_words(const study::StudyPlan& plan, const study::StudyCondition& condition);

/// Whether there are enough hands for a 5th and a 95th percentile: five.
bool has_percentiles(const study::QuantitySummary& one);

/// "p < 0.001", "p = 0.012"
std::string p_words(double p);

/// "Handle r10 has a lower peak pressure on sensor cells than handle r3: 0.21 against 0.34 MPa,
/// 38 % less (difference 0.13, 95 % interval 0.11 to 0.15 MPa; 30 hands, p < 0.001)." One sentence
/// or two about a pair, whatever its verdict.
std::string pair_words(const study::StudyPlan& plan, const study::StudyQuantity& quantity,
                       const study::ProductPair& pair);

/// "They are held at different grip forces (47 and 80 N): leave out limit_depths to compare at
/// equal force."; "" if the mean grip forces over hands that hold both differ by 10 % or less, or
/// aren't known.
std::string grip_force_words(const study::StudyResults& results,
                             const study::StudyCondition& condition, int first, int second);

/// How firmly a setting has hands grip: "grip force 107 N: 25 % of what ... reach on a
/// dynamometer";
/// "" where they stay as they were closed.
std::string grip_force_words(const study::StudySetting& setting);

/// What left hands out of a pair: "handle r3: 2 slip out, 1 not run"; empty if nothing did.
std::string left_out_words(const study::StudyPlan& plan, const study::ProductPair& pair);

}  // namespace palmar::report
