// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <vector>

#include "palmar/geometry/distance/distance_field.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/grasp/indices/grasp_index.h"
#include "palmar/hand/hand.h"

namespace palmar::grasp {

struct FitnessOptions {
  /// Palmar skin within this distance of the product, on either side, and facing it takes part,
  /// mm.
  double reach = 8.0;
  /// Largest angle between skin and product at which the skin counts as facing it, rad; beyond are
  /// the sides of fingers that lie along the product.
  double facing = std::numbers::pi / 3.0;
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// Gaps between skin and product, weighted by the skin's area. Signed: negative where the
/// undeformed skin lies inside the product. mm.
struct GapStatistics {
  double area = 0.0;                   ///< of the skin that takes part, mm^2
  double skin_area = 0.0;              ///< of all palmar skin of the region, mm^2
  double mean = 0.0, deviation = 0.0;  ///< deviation: standard deviation about the mean
  double rms = 0.0, median = 0.0;
  double within_1_mm = 0.0, within_2_mm = 0.0;  ///< share of `area` so near to the mean gap
  /// Mean angle between the skin's normal and that of the product, turned round, rad.
  double normal_angle = 0.0;
};

struct RegionFitness {
  hand::Region region{};
  GapStatistics gap;
};

/// How well the shapes of hand and product agree before the skin gives way.
struct FitnessResult {
  GapStatistics total;                 ///< area 0: nothing is near
  std::vector<RegionFitness> regions;  ///< those with skin near the product, ascending
  double contact_share = 0.0;          ///< of the palmar skin's area: takes part
  double touching_share = 0.0;         ///< of the skin that takes part: inside or on the product
  double reach = 0.0;                  ///< that was used, mm
  double facing = 0.0;                 ///< that was used, rad
};

/// Fitness of a grasp: the gap d(x) between undeformed posed palmar skin and product, over the skin
/// that faces the product within `reach`. A product that follows the hand has the same gap
/// everywhere; so the spread of the gaps is the measure, their mean only says how far the hand
/// closed. After the idea of Endo, Kanai, Miyata, Kouchi, Mochimaru et al. 2007 (Digital Hand:
/// grasp fitness as agreement of finger and product surfaces). The dorsum doesn't count.
///
/// `posed_skin` in the hand frame, one point per skin vertex; areas are those of the reference
/// posture. Throws UsageError.
FitnessResult assess_fitness(const hand::Hand& hand, const std::vector<Vec3>& posed_skin,
                             const geometry::Rigid3& product_from_hand,
                             const geometry::DistanceField& product,
                             const FitnessOptions& options = {});

/// Rows of the group "fitness".
GraspIndices to_indices(const FitnessResult& result);

}  // namespace palmar::grasp
