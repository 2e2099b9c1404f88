// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/bone/block_tree.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palmar::contact {
namespace {

class Dissector {
 public:
  Dissector(const geometry::TetrahedralMesh& mesh, int leaf)
      : mesh_(mesh), leaf_(static_cast<std::size_t>(leaf)), half_(mesh.vertices.size(), 0) {
    neighbour_.resize(mesh.vertices.size());
    for (const geometry::Tetrahedron& t : mesh.tetrahedra) {
      for (const int v : t) {
        for (const int w : t) {
          if (v != w) neighbour_[v].push_back(w);
        }
      }
    }
    for (std::vector<int>& list : neighbour_) {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    }
  }

  std::vector<DissectionNode> run() {
    std::vector<int> all;
    for (std::size_t v = 0; v < neighbour_.size(); ++v) {
      if (!neighbour_[v].empty()) all.push_back(static_cast<int>(v));
    }
    if (!all.empty()) split(std::move(all));
    find_later();
    return std::move(node_);
  }

 private:
  /// Adds the tree over these vertices; returns its root.
  int split(std::vector<int> vertices) {
    DissectionNode node;
    if (vertices.size() <= leaf_) {
      node.vertex = std::move(vertices);
    } else {
      Cut best;
      for (int axis = 0; axis < 3; ++axis) {
        for (const double share : {0.35, 0.5, 0.65}) {
          Cut cut = cut_at(vertices, axis, share);
          if (best.low.empty() || cut.cost < best.cost) best = std::move(cut);
        }
      }
      node.vertex = std::move(best.separator);
      vertices = {};
      if (!best.low.empty()) node.child.push_back(split(std::move(best.low)));
      if (!best.high.empty()) node.child.push_back(split(std::move(best.high)));
    }
    std::sort(node.vertex.begin(), node.vertex.end());
    node_.push_back(std::move(node));
    return static_cast<int>(node_.size()) - 1;
  }

  struct Cut {
    std::vector<int> low, high, separator;
    double cost = 0.0;
  };
  /// Halves (in any shares) and what separates them: the vertices of one half that touch the other,
  /// of the half with fewer of them. A small separator is worth an uneven cut.
  Cut cut_at(std::vector<int>& vertices, int axis, double share) {
    Cut cut;
    const auto middle = vertices.begin() +
                        static_cast<std::ptrdiff_t>(share * static_cast<double>(vertices.size()));
    std::nth_element(vertices.begin(), middle, vertices.end(), [&](int a, int b) {
      return std::pair(mesh_.vertices[a][axis], a) < std::pair(mesh_.vertices[b][axis], b);
    });
    cut.low.assign(vertices.begin(), middle);
    cut.high.assign(middle, vertices.end());
    for (const int v : cut.low) half_[v] = 1;
    for (const int v : cut.high) half_[v] = 2;
    const auto touches = [&](int v, char other) {
      return std::any_of(neighbour_[v].begin(), neighbour_[v].end(),
                         [&](int w) { return half_[w] == other; });
    };
    const auto count = [&](const std::vector<int>& part, char other) {
      return std::count_if(part.begin(), part.end(), [&](int v) { return touches(v, other); });
    };
    const bool from_low = count(cut.low, 2) <= count(cut.high, 1);
    std::vector<int>& part = from_low ? cut.low : cut.high;
    const auto first = std::stable_partition(part.begin(), part.end(),
                                             [&](int v) { return !touches(v, from_low ? 2 : 1); });
    cut.separator.assign(first, part.end());
    part.erase(first, part.end());
    for (const int v : vertices) half_[v] = 0;
    cut.cost = static_cast<double>(cut.separator.size()) / std::sqrt(share * (1.0 - share));
    return cut;
  }

  void find_later() {
    std::vector<int> order(neighbour_.size(), -1);
    std::vector<int> where(neighbour_.size(), -1);
    int count = 0;
    for (std::size_t n = 0; n < node_.size(); ++n) {
      for (const int v : node_[n].vertex) {
        order[v] = count++;
        where[v] = static_cast<int>(n);
      }
    }
    for (std::size_t n = 0; n < node_.size(); ++n) {
      DissectionNode& node = node_[n];
      std::vector<int>& later = node.later;
      for (const int v : node.vertex) {
        later.insert(later.end(), neighbour_[v].begin(), neighbour_[v].end());
      }
      for (const int c : node.child) {
        later.insert(later.end(), node_[c].later.begin(), node_[c].later.end());
      }
      std::erase_if(later, [&](int v) { return where[v] <= static_cast<int>(n); });
      std::sort(later.begin(), later.end(), [&](int a, int b) { return order[a] < order[b]; });
      later.erase(std::unique(later.begin(), later.end()), later.end());
    }
    for (int e = 0; e < mesh_.tetrahedron_count(); ++e) {
      int first = static_cast<int>(node_.size());
      for (const int v : mesh_.tetrahedra[e]) first = std::min(first, where[v]);
      node_[first].element.push_back(e);
    }
  }

  const geometry::TetrahedralMesh& mesh_;
  std::size_t leaf_;
  std::vector<std::vector<int>> neighbour_;
  std::vector<char> half_;
  std::vector<DissectionNode> node_;
};

}  // namespace

std::vector<DissectionNode> dissect(const geometry::TetrahedralMesh& mesh, int leaf) {
  return Dissector(mesh, leaf).run();
}

}  // namespace palmar::contact
