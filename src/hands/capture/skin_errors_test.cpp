// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/skin_errors.h"

#include <gtest/gtest.h>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::capture {
namespace {

// A slab of skin of 40 x 40 mm whose face stands `gap` over the product's top, moved along x.
geometry::TriangleMesh slab(double gap, double x) {
  geometry::TriangleMesh mesh = geometry::make_box({40.0, 40.0, 10.0}, 40);
  for (Vec3& v : mesh.vertices) v += Vec3(x, 0.0, gap + 5.0);
  return mesh;
}

geometry::TriangleMesh table() {
  geometry::TriangleMesh mesh = geometry::make_box({200.0, 200.0, 20.0});
  for (Vec3& v : mesh.vertices) v.z() -= 10.0;
  return mesh;
}

TEST(ContactOverlap, CountsWhatBothTouch) {
  // Across x the first touches 40 mm and the sqrt(2^2 - 1^2) = 1.73 mm beyond each edge that are
  // within 2 mm, -21.73 to 21.73; the other -12 to 32; along y 43.46 and 44 mm.
  const ContactOverlap overlap = contact_overlap(slab(1.0, 0.0), slab(-0.5, 10.0), table());
  EXPECT_NEAR(overlap.share_of_hand, 33.73 / 43.46, 0.01);
  EXPECT_NEAR(overlap.share_of_scan, 33.73 * 43.46 / (44.0 * 44.0), 0.01);
  const double shared = 33.73 * 43.46;
  EXPECT_NEAR(overlap.intersection_over_union, shared / (43.46 * 43.46 + 44.0 * 44.0 - shared),
              0.01);
  // The side walls of the slabs touch, too, as far as they are within 2 mm.
  EXPECT_NEAR(overlap.hand_area, 1600.0 + 160.0, 100.0);
  EXPECT_GT(overlap.scanned_area, overlap.hand_area);
}

TEST(ContactOverlap, OfTheSameSkinIsWhole) {
  const ContactOverlap overlap = contact_overlap(slab(1.0, 3.0), slab(1.0, 3.0), table());
  EXPECT_DOUBLE_EQ(overlap.intersection_over_union, 1.0);
  EXPECT_DOUBLE_EQ(overlap.hand_area, overlap.scanned_area);
}

TEST(ContactOverlap, IsNoneBeyondTheRange) {
  const ContactOverlap apart = contact_overlap(slab(2.1, 0.0), slab(1.0, 0.0), table());
  EXPECT_EQ(apart.hand_area, 0.0);
  EXPECT_EQ(apart.intersection_over_union, 0.0);
  EXPECT_GT(apart.scanned_area, 1500.0);
  EXPECT_THROW(contact_overlap(slab(1, 0), slab(1, 0), table(), 0.0), UsageError);
}

}  // namespace
}  // namespace palmar::capture
