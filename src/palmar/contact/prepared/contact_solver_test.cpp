// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>

#include "palmar/contact/contact.h"
#include "palmar/contact/contact_test_hand.h"
#include "palmar/contact/prepared/prepared_hand.h"
#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::contact {
namespace {

using contact_test::ball_hand;
using contact_test::HalfSpace;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kSkinRadius = 10.0;  // mm

/// A ball of skin whose lower half belongs to two regions that meet under its lowest point.
std::shared_ptr<hand::Hand> split_ball() {
  auto hand = ball_hand(kSkinRadius, 3);
  for (std::size_t v = 0; v < hand->region.size(); ++v) {
    if (hand->region[v] == hand::Region::kDorsum) continue;
    hand->region[v] = hand->skin.vertices[v].x() < 0.0 ? hand::Region::kMiddleDistal
                                                       : hand::Region::kMiddleMiddle;
  }
  return hand;
}

ContactResult on_plane(const PreparedHand& hand, double depth, const ContactOptions& options = {},
                       double radius = kSkinRadius) {
  return solve_hand_contact(hand, hand.hand().skin.vertices, {}, HalfSpace(depth - radius),
                            options);
}

TEST(CoupledRegions, ABorderUnderTheContactChangesNothing) {
  const PreparedHand whole(ball_hand(kSkinRadius, 3));
  const PreparedHand split(split_ball());
  for (const double depth : {0.5, 1.0, 2.0, 4.0}) {
    const ContactResult one = on_plane(whole, depth);
    const ContactResult two = on_plane(split, depth);
    ASSERT_EQ(two.status, ContactStatus::kSolved);
    EXPECT_NEAR(two.total.force, one.total.force, 1e-6 * one.total.force);
    EXPECT_NEAR(two.total.peak_pressure, one.total.peak_pressure, 1e-6 * one.total.peak_pressure);
    ASSERT_EQ(two.regions.size(), 2U);
    EXPECT_NEAR(two.regions[0].force + two.regions[1].force, two.total.force, 1e-9);
  }
}

TEST(CoupledRegions, AloneTheyNeedMoreForce) {
  const PreparedHand coupled(split_ball());
  const PreparedHand alone(split_ball(), {.coupling = RegionCoupling::kIndependent});
  const ContactResult together = on_plane(coupled, 2.0);
  const ContactResult apart = on_plane(alone, 2.0);
  EXPECT_GT(apart.total.force, 1.1 * together.total.force);
  // The border is then an edge, with the peak on it.
  EXPECT_GT(apart.total.peak_pressure, 1.1 * together.total.peak_pressure);
  EXPECT_EQ(together.model.coupling, RegionCoupling::kCoupled);
  EXPECT_EQ(apart.model.coupling, RegionCoupling::kIndependent);
}

TEST(CoupledRegions, EachRowHasItsOwnModulus) {
  // One region four times as stiff: it carries more, the soft one less than before, as the stiff
  // one lifts it.
  auto hand = split_ball();
  auto& stiff = hand->tissue.region[index_of(hand::Region::kMiddleMiddle)].half_space;
  stiff.nominal = {0.02, 0.38, 4.0};
  const ContactResult even = on_plane(PreparedHand(split_ball()), 2.0);
  const ContactResult uneven = on_plane(PreparedHand(hand), 2.0);
  EXPECT_GT(uneven.regions[0].force, even.regions[0].force);  // middle_middle
  EXPECT_LT(uneven.regions[1].force, even.regions[1].force);  // middle_distal
  EXPECT_LT(uneven.complementarity_error, 1e-9);
}

TEST(ContactBand, ForceIsHomogeneousInTheModuli) {
  const PreparedHand hand(split_ball());
  ContactOptions options;
  options.error_band = true;
  const ContactResult contact = on_plane(hand, 2.0, options);
  ASSERT_TRUE(contact.band);
  // Euler: sum of G_r dF/dG_r = F.
  EXPECT_NEAR(contact.band->total.force_per_modulus, contact.total.force,
              1e-8 * contact.total.force);
  double sum = 0.0;
  for (const ContactBandRow& row : contact.band->regions) sum += row.force_per_modulus;
  EXPECT_NEAR(sum, contact.total.force, 1e-8 * contact.total.force);
  EXPECT_LT(contact.band->total.force_low, contact.total.force);
  EXPECT_GT(contact.band->total.force_high, contact.total.force);
}

TEST(ContactBand, SensitivityIsTheSlopeOfTheForce) {
  ContactOptions options;
  options.error_band = true;
  const ContactResult before = on_plane(PreparedHand(split_ball()), 2.0, options);
  auto hand = split_ball();
  constexpr double kStep = 1e-4;
  auto& tissue = hand->tissue.region[index_of(hand::Region::kMiddleMiddle)].half_space;
  tissue.nominal.g0 *= 1.0 + kStep;
  tissue.nominal.g_limit *= 1.0 + kStep;
  const double slope = (on_plane(PreparedHand(hand), 2.0).total.force - before.total.force) / kStep;
  // The laws of neighbouring regions are mixed over 6 mm along their border, the sensitivity counts
  // whole regions: of a contact 9 mm wide on the border itself a little belongs to the other.
  EXPECT_NEAR(before.band->regions[0].force_per_modulus, slope, 0.05 * slope);
}

TEST(ContactBand, LowAndHighAreThoseOfOtherHands) {
  // A hand whose nominal tissue is the low one of another has that one's lower force.
  ContactOptions options;
  options.error_band = true;
  const ContactResult contact = on_plane(PreparedHand(split_ball()), 2.0, options);
  for (const bool is_high : {false, true}) {
    auto hand = split_ball();
    for (hand::RegionTissue& tissue : hand->tissue.region) {
      tissue.half_space.nominal = is_high ? tissue.half_space.high : tissue.half_space.low;
    }
    const ContactResult other = on_plane(PreparedHand(hand), 2.0);
    const ContactBandRow& band = contact.band->total;
    EXPECT_NEAR(is_high ? band.force_high : band.force_low, other.total.force,
                1e-8 * other.total.force);
    EXPECT_NEAR(is_high ? band.area_high : band.area_low, other.total.area,
                1e-6 * other.total.area);
    EXPECT_NEAR(is_high ? band.peak_pressure_cells_high : band.peak_pressure_cells_low,
                other.total.peak_pressure_cells, 1e-6 * other.total.peak_pressure_cells);
  }
}

TEST(ContactSolver, AlongAMotionItAnswersAsAfresh) {
  const PreparedHand hand(split_ball());
  ContactSolver solver(hand);
  ContactResult along;
  for (const double depth : {0.4, 0.45, 0.5, 1.5, 1.45, 0.2, -1.0, 3.0}) {
    solver.solve(hand.hand().skin.vertices, {}, HalfSpace(depth - kSkinRadius), along);
    const ContactResult afresh = on_plane(hand, depth);
    EXPECT_EQ(along.status, afresh.status) << depth;
    EXPECT_NEAR(along.total.force, afresh.total.force, 1e-9 * (1.0 + afresh.total.force));
    EXPECT_NEAR(along.total.area, afresh.total.area, 1e-6 * (1.0 + afresh.total.area));
    EXPECT_EQ(along.regions.size(), afresh.regions.size());
    for (std::size_t v = 0; v < along.deformed.size(); ++v) {
      EXPECT_LT((along.deformed[v] - afresh.deformed[v]).norm(), 1e-6);
    }
  }
}

TEST(ContactSolver, ForceRisesWithoutJumpsInAMotion) {
  // Steps of 0.05 mm. Between steps F grows like depth^n; what is left over must stay below 2 %.
  const PreparedHand hand(split_ball());
  ContactSolver solver(hand);
  ContactResult contact;
  std::vector<double> log_force;
  for (double depth = 1.0; depth < 5.0; depth += 0.05) {
    solver.solve(hand.hand().skin.vertices, {}, HalfSpace(depth - kSkinRadius), contact);
    log_force.push_back(std::log(contact.total.force));
  }
  for (std::size_t i = 1; i + 1 < log_force.size(); ++i) {
    EXPECT_GT(log_force[i], log_force[i - 1]);
    EXPECT_NEAR(log_force[i], 0.5 * (log_force[i - 1] + log_force[i + 1]), 0.02) << i;
  }
}

TEST(ContactSolver, ThreadsDoNotShow) {
  const int before = thread_count();
  std::vector<double> force[2];
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    const PreparedHand hand(split_ball());
    force[threads - 1] = on_plane(hand, 2.0).force;
  }
  set_thread_count(before);
  EXPECT_EQ(force[0], force[1]);  // bit by bit
}

constexpr double kLargeRadius = 40.0;  // mm

/// A ball of skin, 10 000 vertices, whose lowest point lies 4 mm below a flat slab of bone.
std::shared_ptr<hand::Hand> ball_over_slab() {
  auto hand = ball_hand(kLargeRadius, 5);
  hand::Bone bone;
  bone.name = "slab";
  bone.mesh = geometry::make_box(Vec3(400.0, 400.0, 30.0), 2);
  for (Vec3& v : bone.mesh.vertices) v.z() += 15.0 - (kLargeRadius - 4.0);
  hand->bones.push_back(bone);
  return hand;
}

TEST(LayeredTissue, ThinSkinMeetsTheBondedLayer) {
  // Sphere on a bonded incompressible layer: F / F_Hertz over sqrt(R depth) / h, computed from the
  // layer's Hankel kernel (VALIDATION: 1.518, 2.156, 3.688 at 0.3, 0.5, 0.8). The sphere's own skin
  // is the layer here, so it thins out sideways (by 6 % at the contact's edge), which the closed
  // form's doesn't.
  const PreparedHand hand(ball_over_slab(), {.tissue = TissueModel::kLayered});
  ContactOptions options;
  options.shear_modulus = 0.02;
  for (const auto& [chi, ratio] : {std::pair(0.5, 2.1562), std::pair(0.8, 3.6884)}) {
    const double depth = std::pow(chi * 4.0, 2) / kLargeRadius;
    const double hertz = 16.0 / 3.0 * 0.02 * std::sqrt(kLargeRadius) * std::pow(depth, 1.5);
    const ContactResult contact = on_plane(hand, depth, options, kLargeRadius);
    ASSERT_EQ(contact.status, ContactStatus::kSolved);
    EXPECT_NEAR(contact.total.force / hertz, ratio, 0.10 * ratio) << chi;
    EXPECT_LT(contact.residual_penetration_other, 0.05);
  }
}

TEST(LayeredTissue, WithoutBoneItIsAThickLayer) {
  ContactOptions options;
  options.shear_modulus = 0.02;
  // No bone counts as 40 mm: sqrt(R depth) / h = 0.1, F / F_Hertz = 1.1291 (same table).
  const double depth = std::pow(0.1 * 40.0, 2) / 20.0;
  const ContactResult half = on_plane(PreparedHand(ball_hand(20.0, 4)), depth, options, 20.0);
  const ContactResult deep = on_plane(
      PreparedHand(ball_hand(20.0, 4), {.tissue = TissueModel::kLayered}), depth, options, 20.0);
  EXPECT_NEAR(deep.total.force / half.total.force, 1.1291, 0.03);
}

/// A square of skin of 110 mm, normal +z.
std::shared_ptr<hand::Hand> square_hand(int columns) {
  auto hand = std::make_shared<hand::Hand>();
  hand->name = "square";
  hand->skin = geometry::make_grid_patch(columns, columns, 110.0 / columns);
  hand->region.assign(hand->skin.vertices.size(), hand::Region::kCentralPalm);
  hand->segment.assign(hand->skin.vertices.size(), hand::Segment::kPalm);
  hand->tissue = hand::default_tissue();
  return hand;
}

TEST(FineMeshes, FarResponsesByClustersGiveTheSame) {
  // Two balls on skin of 7 921 vertices, all pairs vertex by vertex, and of 12 544, the far ones by
  // clusters. The contacts are 20 mm wide and 6 mm apart, so far pairs count.
  class TwoBalls : public geometry::DistanceField {
   public:
    void sample(std::span<const Vec3> points, double range,
                std::span<geometry::DistanceSample> samples) const override {
      std::vector<geometry::DistanceSample> other(points.size());
      one_.sample(points, range, samples);
      two_.sample(points, range, other);
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (other[i].distance < samples[i].distance) samples[i] = other[i];
      }
    }
    Box3 bounding_box() const override { return one_.bounding_box().merged(two_.bounding_box()); }

   private:
    contact_test::Ball one_{Vec3(42.0, 55.0, 20.0), 25.0};
    contact_test::Ball two_{Vec3(68.0, 55.0, 20.0), 25.0};
  };
  const PreparedHand coarse(square_hand(88));
  const PreparedHand fine(square_hand(111));
  ASSERT_FALSE(coarse.impl().response.has_far());
  ASSERT_TRUE(fine.impl().response.has_far());
  ContactOptions options;
  options.shear_modulus = 0.05;
  const auto solved = [&](const PreparedHand& hand) {
    return solve_hand_contact(hand, hand.hand().skin.vertices, {}, TwoBalls(), options);
  };
  const ContactResult few = solved(coarse);
  const ContactResult many = solved(fine);
  ASSERT_EQ(many.status, ContactStatus::kSolved);
  EXPECT_NEAR(many.total.force, few.total.force, 0.01 * few.total.force);
  EXPECT_NEAR(many.total.area, few.total.area, 0.03 * few.total.area);
  EXPECT_NEAR(many.total.peak_pressure_cells, few.total.peak_pressure_cells,
              0.01 * few.total.peak_pressure_cells);
  EXPECT_LT(many.complementarity_error, 1e-9);
  // Skin between the balls, which carries nothing, sinks alike.
  const auto middle_of = [](const PreparedHand& hand, const ContactResult& contact) {
    double nearest = 1e9;
    double u = 0.0;
    for (std::size_t v = 0; v < contact.displacement.size(); ++v) {
      const double r = (hand.hand().skin.vertices[v] - Vec3(55.0, 70.0, 0.0)).norm();
      if (r < nearest) u = contact.displacement[v];
      nearest = std::min(nearest, r);
    }
    return u;
  };
  options.swelling = false;
  const double sunk = middle_of(coarse, solved(coarse));
  EXPECT_NEAR(middle_of(fine, solved(fine)), sunk, 0.05 * std::abs(sunk) + 0.02);
}

TEST(Coating, ThickCoverIsAHalfSpaceInSeries) {
  // Two elastic bodies: 1 / E* = 1 / E1* + 1 / E2* (Hertz); both incompressible, so force is that
  // of G1 G2 / (G1 + G2).
  const PreparedHand hand(ball_hand(kSkinRadius, 3));
  ContactOptions options;
  options.shear_modulus = 0.05;
  options.coatings.push_back(
      {.thickness = 50.0, .shear_modulus = 0.025, .poisson = 0.5, .where = {}});
  const ContactResult contact = on_plane(hand, 1.0, options);
  const double G = 0.05 * 0.025 / (0.05 + 0.025);
  const double hertz = 16.0 / 3.0 * G * std::sqrt(kSkinRadius);
  // A contact of sqrt(R depth) / h = 0.06 on a layer is up to 6 % stiffer than on a half-space.
  EXPECT_GT(contact.total.force, 0.98 * hertz);
  EXPECT_LT(contact.total.force, 1.08 * hertz);
}

TEST(Coating, ThinCoverUnderHardSkinIsTheBondedLayer) {
  // Skin ten thousand times as stiff as the cover: the sphere on the bonded incompressible layer,
  // 15 mm, sqrt(R depth) / h = 1.5 and 2: F / F_Hertz = 10.30, 18.37 and contact radius /
  // sqrt(R depth) = 1.508, 1.577 (VALIDATION, closed form 5). The second is wider than the skin
  // that penetrates (1.414): what bulges must join.
  const double radius = 200.0;
  const PreparedHand hand(ball_hand(radius, 5));
  ContactOptions options;
  options.shear_modulus = 100.0;
  options.coatings.push_back(
      {.thickness = 15.0, .shear_modulus = 0.01, .poisson = 0.5, .where = {}});
  for (const auto& [chi, force_ratio, radius_ratio] :
       {std::tuple(1.5, 10.3045, 1.508), std::tuple(2.0, 18.3687, 1.577)}) {
    const double depth = std::pow(chi * 15.0, 2) / radius;
    const double hertz = 16.0 / 3.0 * 0.01 * std::sqrt(radius) * std::pow(depth, 1.5);
    const ContactResult contact = on_plane(hand, depth, options, radius);
    ASSERT_EQ(contact.status, ContactStatus::kSolved);
    EXPECT_TRUE(contact.message.empty()) << contact.message;
    EXPECT_NEAR(contact.total.force / hertz, force_ratio, 0.06 * force_ratio) << chi;
    const double width = std::sqrt(contact.total.area / std::numbers::pi);
    EXPECT_NEAR(width / std::sqrt(radius * depth), radius_ratio, 0.08 * radius_ratio) << chi;
  }
}

TEST(Coating, HardCoverIsNone) {
  const PreparedHand hand(ball_hand(kSkinRadius, 3));
  ContactOptions options;
  const ContactResult rigid = on_plane(hand, 2.0, options);
  options.coatings.push_back({.thickness = 2.0, .shear_modulus = 1e4, .poisson = 0.5, .where = {}});
  const ContactResult covered = on_plane(hand, 2.0, options);
  EXPECT_NEAR(covered.total.force, rigid.total.force, 1e-4 * rigid.total.force);
}

TEST(Coating, SoftCoverSpreadsTheLoadWhereItIs) {
  const PreparedHand hand(ball_hand(kSkinRadius, 3));
  ContactOptions options;
  const ContactResult rigid = on_plane(hand, 3.0, options);
  options.coatings.push_back(
      {.thickness = 3.0, .shear_modulus = 0.05, .poisson = 0.45, .where = {}});
  const ContactResult covered = on_plane(hand, 3.0, options);
  EXPECT_LT(covered.total.peak_pressure, 0.9 * rigid.total.peak_pressure);
  EXPECT_LT(covered.total.force, rigid.total.force);
  options.coatings[0].where = Box3(Vec3(100.0, 100.0, -50.0), Vec3(200.0, 200.0, 50.0));
  const ContactResult elsewhere = on_plane(hand, 3.0, options);
  EXPECT_EQ(elsewhere.total.force, rigid.total.force);
  EXPECT_THAT(elsewhere.message, HasSubstr("no skin in contact is on a coated part"));
}

TEST(Coating, IsChecked) {
  const PreparedHand hand(ball_hand(kSkinRadius, 2));
  ContactOptions options;
  options.coatings.push_back(
      {.thickness = -1.0, .shear_modulus = 1.0, .poisson = 0.5, .where = {}});
  EXPECT_THAT([&] { on_plane(hand, 1.0, options); },
              ThrowsMessage<UsageError>(HasSubstr("coating: thickness is -1")));
  options.coatings[0] = {.thickness = 1.0, .shear_modulus = 1.0, .poisson = 0.6, .where = {}};
  EXPECT_THAT([&] { on_plane(hand, 1.0, options); },
              ThrowsMessage<UsageError>(HasSubstr("Poisson's ratio is 0.6")));
}

TEST(ThesisModel, RunsEveryEquationAndSaysSo) {
  const PreparedHand hand(split_ball(), xie2014_model());
  const ContactResult contact = on_plane(hand, 2.0);
  EXPECT_EQ(contact.status, ContactStatus::kSolved);
  EXPECT_EQ(name_of(contact.model), "xie2014");
  EXPECT_EQ(contact_model_named("xie2014"), xie2014_model());
  EXPECT_EQ(contact_model_named("palmar"), palmar_model());
  EXPECT_EQ(palmar_model().tissue, TissueModel::kBone);
  EXPECT_FALSE(contact_model_named("newton"));
  EXPECT_EQ(name_of(ContactModel{.coupling = RegionCoupling::kIndependent}),
            "palmar, halfspace, independent");
}

TEST(ThesisModel, RunsOnIndependentHalfSpacesOnly) {
  // What the procedure doesn't know runs with Palmar's own, and the result says so.
  ContactModel coupled = xie2014_model();
  coupled.coupling = RegionCoupling::kCoupled;
  const PreparedHand hand(split_ball(), coupled);
  EXPECT_EQ(name_of(hand.model()), "palmar, point, halfspace");
}

TEST(PointKernel, BreakdownIsNamedAndLeavesAValidState) {
  // Vertices 0.35 mm apart: the thesis' kernel is no longer positive definite.
  const PreparedHand hand(ball_hand(2.0, 3), {.kernel = Kernel::kPoint});
  const ContactResult contact = on_plane(hand, 0.5, {}, 2.0);
  if (contact.status == ContactStatus::kNotConverged) {
    EXPECT_THAT(contact.message, HasSubstr("middle_distal"));
  }
  for (const double p : contact.force) {
    EXPECT_TRUE(std::isfinite(p));
    EXPECT_GE(p, 0.0);
  }
  for (const Vec3& x : contact.deformed) EXPECT_TRUE(x.allFinite());
}

}  // namespace
}  // namespace palmar::contact
