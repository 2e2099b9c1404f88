// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/prepared/contact_patch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::contact {
namespace {

TEST(ContactArea, EdgeStandsWhereBothLawsOfTheContactsEdgeHold) {
  // One loaded corner of a right triangle with legs of 2 mm. With the contact's edge at x on both
  // legs its part is (x / l)^2. From any x and K: p = K sqrt(x), g = (K / 3G) (l - x)^1.5.
  const std::vector<Vec3> positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  const std::vector<Triangle> triangles = {{0, 1, 2}};
  constexpr double kLength = 2.0, kModulus = 0.04;  // mm, MPa
  for (const double K : {0.001, 0.05, 2.0}) {
    for (const double x : {1e-6, 0.01, 0.3, 1.0, 1.7, 1.99, 2.0 - 1e-6}) {
      const double p = K * std::sqrt(x);
      const double g = K / (3.0 * kModulus) * std::pow(kLength - x, 1.5);
      const auto area =
          contact_area(positions, triangles, {p, 0.0, 0.0}, {0.0, g, g}, {kModulus, 0.0, 0.0});
      const double share = x / kLength;
      EXPECT_NEAR(area[0], 2.0 * share * share, 1e-9 * share) << "K " << K << " x " << x;
      EXPECT_EQ(area[1] + area[2], 0.0);
    }
  }
}

TEST(ContactArea, CountsWholeTrianglesAndSkinThatTouches) {
  const std::vector<Vec3> positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  const std::vector<Triangle> triangles = {{0, 1, 2}};
  const std::vector<double> modulus(3, 0.04);
  const auto whole = contact_area(positions, triangles, {0.1, 0.2, 0.3}, {0, 0, 0}, modulus);
  EXPECT_NEAR(whole[0] + whole[1] + whole[2], 2.0, 1e-15);
  // A lifted vertex without a gap: the contact reaches up to it.
  const auto touching = contact_area(positions, triangles, {0.1, 0.2, 0.0}, {0, 0, 0}, modulus);
  EXPECT_NEAR(touching[0] + touching[1], 2.0, 1e-15);
  const auto none = contact_area(positions, triangles, {0, 0, 0}, {0, 0, 0}, modulus);
  EXPECT_EQ(none, std::vector<double>(3, 0.0));
}

TEST(PeakOverCells, OfEvenPressureIsThatPressure) {
  const SkinGeometry skin = skin_geometry(geometry::make_icosphere(10.0, 4));
  std::vector<double> force;
  for (const double a : skin.area) force.push_back(0.07 * a);
  const std::vector<hand::Region> region(force.size(), hand::Region::kIndexDistal);
  for (const double area : {4.0, kUsualCellArea, 60.0}) {
    const CellPeaks peaks = peak_over_cells(skin, std::vector<int>{0, 5, 77}, force, region, area);
    EXPECT_NEAR(peaks.all, 0.07, 1e-12) << area;
    EXPECT_EQ(peaks.own, peaks.all);
  }
}

TEST(PeakOverCells, CellsCoverTheirArea) {
  // Voronoi discs overlap here and leave gaps there; together they cover a cell within some per
  // cent.
  const SkinGeometry skin = skin_geometry(geometry::make_icosphere(30.0, 5));
  std::vector<int> centres;
  for (int v = 0; v < skin.vertex_count(); v += 97) centres.push_back(v);
  const SensorCells cells =
      sensor_cells(skin, centres, std::vector<double>(centres.size(), kUsualCellArea));
  for (std::size_t c = 0; c < centres.size(); ++c) {
    double sum = 0.0;
    for (int k = cells.begin[c]; k < cells.begin[c + 1]; ++k) sum += cells.shared[k];
    EXPECT_NEAR(sum, kUsualCellArea, 0.05 * kUsualCellArea);
  }
}

TEST(PeakOverCells, OwnLoadIsThatOfTheCentresRegion) {
  const SkinGeometry skin = skin_geometry(geometry::make_icosphere(10.0, 4));
  std::vector<double> force;
  std::vector<hand::Region> region;
  for (int v = 0; v < skin.vertex_count(); ++v) {
    const bool is_left = skin.position[v].x() < 0.0;
    region.push_back(is_left ? hand::Region::kIndexDistal : hand::Region::kIndexMiddle);
    force.push_back((is_left ? 0.1 : 0.3) * skin.area[v]);
  }
  int border = 0;  // the vertex of the left part that is nearest to the right one, on the equator
  for (int v = 0; v < skin.vertex_count(); ++v) {
    if (region[v] != hand::Region::kIndexDistal) continue;
    if (skin.position[v].x() > skin.position[border].x() || region[border] != region[v]) border = v;
  }
  const CellPeaks peaks =
      peak_over_cells(skin, std::vector<int>{border}, force, region, kUsualCellArea);
  EXPECT_LT(peaks.own, 0.1);
  EXPECT_GT(peaks.own, 0.04);
  EXPECT_GT(peaks.all, 0.15);
  EXPECT_LT(peaks.all, 0.25);
}

}  // namespace
}  // namespace palmar::contact
