// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/regions.h"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>

#include "palmar/core/error.h"
#include "palmar/geometry/closest_point.h"
#include "palmar/geometry/mesh_measures.h"
#include "palmar/geometry/mesh_topology.h"
#include "palmar/hand/creases.h"

namespace palmar {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Standing of a label where several meet; the smallest wins.
auto standing(const SkinLabel& label) {
  return std::tuple(label.region == Region::kDorsum, label.segment == Segment::kPalm, label.region,
                    label.segment);
}

bool ranks_before(const SkinLabel& a, const SkinLabel& b) { return standing(a) < standing(b); }

// Slides points along the original surface.
class Surface {
 public:
  explicit Surface(const TriangleMesh& mesh)
      : mesh_(mesh), normals_(vertex_normals(mesh)), query_(mesh) {}

  Vec3 project(const Vec3& point, Vec3* normal = nullptr) const {
    const ClosestPoint nearest = *query_.closest(point);
    if (normal != nullptr) {
      *normal = Vec3::Zero();
      const Triangle& t = mesh_.triangles[at(nearest.triangle)];
      for (std::size_t k = 0; k < 3; ++k) *normal += nearest.weights[k] * normals_[at(t[k])];
      normal->normalize();
    }
    return nearest.point;
  }

 private:
  const TriangleMesh& mesh_;
  std::vector<Vec3> normals_;
  ClosestPointQuery query_;
};

// One vertex label component that is not the largest of its label falls to the label most common
// round it.
void remove_islands(const std::vector<std::vector<int>>& neighbours,
                    std::vector<SkinLabel>& label) {
  const int n = static_cast<int>(label.size());
  constexpr int kPasses = 10;  // an island may touch only other islands
  for (int pass = 0; pass < kPasses; ++pass) {
    std::vector<int> component(at(n), -1);
    std::vector<std::vector<int>> members;
    for (int seed = 0; seed < n; ++seed) {
      if (component[at(seed)] >= 0) continue;
      const int id = static_cast<int>(members.size());
      std::vector<int> stack{seed};
      component[at(seed)] = id;
      members.emplace_back();
      while (!stack.empty()) {
        const int i = stack.back();
        stack.pop_back();
        members.back().push_back(i);
        for (const int j : neighbours[at(i)]) {
          if (component[at(j)] >= 0 || !(label[at(j)] == label[at(i)])) continue;
          component[at(j)] = id;
          stack.push_back(j);
        }
      }
    }
    const auto by_standing = [](const SkinLabel& a, const SkinLabel& b) {
      return ranks_before(a, b);
    };
    // Of each label the largest component stays, of equal ones the first.
    std::map<SkinLabel, std::size_t, decltype(by_standing)> stays(by_standing);
    for (std::size_t c = 0; c < members.size(); ++c) {
      const auto [entry, is_new] = stays.try_emplace(label[at(members[c].front())], c);
      if (!is_new && members[c].size() > members[entry->second].size()) entry->second = c;
    }
    bool has_changed = false;
    for (std::size_t c = 0; c < members.size(); ++c) {
      const std::vector<int>& m = members[c];
      const auto kept = stays.find(label[at(m.front())]);
      if (kept != stays.end() && kept->second == c) continue;
      std::map<SkinLabel, int, decltype(by_standing)> around(by_standing);
      for (const int i : m) {
        for (const int j : neighbours[at(i)]) {
          if (!(label[at(j)] == label[at(i)])) ++around[label[at(j)]];
        }
      }
      if (around.empty()) continue;
      const auto most =
          std::max_element(around.begin(), around.end(),
                           [](const auto& a, const auto& b) { return a.second < b.second; });
      const SkinLabel winner = most->first;
      for (const int i : m) label[at(i)] = winner;
      has_changed = true;
    }
    if (!has_changed) return;
  }
}

// Where an edge crosses the crease between the labels of its ends, as share of the way to b.
double crossing(const HandCreases& creases, const Vec3& a, const Vec3& b, const SkinLabel& la,
                const SkinLabel& lb) {
  double lower = 0.0, upper = 1.0;
  const double at_a = creases.boundary_value(a, la, lb);
  if (at_a * creases.boundary_value(b, la, lb) >= 0.0) return 0.5;  // a former island
  constexpr int kBisections = 12;                                   // to 1 um on an edge of 2.5 mm
  for (int k = 0; k < kBisections; ++k) {
    const double middle = 0.5 * (lower + upper);
    const bool is_a = creases.boundary_value(a + middle * (b - a), la, lb) * at_a > 0.0;
    (is_a ? lower : upper) = middle;
  }
  return 0.5 * (lower + upper);
}

// Brings a point back onto all creases that meet in it: Gauss-Newton within the tangent plane, the
// shortest step where one crease leaves a direction free.
Vec3 onto_creases(const HandCreases& creases, const Surface& surface, const Vec3& start,
                  const std::vector<std::pair<SkinLabel, SkinLabel>>& pairs) {
  constexpr double kStep = 0.05;  // mm, difference quotient
  constexpr double kReach = 1.0;  // mm, longest correction: farther away the creases do not meet
  Vec3 point = start;
  for (int iteration = 0; iteration < 3; ++iteration) {
    Vec3 normal;
    point = surface.project(point, &normal);
    const Vec3 u = normal.unitOrthogonal();
    const Vec3 v = normal.cross(u);
    Eigen::MatrixXd slope(static_cast<int>(pairs.size()), 2);
    Eigen::VectorXd value(static_cast<int>(pairs.size()));
    for (int k = 0; k < value.size(); ++k) {
      const auto& [a, b] = pairs[at(k)];
      const auto phi = [&](const Vec3& p) { return creases.boundary_value(p, a, b); };
      value[k] = phi(point);
      slope(k, 0) = (phi(point + kStep * u) - phi(point - kStep * u)) / (2.0 * kStep);
      slope(k, 1) = (phi(point + kStep * v) - phi(point - kStep * v)) / (2.0 * kStep);
    }
    // Creases that coincide make the system nearly singular; damping picks the short step.
    const Eigen::Matrix2d normal_matrix =
        slope.transpose() * slope + 0.01 * Eigen::Matrix2d::Identity();
    Eigen::Vector2d step = -normal_matrix.ldlt().solve(slope.transpose() * value);
    if (step.norm() > kReach) step *= kReach / step.norm();
    point += step.x() * u + step.y() * v;
  }
  return surface.project(point);
}

// What the creases look like as edges of the mesh.
struct CreaseGraph {
  std::vector<SkinLabel> triangle;             ///< label of each triangle
  std::vector<std::vector<int>> neighbours;    ///< per vertex: the other ends of crease edges
  std::vector<std::vector<SkinLabel>> labels;  ///< per vertex on a crease: labels round it
};

CreaseGraph build_graph(const TriangleMesh& skin, const MeshTopology& topology,
                        const HandCreases& creases, const std::vector<SkinLabel>& label,
                        const std::vector<bool>& is_snapped) {
  CreaseGraph graph;
  graph.triangle.resize(skin.triangles.size());
  for (std::size_t t = 0; t < skin.triangles.size(); ++t) {
    const Triangle& corner = skin.triangles[t];
    const auto inner =
        std::find_if(corner.begin(), corner.end(), [&](int i) { return !is_snapped[at(i)]; });
    graph.triangle[t] =
        inner != corner.end()
            ? label[at(*inner)]
            : creases.label((skin.vertices[at(corner[0])] + skin.vertices[at(corner[1])] +
                             skin.vertices[at(corner[2])]) /
                            3.0);
  }
  graph.neighbours.resize(skin.vertices.size());
  graph.labels.resize(skin.vertices.size());
  for (int h = 0; h < static_cast<int>(topology.twin.size()); ++h) {
    const int other = topology.twin[at(h)];
    if (graph.triangle[at(h / 3)] == graph.triangle[at(other / 3)]) continue;
    const int i = skin.triangles[at(h / 3)][at(h % 3)];
    const int j = skin.triangles[at(h / 3)][at(MeshTopology::next(h) % 3)];
    graph.neighbours[at(i)].push_back(j);  // the twin adds the other direction
    for (const int end : {i, j}) {
      for (const int t : {h / 3, other / 3}) {
        auto& labels = graph.labels[at(end)];
        if (std::find(labels.begin(), labels.end(), graph.triangle[at(t)]) == labels.end()) {
          labels.push_back(graph.triangle[at(t)]);
        }
      }
    }
  }
  for (auto& labels : graph.labels) std::sort(labels.begin(), labels.end(), ranks_before);
  return graph;
}

// Vertices at most `rings` edges from a crease.
std::vector<int> near_creases(const CreaseGraph& graph,
                              const std::vector<std::vector<int>>& neighbours, int rings) {
  std::vector<bool> is_near(neighbours.size());
  for (std::size_t i = 0; i < is_near.size(); ++i) is_near[i] = !graph.neighbours[i].empty();
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<bool> grown = is_near;
    for (std::size_t i = 0; i < is_near.size(); ++i) {
      if (!is_near[i]) continue;
      for (const int j : neighbours[i]) grown[at(j)] = true;
    }
    is_near = std::move(grown);
  }
  std::vector<int> list;
  for (std::size_t i = 0; i < is_near.size(); ++i) {
    if (is_near[i]) list.push_back(static_cast<int>(i));
  }
  return list;
}

void relax(TriangleMesh& skin, const std::vector<std::vector<int>>& neighbours,
           const CreaseGraph& graph, const HandCreases& creases, const Surface& surface) {
  constexpr int kRounds = 12;
  constexpr int kRings = 4;
  const std::vector<int> moving = near_creases(graph, neighbours, kRings);
  for (int round = 0; round < kRounds; ++round) {
    for (const int i : moving) {
      const auto& along = graph.neighbours[at(i)];
      Vec3& p = skin.vertices[at(i)];
      if (along.empty()) {
        Vec3 mean = Vec3::Zero();
        for (const int j : neighbours[at(i)]) mean += skin.vertices[at(j)];
        mean /= static_cast<double>(neighbours[at(i)].size());
        p = surface.project(p + 0.6 * (mean - p));
        continue;
      }
      Vec3 target = p;
      if (along.size() == 2) {
        const Vec3 mean = 0.5 * (skin.vertices[at(along[0])] + skin.vertices[at(along[1])]);
        target += 0.5 * (mean - p);
      }
      std::vector<std::pair<SkinLabel, SkinLabel>> pairs;
      const auto& labels = graph.labels[at(i)];
      for (std::size_t a = 0; a < labels.size(); ++a) {
        for (std::size_t b = a + 1; b < labels.size(); ++b)
          pairs.emplace_back(labels[a], labels[b]);
      }
      p = onto_creases(creases, surface, target, pairs);
    }
  }
}

void require_all_labels(const SkinPartition& partition) {
  std::array<int, kSegmentCount> in_segment{};
  std::array<int, kRegionCount> in_region{};
  for (const Segment s : partition.segment) ++in_segment[static_cast<std::size_t>(s)];
  for (const Region r : partition.region) ++in_region[static_cast<std::size_t>(r)];
  for (int s = 0; s < kSegmentCount; ++s) {
    if (in_segment[at(s)] > 0) continue;
    throw InputError("skin: segment \"" + std::string(name_of(static_cast<Segment>(s))) +
                     "\" has 0 vertices; its creases do not meet the skin");
  }
  for (int r = 0; r < kRegionCount; ++r) {
    if (in_region[at(r)] > 0) continue;
    throw InputError("skin: region \"" + std::string(name_of(static_cast<Region>(r))) +
                     "\" has 0 vertices; its creases do not meet the skin");
  }
}

}  // namespace

SkinPartition partition_skin(const TriangleMesh& skin, const Skeleton& skeleton) {
  require_closed_manifold(skin, "skin");
  const HandCreases creases(skin, skeleton);
  const Surface surface(skin);
  const MeshTopology topology = build_topology(skin);
  const std::vector<std::vector<int>> neighbours = vertex_neighbours(topology);

  std::vector<SkinLabel> label(skin.vertices.size());
  for (std::size_t i = 0; i < label.size(); ++i) label[i] = creases.label(skin.vertices[i]);
  remove_islands(neighbours, label);

  // Of each edge across a crease the nearer end moves onto it, by the shortest way it is offered.
  SkinPartition result{.skin = skin, .segment = {}, .region = {}};
  std::vector<bool> is_snapped(label.size());
  std::vector<double> way(label.size(), 1e9);
  for (const auto& [i, j] : topology.edge) {
    if (label[at(i)] == label[at(j)]) continue;
    const Vec3& a = skin.vertices[at(i)];
    const Vec3& b = skin.vertices[at(j)];
    const double share = crossing(creases, a, b, label[at(i)], label[at(j)]);
    const int end = share < 0.5 ? i : j;
    const double distance = std::min(share, 1.0 - share) * (b - a).norm();
    is_snapped[at(end)] = true;
    if (distance >= way[at(end)]) continue;
    way[at(end)] = distance;
    result.skin.vertices[at(end)] = surface.project(a + share * (b - a));
  }
  const CreaseGraph graph = build_graph(result.skin, topology, creases, label, is_snapped);
  relax(result.skin, neighbours, graph, creases, surface);

  for (std::size_t i = 0; i < label.size(); ++i) {
    if (!graph.labels[i].empty()) label[i] = graph.labels[i].front();
    result.segment.push_back(label[i].segment);
    result.region.push_back(label[i].region);
  }
  require_all_labels(result);
  return result;
}

std::vector<Region> triangle_regions(const std::vector<Triangle>& triangles,
                                     const std::vector<Region>& region) {
  const auto stands_lower = [](Region a, Region b) {
    const auto key = [](Region r) { return std::tuple(r == Region::kDorsum, r); };
    return key(a) < key(b);
  };
  std::vector<Region> result;
  result.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    result.push_back(
        std::max({region[at(t[0])], region[at(t[1])], region[at(t[2])]}, stands_lower));
  }
  return result;
}

}  // namespace palmar
