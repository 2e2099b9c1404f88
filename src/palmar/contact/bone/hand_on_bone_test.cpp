// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/contact/bone/contact_test_skin.h"
#include "palmar/contact/bone/skin_compliance.h"
#include "palmar/contact/contact.h"
#include "palmar/contact/contact_normals.h"
#include "palmar/contact/contact_test_hand.h"
#include "palmar/contact/hand_family.h"
#include "palmar/contact/prepared/contact_solver.h"
#include "palmar/core/error.h"
#include "palmar/hand/tissue.h"

namespace palmar::contact {
namespace {

using contact_test::on_bone_model;

/// A fingertip of sorts: a ball of skin round a ball of bone.
std::shared_ptr<const hand::Hand> tip(double size) {
  auto hand = std::make_shared<hand::Hand>();
  hand->name = "tip";
  hand->skin = geometry::make_icosphere(9.0, 4);
  for (const Vec3& x : hand->skin.vertices) {
    hand->region.push_back(x.z() > 0.0 ? hand::Region::kIndexDistal : hand::Region::kDorsum);
  }
  hand->segment.assign(hand->region.size(), hand::Segment::kIndexDistal);
  hand::Bone& bone = hand->bones.emplace_back();
  bone.mesh = geometry::make_icosphere(4.0, 3);
  for (geometry::TriangleMesh* mesh : {&hand->skin, &bone.mesh}) {
    for (Vec3& x : mesh->vertices) x = size * (x + Vec3(0.0, 20.0, 0.0));
  }
  hand->tissue = hand::default_tissue();
  return hand;
}

/// The tip of size 1, whose elements are solved once.
const std::shared_ptr<const hand::Hand>& usual_tip() {
  static const std::shared_ptr<const hand::Hand> hand = tip(1.0);
  return hand;
}

const std::shared_ptr<const SkinCompliance>& compliance_of_tip() {
  static const auto compliance = std::make_shared<const SkinCompliance>(
      skin_compliance(*usual_tip(), skin_geometry(usual_tip()->skin)));
  return compliance;
}

/// Force on a plate above that is lowered by `depth` from first touch.
ContactResult pressed(const PreparedHand& hand, double size, double depth,
                      const geometry::Rigid3& moved = {}) {
  // The plate is the solid below z = 0 of its own frame, the tip upside down on it.
  geometry::Rigid3 product_from_hand;
  product_from_hand.rotation = Quat(Eigen::AngleAxisd(M_PI, Vec3::UnitX()));
  product_from_hand.translation = Vec3(0.0, 0.0, 9.0 * size - depth);
  std::vector<Vec3> skin = hand.hand().skin.vertices;
  for (Vec3& x : skin) x = moved * x;
  const geometry::Rigid3 back = moved.inverse();
  geometry::Rigid3 placed;
  placed.rotation = product_from_hand.rotation * back.rotation;
  placed.translation = product_from_hand * back.translation;
  return solve_hand_contact(hand, skin, placed, contact_test::HalfSpace(0.0));
}

TEST(HandOnBone, StiffensFasterThanHertzAndHoldsTheContactEquations) {
  const PreparedHand hand(usual_tip(), on_bone_model(), compliance_of_tip());
  const ContactResult one = pressed(hand, 1.0, 1.0);
  const ContactResult two = pressed(hand, 1.0, 2.0);
  ASSERT_EQ(two.status, ContactStatus::kSolved) << two.message;
  EXPECT_EQ(two.message, "");
  EXPECT_GT(two.total.force, 3.5 * one.total.force);  // Hertz: 2^1.5 = 2.8
  EXPECT_LT(two.complementarity_error, 1e-8 * two.total.force);
  for (std::size_t v = 0; v < two.force.size(); ++v) {
    EXPECT_GE(two.force[v], 0.0);
    if (two.force[v] > 0.0) {
      EXPECT_LT(two.deformed[v].z(), 1e-6);
    }
  }
  EXPECT_NEAR(two.total.force_vector.z(), -two.total.force, 1e-9);
}

TEST(HandOnBone, StiffnessIsTheSlopeOfTheForces) {
  const PreparedHand hand(usual_tip(), on_bone_model(), compliance_of_tip());
  ContactSolver::Impl solver(hand, {});
  const contact_test::HalfSpace plate(0.0);
  ContactResult result;
  const auto press = [&](double depth) {
    geometry::Rigid3 placed;
    placed.rotation = Quat(Eigen::AngleAxisd(M_PI, Vec3::UnitX()));
    placed.translation = Vec3(0.0, 0.0, 9.0 - depth);
    solver.solve_forces(usual_tip()->skin.vertices, placed, plate, 1e-9, result);
    return result.total.force;
  };
  constexpr double kStep = 1e-3;  // mm
  const double slope = (press(1.5 + kStep) - press(1.5 - kStep)) / (2.0 * kStep);
  press(1.5);
  const std::vector<int> loaded = loaded_vertices(result);
  Eigen::MatrixXd change(loaded.size(), 2);
  for (std::size_t k = 0; k < loaded.size(); ++k) {
    change(static_cast<Eigen::Index>(k), 0) = 1.0;
    change(static_cast<Eigen::Index>(k), 1) = usual_tip()->skin.vertices[loaded[k]].x();
  }
  const auto lost = solver.stiffness_times(change, {}, 1e-8);
  ASSERT_TRUE(lost);
  EXPECT_NEAR(lost->col(0).sum(), slope, 0.002 * slope);  // skin joins and leaves the contact
  const Eigen::Matrix2d both = change.transpose() * *lost;
  EXPECT_NEAR(both(0, 1), both(1, 0), 1e-5 * std::sqrt(both(0, 0) * both(1, 1)));
  EXPECT_GT(both(1, 1), 0.0);
}

TEST(HandOnBone, TurningTheProductAgainstTheSkinChangesForcesAsTheirRateSays) {
  // A plate turns about an axis through the fingertip: depths change, and so do the directions in
  // which the skin is pressed.
  const PreparedHand hand(usual_tip(), on_bone_model(), compliance_of_tip());
  ContactSolver::Impl solver(hand, {});
  const contact_test::HalfSpace plate(0.0);
  const std::vector<Vec3>& skin = usual_tip()->skin.vertices;
  const Vec3 axis = Vec3(1.0, 0.4, 0.0).normalized();  // hand frame
  ContactResult result;
  const auto press = [&](double turn) -> const std::vector<double>& {
    geometry::Rigid3 placed;
    placed.rotation =
        Quat(Eigen::AngleAxisd(M_PI, Vec3::UnitX())) * Quat(Eigen::AngleAxisd(turn, axis));
    placed.translation = Vec3(0.0, 0.0, 7.5);
    solver.solve_forces(skin, placed, plate, 1e-9, result);
    return result.force;
  };
  constexpr double kStep = 2e-4;  // rad
  const std::vector<double> more = press(kStep), less = press(-kStep);
  press(0.0);
  const std::vector<int> loaded = loaded_vertices(result);
  Eigen::MatrixXd change(loaded.size(), 1);
  LoadedSkin::Turns turns;
  const Vec3 turn = Quat(Eigen::AngleAxisd(M_PI, Vec3::UnitX())) * axis;  // of the skin
  for (std::size_t k = 0; k < loaded.size(); ++k) {
    const Vec3 moved = turn.cross(Vec3(result.undeformed[loaded[k]] - Vec3(0.0, 0.0, 7.5)));
    change(static_cast<Eigen::Index>(k), 0) = moved.z();
    turns.push_back({{0, -turn.cross(Vec3::UnitZ())}});
  }
  const auto rate = [&](const LoadedSkin::Turns& with) {
    return Eigen::VectorXd(*solver.stiffness_times(change, with, 1e-8));
  };
  const Eigen::VectorXd exact = rate(turns), held = rate({});
  double off = 0.0, off_held = 0.0, size = 0.0;
  for (std::size_t k = 0; k < loaded.size(); ++k) {
    const double lost = (less[loaded[k]] - more[loaded[k]]) / (2.0 * kStep);
    const auto i = static_cast<Eigen::Index>(k);
    off += std::pow(exact[i] - lost, 2);
    off_held += std::pow(held[i] - lost, 2);
    size += lost * lost;
  }
  EXPECT_LT(std::sqrt(off / size), 0.01);
  EXPECT_GT(std::sqrt(off_held / size), 0.03);  // else the test would say nothing
}

TEST(HandOnBone, TissueThatIsPressedAwayBulgesBesideTheContact) {
  // Tissue hardly changes its volume: what is pressed in comes out elsewhere.
  const PreparedHand hand(usual_tip(), on_bone_model(), compliance_of_tip());
  const ContactResult contact = pressed(hand, 1.0, 1.5);
  double pressed_in = 0.0, bulge = 0.0;  // mm3
  for (const auto& [a, b, c] : usual_tip()->skin.triangles) {
    const auto moved = [&](auto v) { return Vec3(contact.undeformed[v] - contact.deformed[v]); };
    const Vec3 twice_area = (contact.undeformed[b] - contact.undeformed[a])
                                .cross(contact.undeformed[c] - contact.undeformed[a]);
    const double volume = (moved(a) + moved(b) + moved(c)).dot(twice_area) / 6.0;
    (volume > 0.0 ? pressed_in : bulge) += volume;
  }
  // Not all of it is seen: skin moves along its normals only, and that of the back not at all.
  EXPECT_GT(-bulge, pressed_in / 3.0);
  EXPECT_LT(-bulge, pressed_in);
}

TEST(HandOnBone, RigidMotionOfSkinAndProductChangesNothing) {
  const PreparedHand hand(usual_tip(), on_bone_model(), compliance_of_tip());
  const ContactResult plain = pressed(hand, 1.0, 1.5);
  geometry::Rigid3 moved;
  moved.rotation = Quat(Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, -0.5).normalized()));
  moved.translation = Vec3(30.0, -10.0, 5.0);
  const ContactResult other = pressed(hand, 1.0, 1.5, moved);
  EXPECT_NEAR(other.total.force, plain.total.force, 1e-5 * plain.total.force);
  EXPECT_NEAR(other.total.area, plain.total.area, 1e-4 * plain.total.area);
}

TEST(HandOnBone, HandOfAFamilyScaledAsAWholeIsExact) {
  const HandFamily family(usual_tip(), on_bone_model(), compliance_of_tip());
  const PreparedHand own(usual_tip(), family);
  const PreparedHand larger(tip(1.2), family);
  const ContactResult small = pressed(own, 1.0, 1.5);
  const ContactResult large = pressed(larger, 1.2, 1.8);
  EXPECT_NEAR(large.total.force / small.total.force, 1.44, 1e-3);
  EXPECT_NEAR(large.total.area / small.total.area, 1.44, 1e-3);
}

TEST(HandOnBone, RegionByRegionAndFineSkinsAreRefused) {
  ContactModel alone = on_bone_model();
  alone.coupling = RegionCoupling::kIndependent;
  EXPECT_THROW(PreparedHand(tip(1.0), alone), UsageError);
  auto fine = std::make_shared<hand::Hand>(*tip(1.0));
  fine->skin = geometry::make_icosphere(9.0, 6);
  fine->region.assign(fine->skin.vertices.size(), hand::Region::kIndexDistal);
  fine->segment.assign(fine->skin.vertices.size(), hand::Segment::kIndexDistal);
  try {
    const PreparedHand hand(fine, on_bone_model());
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("up to 12000"));
  }
}

}  // namespace
}  // namespace palmar::contact
