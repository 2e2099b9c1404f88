// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/rough_parts.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

#include "palmar/core/parallel.h"

namespace palmar {
namespace {

constexpr double kSteep = 0.35;      // radius per length; a bar's own taper is less (20 deg a side)
constexpr double kJump = 1.4;        // ratio of radii: a step that a finger feels as an end
constexpr double kStepVoxels = 2.0;  // voxels; steps below that are rounding
constexpr double kStubLength = 2.0;  // depths of the body: its far side is one away
constexpr double kSheet = 8.0;       // mm radius; up to half a finger
constexpr double kShortest = 8.0;    // mm; half a finger: what is shorter isn't a part
constexpr double kStraight = 0.82;   // cosine (35 deg) between two lines that go on as one
constexpr double kAlike = 1.5;       // ratio of radii and of girths of two lines that go on as one
// One part's hull reaches at most this far beyond the solid, mm: half a finger (16 mm thick at the
// distal joint of the index finger of women, Greiner 1991) can't sink in deeper; or, of something
// large, a share of its depth: a shallow saddle.
constexpr double kHollow = 8.0, kHollowShare = 0.4;
// Between a limb and what it stands on: less than any gap that a finger enters.
constexpr double kHollowAtLimb = 5.0;
constexpr double kSharp = 0.64;      // cosine (50 deg): a line that turns by more within a hand's
                                     // thumb breadth on either side goes round a corner
constexpr double kTurnReach = 15.0;  // mm on either side; or 1.5 depths
constexpr double kSmallestPart =
    15.0;  // mm; less than a finger's breadth: belongs to what it is on

struct Piece {
  std::vector<Vec3> point;
  std::vector<double> radius;
  std::array<int, 2> node = {-1, -1};             // -1: ring
  std::array<bool, 2> is_cut = {false, false};    // thinner than what goes on at that end
  std::array<bool, 2> is_thick = {false, false};  // thicker than the limb that begins at that end
  std::array<bool, 2> is_free = {false, false};
  std::vector<int> passed;             // nodes within ...
  std::vector<std::size_t> passed_at;  // ... and at which point
  double length = 0.0;
  double mean_radius() const {
    return std::accumulate(radius.begin(), radius.end(), 0.0) / static_cast<double>(radius.size());
  }
};

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
std::vector<Piece> linked_lines(const SkeletonGraph& graph, const GirthAt& girth_at) {
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
  std::vector<Piece> lines;
  std::vector<char> is_used(graph.edges.size(), 0);
  const auto walk = [&](int edge, int end) {
    Piece line;
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
    Piece ball;
    ball.point.push_back(graph.node[n]);
    ball.radius.push_back(graph.node_radius[n]);
    ball.node = {static_cast<int>(n), static_cast<int>(n)};
    lines.push_back(std::move(ball));
  }
  for (Piece& line : lines) {
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
std::vector<Cut> cuts_of(const Piece& line, double spacing) {
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
void open_ring(Piece& line, double spacing, int& next_node) {
  if (line.node[0] >= 0 || line.point.size() < 6) return;
  const auto deepest = std::max_element(line.radius.begin(), line.radius.end());
  const auto shallowest = std::min_element(line.radius.begin(), line.radius.end());
  if (*deepest < kJump * *shallowest || *deepest - *shallowest < kStepVoxels * spacing) return;
  const auto at = deepest - line.radius.begin();
  Piece open = line;
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
std::vector<std::size_t> corners_of(const Piece& line) {
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
std::size_t off_corner(const Piece& line, std::size_t corner, const GirthAt& girth_at) {
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
std::vector<char> is_round_trip(const std::vector<Piece>& lines, int nodes) {
  std::vector<char> result(lines.size(), 0);
  for (std::size_t own = 0; own < lines.size(); ++own) {
    if (lines[own].node[0] < 0 || lines[own].point.size() < 2) continue;
    std::vector<int> tree(nodes);
    std::iota(tree.begin(), tree.end(), 0);
    const auto root = [&](int n) {
      while (tree[n] != n) n = tree[n] = tree[tree[n]];
      return n;
    };
    for (std::size_t k = 0; k < lines.size(); ++k) {
      if (k == own || lines[k].node[0] < 0) continue;
      tree[root(lines[k].node[0])] = root(lines[k].node[1]);
      for (const int n : lines[k].passed) tree[root(n)] = root(lines[k].node[1]);
    }
    result[own] = root(lines[own].node[0]) == root(lines[own].node[1]) ? 1 : 0;
  }
  return result;
}

std::vector<Piece> cut_lines(const std::vector<Piece>& lines, double spacing,
                             const GirthAt& girth_at, int& next_node) {
  std::vector<Piece> pieces;
  const std::vector<char> is_round = is_round_trip(lines, next_node);
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const Piece& line = lines[l];
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
      Piece piece;
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

// Directions in which hulls are measured: primitive vectors of whole numbers up to 2.
std::vector<Vec3> hull_directions() {
  std::vector<Vec3> result;
  for (int i = -2; i <= 2; ++i) {
    for (int j = -2; j <= 2; ++j) {
      for (int k = -2; k <= 2; ++k) {
        if (std::gcd(std::gcd(i, j), k) != 1) continue;
        if (i < 0 || (i == 0 && (j < 0 || (j == 0 && k < 0)))) continue;
        result.push_back(Vec3(i, j, k).normalized());
      }
    }
  }
  return result;
}

struct Region {
  double count = 0.0;
  double deepest = 0.0;           // largest depth, mm
  std::vector<double> low, high;  // along the hull's directions, mm
};

Region united(const Region& a, const Region& b) {
  Region r = a;
  r.count += b.count;
  r.deepest = std::max(a.deepest, b.deepest);
  for (std::size_t d = 0; d < r.low.size(); ++d) {
    r.low[d] = std::min(a.low[d], b.low[d]);
    r.high[d] = std::max(a.high[d], b.high[d]);
  }
  return r;
}

// How far a region's hull (between parallel planes) reaches beyond the solid, mm; stops when it is
// more than `limit`.
double hollowness(const SolidGrid& grid, const std::vector<Vec3>& directions, const Region& region,
                  int stride, double limit) {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  for (std::size_t d = 0; d < directions.size(); ++d) {
    for (int a = 0; a < 3; ++a) {
      if (directions[d][a] == 1.0) {
        low[a] = region.low[d];
        high[a] = region.high[d];
      }
    }
  }
  std::array<int, 3> begin{}, end{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double half = 0.5 * (grid.size[a] - 1);
    begin[a] = std::max(0, static_cast<int>(std::ceil(low[a] / grid.spacing + half - 1e-6)));
    begin[a] = (begin[a] + stride - 1) / stride * stride;
    end[a] = std::min(grid.size[a] - 1,
                      static_cast<int>(std::floor(high[a] / grid.spacing + half + 1e-6)));
  }
  double deepest = 0.0;
  for (int k = begin[2]; k <= end[2]; k += stride) {
    for (int j = begin[1]; j <= end[1]; j += stride) {
      for (int i = begin[0]; i <= end[0]; i += stride) {
        const std::size_t n = grid.index(i, j, k);
        if (grid.air[n] <= deepest) continue;
        const Vec3 x = grid.centre(n);
        bool is_in = true;
        for (std::size_t d = 0; d < directions.size() && is_in; ++d) {
          const double t = directions[d].dot(x);
          is_in = t >= region.low[d] - 1e-6 && t <= region.high[d] + 1e-6;
        }
        if (is_in) deepest = grid.air[n];
        if (deepest > limit) return deepest;
      }
    }
  }
  return deepest;
}

double limit_of(const Region& region) { return std::max(kHollow, kHollowShare * region.deepest); }

}  // namespace

int nearest_part(const std::vector<SolidBall>& balls, const Vec3& point) {
  int part = -1;
  double least = std::numeric_limits<double>::infinity();
  for (const SolidBall& ball : balls) {
    const double bound = least + ball.radius;
    const double squared = (point - ball.centre).squaredNorm();
    if (bound > 0.0 && squared < bound * bound) {
      least = std::sqrt(squared) - ball.radius;
      part = ball.part;
    }
  }
  return part;
}

RoughParts rough_parts(const SolidGrid& grid, const SkeletonGraph& graph, const GirthAt& girth_at) {
  int next_node = static_cast<int>(graph.node.size());
  std::vector<Piece> lines = linked_lines(graph, girth_at);
  for (Piece& line : lines) open_ring(line, grid.spacing, next_node);
  const std::vector<Piece> pieces = cut_lines(lines, grid.spacing, girth_at, next_node);
  RoughParts result;
  if (pieces.empty()) return result;
  const int count = static_cast<int>(pieces.size());
  for (int p = 0; p < count; ++p) {
    // One ball per third of a depth is enough.
    double way = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < pieces[p].point.size(); ++i) {
      if (i > 0) way += (pieces[p].point[i] - pieces[p].point[i - 1]).norm();
      if (way < 0.33 * pieces[p].radius[i] && i + 1 < pieces[p].point.size()) continue;
      way = 0.0;
      result.balls.push_back({pieces[p].point[i], pieces[p].radius[i], p});
    }
  }
  // Which voxels are whose, in every second voxel per axis of a large grid.
  const int stride = grid.is_solid.size() > 60000 ? 2 : 1;
  const std::vector<Vec3> directions = hull_directions();
  Region nothing;
  nothing.low.assign(directions.size(), std::numeric_limits<double>::infinity());
  nothing.high.assign(directions.size(), -std::numeric_limits<double>::infinity());
  std::vector<Region> region(count, nothing);
  std::vector<std::vector<Region>> of_slice((grid.size[2] + stride - 1) / stride);
  parallel_for(static_cast<int>(of_slice.size()), [&](int slice) {
    std::vector<Region>& mine = of_slice[slice];
    mine.assign(count, nothing);
    for (int j = 0; j < grid.size[1]; j += stride) {
      for (int i = 0; i < grid.size[0]; i += stride) {
        const std::size_t n = grid.index(i, j, slice * stride);
        if (grid.is_solid[n] == 0) continue;
        const Vec3 x = grid.centre(n);
        Region& r = mine[nearest_part(result.balls, x)];
        r.count += 1.0;
        r.deepest = std::max<double>(r.deepest, grid.depth[n]);
        for (std::size_t d = 0; d < directions.size(); ++d) {
          const double t = directions[d].dot(x);
          r.low[d] = std::min(r.low[d], t);
          r.high[d] = std::max(r.high[d], t);
        }
      }
    }
  });
  for (const std::vector<Region>& slice : of_slice) {
    for (int p = 0; p < count; ++p) {
      if (slice[p].count > 0.0) region[p] = united(region[p], slice[p]);
    }
  }
  // Groups of pieces.
  std::vector<int> group(count);
  std::iota(group.begin(), group.end(), 0);
  std::map<int, std::vector<int>> at_node;
  for (int p = 0; p < count; ++p) {
    for (const int n : pieces[p].node) {
      if (n >= 0) at_node[n].push_back(p);
    }
    for (const int n : pieces[p].passed) at_node[n].push_back(p);
  }
  const auto is_limb_at = [&](int p, int node) {
    if (pieces[p].length < 2.0 * pieces[p].mean_radius()) return false;
    return (pieces[p].is_cut[0] && pieces[p].node[0] == node) ||
           (pieces[p].is_cut[1] && pieces[p].node[1] == node);
  };
  struct Joint {
    int a, b;
    bool is_limb;
  };
  std::vector<Joint> joints;
  for (const auto& [node, at] : at_node) {
    for (std::size_t a = 0; a < at.size(); ++a) {
      for (std::size_t b = a + 1; b < at.size(); ++b) {
        if (at[a] == at[b]) continue;
        joints.push_back({std::min(at[a], at[b]), std::max(at[a], at[b]),
                          is_limb_at(at[a], node) || is_limb_at(at[b], node)});
      }
    }
  }
  std::map<std::pair<int, int>, double> known;
  const auto merge = [&](int a, int b) {
    const int keep = std::min(a, b), drop = std::max(a, b);
    region[keep] = united(region[keep], region[drop]);
    for (int& g : group) {
      if (g == drop) g = keep;
    }
    std::erase_if(known, [&](const auto& entry) {
      const auto& [x, y] = entry.first;
      return x == keep || y == keep || x == drop || y == drop;
    });
  };
  // All of it at once, if the whole is convex and no limb stands out.
  Region whole = nothing;
  for (const Region& r : region) {
    if (r.count > 0.0) whole = united(whole, r);
  }
  // A line more than a tree of these nodes has closes a ring.
  std::vector<int> tree(next_node);
  std::iota(tree.begin(), tree.end(), 0);
  const auto root = [&](int n) {
    while (tree[n] != n) n = tree[n] = tree[tree[n]];
    return n;
  };
  bool has_ring = false;
  for (const Piece& p : pieces) {
    if (p.node[0] < 0) {
      has_ring = true;
    } else if (p.point.size() > 1) {
      const int a = root(p.node[0]), b = root(p.node[1]);
      has_ring = has_ring || a == b;
      tree[a] = b;
    }
    for (const int n : p.passed) {
      const int a = root(p.node[0]), b = root(n);
      has_ring = has_ring || a == b;
      tree[a] = b;
    }
  }
  if (!has_ring &&
      hollowness(grid, directions, whole, stride, limit_of(whole)) <= limit_of(whole)) {
    for (int p = 1; p < count; ++p) merge(0, group[p]);
  }
  // The run-out of a body towards a limb belongs to the body, though the limb's root stands out.
  for (int p = 0; p < count; ++p) {
    const Piece& stub = pieces[p];
    if (stub.radius.empty() || stub.is_thick[0] == stub.is_thick[1]) continue;
    const double deepest = *std::max_element(stub.radius.begin(), stub.radius.end());
    if (stub.length > kStubLength * deepest) continue;
    int host = -1;
    for (const int other : at_node[stub.node[stub.is_thick[0] ? 1 : 0]]) {
      if (group[other] == group[p]) continue;
      const int g = group[other];
      if (host < 0 || region[g].deepest > region[host].deepest) host = g;
    }
    if (host >= 0 && region[host].deepest > 0.7 * deepest) merge(group[p], host);
  }
  while (true) {
    double best = 1.0;  // hollowness as a share of what is allowed
    bool has_best = false;
    std::pair<int, int> chosen;
    for (const Joint& joint : joints) {
      const int a = std::min(group[joint.a], group[joint.b]);
      const int b = std::max(group[joint.a], group[joint.b]);
      if (a == b) continue;
      bool is_limb = false;  // a limb stays a limb, whatever else joins the two
      for (const Joint& other : joints) {
        const int c = std::min(group[other.a], group[other.b]);
        const int d = std::max(group[other.a], group[other.b]);
        is_limb = is_limb || (c == a && d == b && other.is_limb);
      }
      const auto [entry, is_new] = known.try_emplace({a, b}, 0.0);
      if (is_new) {
        const Region both = united(region[a], region[b]);
        const double limit = is_limb ? kHollowAtLimb : limit_of(both);
        entry->second = region[a].count == 0.0 || region[b].count == 0.0
                            ? 0.0
                            : hollowness(grid, directions, both, stride, limit) / limit;
      }
      if (entry->second < best) {
        best = entry->second;
        chosen = {a, b};
        has_best = true;
      }
    }
    if (!has_best) break;
    merge(chosen.first, chosen.second);
  }
  // What is smaller than a finger belongs to the largest that it touches.
  while (true) {
    int small = -1, host = -1;
    for (int p = 0; p < count && small < 0; ++p) {
      if (group[p] != p || region[p].count == 0.0) continue;
      double largest = 0.0;
      for (std::size_t d = 0; d < directions.size(); ++d) {
        largest = std::max(largest, region[p].high[d] - region[p].low[d]);
      }
      if (largest >= kSmallestPart) continue;
      for (const Joint& joint : joints) {
        const int a = group[joint.a], b = group[joint.b];
        if (a == b || (a != p && b != p)) continue;
        const int other = a == p ? b : a;
        if (host < 0 || region[other].count > region[host].count) host = other;
      }
      if (host >= 0) small = p;
    }
    if (small < 0) break;
    merge(small, host);
  }
  // Parts, numbered in the order of their first piece.
  std::vector<int> part_of_group(count, -1);
  for (int p = 0; p < count; ++p) {
    if (part_of_group[group[p]] < 0) {
      part_of_group[group[p]] = static_cast<int>(result.parts.size());
      RoughPart part;
      part.volume = region[group[p]].count * std::pow(grid.spacing * stride, 3.0);
      result.parts.push_back(std::move(part));
    }
  }
  const auto part_of = [&](int p) { return part_of_group[group[p]]; };
  for (SolidBall& ball : result.balls) ball.part = part_of(ball.part);
  for (const Joint& joint : joints) {
    const int a = part_of(joint.a), b = part_of(joint.b);
    if (a != b) result.joints.push_back({std::min(a, b), std::max(a, b)});
  }
  std::sort(result.joints.begin(), result.joints.end());
  result.joints.erase(std::unique(result.joints.begin(), result.joints.end()), result.joints.end());
  // Whether two nodes hang together without the pieces of a part.
  const auto are_joined_without = [&](int part, int from, int to) {
    if (from == to) return true;
    std::vector<int> stack(1, from);
    std::vector<char> is_seen(next_node, 0);
    is_seen[from] = 1;
    while (!stack.empty()) {
      const int node = stack.back();
      stack.pop_back();
      for (const int p : at_node[node]) {
        if (part_of(p) == part) continue;
        std::vector<int> nodes(pieces[p].node.begin(), pieces[p].node.end());
        nodes.insert(nodes.end(), pieces[p].passed.begin(), pieces[p].passed.end());
        for (const int n : nodes) {
          if (n == to) return true;
          if (is_seen[n] != 0) continue;
          is_seen[n] = 1;
          stack.push_back(n);
        }
      }
    }
    return false;
  };
  for (std::size_t id = 0; id < result.parts.size(); ++id) {
    RoughPart& part = result.parts[id];
    std::vector<int> mine;
    for (int p = 0; p < count; ++p) {
      if (part_of(p) == static_cast<int>(id)) mine.push_back(p);
    }
    // The longest way through the pieces is the line, if nothing of size is beside it.
    double together = 0.0;
    for (const int p : mine) together += pieces[p].length;
    std::vector<int> way, best;  // pieces, in order
    double best_length = -1.0;
    std::vector<char> is_on(pieces.size(), 0);
    int tries = 0;
    const std::function<void(int, double)> go = [&](int node, double length) {
      if (length > best_length) {
        best_length = length;
        best = way;
      }
      if (++tries > 20000) return;  // of a plate with many lines none is the line
      for (const int p : mine) {
        if (is_on[p] != 0 || pieces[p].node[0] < 0) continue;
        for (std::size_t k = 0; k < 2; ++k) {
          if (pieces[p].node[k] != node) continue;
          is_on[p] = 1;
          way.push_back(p);
          go(pieces[p].node[1 - k], length + pieces[p].length);
          way.pop_back();
          is_on[p] = 0;
          if (pieces[p].node[0] == pieces[p].node[1]) break;
        }
      }
    };
    if (mine.size() == 1) {
      best = mine;
      best_length = together;
    } else {
      for (const int p : mine) {
        for (const int n : pieces[p].node) {
          if (n >= 0) go(n, 0.0);
        }
      }
    }
    if (best.empty() || best_length < 0.75 * together || together == 0.0) continue;
    std::array<int, 2> ends = pieces[best.front()].node;
    std::array<bool, 2> is_free = pieces[best.front()].is_free;
    for (std::size_t i = 0; i < best.size(); ++i) {
      Piece piece = pieces[best[i]];
      const int next = i + 1 < best.size() ? best[i + 1] : -1;
      bool is_backwards = false;
      if (i > 0) {
        is_backwards = piece.node[0] != ends[1];
      } else if (next >= 0) {
        const auto& other = pieces[next].node;
        is_backwards = piece.node[1] != other[0] && piece.node[1] != other[1];
      }
      if (is_backwards) {
        std::reverse(piece.point.begin(), piece.point.end());
        std::reverse(piece.radius.begin(), piece.radius.end());
        std::swap(piece.node[0], piece.node[1]);
        std::swap(piece.is_free[0], piece.is_free[1]);
      }
      if (i == 0) {
        ends[0] = piece.node[0];
        is_free[0] = piece.is_free[0];
      }
      ends[1] = piece.node[1];
      is_free[1] = piece.is_free[1];
      const std::ptrdiff_t skip = i == 0 ? 0 : 1;
      part.line.insert(part.line.end(), piece.point.begin() + skip, piece.point.end());
      part.radius.insert(part.radius.end(), piece.radius.begin() + skip, piece.radius.end());
    }
    part.is_ring = ends[0] < 0;
    if (part.is_ring) continue;
    for (std::size_t k = 0; k < 2; ++k) {
      for (const int p : at_node[ends[k]]) {
        if (part_of(p) != static_cast<int>(id)) part.end_part[k] = part_of(p);
      }
    }
    part.is_in_loop = ends[0] == ends[1]
                          ? true
                          : !is_free[0] && !is_free[1] &&
                                are_joined_without(static_cast<int>(id), ends[0], ends[1]);
  }
  return result;
}

}  // namespace palmar
