// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/grasp/power/posable_skin.h"
#include "palmar/grasp/precision/fingertip_ik.h"

namespace palmar::grasp {

/// How deep the skin of a posed hand is in the product, mm; gaps count negative, down to -10.
struct SkinDepth {
  std::array<double, hand::kSegmentCount> palmar{};  ///< deepest palmar skin of each segment
  std::array<double, hand::kSegmentCount> any{};     ///< deepest skin of each segment
};

/// Presses fingertips that touch a product into it.
class FingertipPress {
 public:
  explicit FingertipPress(const FingertipIk& ik);

  /// Every skin vertex by the product's own distance.
  SkinDepth look(const geometry::DistanceField& product, const hand::Posture& posture,
                 const geometry::Rigid3& product_from_hand) const;

  /// Deepest skin within a pulp's breadth of each fingertip point, mm, per goal.
  std::vector<double> depth_at(const geometry::DistanceField& product,
                               const FingertipSolution& hand,
                               const std::vector<FingertipGoal>& goals) const;

  /// Solves again with deeper and deeper goals until the deepest skin of every pulp is `depth` [mm]
  /// in the product, to 0.05 mm. `problem` is started from where it stands; its goals' depths are
  /// overwritten. Fingers that miss their goal anyway are pressed no further than it.
  FingertipSolution press(FingertipProblem& problem, double depth) const;

 private:
  const FingertipIk* ik_;
  PosableSkin skin_;
  std::vector<Vec3> normal_;  ///< of the skin, reference posture
};

}  // namespace palmar::grasp
