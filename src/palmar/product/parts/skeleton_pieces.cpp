// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/skeleton_pieces.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "palmar/product/parts/node_tree.h"

namespace palmar::product {
namespace {

constexpr double kSteep = 0.35;      // radius per length; a bar's own taper is less (20 deg a side)
constexpr double kJump = 1.4;        // ratio of radii: a step that a finger feels as an end
constexpr double kStepVoxels = 2.0;  // voxels; steps below that are rounding
constexpr double kSheet = 8.0;       // mm radius; up to half a finger
constexpr double kShortest = 8.0;    // mm; half a finger: what is shorter isn't a part
constexpr double kStraight = 0.82;   // cosine (35 deg) between two lines that go on as one
constexpr double kAlike = 1.5;       // ratio of radii and of girths of two lines that go on as one
constexpr double kSharp = 0.64;      // cosine (50 deg): a line that turns by more within a hand's
                                     // thumb breadth on either side goes round a corner
constexpr double kTurnReach = 15.0;  // mm on either side; or 1.5 depths

double length_of(const std::vector<Vec3>& point) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < point.size(); ++i) sum += (point[i + 1] - point[i]).norm();
  return sum;
}

// Point of an edge that is `way` from one of its ends, and the radius there.
std::pair<Vec3, double> along_edge(const SkeletonEdge& edge, int end, double way) {
  const std::size_t n = edge.point.size();
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const std::size_t a = end == 0 ? i : n - 1 - i, b = end == 0 ? i + 1 : n - 2 - i;
    sum += (edge.point[b] - edge.point[a]).norm();
    if (sum >= way) return {edge.point[b], edge.radius[b]};
  }
  const std::size_t last = end == 0 ? n - 1 : 0;
  return {edge.point[last], edge.radius[last]};
}

// Lines that go straight on through a node become one.
std::vector<SkeletonPiece> linked_lines(const SkeletonGraph& graph, const GirthAt& girth_at) {
  using End = std::pair<int, int>;  // edge, end
  std::map<int, std::vector<End>> at_node;
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    for (int k = 0; k < 2; ++k) {
      const int n = graph.edges[e].node[k];
      if (n >= 0) at_node[n].push_back({static_cast<int>(e), k});
    }
  }
  std::map<End, End> link;
  for (const auto& [node, ends] : at_node) {
    if (ends.size() < 3) continue;
    struct Pair {
      double straight;
      std::size_t a, b;
    };
    std::vector<Pair> pairs;
    std::vector<Vec3> direction;
    std::vector<double> radius, girth;
    for (const auto& [e, k] : ends) {
      const auto [p, r] =
          along_edge(graph.edges[e], k, std::max(kShortest, 1.5 * graph.node_radius[node]));
      direction.push_back((p - graph.node[node]).normalized());
      radius.push_back(std::max(r, 1e-3));
      girth.push_back(std::max(1e-3, girth_at(p, direction.back())));
    }
    for (std::size_t a = 0; a < ends.size(); ++a) {
      for (std::size_t b = a + 1; b < ends.size(); ++b) {
        const double straight = -direction[a].dot(direction[b]);
        const double ratio = std::max(radius[a] / radius[b], radius[b] / radius[a]);
        // A blade is as thin as its stem, but wider.
        const double girths = std::max(radius[a], radius[b]) > kSheet
                                  ? 1.0
                                  : std::max(girth[a] / girth[b], girth[b] / girth[a]);
        if (straight >= kStraight && ratio <= kAlike && girths <= kAlike)
          pairs.push_back({straight, a, b});
      }
    }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& a, const Pair& b) { return a.straight > b.straight; });
    for (const Pair& p : pairs) {
      if (link.count(ends[p.a]) != 0 || link.count(ends[p.b]) != 0) continue;
      link[ends[p.a]] = ends[p.b];
      link[ends[p.b]] = ends[p.a];
    }
  }
  std::vector<SkeletonPiece> lines;
  std::vector<char> is_used(graph.edges.size(), 0);
  const auto walk = [&](int edge, int end) {
    SkeletonPiece line;
    line.node[0] = graph.edges[edge].node[end];
    line.is_free[0] = line.node[0] >= 0 && at_node[line.node[0]].size() == 1;
    while (true) {
      is_used[edge] = 1;
      const SkeletonEdge& e = graph.edges[edge];
      const std::size_t n = e.point.size();
      for (std::size_t i = line.point.empty() ? 0 : 1; i < n; ++i) {
        const std::size_t k = end == 0 ? i : n - 1 - i;
        line.point.push_back(e.point[k]);
        line.radius.push_back(e.radius[k]);
      }
      line.node[1] = e.node[1 - end];
      const auto next = link.find({edge, 1 - end});
      if (next == link.end() || is_used[next->second.first] != 0) break;
      line.passed.push_back(line.node[1]);
      line.passed_at.push_back(line.point.size() - 1);
      edge = next->second.first;
      end = next->second.second;
    }
    line.is_free[1] = line.node[1] >= 0 && at_node[line.node[1]].size() == 1;
    return line;
  };
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {  // those that begin somewhere, first
    for (int k = 0; k < 2; ++k) {
      if (is_used[e] == 0 && link.count({static_cast<int>(e), k}) == 0) {
        lines.push_back(walk(static_cast<int>(e), k));
      }
    }
  }
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    if (is_used[e] == 0) lines.push_back(walk(static_cast<int>(e), 0));
  }
  for (std::size_t n = 0; n < graph.node.size(); ++n) {  // balls
    if (graph.node_radius[n] <= 0.0 || at_node.count(static_cast<int>(n)) != 0) continue;
    SkeletonPiece ball;
    ball.point.push_back(graph.node[n]);
    ball.radius.push_back(graph.node_radius[n]);
    ball.node = {static_cast<int>(n), static_cast<int>(n)};
    lines.push_back(std::move(ball));
  }
  for (SkeletonPiece& line : lines) {
    // Free ends without the run to a corner of the end.
    for (std::size_t k = 0; k < 2; ++k) {
      if (!line.is_free[k]) continue;
      std::size_t drop = 0;
      double way = 0.0;
      const std::size_t n = line.point.size();
      const auto at = [&](std::size_t i) { return k == 0 ? i : n - 1 - i; };
      for (std::size_t i = 0; i + 3 < n; ++i) {
        way = 0.0;
        for (std::size_t m = i; m < i + 3; ++m) {
          way += (line.point[at(m + 1)] - line.point[at(m)]).norm();
        }
        if (line.radius[at(i + 3)] - line.radius[at(i)] < kSteep * way) break;
        drop = i + 1;
      }
      drop = std::min(drop, n > 4 ? n - 4 : 0);
      const auto first = line.point.begin();
      const auto first_radius = line.radius.begin();
      const auto count = static_cast<std::ptrdiff_t>(drop), size = static_cast<std::ptrdiff_t>(n);
      if (k == 0) {
        line.point.erase(first, first + count);
        line.radius.erase(first_radius, first_radius + count);
        for (std::size_t& i : line.passed_at) i = i > drop ? i - drop : 0;
      } else {
        line.point.erase(first + size - count, line.point.end());
        line.radius.erase(first_radius + size - count, line.radius.end());
      }
    }
    line.length = length_of(line.point);
  }
  return lines;
}

struct Cut {
  std::size_t at = 0;
  bool is_thin_after = false;
  bool is_corner = false;
};

// Where a line becomes much thinner within a short way: the thin end of each such ramp.
std::vector<Cut> cuts_of(const SkeletonPiece& line, double spacing) {
  const std::size_t n = line.point.size();
  if (line.node[0] < 0 || n < 6) return {};
  std::vector<double> way(n, 0.0), radius(n);
  for (std::size_t i = 1; i < n; ++i) {
    way[i] = way[i - 1] + (line.point[i] - line.point[i - 1]).norm();
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t a = i < 1 ? 0 : i - 1, b = std::min(n - 1, i + 1);
    double sum = 0.0;
    for (std::size_t k = a; k <= b; ++k) sum += line.radius[k];
    radius[i] = sum / static_cast<double>(b - a + 1);
  }
  const auto slope = [&](std::size_t i) {
    const std::size_t a = i < 2 ? 0 : i - 2, b = std::min(n - 1, i + 2);
    return (radius[b] - radius[a]) / std::max(1e-9, way[b] - way[a]);
  };
  std::vector<Cut> cuts;
  for (std::size_t i = 0; i < n;) {
    const double s = slope(i);
    if (std::abs(s) < kSteep) {
      ++i;
      continue;
    }
    std::size_t j = i;
    while (j + 1 < n && slope(j + 1) * s > 0.0 && std::abs(slope(j + 1)) >= kSteep) ++j;
    const bool is_falling = s < 0.0;
    const double thick = is_falling ? radius[i] : radius[j];
    const double thin = std::max(1e-3, is_falling ? radius[j] : radius[i]);
    if (thick / thin >= kJump && thick - thin >= kStepVoxels * spacing) {
      const std::size_t at = is_falling ? j : i;
      const double rest = is_falling ? way[n - 1] - way[at] : way[at];
      const bool is_to_tip = line.is_free[is_falling ? 1 : 0];
      // A flat end runs out in a ramp as well.
      if (at > 0 && at + 1 < n && (!is_to_tip || rest > std::max(kShortest, 2.0 * thin))) {
        cuts.push_back({at, is_falling, false});
      }
    }
    i = j + 1;
  }
  // A ramp may run out slowly: what is still much thicker than the limb itself belongs to what is
  // thick.
  for (std::size_t c = 0; c < cuts.size(); ++c) {
    const std::size_t from = cuts[c].is_thin_after ? cuts[c].at : (c == 0 ? 0 : cuts[c - 1].at);
    const std::size_t to =
        cuts[c].is_thin_after ? (c + 1 < cuts.size() ? cuts[c + 1].at : n - 1) : cuts[c].at;
    std::vector<double> limb(radius.begin() + static_cast<std::ptrdiff_t>(from),
                             radius.begin() + static_cast<std::ptrdiff_t>(to) + 1);
    std::nth_element(limb.begin(), limb.begin() + static_cast<std::ptrdiff_t>(limb.size() / 2),
                     limb.end());
    const double own = kJump * limb[limb.size() / 2];
    if (cuts[c].is_thin_after) {
      while (cuts[c].at + 2 < to && radius[cuts[c].at] > own) ++cuts[c].at;
    } else {
      while (cuts[c].at > from + 2 && radius[cuts[c].at] > own) --cuts[c].at;
    }
  }
  // An hourglass has two cuts close to each other: one in the middle is enough.
  std::vector<Cut> result;
  for (const Cut& cut : cuts) {
    if (!result.empty() && result.back().is_thin_after && !cut.is_thin_after &&
        way[cut.at] - way[result.back().at] < std::max(kShortest, radius[cut.at])) {
      result.back().at = (result.back().at + cut.at) / 2;
      continue;
    }
    result.push_back(cut);
  }
  return result;
}

// A ring that runs through a body (a cup with a handle) becomes a line from the deepest place of
// the body round to it.
void open_ring(SkeletonPiece& line, double spacing, int& next_node) {
  if (line.node[0] >= 0 || line.point.size() < 6) return;
  const auto deepest = std::max_element(line.radius.begin(), line.radius.end());
  const auto shallowest = std::min_element(line.radius.begin(), line.radius.end());
  if (*deepest < kJump * *shallowest || *deepest - *shallowest < kStepVoxels * spacing) return;
  const auto at = deepest - line.radius.begin();
  SkeletonPiece open = line;
  std::rotate(open.point.begin(), open.point.begin() + at, open.point.end());
  std::rotate(open.radius.begin(), open.radius.begin() + at, open.radius.end());
  open.point.push_back(open.point.front());
  open.radius.push_back(open.radius.front());
  open.node = {next_node, next_node};
  if (cuts_of(open, spacing).empty()) return;
  ++next_node;
  open.length = length_of(open.point);
  line = std::move(open);
}

// Where a line goes round a corner.
std::vector<std::size_t> corners_of(const SkeletonPiece& line) {
  const std::size_t n = line.point.size();
  std::vector<double> way(n, 0.0), cosine(n, 1.0);
  for (std::size_t i = 1; i < n; ++i) {
    way[i] = way[i - 1] + (line.point[i] - line.point[i - 1]).norm();
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double reach = std::max(kTurnReach, 1.5 * line.radius[i]);
    std::size_t a = i, b = i;
    while (a > 0 && way[i] - way[a] < reach) --a;
    while (b + 1 < n && way[b] - way[i] < reach) ++b;
    if (way[i] - way[a] < reach || way[b] - way[i] < reach) continue;
    cosine[i] = (line.point[i] - line.point[a])
                    .normalized()
                    .dot((line.point[b] - line.point[i]).normalized());
  }
  std::vector<std::size_t> corners;
  for (std::size_t i = 0; i < n;) {
    if (cosine[i] >= kSharp) {
      ++i;
      continue;
    }
    std::size_t sharpest = i;
    for (; i < n && cosine[i] < kSharp; ++i) {
      if (cosine[i] < cosine[sharpest]) sharpest = i;
    }
    corners.push_back(sharpest);
  }
  return corners;
}

// The corner belongs to the thicker of the two that meet there: the place a depth from it on the
// thinner side.
std::size_t off_corner(const SkeletonPiece& line, std::size_t corner, const GirthAt& girth_at) {
  constexpr double kThicker = 1.1;  // ratio of girths
  const std::size_t n = line.point.size();
  const auto walk = [&](bool is_forwards, double length) {
    std::size_t i = corner;
    double way = 0.0;
    while (way < length && i > 1 && i + 2 < n) {
      const std::size_t next = is_forwards ? i + 1 : i - 1;
      way += (line.point[next] - line.point[i]).norm();
      i = next;
    }
    return i;
  };
  const double radius = line.radius[corner];
  const auto girth = [&](bool is_forwards) {
    const std::size_t i = walk(is_forwards, 2.0 * radius);
    return girth_at(line.point[i], (line.point[i + 1] - line.point[i - 1]).normalized());
  };
  const double before = girth(false), after = girth(true);
  if (before > kThicker * after) return walk(true, radius);
  if (after > kThicker * before) return walk(false, radius);
  return corner;
}

// Whether a line's ends hang together without it.
std::vector<char> is_round_trip(const std::vector<SkeletonPiece>& lines, int nodes) {
  std::vector<char> result(lines.size(), 0);
  for (std::size_t own = 0; own < lines.size(); ++own) {
    if (lines[own].node[0] < 0 || lines[own].point.size() < 2) continue;
    NodeTree tree(nodes);
    for (std::size_t k = 0; k < lines.size(); ++k) {
      if (k == own || lines[k].node[0] < 0) continue;
      tree.join(lines[k].node[0], lines[k].node[1]);
      for (const int n : lines[k].passed) tree.join(n, lines[k].node[1]);
    }
    result[own] = tree.are_joined(lines[own].node[0], lines[own].node[1]) ? 1 : 0;
  }
  return result;
}

std::vector<SkeletonPiece> cut_lines(const std::vector<SkeletonPiece>& lines, double spacing,
                                     const GirthAt& girth_at, int& next_node) {
  std::vector<SkeletonPiece> pieces;
  const std::vector<char> is_round = is_round_trip(lines, next_node);
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const SkeletonPiece& line = lines[l];
    std::vector<Cut> cuts = cuts_of(line, spacing);
    if (is_round[l] == 0 && line.node[0] >= 0) {
      for (const std::size_t corner : corners_of(line)) {
        const std::size_t at = off_corner(line, corner, girth_at);
        bool is_near = at < 2 || at + 2 >= line.point.size();
        for (const Cut& cut : cuts) {
          is_near = is_near || (line.point[cut.at] - line.point[at]).norm() <
                                   std::max(kShortest, line.radius[at]);
        }
        if (!is_near) cuts.push_back({at, false, true});
      }
      std::sort(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) { return a.at < b.at; });
    }
    std::size_t begin = 0;
    for (std::size_t c = 0; c <= cuts.size(); ++c) {
      const std::size_t end = c < cuts.size() ? cuts[c].at : line.point.size() - 1;
      SkeletonPiece piece;
      piece.point.assign(line.point.begin() + static_cast<std::ptrdiff_t>(begin),
                         line.point.begin() + static_cast<std::ptrdiff_t>(end) + 1);
      piece.radius.assign(line.radius.begin() + static_cast<std::ptrdiff_t>(begin),
                          line.radius.begin() + static_cast<std::ptrdiff_t>(end) + 1);
      piece.node = {c == 0 ? line.node[0] : next_node - 1,
                    c < cuts.size() ? next_node : line.node[1]};
      piece.is_cut = {c > 0 && cuts[c - 1].is_thin_after && !cuts[c - 1].is_corner,
                      c < cuts.size() && !cuts[c].is_thin_after && !cuts[c].is_corner};
      piece.is_thick = {c > 0 && !cuts[c - 1].is_thin_after && !cuts[c - 1].is_corner,
                        c < cuts.size() && cuts[c].is_thin_after && !cuts[c].is_corner};
      piece.is_free = {c == 0 && line.is_free[0], c == cuts.size() && line.is_free[1]};
      piece.length = length_of(piece.point);
      if (c < cuts.size()) ++next_node;
      for (std::size_t k = 0; k < line.passed.size(); ++k) {
        const std::size_t at = line.passed_at[k];
        if (at >= begin && (at < end || c == cuts.size())) piece.passed.push_back(line.passed[k]);
      }
      begin = end;
      pieces.push_back(std::move(piece));
    }
  }
  return pieces;
}

}  // namespace

double SkeletonPiece::mean_radius() const {
  return std::accumulate(radius.begin(), radius.end(), 0.0) / static_cast<double>(radius.size());
}

SkeletonPieces skeleton_pieces(const SkeletonGraph& graph, double spacing,
                               const GirthAt& girth_at) {
  SkeletonPieces result;
  result.nodes = static_cast<int>(graph.node.size());
  std::vector<SkeletonPiece> lines = linked_lines(graph, girth_at);
  for (SkeletonPiece& line : lines) open_ring(line, spacing, result.nodes);
  result.pieces = cut_lines(lines, spacing, girth_at, result.nodes);
  return result;
}

}  // namespace palmar::product
