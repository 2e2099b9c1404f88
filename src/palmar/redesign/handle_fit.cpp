// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The features that come nearest to what a handle is now.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "palmar/redesign/handle_body.h"

namespace palmar::redesign {
namespace {

constexpr int kFitColumns = 144;  // 2.5 degrees apart
constexpr double kFitTurn = 2.0 * std::numbers::pi;

double mean_value(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Share of its box that a superellipse fills; 1 for a rectangle, pi / 4 for an ellipse.
double fill_of(double p) {
  return std::exp(2.0 * std::lgamma(1.0 + 1.0 / p) - std::lgamma(1.0 + 2.0 / p));
}

/// Between which z the features are wholly there; all but the ends if they are so nowhere.
std::array<double, 2> shaped_length(const HandleBody& body,
                                    const std::array<double, 2>& kept_ends) {
  constexpr double kLeast = 12.0;  // mm, for a taper
  const double margin = body.is_whole ? body.end_radius + 1.0 : 1.0;
  const std::array<double, 2> all = {body.bottom + margin, body.top - margin};
  std::array<double, 2> ends = {0.0, 0.0};
  for (const std::size_t end : {0, 1}) {
    if (!body.is_whole && !body.is_free[end]) ends[end] = body.run_out;
    if (body.is_whole && kept_ends[end] > 0.0) ends[end] = kept_ends[end] + kShapeBlend;
  }
  const std::array<double, 2> shaped = {std::max(all[0], body.bottom + ends[0]),
                                        std::min(all[1], body.top - ends[1])};
  return shaped[1] - shaped[0] < kLeast ? all : shaped;
}

}  // namespace

FittedFeatures fit_features(const HandleBody& body, const std::array<double, 2>& kept_ends) {
  const std::array<double, 2> shaped = shaped_length(body, kept_ends);
  const double low = shaped[0], high = shaped[1];
  const auto radii_at = [&](double z) {
    std::vector<double> radii;
    for (int k = 0; k < kFitColumns; ++k)
      radii.push_back(body.outlines.at(z, kFitTurn * k / kFitColumns));
    return radii;
  };
  const std::vector<double> here = radii_at(std::clamp(0.0, low, high));
  double second_c = 0.0, second_s = 0.0, fourth_c = 0.0, fourth_s = 0.0, area = 0.0;
  for (int k = 0; k < kFitColumns; ++k) {
    const double phi = kFitTurn * k / kFitColumns, r = here[static_cast<std::size_t>(k)];
    second_c += std::pow(r, 4) * std::cos(2.0 * phi);
    second_s += std::pow(r, 4) * std::sin(2.0 * phi);
    fourth_c += r * std::cos(4.0 * phi);
    fourth_s += r * std::sin(4.0 * phi);
    area += 0.5 * r * r * kFitTurn / kFitColumns;
  }
  FittedFeatures fitted;
  HandleFeatures& f = fitted.features;
  const double mean = mean_value(here);
  constexpr double kRound = 0.02;  // of the radius: below it a direction means nothing
  const double oblong = std::hypot(second_c, second_s) / (kFitColumns * std::pow(mean, 4));
  const double square = std::hypot(fourth_c, fourth_s) / (kFitColumns * mean);
  if (oblong > 2.0 * kRound) {
    // The longer axis to the nearer of x and y.
    const double longer = 0.5 * std::atan2(second_s, second_c);
    f.turn = std::remainder(longer, 0.5 * std::numbers::pi);
  } else if (square > 0.5 * kRound) {
    f.turn = std::remainder(0.25 * (std::atan2(fourth_s, fourth_c) + std::numbers::pi),
                            0.5 * std::numbers::pi);
  }
  const auto extent_along = [&](const std::vector<double>& radii, double direction) {
    double least = 0.0, most = 0.0;
    for (int k = 0; k < kFitColumns; ++k) {
      const double along =
          radii[static_cast<std::size_t>(k)] * std::cos(kFitTurn * k / kFitColumns - direction);
      least = std::min(least, along);
      most = std::max(most, along);
    }
    return most - least;
  };
  f.width = extent_along(here, f.turn);
  f.depth = extent_along(here, f.turn + 0.5 * std::numbers::pi);
  const double fill = area / (f.width * f.depth);
  if (const double by = fill / fill_of(2.0); by < 1.0) {
    f.width *= std::sqrt(by);
    f.depth *= std::sqrt(by);
  }
  double least = 0.0, most = 2.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (least + most);
    (fill_of(2.0 + 3.0 * middle) < fill ? least : most) = middle;
  }
  f.squareness = least;
  double sum_z = 0.0, sum_zz = 0.0, sum_d = 0.0, sum_zd = 0.0;
  int count = 0;
  for (const double z : body.outlines.z) {
    if (z < low || z > high) continue;
    const double diameter = 2.0 * mean_value(radii_at(z));
    sum_z += z;
    sum_zz += z * z;
    sum_d += diameter;
    sum_zd += z * diameter;
    ++count;
  }
  const double spread = count * sum_zz - sum_z * sum_z;
  if (spread > 0.0) f.taper = -100.0 * (count * sum_zd - sum_z * sum_d) / spread;
  for (const HandleFeature& one : handle_features()) {
    f.*one.value = std::clamp(f.*one.value, one.lowest / one.scale, one.highest / one.scale);
  }
  double squares = 0.0;
  int points = 0;
  for (const double z : body.outlines.z) {
    if (z < low || z > high) continue;
    for (int k = 0; k < kFitColumns; ++k) {
      const Eigen::Vector2d point =
          section_point(f, body.hands, z, static_cast<double>(k) / kFitColumns);
      const double off = point.norm() - body.outlines.at(z, std::atan2(point.y(), point.x()));
      squares += off * off;
      ++points;
    }
  }
  if (points > 0) fitted.rms = std::sqrt(squares / points);
  return fitted;
}

}  // namespace palmar::redesign
