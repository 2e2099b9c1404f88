// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/skin_errors.h"

#include <string>

#include "palmar/core/error.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/remesh/split_edges.h"
#include "palmar/hand/skin/skinning.h"

namespace palmar::capture {
namespace {

/// Per point: nearer to the solid than `range`, or inside.
std::vector<char> is_touched(const std::vector<Vec3>& points, const geometry::MeshDistance& by,
                             double range) {
  std::vector<geometry::DistanceSample> samples(points.size());
  by.sample(points, range, samples);
  std::vector<char> result;
  result.reserve(points.size());
  for (const geometry::DistanceSample& s : samples) result.push_back(s.distance < range);
  return result;
}

double area_touched(const geometry::TriangleMesh& skin, const geometry::MeshDistance& product,
                    double range) {
  const std::vector<double> area = geometry::vertex_areas(skin);
  const std::vector<char> touched = is_touched(skin.vertices, product, range);
  double sum = 0.0;
  for (std::size_t v = 0; v < area.size(); ++v) sum += touched[v] ? area[v] : 0.0;
  return sum;
}

}  // namespace

std::optional<double> mean_skin_error(const hand::Hand& hand, const hand::Posture& posture,
                                      const std::vector<int>& vertices, const SkinScan& scan) {
  constexpr double kReach = 15.0;  // mm
  const std::vector<Vec3> skin = hand::pose_skin(hand, posture);
  const std::vector<Vec3> all_normals = geometry::vertex_normals(skin, hand.skin.triangles);
  std::vector<Vec3> point, normal;
  for (const int v : vertices) {
    point.push_back(skin[v]);
    normal.push_back(all_normals[v]);
  }
  double sum = 0.0;
  int count = 0;
  for (const double d : distances_to_scan(point, normal, scan, hand.skeleton, kReach)) {
    if (d < 0.0) continue;
    sum += d;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

ContactOverlap contact_overlap(const geometry::TriangleMesh& posed_skin,
                               const geometry::TriangleMesh& scanned_skin,
                               const geometry::TriangleMesh& product, double range) {
  if (!(range > 0.0 && range <= 50.0)) {
    throw UsageError("contact overlap: the range is " + std::to_string(range) +
                     " mm; above 0 to 50 mm is allowed");
  }
  const geometry::MeshDistance to_product(product), to_hand(posed_skin), to_scan(scanned_skin);
  ContactOverlap overlap;
  overlap.hand_area = area_touched(posed_skin, to_product, range);
  overlap.scanned_area = area_touched(scanned_skin, to_product, range);
  // The product in pieces of about a millimetre: its triangles may be as large as it is.
  constexpr double kPiece = 1.0;  // mm
  Box3 skins;
  for (const geometry::TriangleMesh* skin : {&posed_skin, &scanned_skin}) {
    for (const Vec3& v : skin->vertices) skins.extend(v);
  }
  const geometry::TriangleMesh fine =
      geometry::split_long_edges(product, kPiece, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        Box3 box(a);
        box.extend(b);
        box.extend(c);
        return box.exteriorDistance(skins) <= range;
      });
  const std::vector<double> area = geometry::vertex_areas(fine);
  const std::vector<char> by_hand = is_touched(fine.vertices, to_hand, range);
  const std::vector<char> by_scan = is_touched(fine.vertices, to_scan, range);
  double hand = 0.0, scan = 0.0;
  for (std::size_t v = 0; v < area.size(); ++v) {
    if (by_hand[v]) hand += area[v];
    if (by_scan[v]) scan += area[v];
    if (by_hand[v] && by_scan[v]) overlap.shared_area += area[v];
  }
  const double either = hand + scan - overlap.shared_area;
  if (either > 0.0) overlap.intersection_over_union = overlap.shared_area / either;
  if (hand > 0.0) overlap.share_of_hand = overlap.shared_area / hand;
  if (scan > 0.0) overlap.share_of_scan = overlap.shared_area / scan;
  return overlap;
}

}  // namespace palmar::capture
