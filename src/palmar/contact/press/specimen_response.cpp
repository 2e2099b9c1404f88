// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/press/specimen_response.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"

namespace palmar::contact {
namespace {

constexpr int kMostDepths = 32;
constexpr int kThicknesses = 16;
constexpr double kThickest = 100.0;  // mm; a half-space to every finger

std::vector<double> geometric_row(double first, double last, int count) {
  std::vector<double> row;
  for (int i = 0; i < count; ++i) row.push_back(first * std::pow(last / first, i / (count - 1.0)));
  row.back() = last;
  return row;
}

bool is_ascending(const std::vector<double>& values) {
  return std::is_sorted(values.begin(), values.end()) &&
         std::adjacent_find(values.begin(), values.end()) == values.end() &&
         (values.empty() || values.front() > 0.0);
}

}  // namespace

void SpecimenResponse::check() const {
  if (depth.empty() || !is_ascending(depth) || !is_ascending(thickness)) {
    throw UsageError(
        "response of a specimen: depths and thicknesses must be ascending, more than 0 mm, with at "
        "least one depth");
  }
  const auto rows = static_cast<Eigen::Index>(depth.size());
  const auto columns = static_cast<Eigen::Index>(std::max<std::size_t>(1, thickness.size()));
  if (force.rows() != rows || force.cols() != columns || area.rows() != rows ||
      area.cols() != columns) {
    throw UsageError("response of a specimen: its tables don't match its " + std::to_string(rows) +
                     " depths and " + std::to_string(columns) + " thicknesses");
  }
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < columns; ++j) {
      if (force(i, j) > 0.0 && std::isfinite(force(i, j)) && area(i, j) >= 0.0) continue;
      std::ostringstream message;
      message << "response of a specimen: at a depth of " << depth[i] << " mm the force is "
              << force(i, j)
              << " N per MPa; more than 0 is required (is the depth above the mesh's resolution?)";
      throw UsageError(message.str());
    }
  }
}

SpecimenResponse specimen_response(const PressOptions& test, const std::vector<double>& depths,
                                   const std::vector<double>& thickness, const PreparedHand* hand) {
  SpecimenResponse response;
  response.depth = depths;
  std::sort(response.depth.begin(), response.depth.end());
  response.depth.erase(std::unique(response.depth.begin(), response.depth.end()),
                       response.depth.end());
  if (response.depth.empty()) throw UsageError("response of a specimen: no depth is given");
  if (response.depth.size() > kMostDepths) {
    response.depth = geometric_row(response.depth.front(), response.depth.back(), kMostDepths);
  }
  response.thickness = thickness;
  const auto rows = static_cast<Eigen::Index>(response.depth.size());
  const auto columns = static_cast<Eigen::Index>(std::max<std::size_t>(1, thickness.size()));
  response.force.resize(rows, columns);
  response.area.resize(rows, columns);
  parallel_for(static_cast<int>(rows * columns), [&](int k) {
    const Eigen::Index i = k / columns;
    const Eigen::Index j = k % columns;
    PressOptions one = test;
    one.forces.clear();
    one.depths = {response.depth[i]};
    one.shear_modulus = 1.0;  // MPa
    if (!thickness.empty()) one.layer_thickness = thickness[j];
    const PressStep step = press(one, hand).front();
    response.force(i, j) = step.force;
    response.area(i, j) = step.area;
  });
  response.check();
  return response;
}

std::vector<double> thicknesses_to_try(double deepest) {
  if (!(deepest > 0.0 && 1.1 * deepest < kThickest)) {
    throw UsageError("thickness of a layer: the deepest point is " + std::to_string(deepest) +
                     " mm; more than 0 and less than " + std::to_string(kThickest / 1.1) +
                     " mm is required");
  }
  return geometric_row(1.1 * deepest, kThickest, kThicknesses);
}

PowerCurve::PowerCurve(const std::vector<double>& x, const Eigen::VectorXd& y) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    log_x_.push_back(std::log(x[i]));
    log_y_.push_back(std::log(y[static_cast<Eigen::Index>(i)]));
  }
  const std::size_t n = x.size();
  slope_.assign(n, 0.0);
  if (n < 2) return;
  const auto secant = [this](std::size_t i) {
    return (log_y_[i + 1] - log_y_[i]) / (log_x_[i + 1] - log_x_[i]);
  };
  slope_.front() = secant(0);
  slope_.back() = secant(n - 2);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = log_x_[i] - log_x_[i - 1];
    const double after = log_x_[i + 1] - log_x_[i];
    slope_[i] = (after * secant(i - 1) + before * secant(i)) / (before + after);
  }
  if (n < 3) return;
  // The ends too take the slope of the parabola.
  slope_.front() = 2.0 * secant(0) - slope_[1];
  slope_.back() = 2.0 * secant(n - 2) - slope_[n - 2];
}

PowerCurve::Value PowerCurve::at(double x) const {
  if (log_x_.size() == 1) return {std::exp(log_y_.front()), 0.0};
  const double u = std::log(x);
  const auto next = std::upper_bound(log_x_.begin() + 1, log_x_.end() - 1, u);
  const auto i = static_cast<std::size_t>(next - log_x_.begin()) - 1;
  const double width = log_x_[i + 1] - log_x_[i];
  const double t = std::clamp((u - log_x_[i]) / width, 0.0, 1.0);
  const double rise = log_y_[i + 1] - log_y_[i];
  const double a = width * slope_[i] - rise;
  const double b = rise - width * slope_[i + 1];
  const double log_y = log_y_[i] + t * rise + t * (1.0 - t) * ((1.0 - t) * a + t * b);
  const double slope =
      (rise + (1.0 - 2.0 * t) * ((1.0 - t) * a + t * b) + t * (1.0 - t) * (b - a)) / width;
  return {std::exp(log_y), slope};
}

}  // namespace palmar::contact
