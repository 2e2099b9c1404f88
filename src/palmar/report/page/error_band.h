// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/study/assessment/assessment.h"

namespace palmar {

/// The error band in the HTML report (ContactBand: results for soft and stiff tissue), in words and
/// tables for ergonomists. Numbers stand shortened, in full in the cell's data-value.

/// Whether the solution for low, high tissue was found; what is not found is shown as a dash.
bool has_low(const ContactBand& band);
bool has_high(const ContactBand& band);

/// "161 to 297", of two values; "–" for one that is missing.
std::string range_words(double low, double high, bool is_low, bool is_high);

/// "How sure are these numbers?": ranges of the whole hand and of each region, and which region's
/// stiffness matters most for the total force. Empty without a band.
std::string error_band_section(const Assessment& assessment);

/// Whether the difference of two products has the same sign for soft, nominal and stiff tissue, as
/// a paragraph. Empty unless both have a band.
std::string band_comparison(const AssessedProduct& first, const AssessedProduct& second);

}  // namespace palmar
