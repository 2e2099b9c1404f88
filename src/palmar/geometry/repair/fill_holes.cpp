// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/repair/fill_holes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <sstream>
#include <unordered_map>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/repair/hole_patch.h"
#include "palmar/geometry/repair/self_intersection.h"

namespace palmar::geometry {
namespace {

constexpr double kFoldedPatch = 2.1;   // rad, 120 degrees between two triangles of a patch
constexpr double kFoldedRim = 2.97;    // rad, 170 degrees: the patch lies on the surface round it
constexpr double kSliver = 1e-3;       // of the perimeter: thinner triangles have no direction
constexpr double kIslandShare = 1e-3;  // of the perimeter: another rim this near lies in the hole

std::array<Vec3, 3> corners_of(const TriangleMesh& mesh, const Triangle& t) {
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

Box3 box_of(const TriangleMesh& mesh, const Triangle& t) {
  Box3 box;
  for (const int v : t) box.extend(mesh.vertices[v]);
  return box;
}

/// Triangles of a growing mesh, found by their place along x.
class NearbyTriangles {
 public:
  explicit NearbyTriangles(const TriangleMesh& mesh) {
    for (int t = 0; t < mesh.triangle_count(); ++t) {
      const Box3 box = box_of(mesh, mesh.triangles[t]);
      widest_ = std::max(widest_, box.sizes().x());
      by_x_.push_back({box.min().x(), t});
    }
    sorted_ = mesh.triangle_count();
    std::sort(by_x_.begin(), by_x_.end());
  }
  /// Those whose boxes meet `box`; what was added to the mesh since is looked at one by one.
  std::vector<int> meeting(const TriangleMesh& mesh, const Box3& box) const {
    std::vector<int> found;
    const auto look_at = [&](int t) {
      if (box_of(mesh, mesh.triangles[t]).intersects(box)) found.push_back(t);
    };
    const auto first = std::lower_bound(by_x_.begin(), by_x_.end(),
                                        std::pair<double, int>{box.min().x() - widest_, -1});
    for (auto at = first; at != by_x_.end() && at->first <= box.max().x(); ++at) {
      look_at(at->second);
    }
    for (int t = sorted_; t < mesh.triangle_count(); ++t) look_at(t);
    return found;
  }

 private:
  std::vector<std::pair<double, int>> by_x_;  ///< where each begins
  double widest_ = 0.0;
  int sorted_ = 0;
};

class Filler {
 public:
  Filler(const TriangleMesh& mesh, const FillHolesOptions& options)
      : options_(options),
        topology_(build_topology(mesh)),
        nearby_(mesh),
        input_vertices_(mesh.vertex_count()) {
    result_.mesh = mesh;
    const std::vector<int> component = triangle_components(mesh, topology_);
    piece_of_vertex_.assign(mesh.vertices.size(), -1);
    for (int t = 0; t < mesh.triangle_count(); ++t) {
      if (component[t] < 0) continue;
      piece_area_.resize(std::max<std::size_t>(piece_area_.size(), component[t] + 1), 0.0);
      const auto c = corners_of(mesh, mesh.triangles[t]);
      piece_area_[component[t]] += triangle_area(c[0], c[1], c[2]);
      for (const int v : mesh.triangles[t]) piece_of_vertex_[v] = component[t];
    }
    loops_ = find_boundary_loops(mesh, topology_);
  }

  FillHolesResult run() && {
    for (const BoundaryLoop& loop : loops_.loops) {
      for (const int v : loop.corner) rim_.push_back(v);
    }
    for (BoundaryLoop& loop : loops_.loops) {
      HoleOutcome outcome;
      outcome.loop = std::move(loop);
      outcome.reason = fill(outcome);
      outcome.is_filled = outcome.reason.empty();
      result_.filled += outcome.is_filled;
      result_.holes.push_back(std::move(outcome));
    }
    return std::move(result_);
  }

 private:
  bool has_edge(int a, int b) const {
    const std::array<int, 2> edge = {std::min(a, b), std::max(a, b)};
    return std::binary_search(topology_.edge.begin(), topology_.edge.end(), edge) ||
           new_edges_.count(edge) > 0;
  }

  /// Closes one hole; why not, or "".
  std::string fill(HoleOutcome& outcome) {
    const BoundaryLoop& loop = outcome.loop;
    std::vector<Vec3> ring;
    for (const int v : loop.corner) ring.push_back(result_.mesh.vertices[v]);
    const IsJoined is_joined = [&](int i, int j) {
      return has_edge(loop.corner[i], loop.corner[j]);
    };
    if (loop.size() == 3 && has_triangle(loop.corner)) return "is the outline of one triangle";
    const std::optional<TriangleMesh> plain = triangulate_ring(ring, is_joined);
    const bool is_crack =
        plain && surface_area(*plain) <= options_.crack_width * loop.perimeter / 2.0;
    if (loop.perimeter > options_.longest_perimeter && !is_crack) {
      return "is " + significant(loop.perimeter, 4) + " mm round; up to " +
             significant(options_.longest_perimeter, 4) + " mm are filled";
    }
    if (!plain) return "has a rim that no patch fits (" + std::to_string(loop.size()) + " corners)";
    const double share = surface_area(*plain) / piece_area_[piece_of_vertex_[loop.corner[0]]];
    if (share > options_.largest_share) {
      return "would need a patch of " + significant(100.0 * share, 4) +
             " % of its piece's area; up to " + significant(100.0 * options_.largest_share, 4) +
             " % is a hole";
    }
    const TriangleMesh refined = refine_patch(*plain, loop.size(), is_joined);
    const auto around = beyond(loop);
    TriangleMesh faired = refined;
    for (int pass = 0; pass < 2; ++pass) {
      faired = fair_patch(faired, around);
      // Where its vertices went, other edges are the better ones.
      faired = refine_patch(faired, loop.size(), is_joined);
    }
    std::string reason;
    for (const TriangleMesh& patch : {faired, refined, *plain}) {
      reason = fault_of(patch, loop);
      if (!reason.empty()) continue;
      outcome.triangles = patch.triangle_count();
      outcome.area = surface_area(patch);
      add(patch, loop);
      return "";
    }
    return reason;
  }

  bool has_triangle(const std::vector<int>& corner) const {
    for (const int h : topology_.outgoing(corner[0])) {
      Triangle t = result_.mesh.triangles[h / 3];
      Triangle wanted = {corner[0], corner[1], corner[2]};
      std::sort(t.begin(), t.end());
      std::sort(wanted.begin(), wanted.end());
      if (t == wanted) return true;
    }
    return false;
  }

  std::vector<std::vector<Vec3>> beyond(const BoundaryLoop& loop) const {
    std::vector<std::vector<Vec3>> neighbours;
    for (const int v : loop.corner) {
      std::vector<int> found;
      for (const int h : topology_.outgoing(v)) {
        for (const int other : result_.mesh.triangles[h / 3]) {
          if (other != v) found.push_back(other);
        }
      }
      std::sort(found.begin(), found.end());
      found.erase(std::unique(found.begin(), found.end()), found.end());
      std::vector<Vec3> points;
      for (const int other : found) {
        const bool is_on_ring =
            std::find(loop.corner.begin(), loop.corner.end(), other) != loop.corner.end();
        if (!is_on_ring) points.push_back(result_.mesh.vertices[other]);
      }
      neighbours.push_back(std::move(points));
    }
    return neighbours;
  }

  /// What forbids a patch; "" if nothing.
  std::string fault_of(const TriangleMesh& patch, const BoundaryLoop& loop) const {
    if (is_folded(patch, loop)) return "has a rim that only a folded patch fits";
    Box3 box;
    for (const Vec3& x : patch.vertices) box.extend(x);
    for (const int v : rim_) {
      const Vec3& x = result_.mesh.vertices[v];
      const double near = kIslandShare * loop.perimeter;
      if (box.squaredExteriorDistance(x) > near * near) continue;
      if (std::find(loop.corner.begin(), loop.corner.end(), v) != loop.corner.end()) continue;
      for (const Triangle& t : patch.triangles) {
        const auto c = corners_of(patch, t);
        if ((closest_point_on_triangle(x, c[0], c[1], c[2]).point - x).norm() < near) {
          return "has another open edge within it";
        }
      }
    }
    return do_cross(patch, loop, box) ? "would go through the surface if filled" : "";
  }

  bool is_folded(const TriangleMesh& patch, const BoundaryLoop& loop) const {
    const auto normal_of = [&](const TriangleMesh& mesh, const Triangle& t) {
      const auto c = corners_of(mesh, t);
      const Vec3 n = (c[1] - c[0]).cross(c[2] - c[0]);
      const double longest =
          std::max({(c[1] - c[0]).norm(), (c[2] - c[1]).norm(), (c[0] - c[2]).norm()});
      return n.norm() < kSliver * loop.perimeter * longest ? Vec3(Vec3::Zero()) : n.normalized();
    };
    const MeshTopology topology = build_topology(patch);
    for (int h = 0; h < static_cast<int>(topology.twin.size()); ++h) {
      const Vec3 n = normal_of(patch, patch.triangles[h / 3]);
      Vec3 other = Vec3::Zero();
      double limit = kFoldedPatch;
      if (topology.twin[h] >= 0) {
        other = normal_of(patch, patch.triangles[topology.twin[h] / 3]);
      } else {
        limit = kFoldedRim;
        const int a = loop.corner[patch.triangles[h / 3][h % 3]];
        const int b = loop.corner[patch.triangles[h / 3][MeshTopology::next(h) % 3]];
        for (const int outer : topology_.outgoing(b)) {
          const Triangle& t = result_.mesh.triangles[outer / 3];
          if (t[MeshTopology::next(outer) % 3] == a) other = normal_of(result_.mesh, t);
        }
      }
      if (n.dot(other) < std::cos(limit)) return true;
    }
    return false;
  }

  bool do_cross(const TriangleMesh& patch, const BoundaryLoop& loop, const Box3& box) const {
    TriangleMesh local;
    std::unordered_map<int, int> local_of;
    const auto local_vertex = [&](int v) {
      const auto [at, is_new] = local_of.try_emplace(v, local.vertex_count());
      if (is_new) local.vertices.push_back(result_.mesh.vertices[v]);
      return at->second;
    };
    for (const int t : nearby_.meeting(result_.mesh, box)) {
      const Triangle& k = result_.mesh.triangles[t];
      local.triangles.push_back({local_vertex(k[0]), local_vertex(k[1]), local_vertex(k[2])});
    }
    const int others = local.triangle_count();
    std::vector<int> index;
    for (int v = 0; v < patch.vertex_count(); ++v) {
      if (v < loop.size()) {
        index.push_back(local_vertex(loop.corner[v]));
      } else {
        index.push_back(local.vertex_count());
        local.vertices.push_back(patch.vertices[v]);
      }
    }
    for (const Triangle& t : patch.triangles) {
      local.triangles.push_back({index[t[0]], index[t[1]], index[t[2]]});
    }
    const auto pairs = find_self_crossings(local);
    return std::any_of(pairs.begin(), pairs.end(),
                       [&](const auto& pair) { return pair[1] >= others; });
  }

  void add(const TriangleMesh& patch, const BoundaryLoop& loop) {
    std::vector<int> index;
    for (int v = 0; v < patch.vertex_count(); ++v) {
      if (v < loop.size()) {
        index.push_back(loop.corner[v]);
      } else {
        index.push_back(result_.mesh.vertex_count());
        result_.mesh.vertices.push_back(patch.vertices[v]);
      }
    }
    for (const Triangle& t : patch.triangles) {
      const Triangle added = {index[t[0]], index[t[1]], index[t[2]]};
      result_.mesh.triangles.push_back(added);
      for (int k = 0; k < 3; ++k) {
        const int a = added[k], b = added[(k + 1) % 3];
        if (a < input_vertices_ && b < input_vertices_) {
          new_edges_.insert({std::min(a, b), std::max(a, b)});
        }
      }
    }
  }

  FillHolesOptions options_;
  MeshTopology topology_;  ///< of the input
  NearbyTriangles nearby_;
  int input_vertices_;
  std::vector<int> piece_of_vertex_;
  std::vector<double> piece_area_;
  BoundaryLoops loops_;
  std::vector<int> rim_;
  std::set<std::array<int, 2>> new_edges_;
  FillHolesResult result_;
};

}  // namespace

void FillHolesOptions::check() const {
  const auto require = [](bool is_allowed, const char* what, double value, const char* allowed) {
    if (is_allowed) return;
    std::ostringstream message;
    message << "holes: " << what << " is " << value << "; " << allowed;
    throw UsageError(message.str());
  };
  require(std::isfinite(longest_perimeter) && longest_perimeter >= 0.0, "longest perimeter in mm",
          longest_perimeter, "a finite length of at least 0 is required");
  require(std::isfinite(crack_width) && crack_width >= 0.0, "crack's width in mm", crack_width,
          "a finite length of at least 0 is required");
  require(largest_share > 0.0 && largest_share <= 1.0, "largest share of the area", largest_share,
          "above 0 and at most 1 is allowed");
}

FillHolesResult fill_holes(const TriangleMesh& mesh, const FillHolesOptions& options) {
  options.check();
  for (const Vec3& x : mesh.vertices) {
    if (!x.allFinite()) throw InputError("holes: a vertex is not finite");
  }
  return Filler(mesh, options).run();
}

}  // namespace palmar::geometry
