// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/distance/mesh_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/distance/winding_number.h"
#include "palmar/geometry/smooth_step.h"

namespace palmar::geometry {
namespace {

constexpr double kOnSurface = 1e-7;  // mm; below, (q - x) / d is rounding
constexpr double kEdge = 0.707;      // cosine of the angle from which on triangles meet at an edge
constexpr int kChunk = 1024;         // points that one thread takes at a time

/// For every vertex the smallest vertex at exactly the same place.
std::vector<int> same_place(const std::vector<Vec3>& vertices) {
  std::vector<int> order(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int v) {
    return std::tuple(vertices[v].x(), vertices[v].y(), vertices[v].z());
  };
  std::sort(order.begin(), order.end(),
            [&](int u, int v) { return std::tuple(key(u), u) < std::tuple(key(v), v); });
  std::vector<int> first(vertices.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool repeats = i > 0 && key(order[i]) == key(order[i - 1]);
    first[order[i]] = repeats ? first[order[i - 1]] : order[i];
  }
  return first;
}

/// Side k of a triangle runs from corner k to corner k + 1.
struct Side {
  int low, high;  ///< corners
  int triangle, side;
  bool is_forward;  ///< runs from low to high
};

/// 1 for facets of one smooth surface, 0 across an edge.
double belongs(double cosine) { return smooth_step((cosine - kEdge) / (1.0 - kEdge)); }

struct Surface {
  std::vector<Triangle> triangles;  ///< corners with same_place() applied
  std::vector<Vec3> face_normal;
  std::vector<Vec3> corner_normal;            ///< angle-weighted, per vertex; unit or zero
  std::vector<std::array<Vec3, 3>> smooth;    ///< per triangle, at its corners; unit
  std::vector<std::array<int, 3>> neighbour;  ///< across side k; -1 if none or several
  bool is_closed = true;
};

/// The normals at the corners of each triangle of the surface that facets stand for.
std::vector<std::array<Vec3, 3>> smooth_normals(const Surface& s,
                                                const std::vector<Vec3>& vertices) {
  std::vector<int> first(vertices.size() + 1, 0);  // of those at a vertex, in `at`
  for (const Triangle& t : s.triangles) {
    for (const int v : t) ++first[v + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  struct Corner {
    int triangle;
    double angle;
  };
  std::vector<Corner> at(3 * s.triangles.size());
  std::vector<int> next(first.begin(), first.end() - 1);
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Triangle& corners = s.triangles[t];
      const Vec3& x = vertices[corners[k]];
      const Vec3 u = vertices[corners[(k + 1) % 3]] - x, v = vertices[corners[(k + 2) % 3]] - x;
      at[next[corners[k]]++] = {static_cast<int>(t), std::atan2(u.cross(v).norm(), u.dot(v))};
    }
  }
  std::vector<std::array<Vec3, 3>> smooth(s.triangles.size());
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    const Vec3& own = s.face_normal[t];
    for (int k = 0; k < 3; ++k) {
      const int v = s.triangles[t][k];
      Vec3 sum = Vec3::Zero();
      for (int i = first[v]; i < first[v + 1]; ++i) {
        const Vec3& other = s.face_normal[at[i].triangle];
        sum += at[i].angle * belongs(own.dot(other)) * other;
      }
      smooth[t][k] = sum.norm() > 0.0 ? sum.normalized() : own;
    }
  }
  return smooth;
}

Surface surface_of(const TriangleMesh& mesh) {
  Surface s;
  const std::vector<int> first = same_place(mesh.vertices);
  s.corner_normal.assign(mesh.vertices.size(), Vec3::Zero());
  s.neighbour.assign(mesh.triangles.size(), {-1, -1, -1});
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    Triangle corners = mesh.triangles[t];
    for (int& v : corners) v = first[v];
    s.triangles.push_back(corners);
    const std::array<Vec3, 3> x = {mesh.vertices[corners[0]], mesh.vertices[corners[1]],
                                   mesh.vertices[corners[2]]};
    const Vec3 normal = (x[1] - x[0]).cross(x[2] - x[0]).stableNormalized();
    s.face_normal.push_back(normal);
    for (int k = 0; k < 3; ++k) {
      const int from = corners[k], to = corners[(k + 1) % 3];
      if (from != to) sides.push_back({std::min(from, to), std::max(from, to), t, k, from < to});
      const Vec3 u = x[(k + 1) % 3] - x[k], v = x[(k + 2) % 3] - x[k];
      s.corner_normal[from] += std::atan2(u.cross(v).norm(), u.dot(v)) * normal;
    }
  }
  for (Vec3& n : s.corner_normal) n.stableNormalize();
  s.smooth = smooth_normals(s, mesh.vertices);

  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tuple(a.low, a.high, a.triangle, a.side) <
           std::tuple(b.low, b.high, b.triangle, b.side);
  });
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i;
    int balance = 0;
    for (; end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high;
         ++end) {
      balance += sides[end].is_forward ? 1 : -1;
    }
    if (balance != 0) s.is_closed = false;
    if (end == i + 2) {
      s.neighbour[sides[i].triangle][sides[i].side] = sides[i + 1].triangle;
      s.neighbour[sides[i + 1].triangle][sides[i + 1].side] = sides[i].triangle;
    }
    i = end;
  }
  return s;
}

/// Pseudo-normal of the feature (face, edge, corner) that the nearest point lies on.
Vec3 pseudo_normal(const Surface& s, const ClosestPoint& nearest) {
  const Triangle& corners = s.triangles[nearest.triangle];
  std::array<int, 3> used{};
  int count = 0;
  for (int k = 0; k < 3; ++k) {
    if (nearest.weights[k] > 0.0) used[count++] = k;
  }
  Vec3 normal = s.face_normal[nearest.triangle];
  if (count == 1 && !s.corner_normal[corners[used[0]]].isZero()) {
    normal = s.corner_normal[corners[used[0]]];
  } else if (count == 2) {
    const int side = used[1] == used[0] + 1 ? used[0] : 2;
    const int other = s.neighbour[nearest.triangle][side];
    const Vec3 sum = other < 0 ? normal : Vec3(normal + s.face_normal[other]);
    if (sum.norm() > 1e-6) normal = sum.normalized();
  }
  return normal.isZero() ? Vec3::UnitZ() : normal;
}

/// Order in which neighbours in space follow each other (Morton code of 10 bits per axis).
std::vector<int> spatial_order(std::span<const Vec3> points) {
  Box3 box;
  for (const Vec3& p : points) {
    if (p.allFinite()) box.extend(p);
  }
  std::vector<std::pair<std::uint32_t, int>> keyed(points.size());
  const Vec3 scale = box.isEmpty()
                         ? Vec3::Zero()
                         : Vec3::Constant(1023.0 / std::max(1e-9, box.sizes().maxCoeff()));
  const auto spread = [](double value) {
    auto bits = static_cast<std::uint32_t>(value);
    bits = (bits | (bits << 16)) & 0x030000FFu;
    bits = (bits | (bits << 8)) & 0x0300F00Fu;
    bits = (bits | (bits << 4)) & 0x030C30C3u;
    return (bits | (bits << 2)) & 0x09249249u;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::uint32_t code = 0;
    if (points[i].allFinite()) {
      const Vec3 u = (points[i] - box.min()).cwiseProduct(scale);
      code = spread(u.x()) | (spread(u.y()) << 1) | (spread(u.z()) << 2);
    }
    keyed[i] = {code, static_cast<int>(i)};
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<int> order;
  order.reserve(points.size());
  for (const auto& entry : keyed) order.push_back(entry.second);
  return order;
}

/// Points whose side is known. The open ball of radius |d| about a point holds nothing of the
/// surface; two points whose balls meet lie on the same side, as nothing is crossed on the way. So
/// most winding numbers are saved. Only for closed meshes: elsewhere the side also changes in the
/// holes.
class KnownSides {
 public:
  std::optional<bool> find(const Vec3& point, double distance) const {
    for (int age = 1; age <= count_; ++age) {  // the latest is the most likely
      const Entry& known = known_[(next_ + kSize - age) % kSize];
      const double reach = (distance + known.distance) * (1.0 - 1e-6) - kOnSurface;
      if (reach > 0.0 && (known.point - point).squaredNorm() < reach * reach) {
        return known.is_inside;
      }
    }
    return {};
  }
  void add(const Vec3& point, double distance, bool is_inside) {
    known_[next_] = {point, distance, is_inside};
    next_ = (next_ + 1) % kSize;
    count_ = std::min(count_ + 1, kSize);
  }

 private:
  struct Entry {
    Vec3 point;
    double distance;
    bool is_inside;
  };
  static constexpr int kSize = 32;
  std::array<Entry, kSize> known_;
  int count_ = 0;
  int next_ = 0;
};

}  // namespace

struct MeshDistance::Impl {
  ClosestPointQuery closest;
  WindingNumber winding;
  Surface surface;
  std::vector<Vec3> vertices;
  Box3 box;

  explicit Impl(const TriangleMesh& mesh)
      : closest(mesh), winding(mesh), surface(surface_of(mesh)), vertices(mesh.vertices) {
    for (const Triangle& t : mesh.triangles) {
      for (const int v : t) box.extend(mesh.vertices[v]);
    }
  }

  /// The sample of one point. `hint`: a triangle believed near. `known`: sides of other points.
  DistanceSample sample(const Vec3& q, double range, std::optional<int> hint,
                        KnownSides& known) const;
};

DistanceSample MeshDistance::Impl::sample(const Vec3& q, double range, std::optional<int> hint,
                                          KnownSides& known) const {
  DistanceSample s = {range, q, Vec3::UnitZ(), -1};
  if (box.isEmpty() || box.squaredExteriorDistance(q) > range * range) return s;
  const std::optional<ClosestPoint> nearest = closest.closest(q, range, hint);
  const double distance = nearest ? nearest->distance : range;
  bool is_inside = false;
  if (box.contains(q) && distance > kOnSurface) {
    if (!surface.is_closed) {
      is_inside = winding.at(q) > 0.5;
    } else if (const std::optional<bool> side = known.find(q, distance)) {
      is_inside = *side;
    } else {
      is_inside = winding.whole_at(q) > 0;
    }
    if (surface.is_closed) known.add(q, distance, is_inside);
  }
  const double sign = is_inside ? -1.0 : 1.0;
  s.distance = sign * distance;
  if (!nearest) return s;
  s.closest = nearest->point;
  s.triangle = nearest->triangle;
  s.normal = distance > kOnSurface ? Vec3(sign * (q - s.closest) / distance)
                                   : pseudo_normal(surface, *nearest);
  return s;
}

Vec3 MeshDistance::smooth_normal(const DistanceSample& sample) const {
  if (sample.triangle < 0) return sample.normal;
  const double share = belongs(impl_->surface.face_normal[sample.triangle].dot(sample.normal));
  if (share == 0.0) return sample.normal;
  const Triangle& t = impl_->surface.triangles[sample.triangle];
  const Vec3 u = impl_->vertices[t[1]] - impl_->vertices[t[0]];
  const Vec3 v = impl_->vertices[t[2]] - impl_->vertices[t[0]];
  const Vec3 p = sample.closest - impl_->vertices[t[0]];
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), det = uu * vv - uv * uv;
  if (!(det > 0.0)) return sample.normal;
  const double b = std::clamp((vv * p.dot(u) - uv * p.dot(v)) / det, 0.0, 1.0);
  const double c = std::clamp((uu * p.dot(v) - uv * p.dot(u)) / det, 0.0, 1.0 - b);
  const std::array<Vec3, 3>& corner = impl_->surface.smooth[sample.triangle];
  const Vec3 smooth = ((1.0 - b - c) * corner[0] + b * corner[1] + c * corner[2]).normalized();
  return (share * smooth + (1.0 - share) * sample.normal).normalized();
}

MeshDistance::MeshDistance(const TriangleMesh& mesh) : impl_(std::make_unique<const Impl>(mesh)) {}
MeshDistance::~MeshDistance() = default;

Box3 MeshDistance::bounding_box() const { return impl_->box; }
bool MeshDistance::is_closed() const { return impl_->surface.is_closed; }
double MeshDistance::winding_number(const Vec3& point) const { return impl_->winding.at(point); }

namespace {

void check_request(std::size_t points, std::size_t samples, double range) {
  if (points != samples) {
    throw UsageError("distance to a mesh: " + std::to_string(points) + " points but room for " +
                     std::to_string(samples) + " samples; the numbers must be equal");
  }
  if (!(range >= 0.0)) {
    throw UsageError("distance to a mesh: range is " + std::to_string(range) +
                     " mm; 0 or more is required");
  }
}

/// body(begin, end) for chunks of [0, count), side by side.
template <typename Body>
void for_chunks(int count, const Body& body) {
  parallel_for((count + kChunk - 1) / kChunk,
               [&](int c) { body(c * kChunk, std::min(count, (c + 1) * kChunk)); });
}

}  // namespace

void MeshDistance::sample(std::span<const Vec3> points, double range,
                          std::span<DistanceSample> samples) const {
  check_request(points.size(), samples.size(), range);
  const std::vector<int> order = spatial_order(points);
  for_chunks(static_cast<int>(order.size()), [&](int begin, int end) {
    std::optional<int> hint;
    KnownSides known;
    for (int k = begin; k < end; ++k) {
      DistanceSample& s = samples[order[k]];
      s = impl_->sample(points[order[k]], range, hint, known);
      if (s.triangle >= 0) hint = s.triangle;
    }
  });
}

void MeshDistance::resample(std::span<const Vec3> points, double range,
                            std::span<DistanceSample> samples) const {
  check_request(points.size(), samples.size(), range);
  const int triangles = static_cast<int>(impl_->surface.triangles.size());
  for_chunks(static_cast<int>(points.size()), [&](int begin, int end) {
    KnownSides known;
    for (int k = begin; k < end; ++k) {
      const DistanceSample before = samples[k];
      const bool is_usable = before.triangle >= 0 && before.triangle < triangles;
      // Where the point was before.
      if (is_usable && impl_->surface.is_closed) {
        known.add(before.closest + before.distance * before.normal, std::abs(before.distance),
                  before.distance < 0.0);
      }
      samples[k] = impl_->sample(
          points[k], range, is_usable ? std::optional<int>(before.triangle) : std::nullopt, known);
    }
  });
}

}  // namespace palmar::geometry
