// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/mesh/triangle_partition.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "palmar/core/error.h"

namespace palmar::geometry {
namespace {

struct Item {
  Eigen::Vector3f centroid;
  int triangle;
};

/// Position of the median of items [begin, end) along their longest side, after partial sorting.
int split(std::vector<Item>& items, int begin, int end) {
  if (end - begin < 2) return end;
  Eigen::AlignedBox3f box;
  for (int i = begin; i < end; ++i) box.extend(items[i].centroid);
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(items.begin() + begin, items.begin() + middle, items.begin() + end,
                   [axis](const Item& s, const Item& t) {
                     return s.centroid[axis] < t.centroid[axis] ||
                            (s.centroid[axis] == t.centroid[axis] && s.triangle < t.triangle);
                   });
  return middle;
}

template <int kWidth>
int divide(WideTrianglePartition<kWidth>& partition, std::vector<Item>& items, int begin, int end,
           int leaf_size) {
  const int index = static_cast<int>(partition.nodes.size());
  partition.nodes.emplace_back();
  std::array<int, kWidth + 1> cuts{};
  cuts[0] = begin;
  cuts[kWidth] = end;
  for (int step = kWidth; step > 1; step /= 2) {
    for (int k = 0; k < kWidth; k += step) {
      cuts[k + step / 2] = split(items, cuts[k], cuts[k + step]);
    }
  }
  for (int k = 0; k < kWidth; ++k) {
    const bool is_split = cuts[k + 1] - cuts[k] > leaf_size;
    const int child = is_split ? divide(partition, items, cuts[k], cuts[k + 1], leaf_size) : -1;
    typename WideTrianglePartition<kWidth>::Node& node = partition.nodes[index];
    node.begin[k] = cuts[k];
    node.end[k] = cuts[k + 1];
    node.child[k] = child;
  }
  return index;
}

}  // namespace

template <int kWidth>
WideTrianglePartition<kWidth> partition_triangles(const TriangleMesh& mesh, int leaf_size) {
  WideTrianglePartition<kWidth> partition;
  if (mesh.triangles.empty()) return partition;
  std::vector<Item> items(mesh.triangles.size());
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Triangle& k = mesh.triangles[t];
    const Vec3 sum = mesh.vertices[k[0]] + mesh.vertices[k[1]] + mesh.vertices[k[2]];
    items[t] = {(sum / 3.0).cast<float>(), t};
  }
  partition.nodes.reserve(items.size() / 2 + 1);
  divide(partition, items, 0, static_cast<int>(items.size()), leaf_size);
  partition.order.reserve(items.size());
  for (const Item& item : items) partition.order.push_back(item.triangle);
  return partition;
}
template WideTrianglePartition<4> partition_triangles<4>(const TriangleMesh& mesh, int leaf_size);
template WideTrianglePartition<8> partition_triangles<8>(const TriangleMesh& mesh, int leaf_size);

void check_finite_and_indexed(const TriangleMesh& mesh) {
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3& x = mesh.vertices[v];
    if (!x.allFinite()) {
      throw InputError("mesh vertex " + std::to_string(v) + ": coordinates are " +
                       std::to_string(x.x()) + ", " + std::to_string(x.y()) + ", " +
                       std::to_string(x.z()) + "; finite numbers are required");
    }
  }
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    for (const int v : mesh.triangles[t]) {
      if (v < 0 || v >= mesh.vertex_count()) {
        throw InputError("mesh triangle " + std::to_string(t) + ": corner is vertex " +
                         std::to_string(v) + "; 0 to " + std::to_string(mesh.vertex_count() - 1) +
                         " exist");
      }
    }
  }
}

}  // namespace palmar::geometry
