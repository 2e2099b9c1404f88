// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/contact/response/skin_geometry.h"
#include "palmar/contact/response/skin_patches.h"

namespace palmar::contact {

/// How far a vertex force moves the skin around it, for every vertex of a hand (Xie 2014, eq. 3-11:
/// R_Bou, and the distances that R_Gau is made of). Sparse columns: entries begin[j] to
/// begin[j + 1] - 1 are the vertices that a force at j moves, ascending, j itself included.
/// Single precision: the rounding of 6e-8 is far below every other error, and half the memory is
/// half the time.
struct ResponseColumns {
  std::vector<std::size_t> begin;    ///< vertex count + 1
  std::vector<std::int32_t> vertex;  ///< i
  std::vector<float> response;       ///< normal displacement at i times G per force at j, 1/mm
  std::vector<float> distance;       ///< on the skin, mm
};

/// The responses of a skin. Of a mesh finer than needed only those up to 8 mm stand in the columns,
/// vertex by vertex. The rest,
///
///     (1 - w(r)) f(r),   w = 1 up to 3 mm, 0 from 8 mm on, smooth between,
///
/// is smooth and acts between clusters of vertices, from and to which forces and displacements are
/// interpolated; what that gives for the pairs in the columns has been taken from them. So memory
/// and time grow with the number of vertices, not with its square (multilevel summation, Brandt,
/// Lubrecht 1990).
struct SkinResponse : ResponseColumns {
  ResponseColumns far;  ///< between clusters; empty if the columns hold everything
  // Interpolation: the clusters around each vertex, with weights that sum to 1.
  std::vector<std::size_t> support_begin;  ///< vertex count + 1
  std::vector<int> support;                ///< cluster
  std::vector<float> support_weight;

  bool has_far() const { return !far.begin.empty(); }
  std::size_t cluster_count() const { return has_far() ? far.begin.size() - 1 : 0; }
  /// w(r); 1 if there is no far part.
  double near_share(double r) const;
  /// Spreads a value at a vertex over the clusters.
  void to_clusters(std::size_t v, double value, std::vector<double>& cluster) const {
    for (std::size_t k = support_begin[v]; k < support_begin[v + 1]; ++k) {
      cluster[support[k]] += value * static_cast<double>(support_weight[k]);
    }
  }
  /// A field of the clusters at a vertex.
  double from_clusters(std::size_t v, const std::vector<double>& cluster) const {
    double sum = 0.0;
    for (std::size_t k = support_begin[v]; k < support_begin[v + 1]; ++k) {
      sum += static_cast<double>(support_weight[k]) * cluster[support[k]];
    }
    return sum;
  }
};

/// Coupled skins with more vertices than this have a far part.
constexpr int kMostFullVertices = 12'000;

/// Where two regions' skin is coupled, a force moves skin within this distance; over the last
/// third its effect is faded out. Skin farther away is held by the bones between.
constexpr double kResponseReach = 20.0;  // mm

/// Responses of a hand's skin.
///
/// RegionCoupling::kCoupled: all pairs within kResponseReach; symmetric.
/// RegionCoupling::kIndependent: within a region all pairs, symmetric, along paths inside the
/// region (the dorsum: within kResponseReach); across regions the rows within the neighbourhood of
/// the column's region (they show how the skin moves, and take no part in the solution).
///
/// `thickness` of the layer per vertex [mm] is used by TissueModel::kLayered. `only`: the vertices
/// (ascending) among which responses are wanted, of a coupled skin without a far part; null: all.
SkinResponse skin_response(const hand::Hand& hand, const SkinGeometry& skin,
                           const ContactModel& model, const std::vector<double>& thickness,
                           const std::vector<int>* only = nullptr);

/// The pairs of a skin that act on each other on it or on any skin of the same mesh up to
/// kPairMargin times smaller, and by how much the way on the skin is longer than the arc between
/// the two (arc_distance()): what hands of one mesh have in common. Columns as in ResponseColumns.
struct SkinPairs {
  std::vector<std::size_t> begin;    ///< vertex count + 1
  std::vector<std::int32_t> vertex;  ///< i
  std::vector<float> detour;         ///< way over arc
};
constexpr double kPairMargin = 1.35;  // hands of people are at most that much smaller than a mean

/// `only` as above.
SkinPairs skin_pairs(const hand::Hand& hand, const SkinGeometry& skin, const ContactModel& model,
                     const std::vector<int>* only = nullptr);

/// Responses of another hand of the same mesh: its distances on the skin are its arcs times the
/// detours of `pairs`. Of a hand's own pairs this gives skin_response() but for rounding.
SkinResponse stretched_response(const hand::Hand& hand, const SkinGeometry& skin,
                                const ContactModel& model, const std::vector<double>& thickness,
                                const SkinPairs& pairs);

/// The responses in the columns between some vertices (ascending) as a dense matrix, 1/mm; zero
/// where a pair has none. Without `across`, pairs of different regions have none.
Eigen::MatrixXd dense_response(const SkinResponse& response, const std::vector<int>& vertices,
                               const std::vector<hand::Region>& region, bool across);

}  // namespace palmar::contact
