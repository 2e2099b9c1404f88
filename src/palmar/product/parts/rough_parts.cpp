// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/rough_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/product/parts/node_tree.h"
#include "palmar/product/parts/piece_groups.h"

namespace palmar::product {
namespace {

// One ball per third of a depth is enough.
std::vector<SolidBall> balls_of(const std::vector<SkeletonPiece>& pieces) {
  std::vector<SolidBall> balls;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const SkeletonPiece& piece = pieces[p];
    double way = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < piece.point.size(); ++i) {
      if (i > 0) way += (piece.point[i] - piece.point[i - 1]).norm();
      if (way < 0.33 * piece.radius[i] && i + 1 < piece.point.size()) continue;
      way = 0.0;
      balls.push_back({piece.point[i], piece.radius[i], static_cast<int>(p)});
    }
  }
  return balls;
}

// The longest way through pieces, in order; nothing if much is beside it.
class LongestWay {
 public:
  LongestWay(const std::vector<SkeletonPiece>& pieces, const std::vector<int>& mine)
      : pieces_(pieces), mine_(mine), is_on_(pieces.size(), 0) {}

  std::vector<int> find() {
    double together = 0.0;
    for (const int p : mine_) together += pieces_[p].length;
    if (mine_.size() == 1) {
      best_ = mine_;
      best_length_ = together;
    } else {
      for (const int p : mine_) {
        for (const int n : pieces_[p].node) {
          if (n >= 0) go(n, 0.0);
        }
      }
    }
    if (best_length_ < 0.75 * together || together == 0.0) return {};
    return best_;
  }

 private:
  void go(int node, double length) {
    if (length > best_length_) {
      best_length_ = length;
      best_ = way_;
    }
    if (++tries_ > 20000) return;  // of a plate with many lines none is the line
    for (const int p : mine_) {
      const SkeletonPiece& piece = pieces_[p];
      if (is_on_[p] != 0 || piece.node[0] < 0) continue;
      for (std::size_t k = 0; k < 2; ++k) {
        if (piece.node[k] != node) continue;
        is_on_[p] = 1;
        way_.push_back(p);
        go(piece.node[1 - k], length + piece.length);
        way_.pop_back();
        is_on_[p] = 0;
        if (piece.node[0] == piece.node[1]) break;
      }
    }
  }

  const std::vector<SkeletonPiece>& pieces_;
  const std::vector<int>& mine_;
  std::vector<char> is_on_;
  std::vector<int> way_, best_;
  double best_length_ = -1.0;
  int tries_ = 0;
};

// Pieces one after the other as one.
SkeletonPiece joined_line(const std::vector<SkeletonPiece>& pieces, const std::vector<int>& way) {
  SkeletonPiece line;
  for (std::size_t i = 0; i < way.size(); ++i) {
    SkeletonPiece piece = pieces[way[i]];
    bool is_backwards = false;
    if (i > 0) {
      is_backwards = piece.node[0] != line.node[1];
    } else if (way.size() > 1) {
      const auto& next = pieces[way[1]].node;
      is_backwards = piece.node[1] != next[0] && piece.node[1] != next[1];
    }
    if (is_backwards) {
      std::reverse(piece.point.begin(), piece.point.end());
      std::reverse(piece.radius.begin(), piece.radius.end());
      std::swap(piece.node[0], piece.node[1]);
      std::swap(piece.is_free[0], piece.is_free[1]);
    }
    if (i == 0) {
      line.node[0] = piece.node[0];
      line.is_free[0] = piece.is_free[0];
    }
    line.node[1] = piece.node[1];
    line.is_free[1] = piece.is_free[1];
    const std::ptrdiff_t skip = i == 0 ? 0 : 1;
    line.point.insert(line.point.end(), piece.point.begin() + skip, piece.point.end());
    line.radius.insert(line.radius.end(), piece.radius.begin() + skip, piece.radius.end());
  }
  return line;
}

// Whether two nodes are connected without the pieces of a part.
bool are_joined_without(int part, int from, int to, const SkeletonPieces& skeleton,
                        const std::vector<int>& part_of) {
  NodeTree tree(skeleton.nodes);
  for (std::size_t p = 0; p < skeleton.pieces.size(); ++p) {
    const SkeletonPiece& piece = skeleton.pieces[p];
    if (part_of[p] == part || piece.node[0] < 0) continue;
    tree.join(piece.node[0], piece.node[1]);
    for (const int n : piece.passed) tree.join(n, piece.node[1]);
  }
  return tree.are_joined(from, to);
}

}  // namespace

RoughParts rough_parts(const SolidGrid& grid, const SkeletonGraph& graph, const GirthAt& girth_at) {
  const SkeletonPieces skeleton = skeleton_pieces(graph, grid.spacing, girth_at);
  const std::vector<SkeletonPiece>& pieces = skeleton.pieces;
  RoughParts result;
  if (pieces.empty()) return result;
  const int count = static_cast<int>(pieces.size());
  result.balls = balls_of(pieces);
  const PartRegions regions = part_regions(grid, result.balls, count);
  const PieceGroups groups = grouped_pieces(grid, skeleton, regions);
  // Parts, numbered in the order of their first piece.
  std::vector<int> part_of_group(count, -1), part_of(count);
  for (int p = 0; p < count; ++p) {
    const int group = groups.group[p];
    if (part_of_group[group] < 0) {
      part_of_group[group] = static_cast<int>(result.parts.size());
      RoughPart part;
      part.volume = groups.region[group].count * std::pow(grid.spacing * regions.stride, 3.0);
      result.parts.push_back(std::move(part));
    }
    part_of[p] = part_of_group[group];
  }
  for (SolidBall& ball : result.balls) ball.part = part_of[ball.part];
  for (const PieceJoint& joint : groups.joints) {
    const int a = part_of[joint.a], b = part_of[joint.b];
    if (a != b) result.joints.push_back({std::min(a, b), std::max(a, b)});
  }
  std::sort(result.joints.begin(), result.joints.end());
  result.joints.erase(std::unique(result.joints.begin(), result.joints.end()), result.joints.end());
  for (int id = 0; id < static_cast<int>(result.parts.size()); ++id) {
    RoughPart& part = result.parts[id];
    std::vector<int> mine;
    for (int p = 0; p < count; ++p) {
      if (part_of[p] == id) mine.push_back(p);
    }
    const std::vector<int> way = LongestWay(pieces, mine).find();
    if (way.empty()) continue;
    SkeletonPiece line = joined_line(pieces, way);
    part.line = std::move(line.point);
    part.radius = std::move(line.radius);
    part.is_ring = line.node[0] < 0;
    if (part.is_ring) continue;
    for (std::size_t k = 0; k < 2; ++k) {
      for (const int p : groups.at_node.at(line.node[k])) {
        if (part_of[p] != id) part.end_part[k] = part_of[p];
      }
    }
    part.is_in_loop = line.node[0] == line.node[1] ||
                      (!line.is_free[0] && !line.is_free[1] &&
                       are_joined_without(id, line.node[0], line.node[1], skeleton, part_of));
  }
  return result;
}

}  // namespace palmar::product
