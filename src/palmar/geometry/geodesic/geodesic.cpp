// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/geodesic/geodesic.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/mesh/mesh_topology.h"

// Vectors of four are passed between inlined functions only.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace palmar::geometry {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Relative height below which a triangle is a needle: its plane, and so the wave rule, is noise.
constexpr double kNeedle = 1e-9;

// Distances shrink to a fixed point; a gain below this share of the mean edge isn't pursued.
constexpr double kLeastGain = 1e-9;

// Four numbers side by side. The compiler makes one AVX register of them where a function allows
// that and two SSE registers elsewhere; the results are the same to the bit.
using Double4 = double __attribute__((vector_size(32)));
using Mask4 = long long __attribute__((vector_size(32)));

[[gnu::always_inline]] inline Double4 load(const double* from) {
  using InMemory = double __attribute__((vector_size(32), may_alias));
  return *reinterpret_cast<const InMemory*>(from);
}
[[gnu::always_inline]] inline Double4 at_places(const std::vector<double>& from, const int* place) {
  const double* const x = from.data();
  return Double4{x[place[0]], x[place[1]], x[place[2]], x[place[3]]};
}
[[gnu::always_inline]] inline Double4 root(const Double4& x) {
  return Double4{std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3])};
}

// Wave rule for corner b of the triangle (v, a, b); infinity if it doesn't apply. In the frame with
// v at the origin and a on +x, b is (bx, by) and S = (sx, -sy).
[[gnu::always_inline]] inline Double4 wave(const Double4& dv, const Double4& da, const Double4& va,
                                           const Double4& inverse_va, const Double4& vb,
                                           const Double4& cosine, const Double4& sine) {
  const Double4 sx = 0.5 * ((dv - da) * (dv + da) * inverse_va + va);
  const Double4 sy_squared = (dv - sx) * (dv + sx);
  const Double4 sy = root(sy_squared);
  const Double4 bx = vb * cosine, by = vb * sine;
  const Double4 crossing = sx * by + bx * sy;  // times (sy + by): where S b crosses v a
  // False for a NaN, which the root of a negative number is.
  const Mask4 applies = (crossing >= 0.0) & (crossing <= va * (sy + by));
  const Double4 length = root(vb * vb + dv * dv + 2.0 * (by * sy - bx * sx));
  return applies ? length : Double4{} + kInfinity;
}

}  // namespace

GeodesicSolver::GeodesicSolver(const TriangleMesh& mesh) {
  const auto empty_corners = [](int v) {
    Corners corners;
    for (auto* corner : {&corners.a, &corners.b, &corners.across}) corner->fill(v);
    for (auto* length : {&corners.va, &corners.vb, &corners.diagonal}) length->fill(kInfinity);
    for (auto* inverse : {&corners.inverse_va, &corners.inverse_vb}) inverse->fill(0.0);
    corners.cosine.fill(1.0);
    corners.sine.fill(0.0);
    return corners;
  };
  const MeshTopology topology = build_topology(mesh);
  const auto at = [&](int v) -> const Vec3& { return mesh.vertices[v]; };
  const auto apex = [&](int half_edge) {
    const auto h = static_cast<std::size_t>(MeshTopology::previous(half_edge));
    return mesh.triangles[h / 3][h % 3];
  };

  std::vector<bool> is_needle(mesh.triangles.size(), true);
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (topology.edge_of[3 * t] < 0) continue;
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3 u = at(b) - at(a), v = at(c) - at(a);
    const double longest = std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()});
    is_needle[t] = !(u.cross(v).norm() > kNeedle * longest);
  }

  begin_.assign(1, 0);
  needle_begin_.assign(1, 0);
  double sum = 0.0;
  int edges = 0;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    int place = 8;  // in the last of corners_
    for (const int h : topology.outgoing(v)) {
      const auto t = h / 3;
      const int opposite = MeshTopology::next(h);
      const int a = mesh.triangles[t][opposite % 3];
      const int b = apex(h);
      const Vec3 va = at(a) - at(v), vb = at(b) - at(v);
      sum += va.norm();
      ++edges;
      if (is_needle[t]) {
        needle_.push_back({a, va.norm()});
        needle_.push_back({b, vb.norm()});
        continue;
      }
      if (place == 8) {
        corners_.push_back(empty_corners(v));
        place = 0;
      }
      Corners& corner = corners_.back();
      const auto k = place++;
      corner.a[k] = a;
      corner.b[k] = b;
      corner.va[k] = va.norm();
      corner.vb[k] = vb.norm();
      corner.inverse_va[k] = 1.0 / corner.va[k];
      corner.inverse_vb[k] = 1.0 / corner.vb[k];
      const double scale = corner.va[k] * corner.vb[k];
      corner.cosine[k] = va.dot(vb) / scale;
      corner.sine[k] = va.cross(vb).norm() / scale;
      const int twin = topology.twin[opposite];
      if (twin >= 0 && !is_needle[twin / 3]) {
        corner.across[k] = apex(twin);
        // Frame with a at the origin and b on +x: v above, the apex across below.
        const Vec3 ab = at(b) - at(a), aw = at(corner.across[k]) - at(a);
        const double length = ab.norm();
        const double vx = -va.dot(ab) / length, vy = va.cross(ab).norm() / length;
        const double wx = aw.dot(ab) / length, wy = aw.cross(ab).norm() / length;
        const double x = (vx * wy + wx * vy) / (vy + wy);
        if (x >= 0.0 && x <= length) corner.diagonal[k] = std::hypot(wx - vx, wy + vy);
      }
    }
    begin_.push_back(static_cast<int>(corners_.size()));
    needle_begin_.push_back(static_cast<int>(needle_.size()));
  }
  if (edges > 0 && sum > 0.0) bucket_width_ = 0.5 * sum / edges;
}

struct GeodesicSolver::Front {
  const GeodesicSolver& solver;
  GeodesicWorkspace& w;
  double radius;
  std::span<const unsigned char> allowed;
  double buckets_per_length;
  double gain;
  size_t current = 0;  // bucket being worked off

  void offer(int vertex, double candidate) {
    const double known = w.distance_[vertex];
    if (!(candidate < known - gain)) return;
    if (known == kInfinity) w.touched_.push_back(vertex);
    w.distance_[vertex] = candidate;
    // Beyond the radius a distance is kept, since the wave rule may use it, but not carried on.
    if (candidate > radius) return;
    // A corner may turn out nearer than the vertex that shows so: not into a bucket that is done.
    const auto bucket = std::max(current, static_cast<std::size_t>(candidate * buckets_per_length));
    if (bucket >= w.bucket_.size()) w.bucket_.resize(bucket + 1);
    w.bucket_[bucket].push_back(vertex);
  }
  bool is_allowed(int v) const { return allowed.empty() || allowed[v] != 0; }

  template <bool kIsLimited>
  [[gnu::always_inline]] inline unsigned candidates(const Corners& c, std::size_t first,
                                                    double distance, Double4& to_near,
                                                    Double4& to_far, Double4& to_across) const;
  template <bool kIsLimited>
  [[gnu::always_inline]] inline void expand(const Corners& c, double distance);
  template <bool kIsLimited>
  [[gnu::always_inline]] inline void work_off_inline();
  void work_off_plainly() { allowed.empty() ? work_off_inline<false>() : work_off_inline<true>(); }
#if defined(__x86_64__)
  __attribute__((target("avx2"))) void work_off_avx2() {
    allowed.empty() ? work_off_inline<false>() : work_off_inline<true>();
  }
  void work_off() {
    static const bool has_avx2 = __builtin_cpu_supports("avx2");
    has_avx2 ? work_off_avx2() : work_off_plainly();
  }
#else
  void work_off() { work_off_plainly(); }
#endif
};

// Candidates for the corners of four of a vertex' triangles, those from `first` on, and in the
// result what of them is worth an offer: bits 0-3 `to_near`, 8-11 `to_far`, 16-19 `to_across`; bits
// 24-27 show that a is the near corner. A corner nearer than the vertex itself can't gain from it.
// The wave goes from the vertex and the nearer of the two corners to the farther one; it waits for
// the later of those two, whose distance is then as good as final.
template <bool kIsLimited>
inline unsigned GeodesicSolver::Front::candidates(const Corners& c, std::size_t first,
                                                  double distance, Double4& to_near,
                                                  Double4& to_far, Double4& to_across) const {
  const Double4 dv = Double4{} + distance;
  const Double4 da = at_places(w.distance_, &c.a[first]), db = at_places(w.distance_, &c.b[first]);
  const Double4 dw = at_places(w.distance_, &c.across[first]);
  const Double4 va = load(&c.va[first]), vb = load(&c.vb[first]);
  const Mask4 is_a_near = da <= db;
  const Double4 near = is_a_near ? da : db, far = is_a_near ? db : da;
  const Double4 v_near = is_a_near ? va : vb, v_far = is_a_near ? vb : va;
  const Double4 inverse = is_a_near ? load(&c.inverse_va[first]) : load(&c.inverse_vb[first]);
  const Double4 by_wave =
      wave(dv, near, v_near, inverse, v_far, load(&c.cosine[first]), load(&c.sine[first]));
  const Double4 by_edge = dv + v_far;
  to_near = dv + v_near;
  to_far = ((near <= dv) & (by_wave < by_edge)) ? by_wave : by_edge;
  to_across = dv + load(&c.diagonal[first]);
  Mask4 gains_near = (near > dv) & (to_near < near - gain);
  Mask4 gains_far = (far > dv) & (to_far < far - gain);
  Mask4 gains_across = to_across < dw - gain;
  if constexpr (kIsLimited) {
    Mask4 is_open = {}, is_open_across = {};
    for (std::size_t k = 0; k < 4; ++k) {
      is_open[k] = is_allowed(c.a[first + k]) && is_allowed(c.b[first + k]) ? -1 : 0;
      is_open_across[k] = is_allowed(c.across[first + k]) ? -1 : 0;
    }
    gains_near &= is_open;
    gains_far &= is_open;
    gains_across &= is_open & is_open_across;
  }
  constexpr Mask4 kBit = {1, 2, 4, 8};
  const Mask4 bits = (gains_near & kBit) | (gains_far & (kBit << 8)) |
                     (gains_across & (kBit << 16)) | (is_a_near & (kBit << 24));
  return static_cast<unsigned>((bits[0] | bits[1]) | (bits[2] | bits[3]));
}

// Offers distances to the corners of eight triangles from their common vertex.
template <bool kIsLimited>
inline void GeodesicSolver::Front::expand(const Corners& c, double distance) {
  Double4 to_near[2], to_far[2], to_across[2];
  const unsigned low = candidates<kIsLimited>(c, 0, distance, to_near[0], to_far[0], to_across[0]);
  const unsigned high = candidates<kIsLimited>(c, 4, distance, to_near[1], to_far[1], to_across[1]);
  const unsigned all = low | (high << 4);
  for (unsigned gains = all & 0xFFFFFFU; gains != 0; gains &= gains - 1) {
    const auto bit = static_cast<std::size_t>(__builtin_ctz(gains));
    const std::size_t k = bit % 8;
    const bool is_a_near = ((all >> (24 + k)) & 1U) != 0;
    if (bit < 8) {
      offer(is_a_near ? c.a[k] : c.b[k], to_near[k / 4][k % 4]);
    } else if (bit < 16) {
      offer(is_a_near ? c.b[k] : c.a[k], to_far[k / 4][k % 4]);
    } else {
      offer(c.across[k], to_across[k / 4][k % 4]);
    }
  }
}

template <bool kIsLimited>
inline void GeodesicSolver::Front::work_off_inline() {
  for (current = 0; current < w.bucket_.size(); ++current) {
    // The bucket may grow while it is worked off, and `bucket_` may move.
    for (size_t i = 0; i < w.bucket_[current].size(); ++i) {
      const int v = w.bucket_[current][i];
      if (i + 2 < w.bucket_[current].size()) {
        // Much of the time is waiting for memory.
        const int next = solver.begin_[w.bucket_[current][i + 2]];
        const auto* corners = reinterpret_cast<const char*>(solver.corners_.data() + next);
        for (int line = 0; line < 9; ++line) __builtin_prefetch(corners + 64 * line);
      }
      const double dv = w.distance_[v];
      if (w.expanded_[v] <= dv) continue;
      w.expanded_[v] = dv;
      for (int c = solver.begin_[v]; c < solver.begin_[v + 1]; ++c) {
        expand<kIsLimited>(solver.corners_[c], dv);
      }
      for (int e = solver.needle_begin_[v]; e < solver.needle_begin_[v + 1]; ++e) {
        const GeodesicReach& needle = solver.needle_[e];
        if (is_allowed(needle.vertex)) offer(needle.vertex, dv + needle.distance);
      }
    }
    w.bucket_[current].clear();
  }
}

std::span<const GeodesicReach> GeodesicSolver::reach(int source, double radius,
                                                     GeodesicWorkspace& workspace,
                                                     std::span<const unsigned char> allowed) const {
  const auto count = static_cast<std::size_t>(vertex_count());
  if (source < 0 || source >= vertex_count()) {
    std::ostringstream message;
    message << "geodesic distance: source vertex " << source << "; the mesh has " << count
            << " vertices";
    throw UsageError(message.str());
  }
  if (!allowed.empty() && allowed.size() != count) {
    std::ostringstream message;
    message << "geodesic distance: " << allowed.size() << " vertices are marked allowed or not; "
            << "the mesh has " << count;
    throw UsageError(message.str());
  }
  GeodesicWorkspace& w = workspace;
  if (w.distance_.size() != count) {
    w.distance_.assign(count, kInfinity);
    w.expanded_.assign(count, kInfinity);
  }
  w.touched_.clear();
  w.result_.clear();
  Front front{*this, workspace, radius, allowed, 1.0 / bucket_width_, kLeastGain * bucket_width_};
  if (!front.is_allowed(source) || !(radius >= 0.0)) return w.result_;
  front.offer(source, 0.0);
  front.work_off();
  for (const int v : w.touched_) {
    if (w.distance_[v] <= radius) w.result_.push_back({v, w.distance_[v]});
    w.distance_[v] = kInfinity;
    w.expanded_[v] = kInfinity;
  }
  return w.result_;
}

std::vector<double> GeodesicSolver::distances(int source, double radius) const {
  GeodesicWorkspace workspace;
  const auto reached = reach(source, radius, workspace);
  std::vector<double> result(vertex_count(), kInfinity);
  for (const GeodesicReach& r : reached) result[r.vertex] = r.distance;
  return result;
}

GeodesicTable geodesic_table(const GeodesicSolver& solver, std::span<const int> vertices,
                             double radius, std::span<const unsigned char> allowed) {
  std::vector<int> place_of(solver.vertex_count(), -1);
  for (size_t i = 0; i < vertices.size(); ++i) {
    const int v = vertices[i];
    if (v < 0 || v >= solver.vertex_count() || place_of[v] >= 0) {
      std::ostringstream message;
      message << "geodesic table: vertex " << v
              << " is listed twice or outside the mesh, which has " << solver.vertex_count()
              << " vertices";
      throw UsageError(message.str());
    }
    place_of[v] = static_cast<int>(i);
  }
  struct Entry {
    int place;
    float distance;
  };
  const int count = static_cast<int>(vertices.size());
  std::vector<std::vector<Entry>> later(vertices.size());  // entries (i, j) with j > i
  // Blocks of sources share a workspace; rows are written apart, so blocks don't show in the
  // result.
  constexpr int kBlock = 64;
  parallel_for((count + kBlock - 1) / kBlock, [&](int block) {
    GeodesicWorkspace workspace;
    for (int i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i) {
      const auto reached = solver.reach(vertices[i], radius, workspace, allowed);
      const auto place = [&](const GeodesicReach& r) { return place_of[r.vertex]; };
      auto& row = later[i];
      row.reserve(std::count_if(reached.begin(), reached.end(),
                                [&](const auto& r) { return place(r) > i; }));
      for (const GeodesicReach& r : reached) {
        if (place(r) > i) row.push_back({place(r), static_cast<float>(r.distance)});
      }
    }
  });

  GeodesicTable table;
  table.begin.assign(vertices.size() + 1, 0);
  for (size_t i = 0; i < later.size(); ++i) {
    table.begin[i + 1] += 1 + static_cast<int>(later[i].size());
    for (const Entry& entry : later[i]) ++table.begin[entry.place + 1];
  }
  std::partial_sum(table.begin.begin(), table.begin.end(), table.begin.begin());
  table.place.resize(table.begin.back());
  table.distance.resize(table.place.size());
  // Ascending rows without sorting: first what stands before the diagonal, from rows in ascending
  // order, then from that what stands behind it.
  std::vector<int> next(table.begin.begin(), table.begin.end() - 1);
  const auto put = [&](int row, int place, float distance) {
    const auto k = next[row]++;
    table.place[k] = place;
    table.distance[k] = distance;
  };
  for (int i = 0; i < count; ++i) {
    for (const Entry& entry : later[i]) put(entry.place, i, entry.distance);
    std::vector<Entry>().swap(later[i]);
  }
  for (int j = 0; j < count; ++j) {
    const int end = next[j];
    put(j, j, 0.0F);
    for (int k = table.begin[j]; k < end; ++k) {
      put(table.place[k], j, table.distance[k]);
    }
  }
  return table;
}

}  // namespace palmar::geometry
