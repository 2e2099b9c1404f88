// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace palmar::report {

/// A coordinate as SVG and PDF take it: two decimals without trailing zeros, independent of the
/// locale; 1/100 point is 3.5 micrometres on paper.
std::string figure_number(double value);

}  // namespace palmar::report
