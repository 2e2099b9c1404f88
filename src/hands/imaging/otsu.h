// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace palmar::imaging {

/// The place that parts a histogram in two classes of least variance, as a number of bins: bins
/// below it are one class. Where empty bins lie between the classes, their middle, so halves occur;
/// of a histogram with fewer than two bins that aren't empty, 1.
///
/// Source: Otsu 1979, "A threshold selection method from gray-level histograms", eq. (12), (18).
double otsu_threshold(const std::vector<double>& histogram);

}  // namespace palmar::imaging
