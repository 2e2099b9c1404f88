// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/refine/skin_division.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::contact {
namespace {

constexpr double kSkinBall = 10.0;  // mm

SkinDivision divided_ball(int times, const std::vector<char>& may_divide = {}) {
  const geometry::TriangleMesh ball = geometry::make_icosphere(kSkinBall, 3);
  std::vector<Vec3> posed = ball.vertices;
  for (Vec3& x : posed) x += Vec3(100.0, 0.0, 0.0);
  SkinDivision division(ball.triangles, ball.vertices, posed,
                        may_divide.empty() ? std::vector<char>(posed.size(), 1) : may_divide);
  for (int i = 0; i < times; ++i) {
    // A cap that gets smaller: neighbours that differ by a level and more.
    std::vector<char> chosen;
    for (const Vec3& x : division.at_rest()) chosen.push_back(x.z() > 7.0 + i ? 1 : 0);
    division.divide(chosen);
  }
  return division;
}

/// How many triangles each edge has.
std::map<std::pair<int, int>, int> edges_of(const std::vector<Triangle>& triangles) {
  std::map<std::pair<int, int>, int> edges;
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++edges[std::minmax(t[k], t[(k + 1) % 3])];
  }
  return edges;
}

TEST(SkinDivision, StaysClosedAndKeepsItsVertices) {
  const SkinDivision division = divided_ball(3);
  const geometry::TriangleMesh ball = geometry::make_icosphere(kSkinBall, 3);
  ASSERT_GT(division.ends().size(), 300u);
  EXPECT_LT(division.ends().size(), 3000u);
  for (const auto& [edge, count] : edges_of(division.triangles())) EXPECT_EQ(count, 2);
  // Euler's number of a ball.
  const auto vertices = static_cast<long>(division.at_rest().size());
  const auto triangles = static_cast<long>(division.triangles().size());
  EXPECT_EQ(vertices - triangles / 2, 2);
  for (std::size_t v = 0; v < division.original_count(); ++v) {
    EXPECT_EQ(division.at_rest()[v], ball.vertices[v]);
  }
  for (const Triangle& t : division.triangles()) {
    const Vec3& a = division.at_rest()[t[0]];
    const Vec3 n = (division.at_rest()[t[1]] - a).cross(division.at_rest()[t[2]] - a);
    EXPECT_GT(n.dot(a), 0.0);
  }
}

TEST(SkinDivision, NewVerticesLieOnTheSurfaceThatTheOldOnesShow) {
  const SkinDivision division = divided_ball(2);
  double farthest = 0.0, shortest_chord = kSkinBall;
  for (std::size_t v = division.original_count(); v < division.at_rest().size(); ++v) {
    farthest = std::max(farthest, std::abs(division.at_rest()[v].norm() - kSkinBall));
    const auto [a, b] = division.ends()[v - division.original_count()];
    const Vec3 chord = 0.5 * (division.at_rest()[a] + division.at_rest()[b]);
    shortest_chord = std::min(shortest_chord, chord.norm());
  }
  // Middles of chords lie 0.028 mm inside.
  EXPECT_LT(shortest_chord, kSkinBall - 0.025);
  EXPECT_LT(farthest, 0.006);
  for (std::size_t v = 0; v < division.posed().size(); ++v) {
    EXPECT_LT((division.posed()[v] - division.at_rest()[v] - Vec3(100.0, 0.0, 0.0)).norm(), 1e-9);
  }
}

TEST(SkinDivision, SharesAreThoseOfTheTriangleThatAVertexIsIn) {
  const SkinDivision division = divided_ball(3);
  const auto shares = division.shares();
  for (std::size_t v = 0; v < shares.size(); ++v) {
    double sum = 0.0;
    Vec3 at = Vec3::Zero();
    for (const auto& [parent, weight] : shares[v]) {
      ASSERT_LT(static_cast<std::size_t>(parent), division.original_count());
      EXPECT_GT(weight, 0.0);
      sum += weight;
      at += weight * division.at_rest()[parent];
    }
    EXPECT_LE(shares[v].size(), 3u);
    EXPECT_DOUBLE_EQ(sum, 1.0);
    // On the facet: inside the ball by no more than the facets are.
    EXPECT_LT((at - division.at_rest()[v]).norm(), 0.06);
  }
}

TEST(SkinDivision, WhatMayNotBeDividedIsOnlyCutAtItsBorder) {
  const geometry::TriangleMesh ball = geometry::make_icosphere(kSkinBall, 3);
  std::vector<char> may_divide;
  for (const Vec3& x : ball.vertices) may_divide.push_back(x.x() > 0.0 ? 1 : 0);
  const SkinDivision division = divided_ball(3, may_divide);
  ASSERT_GT(division.ends().size(), 100u);
  for (const auto& [edge, count] : edges_of(division.triangles())) EXPECT_EQ(count, 2);
  for (const auto& ends : division.ends()) {
    for (const int v : ends) {
      if (static_cast<std::size_t>(v) < may_divide.size()) {
        EXPECT_EQ(may_divide[v], 1);
      }
    }
  }
}

}  // namespace
}  // namespace palmar::contact
