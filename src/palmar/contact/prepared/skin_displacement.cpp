// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/prepared/skin_displacement.h"

#include <algorithm>
#include <array>

#include "palmar/contact/response/response.h"
#include "palmar/core/enum_index.h"
#include "palmar/geometry/smooth_step.h"

namespace palmar::contact {
namespace {

/// gaussian_response() by table: an exponential per pair of vertices would cost more than the
/// solution. Linear between samples 1/128 c apart: error below 1e-5 of the maximum.
class GaussianTable {
 public:
  GaussianTable(double b, double c)
      : b_(static_cast<float>(b)), per_mm_(kPerWidth / static_cast<float>(c)) {
    for (int i = 0; i <= kSize; ++i) {
      value_[i] =
          static_cast<float>(gaussian_response(static_cast<double>(i) / kPerWidth, 0.0, 1.0));
    }
  }
  float at(float r) const {
    const float x = std::abs(r - b_) * per_mm_;
    if (x >= static_cast<float>(kSize)) return 0.0F;
    const int i = static_cast<int>(x);
    const float t = x - static_cast<float>(i);
    const float* v = value_.data() + i;
    return v[0] + t * (v[1] - v[0]);
  }

 private:
  static constexpr int kPerWidth = 128;
  static constexpr int kSize = 6 * kPerWidth;
  float b_, per_mm_;
  std::array<float, kSize + 1> value_{};
};

/// What one part does to the vertices around it, per vertex of the skin.
struct Motion {
  double elastic = 0.0;  ///< mm
  double bulge = 0.0;    ///< mm, out of the hand
};
using PartField = std::vector<Motion>;

/// The far part of what loaded vertices do; see SkinResponse.
class FarLoad {
 public:
  explicit FarLoad(const SkinResponse& response)
      : response_(&response),
        share_(response.cluster_count(), 0.0),
        force_(response.cluster_count(), 0.0) {}
  void add(std::size_t vertex, double share, double force) {
    if (!response_->has_far()) return;
    response_->to_clusters(vertex, share, share_);
    response_->to_clusters(vertex, force, force_);
  }
  template <typename Gaussian>
  void spread(const Gaussian& gaussian, const std::vector<GrownVertex>& around, bool swelling,
              PartField& field) const {
    if (!response_->has_far()) return;
    std::vector<double> elastic(share_.size(), 0.0), bulge(share_.size(), 0.0);
    const ResponseColumns& far = response_->far;
    for (std::size_t c = 0; c < share_.size(); ++c) {
      if (force_[c] == 0.0) continue;
      for (std::size_t e = far.begin[c]; e < far.begin[c + 1]; ++e) {
        const int i = far.vertex[e];
        elastic[i] += share_[c] * static_cast<double>(far.response[e]);
        if (!swelling) continue;
        bulge[i] += force_[c] * (1.0 - response_->near_share(far.distance[e])) *
                    static_cast<double>(gaussian.at(far.distance[e]));
      }
    }
    for (const GrownVertex& g : around) {
      const int v = g.vertex;
      field[v].elastic += response_->from_clusters(v, elastic);
      field[v].bulge += response_->from_clusters(v, bulge);
    }
  }

 private:
  const SkinResponse* response_;
  std::vector<double> share_, force_;  // per cluster
};

void add_held(const PreparedHand::Impl& prepared, const SkinLoad& load, const LoadedPart& part,
              const std::vector<GrownVertex>& around, const std::vector<char>& is_around,
              bool swelling, PartField& field) {
  const hand::RegionTissue& tissue = prepared.tissue(part.region);
  const GaussianTable gaussian(tissue.swelling_radius, tissue.swelling_width);
  const SkinResponse& response = prepared.response;
  FarLoad far(response);
  for (const int k : part.row) {
    const int j = load.vertex[k];
    const double p = load.force[k];
    const double share = p / load.shear_modulus[k];
    const bool is_split = response.has_far();
    for (std::size_t e = response.begin[j]; e < response.begin[j + 1]; ++e) {
      const int i = response.vertex[e];
      if (!is_around[i]) continue;
      const float r = response.distance[e];
      const double bulge = swelling ? p * static_cast<double>(gaussian.at(r)) : 0.0;
      field[i].elastic += share * static_cast<double>(response.response[e]);
      field[i].bulge += is_split ? bulge * response.near_share(r) : bulge;
    }
    far.add(j, share, p);
  }
  far.spread(gaussian, around, swelling, field);
  if (!swelling) return;
  double highest = 0.0;
  for (const GrownVertex& g : around) {
    double& bulge = field[g.vertex].bulge;
    bulge *= geometry::smooth_step(g.distance / (0.5 * tissue.swelling_radius));
    highest = std::max(highest, bulge);
  }
  if (!(highest > 0.0)) return;
  const double scale = swelling_height_at(tissue, part.force) / highest;
  for (const GrownVertex& g : around) field[g.vertex].bulge *= scale;
}

}  // namespace

std::vector<LoadedPart> loaded_parts(const PreparedHand::Impl& prepared, const SkinLoad& load) {
  std::array<std::vector<int>, hand::kRegionCount> rows;
  std::vector<int> dorsal;
  std::vector<int> row_of(prepared.skin.vertex_count(), -1);
  for (std::size_t k = 0; k < load.vertex.size(); ++k) {
    if (!(load.force[k] > 0.0)) continue;
    const int v = load.vertex[k];
    const hand::Region region = prepared.hand->region[v];
    if (region == hand::Region::kDorsum) {
      dorsal.push_back(v);
      row_of[v] = static_cast<int>(k);
    } else {
      rows[index_of(region)].push_back(static_cast<int>(k));
    }
  }
  std::vector<LoadedPart> parts;
  for (const std::vector<int>& patch : connected_parts(prepared.skin, dorsal)) {
    LoadedPart& part = parts.emplace_back();
    part.region = hand::Region::kDorsum;
    for (const int v : patch) part.row.push_back(row_of[v]);
  }
  for (int r = 0; r < hand::kRegionCount; ++r) {
    if (rows[r].empty()) continue;
    parts.push_back({static_cast<hand::Region>(r), std::move(rows[r]), 0.0});
  }
  for (LoadedPart& part : parts) {
    for (const int k : part.row) part.force += load.force[k];
  }
  return parts;
}

SkinDisplacement skin_displacement(const PreparedHand::Impl& prepared, const SkinOnProduct& skin,
                                   const SkinLoad& load, const std::vector<LoadedPart>& parts,
                                   bool swelling) {
  const std::size_t n = skin.sample.size();
  const bool adds_up = prepared.model.coupling == RegionCoupling::kCoupled;
  SkinDisplacement u{std::vector<double>(n, 0.0), std::vector<double>(n, 0.0),
                     std::vector<char>(n, 0)};
  std::vector<double> bulge(n, 0.0), weight_sum(n, 0.0), best_fade(n, 0.0);
  std::vector<char> is_around(n, 0);
  PartField field(n);
  std::vector<int> loaded;
  for (const LoadedPart& part : parts) {
    loaded.clear();
    for (const int k : part.row) loaded.push_back(load.vertex[k]);
    const double reach = prepared.tissue(part.region).neighbourhood;
    const std::vector<GrownVertex> around = grow(prepared.skin, loaded, reach);
    for (const GrownVertex& g : around) {
      is_around[g.vertex] = 1;
    }
    // On bone the caller knows how the skin around moves.
    if (!prepared.is_on_bone()) {
      add_held(prepared, load, part, around, is_around, swelling, field);
    }
    for (const GrownVertex& g : around) {
      const int v = g.vertex;
      const double fade = geometry::smooth_step(3.0 * (1.0 - g.distance / reach));
      const double weight = fade / (g.distance * g.distance + 1.0);
      weight_sum[v] += weight;
      best_fade[v] = std::max(best_fade[v], fade);
      u.elastic[v] += adds_up ? field[v].elastic : weight * fade * field[v].elastic;
      bulge[v] += weight * fade * field[v].bulge;
      if (g.distance < reach) u.is_active[v] = 1;
      field[v] = {};
      is_around[v] = 0;
    }
  }
  for (std::size_t v = 0; v < n; ++v) {
    if (!(weight_sum[v] > 0.0)) continue;
    if (adds_up) {
      u.elastic[v] *= best_fade[v];
    } else {
      u.elastic[v] /= weight_sum[v];
    }
    u.with_bulge[v] = u.elastic[v] - bulge[v] / weight_sum[v];
  }
  for (std::size_t k = 0; k < load.vertex.size(); ++k) {
    // What the solution found is exact.
    const int v = load.vertex[k];
    const double d = skin.sample[v].distance;
    if (load.force[k] > 0.0) {
      u.elastic[v] = -d;
      u.with_bulge[v] = -d;
    } else if (d < 0.0) {
      u.elastic[v] = load.gap[k] - d;
      u.is_active[v] = 1;
    }
  }
  for (std::size_t v = 0; v < n; ++v) {
    if (u.is_active[v]) u.with_bulge[v] = std::max(u.with_bulge[v], -skin.sample[v].distance);
  }
  return u;
}

}  // namespace palmar::contact
