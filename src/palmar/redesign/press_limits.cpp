// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/press_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/repair/self_intersection.h"
#include "palmar/geometry/smooth_step.h"
#include "palmar/redesign/surface_diffusion.h"

namespace palmar::redesign {
namespace {

constexpr double kLess = 0.75;     // share of the depth that is left after a step back
constexpr int kMaxStepsBack = 24;  // 12 mm become 12 micrometres; then nothing moves there
// Round what is wrong, mm: narrower, the step back would be a bump with folds of its own.
constexpr double kBlend = 10.0;
constexpr double kLeastFacing = 0.1;    // cosine between a moved triangle and its direction
constexpr double kFree = 1.0;           // mm deep; from there a vertex follows the smooth surface
constexpr double kWallRounding = 1e-3;  // mm; rays are single precision

std::vector<std::array<int, 2>> new_crossings(const geometry::TriangleMesh& before,
                                              const geometry::TriangleMesh& after,
                                              std::optional<std::vector<std::array<int, 2>>>& old) {
  std::vector<std::array<int, 2>> pairs = geometry::find_self_crossings(after);
  if (pairs.empty()) return pairs;
  if (!old) old = geometry::find_self_crossings(before);
  std::erase_if(
      pairs, [&](const auto& pair) { return std::binary_search(old->begin(), old->end(), pair); });
  return pairs;
}

}  // namespace

double held_below(double depth, double limit) {
  constexpr double kStraight = 0.75;
  if (!(limit > 0.0)) return 0.0;
  const double x = depth / limit;
  if (x <= kStraight) return depth;
  return limit * (1.0 - (1.0 - kStraight) * std::exp(-(x - kStraight) / (1.0 - kStraight)));
}

std::vector<double> distance_to(const geometry::TriangleMesh& mesh, const std::vector<Vec3>& points,
                                double range) {
  std::vector<double> distance(points.size(), range);
  if (mesh.triangles.empty()) return distance;
  const geometry::ClosestPointQuery query(mesh);
  parallel_for(static_cast<int>(points.size()), [&](int k) {
    if (const auto found = query.closest(points[k], range)) distance[k] = found->distance;
  });
  return distance;
}

std::vector<unsigned char> kept_face_triangles(const product::Product& product,
                                               const KeepOut& keep_out) {
  if (keep_out.faces.empty() && keep_out.names.empty()) return {};
  if (!product.faces) {
    throw UsageError("keep-out: \"" + product.name +
                     "\" is a mesh without faces of CAD; a STEP file has them, or give a box");
  }
  const product::ProductFaces& faces = *product.faces;
  std::vector<unsigned char> kept(faces.face.size(), 0);
  const auto mark = [&](const auto& is_meant, const std::string& what) {
    bool is_found = false;
    for (std::size_t f = 0; f < faces.face.size(); ++f) {
      if (!is_meant(faces.face[f])) continue;
      kept[f] = 1;
      is_found = true;
    }
    if (!is_found) {
      throw UsageError(fmt::format("keep-out: no face {} in \"{}\"; it has {} faces, 1 to {}", what,
                                   product.name, faces.face.size(), faces.face.size()));
    }
  };
  for (const int number : keep_out.faces) {
    mark([&](const product::ProductFace& face) { return face.number == number; },
         std::to_string(number));
  }
  for (const std::string& name : keep_out.names) {
    mark([&](const product::ProductFace& face) { return face.name == name; }, "\"" + name + "\"");
  }
  std::vector<unsigned char> result(product.mesh.triangles.size(), 0);
  for (std::size_t t = 0; t < result.size(); ++t) {
    const int face = faces.face_of_triangle[t];
    if (face >= 0) result[t] = kept[face];
  }
  return result;
}

geometry::TriangleMesh kept_part(const PressRegion& region,
                                 const std::vector<unsigned char>& kept_faces,
                                 const KeepOut& keep_out) {
  geometry::TriangleMesh kept{region.mesh.vertices, {}};
  for (int t = 0; t < region.mesh.triangle_count(); ++t) {
    const Triangle& corner = region.mesh.triangles[t];
    bool is_kept = !kept_faces.empty() && kept_faces[region.triangle_of[t]] != 0;
    Box3 box;
    for (const int v : corner) box.extend(region.mesh.vertices[v]);
    for (const Box3& other : keep_out.boxes) is_kept = is_kept || box.intersects(other);
    if (is_kept) kept.triangles.push_back(corner);
  }
  return kept;
}

std::vector<Vec3> PressedSurface::moved(const std::vector<double>& depth) const {
  std::vector<Vec3> result = region_.part.vertices;
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (depth[i] > 0.0) result[i] -= depth[i] * outward_[i];
  }
  return result;
}

std::vector<double> PressedSurface::without_creases(const std::vector<double>& depth,
                                                    double length) const {
  if (!(length > 0.0)) return depth;
  const geometry::TriangleMesh pressed{moved(depth), region_.part.triangles};
  const std::vector<Vec3> smooth = SurfaceDiffusion(pressed, length).smooth(pressed.vertices);
  std::vector<double> result = depth;
  for (std::size_t i = 0; i < result.size(); ++i) {
    const double change = (pressed.vertices[i] - smooth[i]).dot(outward_[i]);
    result[i] += geometry::smooth_step(depth[i] / kFree) * std::max(0.0, change);
  }
  return result;
}

std::vector<unsigned char> PressedSurface::folded(const std::vector<Vec3>& moved) const {
  std::vector<unsigned char> result(moved.size(), 0);
  for (const Triangle& t : region_.part.triangles) {
    const auto cross = [&](const std::vector<Vec3>& at) -> Vec3 {
      const Vec3& a = at[t[0]];
      return (at[t[1]] - a).cross(at[t[2]] - a);
    };
    const Vec3 before = cross(region_.part.vertices);
    const Vec3 after = cross(moved);
    if (before == after || !(before.norm() > 1e-9)) continue;
    Vec3 facing = Vec3::Zero();
    for (const int v : t) facing += outward_[v];
    if (facing.isZero() || after.dot(facing.normalized()) >= kLeastFacing * after.norm()) continue;
    for (const int v : t) result[v] = 1;
  }
  return result;
}

std::vector<double> PressedSurface::walls(const std::vector<double>& depth, double pressed) const {
  std::vector<double> result(depth.size(), std::numeric_limits<double>::infinity());
  geometry::TriangleMesh mesh = region_.mesh;
  const std::vector<Vec3> place = moved(depth);
  std::vector<Vec3> points, directions;
  std::vector<std::size_t> of;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    mesh.vertices[region_.part_vertex[i]] = place[i];
    if (!(depth[i] > pressed)) continue;
    points.push_back(place[i]);
    directions.push_back(outward_[i]);
    of.push_back(i);
  }
  const ImprintGauge gauge(mesh, std::move(points), std::move(directions));
  for (std::size_t k = 0; k < of.size(); ++k) result[of[k]] = gauge.wall()[k];
  return result;
}

std::vector<double> PressedSurface::sound_share(const std::vector<double>& depth,
                                                const std::vector<double>& wall_before, double wall,
                                                const Progress& progress) const {
  std::vector<double> share(depth.size(), 1.0);
  std::vector<double> tried = depth;
  std::vector<int> part_of(region_.mesh.vertices.size(), -1);
  for (std::size_t i = 0; i < region_.part_vertex.size(); ++i) {
    part_of[region_.part_vertex[i]] = static_cast<int>(i);
  }
  std::optional<std::vector<std::array<int, 2>>> old_crossings;
  for (int round = 0; round <= kMaxStepsBack; ++round) {
    progress.throw_if_cancelled();
    const std::vector<Vec3> place = moved(tried);
    std::vector<unsigned char> wrong = folded(place);
    geometry::TriangleMesh mesh = region_.mesh;
    for (std::size_t i = 0; i < place.size(); ++i) {
      mesh.vertices[region_.part_vertex[i]] = place[i];
    }
    for (const auto& pair : new_crossings(region_.mesh, mesh, old_crossings)) {
      for (const int t : pair) {
        for (const int v : mesh.triangles[t]) {
          const int i = part_of[v];
          if (i >= 0) wrong[i] = 1;
        }
      }
    }
    if (wall > 0.0) {
      const std::vector<double> left = walls(tried, 0.0);
      for (std::size_t i = 0; i < left.size(); ++i) {
        if (left[i] < std::min(wall, wall_before[i]) - kWallRounding) wrong[i] = 1;
      }
    }
    geometry::TriangleMesh marks{region_.part.vertices, {}};
    for (std::size_t i = 0; i < wrong.size(); ++i) {
      if (wrong[i] == 0) continue;
      const int v = static_cast<int>(i);
      marks.triangles.push_back({v, v, v});
    }
    if (marks.triangles.empty()) break;
    const std::vector<double> distance = distance_to(marks, region_.part.vertices, kBlend);
    const double least = round + 1 >= kMaxStepsBack ? 0.0 : kLess;
    for (std::size_t i = 0; i < share.size(); ++i) {
      share[i] *= least + (1.0 - least) * geometry::smooth_step(distance[i] / kBlend);
      tried[i] = share[i] * depth[i];
    }
  }
  return share;
}

double PressedSurface::thinnest_wall(const std::vector<double>& depth, double pressed) const {
  const std::vector<double> left = walls(depth, pressed);
  return left.empty() ? std::numeric_limits<double>::infinity()
                      : *std::min_element(left.begin(), left.end());
}

}  // namespace palmar::redesign
