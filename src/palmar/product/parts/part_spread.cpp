// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/part_spread.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar {
namespace {

// The direction that is unlike the other two, and how much so: of something round, its axis.
std::pair<Vec3, double> odd_axis(const Spread& s) {
  const double first = std::log(s.size[0] / s.size[1]), last = std::log(s.size[1] / s.size[2]);
  return first > last ? std::pair(Vec3(s.axes.col(0)), first - last)
                      : std::pair(Vec3(s.axes.col(2)), last - first);
}

}  // namespace

Vec3 surface_middle(const TriangleMesh& mesh) {
  Vec3 sum = Vec3::Zero();
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double A = triangle_area(a, b, c);
    area += A;
    sum += A / 3.0 * (a + b + c);
  }
  return area > 0.0 ? Vec3(sum / area) : Vec3(mesh.vertices[mesh.triangles[0][0]]);
}

Spread spread_of(const TriangleMesh& piece) {
  Spread s;
  s.middle = surface_middle(piece);
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  double area = 0.0;
  for (const Triangle& t : piece.triangles) {
    const Vec3 a = piece.vertices[t[0]] - s.middle, b = piece.vertices[t[1]] - s.middle,
               c = piece.vertices[t[2]] - s.middle;
    const double A = triangle_area(a, b, c);
    const Vec3 sum = a + b + c;
    area += A;
    second += A / 12.0 *
              (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  if (!(area > 0.0)) return s;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(second / area);
  for (int k = 0; k < 3; ++k) {
    s.axes.col(k) = solver.eigenvectors().col(2 - k);
    s.size[k] = std::sqrt(std::max(0.0, solver.eigenvalues()[2 - k]));
  }
  return s;
}

Vec3 extents_of(const TriangleMesh& piece, const Eigen::Matrix3d& axes) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec3& p : piece.vertices) {
    const Vec3 q = axes.transpose() * p;
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
  }
  return piece.vertices.empty() ? Vec3(Vec3::Zero()) : Vec3(high - low);
}

Spread facing_of(const TriangleMesh& piece) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  double area = 0.0;
  for (const Triangle& t : piece.triangles) {
    const Vec3 n = (piece.vertices[t[1]] - piece.vertices[t[0]])
                       .cross(piece.vertices[t[2]] - piece.vertices[t[0]]);
    const double length = n.norm();
    if (length > 0.0) sum += n * n.transpose() / length;
    area += length;
  }
  Spread s;
  if (!(area > 0.0)) return s;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sum / area);
  for (int k = 0; k < 3; ++k) {
    s.axes.col(k) = solver.eigenvectors().col(2 - k);
    s.size[k] = std::sqrt(std::max(1e-12, solver.eigenvalues()[2 - k]));
  }
  return s;
}

double roundness_of(const TriangleMesh& piece, const Spread& spread) {
  double farthest = 0.0;
  for (const Vec3& p : piece.vertices) farthest = std::max(farthest, (p - spread.middle).norm());
  return spread.size.norm() > 0.0 ? farthest / spread.size.norm() : 2.0;
}

Vec3 body_axis(const Spread& spread, const Spread& facing) {
  constexpr double kLong = 1.4;  // ratio of spreads
  if (spread.size[0] > kLong * spread.size[1]) return spread.axes.col(0);
  const auto [by_place, place] = odd_axis(spread);
  const auto [by_normal, normal] = odd_axis(facing);
  return place >= normal ? by_place : by_normal;
}

}  // namespace palmar
