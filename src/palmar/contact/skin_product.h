// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "palmar/contact/contact.h"

namespace palmar {

/// How the posed skin lies to the product before contact.
struct SkinOnProduct {
  std::vector<Vec3> normal;            ///< of the posed skin, outward, product frame
  std::vector<DistanceSample> sample;  ///< per vertex; capped at 6 mm outside
  std::vector<int> near;               ///< vertices that were sampled, ascending
  std::vector<int> collision;          ///< penetrating vertices that take part, ascending
  std::vector<int> left_out;           ///< penetrating vertices without a surface to go to, or too
                                       ///< deep; ascending
  std::vector<int> traced;   ///< collision vertices whose `sample` isn't the nearest point
                             ///< but the one the skin came through, ascending
  bool is_too_deep = false;  ///< palmar skin deeper than kMaxContactDepth
  std::string message;       ///< what was left out, or empty
};

/// Samples the product near the skin and decides for each penetrating vertex to which side of the
/// product it belongs (see solve_hand_contact()).
SkinOnProduct find_skin_on_product(const Hand& hand, const std::vector<Vec3>& posed,
                                   const DistanceField& product, std::optional<Region> only);

/// Skin farther from the product than this does not matter; beyond the limit depth of the fingers
/// and every bulge.
constexpr double kNearRange = 6.0;  // mm

/// Samples the product at some vertices into their places in `samples`.
void sample_vertices(const DistanceField& product, const std::vector<Vec3>& positions,
                     const std::vector<int>& vertices, double range,
                     std::vector<DistanceSample>& samples);

/// The same for vertices that have moved a little; `samples` holds what they had before (see
/// DistanceField::resample()).
void resample_vertices(const DistanceField& product, const std::vector<Vec3>& positions,
                       const std::vector<int>& vertices, double range,
                       std::vector<DistanceSample>& samples);

}  // namespace palmar
