// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/geodesic.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/mesh_topology.h"

namespace palmar {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Relative height below which a triangle is a needle: its plane, and so the wave rule, is noise.
constexpr double kNeedle = 1e-9;

// Distances shrink to a fixed point; a gain below this share of the mean edge isn't pursued.
constexpr double kLeastGain = 1e-9;

// Wave rule for corner b of the triangle (v, a, b); infinity if it doesn't apply. In the frame with
// v at the origin and a on +x, b is (bx, by) and S = (sx, -sy).
inline double wave(double dv, double da, double va, double vb, double cosine, double sine) {
  const double sx = 0.5 * ((dv - da) * (dv + da) / va + va);
  const double sy_squared = (dv - sx) * (dv + sx);
  if (!(sy_squared >= 0.0)) return kInfinity;
  const double sy = std::sqrt(sy_squared);
  const double bx = vb * cosine, by = vb * sine;
  const double crossing = sx * by + bx * sy;  // times (sy + by): where S b crosses v a
  if (crossing < 0.0 || crossing > va * (sy + by)) return kInfinity;
  return std::sqrt(vb * vb + dv * dv + 2.0 * (by * sy - bx * sx));
}

}  // namespace

GeodesicSolver::GeodesicSolver(const TriangleMesh& mesh) {
  const MeshTopology topology = build_topology(mesh);
  const auto at = [&](int v) -> const Vec3& { return mesh.vertices[static_cast<size_t>(v)]; };
  const auto apex = [&](int half_edge) {
    const auto h = static_cast<size_t>(MeshTopology::previous(half_edge));
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
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    for (const int h : topology.outgoing(v)) {
      const auto t = static_cast<size_t>(h / 3);
      const int opposite = MeshTopology::next(h);
      Corner corner;
      corner.a = mesh.triangles[t][static_cast<size_t>(opposite % 3)];
      corner.b = apex(h);
      const Vec3 va = at(corner.a) - at(v), vb = at(corner.b) - at(v);
      corner.va = va.norm();
      corner.vb = vb.norm();
      sum += corner.va;
      if (is_needle[t]) {
        needle_.push_back({corner.a, corner.va});
        needle_.push_back({corner.b, corner.vb});
        continue;
      }
      const double scale = corner.va * corner.vb;
      corner.cosine = va.dot(vb) / scale;
      corner.sine = va.cross(vb).norm() / scale;
      const int twin = topology.twin[static_cast<size_t>(opposite)];
      if (twin >= 0 && !is_needle[static_cast<size_t>(twin / 3)]) {
        corner.across = apex(twin);
        // Frame with a at the origin and b on +x: v above, the apex across below.
        const Vec3 ab = at(corner.b) - at(corner.a), aw = at(corner.across) - at(corner.a);
        const double length = ab.norm();
        const double vx = -va.dot(ab) / length, vy = va.cross(ab).norm() / length;
        const double wx = aw.dot(ab) / length, wy = aw.cross(ab).norm() / length;
        const double x = (vx * wy + wx * vy) / (vy + wy);
        if (x >= 0.0 && x <= length) corner.diagonal = std::hypot(wx - vx, wy + vy);
      }
      corner_.push_back(corner);
    }
    begin_.push_back(static_cast<int>(corner_.size()));
    needle_begin_.push_back(static_cast<int>(needle_.size()));
  }
  const size_t edges = corner_.size() + needle_.size() / 2;
  if (edges > 0 && sum > 0.0) bucket_width_ = 0.5 * sum / static_cast<double>(edges);
}

struct GeodesicSolver::Front {
  GeodesicWorkspace& w;
  double radius;
  double buckets_per_length;
  double gain;

  void offer(int vertex, double candidate) {
    offer(vertex, w.distance_[static_cast<size_t>(vertex)], candidate);
  }
  void offer(int vertex, double known, double candidate) {
    if (!(candidate < known - gain)) return;
    if (known == kInfinity) w.touched_.push_back(vertex);
    w.distance_[static_cast<size_t>(vertex)] = candidate;
    // Beyond the radius a distance is kept, since the wave rule may use it, but not carried on.
    if (candidate > radius) return;
    const auto bucket = static_cast<size_t>(candidate * buckets_per_length);
    if (bucket >= w.bucket_.size()) w.bucket_.resize(bucket + 1);
    w.bucket_[bucket].push_back(vertex);
  }
};

std::span<const GeodesicReach> GeodesicSolver::reach(int source, double radius,
                                                     GeodesicWorkspace& workspace,
                                                     std::span<const unsigned char> allowed) const {
  const auto count = static_cast<size_t>(vertex_count());
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
  const auto is_allowed = [&](int v) {
    return allowed.empty() || allowed[static_cast<size_t>(v)] != 0;
  };
  if (!is_allowed(source) || !(radius >= 0.0)) return w.result_;

  Front front{w, radius, 1.0 / bucket_width_, kLeastGain * bucket_width_};
  front.offer(source, 0.0);
  for (size_t k = 0; k < w.bucket_.size(); ++k) {
    // The bucket may grow while it is worked off, and `bucket_` may move.
    for (size_t i = 0; i < w.bucket_[k].size(); ++i) {
      const auto v = static_cast<size_t>(w.bucket_[k][i]);
      const double dv = w.distance_[v];
      if (w.expanded_[v] <= dv) continue;
      w.expanded_[v] = dv;
      const Corner* const end = corner_.data() + begin_[v + 1];
      for (const Corner* c = corner_.data() + begin_[v]; c != end; ++c) {
        if (!is_allowed(c->a) || !is_allowed(c->b)) continue;
        const double da = w.distance_[static_cast<size_t>(c->a)];
        const double db = w.distance_[static_cast<size_t>(c->b)];
        // A corner nearer to the source than v can't gain from v. The wave rule waits for the later
        // of its two corners, whose distance is then as good as final.
        if (da > dv) {
          double best = dv + c->va;
          if (db <= dv) best = std::min(best, wave(dv, db, c->vb, c->va, c->cosine, c->sine));
          front.offer(c->a, da, best);
        }
        if (db > dv) {
          double best = dv + c->vb;
          if (da <= dv) best = std::min(best, wave(dv, da, c->va, c->vb, c->cosine, c->sine));
          front.offer(c->b, db, best);
        }
        if (c->diagonal < kInfinity && is_allowed(c->across)) {
          front.offer(c->across, dv + c->diagonal);
        }
      }
      for (int e = needle_begin_[v]; e < needle_begin_[v + 1]; ++e) {
        const GeodesicReach& needle = needle_[static_cast<size_t>(e)];
        if (is_allowed(needle.vertex)) front.offer(needle.vertex, dv + needle.distance);
      }
    }
    w.bucket_[k].clear();
  }
  for (const int v : w.touched_) {
    const auto place = static_cast<size_t>(v);
    if (w.distance_[place] <= radius) w.result_.push_back({v, w.distance_[place]});
    w.distance_[place] = kInfinity;
    w.expanded_[place] = kInfinity;
  }
  return w.result_;
}

std::vector<double> GeodesicSolver::distances(int source, double radius) const {
  GeodesicWorkspace workspace;
  const auto reached = reach(source, radius, workspace);
  std::vector<double> result(static_cast<size_t>(vertex_count()), kInfinity);
  for (const GeodesicReach& r : reached) result[static_cast<size_t>(r.vertex)] = r.distance;
  return result;
}

GeodesicTable geodesic_table(const GeodesicSolver& solver, std::span<const int> vertices,
                             double radius, std::span<const unsigned char> allowed) {
  std::vector<int> place_of(static_cast<size_t>(solver.vertex_count()), -1);
  for (size_t i = 0; i < vertices.size(); ++i) {
    const int v = vertices[i];
    if (v < 0 || v >= solver.vertex_count() || place_of[static_cast<size_t>(v)] >= 0) {
      std::ostringstream message;
      message << "geodesic table: vertex " << v
              << " is listed twice or outside the mesh, which has " << solver.vertex_count()
              << " vertices";
      throw UsageError(message.str());
    }
    place_of[static_cast<size_t>(v)] = static_cast<int>(i);
  }
  struct Entry {
    int place;
    double distance;
  };
  const int count = static_cast<int>(vertices.size());
  std::vector<std::vector<Entry>> rows(vertices.size());
  // Blocks of sources share a workspace; rows are written apart, so blocks don't show in the
  // result.
  constexpr int kBlock = 64;
  parallel_for((count + kBlock - 1) / kBlock, [&](int block) {
    GeodesicWorkspace workspace;
    for (int i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i) {
      auto& row = rows[static_cast<size_t>(i)];
      for (const auto& r :
           solver.reach(vertices[static_cast<size_t>(i)], radius, workspace, allowed)) {
        const int place = place_of[static_cast<size_t>(r.vertex)];
        if (place >= 0) row.push_back({place, r.distance});
      }
      std::sort(row.begin(), row.end(),
                [](const Entry& x, const Entry& y) { return x.place < y.place; });
    }
  });

  GeodesicTable table;
  table.begin.push_back(0);
  for (int i = 0; i < count; ++i) {
    for (const Entry& entry : rows[static_cast<size_t>(i)]) {
      // At the very radius one direction may see the other alone; such pairs are left out, so that
      // the table stays symmetric.
      const auto& back = rows[static_cast<size_t>(entry.place)];
      const auto mirror = std::lower_bound(back.begin(), back.end(), i,
                                           [](const Entry& x, int p) { return x.place < p; });
      if (mirror == back.end() || mirror->place != i) continue;
      table.place.push_back(entry.place);
      table.distance.push_back(0.5 * (entry.distance + mirror->distance));
    }
    table.begin.push_back(static_cast<int>(table.place.size()));
  }
  return table;
}

}  // namespace palmar
