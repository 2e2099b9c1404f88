// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/hand_family.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/contact/contact_test_hand.h"
#include "palmar/contact/prepared/prepared_hand.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"

namespace palmar::contact {
namespace {

using contact_test::ball_hand;
using contact_test::HalfSpace;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kFamilyRadius = 10.0;  // mm

std::shared_ptr<hand::Hand> ellipsoid(const Vec3& stretch) {
  auto hand = ball_hand(kFamilyRadius, 3);
  for (Vec3& v : hand->skin.vertices) v = v.cwiseProduct(stretch);
  return hand;
}

ContactResult on_plane(const PreparedHand& hand, double height, double depth) {
  return solve_hand_contact(hand, hand.hand().skin.vertices, {}, HalfSpace(depth - height));
}

/// Force and peak of a hand from the family against those of the full preparation, as shares.
void expect_alike(const std::shared_ptr<hand::Hand>& hand, const HandFamily& family, double height,
                  double share) {
  const PreparedHand full(hand, family.model());
  const PreparedHand quick(hand, family);
  for (const double depth : {1.0, 3.0}) {
    const ContactResult a = on_plane(full, height, depth), b = on_plane(quick, height, depth);
    ASSERT_EQ(b.status, ContactStatus::kSolved);
    EXPECT_NEAR(b.total.force, a.total.force, share * a.total.force);
    EXPECT_NEAR(b.total.area, a.total.area, share * a.total.area);
    EXPECT_NEAR(b.total.peak_pressure, a.total.peak_pressure, share * a.total.peak_pressure);
  }
}

// 1e-5: tables of the disc's response and of the arc in single precision.
TEST(HandFamily, PreparesItsBaseAsAlways) {
  expect_alike(ball_hand(kFamilyRadius, 3), HandFamily(ball_hand(kFamilyRadius, 3)), kFamilyRadius,
               1e-5);
}

TEST(HandFamily, IsExactForAHandScaledAsAWhole) {
  const HandFamily family(ball_hand(kFamilyRadius, 3));
  for (const double factor : {0.8, 1.25}) {
    expect_alike(ellipsoid(Vec3::Constant(factor)), family, factor * kFamilyRadius, 1e-5);
  }
}

TEST(HandFamily, IsNearlyExactForAStretchedHand) {
  const HandFamily family(ball_hand(kFamilyRadius, 3));
  // Three standard deviations of hand length (17 %) against three of the circumference.
  expect_alike(ellipsoid({1.17, 0.85, 0.85}), family, 0.85 * kFamilyRadius, 0.005);
  expect_alike(ellipsoid({0.85, 1.2, 1.2}), family, 1.2 * kFamilyRadius, 0.005);
}

TEST(HandFamily, KnowsEveryModel) {
  ContactModel independent;
  independent.coupling = RegionCoupling::kIndependent;
  for (const ContactModel& model : {independent, xie2014_model()}) {
    // A flattened region has a picture of its own; scaled as a whole it stays the same.
    expect_alike(ellipsoid(Vec3::Constant(0.9)), HandFamily(ball_hand(kFamilyRadius, 3), model),
                 0.9 * kFamilyRadius, 1e-4);
  }
}

TEST(HandFamily, ResponsesAreSymmetricAndDontDependOnThreads) {
  const HandFamily family(ball_hand(kFamilyRadius, 3));
  const auto hand = ellipsoid({1.1, 0.95, 0.9});
  set_thread_count(1);
  const PreparedHand one(hand, family);
  set_thread_count(4);
  const PreparedHand four(hand, family);
  set_thread_count(0);
  const SkinResponse& response = one.impl().response;
  EXPECT_EQ(response.vertex, four.impl().response.vertex);
  EXPECT_EQ(response.response, four.impl().response.response);
  std::vector<int> some;
  for (int v = 0; v < hand->skin.vertex_count(); v += 7) some.push_back(v);
  const Eigen::MatrixXd R = dense_response(response, some, hand->region, true);
  EXPECT_EQ((R - R.transpose()).cwiseAbs().maxCoeff(), 0.0);
}

TEST(HandFamily, RefusesAnotherMesh) {
  const HandFamily family(ball_hand(kFamilyRadius, 3));
  EXPECT_THAT([&] { PreparedHand(ball_hand(kFamilyRadius, 2), family); },
              ThrowsMessage<UsageError>(HasSubstr("hand \"ball\" has not the mesh of hand")));
  EXPECT_THAT([&] { PreparedHand(nullptr, family); },
              ThrowsMessage<UsageError>(HasSubstr("no hand was given")));
}

}  // namespace
}  // namespace palmar::contact
