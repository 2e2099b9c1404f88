// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/handle_ends.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/product/primitives.h"
#include "palmar/redesign/handle_shape.h"

namespace palmar::redesign {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// A bar of 120 mm along z, gripped from -40 to 40, of a radius by z and direction.
template <typename Radius>
HandleBody bar(const Radius& radius) {
  HandleBody body;
  body.is_whole = true;
  body.bottom = -60.0;
  body.top = 60.0;
  body.gripped = {-40.0, 40.0};
  body.centre = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  body.outlines.columns = 144;
  for (int j = 0; j <= 60; ++j) {
    const double z = -60.0 + 2.0 * j;
    body.outlines.z.push_back(z);
    body.outlines.radius.emplace_back();
    for (int k = 0; k < 144; ++k) {
      body.outlines.radius.back().push_back(radius(z, 2.0 * std::numbers::pi * k / 144));
    }
  }
  return body;
}

TEST(GrippedLength, IsWhereHandsPressAndTheirSpreadMore) {
  HandleBody body = bar([](double, double) { return 15.0; });
  body.product_from_handle.translation = Vec3(0.0, 0.0, 100.0);
  HandsOnHandle hands;
  hands.spread = 5.0;
  EXPECT_EQ(gripped_length(body, hands), (std::array<double, 2>{-60.0, 60.0}));  // nothing known
  for (const double shift : {-4.0, 4.0}) {
    hands.pressures.emplace_back();
    for (int z = -30; z <= 30; ++z) {
      hands.pressures.back().push_back({Vec3(15.0, 0.0, 100.0 + shift + z), 0.1});
    }
  }
  const auto [low, high] = gripped_length(body, hands);  // 2 % of 61 are less than two of them
  EXPECT_NEAR(low, -34.0, 1.01);
  EXPECT_NEAR(high, 34.0, 1.01);
}

TEST(OtherEnds, ABarThatGoesOnAlikeHasNone) {
  const std::array<double, 2> none = {0.0, 0.0};
  EXPECT_EQ(other_ends(bar([](double, double) { return 15.0; })), none);
  EXPECT_EQ(other_ends(bar([](double z, double) { return 15.0 - 0.05 * z; })), none);  // a taper
  // A brick.
  EXPECT_EQ(other_ends(bar([](double, double phi) {
              return 15.0 / std::max(std::abs(std::cos(phi)), 0.75 * std::abs(std::sin(phi)));
            })),
            none);
}

TEST(OtherEnds, AFootAndAWaistedNeckAreNotTheHandle) {
  const auto foot = other_ends(bar(
      [](double z, double phi) { return 15.0 + (z < -45.0 && std::cos(phi) > 0.5 ? 6.0 : 0.0); }));
  EXPECT_EQ(foot, (std::array<double, 2>{20.0, 0.0}));
  const auto neck = other_ends(bar([](double z, double) { return z > 50.0 ? 8.0 : 15.0; }));
  EXPECT_EQ(neck, (std::array<double, 2>{0.0, 20.0}));
  // From 30 mm on, where fingers still lie (up to 40): outlines are 2 mm apart.
  const auto held_neck = other_ends(bar([](double z, double) { return z > 29.0 ? 8.0 : 15.0; }));
  EXPECT_EQ(held_neck, (std::array<double, 2>{0.0, 30.0}));
}

TEST(OtherEnds, ANeckIsAsLongHoweverMuchOfItIsGripped) {
  HandleBody body = bar([](double z, double) { return z > 9.0 ? 8.0 : 15.0 + 0.05 * z; });
  for (const double high : {20.0, 30.0, 50.0}) {
    body.gripped = {-55.0, high};
    EXPECT_EQ(other_ends(body), (std::array<double, 2>{0.0, 50.0})) << high;
  }
}

TEST(KeptLengths, LeaveHalfOfTheRunOutToTheGripButNoneOfANeck) {
  const auto foot = kept_lengths(bar(
      [](double z, double phi) { return 15.0 + (z < -45.0 && std::cos(phi) > 0.5 ? 6.0 : 0.0); }));
  EXPECT_EQ(foot, (std::array<double, 2>{13.0, 0.0}));  // gripped from -40 on, 7 mm less
  const auto held_neck = kept_lengths(bar([](double z, double) { return z > 29.0 ? 8.0 : 15.0; }));
  EXPECT_EQ(held_neck, (std::array<double, 2>{0.0, 30.0}));
}

TEST(FittedFeatures, AreThoseOfTheHandleNotOfItsNeck) {
  // A screwdriver's handle: 10 mm thicker per 100 mm towards its neck.
  HandleBody body = bar([](double z, double) { return z > 29.0 ? 8.0 : 15.0 + 0.05 * z; });
  FittedFeatures fitted = fit_features(body, kept_lengths(body));
  EXPECT_NEAR(fitted.features.width, 30.0, 0.05);
  EXPECT_NEAR(fitted.features.depth, 30.0, 0.05);
  EXPECT_NEAR(fitted.features.taper, -10.0, 0.05);
  EXPECT_LT(fitted.rms, 0.02);
  // A part of a product that runs out into its neck.
  body = bar([](double z, double) { return z > 46.0 ? 8.0 : 15.0 + 0.05 * z; });
  body.is_whole = false;
  body.run_out = 14.0;
  body.is_free = {true, false};
  fitted = fit_features(body);
  EXPECT_NEAR(fitted.features.taper, -10.0, 0.05);
  EXPECT_LT(fitted.rms, 0.02);
}

TEST(FittedFeatures, OfAFlutedBarHaveItsArea) {
  // Mean of r^2: 15^2 + 1 / 2.
  const FittedFeatures fitted =
      fit_features(bar([](double, double phi) { return 15.0 + std::cos(7.0 * phi); }));
  EXPECT_NEAR(fitted.features.width * fitted.features.depth, 4.0 * 225.5, 2.0);
  EXPECT_NEAR(fitted.features.squareness, 0.0, 1e-6);
}

TEST(KeptEnds, KeepTheOutlinesThatTheyHave) {
  HandleShape shape{.body = bar([](double z, double) { return z < -45.0 ? 20.0 : 15.0; })};
  shape.features = {.width = 26.0, .depth = 26.0};
  shape.kept_ends = {13.0, 0.0};
  EXPECT_NEAR(shape.radius_at(-50.0, 1.0), 20.0, 1e-9);
  EXPECT_NEAR(shape.radius_at(-40.0, 1.0), 14.0, 1e-6);  // half way between 15 and 13
  EXPECT_NEAR(shape.radius_at(-32.9, 1.0), 13.0, 1e-3);
  EXPECT_NEAR(shape.radius_at(59.0, 1.0), 13.0, 1e-3);
}

TEST(KeptFaces, KeepTheirOutlineAndAreNamedIfTheyAreNotThere) {
  const product::Product prism =
      product::make_prism_product({.width = 30, .depth = 40, .length = 120});
  ASSERT_NE(prism.faces, nullptr);
  // The flat side that looks to +x.
  int number = 0;
  for (std::size_t t = 0; t < prism.mesh.triangles.size(); ++t) {
    const Triangle& corner = prism.mesh.triangles[t];
    bool is_there = true;
    for (const int v : corner) {
      is_there = is_there && prism.mesh.vertices[static_cast<std::size_t>(v)].x() > 14.999;
    }
    if (is_there)
      number = prism.faces->face[static_cast<std::size_t>(prism.faces->face_of_triangle[t])].number;
  }
  ASSERT_GT(number, 0);
  HandleShape shape{.body = bar([](double, double phi) {
                      return std::min(15.0 / std::max(1e-9, std::abs(std::cos(phi))),
                                      20.0 / std::max(1e-9, std::abs(std::sin(phi))));
                    })};
  shape.features = {.width = 36.0, .depth = 48.0};
  KeepOut keep;
  keep.faces = {number};
  shape.to_kept_faces = distances_to_faces(shape.body, prism, keep);
  EXPECT_NEAR(shape.radius_at(0.0, 0.0), 15.0, 1e-6);               // on the face
  EXPECT_NEAR(shape.radius_at(0.0, std::numbers::pi), 18.0, 1e-3);  // opposite to it
  keep.faces = {99};
  EXPECT_THAT([&] { distances_to_faces(shape.body, prism, keep); },
              ThrowsMessage<UsageError>(HasSubstr("no face 99")));
  keep.faces = {number};
  shape.body.product_from_handle.translation = Vec3(500.0, 0.0, 0.0);
  EXPECT_THAT([&] { distances_to_faces(shape.body, prism, keep); },
              ThrowsMessage<UsageError>(HasSubstr("lies on the handle")));
  EXPECT_TRUE(distances_to_faces(shape.body, prism, {}).z.empty());
}

TEST(SmoothedOutlines, LoseRoughnessAndKeepTheirOval) {
  const HandleOutlines smooth =
      smoothed(bar([](double, double phi) {
                 return 15.0 + 2.0 * std::cos(2.0 * phi) + std::cos(11.0 * phi);
               }).outlines);
  for (const double phi : {0.0, 0.7, 2.0}) {
    EXPECT_NEAR(smooth.at(0.0, phi), 15.0 + 2.0 * std::cos(2.0 * phi), 0.01) << phi;
  }
}

}  // namespace
}  // namespace palmar::redesign
