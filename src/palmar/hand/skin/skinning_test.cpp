// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Skinning on one straight finger: rings of skin about the y axis, one hinge at the origin.
#include "palmar/hand/skin/skinning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "palmar/core/enum_index.h"

namespace palmar::hand {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRadius = 8.0;     // mm
constexpr double kBandHalf = 10.0;  // mm

JointDof turn_about_x(Dof dof, double lower, double upper) {
  JointDof result;
  result.dof = dof;
  result.lower = lower;
  result.upper = upper;
  return result;
}

/// w1 rises from 0 at y = -10 to 1 at y = 10; all of the skin belongs to the finger.
Hand straight_finger() {
  Hand hand;
  for (int j = 0; j < kJointCount; ++j) {
    hand.skeleton.joints[j].id = static_cast<JointId>(j);
  }
  const auto joint = [&](JointId id) -> Joint& { return hand.skeleton.joints[index_of(id)]; };
  joint(JointId::kThumbCmc).dofs = {turn_about_x(Dof::kThumbCmcAbduction, -1, 1),
                                    turn_about_x(Dof::kThumbCmcFlexion, -1, 1)};
  joint(JointId::kIndexPip).dofs = {turn_about_x(Dof::kIndexPipFlexion, 0, 2)};
  JointWeights weights;
  weights.joint = JointId::kIndexPip;
  for (int y = -40; y <= 40; y += 2) {
    for (int k = 0; k < 16; ++k) {
      const double a = 2 * kPi * k / 16;
      const double w1 = std::clamp(0.5 + 0.5 * y / kBandHalf, 0.0, 1.0);
      if (w1 > 0) {
        weights.vertex.push_back(static_cast<int>(hand.skin.vertices.size()));
        weights.w1.push_back(w1);
        weights.w2.push_back(1.0);
      }
      hand.skin.vertices.emplace_back(kRadius * std::cos(a), y, kRadius * std::sin(a));
    }
  }
  hand.weights = {weights};
  return hand;
}

Posture bent(double angle) {
  Posture posture;
  posture[Dof::kIndexPipFlexion] = angle;
  return posture;
}

TEST(Skinning, SkinKeepsItsDistanceFromTheAxisOfTheJoint) {
  // A rotation about the axis, by whatever share of the angle: no candy-wrapper.
  const Hand hand = straight_finger();
  const std::vector<Vec3> skin = pose_skin(hand, bent(1.7));
  for (std::size_t v = 0; v < skin.size(); ++v) {
    const Vec3& before = hand.skin.vertices[v];
    EXPECT_NEAR(std::hypot(skin[v].y(), skin[v].z()), std::hypot(before.y(), before.z()), 1e-12);
    EXPECT_NEAR(skin[v].x(), before.x(), 1e-12);
  }
}

TEST(Skinning, BeyondTheBandSkinStaysOrTurnsRigidly) {
  const Hand hand = straight_finger();
  const double angle = 1.2;
  const std::vector<Vec3> skin = pose_skin(hand, bent(angle));
  for (std::size_t v = 0; v < skin.size(); ++v) {
    const Vec3& p = hand.skin.vertices[v];
    if (p.y() <= -kBandHalf) {
      EXPECT_EQ(skin[v], p);
    }
    if (p.y() >= kBandHalf) {
      const Vec3 turned(p.x(), p.y() * std::cos(angle) - p.z() * std::sin(angle),
                        p.y() * std::sin(angle) + p.z() * std::cos(angle));
      EXPECT_NEAR((skin[v] - turned).norm(), 0, 1e-12);
    }
  }
}

TEST(Skinning, HalfWayAlongTheBandTurnsByHalfTheAngle) {
  const Hand hand = straight_finger();
  const std::vector<Vec3> skin = pose_skin(hand, bent(kPi / 2));
  for (std::size_t v = 0; v < skin.size(); ++v) {
    const Vec3& p = hand.skin.vertices[v];
    if (p.y() != 0) continue;
    const Vec3 turned(p.x(), -p.z() * std::sqrt(0.5), p.z() * std::sqrt(0.5));
    EXPECT_NEAR((skin[v] - turned).norm(), 0, 1e-12);
  }
}

TEST(Skinning, PalmarSkinFoldsOnlyBeyondTwiceTheBandOverTheDepth) {
  // Along the palmar line the skin keeps the share 1 - theta R / (2 h) of its length to first
  // order: it turns over when theta exceeds 2 h / R = 2.5 rad.
  const Hand hand = straight_finger();
  const auto steps_on = [&](double angle) {
    const std::vector<Vec3> skin = pose_skin(hand, bent(angle));
    double least = 1e30;  // of the way along the turned bone from one ring to the next
    for (std::size_t v = 0; v + 16 < skin.size(); ++v) {
      const Vec3 &p = hand.skin.vertices[v], &q = hand.skin.vertices[v + 16];
      if (std::abs(p.z() - kRadius) > 1e-9 || p.y() < -1.5 || p.y() > 1.5) continue;
      const double turn = angle * (0.5 + 0.25 * (p.y() + q.y()) / kBandHalf);
      const Vec3 along(0, std::cos(turn), std::sin(turn));
      least = std::min(least, (skin[v + 16] - skin[v]).dot(along));
    }
    return least;
  };
  EXPECT_GT(steps_on(2.3), 0);
  EXPECT_LT(steps_on(2.7), 0);
}

TEST(Skinning, BulgeComesOutOnlyInFlexion) {
  Hand hand = straight_finger();
  JointWeights& weights = hand.weights.front();
  const Vec3 out(0.5, 0, 0);
  weights.bulge.assign(weights.vertex.size(), out);
  for (const double angle : {-0.4, 0.0, 0.6}) {
    Hand plain = hand;
    plain.weights.front().bulge.clear();
    const std::vector<Vec3> with = pose_skin(hand, bent(angle));
    const std::vector<Vec3> without = pose_skin(plain, bent(angle));
    for (const int v : weights.vertex) {
      // Along the axis, which the turn leaves alone.
      EXPECT_NEAR((with[v] - without[v] - std::max(angle, 0.0) * out).norm(), 0, 1e-12);
    }
  }
}

TEST(Skinning, SomeVerticesInAnyOrderGoWhereAllGo) {
  const Hand hand = straight_finger();
  const std::vector<Vec3> all = pose_skin(hand, bent(0.9));
  const std::vector<int> some = {600, 3, 600, 0};
  const std::vector<Vec3> alone = pose_skin_vertices(hand, bent(0.9), some);
  ASSERT_EQ(alone.size(), some.size());
  for (std::size_t k = 0; k < some.size(); ++k) {
    EXPECT_EQ(alone[k], all[some[k]]);
  }
  EXPECT_TRUE(pose_skin_vertices(hand, bent(0.9), {}).empty());
}

}  // namespace
}  // namespace palmar::hand
