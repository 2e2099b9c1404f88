// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/study/assessment.h"

namespace palmar {

/// Tables of the HTML report. Every number stands shortened for reading and in full, as in
/// assessment.json, in the cell's data-value.

/// One row per product: held or not, force, area, peaks, hottest region, verdicts.
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
std::string settings_table(const AssessOptions& options);

/// Both verdicts on the pressures as a sentence each (a paragraph); limits and family named.
std::string pressure_verdict(const ContactResult& contact);

}  // namespace palmar
