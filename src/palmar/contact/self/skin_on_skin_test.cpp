// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <cmath>
#include <numeric>

#include "palmar/contact/bone/contact_test_skin.h"
#include "palmar/contact/contact.h"
#include "palmar/contact/contact_test_hand.h"
#include "palmar/contact/prepared/prepared_hand.h"
#include "palmar/contact/response/skin_geometry.h"
#include "palmar/contact/self/meeting_loads.h"
#include "palmar/contact/self/skin_meetings.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/hand/tissue.h"

namespace palmar::contact {
namespace {

using contact_test::on_bone_model;

constexpr double kLimbRadius = 9.0;  // mm

/// Two fingertips of sorts, mirror images of each other in the plane x = 0: balls of skin round
/// balls of bone, 60 mm apart. The first half of the vertices is the index finger's.
std::shared_ptr<const hand::Hand> two_tips() {
  auto hand = std::make_shared<hand::Hand>();
  hand->name = "two tips";
  const geometry::TriangleMesh ball = geometry::make_icosphere(kLimbRadius, 4);
  const geometry::TriangleMesh bone = geometry::make_icosphere(4.0, 3);
  const Vec3 side(30.0, 20.0, 0.0);
  const auto add = [&](const geometry::TriangleMesh& mesh, bool is_mirrored,
                       geometry::TriangleMesh& to) {
    const int first = to.vertex_count();
    for (const Vec3& x : mesh.vertices) {
      const Vec3 place = x - side;
      to.vertices.emplace_back(is_mirrored ? -place.x() : place.x(), -place.y(), place.z());
    }
    for (const Triangle& t : mesh.triangles) {
      to.triangles.push_back(is_mirrored ? Triangle{first + t[0], first + t[2], first + t[1]}
                                         : Triangle{first + t[0], first + t[1], first + t[2]});
    }
  };
  for (const bool is_mirrored : {false, true}) {
    add(ball, is_mirrored, hand->skin);
    hand::Bone& one = hand->bones.emplace_back();
    add(bone, is_mirrored, one.mesh);
  }
  // Mirroring y as well as x keeps the first ball's triangles outward only with a turn.
  for (std::size_t t = 0; t < hand->skin.triangles.size(); ++t) {
    std::swap(hand->skin.triangles[t][1], hand->skin.triangles[t][2]);
  }
  for (hand::Bone& one : hand->bones) {
    for (Triangle& t : one.mesh.triangles) std::swap(t[1], t[2]);
  }
  const std::size_t half = ball.vertices.size();
  for (std::size_t v = 0; v < 2 * half; ++v) {
    hand->segment.push_back(v < half ? hand::Segment::kIndexDistal : hand::Segment::kMiddleDistal);
    hand->region.push_back(v < half ? hand::Region::kIndexDistal : hand::Region::kMiddleDistal);
  }
  hand->tissue = hand::default_tissue();
  return hand;
}

const PreparedHand& prepared() {
  static const PreparedHand hand(two_tips(), on_bone_model());
  return hand;
}

/// Both balls moved towards each other until they cross by `overlap` [mm].
std::vector<Vec3> approached(const hand::Hand& hand, double overlap) {
  std::vector<Vec3> skin = hand.skin.vertices;
  const double way = 30.0 - kLimbRadius + 0.5 * overlap;
  for (std::size_t v = 0; v < skin.size(); ++v) {
    skin[v].x() += hand.segment[v] == hand::Segment::kIndexDistal ? way : -way;
  }
  return skin;
}

/// A plate far away, for contacts of skin with itself alone.
const contact_test::HalfSpace& far_plate() {
  static const contact_test::HalfSpace plate(-500.0);
  return plate;
}

double sum_of(const std::vector<SkinTouch>& touches) {
  return std::accumulate(touches.begin(), touches.end(), 0.0,
                         [](double sum, const SkinTouch& touch) { return sum + touch.force; });
}

TEST(SkinMeetings, FindCrossingOfTwoBallsAndItsDepth) {
  const auto hand = two_tips();
  const SkinMeetings meetings(*hand);
  const std::vector<Vec3> posed = approached(*hand, 2.0);
  const auto found =
      meetings.find(posed, geometry::area_weighted_normals(posed, hand->skin.triangles), 0.0);
  ASSERT_FALSE(found.empty());
  EXPECT_NEAR(deepest_crossing(found), 2.0, 0.1);  // flat triangles lie 0.02 mm under the ball
  for (const SkinMeeting& one : found) {
    // The lens that the balls share has its rim where cos = (r - 1) / r.
    const Vec3& x = posed[one.vertex];
    EXPECT_LT(std::hypot(x.y() - 20.0, x.z()), std::sqrt(81.0 - 64.0) + 0.1);
    EXPECT_EQ(hand->segment[one.vertex], hand::Segment::kIndexDistal);
    EXPECT_EQ(hand->segment[one.on[0]], hand::Segment::kMiddleDistal);
    EXPECT_NEAR(one.weight[0] + one.weight[1] + one.weight[2], 1.0, 1e-12);
    // To its mirror image beyond x = 0.
    EXPECT_NEAR(one.distance, -2.0 * x.x(), 0.1);
  }
  EXPECT_TRUE(meetings
                  .find(approached(*hand, -0.5),
                        geometry::area_weighted_normals(posed, hand->skin.triangles), 0.0)
                  .empty());
}

TEST(SkinMeetings, LeaveOutWhatAJointFolds) {
  auto hand = std::make_shared<hand::Hand>(*two_tips());
  hand::JointWeights& weights = hand->weights.emplace_back();
  weights.joint = hand::joint_of(hand::Segment::kMiddleDistal);
  for (int v = hand->skin.vertex_count() / 2; v < hand->skin.vertex_count(); ++v) {
    weights.vertex.push_back(v);
    weights.w1.push_back(0.5);
    weights.w2.push_back(1.0);
  }
  // The index finger isn't beside the joint that folds the middle finger's skin: they still meet.
  const std::vector<Vec3> posed = approached(*hand, 2.0);
  const auto normal = geometry::area_weighted_normals(posed, hand->skin.triangles);
  EXPECT_FALSE(SkinMeetings(*hand).find(posed, normal, 0.0).empty());
  // The middle phalanx of the same finger is beside it.
  for (hand::Segment& segment : hand->segment) {
    if (segment == hand::Segment::kIndexDistal) segment = hand::Segment::kMiddleMiddle;
  }
  EXPECT_TRUE(SkinMeetings(*hand).find(posed, normal, 0.0).empty());
}

const ContactOptions kOnSkin = [] {
  ContactOptions options;
  options.skin_on_skin = true;
  return options;
}();

// By symmetry each of two equal bodies pressed on each other meets a rigid plane half way: at equal
// force the approach is twice that to a plate.
TEST(SkinOnSkin, ThoroughTwoEqualTipsPressAsEachOnAPlateHalfWay) {
  for (const double overlap : {1.0, 2.0, 3.0}) {
    const std::vector<Vec3> both = approached(prepared().hand(), overlap);
    const ContactResult own = solve_hand_contact(prepared(), both, {}, far_plate(), kOnSkin);
    EXPECT_EQ(own.status, ContactStatus::kNoContact);
    EXPECT_EQ(own.total.force, 0.0);
    // The index tip alone on a plate whose surface is x = 0: z up is x.
    std::vector<Vec3> alone = prepared().hand().skin.vertices;
    for (std::size_t v = 0; v < alone.size(); ++v) {
      const bool is_index = prepared().hand().segment[v] == hand::Segment::kIndexDistal;
      alone[v].x() += is_index ? 30.0 - kLimbRadius + 0.5 * overlap : 200.0;
    }
    geometry::Rigid3 plate;
    plate.rotation = Quat(Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitY()));  // x to -z
    std::vector<Vec3> index = alone;
    for (std::size_t v = 0; v < index.size(); ++v) {
      if (prepared().hand().segment[v] != hand::Segment::kIndexDistal) index[v].x() = -500.0;
    }
    const ContactResult on_plate =
        solve_hand_contact(prepared(), index, plate, contact_test::HalfSpace(0.0), kOnSkin);
    ASSERT_GT(on_plate.total.force, 0.0);
    EXPECT_NEAR(sum_of(own.skin_touch), on_plate.total.force, 0.06 * on_plate.total.force)
        << overlap;
    EXPECT_LT(own.residual_crossing, 0.1);
    EXPECT_LT(own.complementarity_error, 1e-9);
    ASSERT_EQ(own.skin_on_skin.size(), 1U);
    EXPECT_EQ(own.skin_on_skin[0].region, hand::Region::kIndexDistal);
    EXPECT_EQ(own.skin_on_skin[0].other, hand::Region::kMiddleDistal);
    EXPECT_NEAR(own.skin_on_skin[0].force, sum_of(own.skin_touch), 1e-12);
    EXPECT_LT(own.skin_on_skin[0].force_vector.x(), -0.9 * own.skin_on_skin[0].force);
    EXPECT_NEAR(own.skin_on_skin[0].deepest, overlap, 0.1);
  }
}

TEST(SkinOnSkin, ThoroughResponsesAreSymmetricAndPositive) {
  const hand::Hand& hand = prepared().hand();
  const SkinCompliance& compliance = *prepared().impl().compliance;
  MeetingLoads loads(prepared().impl().skin, compliance, {});
  const std::vector<Vec3> posed = approached(hand, 2.0);
  const std::vector<Vec3> normal = geometry::area_weighted_normals(posed, hand.skin.triangles);
  loads.set(SkinMeetings(hand).find(posed, normal, 0.0), posed, normal);
  ASSERT_FALSE(loads.is_empty());
  // One vertex on a product besides, next to the meetings.
  const std::vector<int> on_product = {compliance.vertex[5]};
  loads.join(on_product, {Vec3(0.0, 0.6, 0.8)});
  SparseRows product;
  product.begin = {0, 1};
  product.column = {0};
  product.value = {1.0F};
  std::vector<double> root(posed.size());
  for (std::size_t v = 0; v < root.size(); ++v) root[v] = 0.1 + 0.01 * static_cast<double>(v % 7);
  const SparseRows& rows = loads.responses(product, root);
  const auto n = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t k = rows.begin[i]; k < rows.begin[i + 1]; ++k) {
      matrix(static_cast<Eigen::Index>(i), rows.column[k]) = static_cast<double>(rows.value[k]);
    }
  }
  EXPECT_EQ((matrix - matrix.transpose()).cwiseAbs().maxCoeff(), 0.0);
  const Eigen::MatrixXd meetings = matrix.bottomRightCorner(n - 1, n - 1);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(meetings).eigenvalues().minCoeff(), 0.0);
}

TEST(SkinOnSkin, ActionIsReaction) {
  const ContactResult own =
      solve_hand_contact(prepared(), approached(prepared().hand(), 2.0), {}, far_plate(), kOnSkin);
  std::vector<Vec3> force(prepared().hand().skin.vertices.size(), Vec3::Zero());
  for (const SkinTouch& touch : own.skin_touch) {
    const Vec3 f = touch.force * touch.meeting.normal;
    force[touch.meeting.vertex] += f;
    for (std::size_t c = 0; c < 3; ++c) force[touch.meeting.on[c]] -= touch.meeting.weight[c] * f;
  }
  Vec3 index = Vec3::Zero(), middle = Vec3::Zero();
  for (std::size_t v = 0; v < force.size(); ++v) {
    (prepared().hand().segment[v] == hand::Segment::kIndexDistal ? index : middle) += force[v];
  }
  EXPECT_GT(index.norm(), 0.1);
  EXPECT_LT((index + middle).norm(), 1e-9 * index.norm());
}

TEST(SkinOnSkin, TissueOfOtherModelsKnowsNone) {
  const PreparedHand half_space(two_tips());
  const std::vector<Vec3> both = approached(half_space.hand(), 2.0);
  EXPECT_TRUE(solve_hand_contact(half_space, both, {}, far_plate()).skin_touch.empty());
  try {
    solve_hand_contact(half_space, both, {}, far_plate(), kOnSkin);
    FAIL() << "half-space";
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(),
                 "contact: skin on skin needs tissue on bone; the tissue model is halfspace");
  }
}

TEST(SkinOnSkin, IsAskedFor) {
  const std::vector<Vec3> both = approached(prepared().hand(), 2.0);
  EXPECT_TRUE(solve_hand_contact(prepared(), both, {}, far_plate()).skin_touch.empty());
}

TEST(SkinOnSkin, SkinApartChangesNoBit) {
  const auto on_plate = [&](double overlap) {
    std::vector<Vec3> skin = approached(prepared().hand(), overlap);
    // Both lie on the plate below them, 1.5 mm deep.
    geometry::Rigid3 up;
    up.translation = Vec3(0.0, 0.0, kLimbRadius - 1.5);
    return solve_hand_contact(prepared(), skin, up, contact_test::HalfSpace(0.0), kOnSkin);
  };
  const ContactResult apart = on_plate(-20.0);
  const ContactResult near = on_plate(-8.0);
  ASSERT_GT(apart.total.force, 0.0);
  EXPECT_TRUE(near.skin_touch.empty());
  EXPECT_EQ(apart.force, near.force);
  EXPECT_GT(sum_of(on_plate(1.0).skin_touch), 0.0);
}

TEST(SkinOnSkin, SameOnOneThreadAndOnMany) {
  const std::vector<Vec3> both = approached(prepared().hand(), 2.0);
  const auto forces = [&](int threads) {
    set_thread_count(threads);
    std::vector<double> result;
    for (const SkinTouch& touch :
         solve_hand_contact(prepared(), both, {}, far_plate(), kOnSkin).skin_touch) {
      result.push_back(touch.force);
    }
    set_thread_count(0);
    return result;
  };
  EXPECT_EQ(forces(1), forces(4));
}

}  // namespace
}  // namespace palmar::contact
