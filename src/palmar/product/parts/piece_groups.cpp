// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/piece_groups.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "palmar/product/parts/node_tree.h"

namespace palmar::product {
namespace {

constexpr double kStubLength = 2.0;  // depths of the body: its far side is one away
// One part's hull reaches at most this far beyond the solid, mm: half a finger (16 mm thick at the
// distal joint of the index finger of women, Greiner 1991) can't sink in deeper; or, of something
// large, a share of its depth: a shallow saddle.
constexpr double kHollow = 8.0, kHollowShare = 0.4;
// Between a limb and what it stands on: less than any gap that a finger enters.
constexpr double kHollowAtLimb = 5.0;
// Area of a border by the square of the smaller depth from which on it is wide: half as much again
// as the square section of a bar. Choice.
constexpr double kWideBorder = 6.0;
constexpr double kSheetBorder = 16.0;  // the same of a board or sheet: four thicknesses wide
// mm; less than a finger's breadth: belongs to what it is on.
constexpr double kSmallestPart = 15.0;

double limit_of(const PartRegion& region) {
  return std::max(kHollow, kHollowShare * region.deepest);
}

// A line more than a tree of these nodes has closes a ring.
bool has_ring(const SkeletonPieces& skeleton) {
  NodeTree tree(skeleton.nodes);
  bool result = false;
  for (const SkeletonPiece& p : skeleton.pieces) {
    if (p.node[0] < 0) {
      result = true;
    } else if (p.point.size() > 1) {
      result = tree.join(p.node[0], p.node[1]) || result;
    }
    for (const int n : p.passed) result = tree.join(p.node[0], n) || result;
  }
  return result;
}

class Grouping {
 public:
  Grouping(const SolidGrid& grid, const SkeletonPieces& skeleton, const PartRegions& regions)
      : grid_(grid), skeleton_(skeleton), regions_(regions), border_(regions.border) {
    const int count = piece_count();
    groups_.region = regions.region;
    groups_.group.resize(count);
    std::iota(groups_.group.begin(), groups_.group.end(), 0);
    for (int p = 0; p < count; ++p) {
      for (const int n : piece(p).node) {
        if (n >= 0) groups_.at_node[n].push_back(p);
      }
      for (const int n : piece(p).passed) groups_.at_node[n].push_back(p);
    }
    for (const auto& [node, at] : groups_.at_node) {
      for (std::size_t a = 0; a < at.size(); ++a) {
        for (std::size_t b = a + 1; b < at.size(); ++b) {
          if (at[a] == at[b]) continue;
          groups_.joints.push_back({std::min(at[a], at[b]), std::max(at[a], at[b]),
                                    is_limb_at(at[a], node) || is_limb_at(at[b], node)});
        }
      }
    }
  }

  // All of it at once, if the whole is convex and no limb stands out.
  void join_whole() {
    PartRegion whole;
    bool is_first = true;
    for (const PartRegion& r : groups_.region) {
      if (r.count == 0.0) continue;
      whole = is_first ? r : united(whole, r);
      is_first = false;
    }
    if (is_first || has_ring(skeleton_)) return;
    if (hollowness_of(whole, limit_of(whole)) > limit_of(whole)) return;
    for (int p = 1; p < piece_count(); ++p) merge(0, groups_.group[p]);
  }

  // The run-out of a body towards a limb belongs to the body, though the limb's root stands out.
  void join_stubs() {
    for (int p = 0; p < piece_count(); ++p) {
      const SkeletonPiece& stub = piece(p);
      if (stub.radius.empty() || stub.is_thick[0] == stub.is_thick[1]) continue;
      const double deepest = *std::max_element(stub.radius.begin(), stub.radius.end());
      if (stub.length > kStubLength * deepest) continue;
      int host = -1;
      for (const int other : groups_.at_node[stub.node[stub.is_thick[0] ? 1 : 0]]) {
        const int g = groups_.group[other];
        if (g == groups_.group[p]) continue;
        if (host < 0 || groups_.region[g].deepest > groups_.region[host].deepest) host = g;
      }
      if (host >= 0 && groups_.region[host].deepest > 0.7 * deepest) {
        merge(groups_.group[p], host);
      }
    }
  }

  // Whatever is nearly convex together, the most convex first.
  void join_convex() {
    while (true) {
      double best = 1.0;  // hollowness as a share of what is allowed
      std::pair<int, int> chosen(-1, -1);
      for (const auto& [a, b] : neighbours()) {
        const double share = hollow_share(a, b);
        if (share < best) {
          best = share;
          chosen = {a, b};
        }
      }
      if (chosen.first < 0) return;
      merge(chosen.first, chosen.second);
    }
  }

  // A neck on which no finger has room belongs to that side of it with which it is more convex.
  void join_necks() {
    for (int p = 0; p < piece_count(); ++p) {
      const SkeletonPiece& neck = piece(p);
      if (groups_.group[p] != p || neck.node[0] < 0 || neck.is_free[0] || neck.is_free[1]) continue;
      if (std::count(groups_.group.begin(), groups_.group.end(), p) != 1) continue;
      double length = neck.length;  // without what is within the parts at its ends
      for (std::size_t k = 0; k < 2; ++k) {
        if (!neck.is_cut[k]) length -= k == 0 ? neck.radius.front() : neck.radius.back();
      }
      if (length >= kSmallestPart) continue;
      int host = -1;
      double least = std::numeric_limits<double>::infinity();
      for (const PieceJoint& joint : groups_.joints) {
        const auto [a, b] = groups_of(joint);
        if (a == b || (a != p && b != p)) continue;
        const int other = a == p ? b : a;
        constexpr double kFarthest = 40.0;  // mm
        const double hollow =
            hollowness_of(united(groups_.region[p], groups_.region[other]), kFarthest);
        if (hollow < least) {
          least = hollow;
          host = other;
        }
      }
      if (host >= 0) merge(p, host);
    }
  }

  // What is smaller than a finger belongs to the largest that it touches.
  void join_small() {
    while (true) {
      int small = -1, host = -1;
      for (int p = 0; p < piece_count() && small < 0; ++p) {
        const PartRegion& region = groups_.region[p];
        if (groups_.group[p] != p || region.count == 0.0) continue;
        double largest = 0.0;
        for (std::size_t d = 0; d < region.low.size(); ++d) {
          largest = std::max(largest, region.high[d] - region.low[d]);
        }
        if (largest >= kSmallestPart) continue;
        for (const PieceJoint& joint : groups_.joints) {
          const auto [a, b] = groups_of(joint);
          if (a == b || (a != p && b != p)) continue;
          const int other = a == p ? b : a;
          if (host < 0 || groups_.region[other].count > groups_.region[host].count) host = other;
        }
        if (host >= 0) small = p;
      }
      if (small < 0) return;
      merge(small, host);
    }
  }

  PieceGroups result() && { return std::move(groups_); }

 private:
  const SkeletonPiece& piece(int p) const { return skeleton_.pieces[p]; }
  int piece_count() const { return static_cast<int>(skeleton_.pieces.size()); }

  bool is_limb_at(int p, int node) const {
    if (piece(p).length < 2.0 * piece(p).mean_radius()) return false;
    return (piece(p).is_cut[0] && piece(p).node[0] == node) ||
           (piece(p).is_cut[1] && piece(p).node[1] == node);
  }

  std::pair<int, int> groups_of(const PieceJoint& joint) const {
    return std::minmax({groups_.group[joint.a], groups_.group[joint.b]});
  }

  // Groups that share a node or a wide border: lines that run side by side through a plate, or
  // cross below a knob, needn't meet.
  std::set<std::pair<int, int>> neighbours() const {
    std::set<std::pair<int, int>> result;
    for (const PieceJoint& joint : groups_.joints) result.insert(groups_of(joint));
    for (const auto& [pair, area] : border_) {
      if (has_wide_border(pair.first, pair.second)) result.insert(pair);
    }
    std::erase_if(result, [](const auto& pair) { return pair.first == pair.second; });
    return result;
  }

  bool has_wide_border(int a, int b, double share = kWideBorder) const {
    const auto found = border_.find({a, b});
    if (found == border_.end()) return false;
    const double depth = std::min(groups_.region[a].deepest, groups_.region[b].deepest);
    return found->second >= share * depth * depth;
  }

  double hollowness_of(const PartRegion& region, double limit) const {
    return hollowness(grid_, regions_, region, limit);
  }

  // Hollowness of two groups together as a share of what is allowed.
  double hollow_share(int a, int b) {
    const auto [entry, is_new] = known_.try_emplace({a, b}, 0.0);
    if (is_new && groups_.region[a].count > 0.0 && groups_.region[b].count > 0.0) {
      const bool is_limb =  // a limb stays a limb, whatever else joins the two
          std::any_of(groups_.joints.begin(), groups_.joints.end(), [&](const PieceJoint& joint) {
            return joint.is_limb && groups_of(joint) == std::pair(a, b);
          });
      const PartRegion both = united(groups_.region[a], groups_.region[b]);
      double limit = is_limb ? kHollowAtLimb : limit_of(both);
      double hollow = hollowness_of(both, limit);
      if (hollow > limit && !is_limb && has_wide_border(a, b, kSheetBorder)) {
        // What a single one of them has already (the foot of a knob on one of a board's lines)
        // doesn't part what is one sheet.
        constexpr double kFarthest = 40.0;  // mm
        limit = std::max({limit, hollowness_of(groups_.region[a], kFarthest),
                          hollowness_of(groups_.region[b], kFarthest)}) +
                0.5 * grid_.spacing;
        limit = std::min(limit, kFarthest);
        hollow = hollowness_of(both, limit);
      }
      entry->second = hollow / limit;
    }
    return entry->second;
  }

  void merge(int a, int b) {
    const int keep = std::min(a, b), drop = std::max(a, b);
    groups_.region[keep] = united(groups_.region[keep], groups_.region[drop]);
    std::replace(groups_.group.begin(), groups_.group.end(), drop, keep);
    std::map<std::pair<int, int>, double> border;
    for (const auto& [pair, area] : border_) {
      const int first = pair.first == drop ? keep : pair.first;
      const int second = pair.second == drop ? keep : pair.second;
      if (first != second) border[std::minmax(first, second)] += area;
    }
    border_ = std::move(border);
    std::erase_if(known_, [&](const auto& entry) {
      const auto& [x, y] = entry.first;
      return x == keep || y == keep || x == drop || y == drop;
    });
  }

  const SolidGrid& grid_;
  const SkeletonPieces& skeleton_;
  const PartRegions& regions_;
  PieceGroups groups_;
  std::map<std::pair<int, int>, double> known_;
  std::map<std::pair<int, int>, double> border_;  // between groups, a < b; mm^2
};

}  // namespace

PieceGroups grouped_pieces(const SolidGrid& grid, const SkeletonPieces& skeleton,
                           const PartRegions& regions) {
  Grouping grouping(grid, skeleton, regions);
  grouping.join_whole();
  grouping.join_stubs();
  grouping.join_convex();
  grouping.join_necks();
  grouping.join_small();
  return std::move(grouping).result();
}

}  // namespace palmar::product
