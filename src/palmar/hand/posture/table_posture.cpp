// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/posture/table_posture.h"

#include "palmar/geometry/degrees.h"

namespace palmar::hand {

Posture posture_on_table(Posture posture, const FingertipHeights& height) {
  const auto start = height(posture);
  const double table = 0.25 * (start[1] + start[2] + start[3] + start[4]);
  constexpr std::array<Dof, 4> kMcp = {Dof::kIndexMcpFlexion, Dof::kMiddleMcpFlexion,
                                       Dof::kRingMcpFlexion, Dof::kLittleMcpFlexion};
  for (std::size_t f = 0; f < kMcp.size(); ++f) {
    for (int round = 0; round < 3; ++round) {
      constexpr double kStep = 0.01;  // rad
      const double z = height(posture)[f + 1];
      Posture bent = posture;
      bent[kMcp[f]] += kStep;
      posture[kMcp[f]] += (table - z) / ((height(bent)[f + 1] - z) / kStep);
    }
  }
  constexpr double kStep = geometry::kDegree;
  for (int step = 0; step < 40 && height(posture)[0] > table; ++step) {
    posture[Dof::kThumbCmcAbduction] -= kStep;
  }
  return posture;
}

}  // namespace palmar::hand
