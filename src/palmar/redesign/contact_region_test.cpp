// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/contact_region.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/product/primitives.h"
#include "palmar/study/study_record.h"

namespace palmar::redesign {
namespace {

/// Slab of 3 mm edges; `hands` of ten touch where `is_touched` says so.
struct Touched {
  geometry::TriangleMesh map;
  ContactCount count;
};
template <typename Where>
Touched touched(const product::Product& product, int hands, const Where& is_touched) {
  Touched result{study::product_map(product.mesh), {}};
  result.count = start_count(result.map);
  result.count.hands = 10;
  for (std::size_t v = 0; v < result.map.vertices.size(); ++v) {
    if (!is_touched(result.map.vertices[v])) continue;
    result.count.any[v] = hands;
    result.count.of_part[index_of(HandPart::kPalm)][v] = hands;
  }
  return result;
}

product::Product slab() {
  return product::make_plane_product({.width = 120.0, .depth = 120.0, .fineness = {}});
}

bool is_on_top(const Vec3& x) { return x.z() > -1e-9; }

TEST(ContactRegion, OfADiscHasItsAreaAndOneSmoothOutlineOnTheSurface) {
  const double radius = 25.0;
  const Touched t = touched(
      slab(), 6, [&](const Vec3& x) { return is_on_top(x) && x.head<2>().norm() <= radius; });
  const ContactRegion region = contact_region(t.map, t.count, HandPart::kPalm);
  EXPECT_EQ(region.title, "palm, half of 10 hands");
  EXPECT_EQ(region.least_hands, 5);
  ASSERT_EQ(region.patches.size(), 1U);
  // Vertices 3 mm apart show a circle to about half of that, evenly round it.
  EXPECT_NEAR(region.area, std::numbers::pi * radius * radius,
              0.03 * std::numbers::pi * radius * radius);
  ASSERT_EQ(region.patches[0].outline.size(), 1U);
  const RegionOutline& outline = region.patches[0].outline[0];
  EXPECT_NEAR(outline.length, 2.0 * std::numbers::pi * radius,
              0.03 * 2.0 * std::numbers::pi * radius);
  double turn = 0.0;
  for (std::size_t i = 0; i < outline.points.size(); ++i) {
    const Vec3& x = outline.points[i];
    EXPECT_NEAR(x.z(), 0.0, 1e-9);
    EXPECT_NEAR(x.head<2>().norm(), radius, 1.6);
    turn += x.cross(outline.points[(i + 1) % outline.points.size()]).z();
  }
  EXPECT_GT(turn, 0.0);  // the region on the left
  EXPECT_LT(region.patches[0].centre.norm(), 0.5);
  EXPECT_TRUE(contact_region(t.map, t.count, HandPart::kThumb).patches.empty());
}

TEST(ContactRegion, AsksForAsManyHandsAsTheShareSays) {
  const Touched t = touched(slab(), 6, [](const Vec3& x) { return is_on_top(x) && x.norm() < 20; });
  const auto area = [&](double share) {
    RegionOptions options;
    options.share = share;
    return contact_region(t.map, t.count, {}, options).area;
  };
  EXPECT_GT(area(0.5), 1000.0);
  EXPECT_DOUBLE_EQ(area(0.0), area(0.5));  // nobody touches elsewhere
  EXPECT_EQ(area(0.61), 0.0);              // seven hands
  RegionOptions any;
  any.share = 0.0;
  EXPECT_EQ(contact_region(t.map, t.count, {}, any).title, "any of 10 hands");
}

TEST(ContactRegion, DropsSpecksAndFillsHolesAndReportsThem) {
  const Touched t = touched(slab(), 10, [](const Vec3& x) {
    if (!is_on_top(x)) return false;
    const bool is_hole = (x.head<2>() - Eigen::Vector2d(5.0, 0.0)).norm() < 3.5;
    const bool is_speck = (x.head<2>() - Eigen::Vector2d(45.0, 45.0)).norm() < 3.5;
    return is_speck || (x.head<2>().norm() < 25.0 && !is_hole);
  });
  RegionOptions options;
  options.smoothing = 0.0;
  options.smallest_area = 80.0;
  const ContactRegion region = contact_region(t.map, t.count, {}, options);
  EXPECT_EQ(region.patches.size(), 1U);
  EXPECT_EQ(region.patches[0].outline.size(), 1U);
  EXPECT_EQ(region.dropped_specks, 1);
  EXPECT_EQ(region.dropped_holes, 1);
  EXPECT_GT(region.dropped_area, 20.0);
  options.smallest_area = 0.0;
  const ContactRegion all = contact_region(t.map, t.count, {}, options);
  EXPECT_EQ(all.patches.size(), 2U);
  EXPECT_EQ(all.patches[0].outline.size(), 2U);
}

TEST(ContactRegion, RoundAHandleHasTwoOutlines) {
  const Touched t = touched(product::make_cylinder_product({.diameter = 40.0, .length = 120.0}), 10,
                            [](const Vec3& x) { return std::abs(x.z()) < 30.0; });
  const ContactRegion region = contact_region(t.map, t.count, {});
  ASSERT_EQ(region.patches.size(), 1U);
  ASSERT_EQ(region.patches[0].outline.size(), 2U);
  for (const RegionOutline& outline : region.patches[0].outline) {
    EXPECT_NEAR(outline.length, std::numbers::pi * 40.0, 0.5);
  }
}

TEST(ContactRegion, CountsWhoTouchesWithWhichPart) {
  const product::Product product = slab();
  const geometry::TriangleMesh map = study::product_map(product.mesh);
  hand::Hand hand;
  hand.region = {hand::Region::kIndexDistal, hand::Region::kThumbDistal, hand::Region::kDorsum,
                 hand::Region::kThenar};
  HeldHand held;
  held.who = std::make_shared<const hand::Hand>(hand);
  held.skin.vertices = {{-30, 0, -1}, {0, 0, -1}, {0, 1, -1}, {30, 0, -1}};
  held.pressure = {0.1, 0.02, 0.5, 0.0};
  Imprint reach;
  for (int v = 0; v < map.vertex_count(); ++v) {
    const Vec3& x = map.vertices[v];
    if (!is_on_top(x)) continue;
    if ((x - Vec3(-30, 0, 0)).norm() < 6.0) {
      held.product_pressure.vertex.push_back(v);
      held.product_pressure.value.push_back(0.1F);
    } else if (x.norm() < 6.0) {
      reach.point.push_back(v);
      reach.depth.push_back(1.0);
    }
  }
  const auto total = [&](const ContactCount& count, HandPart part) {
    int sum = 0;
    for (const int n : count.of_part[index_of(part)]) sum += n;
    return sum;
  };
  ContactCount count = start_count(map);
  add_hand(count, map, held, reach);
  EXPECT_EQ(total(count, HandPart::kFingers),
            static_cast<int>(held.product_pressure.vertex.size()));
  EXPECT_EQ(total(count, HandPart::kThumb), static_cast<int>(reach.point.size()));
  EXPECT_EQ(total(count, HandPart::kPalm), 0);  // not pressed; the dorsum isn't asked
  ContactCount strong = start_count(map, 0.05);
  add_hand(strong, map, held, reach);
  EXPECT_EQ(total(strong, HandPart::kThumb), 0);  // 0.02 MPa are too little
  EXPECT_EQ(strong.hands, 1);
}

TEST(FaceShares, SumToTheRegion) {
  const product::Product prism = product::make_prism_product({});
  ASSERT_TRUE(prism.faces);
  const study::ProductMap map = study::product_map(prism);
  ContactCount count = start_count(map.mesh);
  count.hands = 4;
  for (std::size_t v = 0; v < count.any.size(); ++v) {
    count.any[v] = map.mesh.vertices[v].z() > 0.0 ? 3 : 1;
  }
  const ContactRegion region = contact_region(map.mesh, count, {});
  double sum = 0.0;
  for (const FaceShare& one :
       face_shares(map.mesh, map.face_of_triangle, static_cast<int>(prism.faces->face.size()),
                   count, region)) {
    sum += one.area;
    EXPECT_DOUBLE_EQ(one.peak_hands, 0.75);
    // Upper end: all of it; long faces: half; but for the smoothing at z = 0.
    EXPECT_TRUE(std::abs(one.share - 1.0) < 1e-9 || std::abs(one.share - 0.5) < 0.03) << one.share;
  }
  EXPECT_NEAR(sum, region.area, 1e-6);
}

TEST(ContactRegion, SaysWhatItNeeds) {
  const geometry::TriangleMesh map = study::product_map(slab().mesh);
  EXPECT_THAT([&] { start_count(map, -1.0); },
              ::testing::ThrowsMessage<UsageError>(
                  "contact region: pressure threshold is -1 MPa; 0 to 100 MPa is allowed"));
  EXPECT_THROW(contact_region(map, start_count(map)), UsageError);
  RegionOptions options;
  options.share = 1.5;
  ContactCount count = start_count(map);
  count.hands = 1;
  EXPECT_THAT([&] { contact_region(map, count, {}, options); },
              ::testing::ThrowsMessage<UsageError>(
                  "contact region: share of the hands is 1.5; 0 to 1 is allowed"));
}

}  // namespace
}  // namespace palmar::redesign
