// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/skin/thumb_ball.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"

namespace palmar::hand {
namespace {

using ::testing::HasSubstr;

ThumbBallMarkers three_markers() {
  ThumbBallMarkers markers;
  markers.reference = {{0, 0, 0}, {10, 0, 0}, {0, 14, 2}};
  for (std::size_t limit = 0; limit < 4; ++limit) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto a = static_cast<double>(limit), b = static_cast<double>(i);
      markers.missing[limit].emplace_back(1.0 + a, b - 0.5 * a, 0.3 * b);
    }
  }
  return markers;
}

TEST(ThumbBall, MarkersAreMetExactlyAtEachLimitPosture) {
  const ThumbBallMarkers markers = three_markers();
  const ThumbBallCorrection correction = fit_thumb_ball({}, markers);
  const CmcShare limits[4] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  for (std::size_t limit = 0; limit < 4; ++limit) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 offset = thumb_ball_offset(correction, markers.reference[i], limits[limit]);
      EXPECT_NEAR((offset - markers.missing[limit][i]).norm(), 0, 1e-9);  // mm, rounding
    }
  }
}

TEST(ThumbBall, CorrectionGrowsInProportionToTheShareAndVanishesAtRest) {
  const ThumbBallCorrection correction = fit_thumb_ball({}, three_markers());
  const Vec3 point(4, 3, 1);
  EXPECT_EQ(thumb_ball_offset(correction, point, {0, 0}), Vec3::Zero());
  const Vec3 full = thumb_ball_offset(correction, point, {1, 0});
  EXPECT_NEAR((thumb_ball_offset(correction, point, {0.25, 0}) - 0.25 * full).norm(), 0, 1e-12);
}

TEST(ThumbBall, OneMarkerSpreadsAsAGaussian) {
  ThumbBallMarkers markers;
  markers.reference = {{0, 0, 0}};
  for (auto& missing : markers.missing) missing = {{0, 0, 2}};
  const ThumbBallCorrection correction = fit_thumb_ball({}, markers, {.beta = 0.01});
  // 2 mm exp(-0.01 * 100) at 10 mm.
  EXPECT_NEAR(thumb_ball_offset(correction, {10, 0, 0}, {1, 0}).z(), 2 * std::exp(-1.0), 1e-12);
}

TEST(ThumbBall, OnlyVerticesWithinReachAreListed) {
  geometry::TriangleMesh skin;
  skin.vertices = {{0, 0, 0}, {34, 0, 0}, {60, 0, 0}};
  ThumbBallMarkers markers;
  markers.reference = {{0, 0, 0}};
  for (auto& missing : markers.missing) missing = {{1, 0, 0}};
  EXPECT_THAT(fit_thumb_ball(skin, markers).vertex, ::testing::ElementsAre(0, 1));
}

TEST(ThumbBall, CoincidingMarkersAndUnequalCountsAreNamed) {
  ThumbBallMarkers markers = three_markers();
  markers.reference[1] = markers.reference[0];
  EXPECT_THROW(fit_thumb_ball({}, markers), NumericalError);
  markers = three_markers();
  markers.missing[2].pop_back();
  try {
    fit_thumb_ball({}, markers);
    FAIL() << "must throw";
  } catch (const UsageError& e) {
    EXPECT_THAT(e.what(), HasSubstr("3 markers, but 2"));
  }
  EXPECT_THROW(fit_thumb_ball({}, three_markers(), {.beta = 0}), UsageError);
}

}  // namespace
}  // namespace palmar::hand
