// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/response/skin_response.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/contact/response/pair_response.h"
#include "palmar/core/enum_index.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/geodesic/geodesic.h"
#include "palmar/geometry/geodesic/isomap.h"

namespace palmar::contact {
namespace {

constexpr double kFarthestPair = 400.0;  // mm; no two points of a region are farther apart
constexpr int kClusters = 9'000;         // about as many as a mesh of 2.3 mm has vertices
constexpr double kAllNear = 3.0;         // mm; up to here everything is in the near part
constexpr double kAllFar = 8.0;          // mm; from here on in the far part
constexpr double kClusterWidth = 5.0;    // mm; no cluster is wider
constexpr double kSupport = 3.6;         // mm; around a vertex, for interpolation

struct Pair {
  int vertex = 0;
  float distance = 0.0F;
};
using Columns = std::vector<std::vector<Pair>>;

Columns columns_of(const geometry::GeodesicTable& table, const std::vector<int>& vertices,
                   int count) {
  Columns columns(count);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    std::vector<Pair>& column = columns[vertices[i]];
    for (int k = table.begin[i]; k < table.begin[i + 1]; ++k) {
      column.push_back({vertices[table.place[k]], static_cast<float>(table.distance[k])});
    }
  }
  return columns;
}

Columns all_within(const geometry::GeodesicSolver& solver, double reach,
                   const std::vector<int>* only = nullptr) {
  if (only != nullptr) {
    return columns_of(geometry::geodesic_table(solver, *only, reach), *only, solver.vertex_count());
  }
  std::vector<int> vertices(solver.vertex_count());
  for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] = static_cast<int>(v);
  return columns_of(geometry::geodesic_table(solver, vertices, reach), vertices,
                    solver.vertex_count());
}

/// Pairs of one region as straight lines in its flat picture (Xie 2014, A2).
void add_flat_pairs(const hand::Hand& hand, const std::vector<int>& own, Columns& columns) {
  const geometry::FlatPatch flat =
      geometry::flatten_by_isomap(geometry::edge_path_distances(hand.skin, own));
  for (std::size_t j = 0; j < own.size(); ++j) {
    std::vector<Pair>& column = columns[own[j]];
    for (std::size_t i = 0; i < own.size(); ++i) {
      const double distance = (flat.position.row(static_cast<Eigen::Index>(i)) -
                               flat.position.row(static_cast<Eigen::Index>(j)))
                                  .norm();
      column.push_back({own[i], static_cast<float>(distance)});
    }
  }
}

/// Pairs of the same region along paths inside it, and rows of other regions near a column.
Columns by_region(const hand::Hand& hand, const geometry::GeodesicSolver& solver, SkinDistance kind,
                  double margin = 1.0) {
  const int count = solver.vertex_count();
  double widest = 0.0;
  for (const hand::RegionTissue& tissue : hand.tissue.region) {
    widest = std::max(widest, tissue.neighbourhood);
  }
  Columns columns = all_within(solver, margin * widest);
  for (int j = 0; j < count; ++j) {
    const hand::Region region = hand.region[j];
    const auto reach =
        static_cast<float>(margin * hand.tissue.region[index_of(region)].neighbourhood);
    std::erase_if(columns[j], [&](const Pair& pair) {
      return hand.region[pair.vertex] == region || pair.distance > reach;
    });
  }
  for (int r = 0; r < hand::kRegionCount; ++r) {
    std::vector<int> own;
    std::vector<unsigned char> allowed(count, 0);
    for (int v = 0; v < count; ++v) {
      if (static_cast<int>(hand.region[v]) != r) continue;
      own.push_back(v);
      allowed[v] = 1;
    }
    if (own.empty()) continue;
    const bool is_dorsum = static_cast<hand::Region>(r) == hand::Region::kDorsum;
    if (kind == SkinDistance::kIsomap && !is_dorsum) {
      add_flat_pairs(hand, own, columns);
    } else {
      const geometry::GeodesicTable table = geometry::geodesic_table(
          solver, own, is_dorsum ? margin * kResponseReach : kFarthestPair, allowed);
      const Columns inside = columns_of(table, own, count);
      for (const int v : own) {
        const std::vector<Pair>& more = inside[v];
        std::vector<Pair>& column = columns[v];
        column.insert(column.end(), more.begin(), more.end());
      }
    }
    for (const int v : own) {
      std::vector<Pair>& column = columns[v];
      std::sort(column.begin(), column.end(),
                [](const Pair& a, const Pair& b) { return a.vertex < b.vertex; });
    }
  }
  return columns;
}

/// Share of a response that is near; see SkinResponse.
double share_near(double distance) {
  const double t = std::clamp((kAllFar - distance) / (kAllFar - kAllNear), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// Columns with their responses. vertex_of(k): the skin vertex that entry k stands for.
template <typename VertexOf>
ResponseColumns filled(const Columns& columns, const PairResponse& response,
                       const VertexOf& vertex_of) {
  ResponseColumns result;
  result.begin.reserve(columns.size() + 1);
  result.begin.push_back(0);
  for (const std::vector<Pair>& column : columns) {
    result.begin.push_back(result.begin.back() + column.size());
  }
  result.vertex.resize(result.begin.back());
  result.distance.resize(result.begin.back());
  result.response.resize(result.begin.back());
  constexpr int kBlock = 64;
  const int count = static_cast<int>(columns.size());
  parallel_for((count + kBlock - 1) / kBlock, [&](int block) {
    for (int j = block * kBlock; j < std::min(count, (block + 1) * kBlock); ++j) {
      std::size_t k = result.begin[j];
      for (const Pair& pair : columns[j]) {
        result.vertex[k] = pair.vertex;
        result.distance[k] = pair.distance;
        result.response[k] = response(vertex_of(pair.vertex), vertex_of(j), pair.distance);
        ++k;
      }
    }
  });
  return result;
}

/// The member of each cluster that is nearest to the cluster's centre.
std::vector<int> middles(const SkinGeometry& skin, const SkinPatches& clusters) {
  const std::vector<Vec3> centre = patch_centres(skin, clusters);
  std::vector<int> middle(centre.size(), -1);
  std::vector<double> best(centre.size(), std::numeric_limits<double>::infinity());
  for (std::size_t v = 0; v < clusters.patch.size(); ++v) {
    const int c = clusters.patch[v];
    const double d = (skin.position[v] - centre[c]).squaredNorm();
    if (d >= best[c]) continue;
    best[c] = d;
    middle[c] = static_cast<int>(v);
  }
  return middle;
}

/// Weights by which the field of the clusters is interpolated at each vertex: smooth bumps about
/// the clusters' middles, normalised (Shepard 1968).
void set_support(const SkinGeometry& skin, const SkinPatches& clusters,
                 const std::vector<int>& middle, const geometry::GeodesicTable& table,
                 SkinResponse& result) {
  result.support_begin.push_back(0);
  for (std::size_t v = 0; v < skin.position.size(); ++v) {
    const auto own = static_cast<std::size_t>(clusters.patch[v]);
    const std::size_t first = result.support.size();
    double sum = 0.0;
    for (int k = table.begin[own]; k < table.begin[own + 1]; ++k) {
      const auto c = static_cast<std::size_t>(table.place[k]);
      if (table.distance[k] > 2.0 * kSupport) continue;
      const Vec3& at = skin.position[middle[c]];
      const double t = (skin.position[v] - at).squaredNorm() / (kSupport * kSupport);
      if (t >= 1.0) continue;
      result.support.push_back(static_cast<int>(c));
      result.support_weight.push_back(static_cast<float>((1.0 - t) * (1.0 - t)));
      sum += (1.0 - t) * (1.0 - t);
    }
    if (!(sum > 1e-3)) {
      result.support.resize(first);
      result.support_weight.resize(first);
      result.support.push_back(static_cast<int>(own));
      result.support_weight.push_back(1.0F);
      sum = 1.0;
    }
    for (std::size_t k = first; k < result.support.size(); ++k) {
      result.support_weight[k] = static_cast<float>(result.support_weight[k] / sum);
    }
    result.support_begin.push_back(result.support.size());
  }
}

/// Takes from the columns what the far part, as interpolated, gives there: their pairs are exact.
void subtract_far(SkinResponse& result) {
  const int count = static_cast<int>(result.begin.size()) - 1;
  constexpr int kBlock = 256;
  parallel_for((count + kBlock - 1) / kBlock, [&](int block) {
    std::vector<double> moved(result.cluster_count(), 0.0);
    for (int v = block * kBlock; v < std::min(count, (block + 1) * kBlock); ++v) {
      const auto for_reached = [&](const auto& visit) {
        for (std::size_t s = result.support_begin[v]; s < result.support_begin[v + 1]; ++s) {
          const int c = result.support[s];
          for (std::size_t e = result.far.begin[c]; e < result.far.begin[c + 1]; ++e) {
            visit(result.far.vertex[e], static_cast<double>(result.support_weight[s]) *
                                            static_cast<double>(result.far.response[e]));
          }
        }
      };
      for_reached([&](std::size_t c, double u) { moved[c] += u; });
      for (std::size_t k = result.begin[v]; k < result.begin[v + 1]; ++k) {
        const int i = result.vertex[k];
        result.response[k] = static_cast<float>(static_cast<double>(result.response[k]) -
                                                result.from_clusters(i, moved));
      }
      for_reached([&](std::size_t c, double) { moved[c] = 0.0; });
    }
  });
}

/// Near part by vertex, far part by cluster.
SkinResponse two_level(const SkinGeometry& skin, const geometry::GeodesicSolver& solver,
                       const PairResponse& response) {
  const int count = skin.vertex_count();
  const SkinPatches clusters = skin_patches(skin, std::max(2, (count + kClusters / 2) / kClusters));
  const std::vector<int> middle = middles(skin, clusters);
  const geometry::GeodesicTable table = geometry::geodesic_table(solver, middle, kResponseReach);
  std::vector<std::vector<int>> members(middle.size());
  for (int v = 0; v < count; ++v) {
    members[clusters.patch[v]].push_back(v);
  }
  Columns near(count);
  Columns far(middle.size());
  for (std::size_t c = 0; c < middle.size(); ++c) {
    for (int k = table.begin[c]; k < table.begin[c + 1]; ++k) {
      const auto other = static_cast<std::size_t>(table.place[k]);
      const double between = table.distance[k];
      if (between > kAllNear)
        far[c].push_back({static_cast<int>(other), static_cast<float>(between)});
      if (between > kAllFar + kClusterWidth) continue;
      for (const int j : members[c]) {
        for (const int i : members[other]) {
          const Vec3& x = skin.position[i];
          if ((x - skin.position[j]).squaredNorm() >= kAllFar * kAllFar) {
            continue;
          }
          // So near, the formula is as good as a path; the smaller number first, so that both
          // directions round alike.
          const double r = i == j ? 0.0 : arc_distance(skin, std::min(i, j), std::max(i, j));
          if (r >= kAllFar) continue;
          near[j].push_back({i, static_cast<float>(r)});
        }
      }
    }
  }
  for (std::vector<Pair>& column : near) {
    std::sort(column.begin(), column.end(),
              [](const Pair& a, const Pair& b) { return a.vertex < b.vertex; });
  }
  SkinResponse result;
  static_cast<ResponseColumns&>(result) = filled(near, response, [](int v) { return v; });
  result.far = filled(far, response, [&](int c) { return middle[c]; });
  for (std::size_t k = 0; k < result.far.response.size(); ++k) {
    result.far.response[k] *= static_cast<float>(1.0 - share_near(result.far.distance[k]));
  }
  set_support(skin, clusters, middle, table, result);
  subtract_far(result);
  return result;
}

}  // namespace

SkinResponse skin_response(const hand::Hand& hand, const SkinGeometry& skin,
                           const ContactModel& model, const std::vector<double>& thickness,
                           const std::vector<int>* only) {
  const geometry::GeodesicSolver solver(hand.skin);
  const PairResponse response(hand, skin, model, thickness);
  const bool is_coupled = model.coupling == RegionCoupling::kCoupled;
  if (is_coupled && skin.vertex_count() > kMostFullVertices) {
    return two_level(skin, solver, response);
  }
  const Columns columns = is_coupled ? all_within(solver, kResponseReach, only)
                                     : by_region(hand, solver, model.distance);
  SkinResponse result;
  static_cast<ResponseColumns&>(result) = filled(columns, response, [](int v) { return v; });
  return result;
}

SkinPairs skin_pairs(const hand::Hand& hand, const SkinGeometry& skin, const ContactModel& model,
                     const std::vector<int>* only) {
  const geometry::GeodesicSolver solver(hand.skin);
  const Columns columns = model.coupling == RegionCoupling::kCoupled
                              ? all_within(solver, kPairMargin * kResponseReach, only)
                              : by_region(hand, solver, model.distance, kPairMargin);
  SkinPairs pairs;
  pairs.begin.reserve(columns.size() + 1);
  pairs.begin.push_back(0);
  for (const std::vector<Pair>& column : columns) {
    pairs.begin.push_back(pairs.begin.back() + column.size());
  }
  pairs.vertex.resize(pairs.begin.back());
  pairs.detour.resize(pairs.begin.back());
  parallel_for(static_cast<int>(columns.size()), [&](int j) {
    std::size_t k = pairs.begin[j];
    for (const Pair& pair : columns[j]) {
      const double arc = arc_distance(skin, pair.vertex, j);
      pairs.vertex[k] = pair.vertex;
      pairs.detour[k] = arc > 0.0 ? static_cast<float>(pair.distance / arc) : 1.0F;
      ++k;
    }
  });
  return pairs;
}

double SkinResponse::near_share(double r) const { return has_far() ? share_near(r) : 1.0; }

Eigen::MatrixXd dense_response(const SkinResponse& response, const std::vector<int>& vertices,
                               const std::vector<hand::Region>& region, bool across) {
  const auto m = static_cast<Eigen::Index>(vertices.size());
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(m, m);
  for (Eigen::Index j = 0; j < m; ++j) {
    const int v = vertices[j];
    Eigen::Index i = 0;
    for (std::size_t k = response.begin[v]; k < response.begin[v + 1]; ++k) {
      while (i < m && vertices[i] < response.vertex[k]) ++i;
      if (i == m) break;
      if (vertices[i] != response.vertex[k]) continue;
      if (across || region[response.vertex[k]] == region[v]) {
        R(i, j) = response.response[k];
      }
    }
  }
  return R;
}

}  // namespace palmar::contact
