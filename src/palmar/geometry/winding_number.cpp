// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/winding_number.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

namespace palmar {
namespace {

using Float4 = Eigen::Array<float, 4, 1>;

constexpr int kWidth = 4;
// A group is expanded if it is farther than this many of its radii. Keeps the error below 0.01
// (worst case over the meshes of winding_number_test.cpp).
constexpr float kFarFactor = 2.2f;

/// Moments of a group of triangles about its area-weighted centre p: N = sum a n (dipole) and
/// M = sum a n (c - p)^T, of which only the symmetric part acts.
struct Moments {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;  ///< of the ball about the centre that holds all corners, mm
  Vec3 dipole = Vec3::Zero();
  Eigen::Matrix3d quadratic = Eigen::Matrix3d::Zero();
};

/// Four groups side by side: each is one triangle (child >= 0 names it) or another node.
struct alignas(16) Node {
  Float4 x, y, z, far2;             ///< centre; squared distance from which it counts as far
  Float4 nx, ny, nz;                ///< dipole / 4 pi
  Float4 trace;                     ///< of M / 4 pi
  Float4 xx, yy, zz, xy, xz, yz;    ///< symmetric M / 4 pi; xy, xz, yz doubled
  std::array<int, kWidth> child{};  ///< node if is_node
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

struct Corners {
  Vec3 a, b, c;
};

/// Adds half the solid angle of the triangle; tan(Omega / 2) = imaginary / real.
void add_solid_angle(const Corners& t, const Vec3& q, AngleSum& sum) {
  const Vec3 a = t.a - q, b = t.b - q, c = t.c - q;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double imaginary = a.dot(b.cross(c));
  const double real = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  // In the plane of the triangle the solid angle jumps; count such a triangle as not there.
  if (imaginary != 0.0) sum.add(real, imaginary);
}

Moments moments_of(std::span<const int> triangles, const std::vector<Corners>& corners) {
  Moments m;
  double area = 0.0;
  for (const int t : triangles) {
    const Corners& k = corners[t];
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
    const Corners& k = corners[t];
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

/// Splits the list at the median centroid of its longest side; returns the size of the first part.
std::size_t split(std::span<int> triangles, const std::vector<Vec3>& centroids) {
  Box3 box;
  for (const int t : triangles) box.extend(centroids[t]);
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::size_t half = triangles.size() / 2;
  std::nth_element(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(half),
                   triangles.end(), [&](int s, int t) {
                     const double u = centroids[s][axis], v = centroids[t][axis];
                     return u < v || (u == v && s < t);
                   });
  return half;
}

}  // namespace

struct WindingNumber::Impl {
  Vec3 origin = Vec3::Zero();
  std::vector<Corners> corners;  ///< relative to origin, in tree order
  std::vector<Node> nodes;

  void fill(int node, std::span<int> triangles, const std::vector<Vec3>& centroids) {
    const std::size_t half = triangles.size() > 1 ? split(triangles, centroids) : 1;
    std::array<std::span<int>, kWidth> parts;
    const auto divide = [&](std::span<int> list, int slot) {
      const std::size_t first = list.size() > 1 ? split(list, centroids) : list.size();
      parts[slot] = list.first(first);
      parts[slot + 1] = list.subspan(first);
    };
    divide(triangles.first(half), 0);
    divide(triangles.subspan(half), 2);

    constexpr double kShare = 0.25 / std::numbers::pi;
    for (int k = 0; k < kWidth; ++k) {
      Moments m;
      if (!parts[k].empty()) m = moments_of(parts[k], corners);
      Node& n = nodes[node];
      n.x[k] = static_cast<float>(m.centre.x());
      n.y[k] = static_cast<float>(m.centre.y());
      n.z[k] = static_cast<float>(m.centre.z());
      const float far = kFarFactor * static_cast<float>(m.radius);
      // An empty slot has no moments and counts as far from everywhere.
      n.far2[k] = parts[k].empty() ? -1.0f : far * far;
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
      n.is_node[k] = parts[k].size() > 1;
      if (parts[k].size() == 1) n.child[k] = parts[k].front();
      if (parts[k].size() > 1) {
        const int child = static_cast<int>(nodes.size());
        nodes[node].child[k] = child;
        nodes.emplace_back();
        fill(child, parts[k], centroids);
      }
    }
  }
};

WindingNumber::WindingNumber(const TriangleMesh& mesh) {
  auto impl = std::make_unique<Impl>();
  Box3 box;
  for (const Triangle& t : mesh.triangles) {
    for (const int v : t) box.extend(mesh.vertices[v]);
  }
  if (!box.isEmpty()) impl->origin = box.center();
  std::vector<Vec3> centroids;
  impl->corners.reserve(mesh.triangles.size());
  centroids.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    const Corners k{mesh.vertices[t[0]] - impl->origin, mesh.vertices[t[1]] - impl->origin,
                    mesh.vertices[t[2]] - impl->origin};
    centroids.push_back((k.a + k.b + k.c) / 3.0);
    impl->corners.push_back(k);
  }
  if (!mesh.triangles.empty()) {
    std::vector<int> order(mesh.triangles.size());
    std::iota(order.begin(), order.end(), 0);
    impl->nodes.reserve(mesh.triangles.size());
    impl->nodes.emplace_back();
    impl->fill(0, order, centroids);
  }
  impl_ = std::move(impl);
}
WindingNumber::~WindingNumber() = default;
WindingNumber::WindingNumber(WindingNumber&&) noexcept = default;
WindingNumber& WindingNumber::operator=(WindingNumber&&) noexcept = default;

double WindingNumber::at(const Vec3& point) const {
  if (impl_->nodes.empty()) return 0.0;
  const Vec3 q = point - impl_->origin;
  const float qx = static_cast<float>(q.x());
  const float qy = static_cast<float>(q.y());
  const float qz = static_cast<float>(q.z());
  Float4 far_sum = Float4::Zero();
  AngleSum near_sum;
  // A node has at most four children and the depth is log4 of an int: 3 * 16 + 1 entries.
  std::array<int, 64> stack;
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& n = impl_->nodes[stack[--size]];
    const Float4 x = n.x - qx, y = n.y - qy, z = n.z - qz;
    const Float4 r2 = x * x + y * y + z * z;
    const Float4 inverse2 = 1.0f / r2.max(1e-30f);
    const Float4 inverse3 = inverse2 * inverse2.sqrt();
    const Float4 dipole = n.nx * x + n.ny * y + n.nz * z;
    const Float4 quadratic =
        n.xx * x * x + n.yy * y * y + n.zz * z * z + n.xy * x * y + n.xz * x * z + n.yz * y * z;
    const Float4 value = inverse3 * (dipole + n.trace - 3.0f * quadratic * inverse2);
    for (int k = 0; k < kWidth; ++k) {
      if (r2[k] > n.far2[k]) {
        far_sum[k] += value[k];
      } else if (n.is_node[k]) {
        stack[size++] = n.child[k];
      } else {
        add_solid_angle(impl_->corners[n.child[k]], q, near_sum);
      }
    }
  }
  return static_cast<double>(far_sum.sum()) + near_sum.value() / (2.0 * std::numbers::pi);
}

double exact_winding_number(const TriangleMesh& mesh, const Vec3& point) {
  AngleSum sum;
  for (const Triangle& t : mesh.triangles) {
    add_solid_angle({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}, point, sum);
  }
  return sum.value() / (2.0 * std::numbers::pi);
}

}  // namespace palmar
