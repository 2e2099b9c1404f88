// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/stiffening.h"

#include <algorithm>
#include <numeric>

namespace palmar {
namespace {

constexpr int kSpotSize = 6;         // vertices
constexpr float kPlateau = 8.0F;     // mm
constexpr float kEnd = 16.0F;        // mm
constexpr float kBlendWidth = 6.0F;  // mm; laws of neighbouring regions are mixed over it

/// Mean of the laws around a vertex, weighted by area and nearness.
StiffeningLaw blended(const Hand& hand, const SkinGeometry& skin, const SkinResponse& response,
                      TissueModel model, TissueLevel level, int vertex) {
  StiffeningLaw sum;
  double weights = 0.0;
  const auto j = static_cast<std::size_t>(vertex);
  for (std::size_t k = response.begin[j]; k < response.begin[j + 1]; ++k) {
    if (response.distance[k] >= kBlendWidth) continue;
    const auto i = static_cast<std::size_t>(response.vertex[k]);
    const RegionTissue& tissue = hand.tissue.region[static_cast<std::size_t>(hand.region[i])];
    const StiffeningLaw& law =
        law_at(model == TissueModel::kLayered ? tissue.layered : tissue.half_space, level);
    const double w = skin.area[i] * (1.0 - static_cast<double>(response.distance[k] / kBlendWidth));
    weights += w;
    sum.g0 += w * law.g0;
    sum.g_limit += w * law.g_limit;
    sum.limit_depth += w * law.limit_depth;
  }
  return {sum.g0 / weights, sum.g_limit / weights, sum.limit_depth / weights};
}

std::vector<Eigen::Vector3f> centres(const SkinGeometry& skin, const SkinPatches& patches) {
  std::vector<Eigen::Vector3f> result;
  for (const Vec3& c : patch_centres(skin, patches)) result.push_back(c.cast<float>());
  return result;
}

}  // namespace

SkinStiffness skin_stiffness(const Hand& hand, const SkinGeometry& skin,
                             const SkinResponse& response, const SkinPatches& blocks,
                             const ContactModel& model) {
  SkinStiffness result;
  const int n = skin.vertex_count();
  const auto count = static_cast<std::size_t>(n);
  for (const TissueLevel level : {TissueLevel::kLow, TissueLevel::kNominal, TissueLevel::kHigh}) {
    std::vector<StiffeningLaw>& law = result.law[static_cast<std::size_t>(level)];
    law.reserve(count);
    for (int v = 0; v < n; ++v) {
      const RegionTissue& tissue =
          hand.tissue.region[static_cast<std::size_t>(hand.region[static_cast<std::size_t>(v)])];
      law.push_back(
          model.coupling == RegionCoupling::kCoupled
              ? blended(hand, skin, response, model.tissue, level, v)
              : law_at(model.tissue == TissueModel::kLayered ? tissue.layered : tissue.half_space,
                       level));
    }
  }
  result.finger.assign(count, -1);
  for (std::size_t v = 0; v < count && !hand.segment.empty(); ++v) {
    if (const auto finger = finger_of(hand.segment[v]))
      result.finger[v] = static_cast<int>(*finger);
  }
  result.spots = skin_patches(skin, kSpotSize);
  result.spot_centre = centres(skin, result.spots);
  result.spot_finger.assign(result.spot_centre.size(), -1);
  for (std::size_t v = count; v-- > 0;) {
    result.spot_finger[static_cast<std::size_t>(result.spots.patch[v])] = result.finger[v];
  }
  result.blocks = blocks;
  result.block_centre = centres(skin, blocks);
  result.block_radius.assign(result.block_centre.size(), 0.0F);
  for (std::size_t v = 0; v < count; ++v) {
    const auto b = static_cast<std::size_t>(blocks.patch[v]);
    const float r = (skin.position[v].cast<float>() - result.block_centre[b]).norm();
    result.block_radius[b] = std::max(result.block_radius[b], r);
  }
  return result;
}

std::vector<double> local_depth(const SkinStiffness& stiffness, const SkinGeometry& skin,
                                const std::vector<int>& vertices, const std::vector<int>& collision,
                                const std::vector<DistanceSample>& sample) {
  std::vector<float> deepest(static_cast<std::size_t>(stiffness.spots.count), 0.0F);
  std::vector<std::size_t> touched;
  for (const int v : collision) {
    const auto s = static_cast<std::size_t>(stiffness.spots.patch[static_cast<std::size_t>(v)]);
    if (deepest[s] == 0.0F) touched.push_back(s);
    deepest[s] =
        std::max(deepest[s], static_cast<float>(-sample[static_cast<std::size_t>(v)].distance));
  }
  // Vertices patch by patch, positions apart by coordinate: vector instructions.
  const std::size_t n = vertices.size();
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  const auto block_of = [&](int k) {
    return stiffness.blocks.patch[static_cast<std::size_t>(vertices[static_cast<std::size_t>(k)])];
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return block_of(a) < block_of(b); });
  std::vector<float> x(n), y(n), z(n), depth(n, 0.0F);
  std::vector<int> finger(n);
  std::vector<std::size_t> first;  // of each patch
  for (std::size_t k = 0; k < n; ++k) {
    const auto v = static_cast<std::size_t>(vertices[static_cast<std::size_t>(order[k])]);
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
      const auto b = static_cast<std::size_t>(block_of(order[first[p]]));
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
    const auto place = static_cast<std::size_t>(order[k]);
    const auto v = static_cast<std::size_t>(vertices[place]);
    result[place] = std::max(static_cast<double>(depth[k]), -sample[v].distance);
  }
  return result;
}

}  // namespace palmar
