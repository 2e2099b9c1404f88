// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/report/chart/figure.h"

namespace palmar::report {

/// The matrix of correlations of several dimensions.
struct CorrelationChart {
  std::string title;
  std::vector<std::string> names;
  Eigen::MatrixXd r;                                                   ///< symmetric
  Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> is_significant;  ///< else the number is grey
};

/// Lower triangle as coloured cells (blue -1, white 0, orange 1) with their numbers; above 20
/// dimensions without numbers. Throws UsageError if the sizes don't agree.
Figure correlation_chart(const CorrelationChart& chart);

}  // namespace palmar::report
