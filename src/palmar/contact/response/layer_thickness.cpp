// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/response/layer_thickness.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/ray_query.h"

namespace palmar::contact {
namespace {

constexpr int kDirections = 96;
constexpr double kFarthestBone = 40.0;  // mm
constexpr double kStart = 0.01;         // mm; a bone that touches the skin counts as kLeast deep

/// Directions of a half sphere about z, as dense as the cosine of their angle from it: points of a
/// sunflower on the disc, lifted (Malley's method).
std::vector<Vec3> cosine_weighted_directions() {
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<Vec3> directions;
  for (int k = 0; k < kDirections; ++k) {
    const double share = (k + 0.5) / kDirections;
    const double radius = std::sqrt(share);
    directions.emplace_back(radius * std::cos(k * golden), radius * std::sin(k * golden),
                            std::sqrt(1.0 - share));
  }
  return directions;
}

}  // namespace

std::vector<double> effective_layer_thickness(const hand::Hand& hand, const SkinGeometry& skin) {
  const std::size_t n = skin.position.size();
  std::vector<double> thickness(n, kMostLayerThickness);
  geometry::TriangleMesh bones;
  for (const hand::Bone& bone : hand.bones) {
    const int first = bones.vertex_count();
    bones.vertices.insert(bones.vertices.end(), bone.mesh.vertices.begin(),
                          bone.mesh.vertices.end());
    for (const Triangle& t : bone.mesh.triangles) {
      bones.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  }
  if (bones.triangles.empty()) return thickness;
  const geometry::RayQuery query(bones);
  const std::vector<Vec3> directions = cosine_weighted_directions();
  parallel_for(static_cast<int>(n), [&](int vertex) {
    Eigen::Matrix3d axes;
    axes.col(2) = -skin.normal[vertex];
    axes.col(0) = axes.col(2).unitOrthogonal();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    double sum = 0.0;
    for (const Vec3& direction : directions) {
      const auto hit =
          query.first_hit(skin.position[vertex], axes * direction, kStart, kFarthestBone);
      if (!hit) continue;
      const double depth = std::max(hit->distance * direction.z(), kLeastLayerThickness);
      sum += 1.0 / (depth * depth);
    }
    if (sum > 0.0) {
      thickness[vertex] =
          std::clamp(1.0 / std::sqrt(sum / kDirections), kLeastLayerThickness, kMostLayerThickness);
    }
  });
  return thickness;
}

}  // namespace palmar::contact
