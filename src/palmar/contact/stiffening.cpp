// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/stiffening.h"

#include <algorithm>

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

}  // namespace

SkinStiffness skin_stiffness(const Hand& hand, const SkinGeometry& skin,
                             const SkinResponse& response, const ContactModel& model) {
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
  result.spots = skin_patches(skin, kSpotSize);
  std::vector<int> members(static_cast<std::size_t>(result.spots.count), 0);
  result.spot_centre.assign(members.size(), Eigen::Vector3f::Zero());
  result.spot_finger.assign(members.size(), -1);
  result.finger.assign(count, -1);
  for (std::size_t v = 0; v < count; ++v) {
    if (!hand.segment.empty()) {
      if (const auto finger = finger_of(hand.segment[v])) {
        result.finger[v] = static_cast<int>(*finger);
      }
    }
    const auto s = static_cast<std::size_t>(result.spots.patch[v]);
    result.spot_centre[s] += skin.position[v].cast<float>();
    if (members[s] == 0) result.spot_finger[s] = result.finger[v];
    ++members[s];
  }
  for (std::size_t s = 0; s < members.size(); ++s) {
    result.spot_centre[s] /= static_cast<float>(members[s]);
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
  // Positions apart by coordinate and one spot at a time over all vertices: vector instructions.
  const std::size_t n = vertices.size();
  std::vector<float> x(n), y(n), z(n), depth(n, 0.0F);
  std::vector<int> finger(n);
  for (std::size_t k = 0; k < n; ++k) {
    const auto v = static_cast<std::size_t>(vertices[k]);
    x[k] = static_cast<float>(skin.position[v].x());
    y[k] = static_cast<float>(skin.position[v].y());
    z[k] = static_cast<float>(skin.position[v].z());
    finger[k] = stiffness.finger[v];
  }
  constexpr float kSlope = 1.0F / (kEnd * kEnd - kPlateau * kPlateau);
  for (const std::size_t s : touched) {
    const Eigen::Vector3f& c = stiffness.spot_centre[s];
    const float d = deepest[s];
    const int own = stiffness.spot_finger[s];
    for (std::size_t k = 0; k < n; ++k) {
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
  std::vector<double> result(n);
  for (std::size_t k = 0; k < n; ++k) {
    // A vertex's own penetration is beyond doubt; its spot's centre may be a little away.
    const auto v = static_cast<std::size_t>(vertices[k]);
    result[k] = std::max(static_cast<double>(depth[k]), -sample[v].distance);
  }
  return result;
}

}  // namespace palmar
