// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/skin_response.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "palmar/contact/layered_response.h"
#include "palmar/contact/response.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/geodesic.h"
#include "palmar/geometry/isomap.h"
#include "palmar/geometry/mesh_distance.h"

namespace palmar {
namespace {

constexpr double kFarthestPair = 400.0;  // mm; no two points of a region are farther apart
constexpr double kThinnest = 1.0;        // mm of skin over bone
constexpr double kThickest = 25.0;       // mm
constexpr double kDepthSmoothing = 3.0;  // mm

struct Pair {
  int vertex = 0;
  float distance = 0.0F;
};
using Columns = std::vector<std::vector<Pair>>;

Columns columns_of(const GeodesicTable& table, const std::vector<int>& vertices, int count) {
  Columns columns(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    std::vector<Pair>& column = columns[static_cast<std::size_t>(vertices[i])];
    for (int k = table.begin[i]; k < table.begin[i + 1]; ++k) {
      column.push_back(
          {vertices[static_cast<std::size_t>(table.place[static_cast<std::size_t>(k)])],
           static_cast<float>(table.distance[static_cast<std::size_t>(k)])});
    }
  }
  return columns;
}

Columns all_within(const GeodesicSolver& solver, double reach) {
  std::vector<int> vertices(static_cast<std::size_t>(solver.vertex_count()));
  for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] = static_cast<int>(v);
  return columns_of(geodesic_table(solver, vertices, reach), vertices, solver.vertex_count());
}

/// Pairs of one region as straight lines in its flat picture (Xie 2014, A2).
void add_flat_pairs(const Hand& hand, const std::vector<int>& own, Columns& columns) {
  const FlatPatch flat = flatten_by_isomap(edge_path_distances(hand.skin, own));
  for (std::size_t j = 0; j < own.size(); ++j) {
    std::vector<Pair>& column = columns[static_cast<std::size_t>(own[j])];
    for (std::size_t i = 0; i < own.size(); ++i) {
      const double distance = (flat.position.row(static_cast<Eigen::Index>(i)) -
                               flat.position.row(static_cast<Eigen::Index>(j)))
                                  .norm();
      column.push_back({own[i], static_cast<float>(distance)});
    }
  }
}

/// Pairs of the same region along paths inside it, and rows of other regions near a column.
Columns by_region(const Hand& hand, const GeodesicSolver& solver, SkinDistance kind) {
  const int count = solver.vertex_count();
  double widest = 0.0;
  for (const RegionTissue& tissue : hand.tissue.region) {
    widest = std::max(widest, tissue.neighbourhood);
  }
  Columns columns = all_within(solver, widest);
  for (int j = 0; j < count; ++j) {
    const auto region = static_cast<std::size_t>(hand.region[static_cast<std::size_t>(j)]);
    const auto reach = static_cast<float>(hand.tissue.region[region].neighbourhood);
    std::erase_if(columns[static_cast<std::size_t>(j)], [&](const Pair& pair) {
      return static_cast<std::size_t>(hand.region[static_cast<std::size_t>(pair.vertex)]) ==
                 region ||
             pair.distance > reach;
    });
  }
  for (int r = 0; r < kRegionCount; ++r) {
    std::vector<int> own;
    std::vector<unsigned char> allowed(static_cast<std::size_t>(count), 0);
    for (int v = 0; v < count; ++v) {
      if (static_cast<int>(hand.region[static_cast<std::size_t>(v)]) != r) continue;
      own.push_back(v);
      allowed[static_cast<std::size_t>(v)] = 1;
    }
    if (own.empty()) continue;
    const bool is_dorsum = static_cast<Region>(r) == Region::kDorsum;
    if (kind == SkinDistance::kIsomap && !is_dorsum) {
      add_flat_pairs(hand, own, columns);
    } else {
      const GeodesicTable table =
          geodesic_table(solver, own, is_dorsum ? kResponseReach : kFarthestPair, allowed);
      const Columns inside = columns_of(table, own, count);
      for (const int v : own) {
        const std::vector<Pair>& more = inside[static_cast<std::size_t>(v)];
        std::vector<Pair>& column = columns[static_cast<std::size_t>(v)];
        column.insert(column.end(), more.begin(), more.end());
      }
    }
    for (const int v : own) {
      std::vector<Pair>& column = columns[static_cast<std::size_t>(v)];
      std::sort(column.begin(), column.end(),
                [](const Pair& a, const Pair& b) { return a.vertex < b.vertex; });
    }
  }
  return columns;
}

/// 1 up to two thirds of the reach, 0 beyond it.
double fade(double distance) {
  const double t = std::clamp(3.0 * (1.0 - distance / kResponseReach), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace

std::vector<double> skin_depth_over_bone(const Hand& hand, const SkinGeometry& skin) {
  const std::size_t n = skin.position.size();
  TriangleMesh bones;
  for (const Bone& bone : hand.bones) {
    const int first = static_cast<int>(bones.vertices.size());
    bones.vertices.insert(bones.vertices.end(), bone.mesh.vertices.begin(),
                          bone.mesh.vertices.end());
    for (const Triangle& t : bone.mesh.triangles) {
      bones.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  }
  if (bones.triangles.empty()) return std::vector<double>(n, kThickest);
  const MeshDistance distance(bones);
  std::vector<DistanceSample> sample(n);
  distance.sample(skin.position, kThickest, sample);
  std::vector<double> depth(n);
  for (std::size_t v = 0; v < n; ++v) {
    depth[v] = std::clamp(sample[v].distance, kThinnest, kThickest);
  }
  std::vector<double> smooth(n);
  for (std::size_t v = 0; v < n; ++v) {
    const std::array<int, 1> source = {static_cast<int>(v)};
    double sum = 0.0;
    double area = 0.0;
    for (const GrownVertex& g : grow(skin, source, kDepthSmoothing)) {
      const auto w = static_cast<std::size_t>(g.vertex);
      sum += skin.area[w] * depth[w];
      area += skin.area[w];
    }
    smooth[v] = area > 0.0 ? sum / area : depth[v];
  }
  return smooth;
}

SkinResponse skin_response(const Hand& hand, const SkinGeometry& skin, const ContactModel& model,
                           const std::vector<double>& depth) {
  const GeodesicSolver solver(hand.skin);
  const bool is_coupled = model.coupling == RegionCoupling::kCoupled;
  const Columns columns =
      is_coupled ? all_within(solver, kResponseReach) : by_region(hand, solver, model.distance);

  std::vector<const LayerKernel*> kernel;  // per vertex
  if (model.tissue == TissueModel::kLayered) {
    for (const Region region : hand.region) {
      kernel.push_back(
          &layer_kernel(hand.tissue.region[static_cast<std::size_t>(region)].poisson_layered));
    }
  }

  SkinResponse result;
  result.begin.reserve(columns.size() + 1);
  result.begin.push_back(0);
  for (const std::vector<Pair>& column : columns) {
    result.begin.push_back(result.begin.back() + column.size());
  }
  result.vertex.resize(result.begin.back());
  result.distance.resize(result.begin.back());
  result.response.resize(result.begin.back());
  constexpr int kBlock = 64;
  const int count = skin.vertex_count();
  parallel_for((count + kBlock - 1) / kBlock, [&](int block) {
    for (int j = block * kBlock; j < std::min(count, (block + 1) * kBlock); ++j) {
      std::size_t k = result.begin[static_cast<std::size_t>(j)];
      const double a_j = skin.radius[static_cast<std::size_t>(j)];
      for (const Pair& pair : columns[static_cast<std::size_t>(j)]) {
        const double r = pair.distance;
        const double a_i = skin.radius[static_cast<std::size_t>(pair.vertex)];
        double response = 0.0;
        if (model.tissue == TissueModel::kLayered) {
          const auto i = static_cast<std::size_t>(pair.vertex);
          const double h = 0.5 * (depth[i] + depth[static_cast<std::size_t>(j)]);
          response = 0.25 * (layered_response(*kernel[i], r, a_i, h) +
                             layered_response(*kernel[i], r, a_j, h) +
                             layered_response(*kernel[static_cast<std::size_t>(j)], r, a_i, h) +
                             layered_response(*kernel[static_cast<std::size_t>(j)], r, a_j, h));
        } else {
          response = boussinesq_response(model.kernel, r, a_i, a_j);
        }
        result.vertex[k] = pair.vertex;
        result.distance[k] = pair.distance;
        result.response[k] = static_cast<float>((is_coupled ? fade(r) : 1.0) * response);
        ++k;
      }
    }
  });
  return result;
}

Eigen::MatrixXd dense_response(const SkinResponse& response, const std::vector<int>& vertices,
                               const std::vector<Region>& region, bool across) {
  const auto m = static_cast<Eigen::Index>(vertices.size());
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(m, m);
  for (Eigen::Index j = 0; j < m; ++j) {
    const auto v = static_cast<std::size_t>(vertices[static_cast<std::size_t>(j)]);
    Eigen::Index i = 0;
    for (std::size_t k = response.begin[v]; k < response.begin[v + 1]; ++k) {
      while (i < m && vertices[static_cast<std::size_t>(i)] < response.vertex[k]) ++i;
      if (i == m) break;
      if (vertices[static_cast<std::size_t>(i)] != response.vertex[k]) continue;
      if (across || region[static_cast<std::size_t>(response.vertex[k])] == region[v]) {
        R(i, j) = response.response[k];
      }
    }
  }
  return R;
}

}  // namespace palmar
