// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/remesh/remesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <sstream>

#include "palmar/core/error.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/editable_mesh.h"
#include "palmar/geometry/mesh/mesh_topology.h"

namespace palmar::geometry {
namespace {

// Edges kept between 4/5 and 4/3 of the length L that steers the rounds end up with a mean of 1.02
// L.
constexpr double kSteeringLength = 1.0 / 1.02;
constexpr double kSplitAbove = 4.0 / 3.0;
constexpr double kCollapseBelow = 4.0 / 5.0;

// A collapse may turn a triangle by this much: cos 45 deg. More would cut a corner of the surface.
constexpr double kMaxTurnCosine = 0.7;

// Sum of the area vectors round a vertex over the sum of areas: 1 if flat, 0.71 at a right-angled
// edge, 0.58 at the corner of a cube.
constexpr double kCommonNormal = 0.6;

constexpr int kMaxWalk = 200;  // triangles; a vertex moves by a few at most

// The input, on which vertices find their feet.
class Target {
 public:
  explicit Target(const TriangleMesh& mesh) : mesh_(mesh), topology_(build_topology(mesh)) {}

  struct Foot {
    int triangle = 0;
    TrianglePoint point;
  };

  // Nearest point to p that a walk downhill from triangle `start` finds.
  Foot descend(const Vec3& p, int start) const {
    Foot foot{start, nearest(p, start)};
    for (int step = 0; step < kMaxWalk; ++step) {
      const Foot last = foot;
      int zeros = 0, corner = 0;
      for (size_t k = 0; k < 3; ++k) {
        if (last.point.weights[k] > 0.0) {
          corner = static_cast<int>(k);
        } else {
          ++zeros;
        }
      }
      if (zeros == 0) return foot;
      if (zeros == 1) {
        for (size_t k = 0; k < 3; ++k) {
          if (last.point.weights[k] > 0.0) continue;
          try_triangle(
              p, topology_.twin[3 * static_cast<std::size_t>(last.triangle) + (k + 1) % 3] / 3,
              topology_.twin[3 * static_cast<std::size_t>(last.triangle) + (k + 1) % 3] >= 0, foot);
        }
      } else {
        const int v = mesh_.triangles[last.triangle][corner];
        for (const int h : topology_.outgoing(v)) try_triangle(p, h / 3, true, foot);
      }
      if (foot.triangle == last.triangle) return foot;
    }
    return foot;
  }

  Vec3 normal(int triangle) const {
    const auto& [a, b, c] = mesh_.triangles[triangle];
    return (at(b) - at(a)).cross(at(c) - at(a)).normalized();
  }

 private:
  const Vec3& at(int v) const { return mesh_.vertices[v]; }
  TrianglePoint nearest(const Vec3& p, int triangle) const {
    const auto& [a, b, c] = mesh_.triangles[triangle];
    return closest_point_on_triangle(p, at(a), at(b), at(c));
  }
  void try_triangle(const Vec3& p, int triangle, bool exists, Foot& foot) const {
    if (!exists || triangle == foot.triangle) return;
    const TrianglePoint candidate = nearest(p, triangle);
    // Nearer by more than rounding, else two triangles could pass a point back and forth.
    if (candidate.squared_distance < foot.point.squared_distance * (1.0 - 1e-12)) {
      foot = {triangle, candidate};
    }
  }

  const TriangleMesh& mesh_;
  MeshTopology topology_;
};

Vec3 area_vector(const Vec3& a, const Vec3& b, const Vec3& c) { return (b - a).cross(c - a); }

// Four times the area over the sum of squared edges, scaled to 1 for an equilateral triangle.
double shape_quality(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double squares = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
  return squares > 0.0 ? 2.0 * std::sqrt(3.0) * area_vector(a, b, c).norm() / squares : 0.0;
}

class Remesher {
 public:
  Remesher(const TriangleMesh& mesh, const RemeshOptions& options)
      : target_(mesh), edit_(mesh), rounds_(options.rounds) {
    length_ = options.edge_length * kSteeringLength;
    foot_.assign(edit_.vertex_capacity(), 0);
    for (int h = 0; h < edit_.half_edge_capacity(); ++h) {
      foot_[edit_.start(h)] = h / 3;
    }
  }

  RemeshResult run(const TriangleMesh& input) {
    for (int round = 0; round < rounds_; ++round) {
      split_long();
      collapse_short();
      flip_edges(&Remesher::evens_valence);
      relax();
    }
    // Valence has done its work; now the angles themselves.
    for (int round = 0; round < rounds_ / 3 + 1 && rounds_ > 0; ++round) {
      flip_edges(&Remesher::widens_angles);
      relax();
    }
    if (rounds_ > 0) flip_edges(&Remesher::widens_angles);
    return in_memory_order(input);
  }

 private:
  const Vec3& at(int v) const { return edit_.position(v); }
  double squared_length(int h) const {
    return (at(edit_.start(h)) - at(edit_.end(h))).squaredNorm();
  }

  // Puts the vertex on the surface, from the foot of a vertex close by.
  void settle(int v, const Vec3& p, int start) {
    const Target::Foot foot = target_.descend(p, start);
    foot_[v] = foot.triangle;
    edit_.set_position(v, foot.point.point);
  }

  void split_long() {
    const double limit = kSplitAbove * kSplitAbove * length_ * length_;
    // New half-edges come at the end and are seen by the same loop.
    for (int h = 0; h < edit_.half_edge_capacity(); ++h) {
      if (!edit_.has_half_edge(h) || squared_length(h) <= limit) continue;
      if (edit_.twin(h) > h && squared_length(edit_.twin(h)) > limit) continue;
      const int a = edit_.start(h);
      const bool is_border = edit_.twin(h) < 0;
      const Vec3 begin = at(a), end = at(edit_.end(h)), middle = 0.5 * (begin + end);
      const int v = edit_.split(h, middle);
      foot_.push_back(foot_[a]);
      if (!is_border) {
        settle(v, middle, foot_[a]);
        // A foot beside one end (on a crumpled surface the walk can stop there) would leave the
        // edge as long as it was, for ever; relax() brings the vertex down later.
        const double reach = 0.64 * (end - begin).squaredNorm();
        if ((at(v) - begin).squaredNorm() > reach || (at(v) - end).squaredNorm() > reach) {
          edit_.set_position(v, middle);
        }
      }
      --h;  // the rest of the edge may still be long
    }
  }

  // Whether the triangles round start(h), moved to end(h) = b at p, stay short, upright and sound.
  bool is_sound_collapse(int h, const Vec3& p) const {
    const double limit = kSplitAbove * kSplitAbove * length_ * length_;
    const int a = edit_.start(h), b = edit_.end(h);
    for (const int centre : {a, b}) {
      const int first = edit_.outgoing(centre);
      for (int o = first; o >= 0;) {
        const int c = edit_.end(o), d = edit_.apex(o);
        if (c != a && c != b && d != a && d != b) {
          const Vec3 before = area_vector(at(centre), at(c), at(d));
          const Vec3 after = area_vector(p, at(c), at(d));
          if (after.dot(before) < kMaxTurnCosine * after.norm() * before.norm()) return false;
          if ((at(c) - p).squaredNorm() > limit || (at(d) - p).squaredNorm() > limit) return false;
        }
        o = edit_.turn(o);
        if (o == first) break;
      }
    }
    return true;
  }

  void collapse_short() {
    const double limit = kCollapseBelow * kCollapseBelow * length_ * length_;
    for (int h = 0; h < edit_.half_edge_capacity(); ++h) {
      if (!edit_.has_half_edge(h) || squared_length(h) >= limit) continue;
      if (edit_.is_border_vertex(edit_.start(h)) || !edit_.can_collapse(h)) continue;
      const int a = edit_.start(h), b = edit_.end(h);
      const bool keeps_end = edit_.is_border_vertex(b);
      const Vec3 p = keeps_end ? at(b) : Vec3(0.5 * (at(a) + at(b)));
      if (!is_sound_collapse(h, p)) continue;
      edit_.collapse(h);
      if (!keeps_end) settle(b, p, foot_[b]);
    }
  }

  bool evens_valence(int h) const {
    const int g = edit_.twin(h);
    const std::array<int, 4> corners{edit_.start(h), edit_.end(h), edit_.apex(h), edit_.apex(g)};
    int before = 0, after = 0;
    for (size_t k = 0; k < 4; ++k) {
      const int ideal = edit_.is_border_vertex(corners[k]) ? 4 : 6;
      const int excess = edit_.valence(corners[k]) - ideal;
      const int change = k < 2 ? -1 : 1;
      before += excess * excess;
      after += (excess + change) * (excess + change);
    }
    return after < before && flipped_quality(h) > 0.3;
  }

  bool widens_angles(int h) const {
    const int g = edit_.twin(h);
    const Vec3 &a = at(edit_.start(h)), &b = at(edit_.end(h));
    const Vec3 &c = at(edit_.apex(h)), &d = at(edit_.apex(g));
    return flipped_quality(h) > std::min(shape_quality(a, b, c), shape_quality(b, a, d)) + 1e-9;
  }

  // Quality of the worse triangle after a flip; 0 if the flip would fold or dent the surface.
  double flipped_quality(int h) const {
    const int g = edit_.twin(h);
    const Vec3 &a = at(edit_.start(h)), &b = at(edit_.end(h));
    const Vec3 &c = at(edit_.apex(h)), &d = at(edit_.apex(g));
    const Vec3 before = area_vector(a, b, c).normalized() + area_vector(b, a, d).normalized();
    const Vec3 first = area_vector(c, d, b), second = area_vector(d, c, a);
    const double scale = before.norm();
    if (first.dot(before) < kMaxTurnCosine * scale * first.norm() ||
        second.dot(before) < kMaxTurnCosine * scale * second.norm()) {
      return 0.0;
    }
    return std::min(shape_quality(c, d, b), shape_quality(d, c, a));
  }

  void flip_edges(bool (Remesher::*wants_flip)(int) const) {
    for (int h = 0; h < edit_.half_edge_capacity(); ++h) {
      if (!edit_.has_half_edge(h) || edit_.twin(h) < h) continue;
      if ((this->*wants_flip)(h)) edit_.flip(h);
    }
  }

  void relax() {
    const int count = edit_.vertex_capacity();
    std::vector<Vec3> goal(count);
    for (int v = 0; v < count; ++v) {
      if (!edit_.has_vertex(v) || edit_.is_border_vertex(v)) continue;
      Vec3 sum = Vec3::Zero(), normal = Vec3::Zero();
      double area = 0.0;
      const int first = edit_.outgoing(v);
      for (int h = first;;) {
        const Vec3 &b = at(edit_.end(h)), &c = at(edit_.apex(h));
        const Vec3 n = area_vector(at(v), b, c);
        sum += n.norm() * (at(v) + b + c) / 3.0;
        area += n.norm();
        normal += n;
        h = edit_.turn(h);
        if (h == first) break;
      }
      goal[v] = at(v);
      // Without a common normal (at a rim, say) there is no tangent plane to move in.
      if (!(normal.norm() > kCommonNormal * area)) continue;
      normal.normalize();
      const Vec3 step = sum / area - at(v);
      goal[v] += step - step.dot(normal) * normal;
    }
    for (int v = 0; v < count; ++v) {
      if (!edit_.has_vertex(v) || edit_.is_border_vertex(v)) continue;
      const Vec3 last = at(v);
      const int last_foot = foot_[v];
      settle(v, goal[v], last_foot);
      if (!turns_triangle(v, last)) continue;
      edit_.set_position(v, last);
      foot_[v] = last_foot;
    }
  }

  // Whether a triangle round v is turned over by its move from `last`.
  bool turns_triangle(int v, const Vec3& last) const {
    const int first = edit_.outgoing(v);
    for (int h = first;;) {
      const Vec3 &b = at(edit_.end(h)), &c = at(edit_.apex(h));
      const Vec3 before = area_vector(last, b, c), after = area_vector(at(v), b, c);
      if (after.dot(before) < kMaxTurnCosine * after.norm() * before.norm()) return true;
      h = edit_.turn(h);
      if (h == first) return false;
    }
  }

  RemeshResult in_memory_order(const TriangleMesh& input) const;

  Target target_;
  EditableMesh edit_;
  int rounds_;
  double length_ = 1.0;
  std::vector<int> foot_;  // per vertex: triangle of the input
};

// Place along a Morton curve through a grid of 1024^3 cells.
uint64_t morton(const Vec3& unit) {
  uint64_t code = 0;
  std::array<uint64_t, 3> cell{};
  for (int k = 0; k < 3; ++k) {
    cell[k] = static_cast<uint64_t>(std::clamp(unit[k], 0.0, 1.0) * 1023.0);
  }
  for (unsigned bit = 0; bit < 10; ++bit) {
    for (unsigned k = 0; k < 3; ++k) code |= ((cell[k] >> bit) & 1U) << (3 * bit + k);
  }
  return code;
}

RemeshResult Remesher::in_memory_order(const TriangleMesh& input) const {
  const EditableMesh::Compacted compacted = edit_.compacted();
  const auto& vertices = compacted.mesh.vertices;
  Box3 box;
  for (const Vec3& v : vertices) box.extend(v);
  const double size =
      vertices.empty() ? 1.0 : std::max(box.sizes().maxCoeff(), std::numeric_limits<double>::min());
  std::vector<std::pair<uint64_t, int>> order;
  for (size_t v = 0; v < vertices.size(); ++v) {
    order.emplace_back(morton((vertices[v] - box.min()) / size), static_cast<int>(v));
  }
  std::sort(order.begin(), order.end());
  RemeshResult result;
  std::vector<int> new_of_old(vertices.size());
  for (const auto& [code, v] : order) {
    new_of_old[v] = result.mesh.vertex_count();
    const int triangle = foot_[compacted.old_of_new[v]];
    const auto& [a, b, c] = input.triangles[triangle];
    const TrianglePoint foot = closest_point_on_triangle(vertices[v], input.vertices[a],
                                                         input.vertices[b], input.vertices[c]);
    result.mesh.vertices.push_back(vertices[v]);
    result.triangle.push_back(triangle);
    result.weights.push_back(foot.weights);
  }
  for (Triangle t : compacted.mesh.triangles) {
    for (int& v : t) v = new_of_old[v];
    // Smallest corner first, orientation kept, so that triangles can be sorted by it.
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    result.mesh.triangles.push_back(t);
  }
  std::sort(result.mesh.triangles.begin(), result.mesh.triangles.end());
  return result;
}

}  // namespace

void RemeshOptions::check() const {
  std::ostringstream message;
  if (!(std::isfinite(edge_length) && edge_length > 0.0)) {
    message << "remeshing: edge_length is " << edge_length
            << " mm; a positive, finite length is required";
    throw UsageError(message.str());
  }
  if (rounds < 0 || rounds > 100) {
    message << "remeshing: rounds is " << rounds << "; allowed are 0 to 100";
    throw UsageError(message.str());
  }
}

RemeshResult remesh(const TriangleMesh& mesh, const RemeshOptions& options) {
  options.check();
  for (size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (mesh.vertices[v].allFinite()) continue;
    std::ostringstream message;
    message << "remeshing: vertex " << v << " is (" << mesh.vertices[v].transpose()
            << ") mm; finite coordinates are required";
    throw InputError(message.str());
  }
  return Remesher(mesh, options).run(mesh);
}

}  // namespace palmar::geometry
