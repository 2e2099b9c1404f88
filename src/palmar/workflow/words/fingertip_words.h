// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/workflow/effort/effort_fingertip.h"

namespace palmar::workflow {

/// Throws UsageError.
hand::Finger parse_finger(const std::string& text);
/// "mcp=40,pip=55,dip=35" (degrees) as angles of that finger. Throws UsageError.
std::vector<DigitAngle> parse_digit_posture(hand::Finger finger, const std::string& text);
/// One tendon, or none for "all". Throws UsageError.
std::vector<hand::Tendon> parse_tendons(hand::Finger finger, const std::string& text);
/// Where the fingers' tendons run ("synek2019", "an1979") and the shares of the extensor hood
/// ("synek2019", "chao1989"). Throws UsageError.
hand::TendonModel parse_tendon_model(const std::string& points, const std::string& hood);

}  // namespace palmar::workflow
