// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "palmar/population/dimension_table.h"

namespace palmar::population {

/// Surveys measure the palm between other points than measure_hand() does (wrist crease to the base
/// crease of the middle finger): ANSUR II's is 60 % of hand length, the template's 55 %. Taken for
/// ours, it would leave fingers 10 mm too short.

inline constexpr const char* kPalmLength = "palm_length";
inline constexpr double kLargestPalmShare = 0.575;  ///< half way from the template to ANSUR II

/// Palm length over hand length of the template.
double template_palm_share();

/// Mean palm length over mean hand length of the subjects that have both; nothing if none has.
std::optional<double> palm_share(const DimensionTable& table);

/// For the user, naming the column, if the table's palm isn't Palmar's: share of hand length, what
/// it does to fingers, what to do. Empty otherwise.
std::string palm_warning(const DimensionTable& table);

}  // namespace palmar::population
