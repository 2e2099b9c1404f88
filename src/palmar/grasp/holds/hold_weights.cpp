// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/hold_weights.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace palmar::grasp {
namespace {

constexpr double kDensity = 20.0;        // mm; people's own spread is 15 to 50
constexpr double kElsewhere = 35.0;      // mm from the modes before; choice
constexpr std::size_t kLikeliest = 600;  // holds that are looked at; the others count nothing

}  // namespace

// palmar grasp fit-holds, of 192 holds of ten objects by ten people who picked each up and handed
// it over (object_sim, of DexYCB: Chao et al. 2021, CVPR); in the order of HoldFeature.
const HoldWeights& hand_over_weights() {
  static const HoldWeights weights = [] {
    HoldWeights table;
    table.weight << 0.868333, 0.850786, -0.778739, -0.550805, -1.30643, -0.868265, 0.660932,
        0.654717, 0.519093, 1.67085, 1.64399, -0.956825;
    table.unseen << 0.819939, 1.02029, -0.565677, -0.69922, -1.11431, -1.01223, 0.79928, 0.716545,
        0.852323, 0.0, 0.0, 0.0;
    table.mean << 2.41272, 0.162831, 2.09296, 0.207613, 0.0316248, 0.0853636, 0.188831, 0.213043,
        0.0709659, 0.0, 0.0, 0.0;
    table.spread << 1.03605, 0.401556, 1.47026, 0.346613, 0.0500059, 0.0989646, 0.191478, 0.202962,
        0.134806, 1.0, 1.0, 1.0;
    return table;
  }();
  return weights;
}

ShapeFeatures HoldWeights::shape_slope(bool knows_how_it_lies) const {
  const HoldFeatures& own = knows_how_it_lies ? weight : unseen;
  return own.head<kShapeFeatureCount>().cwiseQuotient(spread.head<kShapeFeatureCount>());
}

TableFeatures HoldWeights::table_slope() const {
  return weight.tail<kTableFeatureCount>().cwiseQuotient(spread.tail<kTableFeatureCount>());
}

Eigen::VectorXd chances(const HoldWeights& weights, const std::vector<OpposedHold>& holds,
                        const std::optional<Standing>& lay) {
  Eigen::VectorXd chance(static_cast<Eigen::Index>(holds.size()));
  const ShapeFeatures shape = weights.shape_slope(lay.has_value());
  const TableFeatures table = weights.table_slope();
  for (std::size_t c = 0; c < holds.size(); ++c) {
    double& score = chance[static_cast<Eigen::Index>(c)];
    score = shape.dot(holds[c].features);
    if (lay) score += table.dot(table_features(holds[c].palm, *lay));
  }
  if (holds.empty()) return chance;
  chance = (chance.array() - chance.maxCoeff()).exp();
  return chance / chance.sum();
}

std::vector<HoldMode> modes_of(const std::vector<OpposedHold>& holds, const Eigen::VectorXd& chance,
                               std::size_t most) {
  std::vector<std::size_t> order(holds.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return chance[static_cast<Eigen::Index>(a)] > chance[static_cast<Eigen::Index>(b)];
  });
  order.resize(std::min(order.size(), kLikeliest));
  std::vector<double> density(order.size(), 0.0);
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const double d = holds[order[i]].points.distance_to(holds[order[j]].points);
      const double near = std::exp(-0.5 * d * d / (kDensity * kDensity));
      density[i] += near * chance[static_cast<Eigen::Index>(order[j])];
      if (j < i) density[j] += near * chance[static_cast<Eigen::Index>(order[i])];
    }
  }
  std::vector<HoldMode> modes;
  std::vector<char> is_free(order.size(), 1);
  while (modes.size() < most) {
    std::size_t best = order.size();
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (is_free[i] != 0 && (best == order.size() || density[i] > density[best])) best = i;
    }
    if (best == order.size() || !(density[best] > 0.0)) break;
    modes.push_back({order[best], std::log(density[best])});
    for (std::size_t i = 0; i < order.size(); ++i) {
      const double away = holds[order[i]].points.distance_to(holds[order[best]].points);
      if (away < kElsewhere) is_free[i] = 0;
    }
  }
  for (std::size_t k = modes.size(); k-- > 0;) modes[k].score -= modes.front().score;
  return modes;
}

}  // namespace palmar::grasp
