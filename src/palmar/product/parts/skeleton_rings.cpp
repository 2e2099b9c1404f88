// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/skeleton_rings.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

namespace palmar::product {
namespace {

// A ring as the lines that it goes along, in order, and whether each is gone along backwards.
struct Way {
  std::vector<std::pair<std::size_t, bool>> edges;
  double length = 0.0;
};

double length_of_edge(const SkeletonEdge& edge) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < edge.point.size(); ++i) {
    sum += (edge.point[i + 1] - edge.point[i]).norm();
  }
  return sum;
}

// The shortest way from node `from` to node `to` without an edge (Dijkstra 1959); no edges if there
// is none.
Way shortest_way(const SkeletonGraph& graph, const std::vector<double>& length, std::size_t without,
                 int from, int to) {
  const std::size_t nodes = graph.node.size();
  std::vector<double> best(nodes, std::numeric_limits<double>::infinity());
  std::vector<std::pair<std::size_t, bool>> by(nodes);
  std::vector<char> is_done(nodes, 0);
  best[from] = 0.0;
  while (true) {
    int here = -1;
    for (std::size_t n = 0; n < nodes; ++n) {
      if (is_done[n] != 0 || !(best[n] < std::numeric_limits<double>::infinity())) continue;
      if (here < 0 || best[n] < best[here]) here = static_cast<int>(n);
    }
    if (here < 0) return {};
    if (here == to) break;
    is_done[here] = 1;
    for (std::size_t e = 0; e < graph.edges.size(); ++e) {
      if (e == without || graph.edges[e].node[0] < 0) continue;
      for (std::size_t k = 0; k < 2; ++k) {
        if (graph.edges[e].node[k] != here) continue;
        const int next = graph.edges[e].node[1 - k];
        if (best[here] + length[e] >= best[next]) continue;
        best[next] = best[here] + length[e];
        by[next] = {e, k == 1};
      }
    }
  }
  Way way;
  way.length = best[to];
  for (int n = to; n != from;) {
    const auto [e, is_backwards] = by[n];
    way.edges.emplace_back(e, is_backwards);
    n = graph.edges[e].node[is_backwards ? 1 : 0];
  }
  std::reverse(way.edges.begin(), way.edges.end());
  return way;
}

// Whether a ring is no sum (modulo 2) of those before it; then it joins them.
class Independent {
 public:
  explicit Independent(std::size_t edges) : pivot_(edges) {}

  bool add(const Way& way) {
    std::vector<char> row(pivot_.size(), 0);
    for (const auto& [e, is_backwards] : way.edges) row[e] ^= 1;
    for (std::size_t e = 0; e < row.size(); ++e) {
      if (row[e] == 0) continue;
      if (pivot_[e].empty()) {
        pivot_[e] = std::move(row);
        return true;
      }
      for (std::size_t k = e; k < row.size(); ++k) row[k] ^= pivot_[e][k];
    }
    return false;
  }

 private:
  std::vector<std::vector<char>> pivot_;
};

}  // namespace

std::vector<SkeletonRing> rings_of(const SkeletonGraph& graph) {
  std::vector<double> length;
  for (const SkeletonEdge& edge : graph.edges) length.push_back(length_of_edge(edge));
  std::vector<Way> ways;
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    const auto [a, b] = graph.edges[e].node;
    Way way;
    if (a != b) {
      way = shortest_way(graph, length, e, b, a);
      if (way.edges.empty()) continue;
    }
    way.edges.insert(way.edges.begin(), {e, false});
    way.length += length[e];
    ways.push_back(std::move(way));
  }
  std::stable_sort(ways.begin(), ways.end(),
                   [](const Way& a, const Way& b) { return a.length < b.length; });
  Independent independent(graph.edges.size());
  std::vector<SkeletonRing> rings;
  for (const Way& way : ways) {
    if (!independent.add(way)) continue;
    SkeletonRing ring;
    ring.length = way.length;
    for (const auto& [e, is_backwards] : way.edges) {
      const SkeletonEdge& edge = graph.edges[e];
      const std::size_t n = edge.point.size();
      for (std::size_t i = 0; i + 1 < n; ++i) {  // the last point is the next one's first
        const std::size_t k = is_backwards ? n - 1 - i : i;
        ring.point.push_back(edge.point[k]);
        ring.radius.push_back(edge.radius[k]);
      }
    }
    rings.push_back(std::move(ring));
  }
  return rings;
}

}  // namespace palmar::product
