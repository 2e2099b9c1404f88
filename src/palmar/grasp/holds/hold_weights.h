// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/grasp/holds/opposed_holds.h"

namespace palmar::grasp {

/// How likely people are to take each of a product's holds: a conditional logit (McFadden 1974),
///
///     p_c = exp(s_c) / sum_k exp(s_k),   s_c = sum_f weight_f (feature_cf - mean_f) / spread_f.
struct HoldWeights {
  HoldFeatures mean = HoldFeatures::Zero(), spread = HoldFeatures::Ones();
  HoldFeatures weight = HoldFeatures::Zero();

  /// The weights where it isn't known how the product lies, fitted without the table's features
  /// (theirs is 0).
  HoldFeatures unseen = HoldFeatures::Zero();

  ShapeFeatures shape_slope(bool knows_how_it_lies) const;  ///< weight / spread
  TableFeatures table_slope() const;
};

/// Of things that are picked up to be handed over, fitted by `palmar grasp fit-holds`;
/// docs/method/hand-over.md has the data and how well they do on objects that were left out.
const HoldWeights& hand_over_weights();

/// Chances of the holds by their features; they sum to 1. Unless it is known how the product lies,
/// that counts nothing.
Eigen::VectorXd chances(const HoldWeights& weights, const std::vector<OpposedHold>& holds,
                        const std::optional<Standing>& lay = {});

/// A hold round which people's are densest.
struct HoldMode {
  std::size_t hold = 0;  ///< index
  double score = 0.0;    ///< ln of the density there over that of the first, at most 0
};

/// Where the density of people's holds,
///
///     sum_c p_c exp(-d^2 / 2 h^2),   d = HandPoints::distance_to(c), h = 20 mm,
///
/// is largest, then where it is so at least 35 mm from those before; at most `most`. Only the 600
/// likeliest holds count.
std::vector<HoldMode> modes_of(const std::vector<OpposedHold>& holds, const Eigen::VectorXd& chance,
                               std::size_t most);

}  // namespace palmar::grasp
