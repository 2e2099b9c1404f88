// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/voxel_skeleton.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace palmar::product {
namespace {

constexpr double kReach = 1.6;      // depths that a line stands for; a square corner is 1.42 away
constexpr double kTipExcess = 8.0;  // mm beyond that from which a tip is one: half a finger
constexpr int kMostTips = 60;       // plates have many
// A line to a tip has to keep its depth, outside of the ball at its beginning, over a finger's
// breadth and half the depth there.
constexpr double kFinger = 15.0, kSpur = 0.5;
constexpr double kCorner = 0.3;     // depth gained per length from a corner or an edge inwards:
                                    // 0.58 and more for square ones; bars taper less (17 deg)
constexpr double kKnobDepth = 6.0;  // mm of depth: what two fingers hold, 12 mm thick
constexpr double kRegrown = 1.2;  // ratio of a knob's depth to its neck's: a finger feels it as one
constexpr double kAsDeep = 0.98;  // share of the largest depth that counts as deepest

using Queue = std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>,
                                  std::greater<>>;

struct Step {
  int offset = 0;
  double length = 0.0;  // mm
};

std::vector<Step> steps_of(const SolidGrid& grid) {
  std::vector<Step> steps;
  for (int k = -1; k <= 1; ++k) {
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i) {
        if (i == 0 && j == 0 && k == 0) continue;
        steps.push_back({i + grid.size[0] * (j + grid.size[1] * k),
                         grid.spacing * std::sqrt(static_cast<double>(i * i + j * j + k * k))});
      }
    }
  }
  return steps;
}

// The deepest voxel of every connected solid (of several as deep the one nearest to its middle).
std::vector<int> roots_of(const SolidGrid& grid, const std::vector<Step>& steps) {
  std::vector<std::uint8_t> is_seen(grid.is_solid.size(), 0);
  std::vector<int> roots, piece;
  for (std::size_t start = 0; start < is_seen.size(); ++start) {
    if (grid.is_solid[start] == 0 || is_seen[start] != 0) continue;
    piece.assign(1, static_cast<int>(start));
    is_seen[start] = 1;
    Vec3 middle = Vec3::Zero();
    double deepest = 0.0;
    for (std::size_t next = 0; next < piece.size(); ++next) {
      const int n = piece[next];
      middle += grid.centre(n);
      deepest = std::max<double>(deepest, grid.depth[n]);
      for (const Step& s : steps) {
        const int m = n + s.offset;
        if (grid.is_solid[m] == 0 || is_seen[m] != 0) continue;
        is_seen[m] = 1;
        piece.push_back(m);
      }
    }
    middle /= static_cast<double>(piece.size());
    int best = -1;
    double nearest = std::numeric_limits<double>::infinity();
    for (const int n : piece) {
      if (grid.depth[n] < kAsDeep * deepest) continue;
      const double d = (grid.centre(n) - middle).norm();
      if (d < nearest) {
        nearest = d;
        best = n;
      }
    }
    roots.push_back(best);
  }
  return roots;
}

// Tips: what the lines to it from the root don't reach.
std::vector<int> tips_of(const SolidGrid& grid, const std::vector<Step>& steps,
                         const std::vector<int>& roots) {
  const std::size_t count = grid.is_solid.size();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  // Ways to the root that keep to the middle: a step costs its length by the square of the depth.
  std::vector<int> back(count, -1);
  {
    std::vector<double> cost(count, kInfinite);
    Queue queue;
    for (const int r : roots) {
      cost[r] = 0.0;
      queue.push({0.0, r});
    }
    while (!queue.empty()) {
      const auto [c, n] = queue.top();
      queue.pop();
      if (c > cost[n]) continue;
      for (const Step& s : steps) {
        const int m = n + s.offset;
        if (grid.is_solid[m] == 0) continue;
        const double d = grid.depth[m];
        const double next = c + s.length / (d * d);
        if (next < cost[m]) {
          cost[m] = next;
          back[m] = n;
          queue.push({next, m});
        }
      }
    }
  }
  std::vector<double> beyond(count, kInfinite);  // way from what the lines reach, mm
  std::vector<std::uint8_t> is_line(count, 0);
  std::vector<int> tips, fresh = roots;
  while (static_cast<int>(tips.size()) < kMostTips) {
    Queue queue;
    for (const int n : fresh) {
      is_line[n] = 1;
      const double d = -kReach * grid.depth[n];
      if (d < beyond[n]) {
        beyond[n] = d;
        queue.push({d, n});
      }
    }
    while (!queue.empty()) {
      const auto [d, n] = queue.top();
      queue.pop();
      if (d > beyond[n]) continue;
      for (const Step& s : steps) {
        const int m = n + s.offset;
        if (grid.is_solid[m] == 0) continue;
        const double next = d + s.length;
        if (next < beyond[m]) {
          beyond[m] = next;
          queue.push({next, m});
        }
      }
    }
    int tip = -1;
    double farthest = kTipExcess;
    for (std::size_t n = 0; n < count; ++n) {
      if (grid.is_solid[n] != 0 && beyond[n] > farthest && beyond[n] < kInfinite) {
        farthest = beyond[n];
        tip = static_cast<int>(n);
      }
    }
    if (tip < 0) break;
    tips.push_back(tip);
    fresh.clear();
    for (int n = tip; n >= 0 && is_line[n] == 0; n = back[n]) fresh.push_back(n);
  }
  return tips;
}

std::uint32_t around(const SolidGrid& grid, const std::vector<std::uint8_t>& solid, int n) {
  std::uint32_t bits = 0;
  int bit = 0;
  for (int k = -1; k <= 1; ++k) {
    for (int j = -1; j <= 1; ++j) {
      const int base = n + grid.size[0] * (j + grid.size[1] * k);
      for (int i = -1; i <= 1; ++i, ++bit) {
        if (solid[base + i] != 0) bits |= 1U << bit;
      }
    }
  }
  return bits;
}

// What is left of the solid when it has become lines.
std::vector<std::uint8_t> thinned(const SolidGrid& grid, const std::vector<Step>& steps,
                                  const std::vector<int>& tips) {
  std::vector<std::uint8_t> solid = grid.is_solid;
  std::vector<std::uint8_t> is_kept(solid.size(), 0);
  for (const int t : tips) is_kept[t] = 1;
  // Levels of depth, a quarter of a voxel wide.
  const auto level_of = [&](int n) {
    return static_cast<std::size_t>(4.0 * grid.depth[n] / grid.spacing);
  };
  std::vector<std::vector<int>> bucket;
  for (std::size_t n = 0; n < solid.size(); ++n) {
    if (solid[n] == 0) continue;
    const std::size_t level = level_of(static_cast<int>(n));
    if (level >= bucket.size()) bucket.resize(level + 1);
    bucket[level].push_back(static_cast<int>(n));
  }
  for (std::size_t level = 0; level < bucket.size(); ++level) {
    std::vector<int> queue = std::move(bucket[level]);
    // Exact order within the level; ties in the order of the grid.
    std::stable_sort(queue.begin(), queue.end(),
                     [&](int a, int b) { return grid.depth[a] < grid.depth[b]; });
    std::vector<int> again;
    while (!queue.empty()) {
      again.clear();
      for (const int n : queue) {
        if (solid[n] == 0 || is_kept[n] != 0 || !can_leave(around(grid, solid, n))) continue;
        solid[n] = 0;
        for (const Step& s : steps) {
          const int m = n + s.offset;
          if (solid[m] != 0 && is_kept[m] == 0 && level_of(m) <= level) again.push_back(m);
        }
      }
      std::sort(again.begin(), again.end());
      again.erase(std::unique(again.begin(), again.end()), again.end());
      queue.swap(again);
    }
  }
  return solid;
}

SkeletonGraph trace(const SolidGrid& grid, const std::vector<Step>& steps,
                    const std::vector<std::uint8_t>& line) {
  SkeletonGraph graph;
  std::vector<int> voxels;
  for (std::size_t n = 0; n < line.size(); ++n) {
    if (line[n] != 0) voxels.push_back(static_cast<int>(n));
  }
  const auto neighbours = [&](int n) {
    std::vector<int> result;
    for (const Step& s : steps) {
      if (line[n + s.offset] != 0) result.push_back(n + s.offset);
    }
    return result;
  };
  // Nodes: ends, and clusters of voxels with three neighbours or more.
  std::vector<int> node_of(line.size(), -1);
  std::vector<std::vector<int>> members;
  for (const int n : voxels) {
    if (node_of[n] >= 0 || neighbours(n).size() == 2) continue;
    const bool is_junction = neighbours(n).size() > 2;
    const int id = static_cast<int>(members.size());
    std::vector<int> cluster(1, n);
    node_of[n] = id;
    for (std::size_t next = 0; is_junction && next < cluster.size(); ++next) {
      for (const int m : neighbours(cluster[next])) {
        if (node_of[m] >= 0 || neighbours(m).size() <= 2) continue;
        node_of[m] = id;
        cluster.push_back(m);
      }
    }
    Vec3 mean = Vec3::Zero();
    for (const int m : cluster) mean += grid.centre(m);
    graph.node.push_back(mean / static_cast<double>(cluster.size()));
    graph.node_radius.push_back(grid.depth_at(graph.node.back()));
    members.push_back(std::move(cluster));
  }
  std::vector<std::uint8_t> is_used(line.size(), 0);
  const auto follow = [&](int before, int first) {
    std::vector<int> way;
    int previous = before;
    for (int n = first; node_of[n] < 0 && is_used[n] == 0;) {
      is_used[n] = 1;
      way.push_back(n);
      int next = -1;
      for (const int m : neighbours(n)) {
        if (m != previous && (node_of[m] >= 0 || is_used[m] == 0)) next = m;
      }
      if (next < 0) break;
      previous = n;
      n = next;
    }
    return way;
  };
  const auto end_of = [&](const std::vector<int>& way, int start) {
    // The node after the last voxel that isn't the voxel the way came from.
    int found = -1;
    for (const int m : neighbours(way.back())) {
      if (node_of[m] >= 0 && (way.size() > 1 || m != start)) found = node_of[m];
    }
    return found;
  };
  for (std::size_t id = 0; id < members.size(); ++id) {
    for (const int n : members[id]) {
      for (const int m : neighbours(n)) {
        if (node_of[m] == static_cast<int>(id)) continue;
        if (node_of[m] >= 0) {  // two nodes side by side
          if (node_of[m] > static_cast<int>(id)) {
            SkeletonEdge edge;
            edge.node = {static_cast<int>(id), node_of[m]};
            graph.edges.push_back(std::move(edge));
          }
          continue;
        }
        if (is_used[m] != 0) continue;
        const std::vector<int> way = follow(n, m);
        SkeletonEdge edge;
        edge.node = {static_cast<int>(id), end_of(way, n)};
        if (edge.node[1] < 0) edge.node[1] = static_cast<int>(id);
        for (const int w : way) edge.point.push_back(grid.centre(w));
        graph.edges.push_back(std::move(edge));
      }
    }
  }
  for (const int n : voxels) {  // rings without a node
    if (node_of[n] >= 0 || is_used[n] != 0) continue;
    SkeletonEdge ring;
    for (const int w : follow(-1, n)) ring.point.push_back(grid.centre(w));
    graph.edges.push_back(std::move(ring));
  }
  // A voxel beside a cluster that leads back to it is no ring.
  std::erase_if(graph.edges, [](const SkeletonEdge& edge) {
    return edge.node[0] >= 0 && edge.node[0] == edge.node[1] && edge.point.size() <= 3;
  });
  for (SkeletonEdge& edge : graph.edges) {
    if (edge.node[0] < 0) continue;
    edge.point.insert(edge.point.begin(), graph.node[edge.node[0]]);
    edge.point.push_back(graph.node[edge.node[1]]);
  }
  return graph;
}

// Length outside of the ball about `start` over which the solid keeps its depth: without the runs
// to a corner or an edge.
double even_length(const SolidGrid& grid, const SkeletonEdge& edge, const Vec3& start,
                   double radius) {
  const std::size_t n = edge.point.size();
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    if ((edge.point[i] - start).norm() < radius) continue;
    const std::size_t a = i < 2 ? 0 : i - 2, b = std::min(n - 1, i + 3);
    double way = 0.0;
    for (std::size_t k = a; k < b; ++k) way += (edge.point[k + 1] - edge.point[k]).norm();
    const double gain = grid.depth_at(edge.point[b]) - grid.depth_at(edge.point[a]);
    if (std::abs(gain) < kCorner * way) sum += (edge.point[i + 1] - edge.point[i]).norm();
  }
  return sum;
}

// Whether the solid becomes thicker again along a line from `start`: the line leads through a neck
// to a knob. Towards a corner, an edge or a flat end it only becomes thinner.
bool leads_to_knob(const SolidGrid& grid, const SkeletonEdge& edge, int start) {
  double thinnest = std::numeric_limits<double>::infinity();
  const std::size_t n = edge.point.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double depth = grid.depth_at(edge.point[edge.node[0] == start ? i : n - 1 - i]);
    if (depth >= kKnobDepth && depth >= kRegrown * thinnest && depth >= thinnest + grid.spacing) {
      return true;
    }
    thinnest = std::min(thinnest, depth);
  }
  return false;
}

std::vector<int> degrees(const SkeletonGraph& graph) {
  std::vector<int> degree(graph.node.size(), 0);
  for (const SkeletonEdge& e : graph.edges) {
    for (const int n : e.node) {
      if (n >= 0) ++degree[n];
    }
  }
  return degree;
}

// Joins the two lines at every node that has no other.
void join_lines(SkeletonGraph& graph) {
  bool has_changed = true;
  while (has_changed) {
    has_changed = false;
    const std::vector<int> degree = degrees(graph);
    for (std::size_t n = 0; n < degree.size() && !has_changed; ++n) {
      if (degree[n] != 2) continue;
      std::vector<std::size_t> at;
      for (std::size_t e = 0; e < graph.edges.size(); ++e) {
        const auto& node = graph.edges[e].node;
        if (node[0] == static_cast<int>(n) || node[1] == static_cast<int>(n)) at.push_back(e);
      }
      if (at.size() == 1) {  // a ring that begins and ends here
        SkeletonEdge& ring = graph.edges[at[0]];
        if (ring.point.size() > 1) ring.point.pop_back();
        ring.node = {-1, -1};
      } else {
        SkeletonEdge a = graph.edges[at[0]], b = graph.edges[at[1]];
        if (a.node[1] != static_cast<int>(n)) {
          std::reverse(a.point.begin(), a.point.end());
          std::swap(a.node[0], a.node[1]);
        }
        if (b.node[0] != static_cast<int>(n)) {
          std::reverse(b.point.begin(), b.point.end());
          std::swap(b.node[0], b.node[1]);
        }
        a.point.insert(a.point.end(), b.point.begin() + 1, b.point.end());
        a.node[1] = b.node[1];
        graph.edges[at[0]] = std::move(a);
        graph.edges.erase(graph.edges.begin() + static_cast<std::ptrdiff_t>(at[1]));
      }
      graph.node_radius[n] = 0.0;
      has_changed = true;
    }
  }
}

// Drops the line to a tip that is most clearly no more than a corner of where it begins, again and
// again.
void drop_spurs(const SolidGrid& grid, SkeletonGraph& graph) {
  while (true) {
    join_lines(graph);
    const std::vector<int> degree = degrees(graph);
    int shortest = -1;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t e = 0; e < graph.edges.size(); ++e) {
      const auto& node = graph.edges[e].node;
      if (node[0] < 0 || node[0] == node[1]) continue;
      const bool is_free0 = degree[node[0]] == 1, is_free1 = degree[node[1]] == 1;
      if (is_free0 == is_free1) continue;  // inner, or the whole
      const int start = is_free0 ? node[1] : node[0];
      if (leads_to_knob(grid, graph.edges[e], start)) continue;
      const double radius = graph.node_radius[start];
      const double excess = even_length(grid, graph.edges[e], graph.node[start], radius) /
                            std::max(kFinger, kSpur * radius);
      if (excess < 1.0 && excess < least) {
        least = excess;
        shortest = static_cast<int>(e);
      }
    }
    if (shortest < 0) return;
    const std::array<int, 2> ends = graph.edges[shortest].node;
    graph.node_radius[degree[ends[0]] == 1 ? ends[0] : ends[1]] = 0.0;
    graph.edges.erase(graph.edges.begin() + shortest);
  }
}

}  // namespace

bool can_leave(std::uint32_t around) {
  struct Tables {
    std::array<std::uint32_t, 27> near26{}, near6{};
    std::uint32_t within18 = 0, faces = 0;
    Tables() {
      for (int a = 0; a < 27; ++a) {
        const std::array<int, 3> p = {a % 3, a / 3 % 3, a / 9};
        const int off = std::abs(p[0] - 1) + std::abs(p[1] - 1) + std::abs(p[2] - 1);
        if (off == 1) faces |= 1U << a;
        if (off == 1 || off == 2) within18 |= 1U << a;
        for (int b = 0; b < 27; ++b) {
          if (b == a || b == 13) continue;
          const std::array<int, 3> q = {b % 3, b / 3 % 3, b / 9};
          const int dx = std::abs(p[0] - q[0]), dy = std::abs(p[1] - q[1]),
                    dz = std::abs(p[2] - q[2]);
          if (std::max({dx, dy, dz}) == 1) near26[a] |= 1U << b;
          if (dx + dy + dz == 1) near6[a] |= 1U << b;
        }
      }
    }
  };
  static const Tables kTables;
  constexpr std::uint32_t kMiddle = 1U << 13;
  const auto grow = [](std::uint32_t seed, std::uint32_t within,
                       const std::array<std::uint32_t, 27>& near) {
    std::uint32_t part = seed, edge = seed;
    while (edge != 0) {
      std::uint32_t next = 0;
      for (std::uint32_t rest = edge; rest != 0; rest &= rest - 1) {
        next |= near[static_cast<std::size_t>(__builtin_ctz(rest))];
      }
      edge = next & within & ~part;
      part |= edge;
    }
    return part;
  };
  const std::uint32_t body = around & ~kMiddle & 0x7FFFFFFU;
  if (body == 0) return false;
  if (grow(body & (0U - body), body, kTables.near26) != body) return false;
  const std::uint32_t air = ~around & kTables.within18;
  const std::uint32_t open = air & kTables.faces;
  if (open == 0) return false;
  return (grow(open & (0U - open), air, kTables.near6) & kTables.faces) == open;
}

SkeletonGraph skeleton_of(const SolidGrid& grid) {
  if (grid.is_solid.empty()) return {};
  const std::vector<Step> steps = steps_of(grid);
  const std::vector<int> roots = roots_of(grid, steps);
  std::vector<int> tips = tips_of(grid, steps, roots);
  tips.insert(tips.end(), roots.begin(), roots.end());
  SkeletonGraph graph = trace(grid, steps, thinned(grid, steps, tips));
  drop_spurs(grid, graph);
  // Steps of the grid are smoothed away; ends stay.
  for (SkeletonEdge& edge : graph.edges) {
    const bool is_ring = edge.node[0] < 0;
    const std::size_t n = edge.point.size();
    for (int round = 0; round < 6 && n >= 3; ++round) {
      const std::vector<Vec3> old = edge.point;
      for (std::size_t i = 0; i < n; ++i) {
        if (!is_ring && (i == 0 || i + 1 == n)) continue;
        edge.point[i] = 0.25 * old[(i + n - 1) % n] + 0.5 * old[i] + 0.25 * old[(i + 1) % n];
      }
    }
    edge.radius.clear();
    for (const Vec3& p : edge.point) edge.radius.push_back(grid.depth_at(p));
  }
  return graph;
}

}  // namespace palmar::product
