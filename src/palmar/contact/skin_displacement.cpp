// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include "palmar/contact/response.h"
#include "palmar/contact/sub_active_region.h"

namespace palmar {
namespace {

/// 0 up to t = 0, 1 from t = 1 on, smooth in between.
double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// What one part says about the rows of its response.
struct PartField {
  Eigen::VectorXf elastic;  ///< mm
  Eigen::VectorXf bulge;    ///< mm; positive out of the hand
};

PartField field_of(const PreparedHand::Impl& prepared, const SubActiveRegion& part,
                   const std::vector<double>& to_loaded, bool swelling) {
  const RegionResponse& response = *part.response;
  const auto rows = static_cast<Eigen::Index>(response.vertex.size());
  PartField field{Eigen::VectorXf::Zero(rows), Eigen::VectorXf::Zero(rows)};
  for (std::size_t k = 0; k < part.columns.size(); ++k) {
    const double p = part.force[static_cast<Eigen::Index>(k)];
    if (p <= 0.0) continue;
    field.elastic += static_cast<float>(p / part.shear_modulus) * response.bou.col(part.columns[k]);
    if (swelling) field.bulge += static_cast<float>(p) * response.gau.col(part.columns[k]);
  }
  if (!swelling) return field;
  const RegionTissue& tissue = prepared.tissue(part.region);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double r = to_loaded[response.vertex[i]];
    field.bulge[i] *= static_cast<float>(smooth_step(r / (0.5 * tissue.swelling_radius)));
  }
  const float highest = field.bulge.maxCoeff();
  if (highest > 0.0F) {
    field.bulge *= static_cast<float>(swelling_height_at(tissue, part.force.sum())) / highest;
  }
  return field;
}

}  // namespace

SkinDisplacement skin_displacement(const PreparedHand::Impl& prepared, const SkinOnProduct& skin,
                                   const std::vector<SubActiveRegion>& parts, bool swelling) {
  const std::size_t n = skin.sample.size();
  SkinDisplacement u{std::vector<double>(n, 0.0), std::vector<double>(n, 0.0),
                     std::vector<char>(n, 0)};
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<double> weight_sum(n, 0.0);
  std::vector<double> to_loaded(n, kFar);
  std::vector<char> is_loaded(n, 0);
  for (const SubActiveRegion& part : parts) {
    std::vector<int> loaded;
    for (std::size_t k = 0; k < part.collision.size(); ++k) {
      if (part.force[static_cast<Eigen::Index>(k)] > 0.0) loaded.push_back(part.collision[k]);
    }
    for (const int v : loaded) is_loaded[v] = 1;
    const double reach = prepared.tissue(part.region).neighbourhood;
    const std::vector<GrownVertex> grown = grow(prepared.skin, loaded, reach);
    for (const GrownVertex& g : grown) to_loaded[g.vertex] = g.distance;
    const PartField field = field_of(prepared, part, to_loaded, swelling);
    for (std::size_t i = 0; i < part.response->vertex.size(); ++i) {
      const int v = part.response->vertex[i];
      const double r = to_loaded[v];
      if (!(r < reach)) continue;
      const double fade = smooth_step(3.0 * (1.0 - r / reach));
      const double weight = fade / (r * r + 1.0);
      const auto row = static_cast<Eigen::Index>(i);
      const double elastic = fade * field.elastic[row];
      weight_sum[v] += weight;
      u.elastic[v] += weight * elastic;
      u.with_bulge[v] += weight * (elastic - fade * field.bulge[row]);
      u.is_active[v] = 1;
    }
    for (const GrownVertex& g : grown) to_loaded[g.vertex] = kFar;
  }
  for (std::size_t v = 0; v < n; ++v) {
    const double d = skin.sample[v].distance;
    if (weight_sum[v] > 0.0) {
      u.elastic[v] /= weight_sum[v];
      u.with_bulge[v] /= weight_sum[v];
    }
    if (is_loaded[v]) {
      u.elastic[v] = -d;
      u.with_bulge[v] = -d;
    }
  }
  for (const SubActiveRegion& part : parts) {
    for (std::size_t k = 0; k < part.collision.size(); ++k) {
      // What the part itself found is exact; neighbours only add to it in the picture.
      const int v = part.collision[k];
      if (is_loaded[v]) continue;
      u.elastic[v] = part.gap[static_cast<Eigen::Index>(k)] - skin.sample[v].distance;
      u.is_active[v] = 1;
    }
  }
  for (std::size_t v = 0; v < n; ++v) {
    if (u.is_active[v]) u.with_bulge[v] = std::max(u.with_bulge[v], -skin.sample[v].distance);
  }
  return u;
}

}  // namespace palmar
