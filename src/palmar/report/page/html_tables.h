// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/study/assessment/assessment.h"

namespace palmar {

/// Tables of the HTML report. Every number stands shortened for reading and in full, as in
/// assessment.json, in the cell's data-value.

/// "good", "fair" or "bad": style class of a grasp's outcome.
std::string status_class(const Assessment& assessment);

/// One row per product: held or not, force, area, peaks, hottest region, verdicts;
/// dashes where it is not in the hand.
std::string summary_table(const AssessmentSet& set);
/// One row per region in contact and one for all.
std::string region_contact_table(const ContactResult& contact);
/// What stopped each segment.
std::string stop_table(const Grasp& grasp);
/// Joint angles, degrees, with the range of motion.
std::string posture_table(const Hand& hand, const Grasp& grasp);
/// Where the product stands in the hand.
std::string placement_table(const Grasp& grasp);
/// Settings of the assessment.
std::string settings_table(const Assessment& assessment);

/// What both limits mean together for this grip, in one sentence for people.
std::string plain_verdict(const Assessment& assessment);
/// That sentence for every product, as a list.
std::string plain_summary(const AssessmentSet& set);

/// The sentence, then both verdicts on the pressures as a paragraph each; limits and family named.
std::string pressure_verdict(const Assessment& assessment);

}  // namespace palmar
