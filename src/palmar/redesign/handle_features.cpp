// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/handle_features.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"

namespace palmar::redesign {
namespace {

// Shares of the hand's breadth; choices, by where fingers lie: the index finger's middle is 0.36 of
// the breadth from the middle of the hand.
constexpr double kSwellReach = 0.8, kPalmReach = 0.6, kWaistAt = 0.36, kWaistReach = 0.3;
constexpr double kRestReach = 16.0;   // mm; a thumb's breadth is about 20 mm
constexpr double kPerLength = 100.0;  // mm, of taper and twist
constexpr double kDegrees = 180.0 / std::numbers::pi;

/// 1 at 0, 0 from |t| = 1 on, with continuous curvature.
double mound(double t) {
  const double rest = 1.0 - t * t;
  return rest <= 0.0 ? 0.0 : rest * rest * rest;
}

/// 1 in a direction, 0 opposite to it.
double lobe(double angle) {
  const double half = 0.5 * (1.0 + std::cos(angle));
  return half * half * half;
}

/// Four waves over the breadth of the hand, 1 at the middle of each finger; curvature is continuous
/// where they end.
double finger_waves(double share) {
  if (std::abs(share) >= 0.5) return 0.0;
  const double wave = 0.5 * (1.0 - std::cos(8.0 * std::numbers::pi * share));
  return wave * wave;
}

}  // namespace

std::span<const HandleFeature> handle_features() {
  using F = HandleFeatures;
  static const std::array<HandleFeature, 13> all = {{
      {"width", "mm", 1.0, 12.0, 90.0, 0.1, false, &F::width, "across, where the hand lies"},
      {"depth", "mm", 1.0, 12.0, 90.0, 0.1, false, &F::depth, "towards the palm"},
      {"squareness", "", 1.0, 0.0, 2.0, 0.02, false, &F::squareness,
       "0: elliptic, 1: nearly a rectangle"},
      {"taper", "mm/100mm", 1.0, -20.0, 20.0, 0.1, false, &F::taper, "thinner towards the thumb"},
      {"swell", "mm", 1.0, -6.0, 12.0, 0.1, false, &F::swell,
       "of width and depth in the middle of the hand"},
      {"waist", "mm", 1.0, -6.0, 12.0, 0.1, false, &F::waist,
       "of width and depth under index finger and thumb"},
      {"egg", "", 1.0, -0.4, 0.4, 0.01, false, &F::egg, "wider towards the palm"},
      {"palm_swell", "mm", 1.0, -3.0, 10.0, 0.1, false, &F::palm_swell, "into the palm"},
      {"finger_swell", "mm", 1.0, -3.0, 10.0, 0.1, false, &F::finger_swell, "under the fingers"},
      {"thumb_rest", "mm", 1.0, 0.0, 4.0, 0.1, true, &F::thumb_rest, "a hollow under the thumb"},
      {"finger_grooves", "mm", 1.0, 0.0, 4.0, 0.1, false, &F::finger_grooves,
       "depth of four grooves, for the fingers of a mean hand"},
      {"turn", "deg", kDegrees, -90.0, 90.0, 1.0, true, &F::turn, "of the section about the axis"},
      {"twist", "deg/100mm", kDegrees, -60.0, 60.0, 1.0, true, &F::twist,
       "of the section along the handle"},
  }};
  return all;
}

const HandleFeature& handle_feature(const std::string& name) {
  std::vector<std::string> known;
  for (const HandleFeature& one : handle_features()) {
    if (one.name == name) return one;
    known.push_back(one.name);
  }
  const std::string nearest = nearest_name(name, known);
  throw UsageError(fmt::format("handle: no feature \"{}\"{}; {} are allowed", name,
                               nearest.empty() ? "" : ", did you mean " + nearest + "?",
                               fmt::join(known, ", ")));
}

void check(const HandleFeatures& features) {
  constexpr double kRounding = 1e-9;
  for (const HandleFeature& one : handle_features()) {
    const double value = one.scale * features.*one.value;
    if (value >= one.lowest - kRounding && value <= one.highest + kRounding) continue;
    throw UsageError(fmt::format("handle: {} is {:g}{}{}; {:g} to {:g} are allowed", one.name,
                                 value, one.unit.empty() ? "" : " ", one.unit, one.lowest,
                                 one.highest));
  }
}

Eigen::Vector2d section_point(const HandleFeatures& f, const HandleHands& hands, double z,
                              double t) {
  const double breadth = hands.breadth;
  const double more = -f.taper * z / kPerLength + f.swell * mound(z / (kSwellReach * breadth)) -
                      f.waist * mound((z - kWaistAt * breadth) / (kWaistReach * breadth));
  const double a = 0.5 * (f.width + more), b = 0.5 * (f.depth + more);
  const double p = 2.0 + 3.0 * f.squareness;
  const double anomaly = 2.0 * std::numbers::pi * t;
  const double c = std::cos(anomaly), s = std::sin(anomaly);
  const double scale = std::pow(std::pow(std::abs(c), p) + std::pow(std::abs(s), p), -1.0 / p);
  Eigen::Vector2d point(a * c * scale * (1.0 + f.egg * s * scale), b * s * scale);
  const Eigen::Rotation2Dd turned(f.turn + f.twist * z / kPerLength);
  point = turned * point;
  const double phi = std::atan2(point.y(), point.x());
  constexpr double kRight = 0.5 * std::numbers::pi;
  const double along = mound(z / (kPalmReach * breadth));
  const double out = f.palm_swell * along * lobe(phi - kRight) +
                     f.finger_swell * along * lobe(phi + kRight) -
                     f.thumb_rest * mound((z - hands.thumb_at) / kRestReach) *
                         std::pow(lobe(phi - hands.thumb_phi), 4) -
                     f.finger_grooves * finger_waves(z / breadth) * std::pow(lobe(phi + kRight), 2);
  return point * (1.0 + out / point.norm());
}

}  // namespace palmar::redesign
