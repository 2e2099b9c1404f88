// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/part_spread.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::product {
namespace {

// The direction that is unlike the other two, and how much so: of something round, its axis.
std::pair<Vec3, double> odd_axis(const Spread& s) {
  const double first = std::log(s.size[0] / s.size[1]), last = std::log(s.size[1] / s.size[2]);
  return first > last ? std::pair(Vec3(s.axes.col(0)), first - last)
                      : std::pair(Vec3(s.axes.col(2)), last - first);
}

// Where the normals lie in the plane of two axes: sum of A rho^4 e^(4 i phi), by polar coordinates
// of each unit normal there; and the sum of A rho^4. The phase of the first is four times the angle
// to the direction that they gather at, modulo a right angle.
std::pair<std::complex<double>, double> fourfold(const geometry::TriangleMesh& piece, const Vec3& u,
                                                 const Vec3& v) {
  std::complex<double> gathered = 0.0;
  double all = 0.0;
  for (const Triangle& t : piece.triangles) {
    const Vec3 n = (piece.vertices[t[1]] - piece.vertices[t[0]])
                       .cross(piece.vertices[t[2]] - piece.vertices[t[0]]);
    const double area = n.norm();
    if (!(area > 0.0)) continue;
    const std::complex<double> z(u.dot(n) / area, v.dot(n) / area);
    gathered += area * z * z * z * z;
    all += area * std::norm(z) * std::norm(z);
  }
  return {gathered, all};
}

// Share of a surface that faces along an axis, either way.
double share_facing(const geometry::TriangleMesh& piece, const Vec3& axis) {
  constexpr double kFlatEnd = 0.99;  // cosine (8 deg)
  double along = 0.0, all = 0.0;
  for (const Triangle& t : piece.triangles) {
    const Vec3 n = (piece.vertices[t[1]] - piece.vertices[t[0]])
                       .cross(piece.vertices[t[2]] - piece.vertices[t[0]]);
    all += n.norm();
    if (std::abs(axis.dot(n)) >= kFlatEnd * n.norm()) along += n.norm();
  }
  return all > 0.0 ? along / all : 0.0;
}

}  // namespace

bool FaceAxes::is_box() const {
  // Choice: half of the way round is flat; a square's, with edges rounded by 0.28 of its width.
  constexpr double kBox = 0.5;
  return sharpness >= kBox;
}

FaceAxes face_axes_of(const geometry::TriangleMesh& piece) {
  FaceAxes result;
  result.axes = facing_of(piece).axes;
  constexpr int kSweeps = 12;             // two or three are usual
  constexpr double kSmallestTurn = 1e-9;  // rad
  constexpr std::array<std::array<int, 2>, 3> kPlanes = {{{0, 1}, {0, 2}, {1, 2}}};
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double turned = 0.0;
    for (const auto& [a, b] : kPlanes) {
      const Vec3 u = result.axes.col(a), v = result.axes.col(b);
      const auto [gathered, all] = fourfold(piece, u, v);
      if (!(std::abs(gathered) > 1e-9 * all)) continue;
      const double turn = 0.25 * std::arg(gathered);
      result.axes.col(a) = std::cos(turn) * u + std::sin(turn) * v;
      result.axes.col(b) = std::cos(turn) * v - std::sin(turn) * u;
      turned = std::max(turned, std::abs(turn));
    }
    if (turned < kSmallestTurn) break;
  }
  result.sharpness = 1.0;
  for (const auto& [a, b] : kPlanes) {
    const auto [gathered, all] = fourfold(piece, result.axes.col(a), result.axes.col(b));
    result.sharpness =
        std::min(result.sharpness, all > 0.0 ? std::max(0.0, gathered.real() / all) : 0.0);
  }
  return result;
}

Vec3 surface_middle(const geometry::TriangleMesh& mesh) {
  Vec3 sum = Vec3::Zero();
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double A = geometry::triangle_area(a, b, c);
    area += A;
    sum += A / 3.0 * (a + b + c);
  }
  return area > 0.0 ? Vec3(sum / area) : Vec3(mesh.vertices[mesh.triangles[0][0]]);
}

Spread spread_of(const geometry::TriangleMesh& piece) {
  Spread s;
  s.middle = surface_middle(piece);
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  double area = 0.0;
  for (const Triangle& t : piece.triangles) {
    const Vec3 a = piece.vertices[t[0]] - s.middle, b = piece.vertices[t[1]] - s.middle,
               c = piece.vertices[t[2]] - s.middle;
    const double A = geometry::triangle_area(a, b, c);
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

Vec3 extents_of(const geometry::TriangleMesh& piece, const Eigen::Matrix3d& axes) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec3& p : piece.vertices) {
    const Vec3 q = axes.transpose() * p;
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
  }
  return piece.vertices.empty() ? Vec3(Vec3::Zero()) : Vec3(high - low);
}

Spread facing_of(const geometry::TriangleMesh& piece) {
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

double roundness_of(const geometry::TriangleMesh& piece, const Spread& spread) {
  double farthest = 0.0;
  for (const Vec3& p : piece.vertices) farthest = std::max(farthest, (p - spread.middle).norm());
  return spread.size.norm() > 0.0 ? farthest / spread.size.norm() : 2.0;
}

Vec3 body_axis(const geometry::TriangleMesh& piece, const Spread& spread, const Spread& facing) {
  const FaceAxes faces = face_axes_of(piece);
  if (faces.is_box()) {
    int longest = 0;
    extents_of(piece, faces.axes).maxCoeff(&longest);
    return faces.axes.col(longest);
  }
  constexpr double kLong = 1.4;  // ratio of spreads
  Vec3 axis = spread.axes.col(0);
  if (spread.size[0] <= kLong * spread.size[1]) {
    const auto [by_place, place] = odd_axis(spread);
    const auto [by_normal, normal] = odd_axis(facing);
    axis = place >= normal ? by_place : by_normal;
  }
  // Flat ends say where it runs more sharply than a spread about as large in all directions.
  constexpr double kNear = 0.966;  // cosine (15 deg)
  constexpr double kEnds = 0.1;    // share of the surface
  for (int k = 0; k < 3; ++k) {
    const Vec3 across = faces.axes.col(k);
    if (std::abs(across.dot(axis)) >= kNear && share_facing(piece, across) >= kEnds) return across;
  }
  return axis;
}

Vec3 plate_axis(const geometry::TriangleMesh& piece, const Spread& spread, const Vec3& normal) {
  const FaceAxes faces = face_axes_of(piece);
  Vec3 axis = spread.axes.col(0);
  if (faces.is_box()) {
    const Vec3 extents = extents_of(piece, faces.axes);
    double longest = 0.0;
    for (int k = 0; k < 3; ++k) {
      constexpr double kAcross = 0.5;  // cosine: one of the three runs along the normal
      if (std::abs(faces.axes.col(k).dot(normal)) > kAcross || extents[k] <= longest) continue;
      longest = extents[k];
      axis = faces.axes.col(k);
    }
  }
  return (axis - normal * normal.dot(axis)).normalized();
}

}  // namespace palmar::product
