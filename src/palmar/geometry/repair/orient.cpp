// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/repair/orient.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "palmar/geometry/distance/ray_query.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"

namespace palmar::geometry {
namespace {

constexpr int kMaxSamples = 200;  // triangles of a patch that send rays; more don't change a vote
constexpr int kDirections = 6;    // rays per side of a sample
constexpr double kClearVote = 0.05;  // share of the rays by which one side must win

/// One patch: its triangles and whether each must be turned to agree with the patch.
struct Patch {
  std::vector<int> triangles;
  std::vector<bool> is_turned;
  bool is_closed = true;
  bool is_twisted = false;
};

std::vector<Patch> find_patches(const TriangleMesh& mesh, const MeshTopology& topology) {
  std::vector<Patch> patches;
  std::vector<int> state(mesh.triangles.size(), -1);  // -1 new, 0 as it is, 1 turned
  for (int seed = 0; seed < mesh.triangle_count(); ++seed) {
    if (state[seed] >= 0) continue;
    Patch patch;
    patch.triangles.push_back(seed);
    state[seed] = 0;
    for (std::size_t i = 0; i < patch.triangles.size(); ++i) {
      const int t = patch.triangles[i];
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        const int twin = topology.twin[h];
        if (twin < 0) {
          patch.is_closed = false;
          continue;
        }
        const auto start = [&](int half_edge) {
          return mesh.triangles[half_edge / 3][half_edge % 3];
        };
        // Neighbours agree if they run along their edge in opposite directions.
        const bool disagree = start(h) == start(twin);
        const int wanted = state[t] ^ (disagree ? 1 : 0);
        const int other = twin / 3;
        if (state[other] < 0) {
          state[other] = wanted;
          patch.triangles.push_back(other);
        } else if (state[other] != wanted) {
          patch.is_twisted = true;
        }
      }
    }
    std::sort(patch.triangles.begin(), patch.triangles.end());
    double kept = 0.0, turned = 0.0;
    for (const int t : patch.triangles) {
      const Triangle& k = mesh.triangles[t];
      (state[t] == 0 ? kept : turned) +=
          triangle_area(mesh.vertices[k[0]], mesh.vertices[k[1]], mesh.vertices[k[2]]);
    }
    for (const int t : patch.triangles)
      patch.is_turned.push_back((state[t] == 1) == (kept >= turned));
    patches.push_back(std::move(patch));
  }
  return patches;
}

/// Directions spread evenly over the half sphere round +z, off any axis.
std::array<Vec3, kDirections> half_sphere() {
  std::array<Vec3, kDirections> directions;
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (int i = 0; i < kDirections; ++i) {
    const double z = 0.25 + 0.7 * (i + 0.5) / kDirections;
    const double r = std::sqrt(1.0 - z * z);
    const double angle = 0.37 + golden * i;
    directions[i] = {r * std::cos(angle), r * std::sin(angle), z};
  }
  return directions;
}

/// What rays say about one patch, per ray.
struct Votes {
  double parity = 0.0;      ///< in [-1, 1]; positive: the front is outside
  double visibility = 0.0;  ///< in [-1, 1]; positive: the front sees more of the world
  double enclosed = 0.0;    ///< share of rays that cross other patches an odd number of times
};

Votes cast_votes(const TriangleMesh& mesh, const Patch& patch, const std::vector<int>& patch_of,
                 int index, const RayQuery& rays, double skin) {
  Votes votes;
  const auto directions = half_sphere();
  const int count = static_cast<int>(patch.triangles.size());
  const int samples = std::min(count, kMaxSamples);
  double weight = 0.0;
  for (int s = 0; s < samples; ++s) {
    const auto at = static_cast<long>(s) * count / samples;
    const Triangle& k = mesh.triangles[patch.triangles[at]];
    const Vec3 &a = mesh.vertices[k[0]], &b = mesh.vertices[k[1]], &c = mesh.vertices[k[2]];
    const Vec3 n = (b - a).cross(c - a);
    const double area = n.norm();
    if (!(area > 0.0)) continue;
    const Vec3 normal = n / area * (patch.is_turned[at] ? -1.0 : 1.0);
    const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
    const Vec3 centre = (a + b + c) / 3.0;
    for (const double side : {1.0, -1.0}) {
      for (const Vec3& d : directions) {
        const Vec3 direction = d.x() * u + d.y() * v + side * d.z() * normal;
        const std::vector<RayHit> hits = rays.all_hits(centre + side * skin * normal, direction);
        int own = 0, others = 0;
        for (const RayHit& hit : hits) ++(patch_of[hit.triangle] == index ? own : others);
        const double vote = side * area;
        votes.parity += (own + others) % 2 == 0 ? vote : -vote;
        votes.visibility += hits.empty() ? 2.0 * vote : 0.0;
        votes.enclosed += others % 2 == 1 ? area : 0.0;
        weight += area;
      }
    }
  }
  if (weight > 0.0) {
    votes.parity /= weight;
    votes.visibility /= weight;
    votes.enclosed /= weight;
  }
  return votes;
}

double patch_volume(const TriangleMesh& mesh, const Patch& patch) {
  const Vec3& origin = mesh.vertices[mesh.triangles[patch.triangles.front()][0]];
  double volume = 0.0;
  for (std::size_t i = 0; i < patch.triangles.size(); ++i) {
    const Triangle& k = mesh.triangles[patch.triangles[i]];
    const Vec3 a = mesh.vertices[k[0]] - origin, b = mesh.vertices[k[1]] - origin,
               c = mesh.vertices[k[2]] - origin;
    volume += (patch.is_turned[i] ? -1.0 : 1.0) * a.dot(b.cross(c)) / 6.0;
  }
  return volume;
}

enum class Verdict { kKeep, kFlip, kUndecided };

Verdict judge(const TriangleMesh& mesh, const Patch& patch, const Votes& votes) {
  if (patch.is_closed && !patch.is_twisted) {
    if (votes.enclosed > 0.5) return Verdict::kKeep;
    return patch_volume(mesh, patch) < 0.0 ? Verdict::kFlip : Verdict::kKeep;
  }
  for (const double vote : {votes.parity, votes.visibility}) {
    if (vote > kClearVote) return Verdict::kKeep;
    if (vote < -kClearVote) return Verdict::kFlip;
  }
  return Verdict::kUndecided;
}

}  // namespace

OrientResult orient_outwards(const TriangleMesh& mesh) {
  OrientResult result;
  result.mesh = mesh;
  if (mesh.triangles.empty()) return result;
  const RayQuery rays(mesh);
  const std::vector<Patch> patches = find_patches(mesh, build_topology(mesh));
  std::vector<int> patch_of(mesh.triangles.size(), -1);
  for (std::size_t p = 0; p < patches.size(); ++p) {
    for (const int t : patches[p].triangles) patch_of[t] = static_cast<int>(p);
  }
  // Rays start off the surface: far enough for single precision, near enough for thin walls.
  const double skin = 1e-5 * bounding_box(mesh).diagonal().norm();

  result.patches = static_cast<int>(patches.size());
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const Patch& patch = patches[p];
    const Votes votes = cast_votes(mesh, patch, patch_of, static_cast<int>(p), rays, skin);
    const Verdict verdict = judge(mesh, patch, votes);
    const bool flips = verdict == Verdict::kFlip;
    if (flips) ++result.flipped_patches;
    if (verdict == Verdict::kUndecided) ++result.undecided_patches;
    if (patch.is_twisted) ++result.twisted_patches;
    const auto turned = std::count(patch.is_turned.begin(), patch.is_turned.end(), true);
    if (turned > 0) ++result.repaired_patches;
    for (std::size_t i = 0; i < patch.triangles.size(); ++i) {
      if (patch.is_turned[i] == flips) continue;
      Triangle& k = result.mesh.triangles[patch.triangles[i]];
      std::swap(k[1], k[2]);
      result.flipped_triangles.push_back(patch.triangles[i]);
    }
  }
  std::sort(result.flipped_triangles.begin(), result.flipped_triangles.end());
  return result;
}

}  // namespace palmar::geometry
