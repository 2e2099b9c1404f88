// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/skin/regions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <tuple>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/remesh/subdivide.h"
#include "palmar/hand/skin/creases.h"

namespace palmar::hand {
namespace {

// Standing of a label where several meet; the smallest wins.
auto standing(const SkinLabel& label) {
  return std::tuple(label.region == Region::kDorsum, label.segment == Segment::kPalm, label.region,
                    label.segment);
}

bool ranks_before(const SkinLabel& a, const SkinLabel& b) { return standing(a) < standing(b); }

// Slides points along the smooth surface that the skin stands for; sliding along its flat triangles
// would cut the corners of fingertips.
class Surface {
 public:
  explicit Surface(const geometry::TriangleMesh& skin)
      : mesh_(geometry::subdivide(
            skin, {.scheme = geometry::SubdivisionScheme::kFittedLoop, .fit_rounds = 3})),
        normals_(geometry::vertex_normals(mesh_)),
        query_(mesh_) {}

  // Not from several threads at once.
  Vec3 project(const Vec3& point, Vec3* normal = nullptr) const {
    const geometry::ClosestPoint nearest = *query_.closest(point, kAnywhere, last_);
    last_ = nearest.triangle;
    if (normal != nullptr) {
      *normal = Vec3::Zero();
      const Triangle& t = mesh_.triangles[nearest.triangle];
      for (std::size_t k = 0; k < 3; ++k) *normal += nearest.weights[k] * normals_[t[k]];
      normal->normalize();
    }
    return nearest.point;
  }

 private:
  static constexpr double kAnywhere = std::numeric_limits<double>::infinity();
  geometry::TriangleMesh mesh_;
  std::vector<Vec3> normals_;
  geometry::ClosestPointQuery query_;
  mutable int last_ = 0;  ///< hint only: points come in runs that lie close together
};

// One vertex label component that is not the largest of its label falls to the label most common
// round it.
void remove_islands(const std::vector<std::vector<int>>& neighbours,
                    std::vector<SkinLabel>& label) {
  const int n = static_cast<int>(label.size());
  constexpr int kPasses = 10;  // an island may touch only other islands
  for (int pass = 0; pass < kPasses; ++pass) {
    std::vector<int> component(n, -1);
    std::vector<std::vector<int>> members;
    for (int seed = 0; seed < n; ++seed) {
      if (component[seed] >= 0) continue;
      const int id = static_cast<int>(members.size());
      std::vector<int> stack{seed};
      component[seed] = id;
      members.emplace_back();
      while (!stack.empty()) {
        const int i = stack.back();
        stack.pop_back();
        members.back().push_back(i);
        for (const int j : neighbours[i]) {
          if (component[j] >= 0 || !(label[j] == label[i])) continue;
          component[j] = id;
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
      const auto [entry, is_new] = stays.try_emplace(label[members[c].front()], c);
      if (!is_new && members[c].size() > members[entry->second].size()) entry->second = c;
    }
    bool has_changed = false;
    for (std::size_t c = 0; c < members.size(); ++c) {
      const std::vector<int>& m = members[c];
      const auto kept = stays.find(label[m.front()]);
      if (kept != stays.end() && kept->second == c) continue;
      std::map<SkinLabel, int, decltype(by_standing)> around(by_standing);
      for (const int i : m) {
        for (const int j : neighbours[i]) {
          if (!(label[j] == label[i])) ++around[label[j]];
        }
      }
      if (around.empty()) continue;
      const auto most =
          std::max_element(around.begin(), around.end(),
                           [](const auto& a, const auto& b) { return a.second < b.second; });
      const SkinLabel winner = most->first;
      for (const int i : m) label[i] = winner;
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

// The way of a vertex onto a crease.
struct Offer {
  bool is_made = false;
  double distance = std::numeric_limits<double>::max();  // mm
  Vec3 place = Vec3::Zero();
};

std::vector<Offer> offers(const geometry::TriangleMesh& skin,
                          const geometry::MeshTopology& topology, const HandCreases& creases,
                          const std::vector<SkinLabel>& label) {
  std::vector<Offer> offer(label.size());
  for (const auto& [i, j] : topology.edge) {
    if (label[i] == label[j]) continue;
    const Vec3& a = skin.vertices[i];
    const Vec3& b = skin.vertices[j];
    const double share = crossing(creases, a, b, label[i], label[j]);
    Offer& nearer = offer[static_cast<std::size_t>(share < 0.5 ? i : j)];
    const double distance = std::min(share, 1.0 - share) * (b - a).norm();
    nearer.is_made = true;
    if (distance >= nearer.distance) continue;
    nearer.distance = distance;
    nearer.place = a + share * (b - a);
  }
  return offer;
}

// A vertex may stay where it is if the other end of each of its crossing edges moves. The longest
// ways are spared first.
void withdraw_needless(const geometry::MeshTopology& topology, const std::vector<SkinLabel>& label,
                       std::vector<Offer>& offer) {
  std::vector<std::vector<int>> across(label.size());
  for (const auto& [i, j] : topology.edge) {
    if (label[i] == label[j]) continue;
    across[i].push_back(j);
    across[j].push_back(i);
  }
  std::vector<int> order;
  for (int i = 0; i < static_cast<int>(offer.size()); ++i) {
    if (offer[i].is_made) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return offer[a].distance > offer[b].distance; });
  for (const int i : order) {
    offer[i].is_made =
        !std::all_of(across[i].begin(), across[i].end(), [&](int j) { return offer[j].is_made; });
  }
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
      const auto phi = [&creases, &pair = pairs[k]](const Vec3& p) {
        return creases.boundary_value(p, pair.first, pair.second);
      };
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

double smallest_angle(const geometry::TriangleMesh& mesh, const Triangle& t) {
  double smallest = std::numbers::pi;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& a = mesh.vertices[t[k]];
    const Vec3 u = mesh.vertices[t[(k + 1) % 3]] - a;
    const Vec3 v = mesh.vertices[t[(k + 2) % 3]] - a;
    smallest = std::min(smallest, std::atan2(u.cross(v).norm(), u.dot(v)));
  }
  return smallest;
}

Vec3 area_normal(const geometry::TriangleMesh& mesh, const Triangle& t) {
  const Vec3& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
}

// Three vertices moved onto one crease make a sliver: its longest edge is turned, if both triangles
// gain by that. `is_fixed` shows edges that must stay.
template <typename IsFixed>
void turn_slivers(geometry::TriangleMesh& skin, const IsFixed& is_fixed) {
  constexpr double kSliver = 25.0 * geometry::kDegree;
  for (int pass = 0; pass < 3; ++pass) {
    const geometry::MeshTopology topology = geometry::build_topology(skin);
    const std::vector<std::vector<int>> neighbours = geometry::vertex_neighbours(topology);
    std::vector<bool> is_touched(skin.vertices.size());
    bool has_changed = false;
    for (int t = 0; t < skin.triangle_count(); ++t) {
      const Triangle mine = skin.triangles[t];
      if (smallest_angle(skin, mine) >= kSliver) continue;
      int longest = 0;
      double length = 0.0;
      for (int k = 0; k < 3; ++k) {
        const double l = (skin.vertices[mine[k]] - skin.vertices[mine[(k + 1) % 3]]).squaredNorm();
        if (l > length) {
          length = l;
          longest = k;
        }
      }
      const int twin = topology.twin[3 * t + longest];
      const int a = mine[longest], b = mine[(longest + 1) % 3];
      const int c = mine[(longest + 2) % 3];
      const Triangle theirs = skin.triangles[twin / 3];
      const int d = theirs[(twin % 3 + 2) % 3];
      if (is_touched[a] || is_touched[b] || is_touched[c] || is_touched[d]) continue;
      if (is_fixed(a, b)) continue;
      const auto& round_c = neighbours[c];
      if (std::binary_search(round_c.begin(), round_c.end(), d)) continue;
      const Triangle first{a, d, c}, second{d, b, c};
      const double before = std::min(smallest_angle(skin, mine), smallest_angle(skin, theirs));
      const double after = std::min(smallest_angle(skin, first), smallest_angle(skin, second));
      const bool is_folded = area_normal(skin, first).dot(area_normal(skin, second)) <= 0.0;
      if (after <= before || is_folded) continue;
      skin.triangles[t] = first;
      skin.triangles[twin / 3] = second;
      for (const int i : {a, b, c, d}) is_touched[i] = true;
      has_changed = true;
    }
    if (!has_changed) return;
  }
}

// What the creases look like as edges of the mesh.
struct CreaseGraph {
  std::vector<SkinLabel> triangle;             ///< label of each triangle
  std::vector<std::vector<int>> neighbours;    ///< per vertex: the other ends of crease edges
  std::vector<std::vector<SkinLabel>> labels;  ///< per vertex on a crease: labels round it
};

CreaseGraph build_graph(const geometry::TriangleMesh& skin, const geometry::MeshTopology& topology,
                        const HandCreases& creases, const std::vector<SkinLabel>& label,
                        const std::vector<bool>& is_snapped) {
  CreaseGraph graph;
  graph.triangle.resize(skin.triangles.size());
  for (std::size_t t = 0; t < skin.triangles.size(); ++t) {
    const Triangle& corner = skin.triangles[t];
    const auto inner =
        std::find_if(corner.begin(), corner.end(), [&](int i) { return !is_snapped[i]; });
    graph.triangle[t] = inner != corner.end()
                            ? label[*inner]
                            : creases.label((skin.vertices[corner[0]] + skin.vertices[corner[1]] +
                                             skin.vertices[corner[2]]) /
                                            3.0);
  }
  graph.neighbours.resize(skin.vertices.size());
  graph.labels.resize(skin.vertices.size());
  for (int h = 0; h < static_cast<int>(topology.twin.size()); ++h) {
    const int other = topology.twin[h];
    if (graph.triangle[h / 3] == graph.triangle[other / 3]) continue;
    const int i = skin.triangles[h / 3][h % 3];
    const int j = skin.triangles[h / 3][geometry::MeshTopology::next(h) % 3];
    graph.neighbours[i].push_back(j);  // the twin adds the other direction
    for (const int end : {i, j}) {
      for (const int t : {h / 3, other / 3}) {
        auto& labels = graph.labels[end];
        if (std::find(labels.begin(), labels.end(), graph.triangle[t]) == labels.end()) {
          labels.push_back(graph.triangle[t]);
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
      for (const int j : neighbours[i]) grown[j] = true;
    }
    is_near = std::move(grown);
  }
  std::vector<int> list;
  for (std::size_t i = 0; i < is_near.size(); ++i) {
    if (is_near[i]) list.push_back(static_cast<int>(i));
  }
  return list;
}

// Smallest angle of the triangles round a vertex; negative if one of them is turned over.
double worst_angle(const geometry::TriangleMesh& skin, const geometry::MeshTopology& topology,
                   int vertex, const Vec3& normal) {
  double worst = std::numbers::pi;
  for (const int h : topology.outgoing(vertex)) {
    const Triangle& t = skin.triangles[h / 3];
    const double angle = smallest_angle(skin, t);
    worst = std::min(worst, area_normal(skin, t).dot(normal) > 0.0 ? angle : -angle);
  }
  return worst;
}

// Labels whose creases hold a vertex: all that meet in it. Two creases that cross make two corners
// side by side; only the first of these is put on the crossing, the other stays on the crease next
// to it, lest they fall into one point.
std::vector<std::pair<SkinLabel, SkinLabel>> holding_pairs(const CreaseGraph& graph,
                                                           const HandCreases& creases, int vertex,
                                                           const Vec3& place) {
  std::vector<std::pair<SkinLabel, SkinLabel>> pairs;
  const auto& labels = graph.labels[vertex];
  for (std::size_t a = 0; a < labels.size(); ++a) {
    for (std::size_t b = a + 1; b < labels.size(); ++b) pairs.emplace_back(labels[a], labels[b]);
  }
  const auto& along = graph.neighbours[vertex];
  const auto comes_first = [&](int i, int j) {
    const std::size_t a = graph.labels[i].size(), b = graph.labels[j].size();
    return a != b ? a > b : i < j;
  };
  const bool yields = labels.size() > 2 && std::any_of(along.begin(), along.end(), [&](int j) {
                        return graph.labels[j].size() > 2 && comes_first(j, vertex);
                      });
  if (!yields) return pairs;
  const auto distance = [&](const std::pair<SkinLabel, SkinLabel>& pair) {
    return std::abs(creases.boundary_value(place, pair.first, pair.second));
  };
  return {*std::min_element(pairs.begin(), pairs.end(), [&](const auto& a, const auto& b) {
    return distance(a) < distance(b);
  })};
}

// Evens out the mesh near the creases. A move is taken if it doesn't spoil the triangles round it.
void relax(geometry::TriangleMesh& skin, const CreaseGraph& graph, const HandCreases& creases,
           const Surface& surface) {
  constexpr int kRounds = 8;
  constexpr int kRings = 4;
  constexpr double kGoodAngle = 25.0 * geometry::kDegree;
  const geometry::MeshTopology topology = geometry::build_topology(skin);
  const std::vector<std::vector<int>> neighbours = geometry::vertex_neighbours(topology);
  const std::vector<int> moving = near_creases(graph, neighbours, kRings);
  for (int round = 0; round < kRounds; ++round) {
    for (const int i : moving) {
      const auto& along = graph.neighbours[i];
      // A vertex on a crease follows its neighbours on the crease, others all theirs.
      const auto& followed = along.empty() ? neighbours[i] : along;
      Vec3 mean = Vec3::Zero();
      for (const int j : followed) mean += skin.vertices[j];
      mean /= static_cast<double>(followed.size());
      const Vec3 before = skin.vertices[i];
      const Vec3 target = before + 0.5 * (mean - before);
      Vec3 after = target;
      if (!along.empty()) {
        after = onto_creases(creases, surface, target, holding_pairs(graph, creases, i, before));
      }
      Vec3 normal;
      after = surface.project(after, &normal);
      const double was = worst_angle(skin, topology, i, normal);
      skin.vertices[i] = after;
      const double is = worst_angle(skin, topology, i, normal);
      if (is < kGoodAngle && is < was) skin.vertices[i] = before;
    }
  }
}

void require_all_labels(const SkinPartition& partition) {
  std::array<int, kSegmentCount> in_segment{};
  std::array<int, kRegionCount> in_region{};
  for (const Segment s : partition.segment) ++in_segment[index_of(s)];
  for (const Region r : partition.region) ++in_region[index_of(r)];
  for (int s = 0; s < kSegmentCount; ++s) {
    if (in_segment[s] > 0) continue;
    throw InputError("skin: segment \"" + std::string(name_of(static_cast<Segment>(s))) +
                     "\" has 0 vertices; its creases do not meet the skin");
  }
  for (int r = 0; r < kRegionCount; ++r) {
    if (in_region[r] > 0) continue;
    throw InputError("skin: region \"" + std::string(name_of(static_cast<Region>(r))) +
                     "\" has 0 vertices; its creases do not meet the skin");
  }
}

}  // namespace

SkinPartition partition_skin(const geometry::TriangleMesh& skin, const Skeleton& skeleton) {
  geometry::require_closed_manifold(skin, "skin");
  const HandCreases creases(skin, skeleton);
  const Surface surface(skin);
  const geometry::MeshTopology topology = geometry::build_topology(skin);
  const std::vector<std::vector<int>> neighbours = geometry::vertex_neighbours(topology);

  std::vector<SkinLabel> label(skin.vertices.size());
  for (std::size_t i = 0; i < label.size(); ++i) label[i] = creases.label(skin.vertices[i]);
  remove_islands(neighbours, label);

  // Of each edge across a crease the nearer end moves onto it, by the shortest way it is offered.
  SkinPartition result{.skin = skin, .segment = {}, .region = {}};
  std::vector<Offer> offer = offers(skin, topology, creases, label);
  withdraw_needless(topology, label, offer);
  std::vector<bool> is_snapped(label.size());
  for (std::size_t i = 0; i < label.size(); ++i) {
    if (!offer[i].is_made) continue;
    is_snapped[i] = true;
    result.skin.vertices[i] = surface.project(offer[i].place);
  }
  turn_slivers(result.skin, [](int, int) { return false; });
  CreaseGraph graph =
      build_graph(result.skin, geometry::build_topology(result.skin), creases, label, is_snapped);
  for (int pass = 0; pass < 2; ++pass) {
    relax(result.skin, graph, creases, surface);
    turn_slivers(result.skin, [&](int i, int j) {
      const auto& along = graph.neighbours[i];
      return std::find(along.begin(), along.end(), j) != along.end();
    });
  }

  for (std::size_t i = 0; i < label.size(); ++i) {
    if (!graph.labels[i].empty()) label[i] = graph.labels[i].front();
  }
  remove_islands(geometry::vertex_neighbours(geometry::build_topology(result.skin)), label);
  for (std::size_t i = 0; i < label.size(); ++i) {
    result.segment.push_back(label[i].segment);
    result.region.push_back(label[i].region);
  }
  require_all_labels(result);
  return result;
}

std::vector<Region> triangle_regions(const std::vector<Triangle>& triangles,
                                     const std::vector<Region>& region) {
  const auto is_lower = [](Region a, Region b) {
    const auto key = [](Region r) { return std::tuple(r == Region::kDorsum, r); };
    return key(a) < key(b);
  };
  std::vector<Region> result;
  result.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    result.push_back(std::max({region[t[0]], region[t[1]], region[t[2]]}, is_lower));
  }
  return result;
}

}  // namespace palmar::hand
