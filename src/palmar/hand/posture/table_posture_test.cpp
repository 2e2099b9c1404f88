// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/posture/table_posture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "palmar/geometry/degrees.h"

namespace palmar::hand {
namespace {

TEST(PostureOnTable, BringsFingertipsToTheirMeanHeightAndTheThumbNoLower) {
  // Stiff fingers of 80 mm whose bases lie at 3, 6, 9, 12 mm, a thumb of 50 mm from 20 mm.
  constexpr std::array<Dof, 4> kMcp = {Dof::kIndexMcpFlexion, Dof::kMiddleMcpFlexion,
                                       Dof::kRingMcpFlexion, Dof::kLittleMcpFlexion};
  const auto height = [&](const Posture& p) {
    std::array<double, kFingerCount> z{20.0 + 50.0 * std::sin(p[Dof::kThumbCmcAbduction])};
    for (std::size_t f = 0; f < 4; ++f) {
      z[f + 1] = 3.0 * static_cast<double>(f + 1) + 80.0 * std::sin(p[kMcp[f]]);
    }
    return z;
  };
  Posture start;
  start[Dof::kIndexPipFlexion] = 0.1;
  const Posture placed = posture_on_table(start, height);
  for (std::size_t f = 0; f < 4; ++f) {
    const double rise = 7.5 - 3.0 * static_cast<double>(f + 1);  // to the mean
    EXPECT_NEAR(placed[kMcp[f]], std::asin(rise / 80.0), 1e-6) << f;
  }
  // asin((7.5 - 20) / 50) is -14.5 degrees; it turns by whole ones.
  EXPECT_NEAR(placed[Dof::kThumbCmcAbduction], -15.0 * geometry::kDegree, 1e-12);
  EXPECT_EQ(placed[Dof::kIndexPipFlexion], 0.1);
}

TEST(PostureOnTable, AdductsAThumbThatStaysLowByNoMoreThanFortyDegrees) {
  const auto height = [](const Posture& p) {
    return std::array<double, kFingerCount>{
        30.0, std::sin(p[Dof::kIndexMcpFlexion]), std::sin(p[Dof::kMiddleMcpFlexion]),
        std::sin(p[Dof::kRingMcpFlexion]), std::sin(p[Dof::kLittleMcpFlexion])};
  };
  EXPECT_NEAR(posture_on_table({}, height)[Dof::kThumbCmcAbduction], -40.0 * geometry::kDegree,
              1e-12);
}

}  // namespace
}  // namespace palmar::hand
