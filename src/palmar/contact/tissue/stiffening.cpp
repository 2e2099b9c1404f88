// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/tissue/stiffening.h"

#include <algorithm>
#include <numeric>

#include "palmar/core/enum_index.h"

namespace palmar::contact {
namespace {

constexpr float kPlateau = 8.0F;     // mm
constexpr float kEnd = 16.0F;        // mm
constexpr float kBlendWidth = 6.0F;  // mm; laws of neighbouring regions are mixed over it

using Laws = std::array<hand::StiffeningLaw, 3>;  // low, nominal, high

Laws laws_of(const hand::RegionTissue& tissue, TissueModel model) {
  const hand::TissueStiffness& stiffness =
      model == TissueModel::kLayered ? tissue.layered : tissue.half_space;
  Laws laws;
  for (const hand::TissueLevel level :
       {hand::TissueLevel::kLow, hand::TissueLevel::kNominal, hand::TissueLevel::kHigh}) {
    laws[index_of(level)] = hand::law_at(stiffness, level);
  }
  return laws;
}

/// Mean of the laws around a vertex, weighted by area and nearness.
Laws blended(const hand::Hand& hand, const SkinGeometry& skin, const SkinResponse& response,
             const std::array<Laws, hand::kRegionCount>& by_region, int vertex) {
  std::array<double, hand::kRegionCount> weight{};  // of each region's law
  double weights = 0.0;
  for (std::size_t k = response.begin[vertex]; k < response.begin[vertex + 1]; ++k) {
    if (response.distance[k] >= kBlendWidth) continue;
    const int i = response.vertex[k];
    const double w = skin.area[i] * (1.0 - static_cast<double>(response.distance[k] / kBlendWidth));
    weight[index_of(hand.region[i])] += w;
    weights += w;
  }
  Laws result{};
  for (std::size_t r = 0; r < weight.size(); ++r) {
    if (weight[r] == 0.0) continue;
    for (std::size_t level = 0; level < result.size(); ++level) {
      result[level].g0 += weight[r] / weights * by_region[r][level].g0;
      result[level].g_limit += weight[r] / weights * by_region[r][level].g_limit;
      result[level].limit_depth += weight[r] / weights * by_region[r][level].limit_depth;
    }
  }
  return result;
}

std::vector<Eigen::Vector3f> centres(const SkinGeometry& skin, const SkinPatches& patches) {
  std::vector<Eigen::Vector3f> result;
  for (const Vec3& c : patch_centres(skin, patches)) result.push_back(c.cast<float>());
  return result;
}

}  // namespace

SkinStiffness skin_stiffness(const hand::Hand& hand, const SkinGeometry& skin,
                             const SkinResponse& response, const SkinPatches& spots,
                             const SkinPatches& blocks, const ContactModel& model) {
  SkinStiffness result;
  const auto count = static_cast<std::size_t>(skin.vertex_count());
  const bool has_laws = model.tissue != TissueModel::kBone;
  std::array<Laws, hand::kRegionCount> by_region;
  for (std::size_t r = 0; r < by_region.size(); ++r) {
    by_region[r] = laws_of(hand.tissue.region[r], model.tissue);
  }
  for (std::vector<hand::StiffeningLaw>& law : result.law) law.resize(has_laws ? count : 0);
  for (std::size_t v = 0; v < count && has_laws; ++v) {
    const Laws laws = model.coupling == RegionCoupling::kCoupled
                          ? blended(hand, skin, response, by_region, static_cast<int>(v))
                          : by_region[index_of(hand.region[v])];
    for (std::size_t level = 0; level < laws.size(); ++level) result.law[level][v] = laws[level];
  }
  result.finger.assign(count, -1);
  for (std::size_t v = 0; v < count && !hand.segment.empty(); ++v) {
    if (const auto finger = hand::finger_of(hand.segment[v]))
      result.finger[v] = static_cast<int>(*finger);
  }
  result.spots = spots;
  result.spot_centre = centres(skin, result.spots);
  result.spot_finger.assign(result.spot_centre.size(), -1);
  for (std::size_t v = count; v-- > 0;) {
    result.spot_finger[result.spots.patch[v]] = result.finger[v];
  }
  result.blocks = blocks;
  result.block_centre = centres(skin, blocks);
  result.block_radius.assign(result.block_centre.size(), 0.0F);
  for (std::size_t v = 0; v < count; ++v) {
    const int b = blocks.patch[v];
    const float r = (skin.position[v].cast<float>() - result.block_centre[b]).norm();
    result.block_radius[b] = std::max(result.block_radius[b], r);
  }
  return result;
}

std::vector<double> local_depth(const SkinStiffness& stiffness, const SkinGeometry& skin,
                                const std::vector<int>& vertices, const std::vector<int>& collision,
                                const std::vector<geometry::DistanceSample>& sample) {
  std::vector<float> deepest(stiffness.spots.count, 0.0F);
  std::vector<std::size_t> touched;
  for (const int v : collision) {
    const auto s = static_cast<std::size_t>(stiffness.spots.patch[v]);
    if (deepest[s] == 0.0F) touched.push_back(s);
    deepest[s] = std::max(deepest[s], static_cast<float>(-sample[v].distance));
  }
  // Vertices patch by patch, positions apart by coordinate: vector instructions.
  const std::size_t n = vertices.size();
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  const auto block_of = [&](int k) { return stiffness.blocks.patch[vertices[k]]; };
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return block_of(a) < block_of(b); });
  std::vector<float> x(n), y(n), z(n), depth(n, 0.0F);
  std::vector<int> finger(n);
  std::vector<std::size_t> first;  // of each patch
  for (std::size_t k = 0; k < n; ++k) {
    const int v = vertices[order[k]];
    x[k] = static_cast<float>(skin.position[v].x());
    y[k] = static_cast<float>(skin.position[v].y());
    z[k] = static_cast<float>(skin.position[v].z());
    finger[k] = stiffness.finger[v];
    if (k == 0 || block_of(order[k]) != block_of(order[k - 1])) first.push_back(k);
  }
  first.push_back(n);
  constexpr float kSlope = 1.0F / (kEnd * kEnd - kPlateau * kPlateau);
  for (const std::size_t s : touched) {
    const Eigen::Vector3f c = stiffness.spot_centre[s];
    const float d = deepest[s];
    const int own = stiffness.spot_finger[s];
    for (std::size_t p = 0; p + 1 < first.size(); ++p) {
      const auto b = block_of(order[first[p]]);
      const float near = kEnd + stiffness.block_radius[b];
      if ((c - stiffness.block_centre[b]).squaredNorm() > near * near) continue;
      for (std::size_t k = first[p]; k < first[p + 1]; ++k) {
        const float dx = x[k] - c.x();
        const float dy = y[k] - c.y();
        const float dz = z[k] - c.z();
        const float phi = std::min(1.0F, (kEnd * kEnd - dx * dx - dy * dy - dz * dz) * kSlope);
        // Neighbouring fingers are near each other but not of one piece.
        const bool is_apart = (own >= 0) & (finger[k] >= 0) & (own != finger[k]);
        const float reach = is_apart ? 0.0F : d * phi;
        depth[k] = std::max(depth[k], reach);
      }
    }
  }
  std::vector<double> result(n);
  for (std::size_t k = 0; k < n; ++k) {
    // A vertex's own penetration is beyond doubt; its spot's centre may be a little away.
    const int place = order[k];
    const int v = vertices[place];
    result[place] = std::max(static_cast<double>(depth[k]), -sample[v].distance);
  }
  return result;
}

}  // namespace palmar::contact
