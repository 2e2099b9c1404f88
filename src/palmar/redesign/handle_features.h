// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace palmar::redesign {

inline constexpr double kFullTurn = 2.0 * std::numbers::pi;  ///< rad

/// The numbers from which a handle is shaped, as a designer would give them. Frame of the handle
/// (handle_body.h), mm: z along it towards the thumb's side of the hand, 0 where the middle of the
/// hand lies; y across it towards the palm; x = y x z. Lengths along z are shares of the hand's
/// breadth B over the four fingers.
///
/// The section in the plane of z is a superellipse |x / a|^p + |y / b|^p = 1 (Lame curve; p = 2 +
/// 3 squareness) whose curvature is continuous, with half axes
///
///     a(z) = (width - taper z / 100 mm + swell u(z / (0.8 B)) - waist u((z - 0.36 B) / (0.3 B))) /
///     2
///
/// and b(z) alike with `depth`; u(t) = (1 - t^2)^3 for |t| < 1, else 0. Then x is stretched by 1 +
/// egg y / b, the swells grow outwards by
///
///     palm_swell u(z / (0.6 B)) v(phi - 90 deg) + finger_swell u(z / (0.6 B)) v(phi + 90 deg)
///     - thumb_rest u((z - thumb_at) / 16 mm) v(phi - thumb_phi)^4
///     - finger_grooves w(z / B) v(phi + 90 deg)^2
///
/// where phi is the direction of a point from the centre, v(t) = ((1 + cos t) / 2)^3 and w(s) =
/// ((1 - cos(8 pi s)) / 2)^2 for |s| < 1/2, else 0: four grooves, a finger's breadth apart; and the
/// section is turned by `turn` + twist z / 100 mm, counter-clockwise seen against z.
struct HandleFeatures {
  double width = 32.0, depth = 36.0;  ///< mm; across and towards the palm, where the hand lies
  double squareness = 0.0;            ///< 0: elliptic; 1: nearly a rectangle
  double taper = 0.0;                 ///< mm per 100 mm; thinner towards the thumb
  double swell = 0.0;                 ///< mm of width and depth, in the middle of the hand
  double waist = 0.0;                 ///< mm of width and depth, under index finger and thumb
  double egg = 0.0;                   ///< share; wider towards the palm
  double palm_swell = 0.0;            ///< mm, outwards
  double finger_swell = 0.0;          ///< mm, outwards, opposite to the palm
  double thumb_rest = 0.0;            ///< mm, a hollow under the thumb
  double finger_grooves = 0.0;        ///< mm, depth of four, under the fingers of a mean hand
  double turn = 0.0;                  ///< rad
  double twist = 0.0;                 ///< rad per 100 mm
};

/// Where hands lie on a handle: what the features are placed by.
struct HandleHands {
  double breadth = 80.0;                    ///< B, mm
  double thumb_at = 30.0, thumb_phi = 0.0;  ///< mm, rad: where the thumb presses, z and phi
};

/// A feature by name, for files, options and searches.
struct HandleFeature {
  std::string name;           ///< "width", "palm_swell"
  std::string unit;           ///< "mm", "mm/100mm", "deg", "deg/100mm"; "" for shares
  double scale = 1.0;         ///< value in its unit / value in HandleFeatures
  double lowest, highest;     ///< that make sense, in its unit
  double step;                ///< of a search, in its unit
  bool is_one_sided = false;  ///< suits one hand only: a shape for both goes without
  double HandleFeatures::*value;
  std::string meaning;  ///< for people
};
std::span<const HandleFeature> handle_features();
/// Throws UsageError with the nearest name.
const HandleFeature& handle_feature(const std::string& name);
/// Throws UsageError: feature, value, allowed range.
void check(const HandleFeatures& features);

/// Point of the section, mm from its centre; `t` goes round once from 0 to 1, counter-clockwise.
Eigen::Vector2d section_point(const HandleFeatures& features, const HandleHands& hands, double z,
                              double t);

}  // namespace palmar::redesign
