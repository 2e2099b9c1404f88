// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/surface/flat_patches.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "palmar/core/parallel.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"

namespace palmar::capture {
namespace {

constexpr double kReach = 3.0;       // mm; paraboloids, so that ripples of stereo don't count
constexpr double kFarthest = 0.6;    // mm, that a vertex moves
constexpr int kSmoothings = 3;       // of the moves over the mesh
constexpr std::size_t kFewest = 10;  // vertices for a paraboloid of six numbers

/// Vertices within kReach of one, going from neighbour to neighbour, that look the same way.
void gather(const geometry::TriangleMesh& mesh, const std::vector<std::vector<int>>& neighbours,
            const std::vector<Vec3>& normals, int middle, std::vector<int>& found) {
  found.assign(1, middle);
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (const int next : neighbours[found[i]]) {
      if ((mesh.vertices[next] - mesh.vertices[middle]).squaredNorm() > kReach * kReach ||
          normals[next].dot(normals[middle]) < 0.0 ||
          std::find(found.begin(), found.end(), next) != found.end()) {
        continue;
      }
      found.push_back(next);
    }
  }
}

/// 1/2 tr(K S) of a vertex.
double shift_of(const geometry::TriangleMesh& mesh, const std::vector<int>& near,
                const Vec3& normal, const Eigen::Matrix3d& patch) {
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  Eigen::Matrix<double, 6, 6> a = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> b = Eigen::Matrix<double, 6, 1>::Zero();
  for (const int i : near) {
    const Vec3 d = mesh.vertices[i] - mesh.vertices[near.front()];
    const double x = d.dot(u), y = d.dot(v);
    Eigen::Matrix<double, 6, 1> row;
    row << 1.0, x, y, 0.5 * x * x, x * y, 0.5 * y * y;
    a += row * row.transpose();
    b += row * d.dot(normal);
  }
  const Eigen::Matrix<double, 6, 1> h = a.ldlt().solve(b);
  // The paraboloid falls away from convex skin: K = -(second derivatives).
  const double shift =
      -0.5 * (h[3] * u.dot(patch * u) + 2.0 * h[4] * u.dot(patch * v) + h[5] * v.dot(patch * v));
  return std::isfinite(shift) ? std::clamp(shift, -kFarthest, kFarthest) : 0.0;
}

}  // namespace

geometry::TriangleMesh without_flat_patches(const geometry::TriangleMesh& mesh,
                                            const PointCells& points) {
  const std::vector<std::vector<int>> neighbours =
      geometry::vertex_neighbours(geometry::build_topology(mesh));
  const std::vector<Vec3> normals = geometry::vertex_normals(mesh);
  const std::size_t count = mesh.vertices.size();
  std::vector<double> shift(count, 0.0);
  constexpr std::size_t kChunk = 256;
  const auto chunks = static_cast<int>((count + kChunk - 1) / kChunk);
  parallel_for(chunks, [&](int chunk) {
    std::vector<int> near;
    const std::size_t begin = static_cast<std::size_t>(chunk) * kChunk;
    for (std::size_t i = begin; i < std::min(count, begin + kChunk); ++i) {
      const PointSupport support = points.near(mesh.vertices[i]);
      if (support.points == 0.0) continue;
      gather(mesh, neighbours, normals, static_cast<int>(i), near);
      if (near.size() >= kFewest) shift[i] = shift_of(mesh, near, normals[i], support.patch);
    }
  });
  for (int round = 0; round < kSmoothings; ++round) {
    std::vector<double> smooth(count);
    for (std::size_t i = 0; i < count; ++i) {
      double sum = shift[i];
      for (const int next : neighbours[i]) sum += shift[next];
      smooth[i] = sum / (1.0 + static_cast<double>(neighbours[i].size()));
    }
    shift = std::move(smooth);
  }
  geometry::TriangleMesh moved = mesh;
  for (std::size_t i = 0; i < count; ++i) moved.vertices[i] += shift[i] * normals[i];
  return moved;
}

}  // namespace palmar::capture
