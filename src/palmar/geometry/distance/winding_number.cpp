// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/distance/winding_number.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "palmar/geometry/mesh/triangle_partition.h"

namespace palmar::geometry {
namespace {

using Float4 = Eigen::Array<float, 4, 1>;

constexpr int kWidth = TrianglePartition::kWidth;
// A group is expanded if it is farther than this many of its radii. Keeps the error below 0.02
// (worst case over the meshes of mesh_distance_test.cpp, whose triangles are coarse).
constexpr float kFarFactor = 3.3f;
// The same for whole_at(), where an error of 0.2 does no harm.
constexpr float kCoarseFarFactor = 1.4f;

/// Moments of a group of triangles about its area-weighted centre p: N = sum a n (dipole) and
/// M = sum a n (c - p)^T, of which only the symmetric part acts.
struct Moments {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;  ///< of the ball about the centre that holds all corners, mm
  Vec3 dipole = Vec3::Zero();
  Eigen::Matrix3d quadratic = Eigen::Matrix3d::Zero();
};

/// Four groups side by side: each is one triangle or another node.
struct alignas(16) MomentsNode {
  Float4 x, y, z, radius2;          ///< centre, squared radius; negative if empty
  Float4 nx, ny, nz;                ///< dipole / 4 pi
  Float4 trace;                     ///< of M / 4 pi
  Float4 xx, yy, zz, xy, xz, yz;    ///< symmetric M / 4 pi; xy, xz, yz doubled
  std::array<int, kWidth> child{};  ///< node or triangle
  std::array<bool, kWidth> is_node{};
};

/// Running product of the complex numbers whose arguments are the half solid angles: one atan2 at
/// the end instead of one per triangle.
class AngleSum {
 public:
  void add(double real, double imaginary) {
    const double re = re_ * real - im_ * imaginary;
    const double im = re_ * imaginary + im_ * real;
    // Two angles of [0, pi] whose sum passes pi, or two of (-pi, 0) whose sum passes -pi.
    if (im_ >= 0.0 && imaginary >= 0.0 && im < 0.0) ++turns_;
    if (im_ < 0.0 && imaginary < 0.0 && im >= 0.0) --turns_;
    const double scale = std::abs(re) + std::abs(im);
    if (scale > 0.0) {
      re_ = re / scale;
      im_ = im / scale;
    }
  }
  double value() const { return std::atan2(im_, re_) + 2.0 * std::numbers::pi * turns_; }

 private:
  double re_ = 1.0;
  double im_ = 0.0;
  int turns_ = 0;
};

struct CornerPoints {
  Vec3 a, b, c;
};

/// Adds half the solid angle of the triangle; tan(Omega / 2) = imaginary / real.
void add_solid_angle(const CornerPoints& t, const Vec3& q, AngleSum& sum) {
  const Vec3 a = t.a - q, b = t.b - q, c = t.c - q;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double imaginary = a.dot(b.cross(c));
  const double real = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  // In the plane of the triangle the solid angle jumps; count such a triangle as not there.
  if (imaginary != 0.0) sum.add(real, imaginary);
}

Moments moments_of(std::span<const int> triangles, const std::vector<CornerPoints>& corners) {
  Moments m;
  double area = 0.0;
  for (const int t : triangles) {
    const CornerPoints& k = corners[t];
    const double a = 0.5 * (k.b - k.a).cross(k.c - k.a).norm();
    m.centre += a * (k.a + k.b + k.c) / 3.0;
    area += a;
  }
  if (area > 0.0) {
    m.centre /= area;
  } else {
    m.centre = corners[triangles.front()].a;
  }
  double radius2 = 0.0;
  for (const int t : triangles) {
    const CornerPoints& k = corners[t];
    const Vec3 an = 0.5 * (k.b - k.a).cross(k.c - k.a);
    m.dipole += an;
    m.quadratic += an * ((k.a + k.b + k.c) / 3.0 - m.centre).transpose();
    for (const Vec3& x : {k.a, k.b, k.c}) {
      radius2 = std::max(radius2, (x - m.centre).squaredNorm());
    }
  }
  m.radius = std::sqrt(radius2);
  return m;
}

}  // namespace

struct WindingNumber::Impl {
  Vec3 origin = Vec3::Zero();
  std::vector<CornerPoints> corners;  ///< relative to origin, in tree order
  std::vector<MomentsNode> nodes;

  void fill(const TrianglePartition& partition, int node);
  double sum(const Vec3& point, float far_factor) const;
};

void WindingNumber::Impl::fill(const TrianglePartition& partition, int node) {
  const TrianglePartition::Node& parts = partition.nodes[node];
  constexpr double kShare = 0.25 / std::numbers::pi;
  for (int k = 0; k < kWidth; ++k) {
    const std::span<const int> triangles =
        std::span(partition.order).subspan(parts.begin[k], parts.size(k));
    Moments m;
    if (!triangles.empty()) m = moments_of(triangles, corners);
    MomentsNode& n = nodes[node];
    n.x[k] = static_cast<float>(m.centre.x());
    n.y[k] = static_cast<float>(m.centre.y());
    n.z[k] = static_cast<float>(m.centre.z());
    // An empty slot has no moments and counts as far from everywhere.
    n.radius2[k] = triangles.empty() ? -1.0f : static_cast<float>(m.radius * m.radius);
    n.nx[k] = static_cast<float>(kShare * m.dipole.x());
    n.ny[k] = static_cast<float>(kShare * m.dipole.y());
    n.nz[k] = static_cast<float>(kShare * m.dipole.z());
    const Eigen::Matrix3d q = kShare * m.quadratic;
    n.trace[k] = static_cast<float>(q.trace());
    n.xx[k] = static_cast<float>(q(0, 0));
    n.yy[k] = static_cast<float>(q(1, 1));
    n.zz[k] = static_cast<float>(q(2, 2));
    n.xy[k] = static_cast<float>(q(0, 1) + q(1, 0));
    n.xz[k] = static_cast<float>(q(0, 2) + q(2, 0));
    n.yz[k] = static_cast<float>(q(1, 2) + q(2, 1));
    n.is_node[k] = parts.child[k] >= 0;
    n.child[k] = parts.child[k] >= 0 || triangles.empty() ? parts.child[k] : triangles.front();
  }
}

double WindingNumber::Impl::sum(const Vec3& point, float far_factor) const {
  if (nodes.empty()) return 0.0;
  const float far2 = far_factor * far_factor;
  const Vec3 q = point - origin;
  const float qx = static_cast<float>(q.x());
  const float qy = static_cast<float>(q.y());
  const float qz = static_cast<float>(q.z());
  Float4 far_sum = Float4::Zero();
  AngleSum near_sum;
  // Each level leaves at most three siblings; depth is log4 of an int.
  std::array<int, 3 * 16 + 1> stack;
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const MomentsNode& n = nodes[stack[--size]];
    const Float4 x = n.x - qx, y = n.y - qy, z = n.z - qz;
    const Float4 r2 = x * x + y * y + z * z;
    // An empty place counts as far; seen from its own centre 1 / r^3 must stay finite, or 0 times
    // infinity spoils the sum.
    const Float4 inverse2 = 1.0f / r2.max(1e-20f);
    const Float4 inverse3 = inverse2 * inverse2.sqrt();
    const Float4 dipole = n.nx * x + n.ny * y + n.nz * z;
    const Float4 quadratic =
        n.xx * x * x + n.yy * y * y + n.zz * z * z + n.xy * x * y + n.xz * x * z + n.yz * y * z;
    const Float4 value = inverse3 * (dipole + n.trace - 3.0f * quadratic * inverse2);
    const auto is_far = r2 > far2 * n.radius2;
    far_sum += is_far.select(value, Float4::Zero());
    for (int k = 0; k < kWidth; ++k) {
      if (r2[k] > far2 * n.radius2[k]) continue;
      if (n.is_node[k]) {
        stack[size++] = n.child[k];
      } else {
        add_solid_angle(corners[n.child[k]], q, near_sum);
      }
    }
  }
  return static_cast<double>(far_sum.sum()) + near_sum.value() / (2.0 * std::numbers::pi);
}

WindingNumber::WindingNumber(const TriangleMesh& mesh) {
  auto impl = std::make_unique<Impl>();
  Box3 box;
  for (const Triangle& t : mesh.triangles) {
    for (const int v : t) box.extend(mesh.vertices[v]);
  }
  if (!box.isEmpty()) impl->origin = box.center();
  impl->corners.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    impl->corners.push_back({mesh.vertices[t[0]] - impl->origin, mesh.vertices[t[1]] - impl->origin,
                             mesh.vertices[t[2]] - impl->origin});
  }
  const TrianglePartition partition = partition_triangles(mesh, 1);
  impl->nodes.resize(partition.nodes.size());
  for (std::size_t n = 0; n < partition.nodes.size(); ++n) {
    impl->fill(partition, static_cast<int>(n));
  }
  impl_ = std::move(impl);
}
WindingNumber::~WindingNumber() = default;
WindingNumber::WindingNumber(WindingNumber&&) noexcept = default;
WindingNumber& WindingNumber::operator=(WindingNumber&&) noexcept = default;

double WindingNumber::at(const Vec3& point) const { return impl_->sum(point, kFarFactor); }

int WindingNumber::whole_at(const Vec3& point) const {
  double w = impl_->sum(point, kCoarseFarFactor);
  if (std::abs(w - std::round(w)) > 0.2) w = at(point);
  return static_cast<int>(std::lround(w));
}

double exact_winding_number(const TriangleMesh& mesh, const Vec3& point) {
  AngleSum sum;
  for (const Triangle& t : mesh.triangles) {
    add_solid_angle({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}, point, sum);
  }
  return sum.value() / (2.0 * std::numbers::pi);
}

}  // namespace palmar::geometry
