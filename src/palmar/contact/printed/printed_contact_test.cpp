// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Single steps of Xie 2014, section 3.3, against what its equations give by hand. The hand is a
// regular tetrahedron: three corners of thenar, 15 mm apart, where the palm's Gaussian (b = 15 mm)
// is exactly 1, and a fourth of dorsum.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/contact/contact_test_hand.h"
#include "palmar/contact/prepared/sub_active_region.h"
#include "palmar/core/error.h"

namespace palmar::contact {
namespace {

using contact_test::ball_hand;
using contact_test::HalfSpace;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::ThrowsMessage;

constexpr double kEdge = 15.0;  // mm

/// Regular tetrahedron about the origin; corners A, B, C of the palm, D of the dorsum.
std::shared_ptr<hand::Hand> four_corners() {
  auto hand = std::make_shared<hand::Hand>();
  hand->name = "four corners";
  const double s = kEdge / std::sqrt(8.0);
  hand->skin.vertices = {s * Vec3(1, 1, 1), s * Vec3(1, -1, -1), s * Vec3(-1, 1, -1),
                         s * Vec3(-1, -1, 1)};
  hand->skin.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  hand->region = {hand::Region::kThenar, hand::Region::kThenar, hand::Region::kThenar,
                  hand::Region::kDorsum};
  hand->segment.assign(4, hand::Segment::kPalm);
  hand->tissue = hand::default_tissue();
  return hand;
}

/// Signed distances given for points; the product's normal looks at the origin.
class Given : public geometry::DistanceField {
 public:
  Given(std::vector<Vec3> points, std::vector<double> distances)
      : points_(std::move(points)), distances_(std::move(distances)) {}
  void sample(std::span<const Vec3> asked, double /*range*/,
              std::span<geometry::DistanceSample> samples) const override {
    for (std::size_t i = 0; i < asked.size(); ++i) {
      std::size_t nearest = 0;
      for (std::size_t k = 1; k < points_.size(); ++k) {
        if ((asked[i] - points_[k]).norm() < (asked[i] - points_[nearest]).norm()) nearest = k;
      }
      const double d = distances_[nearest];
      const Vec3 n = -points_[nearest].normalized();
      samples[i] = {d, asked[i] - d * n, n, -1};
    }
  }
  Box3 bounding_box() const override { return {Vec3::Constant(-100.0), Vec3::Constant(100.0)}; }

 private:
  std::vector<Vec3> points_;
  std::vector<double> distances_;
};

ContactResult contact_of(const std::shared_ptr<hand::Hand>& hand,
                         const std::vector<double>& distances, const ContactOptions& options = {}) {
  const PreparedHand prepared(hand, xie2014_model());
  const std::vector<Vec3>& skin = hand->skin.vertices;
  return solve_hand_contact(prepared, skin, geometry::Rigid3(), Given(skin, distances), options);
}

// At d_max = 3.5 mm, half of the palm's limit depth: G = 5 + (60 - 5) / 2 = 32.5 kPa (3-3), a =
// 3 mm/N * 5 / 32.5 = 0.461538 mm/N (3-6), and with r = 0.5 and 15 mm in (3-2)
constexpr double kOwn = 4.897075;    // 1 / (4 pi 0.5 mm 0.0325 MPa), mm/N
constexpr double kOther = 0.163236;  // 1 / (4 pi 15 mm 0.0325 MPa), mm/N
constexpr double kBulge = 0.461538;  // mm/N

TEST(PrintedContact, BulgeStandsOutBesideOneLoadedVertex) {
  const auto hand = four_corners();
  const ContactResult contact = contact_of(hand, {-3.5, 0.5, 0.5, 9.0});
  ASSERT_EQ(contact.status, ContactStatus::kSolved);
  EXPECT_EQ(contact.fallbacks, ContactFallbacks{});
  const double p = 3.5 / kOwn;  // 0.714713 N
  EXPECT_NEAR(contact.force[0], p, 1e-5);
  EXPECT_EQ(contact.force[1], 0.0);
  EXPECT_NEAR(contact.displacement[0], 3.5, 1e-12);                   // up to the product
  EXPECT_NEAR(contact.displacement[1], p * (kOther - kBulge), 1e-5);  // -0.213204 mm: outwards
  EXPECT_NEAR(contact.displacement[2], contact.displacement[1], 1e-9);
  EXPECT_EQ(contact.displacement[3], 0.0);  // the dorsum is no region
  // (3-15): against the vertex' own normal, which of a regular tetrahedron is radial.
  for (int v = 0; v < 4; ++v) {
    const Vec3& x = hand->skin.vertices[v];
    EXPECT_LT((contact.deformed[v] - (x - contact.displacement[v] * x.normalized())).norm(), 1e-9);
  }
  EXPECT_NEAR(contact.regions.front().shear_modulus, 0.0325, 1e-12);
  // Three triangles of sqrt(3)/4 15^2 = 97.43 mm2 have the loaded corner.
  EXPECT_NEAR(contact.total.area, 3.0 * std::sqrt(3.0) / 4.0 * kEdge * kEdge, 1e-9);
}

TEST(PrintedContact, BulgeThatMeetsTheProductIsPartOfTheProblem) {
  // B and C are 0.1 mm away and would bulge by 0.213 mm: they carry q each, with
  //   own p + 2 other q             = 3.5   (A penetrates: no Gaussian in its row, 3-12)
  //   (other - bulge)(p + q) + own q = -0.1  (the Gaussian of their own force, r = 0, is 4e-6)
  const ContactResult contact = contact_of(four_corners(), {-3.5, 0.1, 0.1, 9.0});
  ASSERT_EQ(contact.status, ContactStatus::kSolved);
  const double c = kBulge - kOther;  // 0.298302
  const double q = (c * 3.5 / kOwn - 0.1) / (kOwn - c + c * 2.0 * kOther / kOwn);
  EXPECT_NEAR(q, 0.0245095, 1e-6);
  EXPECT_NEAR(contact.force[1], q, 1e-5);
  EXPECT_NEAR(contact.force[2], q, 1e-5);
  EXPECT_NEAR(contact.force[0], (3.5 - 2.0 * kOther * q) / kOwn, 1e-5);
  EXPECT_NEAR(contact.displacement[1], -0.1, 1e-9);  // held on the product
  EXPECT_LT(contact.complementarity_error, 1e-12);
  // All four triangles have a loaded corner: the whole surface.
  EXPECT_NEAR(contact.total.area, std::sqrt(3.0) * kEdge * kEdge, 1e-9);
}

TEST(PrintedContact, WithoutSwellingIsTheThesisBoussinesqModel) {
  ContactOptions options;
  options.swelling = false;
  const ContactResult contact = contact_of(four_corners(), {-3.5, 0.1, 0.1, 9.0}, options);
  EXPECT_NEAR(contact.force[0], 3.5 / kOwn, 1e-5);
  EXPECT_NEAR(contact.displacement[1], 3.5 / kOwn * kOther, 1e-5);  // dragged in by 0.1167 mm
}

TEST(PrintedContact, LevelsOfTheBandDifferByTheirModulusOnly) {
  // Section 3.4.1: contact areas at different moduli almost overlap; with a G = a0 G0 given they
  // are equal. G = 5 + 35 / 2 = 22.5 and 5 + 75 / 2 = 42.5 kPa.
  ContactOptions options;
  options.error_band = true;
  const ContactResult contact = contact_of(four_corners(), {-3.5, 0.1, 0.1, 9.0}, options);
  ASSERT_TRUE(contact.band);
  EXPECT_NEAR(contact.band->total.force_low, 22.5 / 32.5 * contact.total.force, 1e-9);
  EXPECT_NEAR(contact.band->total.force_high, 42.5 / 32.5 * contact.total.force, 1e-9);
  EXPECT_NEAR(contact.band->total.area_low, contact.total.area, 1e-9);
  EXPECT_NEAR(contact.band->total.area_high, contact.total.area, 1e-9);
  EXPECT_EQ(contact.band->total.force_per_modulus, contact.total.force);
}

TEST(PrintedContact, EquationsWithoutSolutionAreNamedAndCounted) {
  // a = 60 * 5 / 32.5 = 9.23 mm/N. The rows of B and C added up: 2 (0.16 - 9.23) p + (4.90 + 0.16 -
  // 9.23)(q + r) + 0.2 >= 0 leaves p + 0.23 (q + r) <= 0.011, but the row of A wants 0.7.
  auto hand = four_corners();
  hand->tissue.region[static_cast<int>(hand::Region::kThenar)].swelling_height = 60.0;
  const ContactResult contact = contact_of(hand, {-3.5, 0.1, 0.1, 9.0});
  EXPECT_EQ(contact.status, ContactStatus::kSolved);
  EXPECT_EQ(contact.fallbacks.without_bulge, 1);
  EXPECT_THAT(contact.message, HasSubstr("region thenar (3 vertices); solved with the bulge left"));
  EXPECT_EQ(fallbacks_in_words(contact.fallbacks),
            "1 regions were solved with the bulge left out of the printed equations");
  EXPECT_NEAR(contact.force[0], 3.5 / kOwn, 1e-5);
  EXPECT_NEAR(contact.displacement[1], -0.1, 1e-9);  // flat against the product (3-7)
}

TEST(PrintedContact, DorsumCarriesNoForceAndIsNamed) {
  const ContactResult contact = contact_of(four_corners(), {-3.5, 2.0, 2.0, -1.0});
  EXPECT_EQ(contact.force[3], 0.0);
  EXPECT_THAT(contact.message, HasSubstr("1 vertices of the dorsum are in the product"));
  EXPECT_NEAR(contact.total.force, 3.5 / kOwn, 1e-5);
}

TEST(PrintedContact, DepthIsThatOfTheNearestFaceHoweverItLooks) {
  // The palm has gone 20 mm into the product: no limit is printed; G is G_lim = 60 kPa beyond 7 mm.
  const ContactResult contact = contact_of(four_corners(), {-20.0, 20.0, 20.0, 20.0});
  EXPECT_EQ(contact.status, ContactStatus::kSolved);
  EXPECT_NEAR(contact.force[0], 20.0 * 4.0 * std::numbers::pi * 0.5 * 0.060, 1e-5);
  EXPECT_NEAR(contact.total.max_penetration, 20.0, 1e-12);
}

TEST(PrintedContact, KnowsNoCover) {
  ContactOptions options;
  options.coatings.push_back({.thickness = 1.0, .shear_modulus = 1.0, .where = {}});
  ContactModel patches = xie2014_model();
  patches.kernel = Kernel::kPatch;
  const auto hand = four_corners();
  const PreparedHand prepared(hand, patches);
  const Given product(hand->skin.vertices, {-1.0, 1.0, 1.0, 1.0});
  EXPECT_THAT(
      [&] {
        solve_hand_contact(prepared, hand->skin.vertices, geometry::Rigid3(), product, options);
      },
      ThrowsMessage<UsageError>(HasSubstr("know no soft cover")));
}

TEST(NeighbourRings, AreThoseOfTheThesisAndFollowTheMesh) {
  EXPECT_EQ(neighbour_rings(12.5, 2.5), 5);
  EXPECT_EQ(neighbour_rings(17.5, 2.5), 7);
  EXPECT_EQ(neighbour_rings(12.5, 1.25), 10);
  EXPECT_EQ(neighbour_rings(12.5, 40.0), 1);
}

TEST(ActiveRegion, GrowsByRingsAcrossBordersButNotOntoTheDorsum) {
  // On a lattice of triangles n rings hold 3 n (n + 1) vertices; the ball's lower half is skin of
  // one finger, its upper half dorsum.
  const auto hand = ball_hand(40.0, 4);
  const PreparedHand prepared(hand, {.coupling = RegionCoupling::kCoupled});
  const SkinGeometry& skin = prepared.impl().skin;
  double mean = 0.0;
  for (const double e : skin.edge_length) mean += e / static_cast<double>(skin.edge_length.size());
  hand::RegionTissue& tissue = hand->tissue.region[static_cast<int>(hand::Region::kMiddleDistal)];
  // A vertex with six neighbours as far as three rings, well below the equator.
  const auto is_regular = [&](int v) {
    if (skin.position[v].z() > -25.0) return false;
    for (const GrownVertex& g : grow(skin, std::vector{v}, 3.5 * mean)) {
      if (skin.neighbours(g.vertex).size() != 6) return false;
    }
    return true;
  };
  int middle = 0;
  while (!is_regular(middle)) ++middle;
  for (const int rings : {1, 2, 3}) {
    tissue.neighbourhood = rings * mean;
    EXPECT_THAT(active_region(*hand, skin, {middle}),
                SizeIs(static_cast<std::size_t>(1 + 3 * rings * (rings + 1))));
  }
  // Two regions share the lower half: growth does not stop between them.
  for (int v = 0; v < skin.vertex_count(); ++v) {
    if (hand->region[v] != hand::Region::kDorsum && v != middle)
      hand->region[v] = hand::Region::kMiddleMiddle;
  }
  EXPECT_THAT(active_region(*hand, skin, {middle}), SizeIs(37));
  for (int v = 0; v < skin.vertex_count(); ++v) {
    if (v != middle) hand->region[v] = hand::Region::kDorsum;
  }
  EXPECT_THAT(active_region(*hand, skin, {middle}), ElementsAre(middle));
}

TEST(SubActiveRegions, HaveTheirOwnDepthAndModulus) {
  // Two regions of a finger, one a little off the deepest point: G = 5 + 90 d_max / 4 kPa each.
  auto hand = ball_hand(40.0, 3);
  for (std::size_t v = 0; v < hand->region.size(); ++v) {
    const Vec3& x = hand->skin.vertices[v];
    if (x.z() < 0.0 && x.x() > 3.0) hand->region[v] = hand::Region::kMiddleMiddle;
  }
  const PreparedHand prepared(hand, xie2014_model());
  SkinOnProduct skin;
  find_skin_as_printed(*hand, hand->skin.vertices, HalfSpace(-38.0), {}, skin);
  const auto parts =
      sub_active_regions(prepared.impl(), skin, hand::TissueLevel::kNominal, std::nullopt);
  ASSERT_THAT(parts, SizeIs(2));
  for (const SubActiveRegion& part : parts) {
    double deepest = 0.0;
    for (const int v : part.vertex) {
      EXPECT_EQ(hand->region[v], part.region);
      deepest = std::max(deepest, -38.0 - hand->skin.vertices[v].z());
    }
    EXPECT_NEAR(part.d_max, deepest, 1e-12);
    EXPECT_NEAR(part.shear_modulus, 0.005 + 0.090 * deepest / 4.0, 1e-12);
    EXPECT_NEAR(part.swelling, 2.0 * 0.005 / part.shear_modulus, 1e-12);
  }
  EXPECT_NE(parts[0].d_max, parts[1].d_max);
}

TEST(ContactTriangles, CountWithAnyLoadedCorner) {
  const std::vector<Vec3> square = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  const std::vector<Triangle> triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_THAT(contact_triangles(square, triangles, {0, 1, 0, 0}), ElementsAre(0, 2, 0, 0));
  EXPECT_THAT(contact_triangles(square, triangles, {1, 1, 0, 0}), ElementsAre(3, 1, 0, 0));
  EXPECT_THAT(contact_triangles(square, triangles, {0, 0, 0, 0}), ElementsAre(0, 0, 0, 0));
}

}  // namespace
}  // namespace palmar::contact
