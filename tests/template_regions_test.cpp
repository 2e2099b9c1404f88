// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/hand/mirror.h"
#include "palmar/hand/skin/regions.h"
#include "template_fixture.h"

namespace palmar::tests {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;

class TemplateRegions : public TemplateTest {};

// Components of the vertices that carry each label.
template <typename Label>
std::map<Label, int> components(const geometry::TriangleMesh& skin,
                                const std::vector<Label>& label) {
  const auto neighbours = geometry::vertex_neighbours(geometry::build_topology(skin));
  std::vector<bool> is_seen(label.size());
  std::map<Label, int> count;
  for (std::size_t seed = 0; seed < label.size(); ++seed) {
    if (is_seen[seed]) continue;
    ++count[label[seed]];
    std::vector<std::size_t> stack{seed};
    is_seen[seed] = true;
    while (!stack.empty()) {
      const std::size_t i = stack.back();
      stack.pop_back();
      for (const int n : neighbours[i]) {
        const auto j = static_cast<std::size_t>(n);
        if (is_seen[j] || label[j] != label[i]) continue;
        is_seen[j] = true;
        stack.push_back(j);
      }
    }
  }
  return count;
}

TEST_F(TemplateRegions, EveryRegionAndSegmentIsThereInOnePiece) {
  const auto regions = components(hand().skin, hand().region);
  EXPECT_EQ(regions.size(), static_cast<std::size_t>(hand::kRegionCount));
  for (const auto& [region, count] : regions) EXPECT_EQ(count, 1) << name_of(region);
  const auto segments = components(hand().skin, hand().segment);
  EXPECT_EQ(segments.size(), static_cast<std::size_t>(hand::kSegmentCount));
  for (const auto& [segment, count] : segments) EXPECT_EQ(count, 1) << name_of(segment);
}

TEST_F(TemplateRegions, EachPalmarRegionLiesOnItsSegment) {
  for (std::size_t i = 0; i < hand().region.size(); ++i) {
    const auto segment = hand::segment_of(hand().region[i]);
    EXPECT_EQ(segment.value_or(hand().segment[i]), hand().segment[i]) << "vertex " << i;
  }
}

TEST_F(TemplateRegions, SlidingOntoCreasesLeavesGoodTriangles) {
  // Asked of the template: above 20 degrees for 99 % of the triangles.
  std::vector<double> angle = geometry::smallest_angles(hand().skin);
  std::sort(angle.begin(), angle.end());
  EXPECT_GT(angle[angle.size() / 100], 20.0 * kDeg);
  EXPECT_GT(angle.front(), 10.0 * kDeg);
  geometry::require_closed_manifold(hand().skin, "skin");
}

TEST_F(TemplateRegions, CreasesRunSmoothlyAlongEdges) {
  const geometry::TriangleMesh& skin = hand().skin;
  const geometry::MeshTopology topology = geometry::build_topology(skin);
  const std::vector<hand::Region> of = hand::triangle_regions(skin.triangles, hand().region);
  std::map<int, std::vector<int>> along;  // vertex -> other ends of crease edges
  for (int h = 0; h < static_cast<int>(topology.twin.size()); ++h) {
    const int twin = topology.twin[static_cast<std::size_t>(h)];
    if (of[static_cast<std::size_t>(h / 3)] == of[static_cast<std::size_t>(twin / 3)]) continue;
    const Triangle& t = skin.triangles[static_cast<std::size_t>(h / 3)];
    along[t[static_cast<std::size_t>(h % 3)]].push_back(t[static_cast<std::size_t>((h + 1) % 3)]);
  }
  std::vector<double> turning;
  for (const auto& [i, ends] : along) {
    if (ends.size() != 2) continue;  // corners between three regions
    const Vec3& p = skin.vertices[static_cast<std::size_t>(i)];
    const Vec3 a = p - skin.vertices[static_cast<std::size_t>(ends[0])];
    const Vec3 b = skin.vertices[static_cast<std::size_t>(ends[1])] - p;
    turning.push_back(std::atan2(a.cross(b).norm(), a.dot(b)));
  }
  ASSERT_GT(turning.size(), 300u);
  std::sort(turning.begin(), turning.end());
  double mean = 0.0;
  for (const double t : turning) mean += t / static_cast<double>(turning.size());
  // A saw-tooth along triangles turns by 60 degrees at every vertex; a curve round a finger of
  // 8 mm radius in steps of 2.5 mm by 18.
  EXPECT_LT(mean, 15.0 * kDeg);
  EXPECT_LT(turning[turning.size() * 95 / 100], 45.0 * kDeg);
}

TEST_F(TemplateRegions, AreasHaveTheOrderOfAHand) {
  const std::vector<double> area = geometry::vertex_areas(hand().skin);
  std::array<double, hand::kRegionCount> sum{};
  for (std::size_t i = 0; i < area.size(); ++i) {
    sum[static_cast<std::size_t>(hand().region[i])] += area[i];
  }
  const auto of = [&](hand::Region r) { return sum[static_cast<std::size_t>(r)]; };
  // Pulps of 300 to 1200 mm^2; thenar and hypothenar are the largest palmar regions.
  for (const hand::Region r :
       {hand::Region::kThumbDistal, hand::Region::kIndexDistal, hand::Region::kMiddleDistal,
        hand::Region::kRingDistal, hand::Region::kLittleDistal}) {
    EXPECT_GT(of(r), 300.0) << name_of(r);
    EXPECT_LT(of(r), 1200.0) << name_of(r);
  }
  for (int r = 1; r < hand::kRegionCount; ++r) {
    const auto region = static_cast<hand::Region>(r);
    if (region == hand::Region::kThenar || region == hand::Region::kHypothenar) continue;
    EXPECT_LT(of(region), of(hand::Region::kThenar)) << name_of(region);
    EXPECT_LT(of(region), of(hand::Region::kHypothenar)) << name_of(region);
  }
}

TEST_F(TemplateRegions, FingertipsAndWebsArePalmarAndTheForearmIsNot) {
  const geometry::TriangleMesh& skin = hand().skin;
  const auto region_near = [&](const Vec3& p) {
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < skin.vertices.size(); ++i) {
      if ((skin.vertices[i] - p).norm() < (skin.vertices[nearest] - p).norm()) nearest = i;
    }
    return hand().region[nearest];
  };
  EXPECT_EQ(region_near(hand().skeleton.fingertips[2]), hand::Region::kMiddleDistal);
  EXPECT_EQ(region_near(hand().skeleton.fingertips[0]), hand::Region::kThumbDistal);
  const Vec3 wrist = hand().skeleton.joint(hand::JointId::kWrist).centre;
  EXPECT_EQ(region_near(wrist + Vec3(0.0, -10.0, 30.0)), hand::Region::kDorsum);
  const Vec3 mcp = hand().skeleton.joint(hand::JointId::kMiddleMcp).centre;
  EXPECT_EQ(region_near(mcp + Vec3(0.0, 0.0, -30.0)), hand::Region::kDorsum);
  EXPECT_EQ(region_near(mcp + Vec3(5.0, 5.0, 30.0)), hand::Region::kRadialPalm);
}

TEST_F(TemplateRegions, ALeftHandIsPartitionedAlike) {
  const hand::Hand left = hand::mirrored(hand());
  const hand::SkinPartition again = hand::partition_skin(left.skin, left.skeleton);
  const hand::SkinPartition right = hand::partition_skin(hand().skin, hand().skeleton);
  int different = 0;
  for (std::size_t i = 0; i < again.region.size(); ++i) {
    different += again.region[i] != right.region[i] || again.segment[i] != right.segment[i];
  }
  // Rounding may turn a tie, nothing more.
  EXPECT_LE(different, static_cast<int>(again.region.size() / 1000));
}

}  // namespace
}  // namespace palmar::tests
