// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/prepared/sub_active_region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "palmar/contact/response/response.h"
#include "palmar/core/enum_index.h"

namespace palmar::contact {
namespace {

/// Calls visit(i, j, e) for the entries e of the response among the vertices of a sub-active
/// region; i, j: their places in it.
template <typename Visit>
void for_pairs(const PreparedHand::Impl& prepared, const SubActiveRegion& part,
               const Visit& visit) {
  const SkinResponse& response = prepared.response;
  for (std::size_t j = 0; j < part.vertex.size(); ++j) {
    const int v = part.vertex[j];
    std::size_t i = 0;
    for (std::size_t e = response.begin[v]; e < response.begin[v + 1]; ++e) {
      while (i < part.vertex.size() && part.vertex[i] < response.vertex[e]) ++i;
      if (i == part.vertex.size()) break;
      if (part.vertex[i] != response.vertex[e]) continue;
      visit(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j), e);
    }
  }
}

}  // namespace

void find_skin_as_printed(const hand::Hand& hand, const std::vector<Vec3>& posed,
                          const geometry::DistanceField& product, std::optional<hand::Region> only,
                          SkinOnProduct& skin) {
  skin.begin(hand, posed);
  for (std::size_t v = 0; v < posed.size(); ++v) {
    skin.sample[v] = {kNearRange, posed[v], Vec3::UnitZ(), -1};
    if (only && hand.region[v] != *only) continue;
    skin.near.push_back(static_cast<int>(v));
  }
  sample_vertices(product, posed, skin.near, std::numeric_limits<double>::infinity(), skin.sample);
  for (const int v : skin.near) {
    if (!(skin.sample[v].distance < 0.0)) continue;
    (hand.region[v] == hand::Region::kDorsum ? skin.left_out : skin.collision).push_back(v);
  }
  if (skin.left_out.empty()) return;
  skin.message = std::to_string(skin.left_out.size()) +
                 " vertices of the dorsum are in the product; Xie 2014 has no region there, and "
                 "they carry no force";
}

int neighbour_rings(double range, double mean_edge) {
  return std::max(1, static_cast<int>(std::lround(range / mean_edge)));
}

std::vector<int> active_region(const hand::Hand& hand, const SkinGeometry& skin,
                               const std::vector<int>& collision) {
  const double mean_edge = std::accumulate(skin.edge_length.begin(), skin.edge_length.end(), 0.0) /
                           static_cast<double>(skin.edge_length.size());
  // Rings that are left to go from each vertex; -1: not in the region.
  std::vector<int> left(skin.position.size(), -1);
  int most = 0;
  for (const int v : collision) {
    left[v] =
        neighbour_rings(hand.tissue.region[index_of(hand.region[v])].neighbourhood, mean_edge);
    most = std::max(most, left[v]);
  }
  for (int rings = most; rings > 0; --rings) {
    for (int v = 0; v < skin.vertex_count(); ++v) {
      if (left[v] != rings) continue;
      for (const int w : skin.neighbours(v)) left[w] = std::max(left[w], rings - 1);
    }
  }
  std::vector<int> active;
  for (int v = 0; v < skin.vertex_count(); ++v) {
    if (left[v] >= 0 && hand.region[v] != hand::Region::kDorsum) active.push_back(v);
  }
  return active;
}

hand::StiffeningLaw printed_law(const hand::RegionTissue& tissue, hand::TissueLevel level) {
  hand::StiffeningLaw law = hand::law_at(tissue.half_space, level);
  law.g0 = tissue.half_space.low.g0;
  return law;
}

std::vector<SubActiveRegion> sub_active_regions(const PreparedHand::Impl& prepared,
                                                const SkinOnProduct& skin, hand::TissueLevel level,
                                                std::optional<double> shear_modulus) {
  std::array<SubActiveRegion, hand::kRegionCount> parts;
  for (const int v : active_region(*prepared.hand, prepared.skin, skin.collision)) {
    SubActiveRegion& part = parts[index_of(prepared.hand->region[v])];
    part.region = prepared.hand->region[v];
    part.vertex.push_back(v);
    part.d_max = std::max(part.d_max, -skin.sample[v].distance);
  }
  std::vector<SubActiveRegion> result;
  for (SubActiveRegion& part : parts) {
    if (!(part.d_max > 0.0)) continue;
    const hand::RegionTissue& tissue = prepared.tissue(part.region);
    const hand::StiffeningLaw law = printed_law(tissue, level);
    part.shear_modulus = shear_modulus.value_or(shear_modulus_at(law, part.d_max));
    part.swelling = tissue.swelling_height * law.g0 / part.shear_modulus;
    result.push_back(std::move(part));
  }
  return result;
}

ContactProblem printed_problem(const PreparedHand::Impl& prepared, const SubActiveRegion& part,
                               const SkinOnProduct& skin) {
  const hand::RegionTissue& tissue = prepared.tissue(part.region);
  const auto m = static_cast<Eigen::Index>(part.vertex.size());
  ContactProblem problem{Eigen::MatrixXd::Zero(m, m), Eigen::VectorXd(m)};
  for (Eigen::Index i = 0; i < m; ++i) {
    problem.distance[i] = skin.sample[part.vertex[i]].distance;
  }
  const SkinResponse& response = prepared.response;
  for_pairs(prepared, part, [&](Eigen::Index i, Eigen::Index j, std::size_t e) {
    double entry = static_cast<double>(response.response[e]) / part.shear_modulus;
    if (!(problem.distance[i] < 0.0)) {
      entry -= part.swelling * gaussian_response(static_cast<double>(response.distance[e]),
                                                 tissue.swelling_radius, tissue.swelling_width);
    }
    problem.response(i, j) = entry;
  });
  return problem;
}

Eigen::VectorXd printed_bulge(const PreparedHand::Impl& prepared, const SubActiveRegion& part,
                              const SkinOnProduct& skin, const Eigen::VectorXd& force) {
  const hand::RegionTissue& tissue = prepared.tissue(part.region);
  Eigen::VectorXd bulge = Eigen::VectorXd::Zero(force.size());
  for_pairs(prepared, part, [&](Eigen::Index i, Eigen::Index j, std::size_t e) {
    if (skin.sample[part.vertex[i]].distance < 0.0 || !(force[j] > 0.0)) return;
    bulge[i] += part.swelling * force[j] *
                gaussian_response(static_cast<double>(prepared.response.distance[e]),
                                  tissue.swelling_radius, tissue.swelling_width);
  });
  return bulge;
}

std::vector<double> contact_triangles(const std::vector<Vec3>& positions,
                                      const std::vector<Triangle>& triangles,
                                      const std::vector<double>& force) {
  std::vector<double> area(positions.size(), 0.0);
  for (const Triangle& t : triangles) {
    int loaded = 0;
    for (const int v : t) loaded += force[v] > 0.0;
    if (loaded == 0) continue;
    const double whole =
        0.5 * (positions[t[1]] - positions[t[0]]).cross(positions[t[2]] - positions[t[0]]).norm();
    for (const int v : t) {
      if (force[v] > 0.0) area[v] += whole / loaded;
    }
  }
  return area;
}

}  // namespace palmar::contact
