// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/skin_marks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/core/random.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::capture {
namespace {

using ::testing::HasSubstr;

constexpr double kRadius = 20.0;
const std::vector<Vec3> kDots{Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(-1, 0.3, 0.2).normalized(),
                              Vec3(0.2, -1, 0.4).normalized()};

/// A ball with dots of 3 mm and a line round it at z = 12 mm, in shade on one side.
geometry::ColouredMesh painted_ball(const geometry::Srgb& skin, const SkinMarkOptions& inks,
                                    double coverage) {
  geometry::ColouredMesh ball{geometry::make_icosphere(kRadius, 6), {}};  // edges of 0.36 mm
  RandomStream random(3, 1);
  for (const Vec3& v : ball.mesh.vertices) {
    geometry::Srgb colour = skin;
    const auto ink = [&](const geometry::Srgb& with) {
      colour += static_cast<float>(coverage) * (with - colour);
    };
    if (std::abs(v.z() - 12.0) < 0.7) ink(inks.crease);
    for (const Vec3& d : kDots) {
      if ((v - kRadius * d).norm() < 1.5) ink(inks.dot);
    }
    colour *= static_cast<float>(0.75 + 0.25 * v.x() / kRadius);  // shade
    for (int k = 0; k < 3; ++k) colour[k] += static_cast<float>(0.01 * random.normal());
    ball.colour.push_back(colour.cwiseMax(0.0F).cwiseMin(1.0F));
  }
  return ball;
}

void expect_marks(const SkinMarks& marks) {
  ASSERT_EQ(marks.dots.size(), kDots.size());
  for (const Vec3& d : kDots) {
    double nearest = 1e9;
    for (const InkDot& dot : marks.dots) {
      nearest = std::min(nearest, (dot.point - kRadius * d).norm());
      EXPECT_NEAR(dot.area, 2.25 * 3.14159, 2.0);
    }
    EXPECT_LT(nearest, 0.2);
  }
  double area = 0.0;
  for (const InkLine& line : marks.lines) {
    area += line.area;
    for (const Vec3& p : line.point) EXPECT_NEAR(p.z(), 12.0, 0.8);
  }
  // Zone of a ball: 2 pi r h.
  EXPECT_NEAR(area, 2.0 * 3.14159 * kRadius * 1.4, 0.15 * 2.0 * 3.14159 * kRadius * 1.4);
}

TEST(SkinMarks, FindsDotsAndLinesOnLightAndDarkSkin) {
  const SkinMarkOptions inks;
  expect_marks(find_skin_marks(painted_ball({0.80F, 0.60F, 0.50F}, inks, 0.9), "ball"));
  expect_marks(find_skin_marks(painted_ball({0.36F, 0.25F, 0.20F}, inks, 0.5), "ball"));
}

TEST(SkinMarks, TakesOtherInks) {
  SkinMarkOptions inks;
  inks.crease = {0.38F, 0.12F, 0.52F};  // purple
  inks.dot = {0.10F, 0.45F, 0.22F};     // green
  expect_marks(find_skin_marks(painted_ball({0.80F, 0.60F, 0.50F}, inks, 0.9), "ball", inks));
}

TEST(SkinMarks, BareSkinHasNone) {
  const SkinMarks marks = find_skin_marks(painted_ball({0.80F, 0.60F, 0.50F}, {}, 0.0), "ball");
  EXPECT_TRUE(marks.dots.empty());
  EXPECT_TRUE(marks.lines.empty());
}

// The lower half was seen by no photograph and has the backdrop's blue; a blot of it reaches into
// what was seen. Neither hides the marks above nor makes any.
TEST(SkinMarks, WhatNobodySawBearsNone) {
  geometry::ColouredMesh ball = painted_ball({0.80F, 0.60F, 0.50F}, {}, 0.9);
  for (std::size_t v = 0; v < ball.colour.size(); ++v) {
    const Vec3& p = ball.mesh.vertices[v];
    const bool is_unseen = p.z() < -10.0;
    ball.is_guess.push_back(is_unseen ? 1 : 0);
    const bool is_bled = p.z() < -9.2 && std::abs(std::atan2(p.y(), p.x())) < 0.1;
    if (is_unseen || is_bled) ball.colour[v] = geometry::Srgb(0.2F, 0.3F, 0.7F);
  }
  const SkinMarks marks = find_skin_marks(ball, "ball");
  expect_marks(marks);
  ASSERT_FALSE(marks.notes.empty());
  EXPECT_THAT(marks.notes.back(), HasSubstr("1 blots in the dots' colour end where no photograph"));
  ball.is_guess.clear();
  EXPECT_NE(find_skin_marks(ball, "ball").notes, marks.notes);
}

TEST(SkinMarks, AStrapIsNoLine) {
  // Some 10 mm wide; the chromaticity of dark grey lies on the way from skin to green, or blue.
  for (const geometry::Srgb& strap :
       {geometry::Srgb(0.10F, 0.11F, 0.10F), geometry::Srgb(0.12F, 0.40F, 0.22F)}) {
    geometry::ColouredMesh ball = painted_ball({0.80F, 0.60F, 0.50F}, {}, 0.9);
    for (std::size_t v = 0; v < ball.colour.size(); ++v) {
      if (std::abs(ball.mesh.vertices[v].z() + 12.0) < 4.0) ball.colour[v] = strap;
    }
    const SkinMarks marks = find_skin_marks(ball, "ball");
    for (const InkLine& line : marks.lines) {
      for (const Vec3& p : line.point) EXPECT_NEAR(p.z(), 12.0, 0.8);
    }
    ASSERT_EQ(marks.other_colour.size(), 1U);
    EXPECT_GT(marks.other_colour.front().size(), ball.colour.size() / 6);
  }
}

TEST(SkinMarks, NamesInksThatCannotBeDistinguished) {
  const geometry::Srgb skin{0.80F, 0.60F, 0.50F};
  const geometry::ColouredMesh ball = painted_ball(skin, {}, 0.9);
  const auto message = [&](const SkinMarkOptions& inks) -> std::string {
    try {
      find_skin_marks(ball, "anna.ply", inks);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  SkinMarkOptions inks;
  inks.crease = {0.70F, 0.53F, 0.44F};
  EXPECT_THAT(message(inks), HasSubstr("anna.ply: the crease colour is like this skin's"));
  inks = {};
  inks.dot = {0.12F, 0.48F, 0.25F};
  EXPECT_THAT(message(inks), HasSubstr("too alike"));
  EXPECT_THROW(find_skin_marks({ball.mesh, {}}, "anna.ply"), InputError);
}

}  // namespace
}  // namespace palmar::capture
